// SPDX-License-Identifier: Apache-2.0
/// \file
/// Material's formula (material.h), term by term, in double precision. World space, linear light.
/// Tests: tests/shade/reference/shading_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "reference/prepared_scene.h"
#include "reference/visibility.h"

namespace relief::reference {

/// What a surface sends to the eye.
struct Shaded {
    glm::dvec3 radiance{0.0};  ///< May be anything where the scene's data is.
    double alpha = 1.0;        ///< As Material says, whatever the alpha mode.
};

Shaded shade(const PreparedScene& prepared, const Hit& hit, const Material& material, Trace& trace);

}  // namespace relief::reference
