// SPDX-License-Identifier: Apache-2.0
// glTF's surfaces in an environment: the blurred surroundings, by the share of light from
// everywhere that GGX facets mirror. Source: [Karis, SIGGRAPH 2013].

#include "common/environment_brdf.glsl"
#include "common/blurred_environment.glsl"
#include <occlusion>

vec3 with_reflection(Surface surface, vec3 scattered) {
    vec3 mirrored_world = reflect(-surface.view_world, surface.normal_world);
    vec3 mirrored = blurred_radiance(mirrored_world, surface.roughness) * occlusion();
    return scattered + mirrored * directional_albedo(surface);
}
