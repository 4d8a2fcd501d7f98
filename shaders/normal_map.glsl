// SPDX-License-Identifier: Apache-2.0
// Normal maps in tangent space and in object space.

//@part texel
// The vector that a normal map stores. Scale and bias hold everything that differs between maps:
// which code stands for zero, the direction of green, and the material's scale of x and y.

//@include "inputs.glsl#texcoord"

uniform sampler2D normal_texture;
uniform vec3 normal_map_scale;
uniform vec3 normal_map_bias;

vec3 normal_lookup = texture(normal_texture, texcoord_surface).xyz;

vec3 normal_texel() { return normal_lookup * normal_map_scale + normal_map_bias; }

//@part tangent_space implements detail
// The normal in tangent space.

//@include "normal_map.glsl#texel"

vec3 normal_tangent() { return normal_texel(); }

//@part object_space implements normal
// The shading normal from a map in object space; the interpolated normal if the map's vector is
// zero.

//@include "inputs.glsl#normal"
//@include "vector.glsl#normalized_or"
//@include "normal_map.glsl#texel"
//@include <facing>

uniform mat3 world_from_object_normal;

vec3 shading_normal() {
    vec3 normal_object = normal_texel();
    vec3 mapped_world = world_from_object_normal * normal_object;
    bool maps = dot(normal_object, normal_object) > 1e-12 && has_direction(mapped_world);
    return facing() * normalized_or(maps ? mapped_world : normal_world, vec3(0.0, 0.0, 1.0));
}
