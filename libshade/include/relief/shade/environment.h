// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines environment maps, and generates a photo studio as one.
///
/// Directions are in world space, right-handed, y up.
#pragma once

#include <array>
#include <variant>

#include "relief/export.h"
#include "relief/shade/image_source.h"

namespace RELIEF_API relief {
namespace shade {

/// Six square images of one size, in OpenGL's order and orientation: +x -x +y -y +z -z, each looked
/// up by the world direction. Seen from inside, OpenGL's faces are those of a left-handed world:
/// sets drawn for a right-handed world appear mirrored unless left_handed is set.
struct CubeFaces {
    std::array<ImageSource, 6> faces;
    bool left_handed = false;  ///< Drawn for a left-handed world: x is reversed.
};

/// Six faces in one image, as a horizontal (4:3) or vertical (3:4) cross, recognized by its shape.
struct CubeCross {
    ImageSource image;
};

/// A panorama by longitude and latitude: its center is -z, its top row +y.
struct Equirectangular {
    ImageSource image;
};

/// A light probe: the view into a mirrored ball, by angle. The center is -z, the rim +z, up is +y.
struct AngularMap {
    ImageSource image;
};

/// An environment map: light from all directions.
struct Environment {
    std::variant<CubeFaces, CubeCross, Equirectangular, AngularMap> source;
    float intensity = 1.0F;
    bool skybox = true;   ///< The environment is visible behind the model.
    bool lights = false;  ///< Surfaces scatter its light, by spherical harmonics of order 2.
    /// Radians by which it is rotated about the world's y axis, from +z to +x. Finite.
    float rotation = 0.0F;
    /// The blur of the visible environment: 0 is none, 1 that of a mirror of roughness 1.
    float skybox_blur = 0.0F;
};

/// Returns a neutral photo studio as an environment: a large soft light from the front left, a dim
/// one from the right, two strips behind that outline the model, and a panel above, in a gray room.
/// It is generated, so that no file is needed, as a panorama of 512 x 256 texels. Its irradiance
/// from the front is about that of the default lights. Surfaces scatter its light; it is not
/// visible as a background.
Environment studio_environment();

/// Returns true if the environment has the image of studio_environment().
bool is_studio(const Environment& environment);

}  // namespace shade
}  // namespace relief
