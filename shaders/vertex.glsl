// SPDX-License-Identifier: Apache-2.0
// Vertex attributes that the fragment stage needs, transformed to world space.

#part position
// The position in world space: for point and spot lights, and for the direction to the eye.

out vec3 position_world;

uniform mat4 world_from_object;

void pass_position() { position_world = vec3(world_from_object * vec4(position_object, 1.0)); }

#part normal
// The normal in world space, unit length at the vertex. The matrix is the inverse transpose of the
// object's, up to a positive factor; for a singular matrix it is the limit of that. A zero or
// non-finite normal is passed as 0, so that it does not contribute between vertices.

#include "vector.glsl#normalized_or"

in vec3 normal_object;
out vec3 normal_world;

uniform mat3 world_from_object_normal;

void pass_normal() {
    normal_world = normalized_or(world_from_object_normal * normal_object, vec3(0.0));
}

#part normal_and_tangent
// Normal and tangent in world space, unit length at the vertex, for a tangent-space normal map. The
// interpolated vectors are used without normalization: bakers assume that basis (MikkTSpace).
// handedness is -1 if the object's matrix mirrors, else +1.

#include "vector.glsl#normalized_or"

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

#part texcoord
// Texture coordinates: (0,0) is the image's upper left corner, v grows downwards.

in vec2 texcoord;
out vec2 texcoord_surface;

void pass_texcoord() { texcoord_surface = texcoord; }

#part texcoord_2
// The second texture coordinates.

in vec2 texcoord_2;
out vec2 texcoord_surface_2;

void pass_texcoord_2() { texcoord_surface_2 = texcoord_2; }

#part color
// The vertex color, linear, and its alpha, as their distance from white: a rasterizer interpolates
// 0 exactly, but 1 as 1 - 6e-8, which would let a mask with cutoff 1 cut holes.

in vec4 color_linear;
out vec4 color_from_white;

void pass_color() { color_from_white = color_linear - vec4(1.0); }
