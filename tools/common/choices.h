// SPDX-License-Identifier: Apache-2.0
/// \file
/// The option words of normals, tangents, height maps and normal maps, which all tools share.
/// Tests: tests/tools/relief_bake_bump_test.cpp, relief_bake_convert_test.cpp.
#pragma once

#include <optional>
#include <string>

#include "common/options.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

inline Choices<NormalMode> normal_choices() {
    return {{"keep", NormalMode::keep},
            {"flat", NormalMode::flat},
            {"auto", NormalMode::automatic},
            {"uniform", NormalMode::uniform},
            {"area", NormalMode::area},
            {"angle", NormalMode::angle},
            {"sine", NormalMode::sine},
            {"max", NormalMode::max},
            {"angle-edges", NormalMode::angle_edges},
            {"area-angle", NormalMode::area_angle}};
}

inline Choices<TangentMode> tangent_choices() {
    return {{"keep", TangentMode::keep},
            {"none", TangentMode::none},
            {"mikktspace", TangentMode::mikktspace},
            {"area-weighted", TangentMode::area_weighted},
            {"lengyel", TangentMode::lengyel}};
}

inline Choices<Kernel> kernel_choices() {
    return {{"forward", Kernel::forward},   {"central3", Kernel::central3},
            {"prewitt3", Kernel::prewitt3}, {"sobel3", Kernel::sobel3},
            {"scharr3", Kernel::scharr3},   {"sobel5", Kernel::sobel5},
            {"scharr5", Kernel::scharr5},   {"central5", Kernel::central5},
            {"central7", Kernel::central7}, {"gaussian", Kernel::gaussian}};
}

/// "auto" is an absent kernel, which is chosen by the map.
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

/// The words are codes of 8 bits. In 16 bits the codes are 32767.5 and 32768.
inline Choices<FlatCode> zero_code_choices() {
    return {{"127.5", FlatCode::half}, {"128", FlatCode::middle}};
}

inline Choices<Dither> dither_choices() {
    return {
        {"none", Dither::none}, {"ordered", Dither::ordered}, {"blue-noise", Dither::blue_noise}};
}

/// The continuation beyond the border along each axis. An absent value is detected from the map.
struct WrapsOrAuto {
    std::optional<Wrap> x, y;

    [[nodiscard]] bool is_settled() const { return x && y; }
    [[nodiscard]] Wraps value_or(const Wraps& detected) const {
        return {x.value_or(detected.x), y.value_or(detected.y)};
    }
};

/// Adds --wrap WORD[,WORD] with the additional word "auto".
AddedOption add_wrap(CLI::App& app, WrapsOrAuto& target, const std::string& description);

/// Adds --wrap WORD[,WORD] without "auto".
AddedOption add_wrap(CLI::App& app, std::optional<Wraps>& target, const std::string& description);

/// Returns "repeat", or "repeat,clamp" for different axes.
std::string wrap_text(const Wraps& wraps);

}  // namespace relief::tools
