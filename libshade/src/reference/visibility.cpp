// SPDX-License-Identifier: Apache-2.0
// Rays from the eye by Embree, made exact. See visibility.h. Embree sees the scene divided by the
// camera's far distance, so that no scale is too large or too small for its floats.
// Tests: tests/shade/reference/visibility_test.cpp.
#include "reference/visibility.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "rays/embree_scene.h"

namespace relief::reference {

namespace {

/// Where the ray meets the plane of a triangle: weights of the corners, and the depth. For a ray d
/// from the origin the weights are as d.(b x c) : d.(c x a) : d.(a x b), and neighbours see exactly
/// opposite values for the edge that they share.
bool intersect(const glm::dvec3& ray, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
               Hit& hit) {
    const glm::dvec3 weights(glm::dot(ray, glm::cross(b, c)), glm::dot(ray, glm::cross(c, a)),
                             glm::dot(ray, glm::cross(a, b)));
    const double sum = weights.x + weights.y + weights.z;
    if (!(std::abs(sum) > 0.0) || !std::isfinite(sum)) return false;
    hit.barycentric = weights / sum;
    hit.depth = -(hit.barycentric.x * a.z + hit.barycentric.y * b.z + hit.barycentric.z * c.z);
    // The triple product a.(b x c) is negative where the eye sees a, b, c counter-clockwise; with
    // depth positive, so is the sum.
    hit.counter_clockwise = sum < 0.0;
    return std::isfinite(hit.depth);
}

}  // namespace

Visibility::Visibility(std::vector<ViewMesh> meshes, double near, double far)
    : meshes_(std::move(meshes)), near_(near), far_(far), embree_(std::make_unique<EmbreeScene>()) {
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        if (meshes_[i].triangles.empty()) continue;
        const std::span<const glm::dvec3> positions = meshes_[i].positions_view;
        const auto fill = [&](std::size_t begin, std::size_t end, float* xyz) {
            for (std::size_t v = begin; v < end; ++v) {
                for (int axis = 0; axis < 3; ++axis)
                    *xyz++ = static_cast<float>(positions[v][axis] * (1.0 / far));
            }
        };
        embree_->add(static_cast<std::uint32_t>(i), positions.size(), fill, meshes_[i].triangles);
    }
    embree_->build();
}

Visibility::~Visibility() = default;

/// Whether b has the edge of a that lies opposite to one of its corners.
bool Visibility::shares_edge(const Hit& a, int opposite_corner, const Hit& b) const {
    if (a.instance != b.instance) return false;
    const ViewMesh& mesh = meshes_[a.instance];
    const auto has = [&](const glm::dvec3& position) {
        const glm::uvec3& corners = mesh.triangles[b.triangle];
        for (int i = 0; i < 3; ++i) {
            if (mesh.positions_view[corners[i]] == position) return true;
        }
        return false;
    };
    const glm::uvec3& corners = mesh.triangles[a.triangle];
    return has(mesh.positions_view[corners[(opposite_corner + 1) % 3]]) &&
           has(mesh.positions_view[corners[(opposite_corner + 2) % 3]]);
}

/// Whether a triangle found by Embree is missed by the exact ray, which meets its neighbour; on the
/// edge itself the first of both counts.
bool Visibility::is_outside(const std::vector<Hit>& all, std::size_t index) const {
    const Hit& hit = all[index];
    for (int corner = 0; corner < 3; ++corner) {
        if (hit.barycentric[corner] > 0.0) continue;
        for (std::size_t other = 0; other < all.size(); ++other) {
            if (other == index || !shares_edge(hit, corner, all[other])) continue;
            if (hit.barycentric[corner] < 0.0 || other < index) return true;
        }
    }
    return false;
}

std::vector<Hit> Visibility::hits(double x, double y) const {
    // A little beyond both ends, for the exact test to decide.
    const RaySegment segment{glm::vec3(0.0F), glm::vec3(x, y, -1.0),
                             static_cast<float>(near_ / far_ * 0.999), 1.001F};
    std::vector<MetTriangle> found;
    embree_->find_all(segment, found);

    const glm::dvec3 ray(x, y, -1.0);
    std::vector<Hit> all;
    for (const auto& [instance, triangle] : found) {
        const ViewMesh& mesh = meshes_[instance];
        const glm::uvec3& corners = mesh.triangles[triangle];
        Hit hit{instance, triangle};
        if (!intersect(ray, mesh.positions_view[corners.x], mesh.positions_view[corners.y],
                       mesh.positions_view[corners.z], hit)) {
            continue;
        }
        if (hit.depth >= near_ && hit.depth <= far_) all.push_back(hit);
    }
    const auto rank = [](const Hit& hit) {
        return std::tuple(hit.depth, hit.instance, hit.triangle);
    };
    std::sort(all.begin(), all.end(),
              [&](const Hit& a, const Hit& b) { return rank(a) < rank(b); });
    all.erase(std::unique(all.begin(), all.end(),
                          [&](const Hit& a, const Hit& b) { return rank(a) == rank(b); }),
              all.end());
    std::vector<Hit> inside;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!is_outside(all, i)) inside.push_back(all[i]);
    }
    return inside;
}

}  // namespace relief::reference
