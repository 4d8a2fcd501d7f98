// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where pictures are drawn: colour and depth of a given size, never the window's or the platform's
/// own surface. Tests: tests/shade/gl/framebuffer_test.cpp.
#pragma once

#include "gl/handle.h"
#include "relief/mesh/image.h"

namespace relief::gl {

enum class ColorFormat {
    rgba8,    ///< 0 to 1; read back as 8-bit samples.
    rgba16f,  ///< Read back as float.
    rgba32f,
};

/// A colour and a depth buffer (24 bit) with 1 or 4 samples a pixel.
class RenderTarget {
  public:
    /// \throws InvalidInput if a size is not positive or samples is not 1 or 4
    /// \throws GpuError if it is larger than the context's limits, or memory runs out
    RenderTarget(const Api& api, int width, int height, ColorFormat format, int samples);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

    /// Draws go here from now on; the viewport is all of it.
    void bind() const;

    /// The colour as drawn, row 0 at the bottom of the picture: with 1 sample a GL_TEXTURE_2D of
    /// one level, linear, clamped; with 4 a GL_TEXTURE_2D_MULTISAMPLE.
    [[nodiscard]] const Texture& color() const { return color_; }

    /// Waits for the drawing to finish and reads the colour back, samples averaged: four channels,
    /// row 0 on top. \param color_space  what the shader wrote; it is only noted, nothing is
    /// converted
    [[nodiscard]] Image read(ColorSpace color_space) const;

    /// Copies the colour of another of the same size, one sample a pixel both.
    void copy(const RenderTarget& other) const;

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

}  // namespace relief::gl
