// SPDX-License-Identifier: Apache-2.0
// The environment behind everything.

//@part vertex
// One triangle over the whole picture, at the far end of depth, with the view direction of each
// pixel. Needs no vertex attributes.

out vec3 direction_world;

uniform mat3 world_from_screen;  // Of (x, y, 1), x and y from -1 to 1.

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    direction_world = world_from_screen * vec3(corner, 1.0);
    gl_Position = vec4(corner, 1.0, 1.0);
}

//@part fragment

in vec3 direction_world;
out vec4 color;

//@include <sky>
//@include <output>

void main() { color = vec4(coded(sky_radiance(direction_world)), 1.0); }

//@part sharp implements sky
// The environment as it is.

//@include "environment.glsl#radiance"

vec3 sky_radiance(vec3 direction_world) { return environment_radiance(direction_world); }

//@part blurred implements sky
// The environment as a rough mirror shows it.

//@include "environment.glsl#blurred"

uniform float skybox_blur;

vec3 sky_radiance(vec3 direction_world) { return blurred_radiance(direction_world, skybox_blur); }
