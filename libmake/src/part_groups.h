// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of a dense mesh that a bake keeps apart. Tests: tests/make/part_matching_test.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "relief/make/asset.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/material.h"
#include "relief/mesh/mesh.h"

namespace relief::make::detail {

/// Joins parts of equal names, and parts with a vertex at the same position: rays at the border
/// between them must hit both. The names are joined, too: "base + hinge".
/// \param mesh  valid
/// \return the parts in the order of their first names; none without names
NamedParts separate_parts(const Mesh& mesh, const NamedParts& parts);

/// Returns the parts of a mesh whose vertices are copies of those of another one.
/// \param part_of  by triangle of `before`, whose parts share no vertex
std::vector<std::uint32_t> parts_of_copy(const Mesh& before, std::span<const std::uint32_t> part_of,
                                         const FramedMesh& after);

/// Returns a range for each run of triangles of one part, whose number is the material.
std::vector<MaterialRange> ranges_of(std::span<const std::uint32_t> part_of);

/// The inverse of ranges_of().
std::vector<std::uint32_t> parts_of_ranges(const Mesh& mesh);

constexpr std::uint32_t alpha_count = 3;  ///< Of AlphaMode.

/// Numbers pairs of a part and an alpha mode: alpha_count * part + mode. \param parts,alpha  may be
/// empty
std::vector<std::uint32_t> pairs_of(std::span<const std::uint32_t> parts,
                                    std::span<const AlphaMode> alpha);

/// Groups of triangles of both meshes, whose rays hit only their own group.
struct RayGroups {
    std::vector<std::string> names;
    std::vector<std::uint32_t> of_high;  ///< By triangle, an index of `names`.
    std::vector<std::uint32_t> of_low;
};

/// Combines parts and alpha modes. An iris behind a cornea gets its own colors, also where they
/// touch.
/// \param high_parts,low_parts  without names or numbers, all triangles are one part
/// \param high_alpha,low_alpha  empty: they are not kept apart
/// \return one group without parts and alpha modes; without those of alpha if a triangle of the
///         asset would see nothing
RayGroups ray_groups(const NamedParts& high_parts, std::span<const std::uint32_t> low_parts,
                     std::span<const AlphaMode> high_alpha, std::span<const AlphaMode> low_alpha);

/// The vertices that triangles of each key use, ascending.
class KeyedVertices {
  public:
    /// \param keys  by triangle of the mesh, below `count`
    KeyedVertices(const Mesh& mesh, std::span<const std::uint32_t> keys, std::size_t count);

    /// A key that uses a vertex, and the number of the vertex among those of the key.
    struct Use {
        std::uint32_t key = 0;
        std::uint32_t number = 0;
    };

    /// Returns the keys of a vertex, ascending.
    [[nodiscard]] std::span<const Use> of(std::uint32_t vertex) const {
        return std::span(uses_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    [[nodiscard]] std::uint32_t number(std::uint32_t vertex, std::uint32_t key) const;
    [[nodiscard]] std::size_t vertex_count(std::uint32_t key) const { return counts_[key]; }

  private:
    std::vector<std::size_t> first_;  ///< By vertex: its first use.
    std::vector<Use> uses_;
    std::vector<std::uint32_t> counts_;  ///< By key.
};

/// Divides a mesh into those of its triangles with each key, with all attributes and materials, but
/// no smoothing groups. Triangles and vertices keep their order.
std::vector<Mesh> divided(const Mesh& mesh, std::span<const std::uint32_t> keys, std::size_t count);

/// Meshes of parts, and the triangles that see them.
struct BakedParts {
    std::vector<Mesh> meshes;
    std::vector<BakePart> parts;  ///< They refer to `meshes`.
};

/// Divides a dense mesh by keys below `names.size()`, which both meshes have.
/// \param high_keys  by triangle of the dense mesh
/// \param low_keys  by triangle of the asset; each one is also a key of the dense mesh
BakedParts divided(const Mesh& high, std::span<const std::uint32_t> high_keys,
                   std::span<const std::uint32_t> low_keys, std::span<const std::string> names);

}  // namespace relief::make::detail
