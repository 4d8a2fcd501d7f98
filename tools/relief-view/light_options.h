// SPDX-License-Identifier: Apache-2.0
/// \file
/// The options of lights and the camera. Angles are radians here and degrees on the command line.
/// Lights have the following form:
///
///     directional:AZIMUTH,ELEVATION[,INTENSITY[,#RRGGBB]]    from this direction, in degrees
///     point:X,Y,Z[,INTENSITY[,#RRGGBB]]                      in world space
///     spot:X,Y,Z,TX,TY,TZ[,ANGLE[,INTENSITY[,#RRGGBB]]]      from (X,Y,Z) towards (TX,TY,TZ)
///     none                                                   no lights
///
/// The intensity is irradiance over pi (at distance 1 for point and spot), so a white surface that
/// faces a directional light of intensity 1 is white. Tests: tests/tools/scene_options_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "common/view_direction.h"
#include "view_options.h"

namespace relief::tools {

/// \param subject  the option for messages, for example "--light point:1,2"
LightOption parse_light(const std::string& subject, const std::string& text);

/// Parses "azimuth,elevation[,factor]" or "azimuth,elevation@x,y,z,distance", in degrees.
/// \throws UsageError
CameraOption parse_camera(const std::string& subject, const std::string& text);

/// Parses 1 to 170 degrees. Returns radians. \throws UsageError
float parse_fov(const std::string& subject, const std::string& text);

void add_light_options(CLI::App& app, ViewOptions& options);

/// Sets the distance of ambient occlusion, times the scene's size; 0 is none.
void set_occlusion(ViewOptions& options, float distance);

}  // namespace relief::tools
