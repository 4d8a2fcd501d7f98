// SPDX-License-Identifier: Apache-2.0
/// \file
/// From drawn samples to the finished picture: how they are stored, tone-mapped, averaged and
/// coded. Tests: tests/shade/render/renderer_test.cpp, picture_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "gl/resources.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "render/program_cache.h"

namespace relief {

/// Render targets that pictures take and return, since memory for millions of samples is slow to
/// allocate.
class TargetPool {
  public:
    explicit TargetPool(const gl::Api& api) : api_(&api) {}

    /// A target without another owner; its content is undefined. \throws as RenderTarget does
    std::shared_ptr<const gl::RenderTarget> take(int width, int height, gl::ColorFormat format,
                                                 int samples);

    void drop_unused();
    [[nodiscard]] std::size_t size() const { return targets_.size(); }

  private:
    struct Entry {
        int width, height;
        gl::ColorFormat format;
        int samples;
        std::shared_ptr<const gl::RenderTarget> target;
    };

    const gl::Api* api_;
    std::vector<Entry> targets_;
};

/// Without a finishing pass (one sample a pixel, nothing blended) the shaders write the picture's
/// own codes, and it is read back as it is. With one they write linear radiance with alpha
/// multiplied in; the pass exposes and tone-maps each sample, lays it over the background, averages
/// in linear light and codes. Averaging codes would darken edges, and averaging radiance before the
/// tone curve would leave edges against bright light jagged.
class Picture {
  public:
    /// \param finishes  the plan's finishing_pass
    /// \throws InvalidInput, GpuError as RenderTarget does; InvalidInput if samples are to be
    ///         averaged without a finishing pass
    Picture(const gl::Api& api, TargetPool& targets, ProgramCache& programs, const Scene& scene,
            const FrameSettings& settings, bool finishes);

    /// Makes it the target of draws, cleared.
    void begin() const;

    /// Finishes the samples, and waits until all is drawn.
    void finish() const;

    /// Makes the finished picture the target, to be drawn over.
    void bind_finished() const { target().bind(); }

    [[nodiscard]] Image read() const;

    /// Where the finished picture is: one level, row 0 at the bottom.
    [[nodiscard]] const gl::RenderTarget& target() const {
        return finished_ ? *finished_ : *samples_;
    }

    [[nodiscard]] float aspect() const {
        return static_cast<float>(samples_->width()) / static_cast<float>(samples_->height());
    }

  private:
    const gl::Api* api_;
    int sample_count_;
    OutputCoding output_;
    glm::vec4 background_;  ///< As it is to be seen, linear, alpha multiplied in.
    float exposure_;
    std::shared_ptr<const gl::RenderTarget> samples_;
    std::shared_ptr<const gl::RenderTarget> finished_;
    std::shared_ptr<const gl::LinkedProgram> finishing_;
    gl::VertexArray nothing_;  ///< Core OpenGL draws only with a vertex array.
};

/// What surfaces write: the picture's coding, or linear light for the finishing pass.
OutputCoding drawn_coding(const FrameSettings& settings, bool finishes);

}  // namespace relief
