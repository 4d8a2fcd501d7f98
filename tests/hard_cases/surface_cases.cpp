// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "hard_cases/mesh_case.h"
#include "hard_cases/mesh_cases.h"
#include "hard_cases/sample_meshes.h"

namespace relief::test {
namespace {

std::optional<glm::dvec3> up(const Mesh&, std::size_t) {
    return glm::dvec3(0, 0, 1);
}

/// Two triangles on one edge, the second folded back over the first.
Mesh fold_over() {
    return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2F, 0.7F, 0}}, {{0, 1, 2}, {1, 0, 3}});
}

/// A flat grid with a triangle in its middle the wrong way round.
Mesh flipped_triangle() {
    Mesh mesh = flat_grid(4);
    std::swap(mesh.triangles[10].x, mesh.triangles[10].y);
    return mesh;
}

Mesh double_sided_square() {
    Mesh mesh = square();
    mesh.triangles.insert(mesh.triangles.end(), {{2, 1, 0}, {3, 2, 0}});
    return mesh;
}

/// A cone of height 1 with an open base, its tip at vertex 0.
Mesh cone() {
    Mesh mesh = fan(16);
    mesh.positions[0].z = 1.0F;
    return mesh;
}

std::optional<glm::dvec3> cone_axis_at_tip(const Mesh&, std::size_t vertex) {
    if (vertex != 0) return std::nullopt;
    return glm::dvec3(0, 0, 1);
}

/// Three triangles on the edge between vertices 0 and 1.
Mesh three_on_an_edge() {
    return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                   {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
}

/// Two triangles that meet in vertex 0 alone, at right angles.
Mesh bow_tie() {
    return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                   {{0, 1, 2}, {0, 3, 4}});
}

std::optional<glm::dvec3> corner_of_cube(const Mesh& mesh, std::size_t vertex) {
    return glm::dvec3(mesh.positions[vertex]);
}

/// At the common edge of a ramp, half way between its two sides; else the side's own.
std::optional<glm::dvec3> ramp_normal(const Mesh& mesh, std::size_t vertex) {
    const glm::dvec3 flat(0, 0, 1);
    const glm::dvec3 rising = glm::dvec3(-1, 0, 1) / std::sqrt(2.0);
    if (mesh.positions[vertex].z != 0.0F) return rising;
    return mesh.positions[vertex].x < 0.0F ? flat : flat + rising;
}

}  // namespace

std::vector<HardCase> surface_cases() {
    using enum MeshCondition;
    return {
        MeshCase("fold-over",
                 "Two triangles on one edge, the smaller folded back over the larger, both the "
                 "right way round.",
                 "Max's weights fail on it, measured", fold_over)
            .checked({{edge_folded, 1}, {edge_boundary, 4}})
            .normals()
            .accurate({NormalWeight::area}, 0, "the larger triangle's on the common edge",
                      [](const Mesh& mesh, std::size_t vertex) -> std::optional<glm::dvec3> {
                          if (vertex > 1) return std::nullopt;
                          return up(mesh, vertex);
                      }),
        MeshCase("flipped triangle",
                 "A flat grid with one triangle in its middle the wrong way round.",
                 "scans and hand-made meshes", flipped_triangle)
            .checked({{edge_flipped, 3}, {edge_boundary, 16}})
            .normals()
            .accurate(all_weights(), 0, "the grid's", up),
        MeshCase("double-sided sheet",
                 "A square with a back on the same vertices: its normals cancel, and are (0,0,1).",
                 "leaves and cloth in games", double_sided_square)
            .checked({{triangle_backed, 4}})
            .normals({{"cancelling normals", 4}})
            .accurate(all_weights(), 0, "(0,0,1)", up),
        MeshCase("tip of a cone",
                 "A cone with an open base; no normal at its tip suits every side.",
                 "bevy PR#10905", cone)
            .checked({{edge_boundary, 16}})
            .normals()
            .accurate(all_weights(), 1e-5, "the axis at the tip", cone_axis_at_tip),
        MeshCase("cube with an uneven triangulation",
                 "Eight vertices; some corners have three triangles, some four or more.",
                 "CGAL#2047", uneven_cube)
            .checked({})
            .normals()
            .accurate({NormalWeight::angle}, 1e-5, "the diagonals of the cube", corner_of_cube),
        MeshCase("flat fan of 10000 triangles", "So many triangles around one vertex, in a plane.",
                 "CGAL PR#8684", [] { return fan(10000); })
            .checked({{edge_boundary, 10000}})
            .normals()
            .accurate(all_weights(), 0, "the plane's", up),
        MeshCase("edge of three triangles",
                 "Three triangles on one edge, so that there is no inside and outside.",
                 "pairs of corners that depend on order in MikkTSpace", three_on_an_edge)
            .checked({{edge_non_manifold, 1}, {edge_boundary, 6}})
            .normals(),
        MeshCase("bow-tie", "Two triangles that touch in one vertex, at right angles.",
                 "meshes cut along a line", bow_tie)
            .checked({{edge_boundary, 6}, {vertex_bow_tie, 1}})
            .normals()
            .accurate(all_weights(), 1e-5, "half way between the two where they touch",
                      [](const Mesh&, std::size_t vertex) -> std::optional<glm::dvec3> {
                          if (vertex != 0) return std::nullopt;
                          return glm::dvec3(0, 1, 1);
                      }),
        MeshCase("crease", "A flat square and one that rises from it at 45 degrees.",
                 "angles exactly at a crease's limit", [] { return ramp(0.0F, 0.0F); })
            .checked({{edge_boundary, 6}})
            .normals()
            .accurate({NormalWeight::angle}, 1e-5, "half way on the common edge", ramp_normal),
        MeshCase("+0 and -0", "The crease with its edge stored twice, once at +0 and once at -0.",
                 "bitwise comparison of positions", [] { return ramp(0.0F, -0.0F); })
            .checked({{edge_boundary, 6}})
            .normals()
            .accurate({NormalWeight::angle}, 1e-5, "half way on the common edge", ramp_normal),
        MeshCase("vertices one unit in the last place apart",
                 "The crease with its edge stored twice, at 1 and at the float after it: "
                 "positions are equal or they are not, unless a tolerance is asked for.",
                 "exporters that compute seams twice",
                 [] { return ramp(1.0F, std::nextafter(1.0F, 2.0F)); })
            .checked({{edge_boundary, 8}, {vertex_near_duplicate, 4}})
            .normals()
            .accurate({NormalWeight::angle}, 1e-5, "each square's own",
                      [](const Mesh&, std::size_t vertex) -> std::optional<glm::dvec3> {
                          return vertex < 4 ? glm::dvec3(0, 0, 1) : glm::dvec3(-1, 0, 1);
                      }),
    };
}

}  // namespace relief::test
