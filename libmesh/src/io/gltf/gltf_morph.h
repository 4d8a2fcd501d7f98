// SPDX-License-Identifier: Apache-2.0
/// \file
/// New frames for a glTF primitive and for its morph targets.
/// Tests: tests/mesh/io/gltf/gltf_morph_test.cpp.
#pragma once

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"

namespace relief {

/// See GltfDocument::set_frames. \return how many vertices the primitive has now
std::size_t replace_all_frames(GltfContents& contents, GltfPrimitiveId id, const FramedMesh& framed,
                               const FrameOptions& options, Report& report);

}  // namespace relief
