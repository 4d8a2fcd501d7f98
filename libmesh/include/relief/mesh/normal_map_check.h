// SPDX-License-Identifier: Apache-2.0
/// \file
/// The health of a normal map: whether an image is one, what its numbers mean, and what is wrong
/// with it. Tests: tests/mesh/image/check/normal_map_check_test.cpp,
/// normal_map_check_real_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relief/mesh/diagnose.h"
#include "relief/mesh/height_statistics.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"

namespace relief {

/// What the numbers of an image are most likely to be.
enum class MapContent {
    tangent_normals,  ///< Directions that lean towards z.
    object_normals,   ///< Directions of unit length that face all ways.
    xy_normals,  ///< x and y of tangent-space normals; the third channel is absent or constant.
    grey,        ///< One channel, or all the same: heights, roughness, a mask.
    other,       ///< Colours, several masks in one image, ...
};

/// Whether the numbers went through the sRGB curve, which no normal may.
enum class StoredCurve {
    none,
    srgb_encoded,  ///< Too bright: linear_from_srgb() of the samples are normals.
    srgb_decoded,  ///< Too dark: srgb_from_linear() of the samples are.
};

/// How long the vectors (2 sample - 1) are that the texels hold; non-finite ones left out.
struct VectorLengths {
    static constexpr std::array bounds = {0.01, 0.02, 0.05, 0.1, 0.25};

    double mean = 0.0;
    double rms_deviation = 0.0;  ///< From 1.
    /// Share of texels no further from 1 than each of the bounds.
    std::array<double, bounds.size()> within{};
};

/// Which way green grows, and how sure that is.
struct GreenEvidence {
    /// Absent where the map cannot tell: flat, ripples along one axis, too small, no surface.
    std::optional<Green> green;
    /// +1: a surface if green is up; -1: one if green is down; 0: neither. The correlation of the
    /// change of the slope along x, in y, with that of the slope along y, in x.
    double correlation = 0.0;
    double deviation = 0.0;   ///< Standard deviation of the correlation, from parts of the map.
    double confidence = 0.0;  ///< 0 to 1: that the sign of the correlation is no accident.
    int scale = 1;            ///< Texels that were averaged to find it: 1, 2, 4 or 8.
};

/// What can be found in a map.
enum class MapCondition {
    // What it is.
    not_normals,   ///< MapContent::grey or other.
    object_space,  ///< MapContent::object_normals.
    z_missing,     ///< MapContent::xy_normals.
    z_constant,    ///< The third channel says nothing, but is near what it should be.
    stored_through_srgb,
    decoded_from_srgb,
    tagged_as_color,  ///< The file says that its samples are sRGB colours, or the like.
    signed_samples,   ///< Float samples hold n itself, not (n + 1) / 2.
    // Texels.
    texel_not_finite,
    texel_without_direction,  ///< Its vector is no longer than 1 / 16.
    texel_facing_back,        ///< z below zero, by more than rounding to codes can do.
    texel_grey,               ///< Black, white or grey, and not of unit length: a background.
    // Its lengths.
    not_unit,        ///< rms_deviation above 0.05.
    not_quite_unit,  ///< Above 0.02: filtered, compressed or averaged without renormalising.
    // Conventions.
    green_contradicted,  ///< The metadata says one direction, the surface shows the other.
    green_down,
    green_unknown,
    /// The file says 128 is flat, but 64 texels or more have 127 in x and y, and more so than any
    /// other code near to flat; a smooth surface has all of them alike.
    flat_contradicted,
    // Channels.
    all_flat,    ///< Every texel is the same.
    x_constant,  ///< No slope left and right, though there is one up and down.
    y_constant,
    bits_unused,    ///< 16 bits or float hold 8 bits or fewer.
    alpha_opaque,   ///< A fourth channel that says nothing.
    alpha_heights,  ///< A fourth channel whose slopes are those of the normals.
    alpha_other,
    // Borders.
    seam_x,  ///< Does not go on across the left and right border.
    seam_y,
};

/// A condition in words.
struct MapConditionInfo {
    MapCondition condition;
    std::string_view word;     ///< "stored through the sRGB curve"
    std::string_view element;  ///< What is counted: "texel", or "map" for the whole.
    Severity severity;
    std::string_view meaning;
};

/// All conditions, in the order of the enumeration.
std::span<const MapConditionInfo> map_conditions();

/// The words for one of them.
const MapConditionInfo& condition_info(MapCondition condition);

/// A condition that a map has.
struct FoundMapCondition {
    MapCondition condition;
    std::size_t count = 1;           ///< Texels, or 1 where the whole map is meant.
    std::vector<std::size_t> first;  ///< The smallest texel indices, ascending, at most 8.
};

struct NormalMapCheck {
    MapContent content = MapContent::other;
    StoredCurve curve = StoredCurve::none;
    VectorLengths lengths;           ///< Of the samples as they are stored.
    VectorLengths lengths_uncurved;  ///< With `curve` undone; equal to `lengths` where it is none.
    GreenEvidence green;             ///< Of tangent-space normals.
    /// What detect_flat_code() says, or FlatCode::half where the texels contradict the metadata.
    FlatCode flat = FlatCode::half;
    Tiling tiling;                            ///< Of x and y, the worse of the two.
    std::vector<int> bits;                    ///< Really used, by channel; 0: more than 16.
    std::optional<double> alpha_correlation;  ///< Of the slopes of alpha with those of the normals.
    std::vector<FoundMapCondition> found;     ///< In the order of the enumeration.

    [[nodiscard]] bool has(MapCondition condition) const;
    [[nodiscard]] bool has_trouble() const;
};

/// Everything that MapCondition lists. Changes nothing.
///
/// \param map       any number of channels and bits
/// \param metadata  text entries of its file; "relief:green" and "relief:flat" are compared with
///                  what the texels show
/// \param color_tag  what color_tag() says of its file (image_tags.h)
/// \throws InvalidInput if the image is empty
///
/// What needs a surface (green, alpha) is looked for in tangent-space normals only. The same
/// for any number of threads. Source of the criterion for green: [Frankot and Chellappa 1988], who
/// make slopes integrable; here it is only asked how far they are.
NormalMapCheck check_normal_map(const Image& map,
                                const std::map<std::string, std::string>& metadata = {},
                                std::string_view color_tag = {});

/// The conditions as findings, or those of one severity.
Report to_report(const NormalMapCheck& check, std::optional<Severity> severity = std::nullopt);

}  // namespace relief
