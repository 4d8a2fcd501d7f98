// SPDX-License-Identifier: Apache-2.0
// The normal from a map in object space; the interpolated one where the map holds nothing.

#include "common/normalized_or.glsl"
#include "detail/normal_texel.glsl"
#include <facing>

in vec3 normal_world;

uniform mat3 world_from_object_normal;

vec3 shading_normal() {
    vec3 normal_object = normal_texel();
    vec3 mapped_world = world_from_object_normal * normal_object;
    bool maps = dot(normal_object, normal_object) > 1e-12 && has_direction(mapped_world);
    return facing() * normalized_or(maps ? mapped_world : normal_world, vec3(0.0, 0.0, 1.0));
}
