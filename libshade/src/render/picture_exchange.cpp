// SPDX-License-Identifier: Apache-2.0
// The exchange of finished pictures between two threads whose contexts share textures.
// Tests: tests/shade/render/render_cache_test.cpp.
#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "gl/resources.h"
#include "relief/shade/renderer.h"

namespace relief::shade {
namespace {

/// Returns texels of four channels, with row 0 at the bottom.
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

}  // namespace relief::shade
