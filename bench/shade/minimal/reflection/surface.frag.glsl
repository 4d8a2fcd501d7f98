// SPDX-License-Identifier: Apache-2.0
// By hand, for one directional light: what this scene takes and nothing else.

in vec3 normal_world;
in vec3 position_world;
in vec2 texcoord_surface;
in vec4 tangent_world;
out vec4 color;
uniform vec3 eye_world;
uniform vec3 diffuse_color;
uniform vec3 specular_color;
uniform float shininess;
uniform sampler2D diffuse_texture;
uniform sampler2D normal_texture;
uniform vec3 normal_map_scale;
uniform vec3 normal_map_bias;
uniform samplerCube environment;
uniform float environment_intensity;
uniform vec3 reflectivity;
uniform vec3 grazing_reflectivity;
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
    float n_dot_l = dot(n, l);
    vec3 radiance = vec3(0.0);
    vec3 highlight = vec3(0.0);
    if (n_dot_l > 0.0) {
        radiance = diffuse_color * light_rows[1].rgb * n_dot_l;
        highlight = specular_color * light_rows[1].rgb *
                    pow(max(dot(n, normalize(l + v)), 0.0), shininess);
    }
    radiance *= texture(diffuse_texture, texcoord_surface).rgb;
    float m = 1.0 - clamp(dot(n, v), 0.0, 1.0);
    vec3 fresnel = reflectivity + (grazing_reflectivity - reflectivity) * (m * m * m * m * m);
    vec3 mirrored = texture(environment, reflect(-v, n)).rgb * environment_intensity;
    radiance = mix(radiance, mirrored, fresnel);
    color = vec4(srgb(radiance + highlight), 1.0);
}
