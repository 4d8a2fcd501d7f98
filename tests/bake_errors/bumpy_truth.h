// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the texels of a map should show of the bumpy sphere: the mean of 16 x 16 lines through each
/// square, by the surface's formula and by the triangles that stand for it. No baker is asked.
#pragma once

#include <vector>

#include "bake_experiments.h"

namespace relief::test {

/// The low mesh is make_sphere() of these.
struct LowSphere {
    int slices = 0;
    int stacks = 0;
};

/// What a texel should hold: normals in object space.
struct TexelReference {
    std::size_t texel = 0;
    glm::dvec3 surface{0.0};  ///< The mean over its square.
    glm::dvec3 mesh{0.0};
    glm::dvec3 surface_middle{0.0};  ///< At its centre.
    glm::dvec3 mesh_middle{0.0};
};

/// Of every 37th texel, away from the poles, where the formula's surface is none.
/// \param low  its normals are the directions of rays
std::vector<TexelReference> texel_references(const BumpySphere& high, const Mesh& low,
                                             const LowSphere& shape, int map_side);

}  // namespace relief::test
