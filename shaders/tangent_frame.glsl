// SPDX-License-Identifier: Apache-2.0
// The tangent frame at a fragment: tangent, bitangent and normal in world space.

//@part stored implements frame
// The mesh's tangent frame as interpolated, neither normalized nor orthogonalized. The bitangent is
// computed here. A baker that assumes the same (MikkTSpace) is then inverted exactly.

//@include "inputs.glsl#normal"

in vec4 tangent_world;

mat3 world_from_tangent() {
    vec3 bitangent_world = tangent_world.w * cross(normal_world, tangent_world.xyz);
    return mat3(tangent_world.xyz, bitangent_world, normal_world);
}

//@part derivatives implements frame
// A tangent frame without stored tangents: the direction in which u grows along the triangle, from
// the screen-space derivatives of position and texture coordinates, made perpendicular to the
// interpolated normal. Bitangents point to decreasing v. If the texture coordinates are constant,
// tangent and bitangent are 0. Source: [Mikkelsen 2008] for the frame of one triangle.

//@include "inputs.glsl#normal"
//@include "vector.glsl#normalized_or"
//@include "vector.glsl#rescaled"
//@include "inputs.glsl#texcoord"
//@include <position>

mat3 derived_frame() {
    vec3 n = normalized_or(normal_world, vec3(0.0, 0.0, 1.0));
    vec3 right_world = rescaled(dFdx(position_world));
    vec3 up_world = dFdy(position_world) * rescaling(dFdx(position_world));
    vec2 right_texture = dFdx(texcoord_surface);
    vec2 up_texture = dFdy(texcoord_surface);
    float area = right_texture.x * up_texture.y - right_texture.y * up_texture.x;
    vec3 along_u = right_world * up_texture.y - up_world * right_texture.y;
    along_u = rescaled(along_u) * sign(area);
    vec3 tangent = normalized_or(along_u - n * dot(n, along_u), vec3(0.0));
    // Texture and surface have the same orientation if both areas have one sign; v grows downwards.
    float turned = sign(area) * sign(dot(n, cross(right_world, up_world)));
    return mat3(tangent, -turned * cross(n, tangent), n);
}

mat3 frame_of_derivatives = derived_frame();

mat3 world_from_tangent() { return frame_of_derivatives; }
