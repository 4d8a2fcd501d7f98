// SPDX-License-Identifier: Apache-2.0
// Tests: tests/shade/render/render_cache_test.cpp.
#include "render/target_pool.h"

#include <algorithm>

namespace relief {

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

}  // namespace relief
