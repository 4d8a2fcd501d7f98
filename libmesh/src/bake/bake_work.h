// SPDX-License-Identifier: Apache-2.0
/// \file
/// The internal interface of the baker: the low mesh, the high meshes by part, and the baking of
/// rows of texels. bake.cpp prepares the meshes and bakes a map strip by strip; bake_rows.cpp bakes
/// the rows of a strip. Tests: tests/mesh/bake/baker_test.cpp, bake_test.cpp, padding_test.cpp.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/high_surface.h"
#include "bake/ray_scene.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_shards.h"

namespace relief::detail {

/// The low-poly mesh of a bake: positions and projection lines of texels. All values are in the
/// space and unit of the meshes, in double.
class LowSurface {
  public:
    /// \throws InvalidInput as bake_normals()
    LowSurface(const Mesh& low, const BakeOptions& options, Report& report);

    /// Returns the mesh with the frames that renderers of the map use.
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }

    /// Returns the line along which a texel is projected onto the high meshes.
    /// \param sample  the texel index for findings
    [[nodiscard]] ProjectionLine line(const CoveredTexel& texel, const BakeDistances& distances,
                                      std::size_t sample, Report& report) const;

    /// Returns the position of a texel on the mesh.
    [[nodiscard]] glm::dvec3 position(const CoveredTexel& texel) const {
        return interpolated(mesh_.positions, texel);
    }

    /// Returns whether rays start on a cage.
    [[nodiscard]] bool has_cage() const { return !cage_.empty(); }
    /// Returns the largest distance of a cage vertex from its mesh vertex; 0 without a cage.
    [[nodiscard]] double cage_reach() const;

  private:
    [[nodiscard]] glm::dvec3 direction(const CoveredTexel& texel, std::size_t sample,
                                       Report& report) const;
    [[nodiscard]] glm::dvec3 interpolated(std::span<const glm::vec3> values,
                                          const CoveredTexel& texel) const;

    Mesh mesh_;
    std::vector<glm::vec3> directions_;  ///< By vertex; empty for face normals.
    std::vector<glm::vec3> cage_;        ///< Cage positions by corner.
    std::optional<double> cage_inside_;  ///< Ray length behind the surface.
};

/// Moves a sample to at least `distance` from every edge of its triangle. If the triangle is too
/// small, the sample moves to the incenter. Returns none if the sample is far enough inside
/// already, or if its triangle has no area or is not finite.
///
/// A texel that only touches a chart has its nearest point exactly on an edge. If the high mesh has
/// an open border there, rounding decides whether a ray through that point hits it. A point further
/// inside than the rounding errors has no such problem.
std::optional<CoveredTexel> moved_inside(const Mesh& mesh, const CoveredTexel& texel,
                                         double distance);

/// The high meshes that some triangles of the low mesh see, and the length of their rays.
struct SeenSurface {
    /// \param low    the triangles that see the meshes; their distance determines the ray length
    /// \param reach  the length of rays from a cage; 0 without a cage
    /// \param name   the name of the part, for messages
    /// \throws BakeMismatch
    SeenSurface(std::span<const Mesh> meshes, const Mesh& low, const BakeOptions& options,
                double reach, const std::string& name, Report& report);

    BakeFit fit;
    double extent;  ///< The largest possible distance between a high and a low point.
    HighSurface high;
    BakeDistances distances;
};

/// The high meshes of a bake by part. Each part has its own ray scene, so rays do not test meshes
/// that the part does not see.
class BakeParts {
  public:
    /// One part: all triangles see all meshes.
    BakeParts(std::span<const Mesh> high, const LowSurface& low, const BakeOptions& options,
              Report& report);

    /// \throws InvalidInput if a triangle of `low` is not in exactly one part
    BakeParts(std::span<const BakePart> parts, const LowSurface& low, const BakeOptions& options,
              Report& report);

    /// Returns the surface that texels of a triangle of the low mesh see.
    [[nodiscard]] const SeenSurface& surface_of(std::uint32_t triangle) const {
        return *surfaces_[part_of_triangle_.empty() ? 0 : part_of_triangle_[triangle]];
    }

    /// Returns what blocks the rays of occlusion from points of a surface.
    [[nodiscard]] const RayScene& occluders(const SeenSurface& surface) const {
        return occluders_ ? *occluders_ : surface.high.scene();
    }

    [[nodiscard]] BakeDistances largest_distances() const;
    /// Returns the comparison of the boxes around all parts.
    [[nodiscard]] BakeFit fit() const;
    /// Returns the bounds of layers other than heights.
    [[nodiscard]] LayerBounds bounds(const BakeLayers& layers) const;
    [[nodiscard]] const std::vector<SurfaceId>& ids() const { return ids_; }

  private:
    /// Numbers the ids of all parts, if they are requested.
    void number_ids(const BakeOptions& options);

    std::vector<std::unique_ptr<SeenSurface>> surfaces_;
    std::vector<SurfaceId> ids_;
    std::vector<std::uint32_t> part_of_triangle_;  ///< Empty if there is only one part.
    std::unique_ptr<RayScene> occluders_;          ///< All meshes, with BakeOptions::parts_occlude.
};

/// Measures the agreement of the surfaces with a few rays, and searches for a correction if they do
/// not agree.
BakeAgreement agreement_of(const BakeParts& parts, const LowSurface& low,
                           const BakeOptions& options);

/// Reports surfaces that do not agree; see Baker::agreement().
void report_agreement(const BakeAgreement& agreement, const BakeOptions& options, Report& report);

/// Returns the units that would explain a ratio of sizes, as a question; empty if there are none.
std::string unit_cause(double size_ratio);

/// The input that all rows of a map share.
struct BakeWork {
    const BakeParts& parts;
    const LowSurface& low;
    const BakeOptions& options;
    const BakeMapOptions& map;
    int side = 1;  ///< Samples along each side of a texel.
};

/// Returns a direction in the space of the map: unit, or zero if it has none. Absent where the low
/// mesh has no tangent frame.
/// \param texel  the point of the low mesh
std::optional<glm::dvec3> in_output_space(const BakeWork& work, const CoveredTexel& texel,
                                          const glm::dvec3& direction);

/// Bakes rows of texels in parallel, from the owners of their samples to the texel means.
///
/// \param first_row  the index of the first texel row
/// \param owners     the owners of all samples of these rows
/// \param rows       gets the result
BakeCounts bake_rows(const BakeWork& work, int first_row, std::span<const CoveredTexel> owners,
                     const BakedRows& rows, Report& report);

}  // namespace relief::detail
