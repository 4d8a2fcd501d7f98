// SPDX-License-Identifier: Apache-2.0
/// \file
/// What glTF's JSON is made of: which property has which type, and which is an index into what.
///
/// One table (gltf_schema.cpp) serves both for checking a document and for renumbering what it
/// refers to. Source: glTF 2.0 (ISO/IEC 12113) and the extensions named in the table.
/// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <functional>
#include <string_view>

#include "io/gltf/gltf_json.h"

namespace relief {

/// Checks the type of every property in the table, and that every index names something.
///
/// \throws InvalidInput naming the place: "meshes[0].primitives[1].indices is 7, but there are only
///         3 accessors"
void check_schema(const Json& root);

/// Calls `visit` for every index into "accessors", "bufferViews" or "buffers", wherever it stands;
/// the index may be changed. The document must have passed check_schema.
void visit_references(Json& root,
                      const std::function<void(std::string_view target, Json& index)>& visit);

/// Whether an object carries an extension.
bool has_extension(const Json& root, std::string_view name);

/// Whether an object carries an extension that the table does not know: it may hold indices that
/// visit_references does not see.
bool has_unknown_extension(const Json& root);

}  // namespace relief
