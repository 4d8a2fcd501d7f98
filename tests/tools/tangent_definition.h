// SPDX-License-Identifier: Apache-2.0
/// \file
/// MikkTSpace's definition once more, in its plainest form: double precision, every corner against
/// every other at its vertex. It shares no code with relief's tangents, so that expected results
/// have a second witness; and it can be made wrong in ways in which programs are.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

/// The deviation from the definition.
enum class Twist {
    none,
    area_weights,   ///< Triangles count by area, not by the angle of the corner.
    across_mirrors  ///< Triangles of both handednesses are averaged together.
};

/// Three per triangle, glTF's convention. Only for triangles with an area in space and in the
/// image, edges of two triangles at most, and textures that nowhere fold back on themselves.
std::vector<glm::vec4> tangents_by_definition(const Mesh& mesh, Twist twist = Twist::none);

}  // namespace relief::test
