// SPDX-License-Identifier: Apache-2.0
/// \file
/// From drawn samples to the finished picture: how they are stored, averaged and coded.
/// Tests: tests/shade/render/renderer_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "relief/shade/renderer.h"

namespace relief {

/// With one sample a pixel the shaders write the picture's own codes, and it is read back as it is.
/// With four they write linear light, no more than the picture can show, which is averaged and then
/// coded by a last pass: averaging codes would darken edges.
class Picture {
  public:
    /// \throws InvalidInput, GpuError as RenderTarget does
    Picture(const gl::Api& api, const FrameSettings& settings);

    /// What the shaders that draw into it must write.
    static OutputCoding drawn_coding(const FrameSettings& settings);

    /// Makes it the target of draws, filled with the background (linear, alpha not multiplied in).
    void begin(const glm::vec4& background) const;

    /// Averages and codes the samples, and waits until all is drawn.
    void finish() const;

    [[nodiscard]] Image read() const;

    [[nodiscard]] float aspect() const {
        return static_cast<float>(samples_.width()) / static_cast<float>(samples_.height());
    }

  private:
    [[nodiscard]] bool averages() const { return coded_.has_value(); }

    const gl::Api* api_;
    OutputCoding drawn_;
    OutputCoding output_;
    gl::RenderTarget samples_;
    std::optional<gl::RenderTarget> coded_;  ///< Only with four samples.
    std::optional<gl::LinkedProgram> coding_;
    gl::VertexArray nothing_;  ///< Core OpenGL draws only with a vertex array.
};

}  // namespace relief
