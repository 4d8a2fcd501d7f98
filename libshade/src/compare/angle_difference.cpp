// SPDX-License-Identifier: Apache-2.0
// Angles between the directions of two images, in degrees, by atan2 in double. Directions without a
// length are counted and have a fixed angle: see image_compare.h.
// Tests: tests/shade/compare/angle_difference_test.cpp.
#include <fmt/format.h>

#include <cmath>
#include <glm/glm.hpp>
#include <span>

#include "parallel.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"
#include "relief/shade/image_compare.h"

namespace relief {

namespace {

constexpr std::size_t texels_per_piece = 1 << 14;

glm::dvec3 direction(std::span<const float> samples, std::size_t texel) {
    return {samples[3 * texel], samples[3 * texel + 1], samples[3 * texel + 2]};
}

/// Squares of floats neither overflow nor vanish in double.
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

    for (std::size_t i = 0; i < map.size(); ++i) {
        if (!has_direction(direction(from, i)) || !has_direction(direction(to, i)))
            ++result.undefined;
    }
    const AngleDistribution angles = angle_distribution({map.begin(), map.end()});
    result.mean = angles.mean;
    result.p99 = angles.p99;
    result.max = angles.max;
    return result;
}

}  // namespace relief
