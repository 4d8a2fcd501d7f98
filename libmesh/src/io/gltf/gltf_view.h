// SPDX-License-Identifier: Apache-2.0
/// \file
/// A glTF document as a scene in plain data. Tests: tests/mesh/io/gltf/gltf_view_test.cpp.
#pragma once

#include <vector>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"

namespace relief {

/// See GltfDocument::triangle_primitives.
std::vector<GltfPrimitiveId> triangle_primitives_of(const GltfContents& contents);

/// See GltfDocument::view.
GltfView view_of(const GltfContents& contents);

}  // namespace relief
