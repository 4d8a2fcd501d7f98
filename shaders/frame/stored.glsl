// SPDX-License-Identifier: Apache-2.0
// The mesh's tangent frame, as interpolated, not made unit and not made perpendicular, with the
// bitangent formed here: a baker that assumes the same (MikkTSpace) is then undone exactly.

in vec3 normal_world;
in vec4 tangent_world;

mat3 world_from_tangent() {
    vec3 bitangent_world = tangent_world.w * cross(normal_world, tangent_world.xyz);
    return mat3(tangent_world.xyz, bitangent_world, normal_world);
}
