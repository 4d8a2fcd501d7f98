// SPDX-License-Identifier: Apache-2.0
/// \file
/// The votes of all triangles (normal_votes.h) summed at every vertex, in any order, with a bound
/// on how far rounding may have taken each sum from the true one.
///
/// That bound is what makes order free: where it leaves no doubt how the normal rounds
/// (normal_rounding.h), no other order could have rounded it differently; where it does not,
/// exact_normals.cpp sums again in higher precision. So triangles are taken as they come, on
/// several threads, with whatever vector instructions there are.
/// Tests: tests/mesh/geometry/normals/normals_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "relief/mesh/normals.h"

namespace relief {

/// Votes at one vertex. A vector register wide, so that one addition does it all.
struct alignas(32) NormalVoteSum {
    double x = 0.0, y = 0.0, z = 0.0;
    double edge_product = 0.0;  ///< Sum of factor times edge product: rounding is in units of this.
};

/// A triangle is degenerate if it is narrower than this part of its longest edge: rounding of the
/// cross product (1e-16) could turn the normal of a narrower one by more than 0.01 degrees.
constexpr double least_triangle_width = 1e-12;

enum class TriangleKind : std::uint8_t { sound, degenerate, non_finite };

/// What kind a triangle is; the same whichever corner it begins with.
TriangleKind kind_of(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Unit normal of a triangle that is sound, else zero; the same whichever corner it begins with.
glm::vec3 triangle_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// The same for all triangles.
std::vector<glm::vec3> normals_or_zero(std::span<const glm::vec3> positions,
                                       std::span<const glm::uvec3> triangles);

/// A power of two that makes the edges of a mesh about 1, for arithmetic in float.
float scale_for(std::span<const glm::vec3> positions);

/// As many triangles as are done at once: small enough for everything about them to stay in the
/// first cache.
constexpr std::size_t triangles_at_once = 128;

/// The smallest and largest vertex that `triangles_at_once` triangles name.
struct VertexRange {
    std::uint32_t lowest;
    std::uint32_t highest;
};

/// Votes of a run of triangles, at all vertices. Memory that no triangle touches stays untouched.
class PartialSums {
  public:
    explicit PartialSums(std::size_t vertex_count);

    NormalVoteSum* sums() { return sums_; }
    std::uint8_t* counts() { return counts_; }
    [[nodiscard]] const NormalVoteSum* sums() const { return sums_; }
    [[nodiscard]] const std::uint8_t* counts() const { return counts_; }

    VertexRange touched{1, 0};  ///< Empty: no triangle.

  private:
    struct Free {
        void operator()(void* memory) const { std::free(memory); }
    };
    std::unique_ptr<void, Free> memory_;
    NormalVoteSum* sums_;
    /// How many votes there are at each vertex, 255 for that many or more.
    std::uint8_t* counts_;
};

struct NormalSums {
    std::vector<PartialSums> parts;   ///< To be added up.
    std::vector<VertexRange> ranges;  ///< Of each `triangles_at_once` triangles.
    /// Triangles that were looked at one by one: all that are not sound, and narrow ones that are.
    std::vector<std::uint32_t> odd;
};

/// \throws InvalidInput if a triangle names a vertex that does not exist
NormalSums sum_votes(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                     NormalWeight weight, Arithmetic arithmetic);

}  // namespace relief
