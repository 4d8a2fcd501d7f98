// SPDX-License-Identifier: Apache-2.0
// Lights from infinitely far away: rows (direction to the light), (irradiance).

#include <light_rows>
#include <highlight_row>
#include <receive>

void add_directional_lights(Surface surface, inout Lighting lighting) {
    for (int i = 0; i < directional_light_count; ++i) {
        int row = directional_light_rows * i;
        vec3 irradiance = light_row(row + 1).rgb;
        receive(surface, light_row(row).xyz, irradiance, highlight_power(row + 2, irradiance),
                lighting);
    }
}
