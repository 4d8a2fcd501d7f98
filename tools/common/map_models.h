// SPDX-License-Identifier: Apache-2.0
/// \file
/// The models that maps are made of and for, from files. Tests: tests/tools/map_models_test.cpp.
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

/// object: each primitive of a document once, in its own axes. world: as the scene places them.
enum class ModelSpace { object, world };

/// A primitive of a document, or all of another file.
struct MapModelPart {
    std::string name;  ///< "mesh 'Body' primitive 0"; empty where it is all of the file.
    Mesh mesh;
    /// The names of its objects: of OBJ files (MeshFile::objects), or the node that places it.
    std::vector<std::string> objects{};
    std::vector<std::uint32_t> object_of{};  ///< By triangle; empty: all of the same.
    int texcoord_set = 0;                    ///< Of a document: which the mesh has.
};

/// What a scene's materials look like, as files have it: nothing is decoded.
struct MapLooks {
    std::vector<GltfMaterial> materials;
    std::vector<GltfImage> images;
};

struct MapModel {
    std::vector<MapModelPart> parts;
    MapLooks looks;  ///< By the same numbers as `materials`; only of models in world space.
    std::vector<std::string> materials;  ///< Names, by the numbers in the parts' material ranges.
    glm::dvec3 origin{0.0};              ///< Positions are relative to it (mesh_file.h).
    /// How the only primitive of a scene is placed; absent where there are several. Mesh files: as
    /// they are.
    std::optional<glm::dmat3> world_from_object;
};

/// All triangles of a model, with what a map on them depends on.
///
/// Texture coordinates are those that glTF's tangents belong to: the set of a primitive's normal
/// texture (GltfDocument::tangent_texcoords). Normals and tangents are the file's. Where a glTF
/// primitive has no normals, they are flat, as glTF asks, and its tangents are left out; where some
/// primitives of a scene have tangents, the others get MikkTSpace's, as a renderer gives them.
/// Other files without normals have none here either. \throws FileError, UsageError if the file
/// cannot be read
MapModel read_map_model(const std::filesystem::path& file, ModelSpace space, Report& report);

/// Every part must have texture coordinates, without which no map lies on it.
/// \throws FileError, naming the part that has none, with what is wrong and what to do
void require_texcoords(const std::filesystem::path& file, const MapModel& model,
                       const std::string& problem, const std::string& remedy);

/// The parts as one mesh, in their order, with those attributes that all of them have, and their
/// material ranges. Colours also where only some have them: the others are white, as glTF says.
/// \throws InvalidInput if there are more vertices than indices can name
Mesh joined(std::vector<MapModelPart> parts);

/// Makes positions relative to another origin.
void move_to(MapModel& model, const glm::dvec3& origin);

}  // namespace relief::tools
