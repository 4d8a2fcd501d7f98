// SPDX-License-Identifier: Apache-2.0
// Differences of normals and tangents at matched corners, in degrees, and their summary. Object
// space, directions of any length. Undefined directions give NaN and count as undefined.
#include "relief/mesh/compare.h"

#include <algorithm>
#include <cmath>

#include "geometry/corners.h"
#include "parallel.h"
#include "relief/mesh/error_stats.h"

namespace relief {
namespace {

constexpr float unmatched = -1.0F;
constexpr std::size_t grain = 4096;

/// Equal directions are the common case and need no arc tangent.
float degrees_apart(const glm::vec3& a, const glm::vec3& b) {
    const float length = glm::dot(a, a);
    if (a == b && length > 0.0F && std::isfinite(length)) return 0.0F;
    return static_cast<float>(degrees_between(glm::dvec3(a), glm::dvec3(b)));
}

/// Order: undefined first, then the largest angles; ties: the lower corner.
bool is_worse(const WorstCorner& a, const WorstCorner& b) {
    const auto rank = [](float degrees) { return std::isnan(degrees) ? 1e9F : degrees; };
    if (rank(a.degrees) != rank(b.degrees)) return rank(a.degrees) > rank(b.degrees);
    return a.corner_a < b.corner_a;
}

/// Angles at matched corners, and the largest of them.
std::vector<float> gather(std::span<const float> degrees, const CornerMatch& match,
                          std::size_t first, std::size_t count, std::size_t limit,
                          std::vector<WorstCorner>& worst) {
    std::vector<float> angles;
    for (std::size_t corner = first; corner < first + count; ++corner) {
        const float angle = degrees[corner];
        if (angle < 0.0F) continue;
        angles.push_back(angle);
        if (angle == 0.0F || limit == 0) continue;
        const WorstCorner candidate{static_cast<std::uint32_t>(corner), match.corners[corner],
                                    angle};
        if (worst.size() == limit && !is_worse(candidate, worst.back())) continue;
        worst.insert(std::upper_bound(worst.begin(), worst.end(), candidate, is_worse), candidate);
        if (worst.size() > limit) worst.pop_back();
    }
    return angles;
}

}  // namespace

CornerDifferences corner_differences(const Mesh& a, const Mesh& b, const CornerMatch& match) {
    CornerDifferences result;
    const std::size_t count = match.corners.size();
    const bool has_normals = !a.normals.empty() && !b.normals.empty();
    const bool has_tangents = !a.tangents.empty() && !b.tangents.empty();
    if (has_normals) result.normals.assign(count, unmatched);
    if (has_tangents) {
        result.tangents.assign(count, unmatched);
        result.sign_differs.assign(count, 0);
    }
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t corner = begin; corner < end; ++corner) {
            if (match.corners[corner] == no_corner_matched) continue;
            const std::uint32_t va = vertex_of(static_cast<Corner>(corner), a.triangles);
            const std::uint32_t vb = vertex_of(match.corners[corner], b.triangles);
            if (has_normals) result.normals[corner] = degrees_apart(a.normals[va], b.normals[vb]);
            if (!has_tangents) continue;
            const glm::vec4& ta = a.tangents[va];
            const glm::vec4& tb = b.tangents[vb];
            result.tangents[corner] = degrees_apart(glm::vec3(ta), glm::vec3(tb));
            result.sign_differs[corner] = (ta.w < 0.0F) != (tb.w < 0.0F) ? 1 : 0;
        }
    });
    return result;
}

FrameComparison compared(const CornerDifferences& differences, const CornerMatch& match,
                         std::size_t first_triangle, std::size_t triangle_count,
                         std::size_t worst) {
    FrameComparison result;
    const std::size_t first = 3 * first_triangle;
    const std::size_t count = 3 * triangle_count;
    for (std::size_t corner = first; corner < first + count; ++corner)
        result.corners += match.corners[corner] != no_corner_matched ? 1 : 0;
    if (!differences.normals.empty()) {
        result.normals = angle_distribution(
            gather(differences.normals, match, first, count, worst, result.worst_normals));
    }
    if (!differences.tangents.empty()) {
        result.tangents = angle_distribution(
            gather(differences.tangents, match, first, count, worst, result.worst_tangents));
        for (std::size_t corner = first; corner < first + count; ++corner)
            result.sign_differences += differences.sign_differs[corner];
    }
    return result;
}

}  // namespace relief
