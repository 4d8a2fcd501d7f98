// SPDX-License-Identifier: Apache-2.0
/// \file
/// Unit normals in image files: what the stored numbers mean.
/// Tests: tests/mesh/image/normals/normal_map_test.cpp.
#pragma once

#include <map>
#include <string>

#include "relief/mesh/dither.h"
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
    /// 8, 16, or 32. Float samples hold (n + 1) / 2, as the EXR and TIFF maps of other bakers do:
    /// zero is exactly 0.5 there, and `flat` has no say.
    int bits = 16;
    Green green = Green::up;
    FlatCode flat = FlatCode::middle;
    /// Of 8 and 16 bits. Any but `none` is less than one code off, instead of half a code at most,
    /// but right in the mean over a few texels.
    Dither dither = Dither::none;
};

/// Stores unit normals as a three-channel data image.
///
/// \param normals  three float channels, y up; any length, only the direction counts
/// \param report   counts normals that are not finite or zero: stored as flat
/// \return codes rounded to the nearest, or as `dither` says; with FlatCode::middle, (0,0,1)
/// decodes
///         to exactly (0,0,1) and n and -n get mirrored codes, so that mirrored texture seams
///         cannot show; with FlatCode::half, 0 becomes the upper of its two codes, or both in turns
///         where dithered
/// \throws InvalidInput if the image is empty or not three float channels, or bits is not 8, 16 or
///         32
Image encode_normal_map(const Image& normals, const NormalMapFormat& format, Report& report);

/// Reads unit normals back: three float channels, unit, y up.
///
/// \param map  three or four channels (a fourth is ignored); bits are the image's own
/// \param flat    for 8 and 16 bits
/// \param report  counts texels that decode to nothing or to non-finite: read as flat
/// \throws InvalidInput if the image is empty or has fewer than three channels
Image decode_normal_map(const Image& map, Green green, FlatCode flat, Report& report);

/// The flat code that a map most likely uses: what the metadata says; else `half` where texels that
/// are flat in x and y, to within the two codes around zero, hold the lower one (127) more often;
/// else `middle`. A float map is `middle`.
///
/// \throws InvalidInput if the image is empty or has fewer than three channels
FlatCode detect_flat_code(const Image& map,
                          const std::map<std::string, std::string>& metadata = {});

/// Text entries that say what a map holds: "relief:content", "relief:green" = "up" or "down",
/// "relief:flat" = the code of zero: "128", "127.5", "32768", "32767.5", or "0.5" for float.
std::map<std::string, std::string> normal_map_metadata(const NormalMapFormat& format);

}  // namespace relief
