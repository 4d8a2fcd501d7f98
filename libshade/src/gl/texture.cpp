// SPDX-License-Identifier: Apache-2.0
// Images to textures and back: choice of texel format, upload, mipmaps, sampling. See texture.h.
// Source of the formats' meaning: OpenGL 3.3 core, tables 3.12 and 3.13.
// Tests: tests/shade/gl/texture_test.cpp.
#include "gl/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "relief/mesh/error.h"
#include "relief/mesh/mip_levels.h"
#include "relief/shade/error.h"

namespace relief::gl {

namespace {

using Four = std::array<GLenum, 4>;  ///< For 1, 2, 3 and 4 channels.

GLenum for_channels(const Four& formats, int channels) {
    assert(channels >= 1 && channels <= 4);
    return formats.at(static_cast<std::size_t>(channels - 1));
}

constexpr Four memory_formats{GL_RED, GL_RG, GL_RGB, GL_RGBA};

GLenum memory_type(int bits) {
    switch (bits) {
        case 8:
            return GL_UNSIGNED_BYTE;
        case 16:
            return GL_UNSIGNED_SHORT;
        default:
            return GL_FLOAT;
    }
}

/// Grey and grey with alpha as RGB and RGB with alpha.
Image spread_grey(const Image& grey) {
    const int channels = grey.channels + 2;
    Image rgb = make_image(grey.width, grey.height, channels, 8, grey.color_space);
    const auto from = grey.as<std::uint8_t>();
    const auto to = rgb.as<std::uint8_t>();
    const auto stride_from = static_cast<std::size_t>(grey.channels);
    const auto stride_to = static_cast<std::size_t>(channels);
    for (std::size_t i = 0; i * stride_from < from.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            to[i * stride_to + c] = from[i * stride_from];
        if (channels == 4) to[i * stride_to + 3] = from[i * stride_from + 1];
    }
    return rgb;
}

/// Grey is looked up as RGB, as images mean it, not as red.
void set_swizzle(const Api& api, int channels) {
    if (channels > 2) return;
    const GLint alpha = channels == 2 ? GL_GREEN : GL_ONE;
    const std::array<GLint, 4> swizzle{GL_RED, GL_RED, GL_RED, alpha};
    api->TexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, swizzle.data());
}

/// The texture that is bound to a target, on the active unit.
GLenum binding_target(GLenum target) {
    return target == GL_TEXTURE_2D ? GL_TEXTURE_2D : GL_TEXTURE_CUBE_MAP;
}

/// What is asked for, as far as it goes; with nearest texels there is nothing to average.
float usable_anisotropy(const Api& api, const Sampling& sampling) {
    const bool is_linear =
        sampling.magnify == GL_LINEAR && sampling.minify == GL_LINEAR_MIPMAP_LINEAR;
    return is_linear ? std::min(sampling.anisotropy, api.limits().anisotropy) : 1.0F;
}

void check_size(const Api& api, const Image& image, std::string_view name) {
    if (image.empty()) throw InvalidInput(fmt::format("texture '{}' has no texels", name));
    const int limit = api.limits().texture_size;
    if (image.width > limit || image.height > limit) {
        throw GpuError(
            fmt::format("texture '{}' has {} x {} texels, but {} holds at most {} along a side",
                        name, image.width, image.height, api.renderer(), limit));
    }
}

}  // namespace

TexelFormat texel_format(const Image& image, FloatStorage storage) {
    TexelFormat result;
    result.format = for_channels(memory_formats, image.channels);
    result.type = memory_type(image.bits());
    if (image.bits() == 8 && image.color_space == ColorSpace::srgb) {
        assert(image.channels >= 3);  // converted_for_upload() has seen to it.
        result.internal = image.channels == 3 ? GL_SRGB8 : GL_SRGB8_ALPHA8;
    } else if (image.bits() == 8) {
        result.internal = for_channels({GL_R8, GL_RG8, GL_RGB8, GL_RGBA8}, image.channels);
    } else if (image.bits() == 16) {
        result.internal = for_channels({GL_R16, GL_RG16, GL_RGB16, GL_RGBA16}, image.channels);
    } else if (storage == FloatStorage::full) {
        result.internal = for_channels({GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F}, image.channels);
    } else {
        result.internal = for_channels({GL_R16F, GL_RG16F, GL_RGB16F, GL_RGBA16F}, image.channels);
    }
    return result;
}

std::optional<Image> converted_for_upload(const Image& image) {
    if (image.color_space != ColorSpace::srgb) return std::nullopt;
    if (image.bits() != 8) return to_linear(image);
    if (image.channels < 3) return spread_grey(image);
    return std::nullopt;
}

void upload_level(const Api& api, GLenum target, GLint level, const TexelFormat& format,
                  const Image& image) {
    const void* samples = std::visit(
        [](const auto& values) { return static_cast<const void*>(values.data()); }, image.samples);
    api->TexImage2D(target, level, static_cast<GLint>(format.internal), image.width, image.height,
                    0, format.format, format.type, samples);
}

void upload_levels(const Api& api, GLenum target, const TexelFormat& format, const Image& image) {
    upload_level(api, target, 0, format, image);
    GLint level = 0;
    for (const Image& smaller : mip_levels(image))
        upload_level(api, target, ++level, format, smaller);
}

void set_sampling(const Api& api, GLenum target, const Sampling& sampling) {
    api->TexParameteri(target, GL_TEXTURE_WRAP_S, static_cast<GLint>(sampling.wrap_s));
    api->TexParameteri(target, GL_TEXTURE_WRAP_T, static_cast<GLint>(sampling.wrap_t));
    api->TexParameteri(target, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(sampling.minify));
    api->TexParameteri(target, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(sampling.magnify));
    if (api.limits().anisotropy > 1.0F) {
        api->TexParameterf(target, GL_TEXTURE_MAX_ANISOTROPY, usable_anisotropy(api, sampling));
    }
}

Sampler make_sampler(const Api& api, const Sampling& sampling) {
    Sampler sampler(api);
    const auto set = [&](GLenum parameter, GLenum value) {
        api->SamplerParameteri(sampler.name(), parameter, static_cast<GLint>(value));
    };
    set(GL_TEXTURE_WRAP_S, sampling.wrap_s);
    set(GL_TEXTURE_WRAP_T, sampling.wrap_t);
    set(GL_TEXTURE_MIN_FILTER, sampling.minify);
    set(GL_TEXTURE_MAG_FILTER, sampling.magnify);
    if (api.limits().anisotropy > 1.0F) {
        api->SamplerParameterf(sampler.name(), GL_TEXTURE_MAX_ANISOTROPY,
                               usable_anisotropy(api, sampling));
    }
    return sampler;
}

Texture make_texture(const Api& api, const Image& image, std::string_view name, bool mipmaps,
                     FloatStorage storage) {
    check_size(api, image, name);
    const std::optional<Image> converted = converted_for_upload(image);
    const Image& uploaded = converted ? *converted : image;
    Texture texture(api);
    api->BindTexture(GL_TEXTURE_2D, texture.name());
    // Before any level: whether there will be more of them decides how much memory Mesa takes.
    Sampling sampling;
    if (!mipmaps) {
        sampling.minify = GL_LINEAR;
        // Complete with any sampler object.
        api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    }
    set_sampling(api, GL_TEXTURE_2D, sampling);
    set_swizzle(api, uploaded.channels);
    const TexelFormat format = texel_format(uploaded, storage);
    if (mipmaps) {
        upload_levels(api, GL_TEXTURE_2D, format, uploaded);
    } else {
        upload_level(api, GL_TEXTURE_2D, 0, format, uploaded);
    }
    api->BindTexture(GL_TEXTURE_2D, 0);
    api.check(fmt::format("uploading texture '{}', {} x {}", name, image.width, image.height));
    return texture;
}

Texture make_buffer_texture(const Api& api, const Buffer& buffer, GLenum format, std::size_t texels,
                            std::string_view name) {
    const auto limit = static_cast<std::size_t>(api.limits().buffer_texels);
    if (texels > limit) {
        throw GpuError(fmt::format("buffer texture '{}' has {} texels, but {} holds at most {}",
                                   name, texels, api.renderer(), limit));
    }
    Texture texture(api);
    api->BindTexture(GL_TEXTURE_BUFFER, texture.name());
    api->TexBuffer(GL_TEXTURE_BUFFER, format, buffer.name());
    api->BindTexture(GL_TEXTURE_BUFFER, 0);
    api.check(fmt::format("making buffer texture '{}'", name));
    return texture;
}

Image read_texture(const Api& api, const Texture& texture, GLenum target, int level, int channels,
                   int bits, ColorSpace color_space) {
    const GLenum bound = binding_target(target);
    api->BindTexture(bound, texture.name());
    GLint width = 0;
    GLint height = 0;
    api->GetTexLevelParameteriv(target, level, GL_TEXTURE_WIDTH, &width);
    api->GetTexLevelParameteriv(target, level, GL_TEXTURE_HEIGHT, &height);
    Image image = make_image(width, height, channels, bits, color_space);
    void* samples =
        std::visit([](auto& values) { return static_cast<void*>(values.data()); }, image.samples);
    api->GetTexImage(target, level, for_channels(memory_formats, channels), memory_type(bits),
                     samples);
    api->BindTexture(bound, 0);
    api.check("reading a texture back");
    return image;
}

}  // namespace relief::gl
