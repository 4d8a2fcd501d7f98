// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of meshopt's bitstream that Debian's meshoptimizer 0.18 does not know: version 1 of
/// the attribute codec and the colour filter, which KHR_meshopt_compression added.
///
/// Bytes in, bytes out; every read is checked, so that broken data ends in false.
/// Source: the glTF extension KHR_meshopt_compression, appendices A and B.
/// Tests: tests/mesh/io/gltf/gltf_meshopt_test.cpp.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace relief {

/// The first byte of attributes in version 1.
inline constexpr unsigned char meshopt_attributes_v1 = 0xA1;

/// Decodes attributes of version 1.
///
/// \param stride    bytes of an element: a multiple of 4, from 4 to 256
/// \param elements  count times stride bytes, all of them overwritten
/// \return whether the data is what its header says it is; if not, `elements` holds anything
bool decode_meshopt_attributes_v1(std::string_view packed, std::size_t count, std::size_t stride,
                                  std::string& elements);

/// YCoCg with a scale in the alpha to RGBA, in place; elements of 4 or 8 bytes (`stride`).
void decode_meshopt_colors(std::string& elements, std::size_t stride);

}  // namespace relief
