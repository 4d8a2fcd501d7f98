// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sums of the weighted normals of all triangles at every vertex, and unit normals rounded from
/// them.
///
/// Triangles are added in any order, on several threads, with any vector instructions. Each sum has
/// a bound on its rounding error. Where the bound leaves no doubt how the normal rounds, no other
/// order could round it differently. The remaining vertices, one in 10,000 or fewer on usual
/// meshes, are summed again in higher precision (normals.cpp). Unit vectors are rounded to
/// multiples of 2^-28 and then to float, so all normals have the bits of exact arithmetic. The
/// method is Ziv's for elementary functions [Ziv 1991].
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/gather.h"
#include "relief/mesh/buffers.h"
#include "relief/mesh/normals.h"
#include "work_array.h"

namespace relief::detail {
/// Sum of contributions at one vertex, as wide as one vector register.
struct alignas(32) WeightedNormalSum {
    double x, y, z;
    /// Sum of factor times edge product, the unit of the rounding error.
    double edge_product;
};

/// A triangle is degenerate if its width divided by its longest edge is below this ratio. The
/// rounding of the cross product (1e-16) could rotate the normal of a narrower triangle by more
/// than 0.01 degrees.
constexpr double min_triangle_width = 1e-12;

enum class TriangleKind : std::uint8_t { sound, degenerate, non_finite };

/// Classifies a triangle. The result does not depend on the first corner.
TriangleKind kind_of(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Returns the unit normal of a valid triangle, otherwise zero. The result does not depend on the
/// first corner.
glm::vec3 triangle_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Unit normals of all triangles, zero for triangles that are not valid.
std::vector<glm::vec3> normals_or_zero(StridedSpan<const glm::vec3> positions,
                                       TriangleSpan triangles);

/// Returns the power of two that scales the edges of a mesh to about 1, for float arithmetic.
float scale_for(StridedSpan<const glm::vec3> positions);

/// Number of triangles per block: small enough for all data of a block to stay in the first-level
/// cache.
constexpr std::size_t triangles_at_once = 128;

/// Contributions of a range of triangles at the vertices from the lowest to the highest that they
/// name. Memory of other vertices is never written.
class PartialSums {
  public:
    explicit PartialSums(std::size_t vertex_count);

    WeightedNormalSum* sums() { return sums_.data(); }
    /// Number of contributions at each vertex; 255 means 255 or more.
    std::uint8_t* counts() { return counts_.data(); }
    [[nodiscard]] const WeightedNormalSum* sums() const { return sums_.data(); }
    [[nodiscard]] const std::uint8_t* counts() const { return counts_.data(); }

    /// 1 for each block of vertices whose normals were rounded from these sums alone.
    std::uint8_t* rounded() { return rounded_.data(); }
    [[nodiscard]] const std::uint8_t* rounded() const { return rounded_.data(); }
    /// The vertices that have sums; empty if there is no triangle.
    [[nodiscard]] const VertexRange& vertices() const { return vertices_; }
    /// Sets the sums of vertices that have none yet to zero. On usual meshes, where triangles
    /// follow the order of vertices, they are then still in the cache when the first triangle is
    /// added.
    void extend_to(const VertexRange& range);

  private:
    void clear(std::size_t begin, std::size_t end);

    WorkArray<WeightedNormalSum> sums_;
    WorkArray<std::uint8_t> counts_;
    WorkArray<std::uint8_t> rounded_;
    VertexRange vertices_{1, 0};
};

struct NormalSums {
    std::vector<PartialSums> parts;       ///< Partial sums that are added.
    std::vector<std::uint32_t> doubtful;  ///< The uncertain ones of vertices that were rounded.
    /// Vertex range of each block of `triangles_at_once` triangles.
    std::vector<VertexRange> ranges;
    /// Triangles that were processed one by one: all that are not valid, and narrow valid ones.
    std::vector<std::uint32_t> odd;
};

/// Sums the contributions, and already computes the normals of most vertices whose sums are
/// complete, while these are in the cache.
///
/// \throws InvalidInput if a triangle names a vertex that does not exist
NormalSums sum_contributions(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                             NormalWeight weight, Arithmetic arithmetic,
                             StridedSpan<glm::vec3> normals);

/// Grid steps per unit to which unit vectors are rounded. The error is at most 1.9e-9, a sixteenth
/// of the spacing of floats next to 1.
constexpr double normal_grid = 268435456.0;

/// Rounds a unit vector to the grid and to float. -0 becomes +0.
glm::vec3 on_grid(double x, double y, double z);

/// Computes the normals of all other vertices. \return the vertices whose rounding is uncertain or
/// that have no normal, ascending
std::vector<std::uint32_t> round_normals(const NormalSums& sums, StridedSpan<glm::vec3> normals);

/// Computes the normals of groups of vertices that share a normal. Group i is `members` from
/// first[i] up to first[i + 1]. \return the groups whose rounding is uncertain or that have no
/// normal, ascending
std::vector<std::uint32_t> round_shared_normals(const NormalSums& sums,
                                                std::span<const std::uint32_t> first,
                                                std::span<const std::uint32_t> members,
                                                StridedSpan<glm::vec3> normals);

}  // namespace relief::detail
