// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads the models of a bake: meshes, objects and materials.
/// Tests: tests/tools/map_models_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::tools {

/// object: each primitive of a document once, in object space. world: each instance in the scene.
enum class ModelSpace { object, world };

/// A primitive of a document, or the mesh of another file.
struct MapModelPart {
    std::string name;  ///< "mesh 'Body' primitive 0"; empty for the mesh of another file.
    Mesh mesh;
    /// The names of its objects: those of an OBJ file (MeshFile::objects), or the node.
    std::vector<std::string> objects{};
    std::vector<std::uint32_t> object_of{};  ///< By triangle; empty for a single object.
    int texcoord_set = 0;                    ///< The set in `mesh.texcoords` for a document.
};

/// The materials and images of a scene, without decoded pixels.
struct MapLooks {
    std::vector<GltfMaterial> materials;
    std::vector<GltfImage> images;
};

struct MapModel {
    std::vector<MapModelPart> parts;
    MapLooks looks;                      ///< In the order of `materials`; only in world space.
    std::vector<std::string> materials;  ///< Names, by the indices in the material ranges.
    glm::dvec3 origin{0.0};              ///< The origin of the positions (mesh_file.h).
    /// The transform of the only primitive of a scene, or the identity for a mesh file; absent for
    /// several primitives.
    std::optional<glm::dmat3> world_from_object;
};

/// Reads all triangles of a model with their attributes.
///
/// Texture coordinates are the set of a primitive's normal texture
/// (GltfDocument::tangent_texcoords). Normals and tangents are those of the file. A glTF primitive
/// without normals gets flat ones, as glTF requires, and no tangents. If only some primitives of a
/// scene have tangents, the others get those of MikkTSpace, as in a renderer. Other files without
/// normals get none. \throws FileError, UsageError if the file cannot be read
MapModel read_map_model(const std::filesystem::path& file, ModelSpace space, Report& report);

/// Checks that every part has texture coordinates.
/// \throws FileError with the part, the problem and the remedy
void require_texcoords(const std::filesystem::path& file, const MapModel& model,
                       const std::string& problem, const std::string& remedy);

/// Joins the parts in their order to one mesh with their material ranges and the attributes that
/// all of them have. Colors are kept if any part has them; the other parts are white, as in glTF.
/// \throws InvalidInput if there are too many vertices for 32-bit indices
Mesh joined(std::vector<MapModelPart> parts);

/// Changes the origin of the positions.
void move_to(MapModel& model, const glm::dvec3& origin);

}  // namespace relief::tools
