// SPDX-License-Identifier: Apache-2.0
// The shading normal at a fragment, and the side that it faces.

//@part interpolated implements normal
// The interpolated normal, normalized; (0,0,1) if it is zero.

//@include "inputs.glsl#normal"
//@include "vector.glsl#normalized_or"
//@include <facing>

vec3 shading_normal() { return facing() * normalized_or(normal_world, vec3(0.0, 0.0, 1.0)); }

//@part flat implements normal
// The normal of the triangle's plane, from the screen-space derivatives of the position, on the
// side that the eye sees: if the plane is nearly edge-on, the next pixel may lie beyond its
// horizon, which flips the derivatives. (0,0,1) if the triangle is edge-on.

//@include "inputs.glsl#eye"
//@include "vector.glsl#normalized_or"
//@include "vector.glsl#rescaled"
//@include <position>

vec3 across_facet = cross(rescaled(dFdx(position_world)), rescaled(dFdy(position_world)));

vec3 shading_normal() {
    vec3 normal = normalized_or(rescaled(across_facet), vec3(0.0, 0.0, 1.0));
    return dot(normal, to_eye(position_world)) < 0.0 ? -normal : normal;
}

//@part perturbed implements normal
// The normal perturbed by a normal map or a bump map: <detail> gives a vector in tangent space, and
// <frame> the tangent frame. If the map's vector is shorter than the rounding of its codes, or the
// frame is degenerate, the interpolated normal stands in, and (0,0,1) if that is zero too.

//@include "vector.glsl#normalized_or"
//@include <detail>
//@include <frame>
//@include <facing>

vec3 shading_normal() {
    vec3 bend = normal_tangent();
    mat3 frame = world_from_tangent();
    vec3 bent_world = bend.x * frame[0] + bend.y * frame[1] + bend.z * frame[2];
    bool bends = dot(bend, bend) > 1e-12 && has_direction(bent_world);
    return facing() * normalized_or(bends ? bent_world : frame[2], vec3(0.0, 0.0, 1.0));
}

//@part both_sides implements facing
// Both sides are drawn, and a back face has the opposite normal.

float facing() { return gl_FrontFacing ? 1.0 : -1.0; }

//@neutral facing
float facing() { return 1.0; }
