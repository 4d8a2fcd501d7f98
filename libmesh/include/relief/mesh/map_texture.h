// SPDX-License-Identifier: Apache-2.0
/// \file
/// Maps of materials as textures for GPUs: one table of kinds, with their formats and the filter of
/// their mip levels, and the encoding of a map with all its levels and their errors.
/// Tests: tests/mesh/io/image/map_texture_test.cpp.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/texture_file.h"

namespace RELIEF_API relief {

/// The filter of mip levels.
enum class MipFilter {
    colors,   ///< Means in linear light. Alpha is averaged separately, or keeps its coverage.
    values,   ///< Means of the values.
    normals,  ///< Means of the normals of the largest level, normalized.
    /// The fourth root of the mean of roughness^4, which is the variance of slopes, plus twice the
    /// variance of the slopes of a normal map.
    roughness,
    /// Means of the values; the channel of roughness as `roughness`.
    packed,
};

/// The row of a kind of map.
struct MapTextureKind {
    MapKind kind;
    int channels;   ///< Without alpha.
    bool is_color;  ///< Colors are sRGB-coded; everything else is data.
    MipFilter filter;
    /// The first one is the default.
    std::span<const TextureFormat> formats;
    /// The values of a surface without this map, as stored.
    glm::vec3 neutral;
};

/// The kinds that have textures: normals in tangent and object space, heights, occlusion,
/// curvature, color, roughness, packed maps, metalness and emission.
std::span<const MapTextureKind> map_texture_kinds();

/// Returns the row of a kind; null for kinds that are not stored in textures.
const MapTextureKind* find_map_texture_kind(MapKind kind);

/// Returns whether a format stores alpha.
bool stores_alpha(TextureFormat format);

/// The number of texels of a level whose errors are measured, unless another one is requested.
inline constexpr std::size_t default_measured_texels = std::size_t{1} << 16;

struct MapTextureOptions {
    MapKind kind = MapKind::color;
    /// Absent: the first format of the kind; for integers of colors with alpha the first one with
    /// alpha.
    std::optional<TextureFormat> format{};
    BlockQuality quality = BlockQuality::normal;
    bool has_mips = true;
    Green green = Green::up;  ///< The stored direction, for normals in tangent space.
    /// The alpha below which a surface is cut out, from 0 to 1: each level keeps the part of texels
    /// that have at least this alpha. For colors.
    std::optional<float> alpha_cutoff{};
    /// Of packed maps: the channel of roughness, and whether it has 1 - roughness.
    int roughness_channel = 1;
    bool is_smoothness = false;
    /// The maximum number of texels of a level whose errors are measured, in random blocks of
    /// 4 x 4 texels, one of each of equal runs of blocks. 0: no errors are measured.
    std::size_t measured_texels = default_measured_texels;
};

/// The confidence of errors that were measured in random blocks of a level.
struct SampleConfidence {
    /// The mean of all texels lies within this distance of the measured one, with a confidence of
    /// 95 %.
    double mean_margin = 0.0;
    double rms_margin = 0.0;  ///< The same for the root mean square.
    /// At most this share of all blocks have an error above the measured maximum, with a confidence
    /// of 95 %.
    double share_above_max = 0.0;
};

/// A level of a texture.
struct MapTextureLevel {
    int width = 0;
    int height = 0;
    /// For normals, angles in degrees. For others, the root mean square of the errors of the
    /// channels of a texel, in codes of 8 bits, with the PSNR; colors are compared sRGB-coded,
    /// those above 1 by the same formula.
    ErrorStats error;
    /// Absent: all texels were measured, or none.
    std::optional<SampleConfidence> confidence{};
};

struct MapTexture {
    /// With the text entries of the kind and its conventions (map_description.h).
    GpuTexture texture;
    std::vector<MapTextureLevel> levels;
};

/// Encodes a map with its mip levels.
///
/// \param map  normals: three float channels of any length, y up. Others: the channels of the kind,
///         and alpha for color, packed maps and object-space normals. Floats of colors are linear,
///         as their color space says
/// \param normals  for roughness and packed maps: the normals of the surface, three float channels;
///         null if there are none
/// \param report  as from encode_normal_blocks() and encode_texture_level(); counts colors above 1,
///         which are stored as 1, and normals of another size than the map, which are not used
/// \param execution  threads, progress and cancellation; the bytes do not depend on it
/// \throws InvalidInput if the kind has no textures, the format is none of the kind's, the map has
///         other channels, or the format stores no alpha but the map has one; Cancelled
///
/// Sources: coverage of alpha [Castano 2010]; roughness [Olano and Baker 2010], with the variance
/// of normals as in slope_variance_of_length().
MapTexture encode_map_texture(const Image& map, const MapTextureOptions& options,
                              const Image* normals = nullptr, Report& report = IgnoredReport(),
                              const ExecutionOptions& execution = {});

/// Computes the mip levels of a map, as encode_map_texture() does, but not normalized for normals.
/// \return the levels below the map itself
std::vector<Image> map_mip_levels(const Image& map, const MapTextureOptions& options,
                                  const Image* normals = nullptr, Report& report = IgnoredReport());

}  // namespace relief
