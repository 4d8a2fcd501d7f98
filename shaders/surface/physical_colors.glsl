// SPDX-License-Identifier: Apache-2.0
// The surface in glTF's metallic-roughness model where only light from everywhere reaches it: what
// it scatters and what it mirrors head on. Source: glTF 2.0, appendix B.

#include <diffuse_texture>
#include <vertex_color>
#include <metallic_roughness>

uniform vec3 base_color;

const float dielectric_f0 = 0.04;

struct Surface {
    vec3 scattered_color;
    vec3 f0;
};

Surface surface_here() {
    vec3 base = base_color * diffuse_texel().rgb * vertex_tint().rgb;
    float metal = clamp(metallic_and_roughness().x, 0.0, 1.0);
    return Surface(base * (1.0 - metal), mix(vec3(dielectric_f0), base, metal));
}
