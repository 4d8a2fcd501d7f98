// SPDX-License-Identifier: Apache-2.0
// The environment's light, scattered as far as the surface does not mirror it.

#include "common/environment_brdf.glsl"
#include "light/environment_irradiance.glsl"
#include <occlusion>

void add_environment_light(Surface surface, inout Lighting lighting) {
    vec3 received = environment_irradiance(surface.normal_world) * occlusion();
    lighting.scattered += received * (vec3(1.0) - directional_albedo(surface));
}
