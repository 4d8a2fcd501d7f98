// SPDX-License-Identifier: Apache-2.0
// Replaces the part of shaders/phong.glsl that receives light: highlights are behind a branch.

//@part receive implements receive
//@include <diffuse>
//@include <specular>

uniform int use_highlights;

void receive(Surface surface, vec3 light_world, vec3 irradiance, vec3 highlight_irradiance,
             inout Lighting lighting) {
    float n_dot_l = dot(surface.normal_world, light_world);
    if (!(n_dot_l > 0.0)) return;
    lighting.scattered += irradiance * diffuse_scattering(n_dot_l);
    if (use_highlights != 0) {
        lighting.highlights += highlight_irradiance * specular_highlight(surface, light_world);
    }
}
