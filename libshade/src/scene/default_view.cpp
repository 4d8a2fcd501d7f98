// SPDX-License-Identifier: Apache-2.0
// Two lamps that go with the camera. Tests: tests/shade/scene/default_view_test.cpp.
#include "relief/shade/default_view.h"

namespace relief {

void add_default_lights(Scene& scene, const Camera& camera) {
    constexpr float ambient = 0.08F;
    const glm::mat3 world_from_view(camera.world_from_view);
    const glm::vec3 to_key_view{-0.7F, 0.64F, 0.32F};
    const glm::vec3 to_fill_view{0.85F, 0.05F, 0.5F};
    scene.directional_lights.push_back(
        {.direction_world = world_from_view * -to_key_view, .irradiance = {1.0F, 0.97F, 0.92F}});
    scene.directional_lights.push_back(
        {.direction_world = world_from_view * -to_fill_view, .irradiance = {0.18F, 0.2F, 0.23F}});
    scene.ambient = glm::vec3(ambient);
}

}  // namespace relief
