// SPDX-License-Identifier: Apache-2.0
// An exercise (../tangent-space.json): a part of shaders/tangent_frame.glsl with a hole.

//@part stored implements frame
// The mesh's tangent frame as interpolated. A normal map stores vectors in this frame.

//@include "inputs.glsl#normal"

in vec4 tangent_world;

mat3 world_from_tangent() {
    // TODO: this bitangent is right on one of the two sides alone.
    vec3 bitangent_world = cross(normal_world, tangent_world.xyz);
    return mat3(tangent_world.xyz, bitangent_world, normal_world);
}
