// SPDX-License-Identifier: Apache-2.0
// Declarations that several files share.

//@part position implements position
// The fragment's position.

in vec3 position_world;

//@neutral position
// The vertex stage has written position_world in pass_position().

//@part texcoord
// The fragment's texture coordinates.

in vec2 texcoord_surface;

//@part texcoord_2 implements second_texcoord
// The fragment's second texture coordinates. Lookups at texcoord_surface are changed to these for the
// textures that need it.

in vec2 texcoord_surface_2;

//@neutral second_texcoord
// Textures are looked up at one set of texture coordinates.

//@part eye
// The vector to the camera, in homogeneous coordinates: (x,y,z,1) is the position of a perspective
// camera, (x,y,z,0) the direction to an orthographic one.

uniform vec4 eye_world;

vec3 to_eye(vec3 position_world) { return eye_world.xyz - eye_world.w * position_world; }

//@part clip
// The projection of the camera.

uniform mat4 clip_from_world;

//@part diffuse_color
// The share of light that the surface scatters.

uniform vec3 diffuse_color;

//@part normal
// The interpolated normal, neither normalized nor turned to the visible side.

in vec3 normal_world;

//@part ambient
// The scattered share of ambient light. For glTF's model, the ambient light itself.

uniform vec3 ambient_scattered;

//@part min_roughness
// The smallest roughness of glTF's facets.

const float min_roughness = 0.045;
