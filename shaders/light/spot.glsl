// SPDX-License-Identifier: Apache-2.0
// Lights from a point within a cone: rows (position, 1 / range), (intensity, law), (axis * cone
// scale, cone offset). Between the cones the light falls off with the square of scale * cosine +
// offset, which is 1 at the inner and 0 at the outer. Source: KHR_lights_punctual.

#include <light_rows>
#include <highlight_row>
#include "light/irradiance.glsl"
#include <receive>

void add_spot_lights(Surface surface, inout Lighting lighting) {
    for (int i = 0; i < spot_light_count; ++i) {
        int row = first_spot_row + spot_light_rows * i;
        vec4 place = light_row(row);
        vec4 power = light_row(row + 1);
        vec4 cone = light_row(row + 2);
        vec3 to_light_world = place.xyz - surface.position_world;
        vec3 light_world = direction_to(to_light_world);
        float share = clamp(dot(-light_world, cone.xyz) + cone.w, 0.0, 1.0);
        float reach = reach_of(to_light_world, place.w, power.w);
        vec3 highlights = highlight_power(row + 3, power.rgb);
        receive(surface, light_world, irradiance_of(power.rgb * (share * share), reach),
                irradiance_of(highlights * (share * share), reach), lighting);
    }
}
