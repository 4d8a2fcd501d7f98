// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on unwrapping: how much texture coordinates stretch the surface, and how many texels
/// of the map stay unused. Tests: tests/accuracy/unwrapping_experiments_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "experiment_driver.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"

namespace relief::accuracy::detail {

/// A sphere of radius 1 with waves of two lengths, without poles: the six sides of a cube, each of
/// `cells` x `cells` squares. Its texture coordinates are those of the sides, side by side, so that
/// vertices on the edges of the cube exist two or three times.
/// \param noise  standard deviation of the radius at each vertex
Mesh wavy_sphere(int cells, double noise);

/// A flat gear with sharp edges: positions and triangles.
/// \param cells  squares along each flank, and rings of the two flat sides
Mesh gear_wheel(int teeth, int cells);

/// The stretch of texture coordinates in percent, at points that are spread evenly over the
/// surface: how much longer or shorter a short line on the surface becomes in the map at most,
/// compared with the mean density of texels. A triangle without area in the map is undefined.
/// \param corner_texcoords  three for each triangle
ErrorStats stretch_errors(const Mesh& mesh, std::span<const glm::vec2> corner_texcoords,
                          const glm::ivec2& size);

/// Compares the choices that change charts by their stretch.
/// \param mesh  with texture coordinates, existing charts are compared as well
/// \param description  "sphere with waves"
PreparedExperiment unwrapping_stretch(Mesh mesh, const std::string& description, int size);

}  // namespace relief::accuracy::detail
