// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which texture coordinates a glTF primitive has, and which of them its tangents belong to.
/// Tests: tests/mesh/io/gltf/gltf_tangent_texcoords_test.cpp.
#pragma once

#include <vector>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"

namespace relief {

/// See GltfDocument::texcoord_sets.
std::vector<int> texcoord_sets_of(const GltfContents& contents, GltfPrimitiveId id);

/// See GltfDocument::tangent_texcoords.
GltfTangentTexcoords tangent_texcoords_of(const GltfContents& contents, GltfPrimitiveId id);

}  // namespace relief
