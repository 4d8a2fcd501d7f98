// SPDX-License-Identifier: Apache-2.0
// The public calls: averages with their report, and normals of single triangles. Object space, any
// unit of length. Tests: tests/mesh/geometry/normals/normals_test.cpp.
#include "relief/mesh/normals.h"

#include "geometry/check_triangles.h"
#include "geometry/normals/averaged_normals.h"
#include "geometry/normals/normal_sums.h"

namespace relief {
namespace {

void report_all(const AveragedNormals& averaged, std::span<const glm::vec3> positions,
                std::span<const glm::uvec3> triangles, Report& report) {
    report_triangles(positions, triangles, averaged.odd_triangles,
                     "has no say in its vertices' normals", report);
    for (const auto& [vertex, kind] : averaged.troubles)
        report_vertex(kind, vertex, report);
}

}  // namespace

std::vector<glm::vec3> vertex_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles,
                                      const NormalOptions& options, Report& report) {
    AveragedNormals averaged =
        averaged_normals(positions, triangles, options.weight, options.arithmetic,
                         [&] { return sharing_vertices(positions, options.weld_tolerance); });
    report_all(averaged, positions, triangles, report);
    return std::move(averaged.normals);
}

std::vector<glm::vec3> vertex_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles, NormalWeight weight,
                                      Report& report) {
    NormalOptions options;
    options.weight = weight;
    return vertex_normals(positions, triangles, options, report);
}

ChosenNormals chosen_normals(std::span<const glm::vec3> positions,
                             std::span<const glm::uvec3> triangles, const NormalOptions& options,
                             Report& report) {
    AveragedNormals averaged =
        averaged_normals_by_choice(positions, triangles, options.arithmetic,
                                   sharing_vertices(positions, options.weld_tolerance));
    report_all(averaged, positions, triangles, report);
    return {std::move(averaged.normals), averaged.by_area};
}

std::vector<glm::vec3> triangle_normals(std::span<const glm::vec3> positions,
                                        std::span<const glm::uvec3> triangles, Report& report) {
    check_triangles(triangles, positions.size());
    std::vector<glm::vec3> normals = normals_or_zero(positions, triangles);
    std::vector<std::uint32_t> odd;
    for (std::size_t t = 0; t < normals.size(); ++t) {
        if (normals[t] != glm::vec3(0.0F)) continue;
        odd.push_back(static_cast<std::uint32_t>(t));
        normals[t] = fallback_normal;
    }
    report_triangles(positions, triangles, odd, "gets the normal (0,0,1)", report);
    return normals;
}

}  // namespace relief
