// SPDX-License-Identifier: Apache-2.0
#include "window/view_handles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "window/viewer_state.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

const BoundingSphere sphere{{1.0F, 2.0F, 3.0F}, 2.0F};

OrbitCamera camera_at(float azimuth, float elevation, bool orthographic = false) {
    return {sphere.center, azimuth, elevation, 8.0F, 0.6F, orthographic};
}

/// The largest difference of a component. Positions are of the size of 1, in single precision.
constexpr float tolerance = 2e-5F;

TEST(AxisEnds, LieAsTheCameraSeesThem) {
    const auto front = axis_ends(camera_at(0.0F, 0.0F));
    EXPECT_EQ(front.back().name, std::string("+z")) << "the nearest one comes last";
    EXPECT_NEAR(front.back().depth, 1.0F, tolerance);
    for (const AxisEnd& end : front) {
        const std::string name = end.name;
        if (name.ends_with("x")) {
            EXPECT_NEAR(end.direction.x, name == "+x" ? 1.0F : -1.0F, tolerance);
        }
        if (name.ends_with("y")) {
            EXPECT_NEAR(end.direction.y, name == "+y" ? 1.0F : -1.0F, tolerance);
        }
    }
}

TEST(AxisEnds, PointAtTheCameraAfterTheirAction) {
    for (const AxisEnd& end : axis_ends(camera_at(0.4F, 0.3F))) {
        ViewerState state{ViewOptions{}};
        state.act(end.action);
        const auto after = axis_ends(state.camera());
        EXPECT_EQ(after.back().name, std::string(end.name));
        EXPECT_NEAR(after.back().depth, 1.0F, tolerance);
    }
}

TEST(Projected, IsTheInverseOfTheRay) {
    for (const bool orthographic : {false, true}) {
        const Camera camera = camera_of(camera_at(0.7F, -0.4F, orthographic), sphere);
        for (const glm::vec2 pointer : {glm::vec2(0.0F), glm::vec2(0.5F, -0.8F)}) {
            const Ray ray = ray_through(camera, pointer);
            const auto again = projected(camera, ray.origin + 3.0F * ray.direction);
            ASSERT_TRUE(again);
            EXPECT_LT(glm::distance(*again, pointer), tolerance);
        }
        if (!orthographic) {
            const Ray ray = ray_through(camera, glm::vec2(0.0F));
            EXPECT_FALSE(projected(camera, ray.origin - ray.direction)) << "behind the camera";
        }
    }
}

glm::vec2 handle_on_view(const AnyLight& light, const Camera& camera) {
    return projected(camera, handle_of(light, sphere)).value();
}

TEST(LightDragTest, DirectionalHandleFollowsThePointerOnItsSide) {
    for (const bool orthographic : {false, true}) {
        for (const float side : {1.0F, -1.0F}) {
            SCOPED_TRACE(testing::Message() << orthographic << side);
            const Camera camera = camera_of(camera_at(0.0F, 0.0F, orthographic), sphere);
            DirectionalLight light;  // From the front, or from behind.
            light.direction_world = glm::vec3(0.1F, -0.2F, -side);
            const glm::vec2 begin = handle_on_view(light, camera);
            const glm::vec2 grip = begin + glm::vec2(0.01F, 0.0F);  // Beside its center.
            LightDrag drag(light, camera, sphere, grip);
            const AnyLight same = drag.moved(light, camera, sphere, grip);
            const auto direction = [](const AnyLight& one) {
                return glm::normalize(std::get<DirectionalLight>(one).direction_world);
            };
            EXPECT_LT(glm::distance(direction(same), direction(light)), 1e-3F)
                << "it does not jump";
            const AnyLight moved = drag.moved(same, camera, sphere, grip + glm::vec2(0.2F, 0.1F));
            EXPECT_LT(glm::distance(handle_on_view(moved, camera), begin + glm::vec2(0.2F, 0.1F)),
                      tolerance);
            EXPECT_LT(side * direction(moved).z, 0.0F) << "the same side";
            EXPECT_NEAR(glm::length(std::get<DirectionalLight>(moved).direction_world), 1.0F,
                        tolerance);
        }
    }
}

TEST(LightDragTest, LeavingTheSphereAndComingBackChangesTheSide) {
    const Camera camera = camera_of(camera_at(0.0F, 0.0F), sphere);
    AnyLight light = DirectionalLight{.direction_world = {0.0F, 0.0F, -1.0F}};
    LightDrag drag(light, camera, sphere, glm::vec2(0.0F));
    light = drag.moved(light, camera, sphere, {1.0F, 0.0F});
    const glm::vec3 outside = std::get<DirectionalLight>(light).direction_world;
    EXPECT_LT(outside.x, -0.9F) << "on the outline, at the right";
    light = drag.moved(light, camera, sphere, {0.1F, 0.0F});
    EXPECT_GT(std::get<DirectionalLight>(light).direction_world.z, 0.9F) << "from behind";
    light = drag.moved(light, camera, sphere, {0.0F, 1.0F});
    light = drag.moved(light, camera, sphere, {0.0F, 0.1F});
    EXPECT_LT(std::get<DirectionalLight>(light).direction_world.z, -0.9F) << "from the front";
}

TEST(LightDragTest, PointLightMovesParallelToTheView) {
    const Camera camera = camera_of(camera_at(0.9F, 0.5F), sphere);
    SpotLight spot;
    spot.point.position_world = {2.0F, 3.0F, 2.5F};
    spot.direction_world = {0.0F, -1.0F, 0.0F};
    const glm::vec3 back(camera.world_from_view[2]);
    for (const AnyLight& light : {AnyLight(spot.point), AnyLight(spot)}) {
        const glm::vec2 begin = handle_on_view(light, camera);
        LightDrag drag(light, camera, sphere, begin);
        const AnyLight moved = drag.moved(light, camera, sphere, begin + glm::vec2(-0.3F, 0.2F));
        EXPECT_LT(glm::distance(handle_on_view(moved, camera), begin + glm::vec2(-0.3F, 0.2F)),
                  tolerance);
        EXPECT_NEAR(glm::dot(handle_of(moved, sphere) - handle_of(light, sphere), back), 0.0F,
                    tolerance);
        if (const auto* const moved_spot = std::get_if<SpotLight>(&moved)) {
            EXPECT_EQ(moved_spot->direction_world, spot.direction_world);
        }
    }
}

}  // namespace
}  // namespace relief::tools
