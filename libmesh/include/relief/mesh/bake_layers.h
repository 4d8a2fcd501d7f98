// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a bake makes beside normals, from the same rays. What is not asked for takes no time and no
/// memory, and asking for it changes nothing about the others.
/// Tests: tests/mesh/bake/bake_layers_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace relief {

/// How much of the surroundings a place sees: the share of rays from it, all about its normal and
/// denser towards it (by the cosine, as light from a grey sky counts), that meet nothing.
struct OcclusionOptions {
    /// For each texel, shared evenly by its samples; 1 to 65536. The error falls by about 2^-0.75
    /// for each doubling.
    int rays = 64;
    /// How far they run, in the unit of the meshes. Absent: half of the longest side of the box
    /// around the high meshes.
    std::optional<double> distance{};
};

/// Each is the mean over those samples of a texel that hit, and padded likewise.
struct BakeLayers {
    bool normals = true;
    /// Where the surface is, outside of the low mesh along the ray; in the unit of the meshes.
    bool heights = false;
    /// 0 to 1, of the high meshes alone. The rays start about the interpolated normal; those that
    /// run below their triangle's plane are left out. What is met from behind hides as well.
    std::optional<OcclusionOptions> occlusion{};
    /// Mean curvature, over the unit of the meshes; what bulges is positive (curvature.h).
    bool curvature = false;
    /// Places, by `position_from_mesh`.
    bool positions = false;
    /// Linear RGB: vertex colours times the material's colour and texture (high_detail.h).
    bool colors = false;
    glm::dmat4 position_from_mesh{1.0};  ///< For `positions`.
};

/// How large the numbers of layers can be, without their signs, for those who store them in
/// integers.
struct LayerBounds {
    double height = 0.0;           ///< How far rays reach.
    double curvature = 0.0;        ///< Of all vertices of the high meshes.
    double usual_curvature = 0.0;  ///< On 99% of their area.
    double position = 0.0;         ///< Of any coordinate, by `position_from_mesh`.
};

}  // namespace relief
