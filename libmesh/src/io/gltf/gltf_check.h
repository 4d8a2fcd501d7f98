// SPDX-License-Identifier: Apache-2.0
/// \file
/// Validation of glTF documents, and the schema that it uses.
///
/// One table in gltf_check.cpp states the type of each property and which properties are indices.
/// It serves for checking a document and for renumbering its references.
#pragma once

#include <functional>
#include <string_view>

#include "io/gltf/gltf_contents.h"

namespace relief {

/// Checks the type of each property in the table and the range of each index.
///
/// \throws InvalidInput with the location: "meshes[0].primitives[1].indices is 7, but there are
///         only 3 accessors"
void check_schema(const Json& root);

/// Calls `visit` for each index into an array of the document, "accessors" for example; it may
/// change the index. The document must have passed check_schema().
void visit_references(Json& root,
                      const std::function<void(std::string_view target, Json& index)>& visit);

/// Returns true if any object carries the extension.
bool has_extension(const Json& root, std::string_view name);

/// Returns true if any object carries an extension that the table does not know. Such an extension
/// may hold indices that visit_references() does not see.
bool has_unknown_extension(const Json& root);

/// Largest count of an accessor without data (all zeros), for which no bytes of the file limit the
/// count.
inline constexpr std::size_t max_zero_elements = std::size_t{1} << 24U;

/// Checks a whole document. Afterwards every index, offset, length and count in it is valid.
///
/// \throws InvalidInput with the location, value and limit, or the name of a required extension
///         that relief does not support
void check_gltf(const Json& root);

/// Reports values that have no meaning: colors and weights that are not finite or out of range,
/// joints that a skin does not have, rotations without unit length, and integer positions and
/// directions without KHR_mesh_quantization. Replaces wrong bounds of positions.
void check_values(GltfContents& contents, Report& report);

}  // namespace relief
