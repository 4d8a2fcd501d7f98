// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "hard_cases/mesh_case.h"
#include "hard_cases/mesh_cases.h"
#include "hard_cases/sample_meshes.h"

namespace relief::test {
namespace {

Mesh with_triangle(Mesh mesh, const glm::uvec3& triangle) {
    mesh.triangles.push_back(triangle);
    return mesh;
}

Mesh with_vertex(Mesh mesh, const glm::vec3& position) {
    mesh.positions.push_back(position);
    return mesh;
}

/// Of vertices that belong to the square or grid in the xy plane.
TrueNormal up_at_first(std::size_t count) {
    return [count](const Mesh&, std::size_t vertex) -> std::optional<glm::dvec3> {
        if (vertex >= count) return std::nullopt;
        return glm::dvec3(0, 0, 1);
    };
}

/// A triangle of length 1 and width 1e-6, turned about its length by half a radian.
Mesh needle() {
    const float width = 1e-6F;
    return mesh_of({{0, 0, 0}, {1, 0, 0}, {0.5F, width * std::cos(0.5F), width * std::sin(0.5F)}},
                   {{0, 1, 2}});
}

/// Two edges along (1,2,3), apart by one unit in the last place of 6 at the end of the longer.
Mesh parallel_edges() {
    return mesh_of({{0, 0, 0}, {1, 2, 3}, {2, 4, std::nextafter(6.0F, 7.0F)}}, {{0, 1, 2}});
}

}  // namespace

std::vector<HardCase> triangle_cases() {
    using enum MeshCondition;
    return {
        MeshCase("triangle with a repeated index",
                 "A square and a triangle that names one vertex twice.", "trimesh#522",
                 [] {
                     return with_triangle(square(), {0, 1, 1});
                 })
            .checked({{triangle_collapsed, 1}, {edge_boundary, 4}})
            .normals({{"degenerate triangle", 1}})
            .accurate(all_weights(), 0, "the square's", up_at_first(4))
            .tangents({{"triangle with coinciding corners", 1}}),
        MeshCase("triangle on a line",
                 "A triangle whose three corners are on a line, on the side of another.",
                 "libigl#791, libigl#1923",
                 [] {
                     return mesh_of({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                                    {{0, 1, 2}, {0, 3, 1}});
                 })
            .checked({{triangle_collinear, 1}, {edge_boundary, 4}, {vertex_degenerate_fan, 1}})
            .normals({{"degenerate triangle", 1}, {"vertex with only degenerate triangles", 1}})
            .accurate(all_weights(), 0, "the sound triangle's", up_at_first(3))
            .tangents({{"corner without texture direction", 1},
                       {"triangle without texture gradient", 1}}),
        MeshCase(
            "vertex with only degenerate triangles",
            "A square and a vertex that only a collapsed triangle uses; its normal is (0,0,1).",
            "trimesh#522",
            [] {
                return with_triangle(with_vertex(square(), {3, 3, 3}), {0, 4, 4});
            })
            .checked({{triangle_collapsed, 1}, {edge_boundary, 4}, {vertex_degenerate_fan, 1}})
            .normals({{"degenerate triangle", 1}, {"vertex with only degenerate triangles", 1}})
            .accurate(all_weights(), 0, "(0,0,1)", up_at_first(5))
            .tangents(
                {{"corner without texture direction", 2}, {"triangle with coinciding corners", 1}}),
        MeshCase("isolated vertex",
                 "A square and a vertex that no triangle uses; its normal is (0,0,1).",
                 "CGAL PR#847",
                 [] {
                     return with_vertex(square(), {3, 3, 3});
                 })
            .checked({{edge_boundary, 4}, {vertex_isolated, 1}})
            .normals({{"isolated vertex", 1}})
            .accurate(all_weights(), 0, "(0,0,1)", up_at_first(5))
            .tangents(),
        MeshCase("needle", "A triangle of length 1 and width 1e-6, turned about its length.",
                 "6.6 degrees off in float, measured", needle)
            .checked({{triangle_needle, 1}, {edge_boundary, 3}})
            .normals()
            .accurate(all_weights(), 1e-4, "the true normal",
                      [](const Mesh&, std::size_t) -> std::optional<glm::dvec3> {
                          return glm::dvec3(0, -std::sin(0.5), std::cos(0.5));
                      })
            .tangents(),
        MeshCase("edges all but parallel",
                 "A triangle between two edges whose directions differ by less than a float can "
                 "hold: an arc cosine of their product would have an argument above 1.",
                 "rgl#372", parallel_edges)
            .checked({{triangle_needle, 1}, {edge_boundary, 3}})
            .normals()
            .accurate(all_weights(), 1e-4, "the true normal",
                      [](const Mesh&, std::size_t) -> std::optional<glm::dvec3> {
                          return glm::dvec3(2, -1, 0);
                      })
            .tangents({{"corner without texture direction", 3},
                       {"triangle without texture gradient", 1}}),
        MeshCase("repeated triangle",
                 "A square with one of its triangles three times over, begun at different corners.",
                 "three copies of a face in assets exported twice",
                 [] {
                     return with_triangle(with_triangle(square(), {1, 2, 0}), {2, 0, 1});
                 })
            .checked({{triangle_repeated, 2}, {edge_boundary, 4}})
            .normals()
            .accurate(all_weights(), 0, "the square's", up_at_first(4))
            .tangents({{"repeated triangle", 2}}),
    };
}

}  // namespace relief::test
