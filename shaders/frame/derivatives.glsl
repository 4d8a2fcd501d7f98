// SPDX-License-Identifier: Apache-2.0
// A tangent frame without a tangent: the direction in which u grows along the triangle, from how
// position and texture coordinates change from pixel to pixel, made perpendicular to the
// interpolated normal. Bitangents point to where v decreases. Where nothing determines a direction
// (coordinates that do not change) tangent and bitangent are 0. Source: [Mikkelsen 2008] for the
// frame of one triangle.

#include "common/normalized_or.glsl"
#include "common/rescaled.glsl"
#include "common/texcoord.glsl"
#include <position>

in vec3 normal_world;

mat3 world_from_tangent() {
    vec3 n = normalized_or(normal_world, vec3(0.0, 0.0, 1.0));
    vec3 right_world = rescaled(dFdx(position_world));
    vec3 up_world = dFdy(position_world) * rescaling(dFdx(position_world));
    vec2 right_texture = dFdx(texcoord_surface);
    vec2 up_texture = dFdy(texcoord_surface);
    float area = right_texture.x * up_texture.y - right_texture.y * up_texture.x;
    vec3 along_u = right_world * up_texture.y - up_world * right_texture.y;
    along_u = rescaled(along_u) * sign(area);
    vec3 tangent = normalized_or(along_u - n * dot(n, along_u), vec3(0.0));
    // Texture and surface turn the same way round where both areas have one sign; v grows down.
    float turned = sign(area) * sign(dot(n, cross(right_world, up_world)));
    return mat3(tangent, -turned * cross(n, tangent), n);
}
