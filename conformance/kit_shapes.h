// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the kit's meshes are made from: surfaces by formula, and changes to them.
///
/// Object space. Computed in double and rounded once; random numbers come from the generator that
/// the C++ standard fixes, by a rule of our own, so that every machine draws the same.
/// Tests: tests/tools/conformance_kit_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <random>

#include "relief/mesh/mesh.h"

namespace relief::conformance {

class Random {
  public:
    explicit Random(std::uint32_t seed) : generator_(seed) {}

    /// From 0 to 1.
    double unit() { return static_cast<double>(generator_()) / 4294967296.0; }

    std::uint32_t below(std::uint32_t limit) {
        return static_cast<std::uint32_t>(generator_()) % limit;
    }

  private:
    std::mt19937 generator_;
};

struct Point {
    glm::dvec3 position;
    glm::dvec3 normal;  ///< Any length.
    glm::dvec2 texcoord;
};

/// A texture coordinate that survives being turned over twice, as programs do in which v runs up:
/// 1 - (1 - v) is v again. A multiple of 1/65536.
glm::vec2 survivor(const glm::dvec2& texcoord);

/// Appends a vertex, its normal made unit, its texture coordinate a survivor.
std::uint32_t add(Mesh& mesh, const Point& point);

/// A surface over [0,1]^2 in columns x rows cells, each cut from its lower left to its upper
/// right corner: what is to the left of growing x, as y grows, is its front.
Mesh patch(int columns, int rows, const std::function<Point(double x, double y)>& point);

/// Hills over [-1,1]^2, seen from +z; the image upright on it from above.
Point hill(double x, double y);

/// `cells` x `cells` cells of hills.
Mesh hills(int cells);

/// The unit sphere by longitude and latitude, u eastwards; triangles at the poles, no collapsed
/// ones.
Mesh sphere(int slices, int stacks);

/// A torus about the y axis, its image once around.
Mesh torus(int slices, int sides);

/// The cube from -1 to 1, `cells` x `cells` on every side, every side with a place of its own in
/// the image; some of those are mirrored.
Mesh cube(int cells, bool is_smooth);

/// `count` triangles all the way around one vertex.
Mesh fan(int count);

/// Three vertices of its own for every triangle.
Mesh soup(const Mesh& mesh);

/// Replaces the texture coordinates by survivors.
Mesh retextured(Mesh mesh, const std::function<glm::dvec2(glm::dvec2)>& change);

}  // namespace relief::conformance
