// SPDX-License-Identifier: Apache-2.0
// By hand, for one directional light: what this scene takes and nothing else.

in vec3 position_object;
in vec3 normal_object;
in vec2 texcoord;

out vec3 normal_world;
out vec3 position_world;
out vec2 texcoord_surface;

uniform mat4 clip_from_object;
uniform mat3 world_from_object_normal;
uniform mat4 world_from_object;

void main() {
    gl_Position = clip_from_object * vec4(position_object, 1.0);
    normal_world = normalize(world_from_object_normal * normal_object);
    position_world = vec3(world_from_object * vec4(position_object, 1.0));
    texcoord_surface = texcoord;
}
