// SPDX-License-Identifier: Apache-2.0
// The same for glTF's metallic-roughness: GGX facets mirror by Schlick's Fresnel factor, and what
// they do not is scattered. pi is in the irradiance. 1 - (n.h)^2 is taken from the cross product,
// since a float next to 1 is too coarse for smooth surfaces. Where light and view are opposite
// there is no half vector, and nothing is mirrored. Source: [Walter et al. 2007], glTF 2.0,
// appendix B.

#include "common/normalized_or.glsl"

// GGX's D times pi. A normal map may turn the normal away from the half vector; n.h then counts as
// 0. Its square alone would mirror the lobe to the other side of the surface.
float facets(vec3 normal_world, vec3 half_world, float alpha_squared) {
    float n_dot_h = dot(normal_world, half_world);
    if (!(n_dot_h > 0.0)) return alpha_squared;
    vec3 across = cross(normal_world, half_world);
    float spread = dot(across, across) + alpha_squared * n_dot_h * n_dot_h;
    return alpha_squared / (spread * spread);
}

// Smith's height-correlated masking and shadowing over 4 (n.l) (n.v).
float visibility(float n_dot_l, float n_dot_v, float alpha_squared) {
    float masked = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - alpha_squared) + alpha_squared);
    float shadowed = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - alpha_squared) + alpha_squared);
    return 0.5 / (masked + shadowed);
}

void receive(Surface surface, vec3 light_world, vec3 irradiance, vec3 highlight_irradiance,
             inout Lighting lighting) {
    float n_dot_l = dot(surface.normal_world, light_world);
    if (!(n_dot_l > 0.0)) return;
    vec3 received = irradiance * n_dot_l;
    vec3 half_world = normalized_or(light_world + surface.view_world, vec3(0.0));
    if (half_world == vec3(0.0)) {
        lighting.scattered += received;
        return;
    }
    float m = 1.0 - clamp(dot(surface.view_world, half_world), 0.0, 1.0);
    vec3 fresnel = surface.f0 + (vec3(1.0) - surface.f0) * (m * m * m * m * m);
    float n_dot_v = max(dot(surface.normal_world, surface.view_world), 0.0);
    float mirrored = facets(surface.normal_world, half_world, surface.alpha_squared) *
                     visibility(n_dot_l, n_dot_v, surface.alpha_squared);
    lighting.scattered += received * (vec3(1.0) - fresnel);
    lighting.highlights += received * fresnel * mirrored;
}
