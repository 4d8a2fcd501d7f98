// SPDX-License-Identifier: Apache-2.0
// Radiance that half floats can hold; see radiance.h. Tests: tests/shade/gl/cube_map_test.cpp.
#include "environment/radiance.h"

#include <cmath>

namespace relief {

namespace {

/// What a half float can hold of a sample, counting what it cannot.
float storable(float value, std::size_t texel, Report& report) {
    if (std::isfinite(value) && std::abs(value) <= largest_half) return value;
    if (!std::isfinite(value)) {
        report.add("radiance that is not finite", "texel", texel,
                   "counts as 65504 if positive infinity, else as 0");
        return value > 0.0F ? largest_half : 0.0F;
    }
    report.add("radiance beyond half floats", "texel", texel, "is clamped to 65504");
    return std::copysign(largest_half, value);
}

}  // namespace

Image storable_radiance(const Image& image, Report& report) {
    Image linear = to_linear(image);
    const auto samples = linear.as<float>();
    const auto channels = static_cast<std::size_t>(linear.channels);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = storable(samples[i], i / channels, report);
    return linear;
}

}  // namespace relief
