// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes on the GPU: the vertex streams that the plan names and no others, a cache of them, and
/// blended triangles in painter's order.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "gl/resources.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "render/program_cache.h"

namespace relief {

/// The streams that all draws of a mesh need together, beside the positions.
struct PlannedStreams {
    bool normals = false;
    bool texcoords = false;
    bool texcoords_2 = false;
    bool tangents = false;
    bool colors = false;

    friend bool operator==(const PlannedStreams&, const PlannedStreams&) = default;

    void add(const PlannedInterface& planned);
};

/// Returns the mesh with the missing normals and tangents that the streams need: angle-weighted
/// normals, and MikkTSpace tangents if it has texture coordinates.
Mesh with_planned_frames(const Mesh& mesh, const PlannedStreams& streams, Report& report);

/// Vertex array and buffers. An attribute whose stream is missing keeps its constant.
class GpuMesh {
  public:
    /// \throws GpuError if memory runs out
    GpuMesh(const gl::Api& api, const Mesh& mesh, const PlannedStreams& streams);

    /// Draws a run of triangles with the current program.
    void draw(const gl::Api& api, const MaterialRange& range) const;

    /// Draws these triangles in this order instead of those of the mesh.
    void draw(const gl::Api& api, std::span<const glm::uvec3> triangles);

  private:
    gl::VertexArray vertices_;
    std::vector<gl::Buffer> buffers_;  ///< The last holds the triangles.
    gl::Buffer ordered_;               ///< Only if triangles were drawn in another order.
};

/// Sets the constants of attributes without a stream: the normal and tangent frame of a flat
/// surface facing +z, and white.
void set_attribute_constants(const gl::Api& api);

/// Meshes on the GPU by the identity of the mesh and its streams.
class MeshCache {
  public:
    explicit MeshCache(const gl::Api& api) : api_(&api) {}

    /// Returns a mesh with these streams. On first use the missing frames are computed, and it is
    /// uploaded. \param report  gets the findings of that computation, on every call
    std::shared_ptr<GpuMesh> get(const Shared<Mesh>& mesh, const PlannedStreams& streams,
                                 Report& report);

    void drop_unused();
    [[nodiscard]] std::size_t size() const { return meshes_.size(); }

  private:
    struct Entry {
        Shared<Mesh>::Identity identity;
        PlannedStreams streams;
        Report findings;
        std::shared_ptr<GpuMesh> mesh;
    };

    const gl::Api* api_;
    std::vector<Entry> meshes_;
};

/// Blended triangles, sorted by their centers along the line of sight, farthest first. That is the
/// correct order if triangles neither intersect nor overlap in a cycle.
class SortedTriangles {
  public:
    /// Centers are in object space; non-finite ones count as nearest.
    SortedTriangles(const Mesh& mesh, const MaterialRange& range);

    /// \param farther_object  the viewing direction in object space, of any length but 0: the
    ///                       camera's -z by the transposed object matrix
    /// \return the triangles, farthest first; ties keep the order of the mesh
    std::span<const glm::uvec3> sort(const glm::vec3& farther_object);

    /// Returns the center of the range in object space, by which draws are sorted.
    [[nodiscard]] const glm::vec3& center() const { return center_; }

  private:
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::vec3> centers_;
    glm::vec3 center_{0.0F};
    std::vector<std::uint32_t> order_;
    std::vector<float> depths_;
    std::vector<glm::uvec3> sorted_;
};

}  // namespace relief
