// SPDX-License-Identifier: Apache-2.0
// Lights from a point: rows (position, 1 / range), (intensity).

#include <light_rows>
#include "light/irradiance.glsl"
#include "light/receive.glsl"

void add_point_lights(Surface surface, inout Lighting lighting) {
    for (int i = 0; i < point_light_count; ++i) {
        int row = first_point_row + 2 * i;
        vec4 place = light_row(row);
        vec3 to_light_world = place.xyz - surface.position_world;
        receive(surface, direction_to(to_light_world),
                irradiance_from(to_light_world, light_row(row + 1).rgb, place.w), lighting);
    }
}
