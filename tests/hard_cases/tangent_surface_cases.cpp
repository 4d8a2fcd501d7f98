// SPDX-License-Identifier: Apache-2.0
// How triangles, quads and surfaces meet, as tangents see it. Tests: hard_cases_test.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>

#include "hard_cases/mesh_case.h"
#include "hard_cases/mesh_cases.h"
#include "hard_cases/sample_meshes.h"
#include "hard_cases/tangent_samples.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/shapes.h"
#include "relief/mesh/tangents.h"
#include "relief/mesh/threads.h"
#include "support/angle.h"
#include "support/shared_data.h"
#include "support/triangle_orders.h"

namespace relief::test {
namespace {

/// For any number of threads, many orders of triangles.
std::string depends_on_order(const Mesh& mesh) {
    std::string problem;
    for (const TangentMethod& method : all_tangent_methods()) {
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

/// Positions and texture of a wavy grid, and frames that do not belong to it.
Mesh without_normals() {
    Mesh mesh = textured_from_above(wavy_grid(2));
    mesh.normals.clear();
    mesh.tangents.assign(mesh.positions.size(), {0, 1, 0, -1});
    return mesh;
}

/// Of no particular length; zero where two corners coincide.
glm::dvec3 triangle_normal_of(const Mesh& mesh, const glm::uvec3& triangle) {
    const glm::dvec3 origin(mesh.positions[triangle.x]);
    return glm::cross(glm::dvec3(mesh.positions[triangle.y]) - origin,
                      glm::dvec3(mesh.positions[triangle.z]) - origin);
}

/// Flat normals, and tangents made for them: the given ones are not looked at.
std::string wrong_flat_frames(const Mesh& mesh) {
    Report report;
    FrameOptions options;
    options.if_missing = NormalMode::flat;
    options.tangents = TangentMode::keep;
    const Mesh framed = with_frames(mesh, options, report).mesh;
    for (std::size_t corner = 0; corner < 3 * framed.triangles.size(); ++corner) {
        const glm::dvec3 normal = triangle_normal_of(framed, framed.triangles[corner / 3]);
        const std::uint32_t v = vertex_at(framed, corner);
        if (!(degrees_between(glm::dvec3(framed.normals[v]), normal) < 1e-5))
            return "a normal is not its triangle's";
        const glm::dvec3 tangent = glm::cross(glm::dvec3(0, 1, 0), normal);  // y stays: along x.
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

/// At a pole no direction is east: there it is that of the triangle's middle.
std::optional<glm::dvec4> east_at_poles(const Mesh& mesh, std::size_t corner) {
    const glm::uvec3& triangle = mesh.triangles[corner / 3];
    const bool is_collapsed = triangle_normal_of(mesh, triangle) == glm::dvec3(0.0);
    if (is_collapsed || !is_pole(mesh, corner)) return std::nullopt;
    return east_of(glm::dvec3(mesh.positions[triangle.x]) + glm::dvec3(mesh.positions[triangle.y]) +
                   glm::dvec3(mesh.positions[triangle.z]));
}

/// The mesh mirrored in the plane x = 0, its triangles turned so that they face outwards.
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
    for (const TangentMethod& method : all_tangent_methods()) {
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

/// A floor and a wall of size 1, with a bevel between them whose texture is sheared. Normals are
/// the floor's and the wall's. Vertices 0 to 3: the floor, 4 to 7: the wall.
Mesh bevelled_edge() {
    Mesh mesh = mesh_of({{-1, 0, 0},
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

/// By how many degrees the bevel turns the tangents of the floor and the wall.
double turned_by_bevel(const Mesh& mesh, const TangentMethod& method) {
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

/// The tangents at every vertex of a wavy sheet of quads, each begun at its `first` corner.
std::vector<glm::vec4> tangents_of_quads(const Mesh& sheet, std::size_t first) {
    std::string obj;
    for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
        const glm::vec3& p = sheet.positions[v];
        const glm::vec2& t = sheet.texcoords[v];
        obj += fmt::format("v {} {} {}\nvt {} {}\nvn 0 0 1\n", p.x, p.y, p.z, t.x, -t.y);
    }
    for (std::size_t t = 0; t < sheet.triangles.size(); t += 2) {
        // The cell's lower left, lower right, upper right, upper left corner.
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

/// Two triangles on an edge, one folded back over the other under one normal: seen along that, u is
/// 14 degrees to the left of x on the first, 9 to the right on the second, and v opposite.
Mesh folded_over() {
    Mesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0.5F}}, {{0, 1, 2}, {1, 0, 3}});
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texcoords = {{0, 0}, {1, 0.25F}, {0, -1}, {0, 1.5F}};
    return mesh;
}

std::string averaged_over_the_fold(const Mesh& mesh) {
    for (const TangentMethod& method : all_tangent_methods()) {
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
        MeshCase("triangles in another order", "A torus, its triangles shuffled in twelve ways.",
                 "MikkTSpace and meshoptimizer: other bits at 72 of 100 corners, measured",
                 textured_torus)
            .tangents()
            .expect("tangents", "the same bits, with 1, 2, 3 threads or all", depends_on_order),
        MeshCase("no normals, but tangents",
                 "A wavy grid whose stored tangents go with normals that it has not.", "glTF#2480",
                 without_normals)
            .expect("frames, flat", "flat normals, and each triangle's tangent for them",
                    wrong_flat_frames),
        MeshCase("poles of a sphere", "A sphere by longitude and latitude, of 12 slices.",
                 "p5.js PR#9068", sphere_with_poles)
            .checked({{triangle_collapsed, 24}})
            .tangents(
                {{"triangle with coinciding corners", 24}, {"corner without texture direction", 2}})
            .tangents_near(1e-4, "each triangle's own east at the poles", east_at_poles)
            .tangents_near(15.001, "east elsewhere: half a slice, at the seam", east_beside_poles),
        MeshCase("texture folded over",
                 "Two triangles on an edge, one over the other under one normal: it sees the back "
                 "of one, and their v opposite.",
                 "the limit of 180 degrees of MikkTSpace; meshoptimizer has none", folded_over)
            .tangents()
            .expect("tangents, mikktspace and area-weighted", "each triangle's own",
                    averaged_over_the_fold),
        MeshCase("thin bevel",
                 "A floor and a wall, and between them a bevel of a hundredth of their size with a "
                 "sheared texture.",
                 "meshoptimizer PR#1047", bevelled_edge)
            .tangents()
            .expect(
                "tangents, area-weighted",
                "the floor's and the wall's own within 2 degrees, where MikkTSpace turns them by "
                "more than 20",
                not_turned_as_told),
        MeshCase("quads begun at other corners",
                 "A wavy sheet of quads, read from OBJ files that begin them at each of their "
                 "corners.",
                 "MikkTSpace#2", coarsely_textured)
            .expect("tangents", "within 0.0001 degrees the same: they are cut along one diagonal",
                    depends_on_first_corner),
        MeshCase("mirrored surface", "A torus mirrored in x, its triangles still facing outwards.",
                 "instances scaled by -1", mirrored_torus)
            .checked({{texture_mirrored, 576}})
            .tangents()
            .expect("tangents", "mirrored within 1e-5 degrees, w negated", not_mirrored),
    };
}

}  // namespace relief::test
