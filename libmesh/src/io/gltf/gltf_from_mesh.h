// SPDX-License-Identifier: Apache-2.0
/// \file
/// A glTF document made from a mesh. Tests: tests/mesh/io/gltf/gltf_from_mesh_test.cpp.
#pragma once

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief {

/// See GltfDocument::from_mesh.
///
/// \param report  null: an image that cannot be read is a FileError
GltfContents gltf_from_mesh(const MeshFile& file, Report* report);

}  // namespace relief
