// SPDX-License-Identifier: Apache-2.0
// Tests: tests/shade/render/render_cache_test.cpp.
#include "render/mesh_cache.h"

#include <algorithm>

namespace relief {

namespace {

std::shared_ptr<GpuMesh> uploaded(const gl::Api& api, const Mesh& mesh,
                                  const PlannedStreams& streams, Report& found) {
    const bool lacks_normals = streams.normals && mesh.normals.empty();
    const bool lacks_tangents =
        streams.tangents && mesh.tangents.empty() && !mesh.texcoords.empty();
    if (!lacks_normals && !lacks_tangents) return std::make_shared<GpuMesh>(api, mesh, streams);
    return std::make_shared<GpuMesh>(api, with_planned_frames(mesh, streams, found), streams);
}

}  // namespace

std::shared_ptr<GpuMesh> MeshCache::get(const Shared<Mesh>& mesh, const PlannedStreams& streams,
                                        Report& report) {
    auto entry = std::find_if(meshes_.begin(), meshes_.end(), [&](const Entry& known) {
        return known.streams == streams && known.identity.is(mesh);
    });
    if (entry == meshes_.end()) {
        Report found;
        std::shared_ptr<GpuMesh> made = uploaded(*api_, mesh, streams, found);
        meshes_.push_back({mesh.identity(), streams, std::move(found), std::move(made)});
        entry = std::prev(meshes_.end());
    }
    report.merge(entry->found);
    return entry->mesh;
}

void MeshCache::drop_unused() {
    std::erase_if(meshes_, [](const Entry& entry) { return entry.mesh.use_count() == 1; });
}

}  // namespace relief
