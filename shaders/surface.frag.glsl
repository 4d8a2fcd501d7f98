// SPDX-License-Identifier: Apache-2.0
// The radiance that a surface sends to the eye, as material.h's Material defines it. World space.
// The effect plan chooses the code of every included <step>; an absent effect is a neutral value.

invariant out vec4 color;

//@include "light.glsl#lighting"
//@include <second_texcoord>
//@include <displacement>
//@include <relief_edge>
//@include <relief_depth>
//@include <alpha>
//@include <surface>
//@include <lights>
//@include <ambient>
//@include <environment_light>
//@include <tint>
//@include <specular_texture>
//@include <environment_tint>
//@include <transmission>
//@include <reflection>
//@include <sheen>
//@include <emission>
//@include <clearcoat>
//@include <output>

void main() {
    float alpha = alpha_here();
    Surface surface = surface_here();

    Lighting lighting = Lighting(vec3(0.0), vec3(0.0));
    add_ambient(surface, lighting);
    add_lights(surface, lighting);
    add_environment_light(surface, lighting);

    vec3 around = environment_tint(surface);
    vec3 scattered =
        with_transmission(surface, lighting.scattered * scattering_tint(surface) * around);
    vec3 highlights = lighting.highlights * specular_texture_color() * around;
    vec3 reflected = with_sheen(surface, with_reflection(surface, scattered) + highlights);
    vec3 radiance = with_clearcoat(surface, reflected + emitted_radiance());
    color = vec4(coded(radiance), alpha);
    write_depth();
    cut_holes();
    cut_silhouette();
}
