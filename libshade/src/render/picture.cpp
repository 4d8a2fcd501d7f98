// SPDX-License-Identifier: Apache-2.0
// Render targets of a picture, its finishing pass with sRGB codes by [IEC 61966-2-1], and the
// exchange of finished pictures between threads. Tests: tests/shade/render/renderer_test.cpp,
// shading_test.cpp, picture_exchange_test.cpp.
#include "render/picture.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <span>

#include "effects/surface_program.h"
#include "relief/mesh/report.h"
#include "relief/shade/renderer.h"

namespace relief {
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

/// Returns the background as displayed, linear.
glm::vec4 shown_background(const glm::vec4& background, OutputCoding output) {
    if (output == OutputCoding::linear) return background;
    return {glm::min(glm::vec3(background), glm::vec3(1.0F)), background.a};
}

ShaderSteps finishing_steps(const Scene& scene, OutputCoding output, int samples) {
    ShaderSteps steps = output_steps(output, scene);
    steps["samples"].part = samples > 1 ? "picture.glsl#four_samples" : "picture.glsl#one_sample";
    return steps;
}

/// Texels of four channels, with row 0 at the bottom.
std::vector<std::uint8_t> as_texels(const Image& picture) {
    const std::span<const std::uint8_t> from = picture.as<std::uint8_t>();
    const auto width = static_cast<std::size_t>(picture.width);
    const auto height = static_cast<std::size_t>(picture.height);
    const auto channels = static_cast<std::size_t>(picture.channels);
    std::vector<std::uint8_t> texels(4 * width * height, 255);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const auto pixel = from.subspan(channels * (y * width + x), channels);
            std::copy(
                pixel.begin(), pixel.end(),
                texels.begin() + static_cast<std::ptrdiff_t>(4 * ((height - 1 - y) * width + x)));
        }
    }
    return texels;
}

}  // namespace

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
        throw InvalidInput("half is what a finishing pass reads, not a picture's coding");
    }
    if (!finishes && settings.samples > 1) {
        throw InvalidInput("samples are to be averaged, but the plan has no finishing pass");
    }
    if (!finishes) return;
    finished_ = targets.take(settings.width, settings.height, format_of(output_), 1);
    finishing_ = programs.get("picture", finishing_steps(scene, output_, settings.samples));
}

void Picture::begin() const {
    samples_->bind();
    glm::vec4 color(0.0F);
    if (!finishing_) {
        color = background_;
        if (output_ == OutputCoding::srgb) {
            for (int i = 0; i < 3; ++i)
                color[i] = srgb_from_linear(color[i]);
        }
    }
    const gl::Api& gl = *api_;
    gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->DepthMask(GL_TRUE);
    gl->ClearColor(color.r, color.g, color.b, color.a);
    gl->ClearDepth(1.0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
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

struct PictureExchange::Implementation {
    explicit Implementation(const gl::Api& gl) : api(gl) {}

    using Target = std::optional<gl::RenderTarget>;
    struct Slot {
        Target picture;
        Target beside;
    };

    /// Returns a slot that is neither shown nor the newest.
    std::size_t free_slot() {
        const std::lock_guard lock(mutex);
        std::size_t free = 0;
        while (free == shown || free == newest)
            ++free;
        return free;
    }

    void fit(Target& target, int width, int height) const {
        if (target && target->width() == width && target->height() == height) return;
        target.reset();
        target.emplace(api, width, height, gl::ColorFormat::rgba8, 1);
    }

    void copy(Target& target, const gl::RenderTarget& drawn) const {
        fit(target, drawn.width(), drawn.height());
        target->copy(drawn);
    }

    void publish(std::size_t slot) {
        api->Finish();
        api.check("handing a picture over");
        const std::lock_guard lock(mutex);
        newest = slot;
    }

    const gl::Api& api;
    std::array<Slot, 3> slots;
    std::mutex mutex;
    std::optional<std::size_t> shown;
    std::optional<std::size_t> newest;
};

PictureExchange::PictureExchange(const Context& context)
    : implementation_(std::make_unique<Implementation>(context.api())) {}

PictureExchange::~PictureExchange() = default;

void PictureExchange::put(const Renderer& renderer, const Renderer* beside) {
    Implementation& self = *implementation_;
    const std::size_t free = self.free_slot();
    Implementation::Slot& slot = self.slots.at(free);
    self.copy(slot.picture, renderer.target());
    if (beside == nullptr)
        slot.beside.reset();
    else
        self.copy(slot.beside, beside->target());
    self.publish(free);
}

void PictureExchange::put(const Image& picture) {
    Implementation& self = *implementation_;
    const std::size_t free = self.free_slot();
    Implementation::Slot& slot = self.slots.at(free);
    slot.beside.reset();
    self.fit(slot.picture, picture.width, picture.height);
    const std::vector<std::uint8_t> texels = as_texels(picture);
    self.api->BindTexture(GL_TEXTURE_2D, slot.picture->color().name());
    self.api->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, picture.width, picture.height, GL_RGBA,
                            GL_UNSIGNED_BYTE, texels.data());
    self.api->BindTexture(GL_TEXTURE_2D, 0);
    self.publish(free);
}

PictureExchange::Shown PictureExchange::get() {
    Implementation& self = *implementation_;
    const std::lock_guard lock(self.mutex);
    self.shown = self.newest;
    if (!self.shown) return {};
    const Implementation::Slot& slot = self.slots.at(*self.shown);
    return {slot.picture->color().name(), slot.picture->width(), slot.picture->height(),
            slot.beside ? slot.beside->color().name() : 0U};
}

}  // namespace relief
