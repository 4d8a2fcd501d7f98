// SPDX-License-Identifier: Apache-2.0
// The radiance that a surface sends to the eye, as scene.h's Material defines it. World space.
// Every included <step> is chosen by the effect plan; one that cannot show is in absent/.

out vec4 color;

// What a light does at one point: before the surface's tint, and as highlights.
struct Lighting {
    vec3 scattered;
    vec3 highlights;
};

#include <surface>
#include <diffuse>
#include <specular>
#include <directional_lights>
#include <point_lights>
#include <spot_lights>
#include <ambient>
#include <diffuse_texture>
#include <vertex_color>
#include <reflection>
#include <emission>
#include <output>

void main() {
    Surface surface = surface_here();

    Lighting lighting = Lighting(ambient_radiance(), vec3(0.0));
    add_directional_lights(surface, lighting);
    add_point_lights(surface, lighting);
    add_spot_lights(surface, lighting);

    vec3 scattered = lighting.scattered * diffuse_texture_color() * vertex_tint();
    vec3 radiance =
        with_reflection(surface, scattered) + lighting.highlights + emitted_radiance();
    color = vec4(coded(radiance), 1.0);
}
