// SPDX-License-Identifier: Apache-2.0
// Embree gets the scene divided by the camera's far distance, so that no scale is too large or too
// small for its floats.
#include "reference/visibility.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "bake/embree_scene.h"

namespace relief::reference {

Visibility::Visibility(std::vector<ViewMesh> meshes, double near, double far)
    : meshes_(std::move(meshes)),
      near_(near),
      far_(far),
      embree_(
          std::make_unique<EmbreeScene>(EmbreeSpace{glm::dvec3(0.0), far}, SceneBuild::thorough)) {
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        if (meshes_[i].triangles.empty()) continue;
        embree_->add(static_cast<std::uint32_t>(i), meshes_[i].positions_view,
                     meshes_[i].triangles);
    }
    embree_->build();
}

Visibility::~Visibility() = default;

/// Tells whether b has the edge or the vertex of a on which the hit a lies: all corners of a whose
/// weights are not 0.
bool Visibility::shares_place(const Hit& a, const Hit& b) const {
    if (a.instance != b.instance) return false;
    const ViewMesh& mesh = meshes_[a.instance];
    const glm::uvec3& corners = mesh.triangles[a.triangle];
    const glm::uvec3& others = mesh.triangles[b.triangle];
    for (int i = 0; i < 3; ++i) {
        if (a.barycentric[i] == 0.0) continue;
        const glm::dvec3& position = mesh.positions_view[corners[i]];
        if (position != mesh.positions_view[others.x] &&
            position != mesh.positions_view[others.y] && position != mesh.positions_view[others.z])
            return false;
    }
    return true;
}

/// Tells whether a hit on an edge or a vertex repeats an earlier hit there.
bool Visibility::is_repeated(const std::vector<Hit>& all, std::size_t index) const {
    const glm::dvec3& weights = all[index].barycentric;
    if (weights.x != 0.0 && weights.y != 0.0 && weights.z != 0.0) return false;
    return std::any_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(index),
                       [&](const Hit& before) { return shares_place(all[index], before); });
}

std::vector<Hit> Visibility::hits(double x, double y) const {
    const glm::dvec3 direction(x, y, -1.0);
    // The search range is slightly larger; the exact depth decides below.
    std::vector<MetTriangle> candidates;
    embree_->find_all({glm::dvec3(0.0), direction, 0.999 * near_, 1.001 * far_}, candidates);

    const RayFrame ray = frame_of(glm::dvec3(0.0), direction);
    std::vector<Hit> all;
    for (const MetTriangle& met : candidates) {
        const std::array<glm::dvec3, 3> corners = embree_->corners(met);
        ExactHit exact;
        if (!intersect(ray, corners, exact)) continue;
        Hit hit{met.mesh, met.triangle};
        hit.barycentric = exact.weights;
        hit.counter_clockwise = exact.faces_origin;
        for (int i = 0; i < 3; ++i)
            hit.depth -= exact.weights[i] * corners[static_cast<std::size_t>(i)].z;
        if (hit.depth >= near_ && hit.depth <= far_) all.push_back(hit);
    }
    std::sort(all.begin(), all.end(), [](const Hit& a, const Hit& b) {
        return std::tie(a.depth, a.instance, a.triangle) <
               std::tie(b.depth, b.instance, b.triangle);
    });
    std::vector<Hit> once;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!is_repeated(all, i)) once.push_back(all[i]);
    }
    return once;
}

}  // namespace relief::reference
