// SPDX-License-Identifier: Apache-2.0
// The Surface structure: the values that shading needs at a point. Each part holds no more than its
// scene needs; metallic_roughness.glsl has those of glTF's model.

//@part none implements surface
// No light and no reflection: the orientation of the surface is not needed.

struct Surface {
    bool unused;
};

Surface surface_here() { return Surface(false); }

//@part normal implements surface
// For diffuse surfaces under directional lights: the normal.

//@include <normal>

struct Surface {
    vec3 normal_world;
};

Surface surface_here() { return Surface(shading_normal()); }

//@part position implements surface
// For point and spot lights: normal and position.

//@include <position>
//@include <normal>

struct Surface {
    vec3 normal_world;
    vec3 position_world;
};

Surface surface_here() { return Surface(shading_normal(), position_world); }

//@part view implements surface
// For highlights and reflections: normal, position, and the unit vector to the eye. If the eye is
// at the surface, that vector is the normal.

//@include "inputs.glsl#eye"
//@include "vector.glsl#normalized_or"
//@include <position>
//@include <normal>

struct Surface {
    vec3 normal_world;
    vec3 position_world;
    vec3 view_world;
};

Surface surface_here() {
    vec3 normal = shading_normal();
    return Surface(normal, position_world, normalized_or(to_eye(position_world), normal));
}
