// SPDX-License-Identifier: Apache-2.0
// Fibers on top of glTF's surfaces, as of velvet: they reflect light at grazing angles, and the
// surface gets the rest. Source: KHR_materials_sheen, [Estevez and Kulla 2017].

//@part layer implements sheen
// The sheen over the radiance of the surface without its emission. A table over sqrt(n.v) has the
// share of even light that white fibers reflect.

//@include <sheen_lights>
//@include <sheen_ambient>
//@include <sheen_environment>
//@include <sheen_color_texture>
//@include <sheen_albedo>

uniform vec3 sheen_color;

float sheen_albedo_at(float n_dot_v) {
    float place = 31.0 * sqrt(n_dot_v);
    int first = min(int(place), 30);
    return mix(sheen_entry(first), sheen_entry(first + 1), place - float(first));
}

vec3 with_sheen(Surface surface, vec3 radiance) {
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    float albedo = sheen_albedo_at(n_dot_v);
    vec3 color = sheen_color * sheen_color_texel();
    float largest = max(max(color.r, color.g), color.b);
    vec3 around = sheen_from_ambient() + sheen_from_environment(surface);
    return radiance * (1.0 - largest * albedo) + color * (sheen_from_lights() + around * albedo);
}

//@neutral sheen
vec3 with_sheen(Surface surface, vec3 radiance) { return radiance; }

//@part albedo implements sheen_albedo
// The table for one roughness.

uniform vec4 sheen_albedo[8];

float sheen_entry(int index) { return sheen_albedo[index / 4][index % 4]; }

//@part roughness_texture
// The share of the roughness from a texture: alpha.

//@include "inputs.glsl#texcoord"

uniform sampler2D sheen_roughness_texture;

float sheen_roughness_lookup = texture(sheen_roughness_texture, texcoord_surface).a;

float sheen_roughness_texel() { return clamp(sheen_roughness_lookup, 0.0, 1.0); }

//@part albedo_by_texture implements sheen_albedo
// The table for the roughness at a pixel, between two rows over the root of the texel: row 19 is
// that of the whole roughness, and rows of smoother fibers also have values above 1.

//@include "sheen.glsl#roughness_texture"

uniform vec4 sheen_albedo[8];
uniform vec4 sheen_albedo_rows[152];

float sheen_entry(int index) {
    float place = 19.0 * sqrt(sheen_roughness_texel());
    int row = min(int(place), 18);
    float share = place - float(row);
    int group = 8 * row + index / 4;
    float smoother = sheen_albedo_rows[group][index % 4];
    float rougher = row < 18 ? sheen_albedo_rows[group + 8][index % 4]
                             : sheen_albedo[index / 4][index % 4];
    return min(smoother * (1.0 - share) + rougher * share, 1.0);
}

//@part width implements sheen_width
// Alpha of the fibers' distribution.

uniform float sheen_alpha;

float sheen_width() { return sheen_alpha; }

//@part width_by_texture implements sheen_width
// Alpha for the roughness at a pixel, which is at least 0.045.

//@include "sheen.glsl#roughness_texture"

uniform float sheen_roughness;

float sheen_width() {
    float roughness = sheen_roughness * sheen_roughness_texel();
    return max(roughness * roughness, 0.002025);
}

//@part color_texture implements sheen_color_texture
// The color from a texture.

//@include "inputs.glsl#texcoord"

uniform sampler2D sheen_color_texture;

vec3 sheen_color_lookup = texture(sheen_color_texture, texcoord_surface).rgb;

vec3 sheen_color_texel() { return sheen_color_lookup; }

//@neutral sheen_color_texture
vec3 sheen_color_texel() { return vec3(1.0); }

//@part lights implements sheen_lights
// The light of light sources. n.v is at least 1e-4, since V has a pole at 0.

//@include "vector.glsl#normalized_or"
//@include <sheen_width>

vec3 sheen_received = vec3(0.0);

float sheen_log_lambda(float cosine, float alpha) {
    float smooth_share = (1.0 - alpha) * (1.0 - alpha);
    float a = mix(21.5473, 25.3245, smooth_share);
    float b = mix(3.82987, 3.32435, smooth_share);
    float c = mix(0.19823, 0.16801, smooth_share);
    float d = mix(-1.97760, -1.27393, smooth_share);
    float e = mix(-4.32054, -4.85967, smooth_share);
    return a / (1.0 + b * pow(cosine, c)) + d * cosine + e;
}

float sheen_lambda(float cosine, float alpha) {
    if (cosine < 0.5) return exp(sheen_log_lambda(cosine, alpha));
    return exp(2.0 * sheen_log_lambda(0.5, alpha) -
               sheen_log_lambda(max(1.0 - cosine, 0.0), alpha));
}

void receive_sheen(Surface surface, vec3 light_world, vec3 irradiance) {
    float alpha = sheen_width();
    float n_dot_l = dot(surface.normal_world, light_world);
    vec3 half_world = normalized_or(light_world + surface.view_world, vec3(0.0));
    if (!(n_dot_l > 0.0) || half_world == vec3(0.0)) return;
    float n_dot_h = clamp(dot(surface.normal_world, half_world), 0.0, 1.0);
    float sine_squared = (1.0 - n_dot_h) * (1.0 + n_dot_h);
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 1e-4, 1.0);
    float fibers = (1.0 + 0.5 / alpha) * pow(sine_squared, 0.5 / alpha);
    float masking = 1.0 + sheen_lambda(n_dot_v, alpha) + sheen_lambda(n_dot_l, alpha);
    sheen_received += irradiance * (fibers / (4.0 * n_dot_v * masking));
}

vec3 sheen_from_lights() { return sheen_received; }

//@neutral sheen_lights
void receive_sheen(Surface surface, vec3 light_world, vec3 irradiance) {}
vec3 sheen_from_lights() { return vec3(0.0); }

//@part ambient implements sheen_ambient
// Ambient light.

//@include "inputs.glsl#ambient"
//@include <occlusion>

vec3 sheen_from_ambient() { return ambient_scattered * occlusion(); }

//@neutral sheen_ambient
vec3 sheen_from_ambient() { return vec3(0.0); }

//@part environment implements sheen_environment
// The environment's light. Fibers reflect it from about half of all directions, so it counts as
// scattered.

//@include "environment.glsl#irradiance"
//@include <occlusion>

vec3 sheen_from_environment(Surface surface) {
    return environment_irradiance(surface.normal_world) * occlusion();
}

//@neutral sheen_environment
vec3 sheen_from_environment(Surface surface) { return vec3(0.0); }
