// SPDX-License-Identifier: Apache-2.0
// Maps values to 8-bit sRGB colors: interpolated between five colors from black to pale yellow that
// follow matplotlib's map "magma". NaN becomes green, which no other value has.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

namespace {

const std::array<glm::dvec3, 5> heat{
    {{0, 0, 4}, {81, 18, 124}, {183, 55, 121}, {252, 137, 97}, {252, 253, 191}}};
const glm::dvec3 no_number{0, 255, 0};

/// \param share  the ratio to the brightest value
glm::dvec3 color_of(double share) {
    if (std::isnan(share)) return no_number;
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(heat.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), heat.size() - 2);
    return glm::mix(heat.at(below), heat.at(below + 1), place - static_cast<double>(below));
}

}  // namespace

Image false_color_image(const Image& values, double brightest) {
    if (values.empty() || values.channels != 1 || values.bits() != 32)
        throw InvalidInput("only an image of one float channel can be shown as heat");
    if (!(brightest > 0.0))
        throw InvalidInput(
            fmt::format("the brightest value is {}, but must be above 0", brightest));
    Image picture = make_image(values.width, values.height, 3, 8, ColorSpace::srgb);
    const auto from = values.as<float>();
    const auto to = picture.as<std::uint8_t>();
    for (std::size_t i = 0; i < from.size(); ++i) {
        const glm::dvec3 color = color_of(static_cast<double>(from[i]) / brightest);
        for (std::size_t c = 0; c < 3; ++c)
            to[3 * i + c] = static_cast<std::uint8_t>(std::lround(color[static_cast<int>(c)]));
    }
    return picture;
}

}  // namespace relief
