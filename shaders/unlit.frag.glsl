// SPDX-License-Identifier: Apache-2.0
// An unlit surface: the picture shows its diffuse color.

out vec4 color;

uniform vec3 diffuse_color;

//@include <second_texcoord>
//@include <displacement>
//@include <relief_edge>
//@include <relief_depth>
//@include <alpha>
//@include <diffuse_texture>
//@include <vertex_color>
//@include <output>

void main() {
    float alpha = alpha_here();
    vec3 radiance = diffuse_color * diffuse_texel().rgb * vertex_tint().rgb;
    color = vec4(coded(radiance), alpha);
    write_depth();
    cut_holes();
    cut_silhouette();
}
