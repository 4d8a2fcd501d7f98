// SPDX-License-Identifier: Apache-2.0
// The surface for highlights and reflections: normal, point, and the unit vector to the eye. Where
// the eye touches the surface, that vector is the normal.

#include "common/eye.glsl"
#include "common/normalized_or.glsl"
#include <position>
#include <normal>

struct Surface {
    vec3 normal_world;
    vec3 position_world;
    vec3 view_world;
};

Surface surface_here() {
    vec3 normal = shading_normal();
    return Surface(normal, position_world, normalized_or(eye_world - position_world, normal));
}
