// SPDX-License-Identifier: Apache-2.0
// Phong's reflection model: diffuse scattering and highlights of the light that a surface receives.

//@part receive implements receive
// Adds light of this irradiance, and of highlight_irradiance for highlights, from the unit
// direction light_world. Light from behind adds nothing; a zero or non-finite direction fails the
// comparison and adds nothing.

//@include <diffuse>
//@include <specular>
//@include <term_limit>

void receive(Surface surface, vec3 light_world, vec3 irradiance, vec3 highlight_irradiance,
             inout Lighting lighting) {
    float n_dot_l = dot(surface.normal_world, light_world);
    if (!(n_dot_l > 0.0)) return;
    lighting.scattered += limited(irradiance * diffuse_scattering(n_dot_l));
    lighting.highlights += limited(highlight_irradiance * specular_highlight(surface, light_world));
}

//@part clamped_terms implements term_limit
// Each term is clamped before it is added, as hardware with fixed functions did.

vec3 limited(vec3 term) { return clamp(term, 0.0, 1.0); }

//@neutral term_limit
vec3 limited(vec3 term) { return term; }

//@part lambert implements diffuse
// Diffuse scattering, equal in all directions. Source: [Lambert 1760].

//@include "inputs.glsl#diffuse_color"

vec3 diffuse_scattering(float n_dot_l) { return diffuse_color * n_dot_l; }

//@neutral diffuse
vec3 diffuse_scattering(float n_dot_l) { return vec3(0.0); }

//@part phong implements specular
// The highlight around the light's mirror direction. Source: [Phong 1975].

//@include "phong.glsl#cosine_power"
//@include <highlight_color>
//@include <sharpness>

uniform float shininess;

vec3 specular_highlight(Surface surface, vec3 light_world) {
    vec3 mirrored_world = reflect(-light_world, surface.normal_world);
    return highlight_color(surface, light_world) * dimmed(shininess) *
           cosine_power(mirrored_world, surface.view_world, sharpened(shininess));
}

//@part blinn_phong implements specular
// The highlight around the half vector between light and eye. If those are opposite, there is no
// half vector: it counts as perpendicular to the normal. Source: [Blinn 1977].

//@include "phong.glsl#cosine_power"
//@include "vector.glsl#normalized_or"
//@include <highlight_color>
//@include <sharpness>

uniform float shininess;

vec3 specular_highlight(Surface surface, vec3 light_world) {
    vec3 half_world = normalized_or(light_world + surface.view_world, vec3(0.0));
    return highlight_color(surface, light_world) * dimmed(shininess) *
           cosine_power(surface.normal_world, half_world, sharpened(shininess));
}

//@neutral specular
vec3 specular_highlight(Surface surface, vec3 light_world) { return vec3(0.0); }

//@part color implements highlight_color
// The color of highlights at all angles.

uniform vec3 specular_color;

vec3 highlight_color(Surface surface, vec3 light_world) { return specular_color; }

//@part fresnel_color implements highlight_color
// The color of highlights by Schlick's approximation at the half vector. If light and eye are
// opposite, their angle to it counts as 90 degrees. Source: [Schlick 1994].

//@include "vector.glsl#normalized_or"

uniform vec3 specular_color;
uniform vec3 specular_gain;  // The increase towards grazing angles.

vec3 highlight_color(Surface surface, vec3 light_world) {
    vec3 half_world = normalized_or(light_world + surface.view_world, vec3(0.0));
    float m = clamp(1.0 - dot(half_world, surface.view_world), 0.0, 1.0);
    return specular_color + specular_gain * (m * m * m * m * m);
}

//@part cosine_power
// Returns max(a.b, 0)^exponent of unit vectors, for exponents from 0 to 1e6; x^0 is 1, also for
// x = 0. Near a = b the cosine's distance to 1 is computed from |a - b| (1 - a.b = |a - b|^2 / 2)
// and its logarithm from a series, since a float next to 1 is too coarse for large exponents.

float cosine_power(vec3 a, vec3 b, float exponent) {
    float cosine = dot(a, b);
    if (!(cosine > 0.0)) return exponent == 0.0 ? 1.0 : 0.0;
    vec3 between = a - b;
    float gap = 0.5 * dot(between, between);
    float log_near = -gap * (1.0 + gap * (0.5 + gap * 0.33333333));
    return exp(exponent * (gap < 0.01 ? log_near : log(min(cosine, 1.0))));
}
