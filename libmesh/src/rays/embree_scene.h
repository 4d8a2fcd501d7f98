// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which triangles rays meet: for the baker (bake/ray_scene.h) and for the reference shader's eye
/// (libshade's reference/visibility.h). This is the only part of relief that knows Embree.
///
/// Embree only proposes triangles: it walks through a tree of boxes around clusters of triangles
/// (rays/triangle_clusters.h), which are larger by more than the errors of its floats. Whether a
/// ray meets a triangle, and where, is decided in double from the mesh's own positions
/// (rays/exact_hit.h). So the result depends neither on the processor, nor on the packet that a ray
/// is in, nor on the order of the triangles.
///
/// Triangles with a vertex that is not finite and those without area are never met, neither are
/// triangles that are seen exactly edge-on. A ray through an edge or a vertex meets all triangles
/// there. Safe to ask from many threads. Tests: tests/mesh/rays/embree_scene_test.cpp.
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

#include "rays/exact_hit.h"
#include "rays/triangle_clusters.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace relief {

/// A ray in the space of the meshes.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};  ///< Of any length, which `near` and `far` count in.
    double near = 0.0;          ///< Along it, from the origin.
    double far = 0.0;
};

struct MetTriangle {
    std::uint32_t mesh = 0;
    std::uint32_t triangle = 0;

    friend auto operator<=>(const MetTriangle&, const MetTriangle&) = default;
};

/// Sixteen rays, and what they meet.
struct alignas(64) RayPacket {
    static constexpr std::size_t size = 16;
    static constexpr std::uint32_t nothing = 0xffffffff;
    using Numbers = std::array<double, size>;

    std::array<RayFrame, size> frame;
    RayLines<size> lines;  ///< The same rays.
    Numbers near, far;     ///< A ray whose `near` is greater than its `far` meets nothing.
    /// The same ray for Embree, in its space, where a length of 1 along the ray is `scale`.
    std::array<glm::vec3, size> float_origin, float_direction;
    std::array<float, size> length;
    Numbers start, scale;  ///< It starts a little before `start` along the ray.

    Numbers until;     ///< All hits as near as that are looked for, not the nearest alone.
    Numbers distance;  ///< Of the hit, along the ray.
    Numbers last;      ///< Of the furthest hit up to `until`; minus infinity if there is none.
    std::array<std::uint32_t, size> mesh, triangle;
    std::array<bool, size> blocked;

    [[nodiscard]] bool hits(std::size_t lane) const { return mesh[lane] != nothing; }
    /// After find_any().
    [[nodiscard]] bool is_blocked(std::size_t lane) const { return blocked[lane]; }
};

/// How thoroughly a scene is built. Hits are the same.
enum class SceneBuild {
    thorough,  ///< For many rays.
    fast,      ///< Two thirds of the time; each ray takes up to a twentieth longer.
};

/// Orders triangles that coincide by what else is known of their corners: whether the first comes
/// before the second.
using TriangleOrder = std::function<bool(const MetTriangle&, const MetTriangle&)>;

class EmbreeScene {
  public:
    /// Of tests alone: the environment variable RELIEF_EMBREE configures Embree's device
    /// ("isa=avx2"), and RELIEF_RAY_PACKET is the number of rays that Embree gets at a time (1, 4,
    /// 8 or 16; by default 16 for find_nearest() and 1 for find_any()). Both are read when a scene
    /// is made.
    EmbreeScene(const EmbreeSpace& space, SceneBuild build, TriangleOrder order = {});
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// \param name       what hits will call the mesh; no other has it
    /// \param positions, triangles  must outlive the scene
    void add(std::uint32_t name, std::span<const glm::vec3> positions,
             std::span<const glm::uvec3> triangles);
    void add(std::uint32_t name, std::span<const glm::dvec3> positions,
             std::span<const glm::uvec3> triangles);

    /// Once all are added, before anything is asked.
    void build();

    /// Puts a ray into a lane of a packet. Rays from more than 1e10 times the scene's size away,
    /// where doubles are too coarse, and rays that are not finite meet nothing.
    /// \param until  for RayPacket::last
    void set(RayPacket& packet, std::size_t lane, const Ray& ray,
             double until = -std::numeric_limits<double>::infinity()) const;

    /// Finds the nearest hits of the first `count` rays of a packet. Fastest for rays that run side
    /// by side.
    ///
    /// Hits whose distances differ by less than 1e-12 of the scene's size count as equally near:
    /// all those at an edge or a vertex. Of those, triangles that face the ray's origin come first,
    /// then the one whose corners, sorted by x, y and z, come first; of triangles that coincide,
    /// the first by the scene's `order`, and where that finds them equal, by mesh and triangle.
    void find_nearest(RayPacket& packet, std::size_t count) const;

    /// Finds out whether the first `count` rays meet anything: is_blocked().
    void find_any(RayPacket& packet, std::size_t count) const;

    /// Appends every triangle that a ray meets, in no order.
    void find_all(const Ray& ray, std::vector<MetTriangle>& found) const;

    /// How far the nearest triangle is; infinity where there is none.
    /// \param enough  where one is as near as that, its distance will do: found sooner
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
    std::vector<std::unique_ptr<MeshOfScene>> meshes_;  ///< By name; null where there is none.
};

}  // namespace relief
