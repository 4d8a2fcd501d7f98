// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hard_cases/mesh_case.h"
#include "hard_cases/mesh_cases.h"
#include "hard_cases/sample_meshes.h"
#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"

namespace relief::test {
namespace {

Mesh bare_torus() {
    const Mesh torus = make_torus(0.4F, 24, 12);
    return mesh_of(torus.positions, torus.triangles);
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

/// The normals of the torus before it was scaled, by angle.
std::optional<glm::dvec3> unscaled_normal(const Mesh&, std::size_t vertex) {
    static const std::vector<glm::vec3> normals = normals_of(bare_torus(), NormalWeight::angle);
    return glm::dvec3(normals[vertex]);
}

HardCase scale_case(float scale) {
    return MeshCase(
               fmt::format("torus of size {:g}", scale), "A torus, all its positions multiplied.",
               "meshoptimizer gives NaN at 1e20, measured", [scale] { return scaled_torus(scale); })
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

/// What is stored so far out, moved back, has the same normals to the last bit.
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
    mesh.positions[12].z = value;  // The middle of 5 x 5.
    return mesh;
}

HardCase non_finite_case(const std::string& name, float value) {
    using enum MeshCondition;
    return MeshCase(name,
                    "A flat grid whose middle vertex is nowhere; its six triangles are lost, all "
                    "others unharmed.",
                    "meshoptimizer: one NaN spoils 36 corners, measured",
                    [value] { return grid_with(value); })
        .checked({{triangle_not_finite, 6}, {edge_boundary, 22}, {vertex_not_finite, 1}})
        .normals({{"triangle with a non-finite corner", 6}, {"non-finite position", 1}})
        .accurate(all_weights(), 0, "the grid's; (0,0,1) at the vertex itself", facing_up)
        .tangents(
            {{"corner without texture direction", 6}, {"triangle with non-finite values", 6}});
}

/// What a call says when it refuses a mesh.
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
                 "MikkTSpace gives tangents of length zero, measured", far_grid)
            .checked({{edge_boundary, 24}, {mesh_far_away, 1}})
            .normals()
            .expect("normals", "the same bits as of the mesh moved back", differs_when_moved_back)
            .tangents(),
        non_finite_case("NaN in a position", std::numeric_limits<float>::quiet_NaN()),
        non_finite_case("infinity in a position", std::numeric_limits<float>::infinity()),
        MeshCase("index out of range", "A triangle that names a vertex that is not there.",
                 "bevy#8429",
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
        MeshCase("one triangle", "Nothing else.", "bevy#14874",
                 [] {
                     return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
                 })
            .checked({{edge_boundary, 3}})
            .normals()
            .accurate(all_weights(), 0, "its own", facing_up)
            .tangents(),
    };
}

}  // namespace relief::test
