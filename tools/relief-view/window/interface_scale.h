// SPDX-License-Identifier: Apache-2.0
/// \file
/// How large text and panels are: 1 is a text of 13 pixels on an ordinary screen. A screen says
/// what it needs; whoever sits before it may want something else.
/// Tests: tests/tools/window/interface_scale_test.cpp.
#pragma once

#include <optional>

namespace relief::tools {

inline constexpr float least_interface_scale = 0.5F;
inline constexpr float most_interface_scale = 4.0F;

/// In what Dear ImGui lays out and draws.
struct InterfaceScale {
    float layout = 1.0F;  ///< Of sizes in the window's units.
    float glyphs = 1.0F;  ///< Of letters in pixels: sharp where a unit is several pixels.

    friend bool operator==(const InterfaceScale&, const InterfaceScale&) = default;
};

/// \param wanted          by option or key; absent: as the screen says
/// \param content_scale   how much larger than usual the screen wants things, in pixels
/// \param pixels_to_unit  pixels that a unit of the window has; on some systems always 1
InterfaceScale interface_scale(std::optional<float> wanted, float content_scale,
                               float pixels_to_unit);

/// The next larger (or smaller) one of 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.5, 3, 3.5, 4.
float next_scale(float scale, bool is_larger);

}  // namespace relief::tools
