// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scenes of one mesh, for pictures that are compared.
/// Tests: tests/accuracy/many_samples_test.cpp.
#pragma once

#include "relief/mesh/mesh.h"
#include "relief/shade/scene.h"

namespace relief {

/// The lamp of lit_scene(): its light travels this way; not unit.
inline constexpr glm::vec3 lamp_direction_world{-0.5F, -0.8F, -0.6F};
inline constexpr float lamp_irradiance = 0.9F;
inline constexpr float lit_ambient = 0.08F;
/// Linear light, opaque.
inline constexpr glm::vec4 lit_background{0.03F, 0.04F, 0.06F, 1.0F};

/// A mesh under one directional lamp and a little ambient light, seen from 30 degrees to the right
/// and 35 above, before a dark background, in a square picture.
Scene lit_scene(Mesh mesh, Material material);

/// The same with a normal map, which repeats.
Scene bumpy_scene(Mesh mesh, Material material, Image normal_map);

/// Smooth and reddish, with a highlight of shininess 40.
Material glossy_plastic();

}  // namespace relief
