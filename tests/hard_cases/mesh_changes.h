// SPDX-License-Identifier: Apache-2.0
/// \file
/// Changes of a mesh that must not change results: another order of triangles and vertices, rotated
/// corners, added collapsed and duplicate triangles, and scaling by powers of two. And the meshes
/// to which tests apply them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "hard_cases/random_meshes.h"
#include "relief/mesh/mesh.h"
#include "support/hard_meshes.h"
#include "support/sanitized.h"

namespace relief::test {

/// A changed mesh.
struct MeshVariant {
    /// The value in `original` of corners that the original mesh does not have.
    static constexpr std::uint32_t added = std::numeric_limits<std::uint32_t>::max();

    Mesh mesh;
    std::vector<std::uint32_t> original;  ///< By corner: the corner of the original, or `added`.
    float scale = 1.0F;                   ///< Of positions.
    float texture_scale = 1.0F;
    bool has_rotated_corners = false;

    explicit MeshVariant(const Mesh& given);
    void add_triangle(const glm::uvec3& triangle, std::uint32_t group,
                      const std::array<std::uint32_t, 3>& corners = {added, added, added});
};

struct MeshChange {
    const char* name;  ///< CamelCase, for names of tests.
    void (*apply)(MeshVariant& variant, Dice& dice);
};

void reorder_triangles(MeshVariant& variant, Dice& dice);
void reorder_vertices(MeshVariant& variant, Dice& dice);
void rotate_corners(MeshVariant& variant, Dice& dice);
/// Adds triangles with two or three corners at one vertex, or at two vertices with equal values.
void add_collapsed(MeshVariant& variant, Dice& dice);
void duplicate_all(MeshVariant& variant, Dice& dice);
/// Scales positions and texture coordinates if all values keep their bits.
void scale_by_power_of_two(MeshVariant& variant, Dice& dice);
/// Applies all changes except duplicate_all().
void change_all(MeshVariant& variant, Dice& dice);

inline constexpr MeshChange mesh_changes[] = {{"OrderOfTriangles", reorder_triangles},
                                              {"OrderOfVertices", reorder_vertices},
                                              {"RotatedCorners", rotate_corners},
                                              {"CollapsedTriangles", add_collapsed},
                                              {"PowersOfTwo", scale_by_power_of_two},
                                              {"EachTriangleTwice", duplicate_all},
                                              {"AllAtOnce", change_all}};

/// The changes that tests try. Under sanitizers, these are duplicates and all others at once: one
/// change alone calls the same code.
inline constexpr std::span<const MeshChange> tested_changes =
    is_sanitized ? std::span(mesh_changes).last(2) : std::span(mesh_changes);

/// Returns the name of a test whose parameter is a change.
inline constexpr auto name_of_change = [](const auto& info) {
    return std::string(info.param.name);
};

/// The hard meshes, those of the catalogue, 200 random meshes and 100 hostile ones. All have
/// normals, texture coordinates and tangents.
const std::vector<NamedMesh>& metamorphic_meshes();

}  // namespace relief::test
