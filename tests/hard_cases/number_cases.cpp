// SPDX-License-Identifier: Apache-2.0
// Hard cases of numbers: extreme scales and positions, rounding, non-finite values, stored normals
// and tangents, and encoded frames.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hard_cases/hard_cases.h"
#include "hard_cases/mesh_case.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/shapes.h"

namespace relief::test {
namespace {

Mesh bare_torus() {
    const Mesh torus = make_torus(0.4F, 24, 12);
    return mesh_from(torus.positions, torus.triangles);
}

Mesh scaled_torus(float scale) {
    Mesh mesh = bare_torus();
    for (glm::vec3& position : mesh.positions)
        position *= scale;
    return mesh;
}

std::vector<glm::vec3> normals_of(const Mesh& mesh, NormalWeight weight) {
    Report report;
    return vertex_normals(mesh.positions, mesh.triangles, weight, report);
}

/// The normals of the torus before scaling, weighted by angle.
std::optional<glm::dvec3> unscaled_normal(const Mesh&, std::size_t vertex) {
    static const std::vector<glm::vec3> normals = normals_of(bare_torus(), NormalWeight::angle);
    return glm::dvec3(normals[vertex]);
}

HardCase scale_case(float scale) {
    return MeshCase(fmt::format("torus of size {:g}", scale), "A torus with scaled positions.",
                    "meshoptimizer returns NaN at 1e20 (measured)",
                    [scale] { return scaled_torus(scale); })
        .checked({})
        .normals()
        .accurate({NormalWeight::angle}, 1e-4, "those at size 1", unscaled_normal)
        .tangents();
}

constexpr float distance = 1e6F;

Mesh far_grid() {
    Mesh mesh = wavy_grid(6);
    for (glm::vec3& position : mesh.positions)
        position += glm::vec3(distance, -distance, distance);
    return mesh;
}

/// Returns a problem unless the mesh has the same normals, bit for bit, after it is moved back to
/// the origin.
std::string differs_when_moved_back(const Mesh& mesh) {
    Mesh near = mesh;
    for (glm::vec3& position : near.positions)
        position -= glm::vec3(distance, -distance, distance);
    for (const NormalWeight weight : all_weights()) {
        if (normals_of(near, weight) != normals_of(mesh, weight)) return "the normals differ";
    }
    return "";
}

Mesh grid_with(float value) {
    Mesh mesh = flat_grid(4);
    mesh.positions[12].z = value;  // The middle of 5 x 5 vertices.
    return mesh;
}

HardCase non_finite_case(const std::string& name, float value) {
    using enum MeshCondition;
    return MeshCase(name,
                    "A flat grid whose middle vertex has no finite position; its six triangles are "
                    "skipped, all others are unaffected.",
                    "meshoptimizer: one NaN affects 36 corners (measured)",
                    [value] { return grid_with(value); })
        .checked({{triangle_not_finite, 6}, {edge_boundary, 22}, {vertex_not_finite, 1}})
        .normals({{"triangle with a non-finite corner", 6}, {"non-finite position", 1}})
        .accurate(all_weights(), 0, "the grid's; (0,0,1) at the vertex itself", facing_up)
        .tangents(
            {{"corner without texture direction", 6}, {"triangle with non-finite values", 6}});
}

/// Returns the error message of a call that refuses a mesh.
template <typename Call>
std::string refusal_of(const Call& call) {
    try {
        call();
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "nothing";
}

std::string wrongly_refused(const Mesh& mesh) {
    const std::string expected = "triangle 2 names vertex 4, but there are only 4";
    const std::string checked = refusal_of([&] { diagnose(mesh); });
    const std::string normals = refusal_of([&] { normals_of(mesh, NormalWeight::angle); });
    if (checked != expected) return "check says: " + checked;
    return normals == expected ? "" : "normals say: " + normals;
}

}  // namespace

std::vector<HardCase> number_cases() {
    using enum MeshCondition;
    return {
        scale_case(1e-30F),
        scale_case(1e-20F),
        scale_case(1e20F),
        scale_case(1e30F),
        MeshCase("a million from the origin",
                 "A wavy grid with cells of size 1, where floats are 1/16 apart.",
                 "MikkTSpace returns tangents of length zero (measured)", far_grid)
            .checked({{edge_boundary, 24}, {mesh_far_away, 1}})
            .normals()
            .expect("normals", "the same bits as at the origin", differs_when_moved_back)
            .tangents(),
        non_finite_case("NaN in a position", std::numeric_limits<float>::quiet_NaN()),
        non_finite_case("infinity in a position", std::numeric_limits<float>::infinity()),
        MeshCase("index out of range", "A triangle that refers to a missing vertex.", "bevy#8429",
                 [] {
                     Mesh mesh = square();
                     mesh.triangles.push_back({0, 1, 4});
                     return mesh;
                 })
            .expect("check, normals",
                    "refused: \"triangle 2 names vertex 4, but there are only 4\"",
                    wrongly_refused),
        MeshCase("empty mesh", "No vertex and no triangle.", "bevy#8429", [] { return Mesh{}; })
            .checked({})
            .normals()
            .tangents(),
        MeshCase("one triangle", "A single triangle.", "bevy#14874",
                 [] {
                     return mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
                 })
            .checked({{edge_boundary, 3}})
            .normals()
            .accurate(all_weights(), 0, "its own", facing_up)
            .tangents(),
    };
}

namespace {

/// A square with an upright image.
Mesh textured_square() {
    Mesh mesh = square_with_normals(std::vector<glm::vec3>(4, {0, 0, 1}));
    mesh.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    return mesh;
}

Mesh square_with_tangents(const std::vector<glm::vec4>& tangents) {
    Mesh mesh = square_with_normals(std::vector<glm::vec3>(4, {0, 0, 1}));
    mesh.tangents = tangents;
    return mesh;
}

}  // namespace

std::vector<HardCase> stored_cases() {
    using enum MeshCondition;
    return {
        MeshCase(
            "invalid normals", "A square whose normals are NaN, zero, of length 2, and valid.",
            "MikkTSpace: 3000 wrong corners with normals that are not unit (measured)",
            [] {
                return square_with_normals({{0, 0, not_a_number}, {0, 0, 0}, {0, 0, 2}, {0, 0, 1}});
            })
            .checked({{edge_boundary, 4},
                      {normal_not_finite, 1},
                      {normal_zero, 1},
                      {normal_not_unit, 1}})
            .tangents({{"normal without direction", 2}}),
        MeshCase("normals that face backwards",
                 "A square with a normal that points backwards and one that lies in its plane.",
                 "the Corset of the glTF samples",
                 [] {
                     return square_with_normals({{0, 0, 1}, {0, 0, -1}, {0, 0, 1}, {1, 0, 0}});
                 })
            .checked({{edge_boundary, 4}, {normal_opposed, 1}, {normal_inconsistent, 1}})
            .tangents({{"corner without texture direction", 1},
                       {"texture direction along the normal", 1}}),
        MeshCase(
            "invalid tangents",
            "A square with a NaN tangent, one of length 2 without handedness, one "
            "along the normal, and one that deviates from the tangent plane by 6 "
            "degrees.",
            "the VertexColorTest of the glTF samples",
            [] {
                return square_with_tangents(
                    {{not_a_number, 0, 0, 1}, {2, 0, 0, 0}, {0, 0, 1, 1}, {0.995F, 0, 0.1F, 1}});
            })
            .checked({{edge_boundary, 4},
                      {tangent_not_finite, 1},
                      {tangent_not_unit, 1},
                      {tangent_invalid_sign, 1},
                      {tangent_along_normal, 1},
                      {tangent_not_perpendicular, 1}})
            .tangents(),
        MeshCase("all texture coordinates equal",
                 "A square whose corners have the same texture coordinates.",
                 "MikkTSpace#1, lslib#51",
                 [] {
                     return changed(textured_square(), [](Mesh& mesh, std::size_t v) {
                         mesh.texcoords[v] = {0.5F, 0.5F};
                     });
                 })
            .checked({{edge_boundary, 4}, {texture_degenerate, 2}})
            .tangents({{"corner without texture direction", 6},
                       {"triangle without texture gradient", 2}}),
        MeshCase("texture coordinate that is NaN",
                 "A square with one NaN corner; its triangles have no position in the image.",
                 "exporters that divide by zero",
                 [] {
                     Mesh mesh = textured_square();
                     mesh.texcoords[1].x = not_a_number;
                     return mesh;
                 })
            .checked({{edge_boundary, 4}, {texture_not_finite, 1}})
            .tangents(
                {{"corner without texture direction", 1}, {"triangle with non-finite values", 1}}),
        MeshCase("mirrored texture", "A square with a mirrored image.", "Godot#114508",
                 [] {
                     return changed(textured_square(), [](Mesh& mesh, std::size_t v) {
                         mesh.texcoords[v].x = 1.0F - mesh.texcoords[v].x;
                     });
                 })
            .checked({{edge_boundary, 4}, {texture_mirrored, 2}})
            .tangents(),
        MeshCase("overlapping texture",
                 "A square whose two triangles have the same texture coordinates.",
                 "bakes in which two triangles write to one texel",
                 [] {
                     Mesh mesh = textured_square();
                     mesh.positions.push_back(mesh.positions[0]);
                     mesh.positions.push_back(mesh.positions[2]);
                     mesh.triangles[1] = {4, 5, 3};
                     mesh.normals.resize(6, {0, 0, 1});
                     mesh.texcoords = {{0, 1}, {1, 1}, {1, 0}, {1, 0}, {0, 1}, {1, 1}};
                     return mesh;
                 })
            .checked({{edge_boundary, 4}, {texture_overlapping, 2}})
            .tangents(),
    };
}

namespace {

/// Vertices with each handedness for rotations by 180 degrees about many axes. The real part of
/// their quaternions is 0, and its sign is the handedness.
Mesh half_turns() {
    Mesh mesh;
    for (int x = -3; x <= 3; ++x) {
        for (int y = -3; y <= 3; ++y) {
            for (int z = -3; z <= 3; ++z) {
                const glm::dvec3 axis(x, y, z);
                if (axis == glm::dvec3(0.0)) continue;
                const glm::dvec3 unit = glm::normalize(axis);
                const auto turned = [&](const glm::dvec3& v) {
                    return 2.0 * glm::dot(unit, v) * unit - v;
                };
                for (const float w : {1.0F, -1.0F}) {
                    mesh.positions.emplace_back(axis);
                    mesh.normals.emplace_back(turned({0.0, 0.0, 1.0}));
                    mesh.tangents.emplace_back(glm::vec3(turned({1.0, 0.0, 0.0})), w);
                }
            }
        }
    }
    return mesh;
}

/// The tolerance of unit length and perpendicularity: the resolution of unit vectors in floats.
constexpr double resolved = 2e-7;

std::string lost_in_codes(const Mesh& mesh) {
    for (const FrameEncoding encoding : all_frame_encodings) {
        for (const FrameRounding rounding : {FrameRounding::nearest, FrameRounding::best}) {
            Report report;
            const Frames frames = decode_frames(
                encode_frames(mesh.normals, mesh.tangents, encoding, rounding, report), encoding,
                report);
            if (!report.empty()) return to_string(report.findings().front());
            for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
                const glm::dvec3 normal(frames.normals[v]);
                const glm::dvec3 tangent(frames.tangents[v]);
                const bool is_frame = std::abs(glm::length(normal) - 1.0) <= resolved &&
                                      std::abs(glm::length(tangent) - 1.0) <= resolved &&
                                      std::abs(glm::dot(normal, tangent)) <= resolved;
                if (is_frame && frames.tangents[v].w == mesh.tangents[v].w) continue;
                return fmt::format("encoding {}, vertex {}", static_cast<int>(encoding), v);
            }
        }
    }
    return "";
}

}  // namespace

std::vector<HardCase> encoding_cases() {
    return {MeshCase("encoded frames, rotated by 180 degrees",
                     "Right- and left-handed frames, rotated by 180 degrees about 342 axes, where "
                     "the real part of a quaternion is 0.",
                     "QTangents lose the sign when the real part is rounded to 0", half_turns)
                .expect("encodings", "orthonormal with unchanged w, in each of the eight encodings",
                        lost_in_codes)};
}

}  // namespace relief::test
