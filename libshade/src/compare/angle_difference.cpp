// SPDX-License-Identifier: Apache-2.0
// Angles between the directions of two images, in degrees, by atan2 in double. Directions without a
// length are counted and have a fixed angle: see image_compare.h.
// Tests: tests/shade/compare/angle_difference_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <span>

#include "parallel.h"
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

double degrees(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
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
            const double angle = one && other ? degrees(d, e) : (one == other ? 0.0 : 180.0);
            map[i] = static_cast<float>(angle);
        }
    });

    double sum = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        sum += static_cast<double>(map[i]);
        if (!has_direction(direction(from, i)) || !has_direction(direction(to, i)))
            ++result.undefined;
    }
    result.mean = sum / static_cast<double>(map.size());
    std::vector<float> sorted(map.begin(), map.end());
    // The smallest angle that at least 99 of 100 texels do not exceed.
    const std::size_t rank = (sorted.size() * 99 + 99) / 100 - 1;
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
    std::ranges::nth_element(sorted, at);
    result.p99 = static_cast<double>(*at);
    result.max = static_cast<double>(*std::max_element(at, sorted.end()));
    return result;
}

}  // namespace relief
