// SPDX-License-Identifier: Apache-2.0
/// \file
/// Additions to a glTF document (bytes, buffer views, accessors) and removal of extensions.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "io/gltf/gltf_contents.h"

namespace relief {

/// Reserves capacity for bytes that will be appended.
void reserve_bytes(GltfContents& contents, std::size_t count);

/// Appends bytes to the buffer of added data, at a multiple of 4. \return their offset
std::size_t append_bytes(GltfContents& contents, std::string_view bytes);

/// Appends bytes as a new buffer view. \return its index
std::size_t add_view(GltfContents& contents, std::string_view bytes);

/// Appends packed elements of `size` bytes as a new buffer view, with the alignment that `target`
/// requires.
/// \return the view's index
std::size_t add_elements(GltfContents& contents, std::size_t size, const std::string& elements,
                         int target);

/// Adds an accessor with its own buffer view. `accessor` has all properties except location and
/// count.
/// \return its index
std::size_t add_accessor(GltfContents& contents, Json accessor, const std::string& elements,
                         int target);

/// Like add_accessor(), but reuses an equal accessor that was added by this function. Primitives
/// that shared an accessor thus share its replacement.
std::size_t add_shared_accessor(GltfContents& contents, Json accessor, const std::string& elements,
                                int target);

/// Updates min and max, if the accessor has them. If elements are not finite, the old bounds stay,
/// because JSON cannot hold them.
void update_bounds(Json& accessor, const std::string& elements);

/// Removes an extension from an object that may have it.
void erase_extension(Json& holder, const char* extension);

/// Removes an extension from extensionsUsed and extensionsRequired if no object has it.
void remove_unused_extension(Json& root, std::string_view extension);

}  // namespace relief
