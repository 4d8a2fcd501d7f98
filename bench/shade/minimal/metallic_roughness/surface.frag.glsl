// SPDX-License-Identifier: Apache-2.0
// By hand, for one directional light: what this scene takes and nothing else.

in vec3 normal_world;
in vec3 position_world;
in vec2 texcoord_surface;
in vec4 tangent_world;
out vec4 color;
uniform vec3 eye_world;
uniform vec3 base_color;
uniform float metallic;
uniform float roughness;
uniform sampler2D diffuse_texture;
uniform sampler2D metallic_roughness_texture;
uniform sampler2D normal_texture;
uniform vec3 normal_map_scale;
uniform vec3 normal_map_bias;
layout(std140) uniform Lights { vec4 light_rows[2]; };

vec3 srgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    vec3 curved = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

void main() {
    vec3 t = texture(normal_texture, texcoord_surface).xyz * normal_map_scale + normal_map_bias;
    vec3 b = tangent_world.w * cross(normal_world, tangent_world.xyz);
    vec3 n = normalize(t.x * tangent_world.xyz + t.y * b + t.z * normal_world);
    vec3 v = normalize(eye_world - position_world);
    vec3 l = light_rows[0].xyz;
    vec3 base = base_color * texture(diffuse_texture, texcoord_surface).rgb;
    vec2 kind = texture(metallic_roughness_texture, texcoord_surface).bg * vec2(metallic, roughness);
    float rough = max(kind.y, 0.045);
    float alpha = rough * rough;
    float a2 = alpha * alpha;
    vec3 f0 = mix(vec3(0.04), base, kind.x);
    float n_dot_l = dot(n, l);
    vec3 radiance = vec3(0.0);
    if (n_dot_l > 0.0) {
        vec3 h = normalize(l + v);
        float n_dot_v = max(dot(n, v), 0.0);
        float n_dot_h = dot(n, h);
        float m = 1.0 - max(dot(v, h), 0.0);
        vec3 fresnel = f0 + (1.0 - f0) * (m * m * m * m * m);
        float spread = n_dot_h * n_dot_h * (a2 - 1.0) + 1.0;
        float visibility = 0.5 / (n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2) +
                                  n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - a2) + a2));
        radiance = light_rows[1].rgb * n_dot_l *
                   ((1.0 - fresnel) * base * (1.0 - kind.x) +
                    fresnel * (a2 / (spread * spread) * visibility));
    }
    color = vec4(srgb(radiance), 1.0);
}
