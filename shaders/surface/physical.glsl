// SPDX-License-Identifier: Apache-2.0
// The surface in glTF's metallic-roughness model: base colour, metallic and roughness made into
// what is scattered, what is mirrored head on, and how far the facets spread. Roughness is kept
// where its fourth power is worth a float. Source: glTF 2.0, appendix B.

#include "common/eye.glsl"
#include "common/normalized_or.glsl"
#include <position>
#include <normal>
#include <sharpness>
#include <diffuse_texture>
#include <vertex_color>
#include <metallic_roughness>

uniform vec3 base_color;

const float dielectric_f0 = 0.04;
const float least_roughness = 0.045;

struct Surface {
    vec3 normal_world;
    vec3 position_world;
    vec3 view_world;
    vec3 scattered_color;
    vec3 f0;
    float roughness;
    float alpha_squared;  // The fourth power of roughness.
};

Surface surface_here() {
    vec3 normal = shading_normal();
    vec3 base = base_color * diffuse_texel().rgb * vertex_tint().rgb;
    vec2 kind = clamp(metallic_and_roughness(), vec2(0.0), vec2(1.0));
    float widened_roughness = widened(max(kind.y, least_roughness));
    float alpha = widened_roughness * widened_roughness;
    return Surface(normal, position_world, normalized_or(eye_world - position_world, normal),
                   base * (1.0 - kind.x), mix(vec3(dielectric_f0), base, kind.x),
                   widened_roughness, alpha * alpha);
}
