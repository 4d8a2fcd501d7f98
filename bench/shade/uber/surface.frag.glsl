// SPDX-License-Identifier: Apache-2.0
// shaders/surface.frag.glsl with every effect compiled in, behind branches on uniforms, as in most
// renderers. Unset uniforms are 0, so that everything but directional light is off.

out vec4 color;

uniform int use_ambient;
uniform int use_environment_light;
uniform int use_reflection;
uniform int use_emission;

//@include "light.glsl#lighting"
//@include <alpha>
//@include <surface>
//@include <lights>
//@include <ambient>
//@include <environment_light>
//@include <tint>
//@include <specular_texture>
//@include <reflection>
//@include <emission>
//@include <output>

void main() {
    float alpha = alpha_here();
    Surface surface = surface_here();

    Lighting lighting = Lighting(vec3(0.0), vec3(0.0));
    if (use_ambient != 0) add_ambient(surface, lighting);
    add_lights(surface, lighting);
    if (use_environment_light != 0) add_environment_light(surface, lighting);

    vec3 scattered = lighting.scattered * scattering_tint(surface);
    vec3 radiance = scattered;
    if (use_reflection != 0) radiance = with_reflection(surface, scattered);
    radiance += lighting.highlights * specular_texture_color();
    if (use_emission != 0) radiance += emitted_radiance();
    color = vec4(coded(radiance), alpha);
}
