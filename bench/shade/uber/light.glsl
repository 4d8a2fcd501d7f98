// SPDX-License-Identifier: Apache-2.0
// Replaces the part of shaders/light.glsl that adds all lights: each kind but directional lights is
// behind a branch.

//@part all implements lights
//@include <directional_lights>
//@include <point_lights>
//@include <spot_lights>

uniform int use_point_lights;
uniform int use_spot_lights;

void add_lights(Surface surface, inout Lighting lighting) {
    add_directional_lights(surface, lighting);
    if (use_point_lights != 0) add_point_lights(surface, lighting);
    if (use_spot_lights != 0) add_spot_lights(surface, lighting);
}
