// SPDX-License-Identifier: Apache-2.0
/// \file
/// Caches the resources that renderers share, so that an edited scene is redrawn quickly.
#pragma once

#include <cstddef>
#include <memory>

#include "relief/shade/context.h"

namespace relief {

/// Programs, vertex buffers, textures, environment maps and render targets of one context.
///
/// A renderer with a cache reuses its contents: programs by their Features, meshes and images that
/// are the same Shared value, image files of the same name, size and time of change, and
/// environments likewise. It draws the same pixels as a renderer without a cache. The cache must
/// outlive its renderers, and the context the cache.
class RenderCache {
  public:
    explicit RenderCache(const Context& context);
    ~RenderCache();
    RenderCache(const RenderCache&) = delete;
    RenderCache& operator=(const RenderCache&) = delete;

    /// Frees resources that no renderer uses. Programs are kept, because they are small and slow to
    /// create.
    void drop_unused();

    /// Removes all programs because their sources changed. Existing renderers keep theirs.
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
