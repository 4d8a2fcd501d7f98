// SPDX-License-Identifier: Apache-2.0
// The normal bent by what is known of it in tangent space. Where that is nothing (shorter than the
// rounding of a map's codes), or the frame spans nothing, the interpolated normal stands in, and
// (0,0,1) where that has no length either.

#include "common/normalized_or.glsl"
#include <detail>
#include <frame>
#include <facing>

vec3 shading_normal() {
    vec3 bend = normal_tangent();
    mat3 frame = world_from_tangent();
    vec3 bent_world = bend.x * frame[0] + bend.y * frame[1] + bend.z * frame[2];
    bool bends = dot(bend, bend) > 1e-12 && has_direction(bent_world);
    return facing() * normalized_or(bends ? bent_world : frame[2], vec3(0.0, 0.0, 1.0));
}
