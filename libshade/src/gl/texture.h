// SPDX-License-Identifier: Apache-2.0
/// \file
/// Images as textures. Row 0 of the image is at t = 0, which is where glTF's texture coordinates
/// have it: nothing is flipped.
/// Tests: tests/shade/gl/texture_test.cpp.
#pragma once

#include <optional>
#include <string_view>

#include "gl/handle.h"
#include "relief/mesh/image.h"

namespace relief::gl {

/// How texels are looked up.
struct Sampling {
    GLenum wrap_s = GL_REPEAT;
    GLenum wrap_t = GL_REPEAT;
    GLenum minify = GL_LINEAR_MIPMAP_LINEAR;
    GLenum magnify = GL_LINEAR;
    /// The most that is asked for; cut to what the context can, and 1 unless both filters are
    /// linear.
    float anisotropy = 16.0F;
};

/// How float samples are stored.
enum class FloatStorage { full, half };

/// An image as a complete 2D texture.
///
/// \param name  for messages: the file, or "material 'body': normal map"
/// \param mipmaps  makes all levels, by mip_levels()
/// \param storage  half takes half the memory; finite values beyond 65504 become infinite
/// \return 8-bit sRGB colours stored as they are and decoded by the GPU at lookup; 8- and 16-bit
///         data unchanged; 16-bit and float sRGB, which no format holds, decoded to linear float.
///         Grey looks up as (g, g, g, 1), grey with alpha as (g, g, g, a), RGB as (r, g, b, 1).
/// \throws GpuError if it is larger than the context's limit, or memory runs out
/// \throws InvalidInput if the image is empty
///
/// The texture's own sampling is Sampling's default, without mipmaps if it has none; a Sampler
/// object overrides it. Nothing is left bound to the active texture unit.
Texture make_texture(const Api& api, const Image& image, std::string_view name, bool mipmaps = true,
                     FloatStorage storage = FloatStorage::full);

/// A sampler object: one image may be used with several.
Sampler make_sampler(const Api& api, const Sampling& sampling);

/// Sets the sampling of the texture bound to `target`.
void set_sampling(const Api& api, GLenum target, const Sampling& sampling);

/// A buffer seen as an array of texels (samplerBuffer).
///
/// \param format  GL_RGBA32F and the like
/// \param texels  the buffer's size in texels of this format
/// \throws GpuError if it has more texels than the context allows
Texture make_buffer_texture(const Api& api, const Buffer& buffer, GLenum format, std::size_t texels,
                            std::string_view name);

/// How samples lie in memory and on the GPU; also used by cube_map.h.
struct TexelFormat {
    GLenum internal = 0;  ///< GL_SRGB8, GL_RGBA16F, ...
    GLenum format = 0;    ///< GL_RED, GL_RG, GL_RGB or GL_RGBA, of the samples in memory.
    GLenum type = 0;      ///< GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT or GL_FLOAT.
};

/// The format that holds this image without loss (but for FloatStorage::half), if there is one.
TexelFormat texel_format(const Image& image, FloatStorage storage);

/// The image in a form for which there is a texel format: sRGB grey as RGB, sRGB of 16 and 32 bits
/// as linear float. Empty where the image has one already.
std::optional<Image> converted_for_upload(const Image& image);

/// The image's samples as a level of the texture bound to `target`, which may be a cube's face.
void upload_level(const Api& api, GLenum target, GLint level, const TexelFormat& format,
                  const Image& image);

/// The image and all its mip_levels(). Not glGenerateMipmap: on Mesa's rasteriser that compiles
/// shaders in every process, for 70 ms per texel format.
void upload_levels(const Api& api, GLenum target, const TexelFormat& format, const Image& image);

/// Reads a level of a texture back, coded as it is stored.
///
/// \param target  GL_TEXTURE_2D, or GL_TEXTURE_CUBE_MAP_POSITIVE_X and the five after it
/// \param bits  8, 16 or 32: what samples are converted to
Image read_texture(const Api& api, const Texture& texture, GLenum target, int level, int channels,
                   int bits, ColorSpace color_space);

}  // namespace relief::gl
