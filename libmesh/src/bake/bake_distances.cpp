// SPDX-License-Identifier: Apache-2.0
// How far two surfaces are apart, from points all over both. Tests: tests/mesh/bake/bake_test.cpp.
#include "bake/bake_distances.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "geometry/direction.h"
#include "parallel.h"
#include "relief/mesh/bake.h"

namespace relief {
namespace {

constexpr std::size_t point_count = 16384;
constexpr double margin = 1.5;
constexpr double least_share = 0.01;    // Of half of the low mesh's size.
constexpr double most_of_others = 4.0;  // Of the low mesh's own distance.

/// Points on triangles, spread evenly over each: by the golden ratio in two dimensions.
std::vector<glm::dvec3> points_on(const Mesh& mesh) {
    std::vector<glm::dvec3> points;
    const std::size_t count = mesh.triangles.size();
    for (std::size_t i = 0; i < point_count && count > 0; ++i) {
        // Triangles in turn, or where there are more of them, some all over.
        const std::size_t index = count > point_count ? i * count / point_count : i % count;
        const auto k = static_cast<double>(i);
        double second = std::fmod(0.5 + k * 0.7548776662466927, 1.0);
        double third = std::fmod(0.5 + k * 0.5698402909980532, 1.0);
        if (second + third > 1.0) {
            second = 1.0 - second;
            third = 1.0 - third;
        }
        const glm::uvec3 corners = mesh.triangles[index];
        const glm::dvec3 a(mesh.positions[corners.x]);
        points.push_back(a + second * (glm::dvec3(mesh.positions[corners.y]) - a) +
                         third * (glm::dvec3(mesh.positions[corners.z]) - a));
    }
    return points;
}

std::vector<glm::dvec3> vertices_of(std::span<const Mesh> meshes) {
    std::size_t all = 0;
    for (const Mesh& mesh : meshes)
        all += mesh.positions.size();
    const std::size_t stride = all / point_count + 1;
    std::vector<glm::dvec3> points;
    std::size_t index = 0;
    for (const Mesh& mesh : meshes) {
        for (const glm::vec3& position : mesh.positions) {
            if (index++ % stride == 0) points.emplace_back(position);
        }
    }
    return points;
}

/// Of those points that are finite and have something to be far from. As soon as one turns out to
/// be no further than another, how far does not matter.
double largest_distance(const std::vector<glm::dvec3>& points, const RayScene& scene) {
    std::atomic<double> largest = 0.0;
    parallel_for(points.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!is_finite(points[i])) continue;
            double known = largest;
            const double distance = scene.distance_from(points[i], known);
            if (!std::isfinite(distance)) continue;
            while (distance > known && !largest.compare_exchange_weak(known, distance)) {
            }
        }
    });
    return largest;
}

}  // namespace

BakeDistances distances_between(std::span<const Mesh> high, const RayScene& high_scene,
                                const Mesh& low) {
    const RayScene low_scene({{low.positions, low.triangles}});
    const double from_low = largest_distance(points_on(low), high_scene);
    const double from_high = largest_distance(vertices_of(high), low_scene);
    const double apart = std::max(from_low, std::min(from_high, most_of_others * from_low));
    const double distance = margin * apart + least_share * low_scene.half_size();
    return {distance, distance};
}

BakeDistances automatic_distances(std::span<const Mesh> high, const Mesh& low) {
    validate(low);
    std::vector<RayMesh> meshes;
    for (const Mesh& mesh : high) {
        validate(mesh);
        meshes.push_back({mesh.positions, mesh.triangles});
    }
    return distances_between(high, RayScene(std::move(meshes)), low);
}

}  // namespace relief
