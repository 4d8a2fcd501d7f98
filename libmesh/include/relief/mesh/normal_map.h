// SPDX-License-Identifier: Apache-2.0
/// \file
/// Unit normals in image files: what the stored numbers mean.
/// Tests: tests/mesh/image/normal_map_test.cpp.
#pragma once

#include <map>
#include <string>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// Which way the green channel grows.
enum class Green {
    up,    ///< OpenGL and glTF: green is bright where the surface faces up in the image.
    down,  ///< DirectX.
};

/// Which stored number stands for zero. It matters: read the wrong way, flat is 0.3 degrees off
/// flat.
enum class FlatCode {
    middle,  ///< 128 of 255 (32768 of 65535) is exactly 0: n = (code - 128) / 127, -1 at least.
    half,    ///< 127.5 of 255 is 0: n = 2 * code / 255 - 1. glTF's formula; no code is exactly 0.
};

struct NormalMapFormat {
    int bits = 16;  ///< 8, 16, or 32 (float: n = 2 * value - 1 for neither; stored as (n + 1) / 2).
    Green green = Green::up;
    FlatCode flat = FlatCode::middle;
};

/// Stores unit normals as a three-channel data image.
///
/// \param normals  three float channels, unit, y up
/// \param report   counts normals that are not finite or zero: stored as flat
/// \return round-to-nearest codes; with FlatCode::middle, (0,0,1) decodes to exactly (0,0,1) and n
///         and -n get mirrored codes, so that mirrored texture seams cannot show
Image encode_normal_map(const Image& normals, const NormalMapFormat& format, Report& report);

/// Reads unit normals back: three float channels, unit, y up.
///
/// \param map  three or four channels (a fourth is ignored); bits are the image's own
/// \param report  counts texels that decode to nothing or to non-finite: read as flat
Image decode_normal_map(const Image& map, Green green, FlatCode flat, Report& report);

/// The flat code that a map most likely uses: `half` where flat-ish texels favour 127 or the
/// metadata says so, else `middle`.
FlatCode detect_flat_code(const Image& map,
                          const std::map<std::string, std::string>& metadata = {});

/// Text entries that say what a map holds ("relief:green" = "up", "relief:flat" = "128", ...).
std::map<std::string, std::string> normal_map_metadata(const NormalMapFormat& format);

}  // namespace relief
