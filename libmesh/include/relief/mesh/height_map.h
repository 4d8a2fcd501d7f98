// SPDX-License-Identifier: Apache-2.0
/// \file
/// Heights out of images: which number of a colour is the height, and which texels have none.
/// Tests: tests/mesh/image/heights/height_map_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "relief/mesh/image.h"

namespace relief {

/// Which number of a colour is the height. Grey has only one, which all but the last three of these
/// take; no colour space is decoded but by `luminance`.
enum class HeightChannel {
    mean,       ///< Of red, green and blue: data has no luminance.
    luminance,  ///< Rec. 709's, in linear light: integer samples are taken for sRGB-coded.
    red,
    green,
    blue,
    alpha,
};

/// The heights in an image: one float channel.
///
/// Integer samples are divided by their maximum. Alpha is left out, unless it is the channel.
/// \throws InvalidInput if the image is empty, or has no such channel
Image height_field(const Image& image, HeightChannel channel = HeightChannel::mean);

/// Heights, and which of them are no part of the surface.
struct HeightMap {
    /// One channel: grey images as they are stored, of any depth; others as height_field() says.
    Image heights;
    /// The alpha of the image, in its depth; empty where it has none or it is the height.
    Image alpha;
    /// 1 where alpha is 0: what colour stands there is no height. Empty where no texel is so.
    std::vector<std::uint8_t> transparent;
    /// Share of texels whose red, green and blue clearly differ: of a height map none. Of some
    /// 10000 texels in even distances.
    double colored_share = 0.0;
    /// Share of texels whose alpha is neither 0 nor the largest: alpha may be heights. Of the same.
    double partial_alpha_share = 0.0;

    [[nodiscard]] std::size_t transparent_count() const;
};

/// \param image  taken apart: where it is grey, its samples become the heights without a copy
/// \throws as height_field()
HeightMap height_map(Image&& image, HeightChannel channel = HeightChannel::mean);

}  // namespace relief
