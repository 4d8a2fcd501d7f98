// SPDX-License-Identifier: Apache-2.0
/// \file
/// The words for how height and normal maps are made and read, the same in every tool.
#pragma once

#include "common/options.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

inline Choices<Kernel> kernel_choices() {
    return {{"forward", Kernel::forward},   {"central3", Kernel::central3},
            {"prewitt3", Kernel::prewitt3}, {"sobel3", Kernel::sobel3},
            {"scharr3", Kernel::scharr3},   {"sobel5", Kernel::sobel5},
            {"scharr5", Kernel::scharr5},   {"central5", Kernel::central5},
            {"central7", Kernel::central7}, {"gaussian", Kernel::gaussian}};
}

/// Absent: as the map calls for.
inline Choices<std::optional<Kernel>> kernel_or_auto_choices() {
    Choices<std::optional<Kernel>> choices = {{"auto", std::nullopt}};
    for (const auto& [name, kernel] : kernel_choices())
        choices.emplace_back(name, kernel);
    return choices;
}

inline Choices<HeightChannel> height_channel_choices() {
    return {{"mean", HeightChannel::mean}, {"luminance", HeightChannel::luminance},
            {"red", HeightChannel::red},   {"green", HeightChannel::green},
            {"blue", HeightChannel::blue}, {"alpha", HeightChannel::alpha}};
}

inline Choices<MapAlpha> map_alpha_choices() {
    return {{"none", MapAlpha::none}, {"height", MapAlpha::height}, {"keep", MapAlpha::keep}};
}

inline Choices<Wrap> wrap_choices() {
    return {{"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}, {"mirror", Wrap::mirror}};
}

inline Choices<Green> green_choices() {
    return {{"up", Green::up}, {"down", Green::down}};
}

/// The code of zero in 8 bits; in 16 bits 32767.5 and 32768.
inline Choices<FlatCode> zero_code_choices() {
    return {{"127.5", FlatCode::half}, {"128", FlatCode::middle}};
}

inline Choices<Dither> dither_choices() {
    return {
        {"none", Dither::none}, {"ordered", Dither::ordered}, {"blue-noise", Dither::blue_noise}};
}

}  // namespace relief::tools
