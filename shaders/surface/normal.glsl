// SPDX-License-Identifier: Apache-2.0
// The surface for directional, diffuse light: its normal alone.

#include <normal>

struct Surface {
    vec3 normal_world;
};

Surface surface_here() { return Surface(shading_normal()); }
