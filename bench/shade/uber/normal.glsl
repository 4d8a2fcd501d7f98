// SPDX-License-Identifier: Apache-2.0
// Replaces a part of shaders/normal.glsl: the map is behind a branch.

//@part perturbed implements normal
//@include "vector.glsl#normalized_or"
//@include <detail>
//@include <frame>
//@include <facing>

uniform int use_normal_map;

vec3 shading_normal() {
    vec3 up = vec3(0.0, 0.0, 1.0);
    if (use_normal_map == 0) return facing() * normalized_or(normal_world, up);
    vec3 bend = normal_tangent();
    bool holds_nothing = !(dot(bend, bend) > 1e-12);
    mat3 frame = world_from_tangent();
    vec3 bent_world = bend.x * frame[0] + bend.y * frame[1] + bend.z * frame[2];
    vec3 fallback = normalized_or(frame[2], up);
    return facing() * (holds_nothing ? fallback : normalized_or(bent_world, fallback));
}
