// SPDX-License-Identifier: Apache-2.0
/// \file
/// The meshes of the conformance kit, each small and for one property of tangents; the surfaces of
/// which they consist, and changes to them.
///
/// Object space, triangles, normals and texture coordinates (upper left origin, v down). The meshes
/// are computed from formulas and pseudo-random numbers, independently of relief's normals and
/// tangents. Values are computed in double and rounded once. Random numbers are those of
/// std::mt19937 without a standard distribution, so that they are the same on all machines. Tests:
/// tests/tools/conformance_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <random>
#include <string>
#include <vector>

#include "relief-mesh/conformance.h"
#include "relief/mesh/mesh.h"

namespace relief::conformance {

using tools::KitGroup;

struct KitMesh {
    std::string name;
    KitGroup group;
    std::string about;  ///< One sentence.
    Mesh mesh;
    std::vector<glm::uvec4> quads;  ///< Empty if the mesh does not consist of quads.
    bool is_indexed = true;         ///< Otherwise the file has three vertices per triangle.
};

/// All meshes of the kit. Every run computes the same bits.
std::vector<KitMesh> kit_meshes();

class Random {
  public:
    explicit Random(std::uint32_t seed) : generator_(seed) {}

    /// A number in [0, 1).
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

/// Rounds a texture coordinate to a multiple of 1/65536, so that 1 - (1 - v) is exactly v in
/// programs that invert v twice.
glm::vec2 invertible(const glm::dvec2& texcoord);

/// Appends a vertex with a unit normal and an invertible texture coordinate.
std::uint32_t add(Mesh& mesh, const Point& point);

/// A surface over [0,1]^2 with columns x rows cells. The diagonal of each cell is from its lower
/// left to its upper right corner. The front is that of cross(d/dx, d/dy).
Mesh patch(int columns, int rows, const std::function<Point(double x, double y)>& point);

/// Hills over [-1,1]^2, which face +z. The image is projected from above and upright.
Point hill(double x, double y);

/// `cells` x `cells` cells of hills.
Mesh hills(int cells);

/// The unit sphere by longitude and latitude, u eastwards. The poles have triangles without
/// collapsed ones.
Mesh sphere(int slices, int stacks);

/// A torus about the y axis, which the image covers once.
Mesh torus(int slices, int sides);

/// The cube from -1 to 1 with `cells` x `cells` cells per side. Each side has its own region of the
/// image; some regions are mirrored.
Mesh cube(int cells, bool is_smooth);

/// A closed fan of `count` triangles around one vertex.
Mesh fan(int count);

/// The mesh with three separate vertices per triangle.
Mesh soup(const Mesh& mesh);

/// Changes the texture coordinates. The results are made invertible.
Mesh retextured(Mesh mesh, const std::function<glm::dvec2(glm::dvec2)>& change);

}  // namespace relief::conformance
