// SPDX-License-Identifier: Apache-2.0
/// \file
/// Extracts heights from images, and finds the texels that have none.
/// Tests: tests/mesh/image/height_map_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "relief/mesh/image.h"

namespace relief {

/// The channel that holds the heights. For mean, luminance and red of a gray image it is the only
/// one, without decoding. For colors, only `luminance` decodes sRGB.
enum class HeightChannel {
    mean,  ///< The mean of red, green and blue.
    /// The luminance of Rec. 709 in linear light; integer samples are decoded from sRGB.
    luminance,
    red,
    green,
    blue,
    alpha,
};

/// Extracts the heights of an image as one float channel.
///
/// Integer samples are divided by their maximum. Alpha is ignored, unless it is the channel.
/// \throws InvalidInput if the image is empty or has no such channel
Image height_field(const Image& image, HeightChannel channel = HeightChannel::mean);

/// Heights, and the texels that do not belong to the surface.
struct HeightMap {
    /// One channel: gray images keep their samples and bits, others are as from height_field().
    Image heights;
    /// The alpha of the image with its bits; empty if it has none or alpha holds the heights.
    Image alpha;
    /// 1 for texels with alpha 0, whose colors are not heights. Empty if there are none.
    std::vector<std::uint8_t> transparent;
    /// Share of texels whose red, green and blue clearly differ; near 0 for height maps. It is
    /// estimated from about 10000 regularly spaced texels.
    double colored_share = 0.0;
    /// Share of texels whose alpha is neither 0 nor the maximum, estimated in the same way: alpha
    /// may be the heights.
    double partial_alpha_share = 0.0;

    [[nodiscard]] std::size_t transparent_count() const;
};

/// Extracts the heights of an image.
///
/// \param image  is consumed; the samples of gray images are moved, not copied
/// \throws InvalidInput as height_field()
HeightMap height_map(Image&& image, HeightChannel channel = HeightChannel::mean);

}  // namespace relief
