// SPDX-License-Identifier: Apache-2.0
// Hard cases of tangents: the texture on the surface, and the surfaces below it. Expected tangents
// are exact if the surface is flat; otherwise they are those of the same mesh without the problem.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>

#include "hard_cases/hard_cases.h"
#include "hard_cases/mesh_case.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/tangents.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// The names of findings in a Report.
constexpr const char* no_gradient = "triangle without texture gradient";
constexpr const char* not_finite = "triangle with non-finite values";
constexpr const char* no_direction = "corner without texture direction";
constexpr const char* along_normal = "texture direction along the normal";
constexpr const char* no_normal = "normal without direction";

std::optional<glm::dvec4> along_x(const Mesh&, std::size_t) {
    return glm::dvec4(1, 0, 0, 1);
}

/// Returns the tangents of another mesh with the same surface and texture.
template <typename Make>
std::function<std::string(const Mesh&)> differs_from(const Make& make, double degrees) {
    return [=](const Mesh& mesh) {
        const Mesh sound = make();
        for (const NamedTangentMethod& method : all_tangent_methods()) {
            const auto expected = tangents_of(sound, method);
            const auto found = tangents_of(mesh, method);
            for (std::size_t corner = 0; corner < found.size(); ++corner) {
                const double error =
                    degrees_between(glm::dvec3(found[corner]), glm::dvec3(expected[corner]));
                if (!(error <= degrees) || found[corner].w != expected[corner].w) {
                    return fmt::format("{}: corner {} is {} degrees off, w {}", method.name, corner,
                                       error, found[corner].w);
                }
            }
        }
        return std::string();
    };
}

Mesh collinear_texture() {
    return changed(textured_grid(), [](Mesh& mesh, std::size_t v) {
        mesh.texcoords[v].y = 0.5F * mesh.texcoords[v].x;
    });
}

/// One half of the grid has a texture. The other half shows a line of it.
Mesh half_textured() {
    return changed(textured_grid(), [](Mesh& mesh, std::size_t v) {
        mesh.texcoords[v].x = std::min(mesh.texcoords[v].x, 2.0F);
    });
}

/// A triangle of length 1 and width 1e-6 that shows the whole image. Its length runs along u.
Mesh textured_sliver() {
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.6, 0.7, 0.3));
    const glm::dvec3 across = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), along));
    Mesh mesh = mesh_from({glm::vec3(0), along, 0.5 * along + 1e-6 * across}, {{0, 1, 2}});
    mesh.normals.assign(3, glm::cross(along, across));
    mesh.texcoords = {{0, 1}, {1, 1}, {0.5F, 0}};
    return mesh;
}

std::optional<glm::dvec4> along_sliver(const Mesh&, std::size_t) {
    return glm::dvec4(0.6, 0.7, 0.3, 1);
}

/// A square, and a triangle at its lower edge. The triangle is a line in space, and mirrored in the
/// image. The angles at its corners are 0.
Mesh textured_line() {
    Mesh mesh = square();
    mesh.positions.emplace_back(0.5F, 0, 0);
    mesh.triangles.emplace_back(1, 0, 4);
    mesh.normals.assign(5, {0, 0, 1});
    mesh.texcoords = {{0, 0}, {1, -1}, {1, -2}, {0, -1}, {0.25F, -1}};
    return mesh;
}

std::optional<glm::dvec4> on_textured_line(const Mesh&, std::size_t corner) {
    return corner / 3 == 2 ? glm::dvec4(1, 0, 0, -1) : glm::dvec4(1, -1, 0, 1);
}

/// The grid with u mirrored about its middle column.
Mesh mirrored_grid() {
    return changed(textured_grid(), [](Mesh& mesh, std::size_t v) {
        mesh.texcoords[v].x = std::abs(mesh.texcoords[v].x - 2.0F);
    });
}

std::optional<glm::dvec4> mirrored_reference(const Mesh& mesh, std::size_t corner) {
    const glm::uvec3& triangle = mesh.triangles[corner / 3];
    float x = 0.0F;
    for (int i = 0; i < 3; ++i)
        x += mesh.positions[triangle[i]].x / 3.0F;
    return x < 2.0F ? glm::dvec4(-1, 0, 0, -1) : glm::dvec4(1, 0, 0, 1);
}

/// with_frames() splits exactly the vertices of the line.
std::string wrongly_split(const Mesh& mesh) {
    Report report;
    FrameOptions options;
    options.tangents = TangentMethod::mikktspace;
    const FramedMesh framed = with_frames(mesh, options, report);
    for (std::size_t v = mesh.positions.size(); v < framed.source_vertex.size(); ++v) {
        if (framed.mesh.positions[v].x != 2.0F) return "a vertex beside the line is split";
    }
    const std::size_t copies = framed.source_vertex.size() - mesh.positions.size();
    return copies == 5 ? "" : fmt::format("{} vertices are split", copies);
}

/// A triangle without texture gradient between an upright and a mirrored one.
Mesh between_handednesses() {
    Mesh mesh = mesh_from({{0, 0, 0}, {1, 0, 0}, {0.5F, 1, 0}, {-0.5F, 1, 0}, {1.5F, 1, 0}},
                          {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}});
    mesh.normals.assign(5, {0, 0, 1});
    mesh.texcoords = {{0, 0}, {1, 0}, {0.5F, 0}, {0, -1}, {1, 1}};
    return mesh;
}

HardCase texture_scale_case(float scale) {
    return MeshCase(
               fmt::format("texture of size {:g}", scale),
               "A textured torus with scaled texture coordinates.",
               scale < 1e-20F
                   ? "MikkTSpace and meshoptimizer: 5 of 6 tangents are not perpendicular to "
                     "the normal (measured)"
                   : "MikkTSpace: 5 of 6 tangents are not perpendicular to the normal (measured)",
               [scale] {
                   return changed(textured_torus(), [scale](Mesh& mesh, std::size_t v) {
                       mesh.texcoords[v] *= scale;
                   });
               })
        .checked({})
        .tangents()
        .expect("tangents", "within 0.0001 degrees of those at size 1",
                differs_from(textured_torus, 1e-4));
}

HardCase position_scale_case(float scale, const std::string& source) {
    return MeshCase(fmt::format("textured torus of size {:g}", scale),
                    "A textured torus with scaled positions.", source,
                    [scale] {
                        return changed(textured_torus(), [scale](Mesh& mesh, std::size_t v) {
                            mesh.positions[v] *= scale;
                        });
                    })
        .checked({})
        .tangents()
        .expect("tangents", "within 0.0001 degrees of those at size 1",
                differs_from(textured_torus, 1e-4));
}

// At this distance, adjacent floats differ by 1/16.
constexpr float far = 1e6F;

HardCase texture_value_case(const std::string& name, float value) {
    using enum MeshCondition;
    return MeshCase(name,
                    "A flat grid with non-finite texture coordinates at the middle vertex. "
                    "Its six triangles have no position in the image; all others are "
                    "unaffected.",
                    "meshoptimizer: one NaN affects 36 corners (measured)",
                    [value] {
                        Mesh mesh = textured_grid();
                        mesh.texcoords[12].y = value;
                        return mesh;
                    })
        .checked({{edge_boundary, 16}, {texture_not_finite, 1}})
        .tangents({{not_finite, 6}, {no_direction, 6}})
        .tangents_near(
            0, "the grid's, except for w of the six triangles",
            [](const Mesh&, std::size_t) { return std::optional(glm::dvec4(1, 0, 0, 0)); });
}

HardCase normal_value_case(const std::string& name, const glm::vec3& normal,
                           MeshCondition condition) {
    return MeshCase(name, "A flat grid whose middle vertex has a normal without direction.",
                    "glTF-Transform#1859",
                    [normal] {
                        Mesh mesh = textured_grid();
                        mesh.normals[12] = normal;
                        return mesh;
                    })
        .checked({{MeshCondition::edge_boundary, 16}, {condition, 1}})
        .tangents({{no_normal, 1}})
        .tangents_near(0, "along u", along_x);
}

Mesh with_normals_of_lengths() {
    return changed(textured_torus(), [](Mesh& mesh, std::size_t v) {
        mesh.normals[v] *= std::ldexp(1.0F, 20 * (static_cast<int>(v % 5) - 2));
    });
}

/// The normals of the grid lie in its surface, along u.
Mesh with_normals_along_the_texture() {
    return changed(textured_grid(), [](Mesh& mesh, std::size_t v) { mesh.normals[v] = {1, 0, 0}; });
}

}  // namespace

std::vector<HardCase> tangent_cases() {
    using enum MeshCondition;
    return {
        MeshCase("texture on a line", "A grid whose texture coordinates are collinear.",
                 "MikkTSpace#1, lslib#51", collinear_texture)
            .checked({{edge_boundary, 16}, {texture_degenerate, 32}})
            .tangents({{no_gradient, 32}, {no_direction, 96}})
            .tangents_near(
                0, "the x axis, projected into the plane of the normal",
                [](const Mesh&, std::size_t) { return std::optional(glm::dvec4(1, 0, 0, -1)); }),
        MeshCase("texture on one half", "A grid with collinear texture coordinates in one half.",
                 "partly unwrapped meshes", half_textured)
            .checked({{edge_boundary, 16}, {texture_degenerate, 16}})
            .tangents({{no_gradient, 16}, {no_direction, 36}})
            .tangents_near(
                0, "those of the textured half, in the other half too",
                [](const Mesh&, std::size_t) { return std::optional(glm::dvec4(1, 0, 0, 0)); }),
        MeshCase("sliver with a regular texture",
                 "A triangle of length 1 and width 1e-6 that is textured with the whole image.",
                 "glTF-Transform#1859", textured_sliver)
            .checked({{triangle_needle, 1}, {edge_boundary, 3}})
            .tangents()
            .tangents_near(1e-4, "its long axis", along_sliver),
        MeshCase("texture on a triangle without area",
                 "A square, and a triangle at its edge that is collinear in space, but "
                 "has an area in the image.",
                 "conformance kit: a corner with angle 0 has a direction, but no weight",
                 textured_line)
            .checked({{triangle_collinear, 1}, {edge_boundary, 5}, {vertex_degenerate_fan, 1}})
            .tangents()
            .tangents_near(1e-5, "the tangent of each triangle", on_textured_line),
        MeshCase("mirrored texture on shared vertices",
                 "A grid with an image that is mirrored at the middle column.", "Godot#114508",
                 mirrored_grid)
            .checked({{edge_boundary, 16}, {texture_mirrored, 16}, {texture_overlapping, 32}})
            .tangents()
            .tangents_near(0, "the tangents of each half", mirrored_reference)
            .expect("frames", "exactly the 5 vertices of the middle column are split",
                    wrongly_split),
        MeshCase("no gradient between both handednesses",
                 "A triangle with collinear texture coordinates between an upright and a "
                 "mirrored triangle.",
                 "glTF#2480: all corners of a triangle must have the same w", between_handednesses)
            .checked({{edge_boundary, 5}, {texture_degenerate, 1}, {texture_mirrored, 1}})
            .tangents({{no_gradient, 1}}),
        texture_scale_case(1e-18F),
        texture_scale_case(1e-25F),
        texture_scale_case(1e18F),
        MeshCase("texture a million from its origin",
                 "A wavy grid with texture coordinates that are multiples of 1/16, the "
                 "spacing of floats at this distance.",
                 "MikkTSpace and meshoptimizer: 540 of 3072 tangents are not "
                 "perpendicular to the normal (measured)",
                 [] {
                     return changed(coarsely_textured(), [](Mesh& mesh, std::size_t v) {
                         mesh.texcoords[v] += glm::vec2(far, -far);
                     });
                 })
            .checked({{edge_boundary, 24}, {texture_far_away, 1}})
            .tangents()
            .expect("tangents", "exactly those without the offset",
                    differs_from(coarsely_textured, 0.0)),
        texture_value_case("NaN in a texture coordinate", not_a_number),
        texture_value_case("infinity in a texture coordinate", infinity),
        normal_value_case("normal of length zero", {0, 0, 0}, normal_zero),
        normal_value_case("normal that is NaN", {0, not_a_number, 1}, normal_not_finite),
        normal_value_case("normal that is infinite", {0, 0, infinity}, normal_not_finite),
        MeshCase("normals of various lengths",
                 "A torus with normals of lengths from 2^-40 to 2^40.",
                 "MikkTSpace and meshoptimizer: 3000 of 3072 tangents are not "
                 "perpendicular to the normal (measured)",
                 with_normals_of_lengths)
            .tangents()
            .expect("tangents", "exactly those of unit normals", differs_from(textured_torus, 0.0)),
        MeshCase("normals along u", "A flat grid with normals in the direction of increasing u.",
                 "baked meshes with invalid normals", with_normals_along_the_texture)
            .tangents({{no_direction, 96}, {along_normal, 96}}),
        position_scale_case(1e-25F, "underflow of squared lengths"),
        position_scale_case(1e20F, "meshoptimizer: 3067 NaN (measured)"),
        position_scale_case(1e25F, "overflow of squared lengths"),
    };
}

namespace {

/// Compares the tangents for several numbers of threads and many orders of triangles.
std::string depends_on_order(const Mesh& mesh) {
    std::string problem;
    for (const NamedTangentMethod& method : all_tangent_methods()) {
        const auto expected = tangents_of(mesh, method);
        for (std::uint32_t seed = 0; seed < 12; ++seed) {
            set_thread_limit(seed % 4);
            const auto order = shuffled(mesh.triangles.size(), seed);
            const auto found = tangents_of(with_triangle_order(mesh, order), method);
            if (!same_bits(found, corners_in_order(expected, order)))
                problem = method.name + ": other bits";
        }
    }
    set_thread_limit(0);
    return problem;
}

/// Positions and texture coordinates of a wavy grid, with frames of another surface.
Mesh without_normals() {
    Mesh mesh = textured_from_above(wavy_grid(2));
    mesh.normals.clear();
    mesh.tangents.assign(mesh.positions.size(), {0, 1, 0, -1});
    return mesh;
}

/// Returns the normal without normalization. It is zero if two corners coincide.
glm::dvec3 triangle_normal_of(const Mesh& mesh, const glm::uvec3& triangle) {
    const glm::dvec3 origin(mesh.positions[triangle.x]);
    return glm::cross(glm::dvec3(mesh.positions[triangle.y]) - origin,
                      glm::dvec3(mesh.positions[triangle.z]) - origin);
}

/// Flat normals, and tangents for them. The given normals have no effect.
std::string wrong_flat_frames(const Mesh& mesh) {
    Report report;
    FrameOptions options;
    options.if_missing = NormalMode::flat;
    options.tangents = TangentMethod::keep;
    const Mesh framed = with_frames(mesh, options, report).mesh;
    for (std::size_t corner = 0; corner < 3 * framed.triangles.size(); ++corner) {
        const glm::dvec3 normal = triangle_normal_of(framed, framed.triangles[corner / 3]);
        const std::uint32_t v = vertex_at(framed, corner);
        if (!(degrees_between(glm::dvec3(framed.normals[v]), normal) < 1e-5))
            return "a normal is not its triangle's";
        // The y axis is perpendicular, so the tangent is along x.
        const glm::dvec3 tangent = glm::cross(glm::dvec3(0, 1, 0), normal);
        if (!(degrees_between(glm::dvec3(framed.tangents[v]), tangent) < 1e-5) ||
            framed.tangents[v].w != 1.0F)
            return "a tangent is not its triangle's";
    }
    return "";
}

Mesh sphere_with_poles() {
    return make_sphere(12, 6);
}

bool is_pole(const Mesh& mesh, std::size_t corner) {
    return std::abs(mesh.normals[vertex_at(mesh, corner)].y) > 0.999F;
}

std::optional<glm::dvec4> east_of(const glm::dvec3& point) {
    return glm::dvec4(point.z, 0, -point.x, 1);
}

std::optional<glm::dvec4> east_beside_poles(const Mesh& mesh, std::size_t corner) {
    if (is_pole(mesh, corner)) return std::nullopt;
    return east_of(glm::dvec3(mesh.positions[vertex_at(mesh, corner)]));
}

/// East is undefined at a pole. The expected tangent is that of the middle of the triangle.
std::optional<glm::dvec4> east_at_poles(const Mesh& mesh, std::size_t corner) {
    const glm::uvec3& triangle = mesh.triangles[corner / 3];
    const bool is_collapsed = triangle_normal_of(mesh, triangle) == glm::dvec3(0.0);
    if (is_collapsed || !is_pole(mesh, corner)) return std::nullopt;
    return east_of(glm::dvec3(mesh.positions[triangle.x]) + glm::dvec3(mesh.positions[triangle.y]) +
                   glm::dvec3(mesh.positions[triangle.z]));
}

/// The mesh mirrored in the plane x = 0, with reversed triangles that face outwards.
Mesh mirrored_torus() {
    Mesh mesh = textured_torus();
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        mesh.positions[v].x *= -1.0F;
        mesh.normals[v].x *= -1.0F;
    }
    for (glm::uvec3& triangle : mesh.triangles)
        std::swap(triangle.y, triangle.z);
    return mesh;
}

std::string not_mirrored(const Mesh& mesh) {
    for (const NamedTangentMethod& method : all_tangent_methods()) {
        const auto before = tangents_of(textured_torus(), method);
        const auto after = tangents_of(mesh, method);
        for (std::size_t corner = 0; corner < after.size(); ++corner) {
            const glm::dvec4 was(before[corner / 3 * 3 + (3 - corner % 3) % 3]);
            const double error =
                degrees_between(glm::dvec3(after[corner]), glm::dvec3(-was.x, was.y, was.z));
            if (!(error < 1e-5) || after[corner].w != -static_cast<float>(was.w))
                return method.name + fmt::format(": corner {} is not", corner);
        }
    }
    return "";
}

constexpr float bevel = 0.01F;

/// A floor and a wall of size 1, and a bevel between them with a sheared texture. The normals are
/// those of the floor and the wall. Vertices 0 to 3 belong to the floor, 4 to 7 to the wall.
Mesh bevelled_edge() {
    Mesh mesh = mesh_from({{-1, 0, 0},
                           {0, 0, 0},
                           {0, 1, 0},
                           {-1, 1, 0},
                           {bevel, 0, -bevel},
                           {bevel, 0, -1},
                           {bevel, 1, -1},
                           {bevel, 1, -bevel}},
                          {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {1, 4, 7}, {1, 7, 2}});
    mesh.normals.assign(4, {0, 0, 1});
    mesh.normals.resize(8, {1, 0, 0});
    mesh.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    for (const float u : {1.0F + bevel, 2.0F, 2.0F, 1.0F + bevel})
        mesh.texcoords.emplace_back(u, u < 1.5F ? 1.0F - bevel : 1.0F);
    mesh.texcoords[5].y = mesh.texcoords[4].y;
    mesh.texcoords[6].y = mesh.texcoords[7].y = -bevel;
    return mesh;
}

/// Returns the angle in degrees by which the bevel rotates the tangents of the floor and the wall.
double turned_by_bevel(const Mesh& mesh, const NamedTangentMethod& method) {
    const auto tangents = tangents_of(mesh, method);
    double most = 0.0;
    for (std::size_t corner = 0; corner < 12; ++corner) {
        const glm::dvec3 along_u = corner < 6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, -1);
        most = std::max(most, degrees_between(glm::dvec3(tangents[corner]), along_u));
    }
    return most;
}

std::string not_turned_as_told(const Mesh& mesh) {
    const double by_angle = turned_by_bevel(mesh, {"mikktspace", mikktspace_tangents});
    const double by_area = turned_by_bevel(mesh, {"area-weighted", area_weighted_tangents});
    return by_angle > 20.0 && by_area < 2.0
               ? ""
               : fmt::format("turned by {} with angles, {} with areas", by_angle, by_area);
}

/// Returns the tangents at every vertex of a wavy sheet of quads, each of which begins at its
/// `first` corner.
std::vector<glm::vec4> tangents_of_quads(const Mesh& sheet, std::size_t first) {
    std::string obj;
    for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
        const glm::vec3& p = sheet.positions[v];
        const glm::vec2& t = sheet.texcoords[v];
        obj += fmt::format("v {} {} {}\nvt {} {}\nvn 0 0 1\n", p.x, p.y, p.z, t.x, -t.y);
    }
    for (std::size_t t = 0; t < sheet.triangles.size(); t += 2) {
        // The corners of the cell: lower left, lower right, upper right, upper left.
        const glm::uvec4 quad(sheet.triangles[t], sheet.triangles[t + 1].z);
        obj += "f";
        for (std::size_t i = 0; i < 4; ++i)
            obj += fmt::format(" {0}/{0}/{0}", quad[static_cast<int>((first + i) % 4)] + 1);
        obj += "\n";
    }
    const TemporaryDirectory folder;
    std::ofstream(folder / "quads.obj") << obj;
    Report ignored;
    const Mesh mesh = read_mesh(folder / "quads.obj", ignored).mesh;
    const auto tangents = tangents_of(mesh, all_tangent_methods()[0]);
    std::map<std::array<float, 2>, glm::vec4> by_place;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const glm::vec3& p = mesh.positions[vertex_at(mesh, corner)];
        by_place[{p.x, p.y}] = tangents[corner];
    }
    std::vector<glm::vec4> in_order;
    for (const auto& [place, tangent] : by_place)
        in_order.push_back(tangent);
    return in_order;
}

std::string depends_on_first_corner(const Mesh& sheet) {
    const auto expected = tangents_of_quads(sheet, 0);
    for (const std::size_t first : {1U, 2U, 3U}) {
        const auto found = tangents_of_quads(sheet, first);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            if (!(degrees_between(glm::dvec3(found[i]), glm::dvec3(expected[i])) < 1e-4))
                return fmt::format("quads begun at corner {} differ", first);
        }
    }
    return "";
}

/// Two triangles at one edge, folded over each other under one normal. In the plane of that normal,
/// u is 14 degrees to the left of x on the first, 9 degrees to the right on the second, and v is
/// opposite.
Mesh folded_over() {
    Mesh mesh = mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0.5F}}, {{0, 1, 2}, {1, 0, 3}});
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texcoords = {{0, 0}, {1, 0.25F}, {0, -1}, {0, 1.5F}};
    return mesh;
}

std::string averaged_over_the_fold(const Mesh& mesh) {
    for (const NamedTangentMethod& method : all_tangent_methods()) {
        if (method.name == "lengyel") continue;
        const auto tangents = tangents_of(mesh, method);
        for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
            const glm::dvec3 own = corner < 3 ? glm::dvec3(4, 1, 0) : glm::dvec3(6, -1, 0);
            const double off = degrees_between(glm::dvec3(tangents[corner]), own);
            if (!(off < 1e-5)) return fmt::format("{}: {} degrees off", method.name, off);
        }
    }
    return "";
}

}  // namespace

std::vector<HardCase> tangent_surface_cases() {
    using enum MeshCondition;
    return {
        MeshCase("triangles in another order",
                 "A torus with twelve random orders of its triangles.",
                 "MikkTSpace and meshoptimizer: different bits at 72 % of the corners (measured)",
                 textured_torus)
            .tangents()
            .expect("tangents", "the same bits, with 1, 2, 3 threads or all", depends_on_order),
        MeshCase("tangents without normals",
                 "A wavy grid with stored tangents, but without normals.", "glTF#2480",
                 without_normals)
            .expect("frames, flat", "flat normals, and tangents that are recomputed for them",
                    wrong_flat_frames),
        MeshCase("poles of a sphere", "A UV sphere with 12 slices.", "p5.js PR#9068",
                 sphere_with_poles)
            .checked({{triangle_collapsed, 24}})
            .tangents(
                {{"triangle with coinciding corners", 24}, {"corner without texture direction", 2}})
            .tangents_near(1e-4, "the eastward direction of each triangle at the poles",
                           east_at_poles)
            .tangents_near(15.001, "the eastward direction elsewhere (half a slice at the seam)",
                           east_beside_poles),
        MeshCase("folded texture",
                 "Two triangles with a common edge lie on top of each other and share "
                 "normals. One is back-facing, and their v directions are opposite.",
                 "MikkTSpace's angular threshold of 180 degrees; meshoptimizer has no threshold",
                 folded_over)
            .tangents()
            .expect("tangents, mikktspace and area-weighted", "the tangent of each triangle",
                    averaged_over_the_fold),
        MeshCase("thin bevel",
                 "A floor and a wall with a bevel between them that has 1 % of their size "
                 "and a sheared texture.",
                 "meshoptimizer PR#1047", bevelled_edge)
            .tangents()
            .expect("tangents, area-weighted",
                    "within 2 degrees of those of the floor and the wall; MikkTSpace's "
                    "differ by more than 20",
                    not_turned_as_told),
        MeshCase("quads that start at other corners",
                 "A wavy sheet of quads, read from four OBJ files whose quads start at "
                 "different corners.",
                 "MikkTSpace#2", coarsely_textured)
            .expect("tangents", "equal within 0.0001 degrees, because the same diagonal is used",
                    depends_on_first_corner),
        MeshCase("mirrored surface",
                 "A torus that is mirrored in x, with outward-facing triangles.",
                 "instances scaled by -1", mirrored_torus)
            .checked({{texture_mirrored, 576}})
            .tangents()
            .expect("tangents", "mirrored within 1e-5 degrees, w negated", not_mirrored),
    };
}

}  // namespace relief::test
