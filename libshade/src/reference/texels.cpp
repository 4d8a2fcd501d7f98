// SPDX-License-Identifier: Apache-2.0
// Texture lookups as OpenGL defines them, in double. See texels.h.
// Tests: tests/shade/reference/texels_test.cpp.
#include "reference/texels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/direction.h"
#include "relief/mesh/error.h"
#include "relief/shade/image_source.h"

namespace relief::reference {

namespace {

/// Calls each(texture, use) for every texture that a material may have.
template <typename Each>
void for_each_texture(const Material& material, Each each) {
    each(material.diffuse_texture, ImageUse::color);
    each(material.specular_texture, ImageUse::color);
    each(material.emission_texture, ImageUse::color);
    each(material.occlusion_texture, ImageUse::data);
    each(material.opacity_texture, ImageUse::data);
    if (material.metallic_roughness) each(material.metallic_roughness->texture, ImageUse::data);
    if (material.normal_map) each(material.normal_map->texture, ImageUse::data);
    if (material.bump_map) each(material.bump_map->texture, ImageUse::data);
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

int wrapped(double index, int size, TextureWrap wrap) {
    const double n = size;
    if (wrap == TextureWrap::clamp) return static_cast<int>(std::clamp(index, 0.0, n - 1.0));
    const double period = wrap == TextureWrap::mirror ? 2.0 * n : n;
    const double within = index - std::floor(index / period) * period;
    // Far away, where doubles are coarser than texels, the remainder may round up to the period.
    const double first = std::min(within, period - 1.0);
    return static_cast<int>(first < n ? first : period - 1.0 - first);
}

Texels::Texels(const Image& image) : image_(to_linear(image)) {}

glm::dvec4 Texels::at(int x, int y) const {
    const std::span<const float> samples = image_.as<float>();
    const auto first = (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                        static_cast<std::size_t>(x)) *
                       static_cast<std::size_t>(image_.channels);
    const auto sample = [&](std::size_t channel) {
        return static_cast<double>(samples[first + channel]);
    };
    const double red = sample(0);
    switch (image_.channels) {
        case 1:
            return {red, red, red, 1.0};
        case 2:
            return {red, red, red, sample(1)};
        case 3:
            return {red, sample(1), sample(2), 1.0};
        default:
            return {red, sample(1), sample(2), sample(3)};
    }
}

glm::dvec4 Texels::bilinear(const glm::dvec2& uv, TextureWrap u, TextureWrap v) const {
    if (!is_finite(uv)) return glm::dvec4(not_a_number);
    const glm::dvec2 place = uv * glm::dvec2(image_.width, image_.height) - 0.5;
    const glm::dvec2 corner = glm::floor(place);
    const glm::dvec2 share = place - corner;
    const int left = wrapped(corner.x, image_.width, u);
    const int right = wrapped(corner.x + 1.0, image_.width, u);
    const int top = wrapped(corner.y, image_.height, v);
    const int bottom = wrapped(corner.y + 1.0, image_.height, v);
    const glm::dvec4 upper = at(left, top) * (1.0 - share.x) + at(right, top) * share.x;
    const glm::dvec4 lower = at(left, bottom) * (1.0 - share.x) + at(right, bottom) * share.x;
    return upper * (1.0 - share.y) + lower * share.y;
}

glm::dvec4 Texels::nearest(const glm::dvec2& uv, TextureWrap u, TextureWrap v, Trace& trace) const {
    if (!is_finite(uv)) return glm::dvec4(not_a_number);
    const int x = wrapped(std::floor(uv.x * image_.width), image_.width, u);
    const int y = wrapped(std::floor(uv.y * image_.height), image_.height, v);
    trace.decide(x);
    trace.decide(y);
    return at(x, y);
}

void SceneTexels::want(const Scene& scene, const Material& material) {
    for_each_texture(material, [&](const std::optional<Texture>& texture, ImageUse use) {
        if (!texture) return;
        const auto key = std::pair(texture->image, use);
        if (texels_.contains(key) || unreadable_.contains(texture->image)) return;
        const ImageSource& source = scene.images[texture->image];
        try {
            texels_.emplace(key, Texels(decode(source, use)));
        } catch (const FileError& error) {
            if (source.is_required) throw;
            unreadable_.emplace(texture->image, error.what());
        }
    });
}

glm::dvec4 SceneTexels::look_up(const Texture& texture, ImageUse use, const glm::dvec2& uv,
                                Trace& trace) const {
    const Texels& texels = get(texture.image, use);
    trace.look_up({uv * glm::dvec2(texels.width(), texels.height()), 0.0});
    if (texture.filter == TextureFilter::nearest) {
        return texels.nearest(uv, texture.wrap_u, texture.wrap_v, trace);
    }
    return texels.bilinear(uv, texture.wrap_u, texture.wrap_v);
}

}  // namespace relief::reference
