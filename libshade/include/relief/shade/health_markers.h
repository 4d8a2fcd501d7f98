// SPDX-License-Identifier: Apache-2.0
/// \file
/// Creates markers for the findings of the mesh health check (diagnose.h, `relief-mesh check`).
/// They are drawn over a picture and colored by kind. No OpenGL.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "relief/mesh/diagnose.h"
#include "relief/shade/debug_views.h"
#include "relief/shade/scene.h"

namespace relief {

/// A condition, counted over all instances.
struct MarkedCondition {
    MeshCondition condition;
    std::size_t count = 0;  ///< Affected elements; those of a mesh once for each instance.
    /// Number of elements with a marker; the others are not finite, or exceed max_markers.
    std::size_t marked = 0;
    glm::vec3 color_srgb{1.0F};
};

struct HealthMarkers {
    std::shared_ptr<const std::vector<Marker>> markers;  ///< In the order of the conditions.
    std::vector<MarkedCondition> conditions;             ///< The legend, in the same order.
};

/// The maximum number of markers for one condition in one mesh.
inline constexpr std::size_t max_markers = 10000;

/// Returns the sRGB color of a condition; every condition has a different one.
glm::vec3 marker_color(MeshCondition condition);

/// Diagnoses every mesh that an instance shows. The marker of a vertex is at its position; that of
/// a triangle, or of an edge by its first triangle, at the center of its corners. Elements that are
/// not finite, and conditions of the whole mesh, are counted without a marker.
///
/// \param severity  only conditions of this severity: problems (for which `relief-mesh check`
///         reports an unsound mesh) or notes; if absent, both. Problems alone are faster
HealthMarkers health_markers(const Scene& scene,
                             std::optional<Severity> severity = Severity::problem);

}  // namespace relief
