// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes on the GPU: the vertex streams that the plan names and no others, what deforms them, a
/// cache of both, and blended triangles in painter's order.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "gl/resources.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "render/program_cache.h"

namespace relief::shade::detail {

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
FramedMesh with_planned_frames(const Mesh& mesh, const PlannedStreams& streams, Report& report);

/// Vertex array and buffers. An attribute whose stream is missing keeps its constant.
class GpuMesh {
  public:
    /// \param source_vertex  the vertex of the scene's mesh of which each was made; empty: the same
    /// \throws GpuError if memory runs out
    GpuMesh(const gl::Api& api, const Mesh& mesh, const PlannedStreams& streams,
            std::vector<std::uint32_t> source_vertex = {});

    /// Binds the vertex array.
    void bind(const gl::Api& api) const { api->BindVertexArray(vertices_.name()); }

    /// Draws a run of triangles with the current program.
    void draw(const gl::Api& api, const MaterialRange& range) const;

    /// Draws these triangles in this order instead of those of the mesh.
    void draw(const gl::Api& api, std::span<const glm::uvec3> triangles);

    [[nodiscard]] std::span<const std::uint32_t> source_vertex() const { return source_vertex_; }

  private:
    gl::VertexArray vertices_;
    std::vector<std::uint32_t> source_vertex_;
    std::vector<gl::Buffer> buffers_;  ///< The last holds the triangles.
    gl::Buffer ordered_;               ///< Only if triangles were drawn in another order.
};

/// Sets the constants of attributes without a stream: the normal and tangent frame of a flat
/// surface facing +z, and white.
void set_attribute_constants(const gl::Api& api);

/// The data that all draws of an instance need together to deform it.
struct PlannedDeformation {
    bool joints = false;
    bool targets = false;
    bool target_normals = false;
    bool target_tangents = false;
    bool facets = false;

    friend bool operator==(const PlannedDeformation&, const PlannedDeformation&) = default;

    void add(const PlannedInterface& planned);
};

/// The deformations of the vertices of a mesh, as buffer textures (vertex.glsl). All poses share
/// them.
struct GpuDeformation {
    /// \throws GpuError if memory runs out, or a texture would be larger than the driver allows
    GpuDeformation(const gl::Api& api, const Mesh& mesh, const GpuMesh& uploaded,
                   const MeshPose& pose, const PlannedDeformation& planned);

    std::vector<gl::Buffer> buffers;
    gl::Texture joint_weights;
    gl::Texture morph_displacements;
    gl::Texture facet_corners;
    int joint_pairs = 0;          ///< Texels of joint_weights for each vertex.
    glm::ivec2 target_texels{0};  ///< Texels of morph_displacements for a target and a vertex.
};

/// The pose of an instance on the GPU: joint matrices, and the morph weights that are not 0.
class GpuPose {
  public:
    /// Uploads a pose. \param vertices  what it deforms; null if it stays at rest
    void update(const gl::Api& api, std::shared_ptr<const GpuDeformation> vertices,
                const MeshPose* pose);

    /// Binds the textures.
    void bind(const gl::Api& api) const;

    [[nodiscard]] int joint_pairs() const { return vertices_ ? vertices_->joint_pairs : 0; }
    /// Targets with a weight, texels of a target, texels of a vertex.
    [[nodiscard]] glm::ivec3 morph_layout() const;

  private:
    std::shared_ptr<const GpuDeformation> vertices_;
    gl::Buffer matrices_;
    gl::Texture joint_matrices_;
    gl::Buffer weights_;
    gl::Texture morph_weights_;
    int weight_count_ = 0;
    std::size_t matrix_count_ = 0;
    std::size_t max_weights_ = 0;
};

/// The open shares of an instance by vertex, as a buffer texture.
class GpuOpenShares {
  public:
    /// \param shares    of the vertices of the scene's mesh; empty: 1 for all
    /// \param uploaded  the mesh with the vertices of draws
    /// \throws GpuError if memory runs out, or the texture would be larger than the driver allows
    GpuOpenShares(const gl::Api& api, const Mesh& mesh, const GpuMesh& uploaded,
                  const std::vector<float>& shares);

    void bind(const gl::Api& api) const;

  private:
    gl::Buffer buffer_;
    gl::Texture texture_;
};

/// Meshes on the GPU by the identity of the mesh and its streams, and what deforms them.
class MeshCache {
  public:
    explicit MeshCache(const gl::Api& api) : api_(&api) {}

    /// Returns a mesh with these streams. On first use the missing frames are computed, and it is
    /// uploaded. \param report  gets the findings of that computation, on every call
    std::shared_ptr<GpuMesh> get(const Shared<Mesh>& mesh, const PlannedStreams& streams,
                                 Report& report);

    /// Returns what deforms a mesh, uploaded on first use.
    std::shared_ptr<const GpuDeformation> get(const Shared<Mesh>& mesh,
                                              const std::shared_ptr<GpuMesh>& uploaded,
                                              const MeshPose& pose,
                                              const PlannedDeformation& planned);

    void drop_unused();
    [[nodiscard]] std::size_t size() const { return meshes_.size(); }

  private:
    struct DeformationEntry {
        Shared<GltfDeformation>::Identity identity;
        std::size_t joints;
        PlannedDeformation planned;
        std::weak_ptr<GpuMesh> mesh;
        std::shared_ptr<const GpuDeformation> deformation;
    };
    struct Entry {
        Shared<Mesh>::Identity identity;
        PlannedStreams streams;
        Report findings;
        std::shared_ptr<GpuMesh> mesh;
    };

    const gl::Api* api_;
    // By address, which is not reused while an entry exists: identities keep the memory.
    std::unordered_multimap<const Mesh*, Entry> meshes_;
    std::unordered_multimap<const GpuMesh*, DeformationEntry> deformations_;
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

}  // namespace relief::shade::detail
