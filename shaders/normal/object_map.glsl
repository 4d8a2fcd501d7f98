// SPDX-License-Identifier: Apache-2.0
// The normal from a map in object space; the interpolated one where the map holds nothing.

#include "common/normalized_or.glsl"
#include "detail/normal_texel.glsl"
#include <facing>

in vec3 normal_world;

uniform mat3 world_from_object_normal;

vec3 shading_normal() {
    vec3 normal_object = normal_texel();
    vec3 fallback = normalized_or(normal_world, vec3(0.0, 0.0, 1.0));
    bool holds_nothing = !(dot(normal_object, normal_object) > 1e-12);
    vec3 mapped_world = normalized_or(world_from_object_normal * normal_object, fallback);
    return facing() * (holds_nothing ? fallback : mapped_world);
}
