// SPDX-License-Identifier: Apache-2.0
// How far two surfaces are apart, from points all over both. Tests: tests/mesh/bake/bake_test.cpp.
#include "bake/bake_distances.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// Grows a box by those triangles whose corners are all finite.
void add_triangles(const Mesh& mesh, Bounds& box) {
    for (const glm::uvec3& corners : mesh.triangles) {
        const std::array<glm::vec3, 3> positions = {
            mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
        if (!std::all_of(positions.begin(), positions.end(),
                         [](const glm::vec3& position) { return is_finite(position); }))
            continue;
        for (const glm::vec3& position : positions) {
            box.min = glm::min(box.min, position);
            box.max = glm::max(box.max, position);
        }
    }
}

/// The largest distance between a face of one box and the same face of the other.
double face_distance(const Bounds& a, const Bounds& b) {
    const glm::dvec3 lower = glm::abs(glm::dvec3(a.min) - glm::dvec3(b.min));
    const glm::dvec3 upper = glm::abs(glm::dvec3(a.max) - glm::dvec3(b.max));
    const glm::dvec3 larger = glm::max(lower, upper);
    return std::max({larger.x, larger.y, larger.z});
}

bool fits_turned(const BakeFit& fit, double low_diagonal) {
    if (face_distance(fit.high, fit.low) <= 0.1 * low_diagonal) return false;
    const glm::vec3 a = fit.high.min;
    const glm::vec3 b = fit.high.max;
    const Bounds forwards{{a.x, -b.z, a.y}, {b.x, -a.z, b.y}};  // (x, y, z) -> (x, -z, y)
    const Bounds backwards{{a.x, a.z, -b.y}, {b.x, b.z, -a.y}};
    return std::min(face_distance(forwards, fit.low), face_distance(backwards, fit.low)) <=
           0.03 * low_diagonal;
}

std::string in_words(const Bounds& box) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})", box.min.x, box.min.y,
                       box.min.z, box.max.x, box.max.y, box.max.z);
}

std::string mismatch_message(BakeMismatch::Kind kind, const BakeFit& fit, double reach,
                             const std::string& part) {
    const std::string prefix = part.empty() ? "" : fmt::format("part '{}': ", part);
    if (kind == BakeMismatch::Kind::no_surface)
        return prefix + "no triangle of the high meshes has finite corners";
    const std::string boxes = fmt::format("the box of the high meshes is {}, of the low mesh {}",
                                          in_words(fit.high), in_words(fit.low));
    if (kind == BakeMismatch::Kind::size) {
        return fmt::format(
            "{}the high meshes are {:.4g} times as large as the low mesh, which is not within "
            "1/{:g} to {:g}: {}",
            prefix, fit.size_ratio, max_size_ratio, max_size_ratio, boxes);
    }
    return fmt::format(
        "{}the high meshes and the low mesh are {:.4g} apart, but rays reach only {:.4g}: {}",
        prefix, fit.gap, reach, boxes);
}

}  // namespace

BakeMismatch::BakeMismatch(Kind kind, const BakeFit& fit, double reach, std::string part)
    : InvalidInput(mismatch_message(kind, fit, reach, part)),
      kind_(kind),
      fit_(fit),
      reach_(reach),
      part_(std::move(part)) {}

double diagonal(const Bounds& box) {
    return glm::distance(glm::dvec3(box.max), glm::dvec3(box.min));
}

bool BakeFit::differs_in_size() const {
    return size_ratio > max_size_ratio || size_ratio < 1.0 / max_size_ratio;
}

BakeFit compare_boxes(std::span<const Mesh> high, const Mesh& low) {
    Bounds high_box;
    Bounds low_box;
    validate(low);
    add_triangles(low, low_box);
    for (const Mesh& mesh : high) {
        validate(mesh);
        add_triangles(mesh, high_box);
    }
    return compare_boxes(high_box, low_box);
}

BakeFit compare_boxes(const Bounds& high, const Bounds& low) {
    BakeFit fit{.high = high, .low = low};
    if (fit.low.empty() || fit.high.empty()) return fit;
    const glm::dvec3 above = glm::dvec3(fit.high.min) - glm::dvec3(fit.low.max);
    const glm::dvec3 below = glm::dvec3(fit.low.min) - glm::dvec3(fit.high.max);
    fit.gap = glm::length(glm::max(glm::max(above, below), glm::dvec3(0.0)));
    const double low_diagonal = diagonal(fit.low);
    const double high_diagonal = diagonal(fit.high);
    if (!(low_diagonal > 0.0 && high_diagonal > 0.0)) return fit;
    fit.size_ratio = high_diagonal / low_diagonal;
    fit.fits_turned = fits_turned(fit, low_diagonal);
    return fit;
}

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
