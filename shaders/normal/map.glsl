// SPDX-License-Identifier: Apache-2.0
// The normal bent by a tangent-space map. The basis is used as interpolated, not made unit and not
// made perpendicular, with the bitangent formed here: a baker that assumes the same (MikkTSpace)
// is then undone exactly. Scale and bias carry everything that differs between maps: which code
// stands for zero, which way green grows, and the material's scale of x and y.
// Where the map holds nothing (shorter than the rounding of its codes), or the basis spans nothing,
// the interpolated normal stands in, and (0,0,1) where that has no length either.

#include "common/normalized_or.glsl"
#include "common/texcoord.glsl"
#include <facing>

in vec3 normal_world;
in vec4 tangent_world;

uniform sampler2D normal_texture;
uniform vec3 normal_map_scale;
uniform vec3 normal_map_bias;

vec3 shading_normal() {
    vec3 texel = texture(normal_texture, texcoord_surface).xyz;
    vec3 normal_tangent = texel * normal_map_scale + normal_map_bias;
    bool holds_nothing = !(dot(normal_tangent, normal_tangent) > 1e-12);
    vec3 bitangent_world = tangent_world.w * cross(normal_world, tangent_world.xyz);
    vec3 bent_world = normal_tangent.x * tangent_world.xyz + normal_tangent.y * bitangent_world +
                      normal_tangent.z * normal_world;
    vec3 fallback = normalized_or(normal_world, vec3(0.0, 0.0, 1.0));
    return facing() * (holds_nothing ? fallback : normalized_or(bent_world, fallback));
}
