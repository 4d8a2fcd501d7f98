// SPDX-License-Identifier: Apache-2.0
// Lights from a point within a cone: rows (position, 1 / range), (intensity, cone scale), (axis,
// cone offset). Between the cones the light falls off with the square of scale * cosine + offset,
// which is 1 at the inner and 0 at the outer. Source: KHR_lights_punctual.

#include <light_rows>
#include "light/irradiance.glsl"
#include "light/receive.glsl"

void add_spot_lights(Surface surface, inout Lighting lighting) {
    for (int i = 0; i < spot_light_count; ++i) {
        int row = first_spot_row + 3 * i;
        vec4 place = light_row(row);
        vec4 intensity = light_row(row + 1);
        vec4 axis = light_row(row + 2);
        vec3 to_light_world = place.xyz - surface.position_world;
        vec3 light_world = direction_to(to_light_world);
        float share = clamp(dot(-light_world, axis.xyz) * intensity.w + axis.w, 0.0, 1.0);
        receive(surface, light_world,
                irradiance_from(to_light_world, intensity.rgb * (share * share), place.w), lighting);
    }
}
