// SPDX-License-Identifier: Apache-2.0
// The environment's light, scattered.

#include "common/diffuse_color.glsl"
#include "light/environment_irradiance.glsl"
#include <occlusion>

void add_environment_light(Surface surface, inout Lighting lighting) {
    lighting.scattered +=
        diffuse_color * environment_irradiance(surface.normal_world) * occlusion();
}
