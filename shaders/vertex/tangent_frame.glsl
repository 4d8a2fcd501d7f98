// SPDX-License-Identifier: Apache-2.0
// Normal and tangent in world space, unit at the vertex, for a tangent-space normal map. Between
// vertices both are interpolated and stay as they come: that is the basis that bakers assume
// (MikkTSpace). handedness is -1 where the object's matrix mirrors, else +1.

#include "common/normalized_or.glsl"

in vec3 normal_object;
in vec4 tangent_object;
out vec3 normal_world;
out vec4 tangent_world;

uniform mat3 world_from_object_normal;
uniform mat3 world_from_object_tangent;
uniform float handedness;

void pass_normal() {
    normal_world = normalized_or(world_from_object_normal * normal_object, vec3(0.0));
    tangent_world.xyz = normalized_or(world_from_object_tangent * tangent_object.xyz, vec3(0.0));
    tangent_world.w = tangent_object.w * handedness;
}
