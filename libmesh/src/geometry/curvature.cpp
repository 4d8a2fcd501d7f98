// SPDX-License-Identifier: Apache-2.0
// Computes the curvature of each vertex separately, from the ring of its triangles. Sums are in the
// order of positions and values, so that they do not depend on the order of vertices.
#include "relief/mesh/curvature.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <numeric>
#include <optional>

#include "geometry/check_triangles.h"
#include "geometry/direction.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "portable_math.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t piece_size = 1 << 14;

/// A triangle seen from one of its corners: the other two vertices, counter-clockwise.
struct Spoke {
    std::uint32_t next, last;

    friend auto operator<=>(const Spoke&, const Spoke&) = default;
};

/// The triangles around every vertex.
class Rings {
  public:
    explicit Rings(std::span<const glm::uvec3> triangles, std::size_t vertex_count)
        : first_(vertex_count + 1) {
        for (const glm::uvec3& triangle : triangles) {
            if (is_collapsed(triangle)) continue;
            for (int corner = 0; corner < 3; ++corner)
                ++first_[triangle[corner] + 1];
        }
        for (std::size_t i = 0; i < vertex_count; ++i)
            first_[i + 1] += first_[i];
        spokes_.resize(first_.back());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (const glm::uvec3& triangle : triangles) {
            if (is_collapsed(triangle)) continue;
            for (int corner = 0; corner < 3; ++corner) {
                spokes_[next[triangle[corner]]++] = {triangle[(corner + 1) % 3],
                                                     triangle[(corner + 2) % 3]};
            }
        }
    }

    static bool is_collapsed(const glm::uvec3& triangle) {
        return triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x;
    }

    [[nodiscard]] std::span<const Spoke> around(std::size_t vertex) const {
        return std::span(spokes_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    /// Returns the triangles around a vertex, sorted by their vertices.
    [[nodiscard]] std::span<Spoke> sorted(std::size_t vertex) {
        const auto ring =
            std::span(spokes_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
        std::sort(ring.begin(), ring.end());
        return ring;
    }

  private:
    std::vector<std::size_t> first_;
    std::vector<Spoke> spokes_;
};

/// Returns whether the ring is closed: each vertex around ends one triangle and begins another one.
bool is_closed(std::span<const Spoke> sorted, std::vector<std::uint32_t>& ends) {
    ends.clear();
    for (const Spoke& spoke : sorted)
        ends.push_back(spoke.last);
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (sorted[i].next != ends[i] || (i > 0 && ends[i] == ends[i - 1])) return false;
    }
    return true;
}

/// The sums over the triangles at a vertex, with the names of [Meyer et al. 2003].
struct VertexSum {
    glm::dvec3 laplacian{0.0};  ///< Sum of (cot a + cot b)(x_i - x_j), (8) without its area.
    glm::dvec3 normal{0.0};
    double mixed_area = 0.0;

    /// Adds a triangle with an area. `b` and `c` are its other corners relative to the vertex.
    void add(const glm::dvec3& b, const glm::dvec3& c) {
        const glm::dvec3 cross = glm::cross(b, c);
        const double area2 = glm::length(cross);
        const double dot_a = glm::dot(b, c);
        const double dot_b = glm::dot(-b, c - b);
        const double dot_c = glm::dot(-c, b - c);
        laplacian -= dot_c / area2 * b + dot_b / area2 * c;
        normal += portable::atan2(area2, dot_a) / area2 * cross;
        if (dot_a < 0.0)
            mixed_area += area2 / 4.0;
        else if (dot_b < 0.0 || dot_c < 0.0)
            mixed_area += area2 / 8.0;
        else
            mixed_area += (glm::dot(b, b) * dot_c + glm::dot(c, c) * dot_b) / (8.0 * area2);
    }

    [[nodiscard]] double mean_curvature() const {
        return 0.25 * glm::dot(laplacian, direction_or_zero(normal)) / mixed_area;
    }
};

bool has_area(const glm::dvec3& b, const glm::dvec3& c) {
    const double area2 = glm::length(glm::cross(b, c));
    return area2 > 0.0 && std::isfinite(area2);
}

/// Compares positions by their bits, an order that also those that are not finite have.
std::strong_ordering compare_bits(const glm::vec3& a, const glm::vec3& b) {
    for (int i = 0; i < 3; ++i) {
        const auto order =
            std::bit_cast<std::uint32_t>(a[i] + 0.0F) <=> std::bit_cast<std::uint32_t>(b[i] + 0.0F);
        if (order != 0) return order;
    }
    return std::strong_ordering::equal;
}

/// Sorts spokes by the positions of their vertices.
void sort_by_position(std::span<const glm::vec3> positions, std::span<Spoke> ring) {
    std::sort(ring.begin(), ring.end(), [&](const Spoke& a, const Spoke& b) {
        const auto order = compare_bits(positions[a.next], positions[b.next]);
        if (order != 0) return order < 0;
        return compare_bits(positions[a.last], positions[b.last]) < 0;
    });
}

/// Returns the curvature, or none if it is undefined. Sorts the ring by position.
std::optional<double> curvature_at(std::span<const glm::vec3> positions, std::size_t vertex,
                                   std::span<Spoke> ring) {
    VertexSum sum;
    const glm::dvec3 here(positions[vertex]);
    sort_by_position(positions, ring);
    for (const Spoke& spoke : ring) {
        const glm::dvec3 b = glm::dvec3(positions[spoke.next]) - here;
        const glm::dvec3 c = glm::dvec3(positions[spoke.last]) - here;
        if (has_area(b, c)) sum.add(b, c);
    }
    const double result = sum.mean_curvature();
    if (!std::isfinite(static_cast<float>(result))) return std::nullopt;
    return result;
}

enum class RingKind : std::uint8_t { none, closed, open };

/// Returns the mean of the adjacent vertices with closed rings.
std::optional<double> mean_around(std::span<const Spoke> sorted, const std::vector<RingKind>& kinds,
                                  const std::vector<float>& values,
                                  std::vector<std::uint32_t>& around) {
    around.clear();
    for (const Spoke& spoke : sorted)
        around.insert(around.end(), {spoke.next, spoke.last});
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    std::vector<float> regular;
    for (const std::uint32_t vertex : around) {
        if (kinds[vertex] == RingKind::closed) regular.push_back(values[vertex]);
    }
    if (regular.empty()) return std::nullopt;
    std::sort(regular.begin(), regular.end());
    return std::accumulate(regular.begin(), regular.end(), 0.0) /
           static_cast<double>(regular.size());
}

void count_flat_triangles(std::span<const glm::vec3> positions,
                          std::span<const glm::uvec3> triangles, Report& report) {
    parallel_for_reporting(triangles.size(), piece_size, report,
                           [&](std::size_t begin, std::size_t end, Report& found) {
                               for (std::size_t i = begin; i < end; ++i) {
                                   const glm::dvec3 a(positions[triangles[i].x]);
                                   if (has_area(glm::dvec3(positions[triangles[i].y]) - a,
                                                glm::dvec3(positions[triangles[i].z]) - a))
                                       continue;
                                   found.add("triangle without area under curvature", "triangle", i,
                                             "does not contribute");
                               }
                           });
}

}  // namespace

std::vector<float> mean_curvatures(std::span<const glm::vec3> positions,
                                   std::span<const glm::uvec3> triangles, Report& report) {
    check_triangles(triangles, positions.size());
    count_flat_triangles(positions, triangles, report);
    const std::vector<std::uint32_t> welded = weld_positions(positions);
    Rings rings(welded_triangles(triangles, welded), positions.size());
    std::vector<float> values(positions.size(), 0.0F);
    std::vector<RingKind> kinds(positions.size(), RingKind::none);
    const auto each = [&](const auto& work) {
        parallel_for_reporting(positions.size(), piece_size, report,
                               [&](std::size_t begin, std::size_t end, Report& found) {
                                   std::vector<std::uint32_t> scratch;
                                   for (std::size_t i = begin; i < end; ++i) {
                                       if (!rings.around(i).empty()) work(i, scratch, found);
                                   }
                               });
    };
    each([&](std::size_t i, std::vector<std::uint32_t>& scratch, Report& found) {
        const std::span<Spoke> ring = rings.sorted(i);
        kinds[i] = is_closed(ring, scratch) ? RingKind::closed : RingKind::open;
        if (kinds[i] == RingKind::open) return;
        const std::optional<double> value = curvature_at(positions, i, ring);
        values[i] = static_cast<float>(value.value_or(0.0));
        if (!value) found.add("vertex without a curvature", "vertex", i, "has 0");
    });
    each([&](std::size_t i, std::vector<std::uint32_t>& scratch, Report& found) {
        if (kinds[i] != RingKind::open) return;
        const auto value = mean_around(rings.around(i), kinds, values, scratch);
        values[i] = static_cast<float>(value.value_or(0.0));
        found.add("vertex on an open or non-manifold edge", "vertex", i,
                  "gets the mean curvature of its regular neighbors, or 0");
    });
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = values[welded[i]];
    return values;
}

}  // namespace relief
