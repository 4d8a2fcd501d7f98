// SPDX-License-Identifier: Apache-2.0
// The normal of the triangle's own plane, from how the position changes from pixel to pixel, on the
// side that the eye sees: where the plane is nearly edge-on, the next pixel may lie beyond its
// horizon, which turns the differences round. (0,0,1) where it is edge-on.

#include "common/eye.glsl"
#include "common/normalized_or.glsl"
#include "common/rescaled.glsl"
#include <position>

vec3 shading_normal() {
    vec3 across = cross(rescaled(dFdx(position_world)), rescaled(dFdy(position_world)));
    vec3 normal = normalized_or(rescaled(across), vec3(0.0, 0.0, 1.0));
    return dot(normal, eye_world - position_world) < 0.0 ? -normal : normal;
}
