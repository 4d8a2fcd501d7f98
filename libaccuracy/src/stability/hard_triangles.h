// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles of the hard-case catalogue, laid into a sound mesh where they change nothing of the
/// surface: what has no area, no place or a back. Tests: tests/accuracy/hard_triangles_test.cpp.
#pragma once

#include <array>
#include <cstddef>

#include "relief/mesh/mesh.h"

namespace relief {

enum class HardTriangle {
    collapsed,   ///< Names one vertex twice.
    coinciding,  ///< Has two corners at one place.
    needle,      ///< A third corner in the middle of an edge, as near as floats come.
    nowhere,     ///< A corner that is not a number.
    back,        ///< Lies on another, turned over.
};

struct HardTriangleWords {
    HardTriangle kind;
    const char* id;
    const char* title;
};
inline constexpr std::array hard_triangle_words = {
    HardTriangleWords{HardTriangle::collapsed, "collapsed", "Triangles that name a vertex twice"},
    HardTriangleWords{HardTriangle::coinciding, "coinciding",
                      "Triangles with two corners at one place"},
    HardTriangleWords{HardTriangle::needle, "needle", "Needles along an edge"},
    HardTriangleWords{HardTriangle::nowhere, "nowhere",
                      "Triangles with a corner that is no number"},
    HardTriangleWords{HardTriangle::back, "back", "Triangles with another on their back"},
};

/// The mesh and `count` such triangles more, spread evenly over its own; of `back` at most one for
/// each. Its own vertices and triangles stay the first ones. Only positions and triangles are in
/// it.
Mesh with_hard_triangles(const Mesh& mesh, HardTriangle kind, std::size_t count);

}  // namespace relief
