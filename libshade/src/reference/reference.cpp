// SPDX-License-Identifier: Apache-2.0
// The reference picture, pixel by pixel, and its conversion to a picture by exposure, tone mapping
// and sRGB codes over the background. In double. Sources: [Reinhard et al. 2002], [Narkowicz 2016],
// [Hill 2017], [Khronos PBR Neutral] (tone curves).
#include "relief/shade/reference.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel.h"
#include "reference/tracer.h"
#include "relief/mesh/report.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::reference;

// Radiance

namespace {

ReferenceHit first_shown(const PreparedScene& prepared, const Sample& sample) {
    if (!sample.first_shown) return {};
    const Hit& hit = *sample.first_shown;
    return {hit.instance, hit.triangle, is_back(prepared, hit)};
}

}  // namespace

Reference render_reference(const Scene& scene, const ReferenceSettings& settings, Report& report) {
    check(settings);
    Reference result;
    result.radiance = make_image(settings.width, settings.height, 4, 32, ColorSpace::linear);
    result.edges = make_image(settings.width, settings.height, 1, 8, ColorSpace::data);
    const PreparedPicture prepared(scene, settings, report);
    const Tracer& tracer = prepared.tracer();
    const auto width = static_cast<std::size_t>(settings.width);
    result.hits.resize(width * static_cast<std::size_t>(settings.height));
    const std::span<float> radiance = result.radiance.as<float>();
    const std::span<std::uint8_t> edges = result.edges.as<std::uint8_t>();
    parallel_for(result.hits.size(), width, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            const double x = static_cast<double>(pixel % width) + 0.5;
            const std::size_t row = pixel / width;
            const double y = static_cast<double>(row) + 0.5;
            const Sample sample = tracer.trace(x, y);
            for (int i = 0; i < 4; ++i) {
                radiance[4 * pixel + static_cast<std::size_t>(i)] =
                    static_cast<float>(sample.color[i]);
            }
            edges[pixel] = is_near_edge(tracer, sample, x, y, settings.edge_margin) ? 255 : 0;
            result.hits[pixel] = first_shown(prepared.scene(), sample);
        }
    });
    return result;
}

// Pictures

namespace {

/// Returns a fit to the ACES reference rendering and display transforms, in their own color space
/// [Hill 2017].
glm::dvec3 filmic(const glm::dvec3& x) {
    const glm::dmat3 aces_from_srgb(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823,
                                    0.01566, 0.83777);
    const glm::dmat3 srgb_from_aces(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276,
                                    -0.07367, -0.00605, 1.07602);
    const glm::dvec3 v = aces_from_srgb * x;
    return srgb_from_aces *
           ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

/// Returns colors as they are up to a peak of 0.76, apart from the reflectance of dielectrics,
/// which it takes away; brighter ones are compressed and lose their saturation [Khronos PBR
/// Neutral].
glm::dvec3 khronos_neutral(glm::dvec3 x) {
    constexpr double start = 0.8 - 0.04;
    constexpr double desaturation = 0.15;
    const double darkest = std::min({x.r, x.g, x.b});
    x -= darkest < 0.08 ? darkest - 6.25 * darkest * darkest : 0.04;
    const double peak = std::max({x.r, x.g, x.b});
    if (peak < start) return x;
    constexpr double room = 1.0 - start;
    const double compressed = 1.0 - room * room / (peak + room - start);
    const double kept = 1.0 / (desaturation * (peak - compressed) + 1.0);
    return glm::mix(glm::dvec3(compressed), x * (compressed / peak), kept);
}

glm::dvec3 tone_mapped(const glm::dvec3& x, ToneMapping mapping) {
    switch (mapping) {
        case ToneMapping::reinhard:
            return x / (1.0 + x);
        case ToneMapping::aces:
            return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
        case ToneMapping::khronos_neutral:
            return khronos_neutral(x);
        case ToneMapping::aces_hill:
            return filmic(x);
        case ToneMapping::aces_hill_boost:
            return filmic(x / 0.6);
        case ToneMapping::none:
            break;
    }
    return x;
}

/// Composes a color over the background; neither is multiplied by its alpha.
glm::dvec4 over(const glm::dvec4& front, const glm::dvec4& background) {
    const double behind = background.a * (1.0 - front.a);
    const double alpha = front.a + behind;
    if (alpha <= 0.0) return glm::dvec4(0.0);
    return {(glm::dvec3(front) * front.a + glm::dvec3(background) * behind) / alpha, alpha};
}

}  // namespace

ProbePicture reference::pixel_picture(const glm::dvec3& radiance, double alpha, const Scene& scene,
                                      OutputCoding output) {
    const bool is_exposed = output == OutputCoding::srgb;
    ProbePicture picture;
    picture.exposed = limited(
        is_exposed ? radiance * static_cast<double>(scene.exposure) : radiance, max_radiance);
    picture.toned = is_exposed ? tone_mapped(picture.exposed, scene.tone_mapping) : picture.exposed;
    if (output != OutputCoding::linear) picture.toned = limited(picture.toned, 1.0);
    glm::dvec4 background(scene.background);
    if (output != OutputCoding::linear) background = glm::min(background, glm::dvec4(1.0));
    picture.composed = over({picture.toned, alpha}, background);
    return picture;
}

Image reference_picture(const Image& radiance, const Scene& scene, OutputCoding output) {
    if (output == OutputCoding::half) throw InvalidInput("pictures cannot have the coding half");
    const bool codes = output == OutputCoding::srgb;
    Image picture = make_image(radiance.width, radiance.height, 4, 32,
                               codes ? ColorSpace::srgb : ColorSpace::linear);
    const std::span<const float> from = radiance.as<float>();
    const std::span<float> to = picture.as<float>();
    for (std::size_t i = 0; i < to.size(); i += 4) {
        const glm::dvec4 pixel = pixel_picture({from[i], from[i + 1], from[i + 2]},
                                               static_cast<double>(from[i + 3]), scene, output)
                                     .composed;
        for (int channel = 0; channel < 4; ++channel) {
            const auto value = static_cast<float>(pixel[channel]);
            to[i + static_cast<std::size_t>(channel)] =
                codes && channel < 3 ? srgb_from_linear(value) : value;
        }
    }
    return picture;
}

}  // namespace relief::shade
