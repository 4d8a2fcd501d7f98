// SPDX-License-Identifier: Apache-2.0
/// \file
/// Replaces the texture coordinates of a whole model, so that all its triangles share one map.
/// Tests: tests/tools/unwrap_test.cpp, unwrap_scene_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/model.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// All triangles of a model, as input of unwrap().
struct TexcoordInput {
    /// The meshes of a glTF document in its order, each in the size that it has in the scene; a
    /// material range for each primitive. For documents, it has no other attributes than texture
    /// coordinates and colors.
    const Mesh& mesh;
    /// The first vertex of each mesh (UnwrapOptions::first_vertices).
    std::vector<std::uint32_t> first_vertices;
};

/// Returns new texture coordinates: three for each triangle of the input, in corner order.
using TexcoordChange =
    std::function<std::vector<glm::vec2>(const TexcoordInput& input, Report& report)>;

struct TexcoordOptions {
    int set = 0;  ///< TEXCOORD_n of glTF; 0 for mesh files.
    /// Removes the textures that materials look up at replaced coordinates. Otherwise they stay,
    /// although they do not fit any more; both is reported.
    bool remove_textures = false;
};

/// The result of change_texcoords().
struct ChangedTexcoords {
    std::size_t triangles = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;
    bool has_tangents = false;
    std::vector<PartReport> reports;
    std::vector<std::string> notes;  ///< Notes that do not concern a defect of the input.
};

/// Gives all triangles of a model new texture coordinates. Vertices are split only where the new
/// coordinates of their corners differ; all other data of the model stays.
///
/// The size of a glTF mesh is that of its largest instance in the default scene; a skin sizes it by
/// its first joint at rest. Instances of a mesh share its coordinates. The texture coordinates of
/// the input are those of `set`, or of a primitive's first set if it does not have that one.
/// Tangents that belong to replaced coordinates are recomputed by MikkTSpace.
///
/// The findings about the input count triangles through the whole model.
/// \throws InvalidInput if there are no triangles, if `set` is negative or above the number of sets
///         in the model, if the change returns another number of coordinates, or if a texture is to
///         be removed that an animation changes
ChangedTexcoords change_texcoords(Model& model, const TexcoordOptions& options,
                                  const TexcoordChange& change);

}  // namespace relief
