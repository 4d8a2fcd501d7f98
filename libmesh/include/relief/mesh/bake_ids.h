// SPDX-License-Identifier: Apache-2.0
/// \file
/// The ids of a baked surface: names of materials or parts, and a flat color for each. Part of the
/// library relief::bake. Tests: tests/mesh/bake/bake_ids_test.cpp.
#pragma once

#include <cstdint>
#include <glm/gtc/type_precision.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/mesh.h"

namespace RELIEF_API relief {

/// The name of the triangles from `first_triangle` to the next entry.
struct NamedTriangles {
    std::uint32_t first_triangle = 0;
    std::string name;

    friend bool operator==(const NamedTriangles&, const NamedTriangles&) = default;
};

/// The names of the triangles of a high mesh. Equal names are one id, also in several meshes.
struct HighIds {
    const Mesh* mesh = nullptr;             ///< A high mesh of the bake, identified by its address.
    std::vector<NamedTriangles> triangles;  ///< Ascending; the first entry begins at triangle 0.
};

/// A name and its color in maps of ids.
struct SurfaceId {
    std::string name;
    glm::u8vec3 color{0};

    friend bool operator==(const SurfaceId&, const SurfaceId&) = default;
};

/// Returns the names of a mesh's triangles by their materials.
///
/// \param names  by the indices of materials. A material without a name is "material-N", counted
///         from 0, and one with the name of an earlier one is "NAME-N"
/// \param other  the name of triangles without a material; if empty, "no-material"
std::vector<NamedTriangles> names_by_material(const Mesh& mesh, std::span<const std::string> names,
                                              const std::string& other = "");

/// Assigns a color to each name.
///
/// A color is a hash of its name. If no channel differs by 32 codes from the color of a name that
/// sorts before it, which happens to 1.5 % of pairs of names, further hashes are tried; for
/// hundreds of names the difference is reduced. So most names have the same color in every model.
/// No color is black, which is the background; the largest channel is at least 64.
///
/// \param names  in any order, with any repetitions
/// \return sorted by name (bytes), each name once; colors are unique
/// \throws InvalidInput if there are more than 65536 names
std::vector<SurfaceId> surface_ids(std::vector<std::string> names);

/// Returns the color as text: "#a0b1c2".
std::string color_text(const SurfaceId& id);

}  // namespace relief
