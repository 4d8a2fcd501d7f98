// SPDX-License-Identifier: Apache-2.0
// Channels out of images and into them, sample by sample. Images of another kind throw.
// Tests: tests/mesh/image/image_channels_test.cpp.
#include "relief/mesh/image_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/largest_sample.h"
#include "image/texel_loops.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

template <typename Sample>
Sample sample_of(float value) {
    if constexpr (std::is_same_v<Sample, float>) {
        return value;
    } else {
        const float inside = value > 0.0F ? std::min(value, 1.0F) : 0.0F;
        return static_cast<Sample>(
            std::lround(inside * static_cast<float>(largest_sample<Sample>)));
    }
}

}  // namespace

Image channel_of(const Image& image, int channel) {
    if (channel < 0 || channel >= image.channels) {
        throw InvalidInput(
            fmt::format("there is no channel {}, but only {}", channel + 1, image.channels));
    }
    Image result = make_image(image.width, image.height, 1, 32, ColorSpace::data);
    const std::span<float> values = result.as<float>();
    const auto channels = static_cast<std::size_t>(image.channels);
    with_sample_type(image, [&]<typename Sample>(Sample) {
        const Sample* const samples = image.as<Sample>().data() + channel;
        Report unused;
        for_each_texel(values.size(), unused, [&](std::size_t texel, Report&) {
            values[texel] = static_cast<float>(samples[texel * channels]) /
                            static_cast<float>(largest_sample<Sample>);
        });
    });
    return result;
}

Image with_alpha(const Image& image, const Image& alpha) {
    check_floats(alpha, 1, "alphas");
    if (image.channels != 3)
        throw InvalidInput(fmt::format("alpha goes with 3 channels, not {}", image.channels));
    if (image.width != alpha.width || image.height != alpha.height) {
        throw InvalidInput(fmt::format("an alpha of {} x {} does not go with an image of {} x {}",
                                       alpha.width, alpha.height, image.width, image.height));
    }
    Image result = make_image(image.width, image.height, 4, image.bits(), image.color_space);
    const std::span<const float> values = alpha.as<float>();
    with_sample_type(image, [&]<typename Sample>(Sample) {
        const Sample* const from = image.as<Sample>().data();
        Sample* const to = result.as<Sample>().data();
        Report unused;
        for_each_texel(values.size(), unused, [&](std::size_t texel, Report&) {
            std::copy_n(from + texel * 3, 3, to + texel * 4);
            to[texel * 4 + 3] = sample_of<Sample>(values[texel]);
        });
    });
    return result;
}

void drop_alpha(Image& image) {
    if (image.channels != 4)
        throw InvalidInput(fmt::format("no alpha to drop from {} channels", image.channels));
    with_sample_type(image, [&]<typename Sample>(Sample) {
        std::vector<Sample>& samples = std::get<std::vector<Sample>>(image.samples);
        for (std::size_t texel = 1; texel < samples.size() / 4; ++texel)
            std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(texel * 4), 3,
                        samples.begin() + static_cast<std::ptrdiff_t>(texel * 3));
        samples.resize(samples.size() / 4 * 3);
    });
    image.channels = 3;
}

}  // namespace relief
