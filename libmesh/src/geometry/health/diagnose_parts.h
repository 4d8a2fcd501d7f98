// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of diagnose(): each looks at one kind of element and counts what it finds.
///
/// Object space, any unit. Every part writes what it finds to arrays by element, in parallel, and
/// counts them afterwards in order: so no count depends on threads.
/// Tests: tests/mesh/geometry/health/diagnose_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "geometry/corners.h"
#include "relief/mesh/diagnose.h"

namespace relief {

/// What was counted, one entry for each condition.
class Tally {
  public:
    /// \param listed  how many elements of a condition are named
    explicit Tally(std::size_t listed);

    /// Counts one element. Elements of one condition come in ascending order; one that comes again
    /// (a triangle with two such edges) is named once.
    void add(MeshCondition condition, std::size_t index);

    /// Adds those of another that found different conditions.
    void merge(const Tally& other);

    /// The conditions that were found, in order.
    [[nodiscard]] std::vector<FoundCondition> found() const;

  private:
    std::size_t listed_;
    std::vector<FoundCondition> conditions_;
};

/// What a triangle is by itself.
enum class TriangleShape : std::uint8_t { sound, needle, collinear, collapsed, not_finite };

inline bool has_area(TriangleShape shape) {
    return shape <= TriangleShape::needle;
}

/// A mesh, and what several parts want to know about it.
struct Subject {
    explicit Subject(const Mesh& subject);

    const Mesh& mesh;
    std::vector<std::uint32_t> classes;  ///< weld_positions()
    std::vector<glm::uvec3> triangles;   ///< Over classes.
    std::vector<TriangleShape> shapes;
    std::vector<glm::vec3> normals;  ///< Of triangles: unit; zero where there is no area.
};

/// Triangles one by one.
void diagnose_triangles(const Subject& subject, Tally& tally);

/// Repeated and backed triangles; edges; fans.
void diagnose_edges(const Subject& subject, Tally& tally);

/// Positions one by one, and whether triangles use them.
void diagnose_vertices(const Subject& subject, Tally& tally);

/// Positions that are nearly equal.
void diagnose_near_duplicates(const Subject& subject, Tally& tally);

/// Stored normals and tangents.
void diagnose_frames(const Subject& subject, Tally& tally);

/// Texture coordinates, but for overlaps.
void diagnose_texture(const Subject& subject, Tally& tally);

}  // namespace relief
