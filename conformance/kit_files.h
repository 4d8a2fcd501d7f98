// SPDX-License-Identifier: Apache-2.0
/// \file
/// The kit's meshes as files. Written here, not by relief's own glTF documents, so that the bytes
/// stay what they are, and values that glTF frowns on (normals of any length) stay in.
/// Tests: tests/tools/conformance_kit_test.cpp.
#pragma once

#include <filesystem>
#include <vector>

#include "kit_meshes.h"

namespace relief::conformance {

/// GLB with POSITION, NORMAL and TEXCOORD_0 as floats, indices as 16-bit numbers where there are
/// any, one primitive, one node, and no TANGENT.
void write_glb(const std::filesystem::path& file, const KitMesh& mesh);

/// OBJ with the mesh's quads; numbers read back as the same floats.
void write_obj(const std::filesystem::path& file, const KitMesh& mesh);

/// kit.json: name, group, what it is about, numbers of vertices and triangles of each mesh.
void write_list(const std::filesystem::path& file, const std::vector<KitMesh>& meshes);

}  // namespace relief::conformance
