// SPDX-License-Identifier: Apache-2.0
// Directional, point and spot lights. Each light is a few rows of four floats;
// libshade/src/effects/light_rows.h describes them. receive() is the material's: phong.glsl or
// metallic_roughness.glsl.

//@part lighting
// The sums of light at a point: scattered before the surface's tint, and highlights.

struct Lighting {
    vec3 scattered;
    vec3 highlights;
};

//@part all implements lights
// Adds all lights.

//@include <directional_lights>
//@include <point_lights>
//@include <spot_lights>

void add_lights(Surface surface, inout Lighting lighting) {
    add_directional_lights(surface, lighting);
    add_point_lights(surface, lighting);
    add_spot_lights(surface, lighting);
}

//@neutral lights
void add_lights(Surface surface, inout Lighting lighting) {}

//@part rows_block implements light_rows
// The rows in a uniform block.

layout(std140) uniform Lights {
    vec4 light_rows[light_row_count];
};

vec4 light_row(int index) { return light_rows[index]; }

//@part rows_buffer implements light_rows
// The rows in a buffer texture, for more lights than a uniform block holds.

//@include <buffers>

uniform samplerBuffer light_buffer;

vec4 light_row(int index) { return buffer_texel(light_buffer, index); }

//@part directional implements directional_lights
// Directional lights: rows (direction to the light), (irradiance).

//@include <light_rows>
//@include <highlight_row>
//@include <directional_shadow>
//@include <relief_share>
//@include <receive>

void add_directional_lights(Surface surface, inout Lighting lighting) {
    float first_share = directional_share(surface);
    for (int i = 0; i < directional_light_count; ++i) {
        int row = directional_light_rows * i;
        vec3 irradiance = light_row(row + 1).rgb;
        vec3 light_world = light_row(row).xyz;
        float share = relief_share(light_world, i == 0 ? first_share : 1.0);
        receive(surface, light_world, irradiance * share,
                highlight_power(row + 2, irradiance) * share, lighting);
    }
}

//@neutral directional_lights
void add_directional_lights(Surface surface, inout Lighting lighting) {}

//@part point implements point_lights
// Point lights: rows (position, 1 / range), (intensity, law).

//@include <light_rows>
//@include <highlight_row>
//@include "falloff.glsl#irradiance"
//@include <point_shadow>
//@include <relief_share>
//@include <receive>

void add_point_lights(Surface surface, inout Lighting lighting) {
    float first_share = point_share(surface);
    for (int i = 0; i < point_light_count; ++i) {
        int row = first_point_row + point_light_rows * i;
        vec4 place = light_row(row);
        vec4 power = light_row(row + 1);
        vec3 to_light_world = place.xyz - surface.position_world;
        float reach = reach_of(to_light_world, place.w, power.w);
        vec3 light_world = direction_to(to_light_world);
        float share = relief_share(light_world, i == 0 ? first_share : 1.0);
        receive(surface, light_world, irradiance_of(power.rgb, reach) * share,
                irradiance_of(highlight_power(row + 2, power.rgb), reach) * share, lighting);
    }
}

//@neutral point_lights
void add_point_lights(Surface surface, inout Lighting lighting) {}

//@part spot implements spot_lights
// Spot lights: rows (position, 1 / range), (intensity, law), (axis * cone scale, cone offset).
// Between the cones the light falls off with the square of scale * cosine + offset, which is 1 at
// the inner and 0 at the outer cone. Source: KHR_lights_punctual.

//@include <light_rows>
//@include <highlight_row>
//@include "falloff.glsl#irradiance"
//@include <spot_shadow>
//@include <relief_share>
//@include <receive>

void add_spot_lights(Surface surface, inout Lighting lighting) {
    float first_share = spot_share(surface);
    for (int i = 0; i < spot_light_count; ++i) {
        int row = first_spot_row + spot_light_rows * i;
        vec4 place = light_row(row);
        vec4 power = light_row(row + 1);
        vec4 cone = light_row(row + 2);
        vec3 to_light_world = place.xyz - surface.position_world;
        vec3 light_world = direction_to(to_light_world);
        float inside = clamp(dot(-light_world, cone.xyz) + cone.w, 0.0, 1.0);
        float reach = reach_of(to_light_world, place.w, power.w);
        vec3 highlights = highlight_power(row + 3, power.rgb);
        float share = relief_share(light_world, i == 0 ? first_share : 1.0);
        receive(surface, light_world, irradiance_of(power.rgb * (inside * inside), reach) * share,
                irradiance_of(highlights * (inside * inside), reach) * share, lighting);
    }
}

//@neutral spot_lights
void add_spot_lights(Surface surface, inout Lighting lighting) {}

//@part highlight_row implements highlight_row
// The color of a light's highlights: the last of its rows.

vec3 highlight_power(int row, vec3 power) { return light_row(row).rgb; }

//@neutral highlight_row
vec3 highlight_power(int row, vec3 power) { return power; }
