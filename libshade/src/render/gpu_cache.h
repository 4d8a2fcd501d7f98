// SPDX-License-Identifier: Apache-2.0
/// \file
/// What renderers of one context can have in common. Tests:
/// tests/shade/render/render_cache_test.cpp.
#pragma once

#include "relief/shade/render_cache.h"
#include "render/environment.h"
#include "render/mesh_cache.h"
#include "render/program_cache.h"
#include "render/target_pool.h"
#include "render/texture_cache.h"

namespace relief {

struct RenderCache::Implementation {
    explicit Implementation(const gl::Api& api)
        : programs(api), meshes(api), textures(api), environments(api), targets(api) {}

    ProgramCache programs;
    MeshCache meshes;
    TextureCache textures;
    EnvironmentCache environments;
    TargetPool targets;
};

}  // namespace relief
