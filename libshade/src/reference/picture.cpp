// SPDX-License-Identifier: Apache-2.0
// From radiance to a picture: exposure, tone mapping, sRGB codes, the background behind. Linear
// light in, in double inside; NaN and negative radiance is black, infinite the largest value.
// Source: [Narkowicz 2016] (the fit to the film curve, by channel).
// Tests: tests/shade/reference/picture_test.cpp.
#include <algorithm>

#include "reference/limited.h"
#include "relief/mesh/error.h"
#include "relief/shade/reference.h"

namespace relief {

namespace {

using reference::limited;

double tone_mapped(double x, ToneMapping mapping) {
    switch (mapping) {
        case ToneMapping::reinhard:
            return x / (1.0 + x);
        case ToneMapping::aces:
            return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
        case ToneMapping::none:
            break;
    }
    return x;
}

/// Radiance as it shows in a picture, not coded yet.
glm::dvec3 shown(const glm::dvec3& radiance, const Scene& scene, OutputCoding output) {
    if (output == OutputCoding::linear) return limited(radiance, reference::largest_radiance);
    if (output == OutputCoding::clamped) return limited(radiance, 1.0);
    glm::dvec3 light =
        limited(radiance * static_cast<double>(scene.exposure), reference::largest_radiance);
    for (int i = 0; i < 3; ++i)
        light[i] = std::min(tone_mapped(light[i], scene.tone_mapping), 1.0);
    return light;
}

/// A colour over the background, neither multiplied by its alpha.
glm::dvec4 over(const glm::dvec4& front, const glm::dvec4& background) {
    const double behind = background.a * (1.0 - front.a);
    const double alpha = front.a + behind;
    if (alpha <= 0.0) return glm::dvec4(0.0);
    return {(glm::dvec3(front) * front.a + glm::dvec3(background) * behind) / alpha, alpha};
}

}  // namespace

Image reference_picture(const Image& radiance, const Scene& scene, OutputCoding output) {
    if (output == OutputCoding::half) throw InvalidInput("half is no picture's coding");
    const bool codes = output == OutputCoding::srgb;
    Image picture = make_image(radiance.width, radiance.height, 4, 32,
                               codes ? ColorSpace::srgb : ColorSpace::linear);
    const std::span<const float> from = radiance.as<float>();
    const std::span<float> to = picture.as<float>();
    glm::dvec4 background(scene.background);
    if (output != OutputCoding::linear) background = glm::min(background, glm::dvec4(1.0));
    for (std::size_t i = 0; i < to.size(); i += 4) {
        const glm::dvec3 color(from[i], from[i + 1], from[i + 2]);
        const glm::dvec4 pixel =
            over({shown(color, scene, output), static_cast<double>(from[i + 3])}, background);
        for (int channel = 0; channel < 4; ++channel) {
            const auto value = static_cast<float>(pixel[channel]);
            to[i + static_cast<std::size_t>(channel)] =
                codes && channel < 3 ? srgb_from_linear(value) : value;
        }
    }
    return picture;
}

}  // namespace relief
