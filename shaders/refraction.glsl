// SPDX-License-Identifier: Apache-2.0
// The light that passes through the surface: the environment behind Phong's surfaces, and the picture of what
// is behind glTF's.

//@part refracted implements refraction
// Light is refracted once, at the surface; total internal reflection is black.

//@include "environment.glsl#radiance"

uniform float transmission;
uniform float refraction_ratio;  // The outside's refractive index over the inside's.

vec3 with_refraction(Surface surface, vec3 scattered) {
    vec3 bent_world = refract(-surface.view_world, surface.normal_world, refraction_ratio);
    bool is_reflected = bent_world == vec3(0.0);
    // The lookup is not in a branch, which would leave neighbors without derivatives.
    vec3 seen = environment_radiance(is_reflected ? -surface.view_world : bent_world);
    vec3 through = is_reflected ? vec3(0.0) : seen;
    return scattered * (1.0 - transmission) + through * transmission;
}

//@part dimming implements refraction
// For a debug view of another term: transmission only dims the scattered light.

uniform float transmission;

vec3 with_refraction(Surface surface, vec3 scattered) { return scattered * (1.0 - transmission); }

//@neutral refraction
vec3 with_refraction(Surface surface, vec3 scattered) { return scattered; }

//@part transmission_share
// The share of the light that passes through glTF's surface instead of being scattered.

//@include <transmission_texture>

uniform float transmission;

float transmission_here() { return transmission * transmission_texel(); }

//@part behind
// The picture behind the surface. Texels are fetched and mixed here, so that the weights are exact.

uniform sampler2D behind;  // Radiance multiplied by coverage. Each level has half the size.
uniform vec3 background_radiance;

// The size of a level. textureSize() takes one level for neighbors whose levels differ (llvmpipe).
ivec2 behind_size(int level) { return max(textureSize(behind, 0) >> level, ivec2(1)); }

vec4 behind_texel(ivec2 texel, int level) {
    return texelFetch(behind, clamp(texel, ivec2(0), behind_size(level) - 1), level);
}

vec4 behind_at(vec2 place, int level) {
    vec2 texels = place * vec2(behind_size(level)) - 0.5;
    ivec2 first = ivec2(floor(texels));
    vec2 share = texels - vec2(first);
    return mix(mix(behind_texel(first, level), behind_texel(first + ivec2(1, 0), level), share.x),
               mix(behind_texel(first + ivec2(0, 1), level),
                   behind_texel(first + ivec2(1, 1), level), share.x),
               share.y);
}

vec3 radiance_behind(vec2 place, float level) {
    int sharper = int(level);
    float share = level - float(sharper);
    vec4 texel = behind_at(place, sharper);
    if (share > 0.0) texel = mix(texel, behind_at(place, sharper + 1), share);
    return texel.rgb + (1.0 - texel.a) * background_radiance;
}

//@part transmission implements transmission
// The picture behind the surface replaces a share of the scattered light. It is tinted as scattered
// light is, and lacks what facets mirror. Rough surfaces look up a coarser level of the picture.
// Source: KHR_materials_transmission.

//@include "inputs.glsl#min_roughness"
//@include "refraction.glsl#transmission_share"
//@include "refraction.glsl#behind"
//@include <film>
//@include <grazing>
//@include <path>
//@include <dispersion>

uniform float blurred_level;  // The level for roughness 1.

vec3 with_transmission(Surface surface, vec3 scattered) {
    float share = transmission_here();
    float m = 1.0 - clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    vec3 blocking = blocking_f0(surface);
    vec3 blocked = blocked_by_film(
        surface, 1.0 - m, 1.0,
        blocking + (grazing_reflectance(surface) - blocking) * (m * m * m * m * m));
    float level = blurred_level * (surface.roughness - min_roughness) / (1.0 - min_roughness);
    Path path = path_through(surface, vec2(textureSize(behind, 0)));
    vec3 seen = radiance_along(path, surface, level) * path.transmittance;
    vec3 passing = seen * surface.scattered_color * (vec3(1.0) - blocked);
    return scattered * (1.0 - share) + passing * share;
}

//@part transmission_dimming implements transmission
// For a debug view of another term: transmission only dims the scattered light.

//@include "refraction.glsl#transmission_share"

vec3 with_transmission(Surface surface, vec3 scattered) {
    return scattered * (1.0 - transmission_here());
}

//@neutral transmission
vec3 with_transmission(Surface surface, vec3 scattered) { return scattered; }

//@part transmission_texture implements transmission_texture
// The share from a texture: red.

//@include "inputs.glsl#texcoord"

uniform sampler2D transmission_texture;

float transmission_lookup = texture(transmission_texture, texcoord_surface).r;

float transmission_texel() { return transmission_lookup; }

//@neutral transmission_texture
float transmission_texel() { return 1.0; }

//@part path
// The path of light through the surface: where it comes from in the picture behind the surface,
// from 0 to 1, and the share that is not absorbed.

struct Path {
    vec2 place;
    vec3 transmittance;
};

//@part thin implements path
// A thin sheet neither bends the path nor absorbs light.

//@include "refraction.glsl#path"

Path path_through(Surface surface, vec2 picture_size) {
    return Path(gl_FragCoord.xy / picture_size, vec3(1.0));
}

//@part volume implements path
// Light is refracted where it leaves the surface to the eye, and absorbed on a path whose length is
// the thickness. A path that begins behind the eye counts as straight. Source: KHR_materials_volume.

//@include "inputs.glsl#clip"
//@include "refraction.glsl#path"
//@include <thickness_texture>

uniform float thickness;
uniform float object_scale;
uniform vec3 absorption;  // The logarithm of the attenuation of a unit of length.
uniform float volume_index_ratio;  // The outside's refractive index over the inside's.

float path_length() { return thickness * thickness_texel() * object_scale; }

vec2 place_behind(Surface surface, vec2 picture_size, float index_ratio) {
    vec3 bent_world = refract(-surface.view_world, surface.normal_world, index_ratio);
    vec4 clip = clip_from_world * vec4(surface.position_world + bent_world * path_length(), 1.0);
    return clip.w > 0.0 ? clamp(0.5 * clip.xy / clip.w + 0.5, vec2(0.0), vec2(1.0))
                        : gl_FragCoord.xy / picture_size;
}

Path path_through(Surface surface, vec2 picture_size) {
    return Path(place_behind(surface, picture_size, volume_index_ratio),
                exp(-absorption * path_length()));
}

//@part dispersion implements dispersion
// Red, green and blue leave the volume in directions of their own: its index is smaller for red and
// larger for blue than for green, by half of (index - 1) / V with the Abbe number V, but at least 1.
// Source: KHR_materials_dispersion.

//@include "refraction.glsl#behind"
//@include "refraction.glsl#volume"

uniform float dispersion;  // 20 / V

vec3 radiance_along(Path path, Surface surface, float level) {
    float spread = max(1.0 - volume_index_ratio, 0.0) * 0.025 * dispersion;  // Over the index.
    float red_ratio =
        volume_index_ratio / max(1.0 - spread, clamp(volume_index_ratio, 1e-20, 1.0));
    float blue_ratio = volume_index_ratio / (1.0 + spread);
    vec2 picture_size = vec2(textureSize(behind, 0));
    return vec3(radiance_behind(place_behind(surface, picture_size, red_ratio), level).r,
                radiance_behind(path.place, level).g,
                radiance_behind(place_behind(surface, picture_size, blue_ratio), level).b);
}

//@neutral dispersion
vec3 radiance_along(Path path, Surface surface, float level) {
    return radiance_behind(path.place, level);
}

//@part thickness_texture implements thickness_texture
// The share of the thickness from a texture: green.

//@include "inputs.glsl#texcoord"

uniform sampler2D thickness_texture;

float thickness_lookup = texture(thickness_texture, texcoord_surface).g;

float thickness_texel() { return thickness_lookup; }

//@neutral thickness_texture
float thickness_texel() { return 1.0; }
