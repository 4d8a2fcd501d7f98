// SPDX-License-Identifier: Apache-2.0
// The surface for lights that have a place: normal and point.

#include <position>
#include <normal>

struct Surface {
    vec3 normal_world;
    vec3 position_world;
};

Surface surface_here() { return Surface(shading_normal(), position_world); }
