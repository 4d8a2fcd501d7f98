// SPDX-License-Identifier: Apache-2.0
/// \file
/// Groups of triangles that lie near each other: what Embree sees as one shape.
///
/// A cluster holds copies of its corners side by side, so that one ray is tested against all of its
/// triangles with vector instructions. Embree builds its tree of the boxes of clusters, which are
/// several times fewer than triangles. Tests: tests/mesh/rays/triangle_clusters_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "rays/exact_hit.h"

namespace relief {

/// The box from -1 to 1 that Embree sees, in the space of the meshes: it is around all of them.
struct EmbreeSpace {
    glm::dvec3 center{0.0};
    double half_size = 1.0;
};

/// Boxes are larger than their triangles, and rays longer than requested, by this much in Embree's
/// space. Embree's floats round origins by 4.8e-7 (they are at most 11 away), directions by 3e-8
/// for each unit of length, and boxes by 6e-8. Embree's tests of boxes add 2^-22 of the distance
/// from the origin, and 2^-24 of the origin. Together that makes less than 4e-6 within the scene.
constexpr double embree_margin = 8e-6;

template <typename Number>
struct alignas(64) TriangleCluster {
    static constexpr std::size_t size = 8;
    static constexpr std::uint32_t none = 0xffffffff;

    /// By corner, axis and triangle. The values of an unused place are NaN.
    std::array<std::array<std::array<Number, size>, 3>, 3> corners;
    std::array<std::uint32_t, size> triangles;  ///< The used places come first; then `none`.

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
    std::vector<EmbreeBox> boxes;  ///< Of each cluster, larger by embree_margin.
};

/// Puts each triangle with finite corners and with area into one cluster. The order of the
/// triangles has no influence but on those whose centers are within 2^-16 of the space of each
/// other. Number is float or double.
template <typename Number>
TriangleClusters<Number> make_clusters(std::span<const glm::vec<3, Number>> positions,
                                       std::span<const glm::uvec3> triangles,
                                       const EmbreeSpace& space);

/// Lines of rays: two coordinates, x and y, are linear in the third, z. They are the two axes after
/// the one that RayFrame is projected along, and that one.
template <std::size_t count>
struct RayLines {
    std::array<double, count> origin_x, origin_y, origin_z, slope_x, slope_y;
    std::array<std::uint8_t, count> along;  ///< Which axis z is.

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

/// Finds the triangles of a cluster that a line meets, or may meet: for the others intersect() is
/// false. \return a bit for each
template <typename Number>
std::uint32_t candidates(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                         std::size_t line);

/// The same for several lines: the first 4, 8 or 16 from `begin`, which have one axis.
template <typename Number>
void candidates(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                std::size_t begin, std::size_t count, std::span<std::uint64_t, 16> bits);

}  // namespace relief
