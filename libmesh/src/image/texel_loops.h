// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parallel loops over texels, coordinates beyond the border of an image, and the largest sample of
/// a format.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "parallel.h"
#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {
namespace detail {
inline constexpr std::size_t texels_per_piece = 1 << 14;

/// Calls each(texel, report) for every texel in parallel; the findings come together in `report`.
template <typename Each>
void for_each_texel(std::size_t count, Report& report, Each each) {
    parallel_for_reporting(count, texels_per_piece, report,
                           [&](std::size_t begin, std::size_t end, Report& found) {
                               for (std::size_t texel = begin; texel < end; ++texel)
                                   each(texel, found);
                           });
}

/// Calls each(row, report) for every row in parallel. Each piece has enough rows to be worthwhile.
template <typename Each>
void for_each_row(int width, int height, Report& report, Each each) {
    const std::size_t rows_per_piece = texels_per_piece / static_cast<std::size_t>(width) + 1;
    parallel_for_reporting(static_cast<std::size_t>(height), rows_per_piece, report,
                           [&](std::size_t begin, std::size_t end, Report& found) {
                               for (std::size_t row = begin; row < end; ++row)
                                   each(row, found);
                           });
}

/// Calls with(Sample{}) for the sample type of an image.
template <typename AnyImage, typename With>
auto with_sample_type(const AnyImage& image, const With& with) {
    if (image.bits() == 8) return with(std::uint8_t{});
    if (image.bits() == 16) return with(std::uint16_t{});
    return with(float{});
}

/// Returns whether the last channel is alpha: that of two or four channels.
inline bool has_alpha(const Image& image) {
    return image.channels == 2 || image.channels == 4;
}

/// \param what  the plural for messages: "normals"
/// \throws InvalidInput if the image is empty or does not have this number of float channels
void check_floats(const ImageView& image, int channels, const char* what);

struct Direction {
    double x, y, z;
};

/// Normalizes a direction. If it has none, the result is flat. \return whether it has a direction
inline bool make_unit(Direction& direction) {
    const double largest =
        std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    const bool usable = largest > 0.0 && std::isfinite(direction.x + direction.y + direction.z);
    if (!usable) {
        direction = {0.0, 0.0, 1.0};
        return false;
    }
    const double length = std::sqrt(direction.x * direction.x + direction.y * direction.y +
                                    direction.z * direction.z);
    direction = {direction.x / length, direction.y / length, direction.z / length};
    return true;
}

/// Stores three floats. Adding zero turns -0 into 0, so that flat is exactly (0,0,1).
inline void store(const Direction& direction, float* normal) {
    normal[0] = static_cast<float>(direction.x + 0.0);
    normal[1] = static_cast<float>(direction.y + 0.0);
    normal[2] = static_cast<float>(direction.z + 0.0);
}

/// Returns the texel within [0, count) for any coordinate: the nearest one for Wrap::clamp.
inline int place_within(int place, int count, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(place, 0, count - 1);
    const int period = wrap == Wrap::mirror ? 2 * count : count;
    const int rest = (place % period + period) % period;
    return rest < count ? rest : period - 1 - rest;
}

/// Continues a clamped quantity beyond its border by point reflection at the border value, so that
/// a plane remains a plane. `at(place)` gives values inside; a single value is constant.
template <typename At>
auto reflected(int place, int count, const At& at) -> decltype(at(0)) {
    if (place >= 0 && place < count) return at(place);
    if (count == 1) return at(0);
    const int edge = place < 0 ? 0 : count - 1;
    return 2 * at(edge) - reflected(2 * edge - place, count, at);
}

/// This is a double, so that dividing a code by it is not an integer division.
template <typename Sample>
inline constexpr double largest_sample =
    std::is_floating_point_v<Sample> ? 1.0
                                     : static_cast<double>(std::numeric_limits<Sample>::max());

}  // namespace detail
}  // namespace relief
