// SPDX-License-Identifier: Apache-2.0
// Truths are exact where the surface is flat, and those of the same mesh without the trouble
// elsewhere. Tests: hard_cases_test.cpp.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hard_cases/mesh_case.h"
#include "hard_cases/mesh_cases.h"
#include "hard_cases/sample_meshes.h"
#include "hard_cases/tangent_samples.h"
#include "relief/mesh/frames.h"
#include "support/angle.h"
#include "support/no_numbers.h"

namespace relief::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// As a Report names them.
constexpr const char* no_gradient = "triangle without texture gradient";
constexpr const char* not_finite = "triangle with non-finite values";
constexpr const char* no_direction = "corner without texture direction";
constexpr const char* along_normal = "texture direction along the normal";
constexpr const char* no_normal = "normal without direction";

std::optional<glm::dvec4> along_x(const Mesh&, std::size_t) {
    return glm::dvec4(1, 0, 0, 1);
}

/// The tangents of a mesh, for one that has the same surface and texture.
template <typename Make>
std::function<std::string(const Mesh&)> differs_from(const Make& make, double degrees) {
    return [=](const Mesh& mesh) {
        const Mesh sound = make();
        for (const TangentMethod& method : all_tangent_methods()) {
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

/// Half of the grid has texture, the other shows a line of it.
Mesh half_textured() {
    return changed(textured_grid(), [](Mesh& mesh, std::size_t v) {
        mesh.texcoords[v].x = std::min(mesh.texcoords[v].x, 2.0F);
    });
}

/// A triangle of length 1 and width 1e-6 that shows the whole image, its length along u.
Mesh textured_sliver() {
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.6, 0.7, 0.3));
    const glm::dvec3 across = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), along));
    Mesh mesh = mesh_of({glm::vec3(0), along, 0.5 * along + 1e-6 * across}, {{0, 1, 2}});
    mesh.normals.assign(3, glm::cross(along, across));
    mesh.texcoords = {{0, 1}, {1, 1}, {0.5F, 0}};
    return mesh;
}

std::optional<glm::dvec4> along_sliver(const Mesh&, std::size_t) {
    return glm::dvec4(0.6, 0.7, 0.3, 1);
}

/// A square, and a triangle on its lower edge that lies on a line in space but, mirrored, not in
/// the image: its corners have angles of 0.
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

/// with_frames() splits the vertices of the line and no others.
std::string wrongly_split(const Mesh& mesh) {
    Report report;
    FrameOptions options;
    options.tangents = TangentMode::mikktspace;
    const FramedMesh framed = with_frames(mesh, options, report);
    for (std::size_t v = mesh.positions.size(); v < framed.source_vertex.size(); ++v) {
        if (framed.mesh.positions[v].x != 2.0F) return "a vertex beside the line is split";
    }
    const std::size_t copies = framed.source_vertex.size() - mesh.positions.size();
    return copies == 5 ? "" : fmt::format("{} vertices are split", copies);
}

/// A triangle without texture gradient between one that is upright and one that is mirrored.
Mesh between_handednesses() {
    Mesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0.5F, 1, 0}, {-0.5F, 1, 0}, {1.5F, 1, 0}},
                        {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}});
    mesh.normals.assign(5, {0, 0, 1});
    mesh.texcoords = {{0, 0}, {1, 0}, {0.5F, 0}, {0, -1}, {1, 1}};
    return mesh;
}

HardCase texture_scale_case(float scale) {
    return MeshCase(fmt::format("texture of size {:g}", scale),
                    "A torus with texture, all its texture coordinates multiplied.",
                    scale < 1e-20F
                        ? "MikkTSpace and meshoptimizer: five in six tangents lean, measured"
                        : "MikkTSpace: five in six tangents lean, measured",
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
                    "A torus with texture, all its positions multiplied.", source,
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

// Where floats are 1/16 apart.
constexpr float far = 1e6F;

HardCase texture_value_case(const std::string& name, float value) {
    using enum MeshCondition;
    return MeshCase(name,
                    "A flat grid whose middle vertex is nowhere in the image; its six triangles "
                    "have no place there, all others are unharmed.",
                    "meshoptimizer: one NaN spoils 36 corners, measured",
                    [value] {
                        Mesh mesh = textured_grid();
                        mesh.texcoords[12].y = value;
                        return mesh;
                    })
        .checked({{edge_boundary, 16}, {texture_not_finite, 1}})
        .tangents({{not_finite, 6}, {no_direction, 6}})
        .tangents_near(0, "the grid's, but for w at the six", [](const Mesh&, std::size_t) {
            return std::optional(glm::dvec4(1, 0, 0, 0));
        });
}

HardCase normal_value_case(const std::string& name, const glm::vec3& normal,
                           MeshCondition condition) {
    return MeshCase(name, "A flat grid whose middle vertex has a normal that is no direction.",
                    "glTF-Transform#1859",
                    [normal] {
                        Mesh mesh = textured_grid();
                        mesh.normals[12] = normal;
                        return mesh;
                    })
        .checked({{MeshCondition::edge_boundary, 16}, {condition, 1}})
        .tangents({{no_normal, 1}})
        .tangents_near(0, "along the texture", along_x);
}

Mesh with_normals_of_lengths() {
    return changed(textured_torus(), [](Mesh& mesh, std::size_t v) {
        mesh.normals[v] *= std::ldexp(1.0F, 20 * (static_cast<int>(v % 5) - 2));
    });
}

/// The normals of the grid turned into its surface: along u.
Mesh with_normals_along_the_texture() {
    return changed(textured_grid(), [](Mesh& mesh, std::size_t v) { mesh.normals[v] = {1, 0, 0}; });
}

}  // namespace

std::vector<HardCase> tangent_cases() {
    using enum MeshCondition;
    return {
        MeshCase("texture on a line", "A grid that shows a line of the image.",
                 "MikkTSpace#1, lslib#51", collinear_texture)
            .checked({{edge_boundary, 16}, {texture_degenerate, 32}})
            .tangents({{no_gradient, 32}, {no_direction, 96}})
            .tangents_near(
                0, "the x axis, turned into the plane of the normal",
                [](const Mesh&, std::size_t) { return std::optional(glm::dvec4(1, 0, 0, -1)); }),
        MeshCase("texture on one side only", "A grid half of which shows a line of the image.",
                 "meshes unwrapped in part", half_textured)
            .checked({{edge_boundary, 16}, {texture_degenerate, 16}})
            .tangents({{no_gradient, 16}, {no_direction, 36}})
            .tangents_near(
                0, "the texture's, also where there is none",
                [](const Mesh&, std::size_t) { return std::optional(glm::dvec4(1, 0, 0, 0)); }),
        MeshCase("sliver with a good texture",
                 "A triangle of length 1 and width 1e-6 that shows the whole image.",
                 "glTF-Transform#1859", textured_sliver)
            .checked({{triangle_needle, 1}, {edge_boundary, 3}})
            .tangents()
            .tangents_near(1e-4, "its length", along_sliver),
        MeshCase(
            "texture on a triangle of no area",
            "A square, and a triangle on its edge that lies on a line in space, but has an area "
            "in the image.",
            "the conformance kit: a corner of angle 0 has no weight, but a direction",
            textured_line)
            .checked({{triangle_collinear, 1}, {edge_boundary, 5}, {vertex_degenerate_fan, 1}})
            .tangents()
            .tangents_near(1e-5, "each triangle's own", on_textured_line),
        MeshCase("mirrored texture on shared vertices",
                 "A grid whose image is mirrored about its middle column.", "Godot#114508",
                 mirrored_grid)
            .checked({{edge_boundary, 16}, {texture_mirrored, 16}, {texture_overlapping, 32}})
            .tangents()
            .tangents_near(0, "each side's own", mirrored_reference)
            .expect("frames", "5 vertices of the line are split, and no other", wrongly_split),
        MeshCase("no gradient between both handednesses",
                 "A triangle that shows a line, between an upright and a mirrored one.",
                 "glTF#2480: w must be one all over a triangle", between_handednesses)
            .checked({{edge_boundary, 5}, {texture_degenerate, 1}, {texture_mirrored, 1}})
            .tangents({{no_gradient, 1}}),
        texture_scale_case(1e-18F),
        texture_scale_case(1e-25F),
        texture_scale_case(1e18F),
        MeshCase("texture a million from its origin",
                 "A wavy grid whose texture coordinates are multiples of 1/16 out there, which is "
                 "what floats are.",
                 "MikkTSpace and meshoptimizer: 540 of 3072 corners lean, measured",
                 [] {
                     return changed(coarsely_textured(), [](Mesh& mesh, std::size_t v) {
                         mesh.texcoords[v] += glm::vec2(far, -far);
                     });
                 })
            .checked({{edge_boundary, 24}, {texture_far_away, 1}})
            .tangents()
            .expect("tangents", "exactly those of the texture moved back",
                    differs_from(coarsely_textured, 0.0)),
        texture_value_case("NaN in a texture coordinate", not_a_number),
        texture_value_case("infinity in a texture coordinate", infinity),
        normal_value_case("normal of length zero", {0, 0, 0}, normal_zero),
        normal_value_case("normal that is NaN", {0, not_a_number, 1}, normal_not_finite),
        normal_value_case("normal that is infinite", {0, 0, infinity}, normal_not_finite),
        MeshCase("normals of any length", "A torus with normals of lengths from 2^-40 to 2^40.",
                 "MikkTSpace and meshoptimizer: 3000 of 3072 corners lean, measured",
                 with_normals_of_lengths)
            .tangents()
            .expect("tangents", "exactly those of unit normals", differs_from(textured_torus, 0.0)),
        MeshCase("normals along the texture", "A flat grid whose normals are where u grows.",
                 "baked meshes with broken normals", with_normals_along_the_texture)
            .tangents({{no_direction, 96}, {along_normal, 96}}),
        position_scale_case(1e-25F, "underflow of squared lengths"),
        position_scale_case(1e20F, "meshoptimizer: 3067 NaN, measured"),
        position_scale_case(1e25F, "overflow of squared lengths"),
    };
}

}  // namespace relief::test
