// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where the lines of a bake meet the high meshes: the surface that belongs to a point of the low
/// one. Space and unit of the meshes. Tests: tests/mesh/bake/projection_test.cpp.
///
/// *The rule.* A line runs through a point P along an outward direction. Walking outwards from P,
/// triangles are passed from behind (the line leaves a solid) or from the front (it enters one).
/// Once outside of all, the surface that was left last is the one wanted, and the walk ends where
/// the line enters another solid: what lies beyond belongs to somewhere else. How deep inside P is
/// shows on the way: where the first triangle met is an entry, P is outside if what lies inwards of
/// it faces it, else within two solids that pass through each other, and both must be left. Where
/// no surface was left, P lies outside, and it is the first surface inwards that faces P.
///
/// One ray from outside finds the first hit, and whether the line meets anything between that hit
/// and P. Where it does not, which is nearly always so, the first hit is the surface wanted. Else
/// the line is walked triangle by triangle.
#pragma once

#include <span>
#include <vector>

#include "bake/ray_scene.h"
#include "relief/mesh/bake.h"

namespace relief {

/// Through a point, from outside to inside.
struct ProjectionLine {
    glm::dvec3 point{0.0};
    glm::dvec3 outward{0.0};  ///< Unit; zero: there is no line, and nothing is hit.
    double outside = 0.0;     ///< How far it reaches from the point.
    double inside = 0.0;
};

/// Where a line meets the surface that belongs to it.
struct ProjectedPoint {
    RayHit hit;           ///< As seen from outside.
    double height = 0.0;  ///< Outwards from the line's point.
};

class Projection {
  public:
    Projection(const RayScene& scene, BackFaces back_faces);

    /// Finds the surface for all lines; neighbours in order are fastest. \return rays cast
    std::size_t find(std::span<const ProjectionLine> lines, std::span<ProjectedPoint> points) const;

    /// A ray so far inside of an open border of the high meshes does not slip past it.
    [[nodiscard]] double least_from_border() const { return step_; }

  private:
    struct Walk;

    /// \return the lines whose first hit may not be the surface wanted
    std::vector<std::size_t> find_from_outside(std::span<const ProjectionLine> lines,
                                               std::span<ProjectedPoint> points) const;
    std::size_t walk(const ProjectionLine& line, ProjectedPoint& point) const;

    const RayScene& scene_;
    BackFaces back_faces_;
    double step_;  ///< By which rays pass what they have met.
};

}  // namespace relief
