// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surface that a height map describes on a mesh, and triangles that approximate it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "image/bilinear_heights.h"
#include "relief/mesh/displace.h"
#include "relief/mesh/mesh.h"
#include "topology/topology.h"

namespace relief::detail {

/// The distances at the samples of a triangle.
struct SampledError {
    double max = 0.0;
    double squares = 0.0;
    std::size_t samples = 0;
};

/// A place of the surface. All of its vertices move to the same position.
struct SurfacePoint {
    glm::dvec3 base{0.0};   ///< On the mesh.
    glm::dvec3 moved{0.0};  ///< Displaced.
};

/// A point with the attributes on one side of a seam.
struct SurfaceVertex {
    std::uint32_t point = 0;
    glm::dvec2 texcoord{0.0};
    glm::dvec3 normal{0.0};  ///< Linear on each triangle of the mesh, not unit.
    /// The gradients of u and v along the mesh.
    glm::dvec3 along_u{0.0};
    glm::dvec3 along_v{0.0};
    glm::vec4 color{0.0F};
    glm::vec2 texcoord_2{0.0F};
};

struct SurfaceTriangle {
    glm::uvec3 vertices{0};
    std::uint32_t source = 0;  ///< The triangle of the mesh.
    bool is_done = false;      ///< It is near enough, or as small as it may become.
};

/// Points, vertices and triangles, which may be divided, and the displacement of each point.
class DisplacedSurface {
  public:
    /// \param mesh  with usable normals
    /// \param topology  of the mesh, with its corners in their order
    DisplacedSurface(const Mesh& mesh, const Topology& topology, const BilinearHeights& heights,
                     const DisplaceOptions& options);

    /// Samples the distance of a triangle from the described surface, up to the first sample above
    /// `enough`. Without samples if a texture coordinate is not finite.
    [[nodiscard]] SampledError error(const SurfaceTriangle& triangle, double enough) const;

    /// Returns true if the edges of a triangle are at most half a texel long along both axes of the
    /// map, or if a texture coordinate is not finite.
    [[nodiscard]] bool is_smallest(const SurfaceTriangle& triangle) const;

    /// Adds the middle of the edges between pairs of vertices, which are the sides of one edge.
    /// \return the first of the new vertices, which are in the order of the pairs
    std::uint32_t add_middle(std::span<const glm::uvec2> sides);

    /// Returns the unit normal of the described surface at each vertex. Those of one point are
    /// equal where the normals of the mesh are.
    [[nodiscard]] std::vector<glm::vec3> normals() const;

    [[nodiscard]] const SurfacePoint& point_of(std::uint32_t vertex) const {
        return points[vertices[vertex].point];
    }

    std::vector<SurfacePoint> points;
    std::vector<SurfaceVertex> vertices;
    std::vector<SurfaceTriangle> triangles;

  private:
    [[nodiscard]] double height_at(const glm::dvec2& texcoord) const;
    [[nodiscard]] glm::dvec3 moved(const glm::dvec3& base,
                                   std::span<const SurfaceVertex> sides) const;
    [[nodiscard]] double error_at(const SurfaceTriangle& triangle, const glm::dvec3& weights) const;
    void set_gradients();

    const BilinearHeights& heights_;
    double height_;
    double zero_;
};

}  // namespace relief::detail
