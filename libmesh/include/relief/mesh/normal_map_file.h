// SPDX-License-Identifier: Apache-2.0
/// \file
/// Converts files of normal maps in bands of rows, so that images may be larger than memory.
/// Tests: tests/mesh/io/image/normal_map_file_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "relief/export.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_texture.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// Files with more bytes of samples than this are converted by rows, and read two or three times.
inline constexpr std::size_t max_normal_map_in_memory = std::size_t{256} << 20;

/// Converts float samples of a map from n to (n + 1) / 2, except alpha.
void remove_signs(Image& map);

/// The normal map that is converted.
struct NormalMapSource {
    std::filesystem::path file;
    /// The samples, if they are in memory; else null, and the rows of the file are read.
    const Image* image = nullptr;
    FlatCode flat = FlatCode::half;
    /// Float samples of the file are n instead of (n + 1) / 2. Those of `image` never are.
    bool is_signed = false;
};

/// A detail map that is blended over another map.
struct DetailLayer {
    Image normals;  ///< As for blend_normals(), for example from fitted_detail().
    NormalBlend blend = NormalBlend::reoriented;
    Report report;  ///< Findings of reading the detail; they precede those of blending.
};

/// The operations of a conversion, in their order.
struct NormalMapConversion {
    /// Changes only axes and alpha of the stored codes. Nothing is decoded, and the operations from
    /// `rebuild_z` to `format` do not apply, except `axes`.
    bool keeps_codes = false;
    std::optional<XyChannels> rebuild_z;
    AxisMapping axes = same_axes;
    bool keeps_alpha = true;  ///< The fourth channel, unless `rebuild_z` reads it.
    int width = 0;            ///< 0 for both sizes: those of the source.
    int height = 0;
    ResizeOptions resize;
    std::optional<double> strength;  ///< For scale_slopes().
    std::optional<DetailLayer> detail;
    NormalMapFormat format;  ///< Green is as after `axes`; `format.green` is ignored.
    std::map<std::string, std::string> metadata;
    ImageWriteOptions write;
    std::size_t texels_per_band = std::size_t{1} << 20;
};

/// The result of a conversion.
struct ConvertedMapFile {
    std::optional<LengthRange> lengths;  ///< Of the source's vectors, unless z was computed.
    BumpFileTimes times;
};

/// Converts a normal map and writes the result.
///
/// Bytes and findings are those of decode_normal_map() (or decode_xy_map()) with FlatTexels::exact,
/// measure_lengths(), map_normal_axes(), resize_normals(), scale_slopes(), blend_normals(),
/// encode_normal_map() and write_image(), and do not depend on bands. Memory holds bands, and the
/// rows of the source that a row of the result needs: six times the factor of a reduction.
///
/// \param report    gets the findings of these functions, in their order
/// \param progress  if given, called after each band with the fraction that is done, 0 to 1
/// \throws InvalidInput, FileError as these functions do
ConvertedMapFile convert_normal_map_file(const NormalMapSource& source,
                                         const std::filesystem::path& file,
                                         const NormalMapConversion& conversion,
                                         Report& report = IgnoredReport(),
                                         const std::function<void(double)>& progress = {});

/// The result of encoding a file.
struct EncodedMapFile {
    NormalTexture encoded;
    std::optional<LengthRange> lengths;  ///< As in ConvertedMapFile.
    BumpFileTimes times;                 ///< Nothing is written.
};

/// Converts a normal map, and encodes it as a texture that the caller writes.
///
/// The operations are those of convert_normal_map_file(), except for `keeps_codes`, `format`,
/// `metadata` and `write`. Memory holds the texture, and bands.
///
/// \throws InvalidInput, FileError
EncodedMapFile encode_normal_map_file(const NormalMapSource& source,
                                      const NormalMapConversion& conversion,
                                      const NormalTextureOptions& options,
                                      Report& report = IgnoredReport(),
                                      const std::function<void(double)>& progress = {});

}  // namespace relief
