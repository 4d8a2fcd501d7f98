// SPDX-License-Identifier: Apache-2.0
/// \file
/// Encodes normal maps as textures by bands of rows: all mip levels grow at the same time, so that
/// neither the map nor its levels are in memory as floats.
/// Tests: tests/mesh/io/image/normal_texture_test.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/block_compression.h"
#include "relief/mesh/image.h"
#include "relief/mesh/map_texture.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/texture_file.h"

namespace RELIEF_API relief {

struct NormalTextureOptions {
    TextureFormat format = TextureFormat::bc5;  ///< One of those of MapKind::normal.
    BlockQuality quality = BlockQuality::normal;
    bool has_mips = true;
    /// If given, a second texture has the roughness of all levels in bc4: that of the surface, and
    /// the variance of the normals of each texel.
    std::optional<double> roughness{};
    /// As in MapTextureOptions.
    std::size_t measured_texels = default_measured_texels;
};

/// A level of a texture of normals.
struct NormalTextureLevel {
    int width = 0;
    int height = 0;
    double mean_length = 1.0;  ///< Of the averaged vectors: 1 if all normals agree.
    double min_length = 1.0;
    std::optional<double> mean_roughness{};
    std::optional<ErrorStats> error{};  ///< In degrees; absent if it was not measured.
    /// Absent: all texels were measured, or none.
    std::optional<SampleConfidence> confidence{};
};

/// Textures without text entries.
struct NormalTexture {
    GpuTexture texture;
    std::optional<GpuTexture> roughness;
    std::vector<NormalTextureLevel> levels;
};

/// Encodes normals, and alpha, of a map whose rows are added from the top.
///
/// The bytes do not depend on the bands. They are those of encode_normal_blocks() and
/// encode_texture_level() for the map and its normal_mip_levels(), whose vectors are normalized.
class NormalTextureEncoder {
  public:
    /// \throws InvalidInput if a size is not positive, the format stores no normals, or there is
    ///         alpha that it does not store
    NormalTextureEncoder(int width, int height, bool has_alpha,
                         const NormalTextureOptions& options);
    ~NormalTextureEncoder();
    NormalTextureEncoder(const NormalTextureEncoder&) = delete;
    NormalTextureEncoder& operator=(const NormalTextureEncoder&) = delete;

    /// Adds rows.
    /// \param normals  three float channels, y as it is stored; tightly packed
    /// \param alpha  one float channel of the same size, if there is alpha; else null
    /// \throws InvalidInput if the image has another width or format, or there are too many rows
    void add(const Image& normals, const Image* alpha = nullptr);

    /// Returns the textures after all rows.
    /// \param report  as from encode_normal_blocks(), encode_texture_level() and split_lengths()
    /// \throws InvalidInput if rows are missing
    NormalTexture finish(Report& report = IgnoredReport());

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
