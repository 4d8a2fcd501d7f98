// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ray casting against several meshes, sixteen rays at a time, in any unit.
///
/// The rules for edges, vertices and coincident triangles are those of bake/embree_scene.h. Results
/// are the same on every processor. An empty scene has no hits. Tests:
/// tests/mesh/bake/ray_scene_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "bake/embree_scene.h"

namespace relief {

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
    /// \param expected_rays  an estimate, which decides how thoroughly the scene is built
    /// (SceneBuild) \param order          the order of coincident triangles that face the same way
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
    /// Half of the longest side of the box around all finite positions; 1 without any.
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

}  // namespace relief
