// SPDX-License-Identifier: Apache-2.0
/// \file
/// Images as textures. Row 0 of the image is at t = 0, which is where glTF's texture coordinates
/// have it: nothing is flipped.
/// Tests: tests/shade/gl/texture_test.cpp.
#pragma once

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
    float anisotropy = 16.0F;  ///< The most that is asked for; cut to what the context can.
};

/// How float samples are stored.
enum class FloatStorage { full, half };

/// An image as a complete 2D texture.
///
/// \param name  for messages: the file, or "material 'body': normal map"
/// \param mipmaps  makes all levels; colours are averaged in linear light
/// \param storage  half takes half the memory; finite values beyond 65504 become infinite
/// \return 8-bit sRGB colours stored as they are and decoded by the GPU at lookup; 8- and 16-bit
///         data unchanged; 16-bit and float sRGB, which no format holds, decoded to linear float.
///         Grey looks up as (g, g, g, 1), grey with alpha as (g, g, g, a), RGB as (r, g, b, 1).
/// \throws GpuError if it is larger than the context's limit, or memory runs out
/// \throws InvalidInput if the image is empty
///
/// The texture's own sampling is Sampling's default; a Sampler object overrides it.
Texture make_texture(const Api& api, const Image& image, std::string_view name, bool mipmaps = true,
                     FloatStorage storage = FloatStorage::full);

/// A sampler object: one image may be used with several.
Sampler make_sampler(const Api& api, const Sampling& sampling);

/// Sets the sampling of the texture bound to `target`.
void set_sampling(const Api& api, GLenum target, const Sampling& sampling);

/// A buffer seen as an array of texels (samplerBuffer).
///
/// \param format  GL_RGBA32F and the like
/// \param bytes  the buffer's size
/// \throws GpuError if it has more texels than the context allows
Texture make_buffer_texture(const Api& api, const Buffer& buffer, GLenum format, std::size_t bytes,
                            std::string_view name);

/// Reads one level of a 2D texture or of a cube face back, as it is stored: for tests.
///
/// \param target  GL_TEXTURE_2D or GL_TEXTURE_CUBE_MAP_POSITIVE_X and so on
/// \param like  channels, bits and colour space of the result
Image read_texture(const Api& api, const Texture& texture, GLenum target, int level,
                   const Image& like);

/// How an image is laid out on the GPU; shared with cube_map.h.
struct TexelFormat {
    GLenum internal = 0;  ///< GL_SRGB8, GL_RGBA16F, ...
    GLenum format = 0;    ///< GL_RED, GL_RG, GL_RGB, GL_RGBA of the samples in memory.
    GLenum type = 0;      ///< GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_FLOAT.
};

}  // namespace relief::gl
