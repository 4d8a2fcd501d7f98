// SPDX-License-Identifier: Apache-2.0
// Lights from a point: rows (position, 1 / range), (intensity, law).

#include <light_rows>
#include <highlight_row>
#include "light/irradiance.glsl"
#include <receive>

void add_point_lights(Surface surface, inout Lighting lighting) {
    for (int i = 0; i < point_light_count; ++i) {
        int row = first_point_row + point_light_rows * i;
        vec4 place = light_row(row);
        vec4 power = light_row(row + 1);
        vec3 to_light_world = place.xyz - surface.position_world;
        float reach = reach_of(to_light_world, place.w, power.w);
        receive(surface, direction_to(to_light_world), irradiance_of(power.rgb, reach),
                irradiance_of(highlight_power(row + 2, power.rgb), reach), lighting);
    }
}
