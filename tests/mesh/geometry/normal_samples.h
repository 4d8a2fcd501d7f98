// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes, weights and calls for the tests of normals.
#pragma once

#include <cmath>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "support/shapes.h"

namespace relief::test {

inline constexpr glm::vec3 facing_up(0.0F, 0.0F, 1.0F);
inline constexpr NormalWeight all_weights[] = {
    NormalWeight::uniform, NormalWeight::area,        NormalWeight::angle,     NormalWeight::sine,
    NormalWeight::max,     NormalWeight::angle_edges, NormalWeight::area_angle};

// A unit vector in floats has an error of half a unit in the last place in each component: 6e-8 in
// total, or 3.4e-6 degrees.
inline constexpr double float_degrees = 4e-6;

inline std::vector<glm::vec3> normals_of(const Mesh& mesh, NormalWeight weight) {
    Report report;
    return vertex_normals(mesh.positions, mesh.triangles, weight, report);
}

inline std::vector<glm::vec3> normals_of(const Mesh& mesh, const NormalOptions& options) {
    Report report;
    return vertex_normals(mesh.positions, mesh.triangles, options, report);
}

/// A sphere with bumps of all sizes and no symmetry, so that no sum is exact by chance.
inline Mesh bumpy_ball() {
    Mesh mesh = test::sphere(64, 32);
    for (glm::vec3& p : mesh.positions) {
        const double bump = 1.0 + 0.1 * std::sin(7.3 * p.x + 1.0) * std::cos(5.1 * p.y - 3.7 * p.z);
        p = glm::vec3(glm::dvec3(p) * bump + glm::dvec3(0.1, 0.2, 0.3));
    }
    // The function removes the triangles without area at the poles.
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
        return mesh.positions[t.x] == mesh.positions[t.y] ||
               mesh.positions[t.y] == mesh.positions[t.z] ||
               mesh.positions[t.z] == mesh.positions[t.x];
    });
    return mesh;
}

}  // namespace relief::test
