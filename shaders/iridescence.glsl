// SPDX-License-Identifier: Apache-2.0
// A thin film on glTF's surfaces: the light that its two surfaces mirror interferes. The spectrum is
// integrated in Fourier space, where the sensitivities of an eye are sums of Gaussians. Schlick's
// approximation stands for Fresnel's formulas, without polarization.
// Source: KHR_materials_iridescence, [Belcour and Barla 2017].

//@part thickness implements film_thickness
// The thickness in nanometers.

uniform float iridescence_thickness;

float film_thickness() { return iridescence_thickness; }

//@part thickness_texture implements film_thickness
// The thickness in nanometers from a texture: green.

//@include "inputs.glsl#texcoord"

uniform float iridescence_thickness;
uniform float iridescence_thickness_minimum;
uniform sampler2D film_thickness_texture;

float film_thickness_lookup = texture(film_thickness_texture, texcoord_surface).g;

float film_thickness() {
    float lacking = 1.0 - film_thickness_lookup;
    return iridescence_thickness -
           lacking * (iridescence_thickness - iridescence_thickness_minimum);
}

//@part texture implements iridescence_texture
// The weight from a texture: red.

//@include "inputs.glsl#texcoord"

uniform sampler2D iridescence_texture;

float iridescence_lookup = texture(iridescence_texture, texcoord_surface).r;

float iridescence_texel() { return iridescence_lookup; }

//@neutral iridescence_texture
float iridescence_texel() { return 1.0; }

//@part film implements film
// The film's reflectance, and its effect on mirrored and on scattered light.

//@include <film_thickness>
//@include <iridescence_texture>

uniform float iridescence;
uniform float iridescence_index;

// The color of light whose parts differ by a path in nanometers, relative to white; `sign` is -1
// where one of them is reflected with the opposite phase.
vec3 interference(float path, vec3 sign) {
    float phase = 6.28318531 * path;
    vec3 xyz = vec3(0.84659, 1.00022189, 1.00112249) * sign *
               cos(vec3(1.6810e-3, 1.7953e-3, 2.2084e-3) * phase) *
               exp(vec3(-4.3278e-9, -9.3046e-9, -6.6121e-9) * (phase * phase));
    xyz.x += 0.153868307 * sign.x * cos(2.2399e-3 * phase) * exp(-4.5282e-9 * (phase * phase));
    const mat3 rgb_from_xyz = mat3(3.2404542, -0.9692660, 0.0556434,  //
                                   -1.5371385, 1.8760108, -0.2040259,  //
                                   -0.4985314, 0.0415560, 1.0572252);
    return rgb_from_xyz * xyz;
}

// Schlick's factor between a reflectance at normal incidence and 1.
float towards_one(float cosine) {
    float m = 1.0 - cosine;
    return m * m * m * m * m;
}

// The film's reflectance on a base of this reflectance at normal incidence.
vec3 film_reflectance(vec3 f0, float cosine) {
    float index = iridescence_index;
    float cosine_inside = sqrt(max(1.0 - (1.0 - cosine * cosine) / (index * index), 0.0));
    float outer_root = (index - 1.0) / (index + 1.0);
    float outer_f0 = outer_root * outer_root;
    float outer = outer_f0 + (1.0 - outer_f0) * towards_one(cosine);
    float through = 1.0 - outer;
    vec3 base_root = sqrt(clamp(f0, 0.0, 0.9999));
    vec3 base_index = (1.0 + base_root) / (1.0 - base_root);
    vec3 inner_root = (base_index - index) / (base_index + index);
    vec3 inner_f0 = inner_root * inner_root;
    vec3 inner = inner_f0 + (1.0 - inner_f0) * towards_one(cosine_inside);
    // Light from inside that meets the air keeps its phase, unlike light that meets a denser medium.
    vec3 sign = mix(vec3(-1.0), vec3(1.0), lessThan(base_index, vec3(index)));

    vec3 bounce = clamp(outer * inner, 1e-5, 0.9999);
    vec3 from_base = through * through * inner / (1.0 - bounce);
    float path = 2.0 * index * film_thickness() * cosine_inside;
    vec3 amplitude = sqrt(bounce);
    vec3 term = (from_base - through) * amplitude;
    vec3 sum = outer + from_base + 2.0 * term * interference(path, sign);
    sum += 2.0 * (term * amplitude) * interference(2.0 * path, vec3(1.0));
    return max(sum, 0.0);
}

// The mirrored light: `share` is that of a surface that mirrors all light.
vec3 with_film(Surface surface, float cosine, float share, vec3 mirrored) {
    return mix(mirrored, film_reflectance(surface.f0, cosine) * share,
               iridescence * iridescence_texel());
}

// The light that scattering lacks. It has the largest channel, so that a colored reflection does not
// tint the scattered light.
vec3 blocked_by_film(Surface surface, float cosine, float share, vec3 blocked) {
    vec3 film = film_reflectance(surface.f0, cosine);
    float largest = min(max(max(film.r, film.g), film.b), 1.0);
    return mix(blocked, vec3(largest * share), iridescence * iridescence_texel());
}

//@neutral film
vec3 with_film(Surface surface, float cosine, float share, vec3 mirrored) { return mirrored; }
vec3 blocked_by_film(Surface surface, float cosine, float share, vec3 blocked) { return blocked; }
