// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options of the layers that a bake computes from the same rays: normals, heights, occlusion,
/// curvature, positions and colors. A layer that is not requested costs no time and no memory, and
/// layers do not affect each other.
/// Tests: tests/mesh/bake/bake_layers_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace relief {

/// Options of ambient occlusion: the share of rays from a point that hit nothing. Rays are
/// cosine-distributed about the normal, like light from a uniform sky.
struct OcclusionOptions {
    /// Rays per texel, 1 to 65536, divided evenly among its samples. The error decreases by a
    /// factor of about 2^-0.75 for each doubling.
    int rays = 64;
    /// The length of the rays in the unit of the meshes. If absent, half of the longest side of the
    /// high meshes' bounding box.
    std::optional<double> distance{};
};

/// The layers to bake. Each value is the mean over those samples of a texel that hit; all layers
/// are padded in the same way.
struct BakeLayers {
    bool normals = true;
    /// The height of the high surface above the low mesh along the ray, in the unit of the meshes.
    bool heights = false;
    /// Ambient occlusion from 0 to 1, by the high meshes alone. Rays are distributed about the
    /// interpolated normal; those below the plane of their triangle are ignored. Back faces occlude
    /// too.
    std::optional<OcclusionOptions> occlusion{};
    /// Mean curvature in one over the unit of the meshes; convex is positive (curvature.h).
    bool curvature = false;
    /// Positions, transformed by `position_from_mesh`.
    bool positions = false;
    /// Linear RGB: vertex colors times the material's color and texture (high_materials.h).
    bool colors = false;
    glm::dmat4 position_from_mesh{1.0};  ///< For `positions`.
};

/// Upper bounds of the absolute values of layers, for integer storage.
struct LayerBounds {
    double height = 0.0;         ///< The length of the rays.
    double curvature = 0.0;      ///< Over all vertices of the high meshes.
    double curvature_p99 = 0.0;  ///< Over 99% of their area.
    double position = 0.0;       ///< Over all coordinates, transformed by `position_from_mesh`.
};

}  // namespace relief
