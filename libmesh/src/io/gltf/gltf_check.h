// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether a glTF document can be worked with: after this, no index, offset, length or count in it
/// leads astray. Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include "io/gltf/gltf_json.h"

namespace relief {

/// Largest count of an accessor without data (all zeros): there are no bytes in the file that bound
/// it.
inline constexpr std::size_t most_zero_elements = std::size_t{1} << 24U;

/// \throws InvalidInput naming the place, the value and the limit; or the extension that is
///         required but not understood
void check_gltf(const Json& root);

}  // namespace relief
