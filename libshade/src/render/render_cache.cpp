// SPDX-License-Identifier: Apache-2.0
// Tests: tests/shade/render/render_cache_test.cpp.
#include "relief/shade/render_cache.h"

#include "render/gpu_cache.h"

namespace relief {

RenderCache::RenderCache(const Context& context)
    : implementation_(std::make_unique<Implementation>(context.api())) {}

RenderCache::~RenderCache() = default;

void RenderCache::drop_unused() {
    implementation_->meshes.drop_unused();
    implementation_->textures.drop_unused();
    implementation_->environments.drop_unused();
    implementation_->targets.drop_unused();
}

void RenderCache::drop_programs() {
    implementation_->programs.clear();
}

RenderCache::Contents RenderCache::contents() const {
    return {implementation_->programs.size(), implementation_->meshes.size(),
            implementation_->textures.size(), implementation_->environments.size(),
            implementation_->targets.size()};
}

}  // namespace relief
