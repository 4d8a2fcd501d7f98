// SPDX-License-Identifier: Apache-2.0
#include "window/orbit_camera.h"
#include "support/angle.h"

#include <gtest/gtest.h>

#include <random>

#include <cmath>
#include <numbers>

namespace relief::tools {
namespace {

using test::half_turn;
const Ball unit_ball{{0.0F, 0.0F, 0.0F}, 1.0F};

glm::vec3 eye_of(const OrbitCamera& orbit) {
    return glm::vec3(camera_of(orbit, unit_ball).world_from_view[3]);
}

/// Where a point is on a view of this size, in pixels from its centre, y down.
glm::vec2 seen(const OrbitCamera& orbit, const glm::vec3& point, int view_height) {
    const Camera camera = camera_of(orbit, unit_ball);
    const glm::vec4 view = glm::inverse(camera.world_from_view) * glm::vec4(point, 1.0F);
    const float scale =
        0.5F * static_cast<float>(view_height) / std::tan(0.5F * camera.vertical_fov);
    return {scale * view.x / -view.z, scale * view.y / view.z};
}

TEST(OrbitCamera, LooksFromAzimuthAndElevation) {
    OrbitCamera orbit;
    orbit.distance = 3.0F;
    EXPECT_NEAR(glm::distance(eye_of(orbit), {0, 0, 3}), 0.0F, 1e-6F);
    orbit.azimuth = 0.5F * half_turn;
    EXPECT_NEAR(glm::distance(eye_of(orbit), {3, 0, 0}), 0.0F, 1e-6F);
    orbit.elevation = 0.5F * half_turn;
    EXPECT_NEAR(glm::distance(eye_of(orbit), {0, 3, 0}), 0.0F, 1e-6F);
}

TEST(OrbitCamera, ADragOverTheHeightIsHalfATurnAndPolesStop) {
    OrbitCamera orbit;
    orbit_by(orbit, {400.0F, 0.0F}, 800);
    EXPECT_NEAR(orbit.azimuth, -0.5F * half_turn, 1e-6F);
    orbit_by(orbit, {0.0F, 4000.0F}, 800);
    EXPECT_EQ(orbit.elevation, 0.5F * half_turn);
    for (int i = 0; i < 1000; ++i)
        orbit_by(orbit, {800.0F, 0.0F}, 800);
    EXPECT_LE(std::abs(orbit.azimuth), half_turn + 1e-5F);
}

TEST(OrbitCamera, PanningKeepsTheTargetUnderThePointer) {
    OrbitCamera orbit;
    orbit.azimuth = 0.7F;
    orbit.elevation = 0.4F;
    orbit.distance = 5.0F;
    const glm::vec3 point = orbit.target;
    pan_by(orbit, {30.0F, -50.0F}, 600);
    const glm::vec2 place = seen(orbit, point, 600);
    EXPECT_NEAR(place.x, 30.0F, 1e-2F);
    EXPECT_NEAR(place.y, -50.0F, 1e-2F);
}

TEST(OrbitCamera, ZoomingKeepsWhatIsUnderThePointerAndStops) {
    OrbitCamera orbit;
    orbit.distance = 4.0F;
    const glm::vec2 pointer(0.5F, 0.25F);  // In halves of the height, y up.
    const float half_height = orbit.distance * std::tan(0.5F * orbit.vertical_fov);
    const glm::vec3 point(pointer.x * half_height, pointer.y * half_height, 0.0F);
    zoom_by(orbit, 3.0F, pointer, unit_ball);
    EXPECT_NEAR(orbit.distance, 4.0F * 0.9F * 0.9F * 0.9F, 1e-5F);
    const glm::vec2 place = seen(orbit, point, 200);
    EXPECT_NEAR(place.x, 50.0F, 1e-2F);
    EXPECT_NEAR(place.y, -25.0F, 1e-2F);
    zoom_by(orbit, 1e6F, {}, unit_ball);
    EXPECT_GT(orbit.distance, 0.0F);
    zoom_by(orbit, -1e6F, {}, unit_ball);
    EXPECT_LE(orbit.distance, 1e4F);
}

TEST(OrbitCamera, FittingShowsAllOfTheBall) {
    for (const float aspect : {0.5F, 1.0F, 2.0F}) {
        OrbitCamera orbit;
        orbit.azimuth = 1.0F;
        const Ball ball{{5.0F, -3.0F, 2.0F}, 2.0F};
        fit(orbit, ball, aspect);
        EXPECT_EQ(orbit.target, ball.center);
        const float half = std::min(0.5F * orbit.vertical_fov,
                                    std::atan(std::tan(0.5F * orbit.vertical_fov) * aspect));
        // The ball's rim is 4% inside of the narrower side.
        EXPECT_NEAR(std::asin(ball.radius / orbit.distance) / half, 1.0F, 0.05F);
        EXPECT_LT(std::asin(ball.radius / orbit.distance), half);
    }
}

TEST(OrbitCamera, TakesOverAnotherCamera) {
    OrbitCamera orbit;
    orbit.target = {0.2F, -0.1F, 0.3F};
    orbit.azimuth = -2.0F;
    orbit.elevation = 0.6F;
    orbit.distance = 4.0F;
    const Camera camera = camera_of(orbit, unit_ball);
    const Camera again = camera_of(orbit_of(camera, unit_ball), unit_ball);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            EXPECT_NEAR(again.world_from_view[column][row], camera.world_from_view[column][row],
                        2e-6F);
        }
    }
}

TEST(OrbitCamera, DepthEnclosesTheBall) {
    OrbitCamera orbit;
    orbit.distance = 10.0F;
    const Camera far_away = camera_of(orbit, unit_ball);
    EXPECT_LT(far_away.near, 9.0F);
    EXPECT_GT(far_away.far, 11.0F);
    orbit.distance = 0.01F;
    const Camera inside = camera_of(orbit, unit_ball);
    EXPECT_GT(inside.near, 0.0F);
    EXPECT_GT(inside.far, 1.0F);
}

TEST(OrbitCamera, BallsOfNothingHaveASize) {
    EXPECT_EQ(ball_around(Bounds{}).radius, 1.0F);
    Bounds point;
    point.min = point.max = {3.0F, 4.0F, 5.0F};
    EXPECT_EQ(ball_around(point).radius, 1.0F);
    EXPECT_EQ(ball_around(point).center, glm::vec3(3.0F, 4.0F, 5.0F));
}

TEST(OrbitCamera, SaysItselfAsText) {
    OrbitCamera orbit;
    orbit.azimuth = glm::radians(30.0F);
    orbit.target = {0.0F, 0.5F, 0.0F};
    orbit.distance = 3.25F;
    EXPECT_EQ(to_text(orbit), "30,0@0,0.5,0,3.25");
}

TEST(OrbitCamera, ComesBackFromItsTextBitForBit) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> angle(-3.14159F, 3.14159F);
    std::uniform_real_distribution<float> length(-10.0F, 10.0F);
    for (int i = 0; i < 2000; ++i) {
        OrbitCamera orbit;
        orbit.target = {length(random), 1e-4F * length(random), 1e4F * length(random)};
        orbit.azimuth = angle(random);
        orbit.elevation = 0.5F * angle(random);
        orbit.distance = std::exp(length(random));
        orbit.vertical_fov = std::abs(angle(random)) * 0.9F + 0.02F;
        const CameraOption read = parse_camera("", to_text(orbit));
        ASSERT_TRUE(read.place);
        const float fov = parse_fov("", degrees_text(orbit.vertical_fov));
        const Camera again = camera_of(orbit_of(read, *read.place, fov), unit_ball);
        const Camera camera = camera_of(orbit, unit_ball);
        ASSERT_EQ(again.world_from_view, camera.world_from_view) << to_text(orbit);
        ASSERT_EQ(again.vertical_fov, camera.vertical_fov);
    }
}

}  // namespace
}  // namespace relief::tools
