// SPDX-License-Identifier: Apache-2.0
/// \file
/// The high meshes of a bake: rays into all of them, and what is known where one hits. Each
/// attribute is a function of a hit, made ready only if it is wanted.
/// Tests: tests/mesh/bake/bake_test.cpp, high_detail_test.cpp.
#pragma once

#include <memory>
#include <vector>

#include "bake/ray_scene.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

class HighSurface {
  public:
    /// The meshes, and what the options name, must outlive this. Meshes without normals get
    /// averaged ones (frames.h), those with normal maps MikkTSpace's tangents where they have none.
    /// \throws InvalidInput if one is not valid
    HighSurface(std::span<const Mesh> meshes, const BakeOptions& options, Report& report);

    [[nodiscard]] const RayScene& scene() const { return *scene_; }

    /// Unit, interpolated; where it has no direction, the triangle's own, and counted.
    [[nodiscard]] glm::dvec3 smooth_normal(const RayHit& hit, std::size_t sample,
                                           Report& found) const;

    /// The same with the mesh's normal map on top, if normals are wanted.
    [[nodiscard]] glm::dvec3 normal(const RayHit& hit, std::size_t sample, Report& found) const;

    /// The triangle's own, unit.
    [[nodiscard]] glm::dvec3 face_normal(const RayHit& hit) const;

    [[nodiscard]] glm::dvec3 position(const RayHit& hit) const;

    /// If wanted: mean curvature, interpolated; positive where it bulges to the front.
    [[nodiscard]] double curvature(const RayHit& hit) const;

    /// If wanted: linear RGB; white where the mesh has none.
    [[nodiscard]] glm::dvec3 color(const RayHit& hit) const;

    /// Over all meshes, if wanted: what most of their area does not exceed, and none of it does.
    struct CurvatureRange {
        double usual = 0.0;  ///< On 99% of the area.
        double greatest = 0.0;
    };
    [[nodiscard]] CurvatureRange curvature_range() const;

    /// Of any position, in size, in other axes: at most this.
    [[nodiscard]] double largest_coordinate(const glm::dmat4& axes_from_mesh) const;

  private:
    /// A mesh and what hangs on it.
    struct Entry {
        const Mesh* mesh = nullptr;
        const HighDetail* detail = nullptr;  ///< None where nothing asks for it.
        std::span<const glm::vec2> color_texcoords;
        std::vector<glm::vec2> split_texcoords;  ///< The same, where vertices were split.
        std::vector<float> curvature;            ///< By vertex.
    };
    [[nodiscard]] Entry entry(const Mesh& mesh, std::size_t index, const BakeOptions& options,
                              Report& report);
    [[nodiscard]] const HighMaterial* material(const RayHit& hit) const;
    /// Whatever a bake can read of a triangle, in an order that does not depend on which of its
    /// corners is the first one.
    [[nodiscard]] std::vector<std::uint32_t> attributes(const MetTriangle& met) const;

    std::vector<Mesh> made_;  ///< Those that had to be given normals or tangents.
    std::vector<Entry> entries_;
    std::unique_ptr<RayScene> scene_;
};

}  // namespace relief
