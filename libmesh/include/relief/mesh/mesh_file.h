// SPDX-License-Identifier: Apache-2.0
/// \file
/// Mesh files without a scene: OBJ with MTL, PLY, STL, OFF. glTF has its own home: gltf_document.h.
/// Tests: tests/mesh/io/mesh/mesh_file_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

/// A material as an MTL file writes it: Phong's, colours linear as given.
///
/// Image paths are resolved against the MTL file's folder and not checked to exist.
struct MtlMaterial {
    std::string name;
    glm::vec3 ambient{0.0F};                            ///< Ka
    glm::vec3 diffuse{0.8F};                            ///< Kd
    glm::vec3 specular{0.0F};                           ///< Ks
    glm::vec3 emission{0.0F};                           ///< Ke
    float shininess = 0.0F;                             ///< Ns
    float opacity = 1.0F;                               ///< d, or 1 - Tr
    float refractive_index = 1.0F;                      ///< Ni
    int illumination_model = 2;                         ///< illum; 3 and above reflect
    std::optional<std::filesystem::path> diffuse_map;   ///< map_Kd
    std::optional<std::filesystem::path> specular_map;  ///< map_Ks
    std::optional<std::filesystem::path> emission_map;  ///< map_Ke
    std::optional<std::filesystem::path> opacity_map;   ///< map_d
    std::optional<std::filesystem::path> normal_map;    ///< norm
    std::optional<std::filesystem::path> bump_map;      ///< map_bump, bump: heights
    float bump_strength = 1.0F;                         ///< -bm of the bump map
    /// What the file says beyond that: "map_Ka", "map_Ns", "disp", "refl"; and "-s", "-o" where one
    /// of the maps above has a scale or an offset.
    std::vector<std::string> more;
};

/// A mesh and the materials that its ranges name.
struct MeshFile {
    Mesh mesh;
    std::vector<MtlMaterial> materials;
    /// Positions of the mesh are relative to this: add it for the coordinates of the file. Zero but
    /// for files far from 0 whose digits floats could not hold otherwise.
    glm::dvec3 origin{0.0};
    /// The names of OBJ's objects (o), or where it has none of its groups (g), in order of first
    /// use; "" for triangles before any. Other formats have none.
    std::vector<std::string> objects{};
    /// Which of them each triangle belongs to; empty where all belong to the same.
    std::vector<std::uint32_t> object_of{};
};

/// Reads OBJ, PLY, STL or OFF, by extension.
///
/// Polygons are triangulated by this rule. A quad is cut along the diagonal that is shorter in
/// texture space, or, where there are no texture coordinates or the two are equal, shorter in
/// object space, and on a further tie from its first corner to its third (MikkTSpace's rule, so
/// that tangents agree with those of the quad mesh); a concave quad is cut at its reflex corner.
/// Larger polygons are cut into ears in the plane of their Newell normal.
///
/// OBJ corners that share position, texture coordinate, normal and colour, bit for bit, become one
/// vertex; PLY and OFF vertices stay as they are (unless PLY stores texture coordinates by face);
/// STL corners with equal positions become one vertex, and its facet normals are not kept, since
/// they follow from the positions. v is turned to the upper left origin: all these formats are
/// written with v upwards. OBJ triangles are grouped by material, in order of first use.
///
/// Numbers written in text or as doubles whose digits floats cannot hold, because the mesh is
/// further from 0 than 16 times its size, are kept relative to an origin near it, which is counted.
///
/// \param report  counts faces of fewer than three corners (left out), polygons that no ear cut
///                fits (cut as fans), corners that lack what others have (filled in), points, lines
///                and whatever else is left out, unknown materials and unreadable MTL files
/// \return a valid mesh (mesh.h); non-manifold, degenerate and non-finite parts are kept as they
///         are. A material that no MTL file defines keeps its name and has default values
/// \throws FileError if the file is missing, unreadable, malformed, names a vertex that does not
///         exist, or has no triangle
MeshFile read_mesh(const std::filesystem::path& file, Report& report);

/// Writes OBJ (with MTL where there are materials) or binary PLY, by extension.
///
/// Positions, normals, texture coordinates (v turned back upwards), colours and, in OBJ, materials.
/// Positions are written with the origin added, in PLY as doubles where there is one. Numbers in
/// OBJ read back as the same floats (v closer to 0 than 2e-9 within 1.2e-16); so they do in PLY,
/// but for v, within 6e-8. Tangents have no place in either and are left out. \throws FileError if
/// it cannot be written; InvalidInput for another extension, or
///         if the mesh is not valid or names a material that is not there
///
/// Written beside and renamed: a failure leaves no half file and the old one unharmed.
void write_mesh(const std::filesystem::path& file, const MeshFile& contents);

}  // namespace relief
