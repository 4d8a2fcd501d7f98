// SPDX-License-Identifier: Apache-2.0
// The normal in world space, unit at the vertex. The matrix is the inverse transpose of the
// object's, up to a positive factor; for a singular one it is what that tends to. A normal without
// length, or not finite, is passed as 0 and has no say between vertices.

#include "common/normalized_or.glsl"

in vec3 normal_object;
out vec3 normal_world;

uniform mat3 world_from_object_normal;

void pass_normal() {
    normal_world = normalized_or(world_from_object_normal * normal_object, vec3(0.0));
}
