// SPDX-License-Identifier: Apache-2.0
// Moves vertices to where they fit the input best, within the neighborhood of its surface. Tests:
// tests/mesh/topology/decimate_test.cpp.
#include "topology/collapse_fit.h"

#include <algorithm>
#include <utility>

#include "portable_math.h"
#include "topology/touched_surface.h"

namespace relief::detail {
namespace {

/// The maximum rotation of a triangle in one move: 45 degrees.
constexpr double min_fit_cosine = 0.7071067811865476;

/// The move of a vertex to where it fits the input.
struct FitMove {
    std::uint32_t vertex = no_corner;
    glm::dvec3 offset{0.0};  ///< In the unit of the points.
};

/// Returns whether a vertex can be at another position: no triangle turns over or leaves the
/// normals of the input. The vertex is there afterwards.
bool may_be_at(const FittedSurface& fitted, std::uint32_t vertex, const Ring& ring,
               const glm::vec3& position) {
    CollapseInput& input = fitted.input;
    const glm::dvec3 before = input.point(vertex);
    input.positions[vertex] = position;
    const glm::dvec3 after = input.point(vertex);
    for (std::size_t i = 0; i < ring.size; ++i) {
        const std::uint32_t vb = fitted.surface[next_in_triangle(ring.corners[i])].vertex;
        const std::uint32_t vc = fitted.surface[previous_in_triangle(ring.corners[i])].vertex;
        const glm::dvec3 b = input.point(vb);
        const glm::dvec3 c = input.point(vc);
        const glm::dvec3 cross_before = glm::cross(b - before, c - before);
        const glm::dvec3 cross_after = glm::cross(b - after, c - after);
        const double lengths = glm::length(cross_before) * glm::length(cross_after);
        if (!(glm::dot(cross_before, cross_after) > min_fit_cosine * lengths)) return false;
        if (!fitted.normals.is_near(cross_after, vertex, vb, vc)) return false;
    }
    return true;
}

/// Shortens the moves to positions that are far from the surface of the input. The planes around a
/// vertex can meet there, but the surface ends before: beside a step, a spike would result.
void shorten_far_moves(const FittedSurface& fitted, std::vector<FitMove>& fits) {
    // Convex surfaces need 1.3 distances of planes. A vertex of the input lies on its surface, so
    // short moves are within the limit.
    constexpr double max_distances = 1.5;
    constexpr double rounding = 1e-6;
    constexpr double max_deviations = 1.0;
    CollapseInput& input = fitted.input;
    std::vector<std::size_t> long_moves;
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < fits.size(); ++i) {
        const FitMove& fit = fits[i];
        double limit = max_distances * fitted.error.plane_distance(fit.vertex);
        if (fitted.deviation) limit = std::min(limit, max_deviations * fitted.deviation->allowed());
        limit = std::max(limit, rounding);
        if (!(glm::dot(fit.offset, fit.offset) > limit * limit)) continue;
        long_moves.push_back(i);
        balls.push_back({input.point(fit.vertex) + fit.offset, limit});
    }
    std::swap(input.positions, fitted.original_positions);
    const std::vector<bool> touch = touch_surface(balls, input);
    std::swap(input.positions, fitted.original_positions);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        glm::dvec3& offset = fits[long_moves[i]].offset;
        if (!touch[i]) offset *= balls[i].radius / glm::length(offset);
    }
}

}  // namespace

std::size_t fit_positions(const FittedSurface& fitted, std::span<const std::uint32_t> vertices,
                          const std::function<bool(std::uint32_t, const Ring&)>& may_move) {
    CollapseInput& input = fitted.input;
    std::size_t examined = 0;
    Ring ring;
    std::vector<FitMove> fits;
    for (const std::uint32_t v : vertices) {
        if (fitted.surface.is_removed(v) || (!input.is_fixed.empty() && input.is_fixed[v]))
            continue;
        const bool is_small = fitted.surface.find_ring(v, ring);
        examined += ring.size;
        if (!is_small || ring.has_border || !may_move(v, ring)) continue;
        const glm::dvec3 offset = fitted.error.fitted_offset(v, ring);
        if (offset != glm::dvec3(0.0)) fits.push_back({v, offset});
    }
    shorten_far_moves(fitted, fits);
    for (const FitMove& fit : fits) {
        const glm::vec3 before = input.positions[fit.vertex];
        const glm::dvec3 point = input.point(fit.vertex) + fit.offset;
        const glm::vec3 after(input.center + point / input.scale);
        if (after == before || !is_finite(after) || !fitted.surface.find_ring(fit.vertex, ring))
            continue;
        if (!may_be_at(fitted, fit.vertex, ring, after)) input.positions[fit.vertex] = before;
    }
    return examined;
}

std::vector<std::size_t> fitted_counts(std::size_t triangles, std::size_t target) {
    std::vector<std::size_t> counts;
    std::size_t before = triangles;
    for (const std::size_t tenths : {60U, 35U, 20U, 14U}) {
        const std::size_t count = tenths * target / 10;
        // A smaller step is not worth its time.
        if (before < count + count / 4) continue;
        counts.push_back(count);
        before = count;
    }
    return counts;
}

}  // namespace relief::detail
