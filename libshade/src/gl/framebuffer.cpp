// SPDX-License-Identifier: Apache-2.0
// Colour and depth to draw into, and reading back. See framebuffer.h.
// Tests: tests/shade/gl/framebuffer_test.cpp.
#include "gl/framebuffer.h"

#include <fmt/format.h>

#include <algorithm>

#include "relief/mesh/error.h"
#include "relief/shade/error.h"

namespace relief::gl {

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
        throw InvalidInput(fmt::format("{} samples a pixel are asked for; 1 or 4 can be", samples));
    }
    const Limits& limits = api.limits();
    const int side = std::min(limits.texture_size, limits.renderbuffer_size);
    const int most_wide = std::min(side, limits.viewport_width);
    const int most_high = std::min(side, limits.viewport_height);
    if (width > most_wide || height > most_high) {
        throw GpuError(fmt::format("a picture of {} x {} pixels: {} draws at most {} x {}", width,
                                   height, api.renderer(), most_wide, most_high));
    }
    if (samples > std::max(limits.samples, 1)) {
        throw GpuError(fmt::format("{} samples a pixel: {} takes at most {}", samples,
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

/// \param samples  1 makes a plain one: 0 in OpenGL's counting
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

void flip_rows(Image& image) {
    std::visit(
        [&](auto& samples) {
            const auto row =
                static_cast<std::ptrdiff_t>(image.width) * static_cast<std::ptrdiff_t>(4);
            for (std::ptrdiff_t y = 0; y < image.height / 2; ++y) {
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
    depth_ = renderbuffer(api, width, height, GL_DEPTH_COMPONENT24, samples);
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
    void* samples =
        std::visit([](auto& values) { return static_cast<void*>(values.data()); }, image.samples);
    api->BindFramebuffer(GL_READ_FRAMEBUFFER, draw_.name());
    api->ReadPixels(0, 0, width_, height_, GL_RGBA, is_byte ? GL_UNSIGNED_BYTE : GL_FLOAT, samples);
    api->BindFramebuffer(GL_FRAMEBUFFER, draw_.name());
    api.check("reading a picture back");
    flip_rows(image);
    return image;
}

}  // namespace relief::gl
