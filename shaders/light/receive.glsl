// SPDX-License-Identifier: Apache-2.0
// What light of this irradiance, and of this for highlights, from the unit direction light_world
// does to the surface: nothing from behind. A direction without length, or not finite, fails the
// comparison and does nothing.

#include <diffuse>
#include <specular>

void receive(Surface surface, vec3 light_world, vec3 irradiance, vec3 highlight_irradiance,
             inout Lighting lighting) {
    float n_dot_l = dot(surface.normal_world, light_world);
    if (!(n_dot_l > 0.0)) return;
    lighting.scattered += irradiance * diffuse_scattering(n_dot_l);
    lighting.highlights += highlight_irradiance * specular_highlight(surface, light_world);
}
