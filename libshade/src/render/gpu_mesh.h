// SPDX-License-Identifier: Apache-2.0
/// \file
/// A mesh on the GPU: the vertex streams that the plan names, and no others.
/// Tests: tests/shade/render/renderer_test.cpp.
#pragma once

#include <span>
#include <vector>

#include "gl/buffer.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "render/program_cache.h"

namespace relief {

/// Which streams are wanted beside the positions, over all draws of a mesh.
struct PlannedStreams {
    bool normals = false;
    bool texcoords = false;
    bool tangents = false;
    bool colors = false;

    friend bool operator==(const PlannedStreams&, const PlannedStreams&) = default;

    void add(const PlannedInterface& planned);
};

/// The mesh with the normals and tangents that the streams want and it lacks: angle-weighted
/// normals, MikkTSpace tangents; tangents only where there are texture coordinates.
Mesh with_planned_frames(const Mesh& mesh, const PlannedStreams& streams, Report& report);

/// Vertex array and buffers. A stream that is wanted but absent stays at the attribute's constant.
class GpuMesh {
  public:
    /// \throws GpuError if memory runs out
    GpuMesh(const gl::Api& api, const Mesh& mesh, const PlannedStreams& streams);

    /// Draws a run of triangles with the current program.
    void draw(const gl::Api& api, const MaterialRange& range) const;

    /// Draws these triangles in this order, whatever the mesh's own are.
    void draw(const gl::Api& api, std::span<const glm::uvec3> triangles);

  private:
    gl::VertexArray vertices_;
    std::vector<gl::Buffer> buffers_;  ///< The last holds the triangles.
    gl::Buffer ordered_;  ///< Only where triangles were drawn in an order of their own.
};

/// Sets what an attribute reads where a mesh has no stream for it: normal and tangent frame of a
/// flat surface facing +z, white.
void set_attribute_constants(const gl::Api& api);

}  // namespace relief
