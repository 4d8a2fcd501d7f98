// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where the health check of meshes (diagnose.h, `relief-mesh check`) found trouble, to be drawn
/// over a picture, coloured by kind. No OpenGL. Tests: tests/shade/scene/health_markers_test.cpp.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "relief/mesh/diagnose.h"
#include "relief/shade/debug_views.h"
#include "relief/shade/scene.h"

namespace relief {

/// A kind of trouble, over all instances.
struct MarkedCondition {
    MeshCondition condition;
    std::size_t count = 0;   ///< Elements that show it; those of a mesh once for each instance.
    std::size_t marked = 0;  ///< With a marker; others are nowhere, or beyond most_markers.
    glm::vec3 color_srgb{1.0F};
};

struct HealthMarkers {
    std::shared_ptr<const std::vector<Marker>> markers;  ///< In the order of the conditions.
    std::vector<MarkedCondition> conditions;             ///< The legend, in that order too.
};

/// Of one condition in one mesh.
inline constexpr std::size_t most_markers = 10000;

/// The colour of a condition, sRGB: another for each.
glm::vec3 marker_color(MeshCondition condition);

/// Diagnoses every mesh that an instance shows. A vertex is marked where it is; a triangle, and an
/// edge by the first triangle on it, at the middle of its corners. What is nowhere (not finite), or
/// about the mesh as a whole, is counted and has no marker.
///
/// \param severity  trouble alone (what makes `relief-mesh check` call a mesh unsound), which is
///                  found sooner, or absent: remarks too
HealthMarkers health_markers(const Scene& scene,
                             std::optional<Severity> severity = Severity::trouble);

}  // namespace relief
