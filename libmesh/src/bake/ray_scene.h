// SPDX-License-Identifier: Apache-2.0
/// \file
/// What rays hit first: the triangles of some meshes, and the nearest hit of sixteen rays at a
/// time.
///
/// Any unit and any place. The rules for edges, vertices and triangles that coincide are those of
/// rays/embree_scene.h; the results are the same on every processor. An empty scene has no hits.
/// Tests: tests/mesh/bake/ray_scene_test.cpp.
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
    /// \param order          of triangles that coincide and face the same way
    explicit RayScene(std::vector<RayMesh> meshes,
                      double expected_rays = std::numeric_limits<double>::infinity(),
                      TriangleOrder order = {});

    /// Puts a ray, whose direction is a unit vector, into a lane of a packet: EmbreeScene::set().
    void set(RayPacket& packet, std::size_t lane, const Ray& ray,
             double until = -std::numeric_limits<double>::infinity()) const;

    /// Finds the nearest hits of the first `count` rays of a packet: EmbreeScene::find_nearest().
    void find(RayPacket& packet, std::size_t count) const;

    /// Finds out whether the first `count` rays of a packet hit anything, which is faster; whatever
    /// it is, wherever they run to, and whichever way it faces. For RayPacket::is_blocked().
    void find_any(RayPacket& packet, std::size_t count) const;

    /// The hit of one lane.
    [[nodiscard]] RayHit hit(const RayPacket& packet, std::size_t lane) const;

    /// The nearest hit of a single ray, by the same rules.
    [[nodiscard]] RayHit nearest(const Ray& ray) const;

    /// How far the nearest triangle is from a point; infinity where there is none.
    /// \param enough  where one is as near as that, its distance will do: found sooner
    [[nodiscard]] double distance_from(const glm::dvec3& point, double enough = 0.0) const;

    [[nodiscard]] const std::vector<RayMesh>& meshes() const { return meshes_; }
    [[nodiscard]] bool is_empty() const { return is_empty_; }
    /// Half of the longest side of the box around all finite positions; 1 where there is none.
    [[nodiscard]] double half_size() const { return space_.half_size; }

    /// The corners of a hit triangle.
    [[nodiscard]] std::array<glm::dvec3, 3> corners(std::uint32_t mesh,
                                                    std::uint32_t triangle) const;

  private:
    std::vector<RayMesh> meshes_;
    EmbreeSpace space_;
    bool is_empty_ = true;
    EmbreeScene embree_;
};

}  // namespace relief
