// SPDX-License-Identifier: Apache-2.0
// The default lamps go with the camera, wherever it looks.
#include "relief/shade/default_view.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "support/angle.h"

namespace relief {
namespace {

TEST(DefaultView, TheKeyLightComesFromTheViewersUpperLeft) {
    Scene scene;
    add_default_lights(scene, Camera{});
    ASSERT_EQ(scene.directional_lights.size(), 2U);
    const glm::vec3 key = scene.directional_lights[0].direction_world;
    EXPECT_GT(key.x, 0.0F);
    EXPECT_LT(key.y, 0.0F);
    EXPECT_LT(key.z, 0.0F);
    // Slanting: on a surface that faces the viewer it falls at more than 60 degrees.
    EXPECT_GT(test::degrees_between(-key, glm::vec3(0, 0, 1)), 60.0);
    EXPECT_GT(scene.directional_lights[0].irradiance.r,
              4.0F * scene.directional_lights[1].irradiance.r);
    EXPECT_FLOAT_EQ(scene.ambient.g, 0.08F);
}

TEST(DefaultView, TurningTheCameraTurnsTheLamps) {
    Scene still;
    add_default_lights(still, Camera{});
    Camera turned;
    turned.world_from_view =
        glm::rotate(glm::translate(glm::mat4(1.0F), {5, 6, 7}), 1.25F, glm::vec3(0.6F, 0.0F, 0.8F));
    Scene scene;
    add_default_lights(scene, turned);
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::vec3 expected =
            glm::mat3(turned.world_from_view) * still.directional_lights[i].direction_world;
        EXPECT_LT(glm::length(scene.directional_lights[i].direction_world - expected), 1e-6F);
    }
}

}  // namespace
}  // namespace relief
