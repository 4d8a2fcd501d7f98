// SPDX-License-Identifier: Apache-2.0
/// \file
/// Intersection of rays with triangles: exact tests of single triangles, and tests of clusters of
/// eight.
///
/// *Exact test.* [Woop et al. 2013] The corners are projected along the ray onto two coordinates,
/// in double. The projection of a corner depends only on the corner and the ray, so all triangles
/// at a corner use the same point. The test of the projected corners is exact: the ray hits the
/// triangle if the origin of the plane lies inside or on the border. Hence a ray never passes
/// between two triangles that share an edge or a vertex, and the result is the same on every
/// processor.
///
/// *Clusters.* A cluster holds copies of the corners of nearby triangles, so that one ray is tested
/// against all of them with vector instructions. Embree builds its tree from the boxes of clusters,
/// which are several times fewer than triangles. Tests: tests/mesh/rays/embree_scene_test.cpp.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief::detail {

/// A ray and the two axes of its projection plane.
struct RayFrame {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
    glm::dvec3 first{0.0}, second{0.0};
    int along = 2;  ///< The axis of the largest component of the direction.
};

/// Returns the projection of a ray whose direction is finite and not zero, of any length.
inline RayFrame frame_of(const glm::dvec3& origin, const glm::dvec3& direction) {
    const glm::dvec3 size = glm::abs(direction);
    const int z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const int x = (z + 1) % 3;
    const int y = (z + 2) % 3;
    RayFrame frame{origin, direction};
    frame.along = z;
    frame.first[x] = 1.0;
    frame.first[z] = -direction[x] / direction[z];
    frame.second[y] = 1.0;
    frame.second[z] = -direction[y] / direction[z];
    // Makes triangles that face the origin counter-clockwise in the plane.
    if (direction[z] > 0.0) std::swap(frame.first, frame.second);
    return frame;
}

struct ExactHit {
    glm::dvec3 weights{0.0};    ///< Barycentric: nonnegative, with sum 1.
    double distance = 0.0;      ///< Along the ray, in units of its direction.
    bool faces_origin = false;  ///< The ray hits the front.
};

/// Returns a.x * b.y - a.y * b.x with the correct sign; 0 only if the exact value is 0.
inline double exact_cross(const glm::dvec2& a, const glm::dvec2& b) {
    const double first = a.x * b.y;
    const double second = a.y * b.x;
    if (first != second) return first - second;
    // Rounding is monotonic, so only equal products need their remainders.
    return std::fma(a.x, b.y, -first) - std::fma(a.y, b.x, -second);
}

/// \return whether the ray's line hits the triangle; a triangle seen exactly edge-on is not hit
inline bool intersect(const RayFrame& ray, const std::array<glm::dvec3, 3>& corners,
                      ExactHit& hit) {
    std::array<glm::dvec3, 3> away;
    std::array<glm::dvec2, 3> point;
    for (std::size_t i = 0; i < 3; ++i) {
        away[i] = corners[i] - ray.origin;
        const glm::dvec3& a = away[i];
        point[i] = {a.x * ray.first.x + a.y * ray.first.y + a.z * ray.first.z,
                    a.x * ray.second.x + a.y * ray.second.y + a.z * ray.second.z};
    }
    const glm::dvec3 areas(exact_cross(point[1], point[2]), exact_cross(point[2], point[0]),
                           exact_cross(point[0], point[1]));
    const bool is_left = areas.x >= 0.0 && areas.y >= 0.0 && areas.z >= 0.0;
    const bool is_right = areas.x <= 0.0 && areas.y <= 0.0 && areas.z <= 0.0;
    if (is_left == is_right) return false;  // Outside, edge-on, or not finite.
    hit.weights = areas / (areas.x + areas.y + areas.z);
    const glm::dvec3 place =
        hit.weights.x * away[0] + hit.weights.y * away[1] + hit.weights.z * away[2];
    hit.distance = glm::dot(place, ray.direction) / glm::dot(ray.direction, ray.direction);
    hit.faces_origin = is_left;
    return true;
}

/// Embree's space: a cube around all meshes that maps to -1 to 1.
struct EmbreeSpace {
    glm::dvec3 center{0.0};
    double half_size = 1.0;
};

/// Boxes and rays are enlarged by this margin, in Embree's space. Embree's floats round origins
/// by 4.8e-7 (they are at most 11 away), directions by 3e-8 per unit of length, and boxes by 6e-8.
/// Embree's box tests add 2^-22 of the distance from the origin, and 2^-24 of the origin. The sum
/// is below 4e-6 in the scene.
constexpr double embree_margin = 8e-6;

template <typename Number>
struct alignas(64) TriangleCluster {
    static constexpr std::size_t size = 8;
    static constexpr std::uint32_t none = 0xffffffff;

    /// By corner, axis and triangle. Unused values are NaN.
    std::array<std::array<std::array<Number, size>, 3>, 3> corners;
    std::array<std::uint32_t, size> triangles;  ///< Unused entries come last and are `none`.

    [[nodiscard]] std::size_t count() const {
        std::size_t used = 0;
        while (used < size && triangles[used] != none)
            ++used;
        return used;
    }
    [[nodiscard]] std::array<glm::dvec3, 3> corners_of(std::size_t place) const {
        std::array<glm::dvec3, 3> result;
        for (std::size_t i = 0; i < 3; ++i) {
            result[i] = {static_cast<double>(corners[i][0][place]),
                         static_cast<double>(corners[i][1][place]),
                         static_cast<double>(corners[i][2][place])};
        }
        return result;
    }
};

/// A box in Embree's space.
struct EmbreeBox {
    glm::vec3 lower, upper;
};

template <typename Number>
struct TriangleClusters {
    std::vector<TriangleCluster<Number>> clusters;
    std::vector<EmbreeBox> boxes;  ///< The box of each cluster, enlarged by embree_margin.
};

/// Puts each triangle with finite corners and a positive area into one cluster. The order of the
/// triangles affects only triangles whose centers are within 2^-16 of each other. Number is float
/// or double.
template <typename Number>
TriangleClusters<Number> make_clusters(std::span<const glm::vec<3, Number>> positions,
                                       std::span<const glm::uvec3> triangles,
                                       const EmbreeSpace& space);

/// Lines of rays: two coordinates, x and y, as linear functions of the third, z. The axis of z is
/// RayFrame::along; x and y are the next two axes.
template <std::size_t count>
struct RayLines {
    std::array<double, count> origin_x, origin_y, origin_z, slope_x, slope_y;
    std::array<std::uint8_t, count> along;  ///< The axis of z.

    void set(std::size_t i, const RayFrame& ray) {
        const int z = ray.along;
        const int x = (z + 1) % 3;
        const int y = (z + 2) % 3;
        const bool is_swapped = ray.direction[z] > 0.0;
        origin_x[i] = ray.origin[x];
        origin_y[i] = ray.origin[y];
        origin_z[i] = ray.origin[z];
        slope_x[i] = is_swapped ? ray.second[z] : ray.first[z];
        slope_y[i] = is_swapped ? ray.first[z] : ray.second[z];
        along[i] = static_cast<std::uint8_t>(z);
    }
};

/// Returns the triangles of a cluster that a line may hit, a bit for each; intersect() is false for
/// the others.
template <typename Number>
std::uint32_t candidates(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                         std::size_t line);

/// The same for 4, 8 or 16 lines from `begin`, which have the same RayLines::along.
template <typename Number>
void candidates(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                std::size_t begin, std::size_t count, std::span<std::uint64_t, 16> bits);

}  // namespace relief::detail
