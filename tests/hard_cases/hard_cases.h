// SPDX-License-Identifier: Apache-2.0
/// \file
/// The catalogue of hard cases: inputs that break naive code, each with the outcome that relief
/// promises, step by step. hard_cases_test.cpp runs every row, and docs/hard-cases.md is written
/// from the same table.
///
/// A row is plain data. An expectation is the name of a step, the outcome in words, and a function
/// that returns the problem, or an empty string.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

/// The expected outcome of one step for a hard input.
struct Expectation {
    std::string step;                      ///< "check", "normals", ...
    std::string outcome;                   ///< For the page: "each unit; 1 x isolated vertex".
    std::function<std::string()> problem;  ///< Returns the difference from the expected outcome, or
                                           ///< an empty string.
};

struct HardCase {
    std::string name;    ///< A fixed name: "needle triangle".
    std::string what;    ///< The input, in a sentence for the page.
    std::string source;  ///< The source that describes the case.
    std::vector<Expectation> expectations;
    std::function<Mesh()> mesh{};  ///< The input if it is a mesh, otherwise empty.
};

/// All rows. Meshes and their normals come first.
const std::vector<HardCase>& hard_cases();

std::vector<HardCase> triangle_cases();  ///< Triangles with an area of zero or close to it.
std::vector<HardCase> surface_cases();   ///< Adjacent triangles.
std::vector<HardCase> number_cases();    ///< Scale, position, rounding and non-finite values.
std::vector<HardCase> stored_cases();    ///< Normals, tangents and texture coordinates from a file.
std::vector<HardCase> tangent_cases();   ///< Texture layouts.
std::vector<HardCase> tangent_surface_cases();  ///< Surfaces below a texture.
std::vector<HardCase> encoding_cases();         ///< Encoded frames.

std::vector<HardCase> image_cases();       ///< Heights and the normals computed from them.
std::vector<HardCase> image_file_cases();  ///< Image files, with and without heights.
std::vector<HardCase> normal_map_cases();  ///< Normals without slope, direction, z or length.
std::vector<HardCase> map_check_cases();   ///< The convention of a map, its heights, and the owner
                                           ///< of each texel.
std::vector<HardCase> bake_cases();        ///< Rays, and the surfaces that they hit or miss.
std::vector<HardCase> bake_shape_cases();  ///< Shapes of high and low meshes, and of maps.

/// Returns the whole page in Markdown.
std::string hard_cases_page();

}  // namespace relief::test
