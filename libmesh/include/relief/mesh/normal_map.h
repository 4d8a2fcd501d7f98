// SPDX-License-Identifier: Apache-2.0
/// \file
/// Unit normals in image files: what the stored numbers mean.
/// Tests: tests/mesh/image/normals/normal_map_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
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

/// Which stored number stands for zero in maps of 8 or 16 bits. A map that is read with the other
/// zero has an error of up to 0.7 degrees in 8 bits, 0.003 in 16: half a code more than rounding.
enum class FlatCode {
    /// 128 of 255 (32768 of 65535) is exactly 0: n = (code - 128) / 127, -1 at least.
    middle,
    /// 127.5 of 255 is 0: n = 2 * code / 255 - 1. glTF 2.0 and engines decode maps so. No code is
    /// exactly 0: a flat texel is stored as (128, 128, 255), which decodes to a direction that is
    /// 0.32 degrees off flat (0.0012 in 16 bits). FlatTexels::exact undoes that.
    half,
};

/// How flat texels are read from maps with FlatCode::half.
enum class FlatTexels {
    as_coded,  ///< By the formula, as glTF and engines decode them.
    /// As exactly (0,0,1), where flat_texel_codes() finds the codes that stand for flat.
    exact,
};

struct NormalMapFormat {
    /// 8, 16, or 32. Float samples hold (n + 1) / 2, as the EXR and TIFF maps of other bakers do:
    /// zero is exactly 0.5 there, and `flat` has no say.
    int bits = 16;
    Green green = Green::up;
    FlatCode flat = FlatCode::half;
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
/// \param map  three or four channels (a fourth is ignored); bits are the image's own. For
///             FlatTexels::exact the whole map, because flat texels are found by their number
/// \param flat    for 8 and 16 bits
/// \param report  counts texels that decode to nothing or to non-finite: read as flat
/// \throws InvalidInput if the image is empty or has fewer than three channels
Image decode_normal_map(const Image& map, Green green, FlatCode flat, Report& report,
                        FlatTexels texels = FlatTexels::as_coded);

/// The codes of x and y that stand for exactly flat in a map with FlatCode::half: the pair of codes
/// around zero, 127 or 128 each, that at least three of four texels near flat hold. Absent if no
/// pair does, as on dithered or curved ground, where each of the four pairs is a direction of its
/// own; and in float maps.
///
/// \param x,y  channels
/// \throws InvalidInput if the image is empty or has no such channels
std::optional<std::array<std::uint16_t, 2>> flat_texel_codes(const Image& map, int x = 0,
                                                             int y = 1);

/// The zero of a map: what the metadata says, else FlatCode::half, as glTF and engines decode. The
/// texels do not tell: flat ones hold 128 in maps of both kinds.
///
/// \throws InvalidInput if the image is empty or has fewer than three channels
FlatCode detect_flat_code(const Image& map,
                          const std::map<std::string, std::string>& metadata = {});

/// Text entries that say what a map holds: "relief:content", "relief:green" = "up" or "down",
/// "relief:flat" = the code of zero: "128", "127.5", "32768", "32767.5", or "0.5" for float.
std::map<std::string, std::string> normal_map_metadata(const NormalMapFormat& format);

}  // namespace relief
