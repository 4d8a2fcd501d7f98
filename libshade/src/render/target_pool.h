// SPDX-License-Identifier: Apache-2.0
/// \file
/// Render targets that pictures take and give back: memory for millions of samples is slow to get.
/// Tests: tests/shade/render/render_cache_test.cpp.
#pragma once

#include <memory>
#include <vector>

#include "gl/framebuffer.h"

namespace relief {

class TargetPool {
  public:
    explicit TargetPool(const gl::Api& api) : api_(&api) {}

    /// One that nobody else holds; what it shows is left from before. \throws as RenderTarget does
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

}  // namespace relief
