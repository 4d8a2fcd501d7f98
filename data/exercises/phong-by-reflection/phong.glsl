// SPDX-License-Identifier: Apache-2.0
// An exercise (../phong-by-reflection.json): a part of shaders/phong.glsl with a hole.

//@part phong implements specular
// The highlight around the light's mirror direction.

//@include "phong.glsl#cosine_power"
//@include <highlight_color>
//@include <sharpness>

uniform float shininess;

vec3 specular_highlight(Surface surface, vec3 light_world) {
    // TODO: mirror light_world at surface.normal_world, and compare it with surface.view_world.
    return vec3(0.0);
}
