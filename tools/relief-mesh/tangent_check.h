// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which basis the tangents in a file are of, in words and as JSON.
/// Tests: tests/tools/relief_mesh_check_tangents_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/tangent_basis.h"

namespace relief::tools {

/// What was found out about the tangents of a primitive.
struct CheckedTangents {
    SniffedTangents sniffed;
    int texcoord_set = 0;       ///< Of which they are, or are thought to be.
    int usual_set = 0;          ///< The one that glTF says they are of.
    bool has_normals = true;    ///< Without, glTF ignores them,
    bool has_texcoords = true;  ///< and without these nothing can be held against them.
};

/// \param mesh  the primitive, with whichever texture coordinates
/// \return absent where it has no tangents. Where they are of no known basis by the texture
///         coordinates that glTF says they belong to, the other sets are tried
std::optional<CheckedTangents> check_tangents(const GltfDocument& document, GltfPrimitiveId id,
                                              const Mesh& mesh);

/// "mikktspace, w negated: 512 of 512 corners within 0.1 degrees ...".
std::string in_words(const CheckedTangents& tangents);

nlohmann::ordered_json json_of(const CheckedTangents& tangents);

}  // namespace relief::tools
