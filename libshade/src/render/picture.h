// SPDX-License-Identifier: Apache-2.0
/// \file
/// The picture of a renderer: its render targets, the finishing pass, and the copy of the opaque
/// surfaces for transmission. Tests: tests/shade/render/renderer_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gl/program.h"
#include "gl/resources.h"
#include "relief/mesh/image.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "render/program_cache.h"

namespace relief::shade::detail {

/// A pool of render targets, because allocating memory for millions of samples is slow.
class TargetPool {
  public:
    explicit TargetPool(const gl::Api& api) : api_(&api) {}

    /// Returns a target that nothing else uses; its content is undefined. \throws as RenderTarget
    /// does
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

/// Returns the background as displayed, linear.
glm::vec4 shown_background(const glm::vec4& background, OutputCoding output);

/// Returns the color to which the target of a picture without a finishing pass is cleared.
glm::vec4 clear_color(const glm::vec4& background, OutputCoding output);

/// Returns the encoding that surfaces write: that of the picture, or linear for the finishing pass.
OutputCoding drawn_coding(const FrameSettings& settings, bool finishes);

/// Without a finishing pass (one sample per pixel, no blending), shaders write the encoded picture.
/// With it, they write linear radiance with premultiplied alpha; the pass exposes and tone-maps
/// each sample, composites it over the background, averages linear values and encodes them.
/// Averaging encoded values would darken edges, and averaging before tone mapping would leave edges
/// against bright light aliased.
class Picture {
  public:
    /// \param finishes  the plan's finishing_pass
    /// \throws InvalidInput, GpuError as RenderTarget does; InvalidInput for several samples
    ///         without a finishing pass
    Picture(const gl::Api& api, TargetPool& targets, ProgramCache& programs, const Scene& scene,
            const FrameSettings& settings, bool finishes);

    /// Binds the target of draws and clears it.
    void begin() const;

    /// Copies what was drawn, with its mip levels, and binds the copy for transmissive surfaces.
    /// \throws GpuError
    void copy_behind();

    /// Runs the finishing pass and waits for its completion.
    void finish() const;

    /// Binds the finished picture as the target of overlays.
    void bind_finished() const { target().bind(); }

    [[nodiscard]] Image read() const;

    /// Returns the finished picture: one level, row 0 at the bottom.
    [[nodiscard]] const gl::RenderTarget& target() const {
        return finished_ ? *finished_ : *samples_;
    }

    [[nodiscard]] int width() const { return samples_->width(); }
    [[nodiscard]] int height() const { return samples_->height(); }
    [[nodiscard]] std::size_t sample_total() const {
        return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()) *
               static_cast<std::size_t>(sample_count_);
    }

    /// Returns the last mip level of a copy.
    [[nodiscard]] int last_level() const;

    [[nodiscard]] float aspect() const {
        return static_cast<float>(samples_->width()) / static_cast<float>(samples_->height());
    }

  private:
    const gl::Api* api_;
    int sample_count_;
    OutputCoding output_;
    glm::vec4 background_;  ///< Linear, clamped as displayed.
    float exposure_;
    std::shared_ptr<const gl::RenderTarget> samples_;
    std::shared_ptr<const gl::RenderTarget> finished_;
    std::shared_ptr<const gl::LinkedProgram> finishing_;
    std::optional<gl::MippedCopy> behind_;  ///< Made when it is needed.
    gl::VertexArray empty_vertices_;        ///< Core OpenGL draws only with a vertex array.
};

}  // namespace relief::shade::detail
