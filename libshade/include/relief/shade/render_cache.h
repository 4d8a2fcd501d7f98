// SPDX-License-Identifier: Apache-2.0
/// \file
/// What one renderer leaves for the next, so that an edited scene is on the screen at once.
/// Tests: tests/shade/render/render_cache_test.cpp.
#pragma once

#include <cstddef>
#include <memory>

#include "relief/shade/context.h"

namespace relief {

/// Programs, vertex buffers, textures, environment maps and render targets of one context.
///
/// A renderer made with a cache takes from it what it needs and finds there: programs by their
/// Features; meshes and images that are the same Shared value as before; image files of the same
/// name, size and time of change that were not replaced; the environment likewise. It draws the
/// same pixels as one made without. The cache must outlive its renderers, and the context the
/// cache.
class RenderCache {
  public:
    explicit RenderCache(const Context& context);
    ~RenderCache();
    RenderCache(const RenderCache&) = delete;
    RenderCache& operator=(const RenderCache&) = delete;

    /// Frees what no renderer holds any more. Programs stay: they are small and slow to make.
    void drop_unused();

    /// Forgets all programs: their sources were edited. Renderers that live keep theirs.
    void drop_programs();

    struct Contents {
        std::size_t programs = 0;
        std::size_t meshes = 0;
        std::size_t textures = 0;
        std::size_t environments = 0;
        std::size_t targets = 0;
    };
    [[nodiscard]] Contents contents() const;

    struct Implementation;
    [[nodiscard]] Implementation& implementation() { return *implementation_; }

  private:
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
