// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is known about a surface where a ray meets it: interpolated attributes, and the normal by
/// interpolation or plane, bent by normal or bump map. World space, in double. A normal without
/// direction is (0,0,1); a map without direction leaves the interpolated normal.
/// Tests: tests/shade/reference/surface_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "reference/prepared_scene.h"
#include "reference/visibility.h"

namespace relief::reference {

struct Surface {
    glm::dvec3 position_world{0.0};
    glm::dvec3 normal_world{0.0, 0.0, 1.0};  ///< Unit, on the side that is seen.
    glm::dvec3 view_world{0.0, 0.0, 1.0};    ///< Unit, to the eye; the normal where it touches.
    glm::dvec2 texcoord{0.0};
    glm::dvec4 color{1.0};      ///< Of the vertices.
    bool has_texcoord = false;  ///< Else no texture shows.
};

/// Whether the hit shows the back of its triangle.
bool is_back(const PreparedScene& prepared, const Hit& hit);

Surface surface_at(const PreparedScene& prepared, const Hit& hit, const Material& material,
                   Trace& trace);

/// The same at a corner of the triangle that was hit, for light computed at vertices: nothing bends
/// its normal.
Surface surface_at_corner(const PreparedScene& prepared, const Hit& hit, int corner);

}  // namespace relief::reference
