// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reference normals of a map of the bumpy sphere: the mean over 16 x 16 lines through each texel,
/// from the formula of the surface and from the triangles of its mesh, without the baker.
#pragma once

#include <vector>

#include "experiment_parts.h"

namespace relief::test {

/// The arguments of make_sphere() for the low mesh.
struct LowSphere {
    int slices = 0;
    int stacks = 0;
};

/// Reference normals of a texel in object space, from the formula of the surface and from its mesh.
struct TexelReference {
    std::size_t texel = 0;
    glm::dvec3 surface{0.0};  ///< The mean over the square of the texel.
    glm::dvec3 mesh{0.0};
    glm::dvec3 surface_middle{0.0};  ///< At the center of the texel.
    glm::dvec3 mesh_middle{0.0};
};

/// The references of every 37th texel away from the poles, where the surface has no formula.
/// \param low  its normals are the directions of rays
std::vector<TexelReference> texel_references(const accuracy::detail::BumpySphere& high,
                                             const Mesh& low, const LowSphere& shape, int map_side);

}  // namespace relief::test
