// SPDX-License-Identifier: Apache-2.0
/// \file
/// Buffer views that EXT_meshopt_compression or KHR_meshopt_compression has compressed.
/// Tests: tests/mesh/io/gltf/gltf_meshopt_test.cpp.
#pragma once

#include <vector>

#include "io/gltf/gltf_contents.h"

namespace relief {

/// Which buffers are only stand-ins: those that have no URI and are not the binary chunk of a GLB,
/// or say so themselves, where all that refers to them are views with a compressed copy elsewhere.
std::vector<bool> meshopt_placeholders(const Json& root, bool has_binary_chunk);

/// Decodes every view that lies in a buffer without data.
///
/// The views then lie in a buffer of their own, and nothing says any more that they were
/// compressed; a view whose plain data is there as well keeps both. Nothing happens, and nothing is
/// paid, where there are no such views.
/// \throws InvalidInput naming the view, if its parameters contradict each other or its data is
///         damaged
void unpack_meshopt(GltfContents& contents);

}  // namespace relief
