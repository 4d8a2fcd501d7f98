// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles in Embree, in float: the one place that knows it. Who asks makes hits exact, in
/// double, from positions of his own: the baker (bake/ray_scene.h) and the reference shader's eye
/// (libshade's reference/visibility.h).
///
/// All is in Embree's space: whoever fills in the positions scales them so that floats serve.
/// Triangles with a vertex that is not finite, or too far away for Embree, are left out; those
/// without area are never met. Robust: a ray between neighbours meets one of them. Safe to ask from
/// many threads. Tests: tests/mesh/rays/embree_scene_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace relief {

/// Sixteen rays, and what they hit. The layout is Embree's (RTCRayHit16), so that nothing is copied
/// on the way.
struct alignas(64) RayPacket {
    static constexpr std::size_t size = 16;
    static constexpr std::uint32_t nothing = 0xffffffff;

    std::array<float, size> origin_x, origin_y, origin_z, near;
    std::array<float, size> direction_x, direction_y, direction_z, time;
    std::array<float, size> far;  ///< Of a hit: where it is.
    std::array<std::uint32_t, size> mask, id, flags;
    std::array<float, size> normal_x, normal_y, normal_z, second, third;
    std::array<std::uint32_t, size> triangle, mesh, instance;

    [[nodiscard]] bool hits(std::size_t lane) const { return mesh[lane] != nothing; }
    /// After find_any().
    [[nodiscard]] bool is_blocked(std::size_t lane) const { return far[lane] < 0.0F; }
};

/// A piece of a line.
struct RaySegment {
    glm::vec3 origin{0.0F};
    glm::vec3 direction{0.0F};  ///< Of any length, which `near` and `far` count in.
    float near = 0.0F;
    float far = 0.0F;
};

struct MetTriangle {
    std::uint32_t mesh = 0;
    std::uint32_t triangle = 0;

    friend auto operator<=>(const MetTriangle&, const MetTriangle&) = default;
};

/// How much time is spent on making a scene ready. Hits are at the same places, but which of
/// triangles that coincide there, or meet in a corner, may differ.
enum class SceneBuild {
    thorough,  ///< For many rays.
    fast,      ///< A third of the time; each ray takes a fifth longer.
};

/// Where Embree has a mesh.
struct EmbreeBuffers {
    const float* vertices = nullptr;
    const glm::uvec3* corners = nullptr;
};

class EmbreeScene {
  public:
    explicit EmbreeScene(SceneBuild build = SceneBuild::thorough);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// Writes x, y and z of the vertices from `begin` to `end`, the first one to `xyz`; called in
    /// pieces, on several threads.
    using VertexFill = std::function<void(std::size_t begin, std::size_t end, float* xyz)>;

    /// \param name       what hits will call the mesh; no other has it
    /// \param triangles  must outlive the scene
    void add(std::uint32_t name, std::size_t vertex_count, const VertexFill& fill,
             std::span<const glm::uvec3> triangles);

    /// Once all are added, before anything is asked.
    void build();

    /// Finds the nearest hits of the first `count` rays of a packet. Fastest for rays that run side
    /// by side.
    void find_nearest(RayPacket& packet, std::size_t count) const;

    /// Finds out whether the first `count` rays hit anything, which is faster: is_blocked().
    void find_any(RayPacket& packet, std::size_t count) const;

    /// Appends every triangle that a segment meets, in no order, some of them perhaps twice.
    void find_all(const RaySegment& segment, std::vector<MetTriangle>& found) const;

    /// How far the nearest triangle is; infinity where there is none.
    /// \param enough  where one is as near as that, its distance will do: found sooner
    [[nodiscard]] float distance_from(const glm::vec3& point, float enough = 0.0F) const;

  private:
    RTCDeviceTy* device_;
    RTCSceneTy* scene_;
    SceneBuild build_;
    std::vector<EmbreeBuffers> meshes_;  ///< By name; without any where there is no such mesh.
};

}  // namespace relief
