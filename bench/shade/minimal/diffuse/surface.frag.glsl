// SPDX-License-Identifier: Apache-2.0
// By hand, for one directional light: what this scene takes and nothing else.

in vec3 normal_world;
out vec4 color;
uniform vec3 diffuse_color;
layout(std140) uniform Lights { vec4 light_rows[2]; };

vec3 srgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    vec3 curved = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

void main() {
    float n_dot_l = max(dot(normalize(normal_world), light_rows[0].xyz), 0.0);
    color = vec4(srgb(diffuse_color * light_rows[1].rgb * n_dot_l), 1.0);
}
