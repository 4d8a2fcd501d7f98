// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/interface_scale_test.cpp.
#include "window/interface_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relief::tools {
namespace {

constexpr std::array scale_steps{0.5F, 0.75F, 1.0F, 1.25F, 1.5F, 1.75F,
                                 2.0F, 2.5F,  3.0F, 3.5F,  4.0F};
static_assert(scale_steps.front() == least_interface_scale &&
              scale_steps.back() == most_interface_scale);

/// What is no scale at all counts as 1.
float usable(float scale) {
    if (!std::isfinite(scale) || scale <= 0.0F) return 1.0F;
    return std::clamp(scale, least_interface_scale, most_interface_scale);
}

}  // namespace

InterfaceScale interface_scale(std::optional<float> wanted, float content_scale,
                               float pixels_to_unit) {
    const float glyphs = usable(wanted.value_or(content_scale));
    const bool has_ratio = std::isfinite(pixels_to_unit) && pixels_to_unit > 0.0F;
    return {.layout = glyphs / (has_ratio ? pixels_to_unit : 1.0F), .glyphs = glyphs};
}

float next_scale(float scale, bool is_larger) {
    if (is_larger) {
        const auto* const next = std::upper_bound(scale_steps.begin(), scale_steps.end(), scale);
        return next == scale_steps.end() ? scale_steps.back() : *next;
    }
    const auto* const next = std::lower_bound(scale_steps.begin(), scale_steps.end(), scale);
    return next == scale_steps.begin() ? scale_steps.front() : *(next - 1);
}

}  // namespace relief::tools
