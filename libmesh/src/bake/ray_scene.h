// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ray casting against several meshes, and the projection of points of the low mesh onto the high
/// meshes: how far rays run, and which hit counts. All values are in the space and unit of the
/// meshes. Tests: tests/mesh/bake/ray_scene_test.cpp, bake_test.cpp.
///
/// *Rays.* Sixteen rays are cast at a time. The rules for edges, vertices and coincident triangles
/// are those of bake/embree_scene.h. Results are the same on every processor. An empty scene has no
/// hits.
///
/// *Projection.* A line runs through a point P along an outward direction. Walking outwards from P,
/// the line crosses each triangle from behind (it leaves a solid) or from the front (it enters
/// one). The result is the last exit before the line enters another solid after it has left all
/// solids. How many solids contain P follows from the crossings: if the first crossing outwards is
/// an entry, P is outside if the nearest triangle inwards faces P; otherwise P is inside two solids
/// that intersect, and the line must leave both. If there is no exit, P is outside, and the result
/// is the first triangle inwards that faces P.
///
/// One ray from the outer end finds the first hit, and whether there are hits between that one and
/// P. If there are none, which is the usual case, the first hit is the result. Otherwise the line
/// is walked triangle by triangle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "bake/embree_scene.h"
#include "relief/export.h"
#include "relief/mesh/bake.h"

namespace RELIEF_API relief {
namespace detail {

/// Triangles of one mesh; both spans must outlive the scene.
struct RayMesh {
    std::span<const glm::vec3> positions;
    std::span<const glm::uvec3> triangles;
};

/// A point on a triangle.
struct RayHit {
    std::uint32_t mesh = RayPacket::nothing;
    std::uint32_t triangle = 0;
    glm::dvec3 weights{0.0};    ///< Barycentric.
    double distance = 0.0;      ///< Along the ray, from its origin.
    bool faces_origin = false;  ///< The ray hits the front.

    [[nodiscard]] bool is_hit() const { return mesh != RayPacket::nothing; }
};

class RayScene {
  public:
    /// \param expected_rays  an estimate, which decides how thoroughly the scene is built:
    /// SceneBuild
    /// \param order  the order of coincident triangles that face the same way
    explicit RayScene(std::vector<RayMesh> meshes,
                      double expected_rays = std::numeric_limits<double>::infinity(),
                      TriangleOrder order = {});

    /// Puts a ray with a unit direction into a lane of a packet; see EmbreeScene::set().
    void set(RayPacket& packet, std::size_t lane, const Ray& ray,
             double until = -std::numeric_limits<double>::infinity()) const;

    /// Finds the nearest hits of the first `count` rays of a packet: EmbreeScene::find_nearest().
    void find(RayPacket& packet, std::size_t count) const;

    /// Tests whether the first `count` rays of a packet hit anything, front or back, which is
    /// faster than find(). RayPacket::is_blocked() has the result.
    void find_any(RayPacket& packet, std::size_t count) const;

    /// Returns the hit of one lane.
    [[nodiscard]] RayHit hit(const RayPacket& packet, std::size_t lane) const;

    /// Returns the nearest hit of a single ray.
    [[nodiscard]] RayHit nearest(const Ray& ray) const;

    /// Returns the distance of the nearest triangle from a point; infinity if there is none.
    /// \param enough  the search stops at a triangle within this distance
    [[nodiscard]] double distance_from(const glm::dvec3& point, double enough = 0.0) const;

    [[nodiscard]] const std::vector<RayMesh>& meshes() const { return meshes_; }
    [[nodiscard]] bool is_empty() const { return is_empty_; }
    /// Returns half of the longest side of the box around all finite positions; 1 without any.
    [[nodiscard]] double half_size() const { return space_.half_size; }

    /// Returns the corners of a hit triangle.
    [[nodiscard]] std::array<glm::dvec3, 3> corners(std::uint32_t mesh,
                                                    std::uint32_t triangle) const;

  private:
    std::vector<RayMesh> meshes_;
    EmbreeSpace space_;
    bool is_empty_ = true;
    EmbreeScene embree_;
};

/// A line through a point of the low mesh, from outside to inside.
struct ProjectionLine {
    glm::dvec3 point{0.0};
    glm::dvec3 outward{0.0};  ///< Unit; zero means that nothing is hit.
    double outside = 0.0;     ///< Length on the outer side of the point.
    double inside = 0.0;      ///< Length on the inner side.
};

/// Returns the ray from the outer end of a line to its inner end.
Ray from_outside(const ProjectionLine& line);

/// The surface point that a line projects to.
struct ProjectedPoint {
    RayHit hit;           ///< Seen from the outer end.
    double height = 0.0;  ///< Along the outward direction, from the line's point.
};

class Projection {
  public:
    Projection(const RayScene& scene, BackFaces back_faces);

    /// Projects all lines; coherent neighbors are fastest. \return the number of rays
    std::size_t find(std::span<const ProjectionLine> lines, std::span<ProjectedPoint> points) const;

    /// Rays at this distance inside an open border of the high meshes hit the surface.
    [[nodiscard]] double border_distance() const { return step_; }

  private:
    struct Walk;

    /// \return the lines whose first hit may not be the result
    std::vector<std::size_t> find_from_outside(std::span<const ProjectionLine> lines,
                                               std::span<ProjectedPoint> points) const;
    std::size_t walk(const ProjectionLine& line, ProjectedPoint& point) const;

    const RayScene& scene_;
    BackFaces back_faces_;
    double step_;  ///< Distance by which a ray continues behind a hit.
};

/// Like automatic_distances(), with an existing scene of the high meshes.
BakeDistances distances_between(std::span<const Mesh> high, const RayScene& high_scene,
                                const Mesh& low);

/// Returns the length of the diagonal of a box.
double diagonal(const Bounds& box);

/// Like the public compare_boxes(), for existing boxes.
BakeFit compare_boxes(const Bounds& high, const Bounds& low);

}  // namespace detail
}  // namespace relief
