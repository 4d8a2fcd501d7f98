// SPDX-License-Identifier: Apache-2.0
// Differences between two images: of their samples, in units of the images' own range, and of their
// directions, as angles in degrees by atan2. Sums are in double, in the order of the samples.
// image_compare.h says how NaN and directions without a length count.
#include "relief/shade/image_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "parallel.h"
#include "relief/mesh/error_stats.h"
#include "relief/mesh/report.h"

namespace relief {

// Samples

namespace {

/// The distance of two samples; 0 for two NaN or two equal infinities, infinite for one NaN.
double distance(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
    if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
    return std::abs(a - b);
}

template <typename T>
ImageDifference difference(const std::vector<T>& a, const std::vector<T>& b, std::size_t channels) {
    constexpr double peak = std::is_integral_v<T> ? std::numeric_limits<T>::max() : 1.0;
    ImageDifference result;
    double sum = 0.0;
    double sum_of_squares = 0.0;
    for (std::size_t pixel = 0; pixel < a.size(); pixel += channels) {
        bool differs = false;
        for (std::size_t i = pixel; i < pixel + channels; ++i) {
            const double error = distance(a[i], b[i]);
            differs = differs || error > 0.0;
            result.max = std::max(result.max, error);
            sum += error;
            sum_of_squares += error * error;
        }
        if (differs) ++result.differing_pixels;
    }
    if (!a.empty()) {
        result.mean = sum / static_cast<double>(a.size());
        result.rms = std::sqrt(sum_of_squares / static_cast<double>(a.size()));
        result.psnr = 20.0 * std::log10(peak / result.rms);
    }
    return result;
}

}  // namespace

ImageDifference compare(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels ||
        a.bits() != b.bits()) {
        throw InvalidInput(fmt::format(
            "images cannot be compared: {} x {} pixels, {} channels of {} bits against {} x {} "
            "pixels, {} channels of {} bits",
            a.width, a.height, a.channels, a.bits(), b.width, b.height, b.channels, b.bits()));
    }
    return std::visit(
        [&]<typename T>(const std::vector<T>& samples) {
            return difference(samples, std::get<std::vector<T>>(b.samples),
                              static_cast<std::size_t>(a.channels));
        },
        a.samples);
}

// Directions

namespace {

constexpr std::size_t texels_per_piece = 1 << 14;

glm::dvec3 direction(std::span<const float> samples, std::size_t texel) {
    return {samples[3 * texel], samples[3 * texel + 1], samples[3 * texel + 2]};
}

/// Tells whether the length is finite and not 0. Squares of floats neither overflow nor vanish in
/// double.
bool has_direction(const glm::dvec3& vector) {
    const double squared = glm::dot(vector, vector);
    return std::isfinite(squared) && squared > 0.0;
}

void check(const Image& a, const Image& b) {
    for (const Image* image : {&a, &b}) {
        if (image->empty()) throw InvalidInput("angles are asked for of an image without texels");
        if (image->channels != 3 || image->bits() != 32) {
            throw InvalidInput(
                fmt::format("angles are between directions in three float channels, not {} "
                            "channels of {} bits; decode_normal_map reads normal maps",
                            image->channels, image->bits()));
        }
    }
    if (a.width != b.width || a.height != b.height) {
        throw InvalidInput(
            fmt::format("directions of {} x {} and {} x {} texels cannot be compared", a.width,
                        a.height, b.width, b.height));
    }
}

}  // namespace

AngleDifference angle_difference(const Image& a, const Image& b) {
    check(a, b);
    AngleDifference result;
    result.map = make_image(a.width, a.height, 1, 32, ColorSpace::data);
    const std::span<float> map = result.map.as<float>();
    const std::span<const float> from = a.as<float>();
    const std::span<const float> to = b.as<float>();
    parallel_for(map.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 d = direction(from, i);
            const glm::dvec3 e = direction(to, i);
            const bool one = has_direction(d);
            const bool other = has_direction(e);
            const double angle =
                one && other ? degrees_between(d, e) : (one == other ? 0.0 : 180.0);
            map[i] = static_cast<float>(angle);
        }
    });

    result.angles = error_stats({map.begin(), map.end()});
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (!has_direction(direction(from, i)) || !has_direction(direction(to, i)))
            ++result.angles.undefined;
    }
    return result;
}

}  // namespace relief
