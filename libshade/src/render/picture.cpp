// SPDX-License-Identifier: Apache-2.0
// Pictures and the pool of their targets. The finishing pass writes sRGB codes by [IEC 61966-2-1].
#include "render/picture.h"

#include <algorithm>

#include "effects/shader_source.h"
#include "gl/cube_map.h"
#include "relief/mesh/report.h"

namespace relief::shade::detail {
namespace {

gl::ColorFormat format_of(OutputCoding coding) {
    switch (coding) {
        case OutputCoding::srgb:
            return gl::ColorFormat::rgba8;
        case OutputCoding::half:
            return gl::ColorFormat::rgba16f;
        default:
            return gl::ColorFormat::rgba32f;
    }
}

}  // namespace

glm::vec4 shown_background(const glm::vec4& background, OutputCoding output) {
    if (output == OutputCoding::linear) return background;
    return {glm::min(glm::vec3(background), glm::vec3(1.0F)), background.a};
}

glm::vec4 clear_color(const glm::vec4& background, OutputCoding output) {
    glm::vec4 color = shown_background(background, output);
    if (output == OutputCoding::srgb) {
        for (int i = 0; i < 3; ++i)
            color[i] = srgb_from_linear(color[i]);
    }
    return color;
}

OutputCoding drawn_coding(const FrameSettings& settings, bool finishes) {
    if (!finishes || settings.output == OutputCoding::linear) return settings.output;
    return OutputCoding::half;
}

Picture::Picture(const gl::Api& api, TargetPool& targets, ProgramCache& programs,
                 const Scene& scene, const FrameSettings& settings, bool finishes)
    : api_(&api),
      sample_count_(settings.samples),
      output_(settings.output),
      background_(shown_background(scene.background, settings.output)),
      exposure_(scene.exposure),
      samples_(targets.take(settings.width, settings.height,
                            format_of(drawn_coding(settings, finishes)), settings.samples)),
      empty_vertices_(api) {
    if (settings.output == OutputCoding::half) {
        throw InvalidInput("pictures cannot have the coding half, which finishing passes read");
    }
    if (!finishes && settings.samples > 1) {
        throw InvalidInput("samples are to be averaged, but the plan has no finishing pass");
    }
    if (!finishes) return;
    finished_ = targets.take(settings.width, settings.height, format_of(output_), 1);
    const char* const samples =
        settings.samples > 1 ? "picture.glsl#four_samples" : "picture.glsl#one_sample";
    finishing_ = programs.get("picture", finishing_steps(output_, scene, samples));
}

void Picture::begin() const {
    samples_->bind();
    const glm::vec4 color = finishing_ ? glm::vec4(0.0F) : clear_color(background_, output_);
    const gl::Api& gl = *api_;
    gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->DepthMask(GL_TRUE);
    gl->ClearColor(color.r, color.g, color.b, color.a);
    gl->ClearDepth(1.0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Picture::copy_behind() {
    const gl::Api& gl = *api_;
    // Making the copy binds it, too: the texture of another unit must stay bound.
    gl->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(TextureUnit::behind));
    if (!behind_) behind_.emplace(gl, *samples_);
    behind_->copy(*samples_);
    gl->BindTexture(GL_TEXTURE_2D, behind_->color().name());
    gl->BindSampler(static_cast<GLuint>(TextureUnit::behind), 0);
    samples_->bind();
}

void Picture::finish() const {
    const gl::Api& gl = *api_;
    if (finishing_) {
        finished_->bind();
        gl->Disable(GL_DEPTH_TEST);
        gl->Disable(GL_CULL_FACE);
        gl->Disable(GL_BLEND);
        finishing_->use();
        finishing_->set("background",
                        glm::vec4(glm::vec3(background_) * background_.a, background_.a));
        finishing_->set("exposure", exposure_);
        gl->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(TextureUnit::drawn));
        const GLenum target = sample_count_ > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
        gl->BindTexture(target, samples_->color().name());
        gl->BindSampler(static_cast<GLuint>(TextureUnit::drawn), 0);
        gl->BindVertexArray(empty_vertices_.name());
        gl->DrawArrays(GL_TRIANGLES, 0, 3);
        gl->BindTexture(target, 0);
    }
    gl->Finish();
}

int Picture::last_level() const {
    return gl::level_count(std::max(width(), height())) - 1;
}

Image Picture::read() const {
    const ColorSpace space = output_ == OutputCoding::srgb ? ColorSpace::srgb : ColorSpace::linear;
    return target().read(space);
}

std::shared_ptr<const gl::RenderTarget> TargetPool::take(int width, int height,
                                                         gl::ColorFormat format, int samples) {
    const auto is_fit = [&](const Entry& entry) {
        return entry.width == width && entry.height == height && entry.format == format &&
               entry.samples == samples && entry.target.use_count() == 1;
    };
    const auto free = std::find_if(targets_.begin(), targets_.end(), is_fit);
    if (free != targets_.end()) return free->target;
    auto made = std::make_shared<const gl::RenderTarget>(*api_, width, height, format, samples);
    targets_.push_back({width, height, format, samples, made});
    return made;
}

void TargetPool::drop_unused() {
    std::erase_if(targets_, [](const Entry& entry) { return entry.target.use_count() == 1; });
}

}  // namespace relief::shade::detail
