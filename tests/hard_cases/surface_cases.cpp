// SPDX-License-Identifier: Apache-2.0
// Hard cases of surfaces: triangles without area, and the ways in which triangles meet.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hard_cases/hard_cases.h"
#include "hard_cases/mesh_case.h"
#include "support/hard_meshes.h"
#include "support/shapes.h"

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

/// Returns +z for the first `count` vertices, which belong to the square or grid in the xy plane.
ReferenceNormal up_at_first(std::size_t count) {
    return [count](const Mesh&, std::size_t vertex) -> std::optional<glm::dvec3> {
        if (vertex >= count) return std::nullopt;
        return glm::dvec3(0, 0, 1);
    };
}

/// A triangle of length 1 and width 1e-6, rotated about its length by half a radian.
Mesh needle() {
    const float width = 1e-6F;
    return mesh_from({{0, 0, 0}, {1, 0, 0}, {0.5F, width * std::cos(0.5F), width * std::sin(0.5F)}},
                     {{0, 1, 2}});
}

/// Two edges along (1,2,3). At the end of the longer one they are one unit in the last place of 6
/// apart.
Mesh parallel_edges() {
    return mesh_from({{0, 0, 0}, {1, 2, 3}, {2, 4, std::nextafter(6.0F, 7.0F)}}, {{0, 1, 2}});
}

}  // namespace

std::vector<HardCase> triangle_cases() {
    using enum MeshCondition;
    return {
        MeshCase("triangle with a repeated index",
                 "A square and a triangle that refers to one vertex twice.", "trimesh#522",
                 [] {
                     return with_triangle(square(), {0, 1, 1});
                 })
            .checked({{triangle_collapsed, 1}, {edge_boundary, 4}})
            .normals({{"degenerate triangle", 1}})
            .accurate(all_weights(), 0, "the square's", up_at_first(4))
            .tangents({{"triangle with coinciding corners", 1}}),
        MeshCase("triangle on a line",
                 "A triangle with three collinear corners that shares an edge with another.",
                 "libigl#791, libigl#1923",
                 [] {
                     return mesh_from({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                                      {{0, 1, 2}, {0, 3, 1}});
                 })
            .checked({{triangle_collinear, 1}, {edge_boundary, 4}, {vertex_degenerate_fan, 1}})
            .normals({{"degenerate triangle", 1}, {"vertex with only degenerate triangles", 1}})
            .accurate(all_weights(), 0, "the valid triangle's", up_at_first(3))
            .tangents({{"corner without texture direction", 1},
                       {"triangle without texture gradient", 1}}),
        MeshCase("vertex with only degenerate triangles",
                 "A square, and a vertex that only a collapsed triangle uses.", "trimesh#522",
                 [] {
                     return with_triangle(with_vertex(square(), {3, 3, 3}), {0, 4, 4});
                 })
            .checked({{triangle_collapsed, 1}, {edge_boundary, 4}, {vertex_degenerate_fan, 1}})
            .normals({{"degenerate triangle", 1}, {"vertex with only degenerate triangles", 1}})
            .accurate(all_weights(), 0, "(0,0,1)", up_at_first(5))
            .tangents(
                {{"corner without texture direction", 2}, {"triangle with coinciding corners", 1}}),
        MeshCase("isolated vertex", "A square, and a vertex that no triangle uses.", "CGAL PR#847",
                 [] {
                     return with_vertex(square(), {3, 3, 3});
                 })
            .checked({{edge_boundary, 4}, {vertex_isolated, 1}})
            .normals({{"isolated vertex", 1}})
            .accurate(all_weights(), 0, "(0,0,1)", up_at_first(5))
            .tangents(),
        MeshCase("needle", "A triangle of length 1 and width 1e-6, rotated about its long axis.",
                 "an error of 6.6 degrees in float, measured", needle)
            .checked({{triangle_needle, 1}, {edge_boundary, 3}})
            .normals()
            .accurate(all_weights(), 1e-4, "the exact normal",
                      [](const Mesh&, std::size_t) -> std::optional<glm::dvec3> {
                          return glm::dvec3(0, -std::sin(0.5), std::cos(0.5));
                      })
            .tangents(),
        MeshCase("nearly parallel edges",
                 "A triangle between two edges whose directions differ by less than float "
                 "precision; the arc cosine of their dot product would have an argument "
                 "above 1.",
                 "rgl#372", parallel_edges)
            .checked({{triangle_needle, 1}, {edge_boundary, 3}})
            .normals()
            .accurate(all_weights(), 1e-4, "the exact normal",
                      [](const Mesh&, std::size_t) -> std::optional<glm::dvec3> {
                          return glm::dvec3(2, -1, 0);
                      })
            .tangents({{"corner without texture direction", 3},
                       {"triangle without texture gradient", 1}}),
        MeshCase("repeated triangle",
                 "A square with three copies of one triangle, each starting at another corner.",
                 "duplicate faces in assets that were exported twice",
                 [] {
                     return with_triangle(with_triangle(square(), {1, 2, 0}), {2, 0, 1});
                 })
            .checked({{triangle_repeated, 2}, {edge_boundary, 4}})
            .normals()
            .accurate(all_weights(), 0, "the square's", up_at_first(4))
            .tangents({{"repeated triangle", 2}}),
    };
}

namespace {

/// Two triangles at one edge. The second is folded back over the first.
Mesh fold_over() {
    return mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2F, 0.7F, 0}}, {{0, 1, 2}, {1, 0, 3}});
}

/// A flat grid with an inverted triangle in its middle.
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

/// A cone of height 1 with an open base. Vertex 0 is its tip.
Mesh cone() {
    Mesh mesh = fan(16);
    mesh.positions[0].z = 1.0F;
    return mesh;
}

std::optional<glm::dvec3> cone_axis_at_tip(const Mesh&, std::size_t vertex) {
    if (vertex != 0) return std::nullopt;
    return glm::dvec3(0, 0, 1);
}

/// Three triangles at the edge between vertices 0 and 1.
Mesh three_on_an_edge() {
    return mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                     {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
}

/// Two perpendicular triangles that share only vertex 0.
Mesh bow_tie() {
    return mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                     {{0, 1, 2}, {0, 3, 4}});
}

std::optional<glm::dvec3> corner_of_cube(const Mesh& mesh, std::size_t vertex) {
    return glm::dvec3(mesh.positions[vertex]);
}

/// Returns the bisector of both sides at the common edge of a ramp, and the normal of the side
/// elsewhere.
std::optional<glm::dvec3> ramp_normal(const Mesh& mesh, std::size_t vertex) {
    const glm::dvec3 flat(0, 0, 1);
    const glm::dvec3 rising = glm::dvec3(-1, 0, 1) / std::sqrt(2.0);
    if (mesh.positions[vertex].z != 0.0F) return rising;
    return mesh.positions[vertex].x < 0.0F ? flat : flat + rising;
}

/// Returns whether normals with this hard-edge angle all equal the face normals.
bool all_flat(const Mesh& mesh, double degrees) {
    Report report;
    const std::vector<glm::vec3> flat = triangle_normals(mesh.positions, mesh.triangles, report);
    HardEdges hard_edges;
    hard_edges.crease_angle = degrees * std::numbers::pi / 180.0;
    const std::vector<glm::vec3> corners =
        corner_normals(mesh.positions, mesh.triangles, NormalWeight::angle, {}, hard_edges, report)
            .normals;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        // Averaged normals are rounded to a grid, and flat normals are not. The difference is 2e-9.
        if (!(glm::distance(corners[c], flat[c / 3]) < 1e-7F)) return false;
    }
    return true;
}

/// Returns a problem if an automatically weighted normal has a larger error than the area-weighted
/// one.
std::string worse_than_area(const Mesh& mesh) {
    Report report;
    const ChosenNormals chosen = chosen_normals(mesh.positions, mesh.triangles, {}, report);
    const std::vector<glm::vec3> area =
        vertex_normals(mesh.positions, mesh.triangles, NormalWeight::area, report);
    for (std::size_t v = 0; v < area.size(); ++v) {
        if (chosen.normals[v].z < area[v].z) return "the choice is worse than area weights";
    }
    return chosen.by_area > 0 ? "" : "no vertex is weighted by area";
}

/// With a relative tolerance of 1e-6, both edges of the ramp are one edge.
std::string not_joined(const Mesh& mesh) {
    NormalOptions options;
    options.weld_tolerance = 1e-6;
    Report report;
    const std::vector<glm::vec3> normals =
        vertex_normals(mesh.positions, mesh.triangles, options, report);
    for (std::size_t a = 0; a < normals.size(); ++a) {
        for (std::size_t b = 0; b < normals.size(); ++b) {
            if (glm::distance(mesh.positions[a], mesh.positions[b]) < 1e-6F &&
                normals[a] != normals[b])
                return "two vertices that are near have normals of their own";
        }
    }
    return normals[0] != normals.back() ? "" : "all normals are the same";
}

}  // namespace

std::vector<HardCase> surface_cases() {
    using enum MeshCondition;
    return {
        MeshCase("fold-over",
                 "Two consistently wound triangles with a common edge; the smaller is "
                 "folded back over the larger.",
                 "weights by [Max 1999] fail here (measured)", fold_over)
            .checked({{edge_folded, 1}, {edge_boundary, 4}})
            .normals_by("normals, uniform", {NormalWeight::uniform}, {{"cancelling normals", 2}})
            .normals_by("normals, other weights",
                        {NormalWeight::area, NormalWeight::angle, NormalWeight::sine,
                         NormalWeight::max, NormalWeight::angle_edges, NormalWeight::area_angle},
                        {})
            .accurate({NormalWeight::area}, 0, "the larger triangle's on the common edge",
                      [](const Mesh& mesh, std::size_t vertex) -> std::optional<glm::dvec3> {
                          if (vertex > 1) return std::nullopt;
                          return facing_up(mesh, vertex);
                      })
            .expect("normals, auto", "nowhere a larger error than by area", worse_than_area)
            .tangents(),
        MeshCase("flipped triangle", "A flat grid with one inverted triangle in its middle.",
                 "scanned and hand-made meshes", flipped_triangle)
            .checked({{edge_flipped, 3}, {edge_boundary, 16}})
            .normals()
            .accurate(all_weights(), 0, "the grid's", facing_up)
            .tangents(),
        MeshCase("double-sided sheet",
                 "A square with a back face on the same vertices; its normals cancel.",
                 "leaves and cloth in games", double_sided_square)
            .checked({{triangle_two_sided, 4}})
            .normals({{"cancelling normals", 4}})
            .accurate(all_weights(), 0, "(0,0,1)", facing_up)
            .tangents(),
        MeshCase("tip of a cone",
                 "A cone with an open base; no single normal at its tip is correct for "
                 "all triangles.",
                 "bevy PR#10905", cone)
            .checked({{edge_boundary, 16}})
            .normals()
            .accurate(all_weights(), 1e-5, "the axis at the tip", cone_axis_at_tip)
            .tangents(),
        MeshCase("cube with an uneven triangulation",
                 "A cube of eight vertices; some have three triangles, some have four or more.",
                 "CGAL#2047", uneven_cube)
            .checked({})
            .normals()
            .accurate({NormalWeight::angle}, 1e-5, "the diagonals of the cube", corner_of_cube)
            .tangents({{"triangle without texture gradient", 8}}),
        MeshCase("flat fan of 10000 triangles",
                 "All triangles share one vertex and lie in a plane.", "CGAL PR#8684",
                 [] { return fan(10000); })
            .checked({{edge_boundary, 10000}})
            .normals()
            .accurate(all_weights(), 0, "the plane's", facing_up)
            .tangents(),
        MeshCase("edge of three triangles",
                 "Three triangles with a common edge, so inside and outside are undefined.",
                 "MikkTSpace's result depends on the order of triangles", three_on_an_edge)
            .checked({{edge_non_manifold, 1}, {edge_boundary, 6}})
            .normals()
            .tangents({{"corner without texture direction", 1},
                       {"triangle without texture gradient", 1}}),
        MeshCase("bow-tie", "Two perpendicular triangles with one common vertex.",
                 "meshes cut along a line", bow_tie)
            .checked({{edge_boundary, 6}, {vertex_bow_tie, 1}})
            .normals()
            .accurate(all_weights(), 1e-5, "the bisector at the common vertex",
                      [](const Mesh&, std::size_t vertex) -> std::optional<glm::dvec3> {
                          if (vertex != 0) return std::nullopt;
                          return glm::dvec3(0, 1, 1);
                      })
            .expect(
                "normals, crease 180",
                "the face normal of each triangle, because they share no edge",
                [](const Mesh& mesh) { return all_flat(mesh, 180.0) ? "" : "they are averaged"; })
            .tangents({{"corner without texture direction", 2},
                       {"triangle without texture gradient", 1}}),
        MeshCase("crease", "Two squares with a common edge and a dihedral angle of 45 degrees.",
                 "angles that equal the crease angle", [] { return ramp(0.0F, 0.0F); })
            .checked({{edge_boundary, 6}})
            .normals()
            .accurate({NormalWeight::angle}, 1e-5, "the bisector at the common edge", ramp_normal)
            .expect("normals, crease 45", "smooth, because the angle does not exceed the limit",
                    [](const Mesh& mesh) { return all_flat(mesh, 45.0) ? "it is hard" : ""; })
            .expect("normals, crease 44.99", "the normal of each square",
                    [](const Mesh& mesh) { return all_flat(mesh, 44.99) ? "" : "it is smooth"; })
            .tangents(),
        MeshCase("+0 and -0", "The crease with two copies of the common edge, at +0 and at -0.",
                 "positions compared by their bits", [] { return ramp(0.0F, -0.0F); })
            .checked({{edge_boundary, 6}})
            .normals()
            .accurate({NormalWeight::angle}, 1e-5, "the bisector at the common edge", ramp_normal)
            .tangents(),
        MeshCase("vertices one unit in the last place apart",
                 "The crease with two copies of the common edge, at 1 and at the next "
                 "float. Without a tolerance, only equal positions are welded.",
                 "exporters that compute both sides of a seam",
                 [] { return ramp(1.0F, std::nextafter(1.0F, 2.0F)); })
            .checked({{edge_boundary, 8}, {vertex_near_duplicate, 4}})
            .normals()
            .accurate({NormalWeight::angle}, 1e-5, "the normal of each square",
                      [](const Mesh&, std::size_t vertex) -> std::optional<glm::dvec3> {
                          return vertex < 4 ? glm::dvec3(0, 0, 1) : glm::dvec3(-1, 0, 1);
                      })
            .expect("normals, weld 1e-6", "shared on the common edge", not_joined)
            .tangents(),
    };
}

}  // namespace relief::test
