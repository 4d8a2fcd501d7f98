// SPDX-License-Identifier: Apache-2.0
/// \file
/// The animations of a glTF document's nodes, in plain data.
/// Tests: tests/mesh/io/gltf/gltf_animation_test.cpp.
#pragma once

#include <vector>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"

namespace relief {

/// See GltfDocument::animations.
std::vector<GltfAnimation> animations_of(const GltfContents& contents, Report& report);

}  // namespace relief
