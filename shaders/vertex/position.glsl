// SPDX-License-Identifier: Apache-2.0
// The point in world space: for lights that have a place, and for the way to the eye.

out vec3 position_world;

uniform mat4 world_from_object;

void pass_position() { position_world = vec3(world_from_object * vec4(position_object, 1.0)); }
