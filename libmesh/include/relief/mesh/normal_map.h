// SPDX-License-Identifier: Apache-2.0
/// \file
/// Encodes unit normals as normal maps and decodes them.
/// Tests: tests/mesh/image/normal_map_test.cpp.
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

/// The direction of the green channel.
enum class Green {
    up,    ///< OpenGL and glTF: surfaces that face up in the image are bright in green.
    down,  ///< DirectX.
};

/// The code of zero in maps of 8 or 16 bits. Decoding with the wrong one causes an error of up to
/// 0.7 degrees in 8 bits, 0.003 in 16: half a code in addition to rounding.
enum class FlatCode {
    /// 128 of 255 (32768 of 65535) is exactly 0: n = (code - 128) / 127, at least -1.
    middle,
    /// 127.5 of 255 is 0: n = 2 * code / 255 - 1, as in glTF 2.0 and engines. No code is exactly 0:
    /// a flat texel is stored as (128, 128, 255), which decodes to a direction 0.32 degrees from
    /// flat (0.0012 in 16 bits). FlatTexels::exact corrects this.
    half,
};

/// The decoding of flat texels with FlatCode::half.
enum class FlatTexels {
    as_coded,  ///< By the formula, as glTF and engines do.
    /// As exactly (0,0,1), if flat_texel_codes() finds the codes of flat texels.
    exact,
};

struct NormalMapFormat {
    /// 8, 16 or 32. Float samples hold (n + 1) / 2, like the EXR and TIFF maps of other bakers.
    /// Zero is exactly 0.5 then, and `flat` is ignored.
    int bits = 16;
    Green green = Green::up;
    FlatCode flat = FlatCode::half;
    /// For 8 and 16 bits. With dithering, the error of a texel is less than one code instead of at
    /// most half a code, but the mean over a few texels is accurate.
    Dither dither = Dither::none;
};

/// Encodes normals as a data image of three channels.
///
/// \param normals  three float channels, y up, of any length
/// \param report  counts normals that are zero or not finite, which are stored as flat
/// \return codes that are rounded to the nearest, or as `dither` says. With FlatCode::middle,
///         (0,0,1) decodes to exactly (0,0,1), and n and -n have symmetric codes, so that seams of
///         mirrored textures are invisible. With FlatCode::half, 0 becomes the upper one of its two
///         codes, or both alternately with dithering
/// \throws InvalidInput if the image is empty or not three float channels, or bits is not 8, 16 or
///         32
Image encode_normal_map(const Image& normals, const NormalMapFormat& format, Report& report);

/// Decodes a normal map to three float channels, unit, y up.
///
/// \param map  three or four channels (the fourth is ignored) of any number of bits.
///         FlatTexels::exact needs the whole map, because it counts codes
/// \param flat  for 8 and 16 bits
/// \param report  counts texels that decode to zero or to values that are not finite; they become
///         flat
/// \throws InvalidInput if the image is empty or has fewer than three channels
Image decode_normal_map(const Image& map, Green green, FlatCode flat, Report& report,
                        FlatTexels texels = FlatTexels::as_coded);

/// Finds the codes of x and y that stand for exactly flat in a map with FlatCode::half: the pair of
/// codes around zero, 127 or 128 each, that at least three quarters of the nearly flat texels have.
/// Absent if there is no such pair, as in dithered or curved maps, where each of the four pairs is
/// a different direction; and in float maps.
///
/// \param x,y  channels
/// \throws InvalidInput if the image is empty or has no such channels
std::optional<std::array<std::uint16_t, 2>> flat_texel_codes(const Image& map, int x = 0,
                                                             int y = 1);

/// Returns the code of zero that the metadata names, else FlatCode::half, as in glTF and engines.
/// It cannot be found from the texels: flat ones contain 128 in both kinds of maps.
///
/// \throws InvalidInput if the image is empty or has fewer than three channels
FlatCode detect_flat_code(const Image& map,
                          const std::map<std::string, std::string>& metadata = {});

/// Returns text entries that describe a map: "relief:content", "relief:green" = "up" or "down",
/// "relief:flat" = the code of zero: "128", "127.5", "32768", "32767.5", or "0.5" for float.
std::map<std::string, std::string> normal_map_metadata(const NormalMapFormat& format);

}  // namespace relief
