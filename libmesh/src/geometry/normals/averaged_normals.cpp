// SPDX-License-Identifier: Apache-2.0
// Quick sums of votes, rounded where there is no doubt; the rest exactly. Object space, any unit.
// Tests: tests/mesh/geometry/normals/normals_test.cpp.
#include "geometry/normals/averaged_normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "geometry/direction.h"
#include "geometry/normals/normal_rounding.h"
#include "geometry/normals/normal_sums.h"
#include "geometry/weld_near.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::size_t few_triangles = 8192;

/// Places that need a closer look: doubtful vertices that share with none, and doubtful groups.
std::vector<Place> doubtful_places(std::size_t vertex_count,
                                   const std::vector<std::uint32_t>& vertices, const Groups& shared,
                                   const std::vector<std::uint32_t>& groups) {
    std::vector<bool> shares(shared.members.empty() ? 0 : vertex_count, false);
    for (const std::uint32_t member : shared.members)
        shares[member] = true;
    std::vector<Place> places;
    for (const std::uint32_t& vertex : vertices) {
        if (shares.empty() || !shares[vertex]) places.push_back({std::span(&vertex, 1)});
    }
    for (const std::uint32_t group : groups)
        places.push_back({shared.at(group)});
    return places;
}

void take_over(std::span<const Place> places, AveragedNormals& result) {
    for (const Place& place : places) {
        const bool sound = place.kind == PlaceKind::sound;
        for (const std::uint32_t vertex : place.vertices) {
            result.normals[vertex] = sound ? place.normal : fallback_normal;
            if (!sound) result.troubles.emplace_back(vertex, place.kind);
        }
    }
    std::sort(result.troubles.begin(), result.troubles.end());
}

/// Which vertices see a triangle around them from behind or edge-on; 1 at those, after sharing.
std::vector<std::uint8_t> folded_vertices(std::span<const glm::vec3> positions,
                                          std::span<const glm::uvec3> triangles,
                                          const AveragedNormals& averaged, const Groups& shared) {
    std::vector<std::uint8_t> folded(positions.size(), 0);
    parallel_for(triangles.size(), few_triangles, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::uvec3& triangle = triangles[t];
            const glm::dvec3 a(positions[triangle.x]);
            const glm::dvec3 area_vector = glm::cross(glm::dvec3(positions[triangle.y]) - a,
                                                      glm::dvec3(positions[triangle.z]) - a);
            for (int i = 0; i < 3; ++i) {
                const glm::dvec3 normal(averaged.normals[triangle[i]]);
                if (!(glm::dot(area_vector, normal) <= 0.0)) continue;
                // Triangles without a normal have no say.
                if (kind_of(positions[triangle.x], positions[triangle.y], positions[triangle.z]) !=
                    TriangleKind::sound)
                    continue;
                // Several threads may write the same 1 here.
                std::atomic_ref(folded[triangle[i]]).store(1, std::memory_order_relaxed);
            }
        }
    });
    for (std::size_t g = 0; g < shared.count(); ++g) {
        std::uint8_t any = 0;
        for (const std::uint32_t member : shared.at(g))
            any |= folded[member];
        for (const std::uint32_t member : shared.at(g))
            folded[member] = any;
    }
    return folded;
}

}  // namespace

Groups sharing_vertices(std::span<const glm::vec3> positions,
                        const std::optional<double>& weld_tolerance) {
    if (!weld_tolerance) return {};
    if (!(*weld_tolerance >= 0.0) || std::isinf(*weld_tolerance)) {
        throw InvalidInput(fmt::format(
            "the weld tolerance is {}, but must be 0 or more, and finite", *weld_tolerance));
    }
    return groups_of(*weld_tolerance > 0.0 ? weld_near_positions(positions, *weld_tolerance)
                                           : weld_positions(positions));
}

AveragedNormals averaged_normals(std::span<const glm::vec3> positions,
                                 std::span<const glm::uvec3> triangles, NormalWeight weight,
                                 Arithmetic arithmetic, const std::function<Groups()>& shared) {
    AveragedNormals result;
    Groups groups;
    NormalSums sums;
    parallel_tasks({[&] { sums = sum_votes(positions, triangles, weight, arithmetic); },
                    [&] { groups = shared(); }},
                   triangles.size() < few_triangles);
    result.odd_triangles = std::move(sums.odd);
    result.normals.resize(positions.size());
    const auto vertices = round_normals(sums, result.normals);
    const auto doubtful = round_shared_normals(sums, groups.first, groups.members, result.normals);
    std::vector<Place> places = doubtful_places(positions.size(), vertices, groups, doubtful);
    find_exact_normals(positions, triangles, sums.ranges, weight, arithmetic, places);
    take_over(places, result);
    return result;
}

AveragedNormals averaged_normals_by_choice(std::span<const glm::vec3> positions,
                                           std::span<const glm::uvec3> triangles,
                                           Arithmetic arithmetic, const Groups& shared) {
    const auto sharing = [&] { return shared; };
    AveragedNormals result =
        averaged_normals(positions, triangles, NormalWeight::max, arithmetic, sharing);
    std::vector<std::uint8_t> by_area = folded_vertices(positions, triangles, result, shared);
    for (const auto& [vertex, kind] : result.troubles)
        by_area[vertex] = kind == PlaceKind::cancelling ? 1 : 0;
    result.by_area = static_cast<std::size_t>(std::count(by_area.begin(), by_area.end(), 1));
    if (result.by_area == 0) return result;

    AveragedNormals area =
        averaged_normals(positions, triangles, NormalWeight::area, arithmetic, sharing);
    for (std::size_t v = 0; v < by_area.size(); ++v) {
        if (by_area[v] != 0) result.normals[v] = area.normals[v];
    }
    // Who cancels by area but not by Max's weights was not asked for.
    std::erase_if(area.troubles, [&](const auto& trouble) {
        return trouble.second == PlaceKind::cancelling && by_area[trouble.first] == 0;
    });
    result.troubles = std::move(area.troubles);
    return result;
}

void report_triangles(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                      std::span<const std::uint32_t> odd, std::string_view outcome,
                      Report& report) {
    for (const std::uint32_t t : odd) {
        const glm::uvec3& triangle = triangles[t];
        switch (kind_of(positions[triangle.x], positions[triangle.y], positions[triangle.z])) {
            case TriangleKind::sound:
                break;
            case TriangleKind::degenerate:
                report.add("degenerate triangle", "triangle", t, outcome);
                break;
            case TriangleKind::non_finite:
                report.add("triangle with a non-finite corner", "triangle", t, outcome);
                break;
        }
    }
}

void report_vertex(PlaceKind kind, std::size_t vertex, Report& report) {
    static constexpr std::string_view outcome = "gets the normal (0,0,1)";
    switch (kind) {
        case PlaceKind::sound:
            break;
        case PlaceKind::isolated:
            report.add("isolated vertex", "vertex", vertex, outcome);
            break;
        case PlaceKind::voiceless:
            report.add("vertex with only degenerate triangles", "vertex", vertex, outcome);
            break;
        case PlaceKind::cancelling:
            report.add("cancelling normals", "vertex", vertex, outcome);
            break;
        case PlaceKind::non_finite:
            report.add("non-finite position", "vertex", vertex, outcome);
            break;
    }
}

}  // namespace relief
