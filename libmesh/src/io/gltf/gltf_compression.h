// SPDX-License-Identifier: Apache-2.0
/// \file
/// Decompression of glTF documents: meshopt buffer views and Draco primitives.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// Returns true for each buffer that is only a placeholder. Such a buffer has no URI, is not the
/// binary chunk of a GLB (or is marked as a fallback), and all its views have a compressed copy in
/// another buffer.
std::vector<bool> meshopt_placeholders(const Json& root, bool has_binary_chunk);

/// Decodes all views of placeholder buffers.
///
/// The decoded views are placed in a new buffer and lose the extension. A view whose plain data is
/// in the file keeps both. A document without such views costs nothing.
/// \throws InvalidInput naming the view, if its parameters contradict each other or its data is
///         damaged
void unpack_meshopt(GltfContents& contents);

/// Decodes all primitives whose plain data is missing.
///
/// Their accessors then have data of their own types and the bounds of the decoded values, and the
/// primitive loses the extension. A primitive whose plain data is in the file keeps both. A
/// document without such primitives costs nothing.
/// \param report  counts accessors whose count differs from the data; the count of the data is used
/// \throws InvalidInput naming the primitive, if its data is damaged, holds points instead of
///         triangles, or lacks a named attribute
void unpack_draco(GltfContents& contents, Report& report);

/// The first byte of version 1 of the attribute codec, which KHR_meshopt_compression added.
/// Debian's meshoptimizer 0.18 does not know it, nor the color filter.
inline constexpr unsigned char meshopt_attributes_v1 = 0xA1;

/// Decodes attributes of version 1. All reads are checked, so that damaged data gives false.
///
/// \param stride    bytes of an element: a multiple of 4, from 4 to 256
/// \param elements  count times stride bytes; all are overwritten
/// \return true if the data matches its header; otherwise `elements` is unspecified
bool decode_meshopt_attributes_v1(std::string_view packed, std::size_t count, std::size_t stride,
                                  std::string& elements);

/// Converts YCoCg with a scale in alpha to RGBA, in place. `stride`, the bytes of an element, is 4
/// or 8.
void decode_meshopt_colors(std::string& elements, std::size_t stride);

}  // namespace relief::detail
