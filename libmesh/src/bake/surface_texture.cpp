// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/bake/high_detail_test.cpp.
#include "bake/surface_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "geometry/direction.h"
#include "image/normal_coding.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// The texel that one beyond the border stands for.
std::size_t wrapped(double index, int size, TextureWrap wrap) {
    const double count = size;
    if (wrap == TextureWrap::clamp)
        return static_cast<std::size_t>(std::clamp(index, 0.0, count - 1.0));
    const double period = wrap == TextureWrap::mirror ? 2.0 * count : count;
    // Far away doubles are coarser than texels, and what is left may be a whole period.
    const double within = std::min(index - std::floor(index / period) * period, period - 1.0);
    return static_cast<std::size_t>(within < count ? within : period - 1.0 - within);
}

/// The weighted sum of value(texel) around a place on the image.
template <typename Value>
glm::dvec3 filtered(const SurfaceTexture& texture, const glm::dvec2& texcoord, const Value& value) {
    const Image& image = *texture.image;
    glm::dvec2 uv = texcoord;
    if (texture.transform != GltfTextureTransform{})
        uv = glm::dvec2(transformed(texture.transform, glm::vec2(texcoord)));
    if (!is_finite(uv)) uv = glm::dvec2(0.0);
    const glm::dvec2 place = uv * glm::dvec2(image.width, image.height);
    const auto at = [&](double x, double y) {
        return value(wrapped(y, image.height, texture.wrap_v) *
                         static_cast<std::size_t>(image.width) +
                     wrapped(x, image.width, texture.wrap_u));
    };
    if (texture.filter == TextureFilter::nearest) {
        const glm::dvec2 texel = glm::floor(place);
        return at(texel.x, texel.y);
    }
    const glm::dvec2 corner = glm::floor(place - 0.5);
    const glm::dvec2 share = place - 0.5 - corner;
    const glm::dvec3 upper =
        glm::mix(at(corner.x, corner.y), at(corner.x + 1.0, corner.y), share.x);
    const glm::dvec3 lower =
        glm::mix(at(corner.x, corner.y + 1.0), at(corner.x + 1.0, corner.y + 1.0), share.x);
    return glm::mix(upper, lower, share.y);
}

/// sRGB codes of 8 bits as light.
const std::array<double, 256>& light_of_bytes() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> light{};
        for (std::size_t code = 0; code < light.size(); ++code)
            light[code] = static_cast<double>(linear_from_srgb(static_cast<float>(code) / 255.0F));
        return light;
    }();
    return table;
}

template <typename Sample>
double light_of(Sample sample, bool is_srgb) {
    if constexpr (std::is_same_v<Sample, std::uint8_t>) {
        return is_srgb ? light_of_bytes()[sample] : sample / 255.0;
    } else if constexpr (std::is_same_v<Sample, std::uint16_t>) {
        return is_srgb
                   ? static_cast<double>(linear_from_srgb(static_cast<float>(sample) / 65535.0F))
                   : sample / 65535.0;
    } else {
        return static_cast<double>(sample);
    }
}

void check(const SurfaceTexture& texture, int least_channels, const char* what) {
    if (texture.image == nullptr || texture.image->empty())
        throw InvalidInput(fmt::format("{} without an image", what));
    if (texture.image->channels < least_channels) {
        throw InvalidInput(fmt::format("{} of {} channels, not {}", what, texture.image->channels,
                                       least_channels));
    }
}

}  // namespace

glm::dvec3 color_at(const SurfaceTexture& texture, const glm::dvec2& texcoord) {
    const Image& image = *texture.image;
    const auto channels = static_cast<std::size_t>(image.channels);
    const bool is_srgb = image.color_space == ColorSpace::srgb;
    return std::visit(
        [&](const auto& samples) {
            return filtered(texture, texcoord, [&](std::size_t texel) {
                const auto* sample = &samples[channels * texel];
                const double red = light_of(sample[0], is_srgb);
                if (channels < 3) return glm::dvec3(red);
                return glm::dvec3(red, light_of(sample[1], is_srgb), light_of(sample[2], is_srgb));
            });
        },
        image.samples);
}

glm::dvec3 normal_at(const SurfaceNormalMap& map, const glm::dvec2& texcoord) {
    const Image& image = *map.texture.image;
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto scale = static_cast<double>(map.scale);
    const glm::dvec3 scales(scale, map.green == Green::up ? scale : -scale, 1.0);
    return std::visit(
        [&](const auto& samples) {
            using Sample = std::decay_t<decltype(samples[0])>;
            const NormalCoding<Sample> coding{map.flat};
            const ExactFlat<Sample> exact(map.flat == FlatCode::half ? map.flat_codes
                                                                     : std::nullopt);
            return scales * filtered(map.texture, texcoord, [&](std::size_t texel) {
                       const Sample* sample = &samples[channels * texel];
                       if (exact.is_flat(sample[0], sample[1]))
                           return glm::dvec3(0.0, 0.0, coding.decoded(sample[2]));
                       return glm::dvec3(coding.decoded(sample[0]), coding.decoded(sample[1]),
                                         coding.decoded(sample[2]));
                   });
        },
        image.samples);
}

void check(const HighDetail& detail) {
    std::vector<HighMaterial> all = detail.materials;
    if (detail.otherwise) all.push_back(*detail.otherwise);
    for (const HighMaterial& material : all) {
        if (material.color_texture) check(*material.color_texture, 1, "a colour texture");
        if (material.normal_map) check(material.normal_map->texture, 3, "a normal map");
    }
    const std::size_t vertices = detail.mesh->positions.size();
    if (!detail.color_texcoords.empty() && detail.color_texcoords.size() != vertices) {
        throw InvalidInput(fmt::format("{} texture coordinates for {} vertices",
                                       detail.color_texcoords.size(), vertices));
    }
    for (const MaterialRange& range : detail.mesh->material_ranges) {
        if (range.material && *range.material >= detail.materials.size()) {
            throw InvalidInput(fmt::format("a high mesh names material {}, but there are only {}",
                                           *range.material, detail.materials.size()));
        }
    }
}

}  // namespace relief
