// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lights as the command line writes them:
///
///     directional:AZIMUTH,ELEVATION[,INTENSITY[,#RRGGBB]]          where it comes from, in degrees
///     point:X,Y,Z[,INTENSITY[,#RRGGBB]]                            in world space
///     spot:X,Y,Z,TX,TY,TZ[,ANGLE[,INTENSITY[,#RRGGBB]]]            from (X,Y,Z) towards (TX,TY,TZ)
///     none                                                         no light at all
///
/// Intensity is irradiance over pi (at distance 1 for point and spot), so a white surface that
/// faces a directional light of intensity 1 is white. Bad text throws UsageError.
/// Tests: tests/tools/light_option_test.cpp.
#pragma once

#include <string>
#include <variant>

#include "relief/shade/scene.h"

namespace relief::tools {

/// "none": the scene is to be dark.
struct NoLight {};

using LightOption = std::variant<NoLight, DirectionalLight, PointLight, SpotLight>;

/// \param subject  what messages name: "--light point:1,2"
LightOption parse_light(const std::string& subject, const std::string& text);

/// The unit vector towards a place in the sky.
///
/// \param azimuth    radians from +z towards +x
/// \param elevation  radians above the horizon
glm::vec3 towards(float azimuth, float elevation);

}  // namespace relief::tools
