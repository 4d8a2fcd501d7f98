// SPDX-License-Identifier: Apache-2.0
/// \file
/// Changing a glTF document: bytes and accessors that are added, extensions that are taken out.
/// Tests: tests/mesh/io/gltf/gltf_frames_test.cpp.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "io/gltf/gltf_contents.h"

namespace relief {

/// Makes room for bytes that are to be appended.
void reserve_bytes(GltfContents& contents, std::size_t count);

/// Appends bytes, 4-aligned, to the buffer that holds what is added. \return where in it
std::size_t append_bytes(GltfContents& contents, std::string_view bytes);

/// Appends bytes as a new buffer view. \return its index
std::size_t add_view(GltfContents& contents, std::string_view bytes);

/// Appends packed elements of `size` bytes as a new buffer view, aligned as `target` asks.
/// \return the view's index
std::size_t add_elements(GltfContents& contents, std::size_t size, const std::string& elements,
                         int target);

/// Adds an accessor over its own buffer view; `accessor` says all but where and how many.
/// \return its index
std::size_t add_accessor(GltfContents& contents, Json accessor, const std::string& elements,
                         int target);

/// The same for one that others may need as well: an equal one that was added this way is taken
/// again, so that those who shared an accessor share the one that replaces it.
std::size_t add_shared_accessor(GltfContents& contents, Json accessor, const std::string& elements,
                                int target);

/// min and max of an accessor that had them: true for the elements that it has now. Where elements
/// are not finite the old ones stay, since JSON has no bounds for them.
void renew_bounds(Json& accessor, const std::string& elements);

/// Takes an extension away from an object that may have it.
void erase_extension(Json& holder, const char* extension);

/// Takes an extension's name out of extensionsUsed and extensionsRequired, if no object has it.
void forget_if_unused(Json& root, std::string_view extension);

}  // namespace relief
