// SPDX-License-Identifier: Apache-2.0
// Normals, codes and slopes of a height field [Blinn 1978]. Rows are computed in parallel by
// bump_rows.cpp. Heights that are not finite are detected by their slopes; only then are they
// filled and reported, and all rows are computed again.
#include "relief/mesh/bump.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "bump/bump_rows.h"
#include "image/height_holes.h"
#include "large_memory.h"
#include "parallel.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/kernel_choice.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

// Differences of floats reach 7e38. With these limits, squares of slopes stay within the range of
// double.
constexpr double max_strength = 1e30;
constexpr double max_texel = 1e30;

void check(const Image& height, const BumpOptions& options) {
    if (height.empty()) throw InvalidInput("an empty height field has no normals");
    if (height.channels != 1)
        throw InvalidInput(fmt::format("a height field has one channel, not {}", height.channels));
    check_bump(options);
}

/// Computes all rows in parallel. Returns false if a height is not finite.
bool make_all_rows(const HeightRows& heights, const BumpOptions& options,
                   const BumpTarget& target) {
    const std::size_t grain =
        std::max<std::size_t>(1, bump_texels_per_piece / static_cast<std::size_t>(heights.width));
    std::atomic<bool> finite = true;
    parallel_for(static_cast<std::size_t>(heights.height), grain,
                 [&](std::size_t begin, std::size_t end) {
                     if (!make_bump_rows(heights, options, target, static_cast<int>(begin),
                                         static_cast<int>(end)))
                         finite = false;
                 });
    return finite;
}

template <typename Sample>
std::function<const void*(int)> rows_of(std::span<const Sample> samples, int width) {
    return [=](int row) { return samples.data() + static_cast<std::ptrdiff_t>(row) * width; };
}

/// Computes all rows of an image. If it has holes, the rows are computed from a filled copy.
void make_image_rows(const Image& height, const BumpOptions& given, const BumpTarget& target,
                     Report& report) {
    const BumpOptions options = resolve_options(height, given);
    HeightRows heights{height.width, height.height, height.bits(), {}};
    std::visit(
        [&](const auto& samples) { heights.row = rows_of(std::span(samples), height.width); },
        height.samples);
    if (make_all_rows(heights, options, target)) return;
    const std::vector<float> whole = filled_holes(height, *options.wrap, report);
    heights.row = rows_of(std::span(whole), height.width);
    make_all_rows(heights, options, target);
}

/// The rows of an image as a target.
template <typename Sample>
std::function<void*(int)> target_rows(Image& image) {
    Sample* const first = image.as<Sample>().data();
    const std::ptrdiff_t row_size = static_cast<std::ptrdiff_t>(image.width) * image.channels;
    return [=](int row) { return first + row * row_size; };
}

Image floats_from_height(const Image& height, int channels, BumpResult result,
                         const BumpOptions& options, Report& report) {
    check(height, options);
    Image image = make_image(height.width, height.height, channels, 32, ColorSpace::data);
    make_image_rows(height, options, {result, {}, target_rows<float>(image)}, report);
    return image;
}

/// Returns an image in large memory pages, because all of it will be written.
template <typename Sample>
Image image_to_fill(int width, int height, int channels) {
    Image image{width, height, channels, ColorSpace::data, {}};
    std::vector<Sample> samples;
    reserve_to_fill(samples, image.sample_count());
    samples.resize(image.sample_count());
    image.samples = std::move(samples);
    return image;
}

Image image_to_fill(int width, int height, int channels, int bits) {
    if (bits == 8) return image_to_fill<std::uint8_t>(width, height, channels);
    if (bits == 16) return image_to_fill<std::uint16_t>(width, height, channels);
    if (bits == 32) return image_to_fill<float>(width, height, channels);
    return make_image(width, height, channels, bits, ColorSpace::data);  // Throws.
}

}  // namespace

void check_bump(const BumpOptions& options) {
    if (!(std::abs(options.strength) <= max_strength)) {
        throw InvalidInput(
            fmt::format("the strength {} is not within +-{}", options.strength, max_strength));
    }
    for (const double size : {options.texel.x, options.texel.y}) {
        if (!(size >= 1.0 / max_texel && size <= max_texel)) {
            throw InvalidInput(fmt::format("the texel size {} is not within {} and {}", size,
                                           1.0 / max_texel, max_texel));
        }
    }
    gradient_kernel(options.kernel.value_or(Kernel::gaussian), options.gaussian_radius);
}

BumpOptions resolve_options(const Image& height, BumpOptions options) {
    check(height, options);
    if (!options.wrap) options.wrap = detect_tiling(height).wraps();
    if (!options.kernel) {
        const KernelChoice choice = choose_kernel(height, options);
        options.kernel = choice.kernel;
        options.gaussian_radius = choice.gaussian_radius;
    }
    return options;
}

Image normals_from_height(const Image& height, const BumpOptions& options, Report& report) {
    return floats_from_height(height, 3, BumpResult::normals, options, report);
}

Image slopes_from_height(const Image& height, const BumpOptions& options, Report& report) {
    return floats_from_height(height, 2, BumpResult::slopes, options, report);
}

void normal_map_from_height(const Image& height, const BumpOptions& options,
                            const NormalMapFormat& format, Image& result, Report& report) {
    check(height, options);
    const bool fits = result.width == height.width && result.height == height.height &&
                      result.channels == 3 && result.bits() == format.bits;
    if (!fits) result = image_to_fill(height.width, height.height, 3, format.bits);
    result.color_space = ColorSpace::data;
    BumpTarget target{BumpResult::codes, format, {}};
    if (format.bits == 8)
        target.row = target_rows<std::uint8_t>(result);
    else if (format.bits == 16)
        target.row = target_rows<std::uint16_t>(result);
    else
        target.row = target_rows<float>(result);
    make_image_rows(height, options, target, report);
}

Image normal_map_from_height(const Image& height, const BumpOptions& options,
                             const NormalMapFormat& format, Report& report) {
    Image result;
    normal_map_from_height(height, options, format, result, report);
    return result;
}

}  // namespace relief
