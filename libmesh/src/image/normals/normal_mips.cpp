// SPDX-License-Identifier: Apache-2.0
// Mip levels of normals and the roughness that makes up for them, see normal_mips.h. Vectors are
// averaged, never codes, and only the result is made unit; its length before is what is known of
// the variance. Tests: tests/mesh/image/normals/normal_mips_test.cpp.
#include "relief/mesh/normal_mips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/texel_loops.h"
#include "relief/mesh/error.h"
#include "relief/mesh/mip_levels.h"

namespace relief {
namespace {

constexpr double shortest_mean = 1e-6;

}  // namespace

std::vector<Image> normal_mip_levels(const Image& normals) {
    check_floats(normals, 3, "normals");
    return mip_levels(normals);
}

Image split_lengths(Image& means, Report& report) {
    check_floats(means, 3, "normals");
    Image lengths = make_image(means.width, means.height, 1, 32, ColorSpace::data);
    const std::span<float> vectors = means.as<float>();
    const std::span<float> to = lengths.as<float>();
    for_each_texel(to.size(), report, [&](std::size_t texel, Report& found) {
        float* const vector = &vectors[texel * 3];
        Direction direction{vector[0], vector[1], vector[2]};
        const double length = std::sqrt(direction.x * direction.x + direction.y * direction.y +
                                        direction.z * direction.z);
        to[texel] = static_cast<float>(std::min(length, 1.0));
        if (length < shortest_mean) direction = {0.0, 0.0, 0.0};
        if (!make_unit(direction))
            found.add("normals that cancel", "texel", texel, "made flat, with length 0");
        store(direction, vector);
    });
    return lengths;
}

double slope_variance_of_length(double length) {
    const double r = std::clamp(length, 1e-3, 1.0);
    return (1.0 / (r * r) - 1.0) / 2.0;
}

double toksvig_factor(double length, double exponent) {
    const double r = std::clamp(length, 0.0, 1.0);
    return r / (r + exponent * (1.0 - r));
}

double roughness_with_variance(double roughness, double variance) {
    const double alpha = roughness * roughness;
    return std::sqrt(std::sqrt(std::min(alpha * alpha + 2.0 * variance, 1.0)));
}

Image roughness_from_lengths(const Image& lengths, double roughness) {
    check_floats(lengths, 1, "lengths");
    if (!(roughness >= 0.0 && roughness <= 1.0))
        throw InvalidInput(fmt::format("the roughness {} is not within 0 and 1", roughness));
    Image result = make_image(lengths.width, lengths.height, 1, 32, ColorSpace::data);
    const std::span<const float> from = lengths.as<float>();
    const std::span<float> to = result.as<float>();
    Report unused;
    for_each_texel(to.size(), unused, [&](std::size_t texel, Report&) {
        const double variance = slope_variance_of_length(static_cast<double>(from[texel]));
        to[texel] = static_cast<float>(roughness_with_variance(roughness, variance));
    });
    return result;
}

}  // namespace relief
