// SPDX-License-Identifier: Apache-2.0
/// \file
/// Projection of points of the low mesh onto the high meshes: how far rays run, and which hit
/// counts. All values are in the space and unit of the meshes. Tests:
/// tests/mesh/bake/ray_scene_test.cpp, bake_test.cpp.
///
/// *The rule.* A line runs through a point P along an outward direction. Walking outwards from P,
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

#include <span>
#include <vector>

#include "bake/ray_scene.h"
#include "relief/mesh/bake.h"

namespace relief {

/// A line through a point of the low mesh, from outside to inside.
struct ProjectionLine {
    glm::dvec3 point{0.0};
    glm::dvec3 outward{0.0};  ///< Unit; zero means that nothing is hit.
    double outside = 0.0;     ///< Length on the outer side of the point.
    double inside = 0.0;      ///< Length on the inner side.
};

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

/// automatic_distances() with an existing scene of the high meshes.
BakeDistances distances_between(std::span<const Mesh> high, const RayScene& high_scene,
                                const Mesh& low);

/// Returns the length of the diagonal of a box.
double diagonal(const Bounds& box);

/// compare_boxes() for existing boxes.
BakeFit compare_boxes(const Bounds& high, const Bounds& low);

}  // namespace relief
