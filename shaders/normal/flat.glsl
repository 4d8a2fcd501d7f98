// SPDX-License-Identifier: Apache-2.0
// The normal of the triangle's own plane, from how the position changes from pixel to pixel. It
// faces the eye, on back faces as well. (0,0,1) where the plane is seen edge-on.

#include "common/normalized_or.glsl"
#include "common/rescaled.glsl"
#include <position>

vec3 shading_normal() {
    vec3 across = cross(rescaled(dFdx(position_world)), rescaled(dFdy(position_world)));
    return normalized_or(rescaled(across), vec3(0.0, 0.0, 1.0));
}
