// SPDX-License-Identifier: Apache-2.0
/// \file
/// The separate checks of diagnose(). Object space, any unit.
///
/// Each check writes its results to arrays by element, in parallel, and counts them afterwards in
/// order, so no count depends on the number of threads.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "relief/mesh/diagnose.h"

namespace relief::detail {

/// Counts of conditions, one entry for each.
class Tally {
  public:
    /// \param listed  maximum number of elements listed per condition
    explicit Tally(std::size_t listed);

    /// Counts one element. Elements of one condition are added in ascending order. An element that
    /// is added again (a triangle with two such edges) is listed once.
    void add(MeshCondition condition, std::size_t index);

    /// Adds the counts of a tally with other conditions.
    void merge(const Tally& other);

    /// The conditions with a count above zero, in order.
    [[nodiscard]] std::vector<MeshConditionCount> found() const;

  private:
    std::size_t listed_;
    std::vector<MeshConditionCount> conditions_;
};

/// Shape of a single triangle.
enum class TriangleShape : std::uint8_t { sound, needle, collinear, collapsed, not_finite };

inline bool has_area(TriangleShape shape) {
    return shape <= TriangleShape::needle;
}

/// A mesh and the derived data that several checks use.
struct DiagnosedMesh {
    explicit DiagnosedMesh(const Mesh& diagnosed);

    const Mesh& mesh;
    std::vector<std::uint32_t> classes;  ///< weld_positions()
    std::vector<glm::uvec3> triangles;   ///< Triangles with the indices of position classes.
    std::vector<TriangleShape> shapes;
    std::vector<glm::vec3> normals;  ///< Unit normals of triangles; zero if the area is zero.
};

/// Checks single triangles.
void diagnose_triangles(const DiagnosedMesh& diagnosed, Tally& tally);

/// Checks duplicate and back-to-back triangles, edges and fans.
void diagnose_edges(const DiagnosedMesh& diagnosed, Tally& tally);

/// Checks positions, and whether triangles use them.
void diagnose_vertices(const DiagnosedMesh& diagnosed, Tally& tally);

/// Checks for nearly equal positions.
void diagnose_near_duplicates(const DiagnosedMesh& diagnosed, Tally& tally);

/// Checks stored normals and tangents.
void diagnose_frames(const DiagnosedMesh& diagnosed, Tally& tally);

/// Checks texture coordinates, except for overlaps.
void diagnose_texture(const DiagnosedMesh& diagnosed, Tally& tally);

struct TextureOverlap {
    std::vector<std::uint8_t> overlapping;  ///< Per triangle: 1 if it shares a texel.
    int raster = 0;                         ///< Texels along each side of the raster.
};

/// Finds triangles that share texels.
///
/// Texture coordinates are used as stored. Two triangles overlap if the center of a texel lies
/// inside both, at least a thousandth of a texel from every edge, so that rounding does not make
/// neighbors overlap. The raster covers the bounding box of all finite texture coordinates.
/// Triangles that are not finite or have no area in the image overlap nothing. The time is nearly
/// linear; see texture_overlap.cpp.
TextureOverlap texture_overlap(std::span<const glm::vec2> texcoords,
                               std::span<const glm::uvec3> triangles);

}  // namespace relief::detail
