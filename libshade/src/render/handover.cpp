// SPDX-License-Identifier: Apache-2.0
// Tests: tests/shade/render/handover_test.cpp.
#include "relief/shade/handover.h"

#include <array>
#include <mutex>
#include <optional>

#include "gl/framebuffer.h"

namespace relief {

struct Handover::Implementation {
    explicit Implementation(const gl::Api& gl) : api(gl) {}

    /// One that is neither shown nor waiting.
    std::size_t free_one() {
        const std::lock_guard lock(mutex);
        std::size_t free = 0;
        while (free == shown || free == newest)
            ++free;
        return free;
    }

    const gl::Api& api;
    std::array<std::optional<gl::RenderTarget>, 3> targets;
    std::mutex mutex;
    std::optional<std::size_t> shown;
    std::optional<std::size_t> newest;
};

Handover::Handover(const Context& context)
    : implementation_(std::make_unique<Implementation>(context.api())) {}

Handover::~Handover() = default;

void Handover::put(const Renderer& renderer) {
    Implementation& self = *implementation_;
    const gl::RenderTarget& drawn = renderer.target();
    const std::size_t free = self.free_one();
    std::optional<gl::RenderTarget>& target = self.targets.at(free);
    if (!target || target->width() != drawn.width() || target->height() != drawn.height()) {
        target.reset();
        target.emplace(self.api, drawn.width(), drawn.height(), gl::ColorFormat::rgba8, 1);
    }
    target->copy(drawn);
    self.api->Finish();
    self.api.check("handing a picture over");
    const std::lock_guard lock(self.mutex);
    self.newest = free;
}

Handover::Shown Handover::get() {
    Implementation& self = *implementation_;
    const std::lock_guard lock(self.mutex);
    self.shown = self.newest;
    if (!self.shown) return {};
    const gl::RenderTarget& target = *self.targets.at(*self.shown);
    return {target.color().name(), target.width(), target.height()};
}

}  // namespace relief
