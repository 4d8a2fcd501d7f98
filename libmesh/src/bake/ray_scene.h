// SPDX-License-Identifier: Apache-2.0
/// \file
/// What rays hit first: the triangles of some meshes, and the nearest hit of sixteen rays at a
/// time.
///
/// Embree finds the triangle, in float; where on it the ray hits is computed anew in double, from
/// the mesh's own positions. Any unit and any place: the scene is moved and scaled into the box
/// from -1 to 1 for Embree. Triangles with a vertex that is not finite are never hit; those without
/// area neither. An empty scene has no hits. Tests: tests/mesh/bake/ray_scene_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "rays/embree_scene.h"

namespace relief {

/// Triangles of one mesh; both spans must outlive the scene.
struct RayMesh {
    std::span<const glm::vec3> positions;
    std::span<const glm::uvec3> triangles;
};

/// A ray in the space of the meshes.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};  ///< Unit.
    double near = 0.0;          ///< Along it, from the origin.
    double far = 0.0;
};

/// A place on a triangle.
struct RayHit {
    std::uint32_t mesh = RayPacket::nothing;
    std::uint32_t triangle = 0;
    glm::dvec3 weights{0.0};    ///< Of the corners: none negative, together 1.
    double distance = 0.0;      ///< Along the ray, from its origin.
    bool faces_origin = false;  ///< Its corners are counter-clockwise, seen from there.

    [[nodiscard]] bool is_hit() const { return mesh != RayPacket::nothing; }
};

class RayScene {
  public:
    /// \param expected_rays  how many will be cast, about: few do not pay for a scene that is made
    ///                       ready for many (SceneBuild).
    explicit RayScene(std::vector<RayMesh> meshes,
                      double expected_rays = std::numeric_limits<double>::infinity());

    /// Puts a ray into a lane of a packet.
    void set(RayPacket& packet, std::size_t lane, const Ray& ray) const;

    /// Finds the nearest hits of the first `count` rays of a packet. Fastest for rays that run side
    /// by side.
    ///
    /// A ray through an edge or a vertex hits one of the triangles there: the one whose corners
    /// come first in order of place, of equal ones the first. So the order of triangles does not
    /// matter there, nor what other rays are in the packet, nor how many threads built the scene.
    /// Of triangles that coincide elsewhere, any is hit.
    void find(RayPacket& packet, std::size_t count) const;

    /// Finds out whether the first `count` rays of a packet hit anything, which is faster; whatever
    /// it is, wherever they run to, and whichever way it faces. For RayPacket::is_blocked().
    void find_any(RayPacket& packet, std::size_t count) const;

    /// The hit of one lane, made exact for the ray that set() was given: where the ray meets the
    /// triangle's plane, drawn into the triangle where rounding put it outside.
    [[nodiscard]] RayHit hit(const RayPacket& packet, std::size_t lane, const Ray& ray) const;

    /// The nearest hit of a single ray, by the same rules.
    [[nodiscard]] RayHit nearest(const Ray& ray) const;

    /// How far the nearest triangle is from a point; infinity where there is none. To within
    /// float's precision over the size of the scene.
    /// \param enough  where one is as near as that, its distance will do: found sooner
    [[nodiscard]] double distance_from(const glm::dvec3& point, double enough = 0.0) const;

    [[nodiscard]] const std::vector<RayMesh>& meshes() const { return meshes_; }
    [[nodiscard]] bool is_empty() const { return is_empty_; }
    /// Half of the longest side of the box around all finite positions; 1 where there is none.
    [[nodiscard]] double half_size() const { return half_size_; }

    /// The corners of a hit triangle.
    [[nodiscard]] std::array<glm::dvec3, 3> corners(std::uint32_t mesh,
                                                    std::uint32_t triangle) const;

  private:
    void settle_edges(RayPacket& packet, std::size_t lane) const;
    [[nodiscard]] RayHit exact(std::uint32_t mesh, std::uint32_t triangle, const Ray& ray) const;

    std::vector<RayMesh> meshes_;
    glm::dvec3 centre_{0.0};
    double half_size_ = 1.0;
    bool is_empty_ = true;
    EmbreeScene embree_;
};

}  // namespace relief
