// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads and writes mesh files without a scene: OBJ with MTL, PLY, STL, OFF. For glTF see
/// gltf_document.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// A material of an MTL file: Phong's model, colors linear as given.
///
/// Image paths are resolved against the folder of the MTL file; the images need not exist.
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
    /// Further statements of the file: "map_Ka", "map_Ns", "disp", "refl"; and "-s", "-o" if a map
    /// above has a scale or an offset.
    std::vector<std::string> more;
    /// The maps above that lie outside of the folder of the OBJ file, unless the limits of the
    /// process permit them (limits.h). Their paths are kept, but the images are not read.
    std::vector<std::filesystem::path> outside_maps{};

    /// Returns whether the image of a map may be read.
    [[nodiscard]] bool may_read(const std::filesystem::path& map) const;
};

/// A mesh and the materials that its ranges name.
struct MeshFile {
    Mesh mesh;
    std::vector<MtlMaterial> materials;
    /// Positions are relative to this origin: add it to get the coordinates of the file. It is zero
    /// except for meshes so far from 0 that floats cannot hold their digits.
    glm::dvec3 origin{0.0};
    /// Names of OBJ objects (o), or of groups (g) in a file without o, in order of first use; ""
    /// for triangles before the first one. Other formats have none.
    std::vector<std::string> objects{};
    /// The object of each triangle; empty if there is only one.
    std::vector<std::uint32_t> object_of{};
    /// The OBJ file that was read, and its MTL files; empty for other formats.
    std::vector<std::filesystem::path> sources{};
};

/// Reads OBJ, PLY, STL or OFF, by extension.
///
/// Polygons are triangulated by a fixed rule. A quad is cut along the diagonal that is shorter in
/// texture space. Without texture coordinates, or if they give equal lengths, the diagonal that is
/// shorter in object space is used; on a further tie the one from the first corner to the third
/// (the rule of MikkTSpace, so that tangents agree with those of the quad mesh). A concave quad is
/// cut at its reflex corner. Larger polygons are cut into ears in the plane of their Newell normal.
///
/// OBJ corners with the same bits of position, texture coordinate, normal and color become one
/// vertex. PLY and OFF vertices do not change (except if PLY stores texture coordinates per face).
/// STL corners with equal positions become one vertex; facet normals are ignored, because they
/// follow from the positions. v is flipped to the upper left origin: all these formats have v
/// upwards. OBJ triangles are grouped by material, in order of first use.
///
/// If a mesh is farther from 0 than 16 times its size, and floats cannot hold the digits of its
/// numbers (text or double), its positions are relative to a local origin, which is reported.
///
/// \param report  counts faces of fewer than three corners (left out), polygons without an ear (cut
///         as fans), corners without attributes that others have (completed), points, lines and
///         other parts that are left out, unknown materials, and MTL files that are unreadable or
///         outside of the folder of the OBJ file (limits.h)
/// \return a valid mesh (mesh.h). Non-manifold, degenerate and non-finite parts are kept. A
/// material that no MTL file defines has its name and default values
/// \throws FileError if the file is missing, unreadable or malformed, names a missing vertex, or
///         has no triangle
MeshFile read_mesh(const std::filesystem::path& file, Report& report = IgnoredReport());

/// Writes OBJ (with MTL if there are materials) or binary PLY, by extension.
///
/// Written are positions, normals, texture coordinates (v flipped back), colors and, in OBJ,
/// materials. The origin is added to positions; PLY then stores doubles. Reading the file again
/// gives the same floats (OBJ: v closer to 0 than 2e-9 within 1.2e-16; PLY: v within 6e-8).
/// Tangents are left out, because neither format can hold them.
///
/// \param report  names each material whose name is changed, because OBJ cannot hold it: it is
///                empty, that of an earlier material, or has blanks or line breaks; likewise the
///                name of the mesh if it has line breaks
///
/// Temporary files are written and renamed: after a failure there is no partial file, and the old
/// ones are unchanged, also the materials of an OBJ file unless the file system cannot exchange two
/// files (NFS, vfat).
/// \throws FileError if the file cannot be written, if the MTL file is one of `contents.sources`,
///         whose OBJ file is another one, or if the name of an image begins or ends with a blank or
///         has a line break or a backslash, which MTL cannot hold; InvalidInput for another
///         extension, or if the mesh is not valid or names a missing material
void write_mesh(const std::filesystem::path& file, const MeshFile& contents,
                Report& report = IgnoredReport());

}  // namespace relief
