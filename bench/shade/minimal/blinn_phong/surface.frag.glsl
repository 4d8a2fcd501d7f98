// SPDX-License-Identifier: Apache-2.0
// By hand, for one directional light: what this scene takes and nothing else.

in vec3 normal_world;
in vec3 position_world;

out vec4 color;
uniform vec3 eye_world;
uniform vec3 diffuse_color;
uniform vec3 specular_color;
uniform float shininess;

layout(std140) uniform Lights { vec4 light_rows[2]; };

vec3 srgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    vec3 curved = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

void main() {
    vec3 n = normalize(normal_world);
    vec3 v = normalize(eye_world - position_world);
    vec3 l = light_rows[0].xyz;
    float n_dot_l = dot(n, l);
    vec3 radiance = vec3(0.0);
    vec3 highlight = vec3(0.0);
    if (n_dot_l > 0.0) {
        radiance = diffuse_color * light_rows[1].rgb * n_dot_l;
        highlight = specular_color * light_rows[1].rgb *
                    pow(max(dot(n, normalize(l + v)), 0.0), shininess);
    }
    color = vec4(srgb(radiance + highlight), 1.0);
}
