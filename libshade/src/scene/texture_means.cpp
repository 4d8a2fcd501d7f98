// SPDX-License-Identifier: Apache-2.0
// Mean colours of images, in double, in row order: the same bits every time. sRGB codes are counted
// first and decoded once each. Tests: tests/shade/scene/texture_means_test.cpp.
#include "scene/texture_means.h"

#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace relief {

namespace {

double decoded(double sample, ColorSpace space) {
    return space == ColorSpace::srgb
               ? static_cast<double>(linear_from_srgb(static_cast<float>(sample)))
               : sample;
}

/// The mean of one channel of integer codes, from how often each occurs.
template <typename Code>
double mean_of_codes(const std::vector<Code>& samples, std::size_t channel, std::size_t channels,
                     ColorSpace space) {
    constexpr std::size_t code_count = std::size_t{1} << (8 * sizeof(Code));
    std::vector<std::size_t> counts(code_count, 0);
    for (std::size_t i = channel; i < samples.size(); i += channels)
        ++counts[samples[i]];
    double sum = 0.0;
    for (std::size_t code = 0; code < code_count; ++code) {
        if (counts[code] == 0) continue;
        const double value =
            static_cast<double>(code) / static_cast<double>(std::numeric_limits<Code>::max());
        sum += static_cast<double>(counts[code]) * decoded(value, space);
    }
    return sum / static_cast<double>(samples.size() / channels);
}

double mean_of_floats(const std::vector<float>& samples, std::size_t channel, std::size_t channels,
                      ColorSpace space) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = channel; i < samples.size(); i += channels) {
        if (!std::isfinite(samples[i])) continue;
        sum += decoded(samples[i], space);
        ++count;
    }
    return count == 0 ? 1.0 : sum / static_cast<double>(count);
}

}  // namespace

glm::vec3 mean_color(const Image& image) {
    if (image.empty()) return glm::vec3(1.0F);
    const auto channels = static_cast<std::size_t>(image.channels);
    glm::vec3 mean(1.0F);
    for (int i = 0; i < 3; ++i) {
        const std::size_t channel = channels < 3 ? 0 : static_cast<std::size_t>(i);
        mean[i] = static_cast<float>(std::visit(
            [&](const auto& samples) {
                using Sample = typename std::decay_t<decltype(samples)>::value_type;
                if constexpr (std::is_same_v<Sample, float>) {
                    return mean_of_floats(samples, channel, channels, image.color_space);
                } else {
                    return mean_of_codes(samples, channel, channels, image.color_space);
                }
            },
            image.samples));
    }
    return mean;
}

}  // namespace relief
