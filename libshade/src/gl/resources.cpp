// SPDX-License-Identifier: Apache-2.0
// Buffers, textures and render targets: upload, mipmaps, sampling and reading back. The meaning of
// formats is in OpenGL 3.3 core, tables 3.12 and 3.13.
#include "gl/resources.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "gl/cube_map.h"
#include "progress_stage.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/renderer.h"

namespace relief::shade::gl {
using namespace relief::detail;

// Buffers

Buffer make_buffer(const Api& api, std::span<const std::byte> bytes, std::string_view name,
                   GLenum usage) {
    Buffer buffer(api);
    replace_content(api, buffer, bytes, name, usage);
    return buffer;
}

void replace_content(const Api& api, const Buffer& buffer, std::span<const std::byte> bytes,
                     std::string_view name, GLenum usage) {
    api->BindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
    api->BufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes.size()),
                    bytes.empty() ? nullptr : bytes.data(), usage);
    api->BindBuffer(GL_COPY_WRITE_BUFFER, 0);
    api.check(fmt::format("uploading {} bytes of {}", bytes.size(), name));
}

std::vector<std::byte> read_buffer(const Api& api, const Buffer& buffer) {
    api->BindBuffer(GL_COPY_READ_BUFFER, buffer.name());
    GLint64 size = 0;
    api->GetBufferParameteri64v(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &size);
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    if (size > 0) {
        api->GetBufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(size), bytes.data());
    }
    api->BindBuffer(GL_COPY_READ_BUFFER, 0);
    api.check("reading a buffer back");
    return bytes;
}

// Textures

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

/// Returns gray and gray with alpha as RGB and RGB with alpha.
Image spread_gray(const Image& gray) {
    const int channels = gray.channels + 2;
    Image rgb = make_image(gray.width, gray.height, channels, 8, gray.color_space);
    const auto from = gray.as<std::uint8_t>();
    const auto to = rgb.as<std::uint8_t>();
    const auto stride_from = static_cast<std::size_t>(gray.channels);
    const auto stride_to = static_cast<std::size_t>(channels);
    for (std::size_t i = 0; i * stride_from < from.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            to[i * stride_to + c] = from[i * stride_from];
        if (channels == 4) to[i * stride_to + 3] = from[i * stride_from + 1];
    }
    return rgb;
}

/// Gray is looked up as RGB, as images mean it, not as red.
void set_swizzle(const Api& api, int channels) {
    if (channels > 2) return;
    const GLint alpha = channels == 2 ? GL_GREEN : GL_ONE;
    const std::array<GLint, 4> swizzle{GL_RED, GL_RED, GL_RED, alpha};
    api->TexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, swizzle.data());
}

/// Returns the texture that is bound to a target, on the active unit.
GLenum binding_target(GLenum target) {
    return target == GL_TEXTURE_2D ? GL_TEXTURE_2D : GL_TEXTURE_CUBE_MAP;
}

/// Returns the requested anisotropy within the limit of the context; 1 for nearest filtering.
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
            fmt::format("texture '{}' has {} x {} texels, but {} allows at most {} along a side",
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
    if (image.channels < 3) return spread_gray(image);
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

Texture make_texture(const Api& api, const std::vector<Image>& levels, std::string_view name) {
    const Image& largest = levels.at(0);
    check_size(api, largest, name);
    Texture texture(api);
    api->BindTexture(GL_TEXTURE_2D, texture.name());
    set_sampling(api, GL_TEXTURE_2D, Sampling{});
    set_swizzle(api, largest.channels);
    const TexelFormat format = texel_format(largest, FloatStorage::full);
    GLint level = 0;
    for (const Image& image : levels)
        upload_level(api, GL_TEXTURE_2D, level++, format, image);
    api->BindTexture(GL_TEXTURE_2D, 0);
    api.check(fmt::format("uploading texture '{}', {} x {}", name, largest.width, largest.height));
    return texture;
}

Texture make_buffer_texture(const Api& api, const Buffer& buffer, GLenum format, std::size_t texels,
                            std::string_view name) {
    const auto limit = static_cast<std::size_t>(api.limits().buffer_texels);
    if (texels > limit) {
        throw GpuError(fmt::format("buffer texture '{}' has {} texels, but {} allows at most {}",
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

// Render targets

namespace {

GLenum internal_format(ColorFormat format) {
    switch (format) {
        case ColorFormat::rgba8:
            return GL_RGBA8;
        case ColorFormat::rgba16f:
            return GL_RGBA16F;
        default:
            return GL_RGBA32F;
    }
}

void check_size(const Api& api, int width, int height, int samples) {
    if (width <= 0 || height <= 0) {
        throw InvalidInput(
            fmt::format("a picture of {} x {} pixels cannot be drawn", width, height));
    }
    if (samples != 1 && samples != 4) {
        throw InvalidInput(
            fmt::format("{} samples per pixel were requested, but must be 1 or 4", samples));
    }
    const Limits& limits = api.limits();
    const int side = std::min(limits.texture_size, limits.renderbuffer_size);
    const int max_width = std::min(side, limits.viewport_width);
    const int max_height = std::min(side, limits.viewport_height);
    if (width > max_width || height > max_height) {
        throw GpuError(fmt::format("a picture of {} x {} pixels: {} draws at most {} x {}", width,
                                   height, api.renderer(), max_width, max_height));
    }
    if (samples > std::max(limits.samples, 1)) {
        throw GpuError(fmt::format("{} samples per pixel: {} allows at most {}", samples,
                                   api.renderer(), limits.samples));
    }
}

Texture color_texture(const Api& api, int width, int height, ColorFormat format) {
    Texture texture(api);
    api->BindTexture(GL_TEXTURE_2D, texture.name());
    api->TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal_format(format)), width, height, 0,
                    GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    api->BindTexture(GL_TEXTURE_2D, 0);
    return texture;
}

Texture multisample_texture(const Api& api, int width, int height, ColorFormat format,
                            int samples) {
    Texture texture(api);
    api->BindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture.name());
    api->TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, internal_format(format), width,
                               height, GL_TRUE);
    api->BindTexture(GL_TEXTURE_2D_MULTISAMPLE, 0);
    return texture;
}

/// \param samples  1 creates a buffer without multisampling, which is 0 in OpenGL
Renderbuffer renderbuffer(const Api& api, int width, int height, GLenum format, int samples) {
    Renderbuffer buffer(api);
    api->BindRenderbuffer(GL_RENDERBUFFER, buffer.name());
    api->RenderbufferStorageMultisample(GL_RENDERBUFFER, samples == 1 ? 0 : samples, format, width,
                                        height);
    api->BindRenderbuffer(GL_RENDERBUFFER, 0);
    return buffer;
}

void check_complete(const Api& api, int width, int height) {
    const std::string doing = fmt::format("making a picture of {} x {} pixels", width, height);
    api.check(doing);
    const GLenum status = api->CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw GpuError(fmt::format("{}: framebuffer status 0x{:x}", doing, status));
    }
}

/// The rows of a picture that are read back between two cancellation points.
constexpr int rows_per_step = 256;

void flip_rows(Image& image) {
    std::visit(
        [&](auto& samples) {
            const auto row =
                static_cast<std::ptrdiff_t>(image.width) * static_cast<std::ptrdiff_t>(4);
            for (std::ptrdiff_t y = 0; y < image.height / 2; ++y) {
                if (y % rows_per_step == 0) check_cancelled();
                const auto top = samples.begin() + y * row;
                const auto bottom = samples.begin() + (image.height - 1 - y) * row;
                std::swap_ranges(top, top + row, bottom);
            }
        },
        image.samples);
}

}  // namespace

RenderTarget::RenderTarget(const Api& api, int width, int height, ColorFormat format, int samples)
    : api_(&api), width_(width), height_(height), format_(format), samples_(samples) {
    check_size(api, width, height, samples);
    color_ = samples > 1 ? multisample_texture(api, width, height, format, samples)
                         : color_texture(api, width, height, format);
    check_cancelled();  // Software OpenGL clears all new memory, which takes as long as drawing.
    depth_ = renderbuffer(api, width, height, GL_DEPTH_COMPONENT24, samples);
    check_cancelled();
    draw_ = Framebuffer(api);
    api->BindFramebuffer(GL_FRAMEBUFFER, draw_.name());
    api->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                              samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D,
                              color_.name(), 0);
    api->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                 depth_.name());
    check_complete(api, width, height);
    bind();
}

void RenderTarget::bind() const {
    (*api_)->BindFramebuffer(GL_FRAMEBUFFER, draw_.name());
    (*api_)->Viewport(0, 0, width_, height_);
}

void RenderTarget::copy(const RenderTarget& other) const {
    const Api& api = *api_;
    api->BindFramebuffer(GL_READ_FRAMEBUFFER, other.draw_.name());
    api->BindFramebuffer(GL_DRAW_FRAMEBUFFER, draw_.name());
    api->BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
}

void RenderTarget::copy_to(const Framebuffer& other) const {
    const Api& api = *api_;
    api->BindFramebuffer(GL_READ_FRAMEBUFFER, draw_.name());
    api->BindFramebuffer(GL_DRAW_FRAMEBUFFER, other.name());
    api->BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
}

Image RenderTarget::read(ColorSpace color_space) const {
    const Api& api = *api_;
    if (samples_ > 1) {
        const RenderTarget averaged(api, width_, height_, format_, 1);
        api->BindFramebuffer(GL_READ_FRAMEBUFFER, draw_.name());
        api->BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                             GL_NEAREST);
        Image image = averaged.read(color_space);
        bind();
        return image;
    }
    const bool is_byte = format_ == ColorFormat::rgba8;
    Image image = make_image(width_, height_, 4, is_byte ? 8 : 32, color_space);
    auto* const samples = std::visit(
        [](auto& values) { return reinterpret_cast<std::byte*>(values.data()); }, image.samples);
    api->BindFramebuffer(GL_READ_FRAMEBUFFER, draw_.name());
    const std::size_t row_bytes =
        static_cast<std::size_t>(width_) * (is_byte ? 4 : 4 * sizeof(float));
    for (int first = 0; first < height_; first += rows_per_step) {
        check_cancelled();
        api->ReadPixels(0, first, width_, std::min(rows_per_step, height_ - first), GL_RGBA,
                        is_byte ? GL_UNSIGNED_BYTE : GL_FLOAT,
                        samples + static_cast<std::size_t>(first) * row_bytes);
    }
    api->BindFramebuffer(GL_FRAMEBUFFER, draw_.name());
    api.check("reading a picture back");
    flip_rows(image);
    return image;
}

DepthLayers::DepthLayers(const Api& api, int width, int layers)
    : api_(&api), width_(width), layers_(layers), texture_(api), target_(api) {
    constexpr GLenum target = GL_TEXTURE_2D_ARRAY;
    api->BindTexture(target, texture_.name());
    api->TexImage3D(target, 0, GL_DEPTH_COMPONENT16, width, width, layers, 0, GL_DEPTH_COMPONENT,
                    GL_UNSIGNED_SHORT, nullptr);
    api->TexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
    api->TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    api->TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    api->TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    api->TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    const std::array<GLfloat, 4> border{1.0F, 1.0F, 1.0F, 1.0F};
    api->TexParameterfv(target, GL_TEXTURE_BORDER_COLOR, border.data());
    api->TexParameteri(target, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    api->TexParameteri(target, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    api->BindTexture(target, 0);
    api->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
    api->DrawBuffer(GL_NONE);
    api->ReadBuffer(GL_NONE);
    api->FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, texture_.name(), 0, 0);
    check_complete(api, width, width);
}

void DepthLayers::begin(int layer) const {
    const Api& api = *api_;
    api->BindFramebuffer(GL_FRAMEBUFFER, target_.name());
    api->FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, texture_.name(), 0, layer);
    api->Viewport(0, 0, width_, width_);
    api->DepthMask(GL_TRUE);
    api->ClearDepth(1.0);
    api->Clear(GL_DEPTH_BUFFER_BIT);
}

MippedCopy::MippedCopy(const Api& api, const RenderTarget& like)
    : api_(&api), width_(like.width()), height_(like.height()), color_(api) {
    api->BindTexture(GL_TEXTURE_2D, color_.name());
    const int last = level_count(std::max(width_, height_)) - 1;
    for (int level = 0; level <= last; ++level) {
        api->TexImage2D(GL_TEXTURE_2D, level, static_cast<GLint>(internal_format(like.format())),
                        std::max(width_ >> level, 1), std::max(height_ >> level, 1), 0, GL_RGBA,
                        GL_UNSIGNED_BYTE, nullptr);
    }
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, last);
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    api->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    api->BindTexture(GL_TEXTURE_2D, 0);
    for (int level = 0; level <= last; ++level) {
        levels_.emplace_back(api);
        api->BindFramebuffer(GL_FRAMEBUFFER, levels_.back().name());
        api->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                                  color_.name(), level);
        check_complete(api, width_, height_);
    }
}

void MippedCopy::copy(const RenderTarget& drawn) const {
    const Api& api = *api_;
    drawn.copy_to(levels_.front());
    for (std::size_t level = 1; level < levels_.size(); ++level) {
        const auto width = [&](std::size_t l) { return std::max(width_ >> l, 1); };
        const auto height = [&](std::size_t l) { return std::max(height_ >> l, 1); };
        api->BindFramebuffer(GL_READ_FRAMEBUFFER, levels_[level - 1].name());
        api->BindFramebuffer(GL_DRAW_FRAMEBUFFER, levels_[level].name());
        api->BlitFramebuffer(0, 0, width(level - 1), height(level - 1), 0, 0, width(level),
                             height(level), GL_COLOR_BUFFER_BIT, GL_LINEAR);
    }
}

}  // namespace relief::shade::gl
