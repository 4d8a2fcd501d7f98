// SPDX-License-Identifier: Apache-2.0
// Lights from infinitely far away: rows (direction to the light), (irradiance).

#include <light_rows>
#include "light/receive.glsl"

void add_directional_lights(Surface surface, inout Lighting lighting) {
    for (int i = 0; i < directional_light_count; ++i) {
        int row = first_directional_row + 2 * i;
        receive(surface, light_row(row).xyz, light_row(row + 1).rgb, lighting);
    }
}
