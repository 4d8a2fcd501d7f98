// SPDX-License-Identifier: Apache-2.0
/// \file
/// One buffer for a document that is to be written, without what processing has replaced.
/// Tests: tests/mesh/io/gltf/gltf_frames_test.cpp.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "io/gltf/gltf_contents.h"

namespace relief {

/// JSON that refers to a single buffer, and the pieces of which that buffer is made, in order.
struct GltfLayout {
    Json root;
    std::vector<std::string_view> pieces;  ///< Into the contents, which must outlive them.
    std::size_t size = 0;                  ///< Bytes of all pieces.
};

/// Lays a document out for writing.
///
/// Retired accessors and buffer views to which nothing refers any more are left out, with their
/// bytes, and all numbers behind them move up; unless an extension is present that may refer to
/// them in a way which is not known: then all stays. Everything else, used or not, keeps its bytes,
/// their order and their alignment. Several buffers become one, which has the name, extras and
/// extensions of the first.
GltfLayout layout_of(const GltfContents& contents);

}  // namespace relief
