// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks an image that should be a normal map: its content, its conventions and its defects.
/// Tests: tests/mesh/image/normal_map_check_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"

namespace RELIEF_API relief {

/// The most likely content of an image.
enum class MapContent {
    tangent_normals,  ///< Directions near +z.
    object_normals,   ///< Directions of unit length that face all sides.
    xy_normals,  ///< x and y of tangent-space normals; the third channel is absent or constant.
    gray,        ///< One channel, or several equal channels: heights, roughness, a mask.
    other,       ///< Colors, several masks in one image, or other data.
};

/// An sRGB conversion that was applied to the samples by mistake.
enum class StoredCurve {
    none,
    srgb_encoded,  ///< Too bright: apply linear_from_srgb() to get normals.
    srgb_decoded,  ///< Too dark: apply srgb_from_linear() to get normals.
};

/// Statistics of the lengths of the vectors (2 sample - 1) of all finite texels.
struct VectorLengths {
    static constexpr std::array bounds = {0.01, 0.02, 0.05, 0.1, 0.25};

    double mean = 0.0;
    double rms_deviation = 0.0;  ///< RMS deviation from 1.
    /// Share of texels whose length deviates from 1 by at most each of the bounds.
    std::array<double, bounds.size()> within{};
};

/// The detected direction of green, with its confidence.
struct GreenEvidence {
    /// Absent if it cannot be determined: the map is flat, has waves along one axis only, is too
    /// small, or shows no surface.
    std::optional<Green> green;
    /// The correlation between the derivative in y of the slope along x and the derivative in x of
    /// the slope along y. +1: a surface with green up; -1: a surface with green down; 0: neither.
    double correlation = 0.0;
    double deviation = 0.0;  ///< Standard deviation of the correlation over parts of the map.
    /// The probability, 0 to 1, that the sign of the correlation is not random.
    double confidence = 0.0;
    int scale = 1;  ///< The size of the averaging filter in texels: 1, 2, 4 or 8.
};

/// The conditions of a map.
enum class MapCondition {
    // Content.
    not_normals,   ///< MapContent::gray or other.
    object_space,  ///< MapContent::object_normals.
    z_missing,     ///< MapContent::xy_normals.
    z_constant,    ///< The third channel is constant, but close to the correct z.
    stored_through_srgb,
    decoded_from_srgb,
    tagged_as_color,  ///< The file is tagged as sRGB colors or similar.
    signed_samples,   ///< Float samples contain n instead of (n + 1) / 2.
    // Texels.
    texel_not_finite,
    texel_without_direction,  ///< Its vector has a length of at most 1 / 16.
    texel_facing_back,        ///< z is negative by more than a rounding error of codes.
    texel_gray,               ///< Black, white or gray, and not of unit length: a background.
    // Lengths.
    not_unit,  ///< rms_deviation is above 0.05.
    /// rms_deviation is above 0.02: filtered, compressed or averaged without normalization.
    not_quite_unit,
    // Conventions.
    green_contradicted,  ///< The metadata and the surface contradict each other.
    green_down,
    green_unknown,
    /// The file declares 128 as flat, but at least 64 texels have 127 in x and y, more than any
    /// other code near flat; a smooth surface would have all of them equally often.
    flat_contradicted,
    // Channels.
    all_flat,    ///< Every texel is the same.
    x_constant,  ///< There are slopes up and down, but none left and right.
    y_constant,
    bits_unused,    ///< 16 bits or float hold at most 8 significant bits.
    alpha_opaque,   ///< The fourth channel is constant.
    alpha_heights,  ///< The fourth channel holds heights whose slopes match the normals.
    alpha_other,
    // Borders.
    seam_x,  ///< The map is not continuous across its left and right borders.
    seam_y,
};

/// The texts for a condition.
struct MapConditionInfo {
    MapCondition condition;
    std::string_view word;     ///< "stored through the sRGB curve"
    std::string_view element;  ///< The counted elements: "texel", or "map" for the whole.
    Severity severity;
    std::string_view meaning;
};

/// All conditions, in the order of the enumeration.
std::span<const MapConditionInfo> map_conditions();

/// The texts for one condition.
const MapConditionInfo& condition_info(MapCondition condition);

/// A condition that occurs in a map.
struct MapConditionCount {
    MapCondition condition;
    std::size_t count = 1;           ///< Number of texels, or 1 for conditions of the whole map.
    std::vector<std::size_t> first;  ///< The smallest texel indices, ascending, at most 8.
};

struct NormalMapCheck {
    MapContent content = MapContent::other;
    StoredCurve curve = StoredCurve::none;
    VectorLengths lengths;  ///< For the stored samples.
    /// After `curve` is undone; equal to `lengths` for StoredCurve::none.
    VectorLengths lengths_uncurved;
    GreenEvidence green;  ///< For tangent-space normals.
    /// The result of detect_flat_code(), or FlatCode::half if the texels contradict the metadata.
    FlatCode flat = FlatCode::half;
    Tiling tiling;          ///< The worse result of x and y.
    std::vector<int> bits;  ///< Significant bits of each channel; 0: more than 16.
    /// The correlation between the slopes of alpha and those of the normals.
    std::optional<double> alpha_correlation;
    std::vector<MapConditionCount> conditions;  ///< In the order of the enumeration.

    [[nodiscard]] bool has(MapCondition condition) const;
    [[nodiscard]] bool has_problem() const;
};

/// Judges the content of a map by at most 2^18 regularly spaced texels. Only if these are no
/// normals of about unit length, all texels are examined for the slopes of a surface.
///
/// \param map  any number of channels and bits
/// \return the same as in check_normal_map() without an assumption
/// \throws InvalidInput if the image is empty
MapContent judged_content(const ImageView& map, FlatCode flat = FlatCode::half);

/// Checks a map for all conditions. The map is not changed.
///
/// \param map  any number of channels and bits; it is read in place, one channel at a time is
///         copied
/// \param metadata  text entries of its file; "relief:green" and "relief:flat" are compared with
///         the texels, and a stated space of the normals wins over the one that they seem to have
/// \param color_tag  the result of color_tag() for its file (image_file.h)
/// \param assumed  a content that is not judged by the texels
/// \throws InvalidInput if the image is empty
///
/// Conditions that require a surface (green, alpha) are checked only for tangent-space normals. The
/// result is the same for any number of threads. The criterion for green is integrability, after
/// [Frankot and Chellappa 1988]; here it is only measured.
NormalMapCheck check_normal_map(const ImageView& map,
                                const std::map<std::string, std::string>& metadata = {},
                                std::string_view color_tag = {},
                                std::optional<MapContent> assumed = std::nullopt);

/// Converts all conditions, or those of one severity, to findings.
Report to_report(const NormalMapCheck& check, std::optional<Severity> severity = std::nullopt);

}  // namespace relief
