// SPDX-License-Identifier: Apache-2.0
// Normals of vertices and triangles. Object space, any unit of length; edges and sums in double.
//
// Every vertex gathers from the triangles around all vertices of its position class (weld.h) and
// adds their votes in an order fixed by the votes themselves. Sources: [Gouraud 1971] (averaging),
// [Thürmer and Wüthrich 1998] (angle weights). Degenerate and non-finite triangles have no vote; a
// vertex without a direction gets (0,0,1); each is counted.
// Tests: tests/mesh/geometry/normals_test.cpp.
#include "relief/mesh/normals.h"

#include <array>

#include "geometry/check_triangles.h"
#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/weld.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr glm::vec3 fallback_normal{0.0F, 0.0F, 1.0F};

// A triangle narrower than this part of its longest edge has no normal: rounding in the cross
// product (1e-16) could turn the normal of a narrower one by more than 0.01 degrees.
constexpr double least_width = 1e-12;

// Votes that cancel to less than this leave only rounding: float positions cannot hold an angle
// that would leave so little, while a million votes in double err by 1e-10 together.
constexpr double cancelled = 1e-9;

constexpr std::size_t grain = 4096;

enum class Trouble : std::uint8_t { none, degenerate, non_finite, isolated, voiceless, cancelling };

/// Normals or votes, and what is wrong with each.
struct Judged {
    std::vector<glm::dvec3> vectors;
    std::vector<Trouble> troubles;

    explicit Judged(std::size_t count) : vectors(count), troubles(count, Trouble::none) {}
};

/// The corners of a triangle, beginning with the vertex of the smallest class: the same for every
/// rotation of the triangle.
std::array<glm::dvec3, 3> canonical_corners(std::span<const glm::vec3> positions,
                                            const glm::uvec3& triangle) {
    int first = 0;
    for (int i = 1; i < 3; ++i) {
        if (triangle[i] < triangle[first]) first = i;
    }
    return {glm::dvec3(positions[triangle[first]]),
            glm::dvec3(positions[triangle[(first + 1) % 3]]),
            glm::dvec3(positions[triangle[(first + 2) % 3]])};
}

/// Twice the area along the normal; zero and the reason if there is none.
Trouble judge_triangle(const std::array<glm::dvec3, 3>& corners, glm::dvec3& area_vector) {
    const glm::dvec3 a = corners[1] - corners[0];
    const glm::dvec3 b = corners[2] - corners[0];
    const glm::dvec3 c = corners[2] - corners[1];
    area_vector = glm::cross(a, b);
    if (!is_finite(corners[0]) || !is_finite(corners[1]) || !is_finite(corners[2])) {
        area_vector = glm::dvec3(0.0);
        return Trouble::non_finite;
    }
    const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
    if (glm::length(area_vector) > least_width * longest) return Trouble::none;
    area_vector = glm::dvec3(0.0);
    return Trouble::degenerate;
}

/// Area vectors, or unit normals, of all triangles; zero where there is none.
Judged judge_triangles(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                       bool unit) {
    Judged judged(triangles.size());
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            glm::dvec3& vector = judged.vectors[t];
            judged.troubles[t] = judge_triangle(canonical_corners(positions, triangles[t]), vector);
            if (unit) vector = direction_or_zero(vector);
        }
    });
    return judged;
}

void report_triangles(const Judged& judged, Report& report, std::string_view outcome) {
    for (std::size_t t = 0; t < judged.troubles.size(); ++t) {
        const Trouble trouble = judged.troubles[t];
        if (trouble == Trouble::none) continue;
        report.add(trouble == Trouble::degenerate ? "degenerate triangle"
                                                  : "triangle with a non-finite corner",
                   "triangle", t, outcome);
    }
}

/// The angle that the triangle takes up at this corner.
double corner_angle(Corner corner, std::span<const glm::vec3> positions,
                    std::span<const glm::uvec3> triangles) {
    const glm::dvec3 here(positions[vertex_of(corner, triangles)]);
    const glm::dvec3 next(positions[vertex_of(next_in_triangle(corner), triangles)]);
    const glm::dvec3 previous(positions[vertex_of(previous_in_triangle(corner), triangles)]);
    return angle_between(next - here, previous - here);
}

/// The normal at one position class from the triangles around it.
Trouble gather(std::span<const Corner> around, std::span<const glm::vec3> positions,
               std::span<const glm::uvec3> triangles, const Judged& votes, NormalWeight weight,
               std::vector<glm::dvec3>& terms, glm::dvec3& normal) {
    terms.clear();
    for (const Corner corner : around) {
        const std::uint32_t triangle = triangle_of(corner);
        if (votes.troubles[triangle] != Trouble::none) continue;
        const double factor =
            weight == NormalWeight::angle ? corner_angle(corner, positions, triangles) : 1.0;
        terms.push_back(factor * votes.vectors[triangle]);
    }
    if (terms.empty()) return around.empty() ? Trouble::isolated : Trouble::voiceless;
    const StableSum sum = stable_sum(terms);
    if (sum.cancels(cancelled)) return Trouble::cancelling;
    normal = direction_or_zero(sum.vector);
    return Trouble::none;
}

/// Normals of all position classes, at the index of their representative.
Judged judge_classes(std::span<const glm::vec3> positions, std::span<const std::uint32_t> classes,
                     std::span<const glm::uvec3> triangles, const Judged& votes,
                     NormalWeight weight) {
    Judged judged(positions.size());
    const CornersByVertex corners(positions.size(), triangles);
    parallel_for(positions.size(), grain, [&](std::size_t begin, std::size_t end) {
        std::vector<glm::dvec3> terms;
        for (std::size_t v = begin; v < end; ++v) {
            if (classes[v] != v) continue;
            judged.troubles[v] = !is_finite(positions[v])
                                     ? Trouble::non_finite
                                     : gather(corners.at(v), positions, triangles, votes, weight,
                                              terms, judged.vectors[v]);
        }
    });
    return judged;
}

void report_vertex(Trouble trouble, std::size_t vertex, Report& report) {
    static constexpr std::string_view outcome = "gets the normal (0,0,1)";
    switch (trouble) {
        case Trouble::isolated:
            report.add("isolated vertex", "vertex", vertex, outcome);
            break;
        case Trouble::cancelling:
            report.add("cancelling normals", "vertex", vertex, outcome);
            break;
        case Trouble::non_finite:
            report.add("non-finite position", "vertex", vertex, outcome);
            break;
        case Trouble::none:
            break;
        case Trouble::degenerate:
        case Trouble::voiceless:
            report.add("vertex with only degenerate triangles", "vertex", vertex, outcome);
            break;
    }
}

}  // namespace

std::vector<glm::vec3> vertex_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles, NormalWeight weight,
                                      Report& report) {
    check_triangles(triangles, positions.size());
    const std::vector<std::uint32_t> classes = weld_positions(positions);
    const std::vector<glm::uvec3> welded = welded_triangles(triangles, classes);
    const Judged votes = judge_triangles(positions, welded, weight == NormalWeight::angle);
    const Judged judged = judge_classes(positions, classes, welded, votes, weight);

    report_triangles(votes, report, "has no say in its vertices' normals");
    std::vector<glm::vec3> normals(positions.size(), fallback_normal);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Trouble trouble = judged.troubles[classes[v]];
        if (trouble == Trouble::none) normals[v] = rounded(judged.vectors[classes[v]]);
        report_vertex(trouble, v, report);
    }
    return normals;
}

std::vector<glm::vec3> triangle_normals(std::span<const glm::vec3> positions,
                                        std::span<const glm::uvec3> triangles, Report& report) {
    check_triangles(triangles, positions.size());
    const Judged judged = judge_triangles(positions, triangles, true);
    report_triangles(judged, report, "gets the normal (0,0,1)");
    std::vector<glm::vec3> normals(triangles.size(), fallback_normal);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (judged.troubles[t] == Trouble::none) normals[t] = rounded(judged.vectors[t]);
    }
    return normals;
}

}  // namespace relief
