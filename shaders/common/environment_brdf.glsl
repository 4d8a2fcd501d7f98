// SPDX-License-Identifier: Apache-2.0
// How much of light from everywhere GGX facets mirror, by the root of n.v and roughness: f0 times the
// table's first number, plus its second. Source: [Karis, SIGGRAPH 2013].

uniform sampler2D environment_brdf;

vec3 directional_albedo(Surface surface) {
    float n_dot_v = clamp(dot(surface.normal_world, surface.view_world), 0.0, 1.0);
    // From the middle of the first texel to that of the last.
    vec2 size = vec2(textureSize(environment_brdf, 0));
    vec2 place = (vec2(sqrt(n_dot_v), surface.roughness) * (size - 1.0) + 0.5) / size;
    vec2 scale_bias = texture(environment_brdf, place).rg;
    return surface.f0 * scale_bias.x + scale_bias.y;
}
