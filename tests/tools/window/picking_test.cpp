// SPDX-License-Identifier: Apache-2.0
#include "window/picking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "support/shapes.h"

namespace relief::tools {
namespace {

Scene scene_of(Mesh mesh, const glm::mat4& placed = glm::mat4(1.0F)) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    Instance instance;
    instance.world_from_object = placed;
    scene.instances.push_back(instance);
    return scene;
}

Mesh triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Mesh mesh;
    mesh.positions = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

TEST(Picking, FindsTheNearestOfAllSides) {
    const Scene scene = scene_of(test::cube());
    float side = 0.0F;
    for (const glm::vec3& position : scene.meshes[0]->positions)
        side = std::max(side, position.z);
    const std::optional<glm::vec3> front = surface_on(scene, {{0.1F, 0.2F, 9.0F}, {0, 0, -2.0F}});
    ASSERT_TRUE(front);
    EXPECT_NEAR(glm::distance(*front, {0.1F, 0.2F, side}), 0.0F, 1e-6F);
    EXPECT_FALSE(surface_on(scene, {{0.1F, 0.2F, 9.0F}, {0, 0, 1}})) << "behind the eye";
    EXPECT_FALSE(surface_on(scene, {{5.0F, 0.2F, 9.0F}, {0, 0, -1}})) << "beside it";
    // From within, the inside is seen.
    EXPECT_TRUE(surface_on(scene, {{0.1F, 0.2F, 0.0F}, {0, 0, -1}}));
}

TEST(Picking, GoesWhereInstancesAreMovedAndScaled) {
    glm::mat4 placed = glm::translate(glm::mat4(1.0F), {10.0F, 0.0F, -5.0F});
    placed = glm::scale(placed, {3.0F, -2.0F, 1.0F});  // Mirrored, too.
    const Scene scene = scene_of(triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), placed);
    const std::optional<glm::vec3> point = surface_on(scene, {{10.5F, 0.5F, 2.0F}, {0, 0, -0.1F}});
    ASSERT_TRUE(point);
    EXPECT_NEAR(glm::distance(*point, {10.5F, 0.5F, -5.0F}), 0.0F, 1e-5F);
}

TEST(Picking, NothingIsHitWhereThereIsNothing) {
    EXPECT_FALSE(surface_on(Scene{}, Ray{}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(surface_on(scene_of(triangle({0, 0, -1}, {0, 0, -1}, {0, 0, -1})), Ray{}));
    EXPECT_FALSE(surface_on(scene_of(triangle({nan, 0, -1}, {1, 0, -1}, {0, 1, -1})), Ray{}));
}

TEST(Picking, RaysGoThroughThePointer) {
    OrbitCamera orbit;
    orbit.distance = 4.0F;
    orbit.vertical_fov = glm::radians(90.0F);
    const Ray ray = ray_through(camera_of(orbit, Ball{}), {0.5F, -0.25F});
    // At a distance of 4, half of the height is 4.
    const glm::vec3 at = ray.origin + 4.0F * ray.direction;
    EXPECT_NEAR(glm::distance(at, {2.0F, -1.0F, 0.0F}), 0.0F, 1e-5F);
}

TEST(Picking, AimingKeepsTheDirectionAndTheSize) {
    OrbitCamera orbit;
    orbit.azimuth = 0.5F;
    orbit.elevation = 0.3F;
    orbit.distance = 4.0F;
    const Camera before = camera_of(orbit, Ball{});
    const glm::vec3 point(0.4F, 0.1F, -0.3F);
    const float depth = -(glm::inverse(before.world_from_view) * glm::vec4(point, 1.0F)).z;
    aim_at(orbit, point);
    EXPECT_EQ(orbit.target, point);
    EXPECT_NEAR(orbit.distance, depth, 1e-5F);
    EXPECT_EQ(orbit.azimuth, 0.5F);
    const OrbitCamera aimed = orbit;
    aim_at(orbit, glm::vec3(camera_of(orbit, Ball{}).world_from_view[3]) * 2.0F);
    EXPECT_EQ(orbit.target, aimed.target) << "behind the eye";
}

}  // namespace
}  // namespace relief::tools
