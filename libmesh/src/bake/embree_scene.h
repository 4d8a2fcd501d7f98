// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ray casting with Embree, for the baker (bake/ray_scene.h) and the reference renderer (libshade's
/// reference/reference_parts.h). No other part of relief uses Embree.
///
/// Embree traverses a tree of boxes around clusters of triangles (bake/triangle_clusters.h). The
/// boxes are enlarged by more than the rounding errors of its floats. The hits themselves are
/// computed in double from the positions of the mesh. So the result depends neither on the
/// processor, nor on the packet that a ray is in, nor on the order of the triangles.
///
/// Triangles with a vertex that is not finite, triangles without area, and triangles seen exactly
/// edge-on are never hit. A ray through an edge or a vertex hits all triangles there. Queries are
/// thread-safe. Tests: tests/mesh/rays/embree_scene_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bake/triangle_clusters.h"
#include "relief/export.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace RELIEF_API relief {
namespace detail {

/// A ray in the space of the meshes.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};  ///< Of any length: the unit of `near` and `far`.
    double near = 0.0;          ///< Along the ray, from the origin.
    double far = 0.0;
};

struct MetTriangle {
    std::uint32_t mesh = 0;
    std::uint32_t triangle = 0;

    friend auto operator<=>(const MetTriangle&, const MetTriangle&) = default;
};

/// Sixteen rays and their hits.
struct alignas(64) RayPacket {
    static constexpr std::size_t size = 16;
    static constexpr std::uint32_t nothing = 0xffffffff;
    using Numbers = std::array<double, size>;

    std::array<RayFrame, size> frame;
    RayLines<size> lines;  ///< The same rays.
    Numbers near, far;     ///< A ray with near > far hits nothing.
    /// The same ray in Embree's space, where a length of 1 along the ray is `scale`.
    std::array<glm::vec3, size> float_origin, float_direction;
    std::array<float, size> length;
    Numbers start, scale;  ///< The ray starts slightly before `start`.

    Numbers until;     ///< All hits up to this distance are found, not only the nearest.
    Numbers distance;  ///< Of the nearest hit, along the ray.
    Numbers last;      ///< The farthest hit up to `until`; minus infinity if there is none.
    std::array<std::uint32_t, size> mesh, triangle;
    std::array<bool, size> blocked;

    [[nodiscard]] bool hits(std::size_t lane) const { return mesh[lane] != nothing; }
    /// Returns whether a ray hits anything, after find_any().
    [[nodiscard]] bool is_blocked(std::size_t lane) const { return blocked[lane]; }
};

/// The effort of building a scene. It does not change the hits.
enum class SceneBuild {
    thorough,  ///< For many rays.
    fast,      ///< Takes two thirds of the build time; rays take up to 5% longer.
};

/// A strict order of coincident triangles by their attributes: whether the first one ranks before
/// the second.
using TriangleOrder = std::function<bool(const MetTriangle&, const MetTriangle&)>;

class EmbreeScene {
  public:
    /// For tests, the environment variable RELIEF_EMBREE configures Embree's device ("isa=avx2"),
    /// and RELIEF_RAY_PACKET is the number of rays per call of Embree: 1, 4, 8 or 16; the default
    /// is 16 for find_nearest() and 1 for find_any(). The constructor reads both.
    /// \throws Error if the processor lacks the instructions that RELIEF_EMBREE asks for
    EmbreeScene(const EmbreeSpace& space, SceneBuild build, TriangleOrder order = {});
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// \param name       the unique number of the mesh in hits
    /// \param positions, triangles  must outlive the scene
    void add(std::uint32_t name, std::span<const glm::vec3> positions,
             std::span<const glm::uvec3> triangles);
    void add(std::uint32_t name, std::span<const glm::dvec3> positions,
             std::span<const glm::uvec3> triangles);

    /// Must be called once, after all meshes are added and before the first query.
    /// \throws std::bad_alloc; Error if Embree fails
    void build();

    /// Puts a ray into a lane of a packet. Rays that are not finite hit nothing, nor do rays from
    /// more than 1e10 times the scene's size away, where doubles are too coarse. \param until  see
    /// RayPacket::until
    void set(RayPacket& packet, std::size_t lane, const Ray& ray,
             double until = -std::numeric_limits<double>::infinity()) const;

    /// Finds the nearest hits of the first `count` rays of a packet. Coherent rays are fastest.
    ///
    /// Hits whose distances differ by less than 1e-12 of the scene's size are ties, which includes
    /// all hits at an edge or a vertex. Ties: triangles that face the ray's origin win, then the
    /// triangle whose corners, sorted by x, y and z, come first. Coincident triangles are compared
    /// by the scene's `order`, then by mesh and triangle.
    void find_nearest(RayPacket& packet, std::size_t count) const;

    /// Tests whether the first `count` rays hit anything; is_blocked() has the result.
    void find_any(RayPacket& packet, std::size_t count) const;

    /// Appends every triangle that a ray hits, in arbitrary order.
    void find_all(const Ray& ray, std::vector<MetTriangle>& triangles) const;

    /// Returns the distance of the nearest triangle; infinity if there is none.
    /// \param enough  the search stops at a triangle within this distance
    [[nodiscard]] double distance_from(const glm::dvec3& point, double enough = 0.0) const;

    [[nodiscard]] std::array<glm::dvec3, 3> corners(const MetTriangle& met) const;

    struct MeshOfScene;  ///< Private to the implementation.

  private:
    template <typename Number>
    void add(std::uint32_t name, std::span<const glm::vec<3, Number>> positions,
             std::span<const glm::uvec3> triangles);
    void settle_ties(RayPacket& packet, std::vector<struct TiedHit>& tied) const;

    EmbreeSpace space_;
    TriangleOrder order_;
    RTCDeviceTy* device_;
    RTCSceneTy* scene_;
    SceneBuild build_;
    std::optional<int> rays_at_once_;
    std::vector<std::unique_ptr<MeshOfScene>> meshes_;  ///< By name; null if unused.
};

}  // namespace detail
}  // namespace relief
