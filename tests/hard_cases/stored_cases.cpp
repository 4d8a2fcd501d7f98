// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "hard_cases/mesh_case.h"
#include "hard_cases/mesh_cases.h"
#include "hard_cases/sample_meshes.h"
#include "hard_cases/tangent_samples.h"
#include "support/no_numbers.h"

namespace relief::test {
namespace {

Mesh square_with_normals(const std::vector<glm::vec3>& normals) {
    Mesh mesh = square();
    mesh.normals = normals;
    return mesh;
}

/// The image upright on the square.
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
            "normals that are none",
            "A square whose normals are NaN, zero, of length 2, and sound.",
            "MikkTSpace: 3000 bad corners from normals that are not unit, measured",
            [] {
                return square_with_normals({{0, 0, not_a_number}, {0, 0, 0}, {0, 0, 2}, {0, 0, 1}});
            })
            .checked({{edge_boundary, 4},
                      {normal_not_finite, 1},
                      {normal_zero, 1},
                      {normal_not_unit, 1}})
            .tangents({{"normal without direction", 2}}),
        MeshCase("normals that face the wrong way",
                 "A square with a normal that points backwards and one that lies in it.",
                 "the Corset of the glTF samples",
                 [] {
                     return square_with_normals({{0, 0, 1}, {0, 0, -1}, {0, 0, 1}, {1, 0, 0}});
                 })
            .checked({{edge_boundary, 4}, {normal_opposed, 1}, {normal_inconsistent, 1}})
            .tangents({{"corner without texture direction", 1},
                       {"texture direction along the normal", 1}}),
        MeshCase(
            "tangents that are none",
            "A square whose tangents are NaN, of length 2 without handedness, along the "
            "normal, and leaning by 6 degrees.",
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
        MeshCase("all texture coordinates equal", "A square that shows one point of the image.",
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
                 "One corner of a square; its triangles have no place in the image.",
                 "exporters that divide by zero",
                 [] {
                     Mesh mesh = textured_square();
                     mesh.texcoords[1].x = not_a_number;
                     return mesh;
                 })
            .checked({{edge_boundary, 4}, {texture_not_finite, 1}})
            .tangents(
                {{"corner without texture direction", 1}, {"triangle with non-finite values", 1}}),
        MeshCase("mirrored texture", "A square that shows the image the wrong way round.",
                 "Godot#114508",
                 [] {
                     return changed(textured_square(), [](Mesh& mesh, std::size_t v) {
                         mesh.texcoords[v].x = 1.0F - mesh.texcoords[v].x;
                     });
                 })
            .checked({{edge_boundary, 4}, {texture_mirrored, 2}})
            .tangents(),
        MeshCase("overlapping texture",
                 "A square whose two triangles show the same half of the image.",
                 "bakes where two places write one texel",
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

}  // namespace relief::test
