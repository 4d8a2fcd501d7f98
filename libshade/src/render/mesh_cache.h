// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes on the GPU, kept by what they are meshes of. Tests:
/// tests/shade/render/render_cache_test.cpp.
#pragma once

#include <memory>
#include <vector>

#include "relief/shade/shared.h"
#include "render/gpu_mesh.h"

namespace relief {

class MeshCache {
  public:
    explicit MeshCache(const gl::Api& api) : api_(&api) {}

    /// A mesh with these streams, uploaded if it is not there yet, after computing the frames that
    /// streams want and it lacks.
    /// \param report  gets what was found then, also where it was some time ago
    std::shared_ptr<GpuMesh> get(const Shared<Mesh>& mesh, const PlannedStreams& streams,
                                 Report& report);

    void drop_unused();
    [[nodiscard]] std::size_t size() const { return meshes_.size(); }

  private:
    struct Entry {
        Shared<Mesh>::Identity identity;
        PlannedStreams streams;
        Report found;
        std::shared_ptr<GpuMesh> mesh;
    };

    const gl::Api* api_;
    std::vector<Entry> meshes_;
};

}  // namespace relief
