// SPDX-License-Identifier: Apache-2.0
/// \file
/// Buffers, textures and render targets. Row 0 of an image is at t = 0, as glTF's texture
/// coordinates require: uploads flip nothing. Pictures are drawn into render targets, never into
/// the surface of a window or of the platform.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gl/api.h"
#include "relief/mesh/image.h"

namespace relief::shade::gl {

// Buffers

/// Returns a buffer holding a copy of these bytes; it can be bound to any target.
///
/// \param usage  GL_STATIC_DRAW, or GL_DYNAMIC_DRAW for data that changes every frame
/// \throws GpuError if memory runs out
///
/// Leaves vertex array and element bindings alone: it works through GL_COPY_WRITE_BUFFER.
Buffer make_buffer(const Api& api, std::span<const std::byte> bytes, std::string_view name,
                   GLenum usage = GL_STATIC_DRAW);

template <typename T>
Buffer make_buffer(const Api& api, std::span<const T> elements, std::string_view name,
                   GLenum usage = GL_STATIC_DRAW) {
    return make_buffer(api, std::as_bytes(elements), name, usage);
}

template <typename T>
Buffer make_buffer(const Api& api, const std::vector<T>& elements, std::string_view name,
                   GLenum usage = GL_STATIC_DRAW) {
    return make_buffer(api, std::as_bytes(std::span(elements)), name, usage);
}

/// Replaces the whole content, of any previous size. \throws GpuError if memory runs out
void replace_content(const Api& api, const Buffer& buffer, std::span<const std::byte> bytes,
                     std::string_view name, GLenum usage = GL_DYNAMIC_DRAW);

/// Returns the content of the buffer.
std::vector<std::byte> read_buffer(const Api& api, const Buffer& buffer);

// Textures

/// The sampling of texels.
struct Sampling {
    GLenum wrap_s = GL_REPEAT;
    GLenum wrap_t = GL_REPEAT;
    GLenum minify = GL_LINEAR_MIPMAP_LINEAR;
    GLenum magnify = GL_LINEAR;
    /// The maximum, limited by the context; 1 unless both filters are linear.
    float anisotropy = 16.0F;
};

/// The storage of float samples.
enum class FloatStorage { full, half };

/// Returns an image as a complete 2D texture.
///
/// \param name  for messages: the file, or "material 'body': normal map"
/// \param mipmaps  creates all levels, by mip_levels()
/// \param storage  half needs half the memory; finite values beyond 65504 become infinite
/// \return 8-bit sRGB colors stored as codes and decoded by the GPU at lookup; 8- and 16-bit
///         data unchanged; 16-bit and float sRGB, which no format holds, decoded to linear float.
///         Gray is looked up as (g, g, g, 1), gray with alpha as (g, g, g, a), RGB as (r, g, b, 1).
/// \throws GpuError if it is larger than the context's limit, or memory runs out
/// \throws InvalidInput if the image is empty
///
/// The texture's own sampling is Sampling's default, without mipmaps if it has none; a Sampler
/// object overrides it. Nothing is left bound to the active texture unit.
Texture make_texture(const Api& api, const Image& image, std::string_view name, bool mipmaps = true,
                     FloatStorage storage = FloatStorage::full);

/// Uploads an image of data with its own levels, from the largest on; each is half as large as the
/// one before, rounded down. Otherwise as above.
Texture make_texture(const Api& api, const std::vector<Image>& levels, std::string_view name);

/// Returns a sampler object: one image may be used with several.
Sampler make_sampler(const Api& api, const Sampling& sampling);

/// Sets the sampling of the texture bound to `target`.
void set_sampling(const Api& api, GLenum target, const Sampling& sampling);

/// Returns a texture that accesses a buffer as an array of texels (samplerBuffer).
///
/// \param format  GL_RGBA32F and the like
/// \param texels  the buffer's size in texels of this format
/// \throws GpuError if it has more texels than the context allows
Texture make_buffer_texture(const Api& api, const Buffer& buffer, GLenum format, std::size_t texels,
                            std::string_view name);

/// The format of samples in memory and on the GPU.
struct TexelFormat {
    GLenum internal = 0;  ///< GL_SRGB8, GL_RGBA16F, ...
    GLenum format = 0;    ///< The layout in memory: GL_RED, GL_RG, GL_RGB or GL_RGBA.
    GLenum type = 0;      ///< GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT or GL_FLOAT.
};

/// Returns the format that stores this image without loss (except for FloatStorage::half), if one
/// exists.
TexelFormat texel_format(const Image& image, FloatStorage storage);

/// Returns the image in a form that has a texel format: sRGB gray as RGB, sRGB of 16 and 32 bits as
/// linear float. Empty if the image has a texel format already.
std::optional<Image> converted_for_upload(const Image& image);

/// Uploads the samples of an image as a level of the texture bound to `target`, which may be the
/// face of a cube map.
void upload_level(const Api& api, GLenum target, GLint level, const TexelFormat& format,
                  const Image& image);

/// Uploads an image and all its mip_levels(). glGenerateMipmap is not used: on Mesa's rasterizer it
/// compiles shaders in every process, which costs 70 ms per texel format.
void upload_levels(const Api& api, GLenum target, const TexelFormat& format, const Image& image);

/// Reads a level of a texture back, coded as it is stored.
///
/// \param target  GL_TEXTURE_2D, or GL_TEXTURE_CUBE_MAP_POSITIVE_X and the five after it
/// \param bits  the bits of the result's samples: 8, 16 or 32
Image read_texture(const Api& api, const Texture& texture, GLenum target, int level, int channels,
                   int bits, ColorSpace color_space);

// Render targets

enum class ColorFormat {
    rgba8,    ///< 0 to 1; read back as 8-bit samples.
    rgba16f,  ///< Read back as float.
    rgba32f,
};

/// A color and a depth buffer (24 bit) with 1 or 4 samples a pixel.
class RenderTarget {
  public:
    /// \throws InvalidInput if a size is not positive or samples is not 1 or 4
    /// \throws GpuError if it is larger than the context's limits, or memory runs out
    RenderTarget(const Api& api, int width, int height, ColorFormat format, int samples);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

    /// Makes this the target of draw calls, with a viewport of its whole size.
    void bind() const;

    /// Returns the color as drawn, row 0 at the bottom of the picture: with 1 sample a
    /// GL_TEXTURE_2D of one level, linear, clamped; with 4 a GL_TEXTURE_2D_MULTISAMPLE.
    [[nodiscard]] const Texture& color() const { return color_; }

    /// Waits for the drawing to finish and reads the color back, samples averaged: four channels,
    /// row 0 on top.
    /// \param color_space  the color space that the shader wrote; nothing is converted
    [[nodiscard]] Image read(ColorSpace color_space) const;

    /// Copies the color of another target of the same size; both have one sample a pixel.
    void copy(const RenderTarget& other) const;

    /// Copies the color into a framebuffer of the same size, which stays bound; samples are
    /// averaged.
    void copy_to(const Framebuffer& other) const;

    [[nodiscard]] ColorFormat format() const { return format_; }

  private:
    const Api* api_;
    int width_;
    int height_;
    ColorFormat format_;
    int samples_;
    Texture color_;
    Renderbuffer depth_;
    Framebuffer draw_;
};

/// Square depth buffers of 16 bits in one GL_TEXTURE_2D_ARRAY, for lookups that compare: bilinear,
/// and as if there were nothing beyond the edge.
class DepthLayers {
  public:
    /// \throws GpuError if they are larger than the context's limits, or memory runs out
    DepthLayers(const Api& api, int width, int layers);

    /// Makes a cleared layer the target of draw calls, with a viewport of its whole size.
    void begin(int layer) const;

    [[nodiscard]] const Texture& texture() const { return texture_; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int layers() const { return layers_; }

  private:
    const Api* api_;
    int width_;
    int layers_;
    Texture texture_;
    Framebuffer target_;
};

/// A copy of a target's color with all mip levels, for lookups by texelFetch.
class MippedCopy {
  public:
    /// \param like  its size and format are those of the copy \throws GpuError
    MippedCopy(const Api& api, const RenderTarget& like);

    /// Copies the color, samples averaged. A texel of each further level is the bilinear mean at
    /// its center in the level before.
    void copy(const RenderTarget& drawn) const;

    [[nodiscard]] const Texture& color() const { return color_; }

  private:
    const Api* api_;
    int width_;
    int height_;
    Texture color_;
    std::vector<Framebuffer> levels_;
};

}  // namespace relief::shade::gl
