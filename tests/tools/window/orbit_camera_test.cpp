// SPDX-License-Identifier: Apache-2.0
#include "window/orbit_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "light_options.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::half_turn;

const BoundingSphere unit_sphere{{0.0F, 0.0F, 0.0F}, 1.0F};

glm::vec3 eye_of(const OrbitCamera& orbit) {
    return glm::vec3(camera_of(orbit, unit_sphere).world_from_view[3]);
}

/// The position of a point in pixels from the center of the view, y down.
glm::vec2 seen(const OrbitCamera& orbit, const glm::vec3& point, int view_height) {
    const Camera camera = camera_of(orbit, unit_sphere);
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

TEST(OrbitCamera, DragOverTheHeightIsHalfATurnAndPolesLimitIt) {
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

TEST(OrbitCamera, ZoomingKeepsThePointUnderThePointerAndIsLimited) {
    OrbitCamera orbit;
    orbit.distance = 4.0F;
    const glm::vec2 pointer(0.5F, 0.25F);  // In halves of the height, y up.
    const float half_height = orbit.distance * std::tan(0.5F * orbit.vertical_fov);
    const glm::vec3 point(pointer.x * half_height, pointer.y * half_height, 0.0F);
    zoom_by(orbit, 3.0F, pointer, unit_sphere);
    EXPECT_NEAR(orbit.distance, 4.0F * 0.9F * 0.9F * 0.9F, 1e-5F);
    const glm::vec2 place = seen(orbit, point, 200);
    EXPECT_NEAR(place.x, 50.0F, 1e-2F);
    EXPECT_NEAR(place.y, -25.0F, 1e-2F);
    zoom_by(orbit, 1e6F, {}, unit_sphere);
    EXPECT_GT(orbit.distance, 0.0F);
    zoom_by(orbit, -1e6F, {}, unit_sphere);
    EXPECT_LE(orbit.distance, 1e4F);
}

TEST(OrbitCamera, FittingShowsTheWholeSphere) {
    for (const float aspect : {0.5F, 1.0F, 2.0F}) {
        OrbitCamera orbit;
        orbit.azimuth = 1.0F;
        const BoundingSphere sphere{{5.0F, -3.0F, 2.0F}, 2.0F};
        fit(orbit, sphere, aspect);
        EXPECT_EQ(orbit.target, sphere.center);
        const float half = std::min(0.5F * orbit.vertical_fov,
                                    std::atan(std::tan(0.5F * orbit.vertical_fov) * aspect));
        // The sphere leaves a margin of 4 %.
        EXPECT_NEAR(std::asin(sphere.radius / orbit.distance) / half, 1.0F, 0.05F);
        EXPECT_LT(std::asin(sphere.radius / orbit.distance), half);
    }
}

TEST(OrbitCamera, ParallelProjectionKeepsTheSizeAtTheTarget) {
    OrbitCamera orbit;
    orbit.target = {1.0F, 2.0F, 3.0F};
    orbit.azimuth = 0.4F;
    orbit.distance = 0.2F;  // Within the sphere.
    orbit.vertical_fov = glm::radians(60.0F);
    orbit.orthographic = true;
    const Camera camera = camera_of(orbit, unit_sphere);
    EXPECT_NEAR(camera.orthographic_height.value(), 0.4F * std::tan(glm::radians(30.0F)), 1e-6F);
    const glm::vec3 back(camera.world_from_view[2]);
    EXPECT_GT(glm::dot(glm::vec3(camera.world_from_view[3]), back), 1.0F)
        << "the whole sphere is in front of the camera";
    const Ray ray = ray_through(camera, {0.0F, 1.0F});
    EXPECT_NEAR(glm::dot(ray.direction, -back), 1.0F, 1e-6F);
    EXPECT_NEAR(glm::dot(ray.origin - orbit.target, glm::vec3(camera.world_from_view[1])),
                0.5F * *camera.orthographic_height, 1e-6F);
    const Camera again = camera_of(orbit_of(camera, unit_sphere), unit_sphere);
    EXPECT_NEAR(*again.orthographic_height, *camera.orthographic_height, 1e-6F);
    EXPECT_NEAR(glm::distance(again.world_from_view[2], camera.world_from_view[2]), 0.0F, 1e-6F);
    fit(orbit, unit_sphere, 2.0F);
    EXPECT_NEAR(camera_of(orbit, unit_sphere).orthographic_height.value(), 2.08F, 1e-5F);
}

TEST(OrbitCamera, TakesOverAnotherCamera) {
    OrbitCamera orbit;
    orbit.target = {0.2F, -0.1F, 0.3F};
    orbit.azimuth = -2.0F;
    orbit.elevation = 0.6F;
    orbit.distance = 4.0F;
    const Camera camera = camera_of(orbit, unit_sphere);
    const Camera again = camera_of(orbit_of(camera, unit_sphere), unit_sphere);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            EXPECT_NEAR(again.world_from_view[column][row], camera.world_from_view[column][row],
                        2e-6F);
        }
    }
}

TEST(OrbitCamera, DepthRangeEnclosesTheSphere) {
    OrbitCamera orbit;
    orbit.distance = 10.0F;
    const Camera far_away = camera_of(orbit, unit_sphere);
    EXPECT_LT(far_away.near, 9.0F);
    EXPECT_GT(far_away.far, 11.0F);
    orbit.distance = 0.01F;
    const Camera inside = camera_of(orbit, unit_sphere);
    EXPECT_GT(inside.near, 0.0F);
    EXPECT_GT(inside.far, 1.0F);
}

TEST(OrbitCamera, EmptyBoundsHaveASphere) {
    EXPECT_EQ(bounding_sphere(Bounds{}).radius, 1.0F);
    Bounds point;
    point.min = point.max = {3.0F, 4.0F, 5.0F};
    EXPECT_EQ(bounding_sphere(point).radius, 1.0F);
    EXPECT_EQ(bounding_sphere(point).center, glm::vec3(3.0F, 4.0F, 5.0F));
}

TEST(OrbitCamera, IsWrittenAsText) {
    OrbitCamera orbit;
    orbit.azimuth = glm::radians(30.0F);
    orbit.target = {0.0F, 0.5F, 0.0F};
    orbit.distance = 3.25F;
    EXPECT_EQ(to_text(orbit), "30,0@0,0.5,0,3.25");
}

TEST(OrbitCamera, IsReadBackFromItsTextBitForBit) {
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
        const Camera again = camera_of(orbit_of(read, *read.place, fov, false), unit_sphere);
        const Camera camera = camera_of(orbit, unit_sphere);
        ASSERT_EQ(again.world_from_view, camera.world_from_view) << to_text(orbit);
        ASSERT_EQ(again.vertical_fov, camera.vertical_fov);
    }
}

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

TEST(Picking, FindsTheNearestSide) {
    const Scene scene = scene_of(test::cube());
    float side = 0.0F;
    for (const glm::vec3& position : scene.meshes[0]->positions)
        side = std::max(side, position.z);
    const std::optional<glm::vec3> front = surface_hit(scene, {{0.1F, 0.2F, 9.0F}, {0, 0, -2.0F}});
    ASSERT_TRUE(front);
    EXPECT_NEAR(glm::distance(*front, {0.1F, 0.2F, side}), 0.0F, 1e-6F);
    EXPECT_FALSE(surface_hit(scene, {{0.1F, 0.2F, 9.0F}, {0, 0, 1}})) << "behind the eye";
    EXPECT_FALSE(surface_hit(scene, {{5.0F, 0.2F, 9.0F}, {0, 0, -1}})) << "beside it";
    // From inside, the back side is hit.
    EXPECT_TRUE(surface_hit(scene, {{0.1F, 0.2F, 0.0F}, {0, 0, -1}}));
}

TEST(Picking, FollowsTransformedInstances) {
    glm::mat4 placed = glm::translate(glm::mat4(1.0F), {10.0F, 0.0F, -5.0F});
    placed = glm::scale(placed, {3.0F, -2.0F, 1.0F});  // The scale also mirrors.
    const Scene scene = scene_of(triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), placed);
    const std::optional<glm::vec3> point = surface_hit(scene, {{10.5F, 0.5F, 2.0F}, {0, 0, -0.1F}});
    ASSERT_TRUE(point);
    EXPECT_NEAR(glm::distance(*point, {10.5F, 0.5F, -5.0F}), 0.0F, 1e-5F);
}

TEST(Picking, HitsNoInvalidTriangles) {
    EXPECT_FALSE(surface_hit(Scene{}, Ray{}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(surface_hit(scene_of(triangle({0, 0, -1}, {0, 0, -1}, {0, 0, -1})), Ray{}));
    EXPECT_FALSE(surface_hit(scene_of(triangle({nan, 0, -1}, {1, 0, -1}, {0, 1, -1})), Ray{}));
}

TEST(Picking, RaysPassThroughThePointer) {
    OrbitCamera orbit;
    orbit.distance = 4.0F;
    orbit.vertical_fov = glm::radians(90.0F);
    const Ray ray = ray_through(camera_of(orbit, BoundingSphere{}), {0.5F, -0.25F});
    // At distance 4, half of the height is 4.
    const glm::vec3 at = ray.origin + 4.0F * ray.direction;
    EXPECT_NEAR(glm::distance(at, {2.0F, -1.0F, 0.0F}), 0.0F, 1e-5F);
}

TEST(Picking, AimingKeepsTheDirectionAndTheSize) {
    OrbitCamera orbit;
    orbit.azimuth = 0.5F;
    orbit.elevation = 0.3F;
    orbit.distance = 4.0F;
    const Camera before = camera_of(orbit, BoundingSphere{});
    const glm::vec3 point(0.4F, 0.1F, -0.3F);
    const float depth = -(glm::inverse(before.world_from_view) * glm::vec4(point, 1.0F)).z;
    aim_at(orbit, point);
    EXPECT_EQ(orbit.target, point);
    EXPECT_NEAR(orbit.distance, depth, 1e-5F);
    EXPECT_EQ(orbit.azimuth, 0.5F);
    const OrbitCamera aimed = orbit;
    aim_at(orbit, glm::vec3(camera_of(orbit, BoundingSphere{}).world_from_view[3]) * 2.0F);
    EXPECT_EQ(orbit.target, aimed.target) << "behind the eye";
}

TEST(ViewText, IsFoundAmongOtherOptions) {
    const ViewText view = parse_view_text(
        "relief-view vase.obj --camera -30,20@0.5,1,-2,3.25 --fov 50 --size 640x480 --wireframe");
    EXPECT_EQ(view.camera.azimuth, static_cast<float>(glm::radians(-30.0)));
    ASSERT_TRUE(view.camera.place);
    EXPECT_EQ(view.camera.place->target, glm::vec3(0.5F, 1.0F, -2.0F));
    EXPECT_EQ(view.camera.place->distance, 3.25F);
    EXPECT_EQ(view.vertical_fov, static_cast<float>(glm::radians(50.0)));
}

TEST(ViewText, MayBeTheCameraAlone) {
    const ViewText view = parse_view_text(" 10,-5@0,0,0,2\n");
    EXPECT_EQ(view.camera.elevation, static_cast<float>(glm::radians(-5.0)));
    EXPECT_FALSE(view.vertical_fov);
    EXPECT_FALSE(parse_view_text("--camera=10,5").camera.place);
}

TEST(ViewText, InvalidTextIsRejected) {
    EXPECT_THROW(parse_view_text(""), UsageError);
    EXPECT_THROW(parse_view_text("two words"), UsageError);
    EXPECT_THROW(parse_view_text("--camera"), UsageError);
    for (const char* text :
         {"10,5@0,0,0", "10,5@0,0,0,0", "10,5,2@0,0,0,1", "10,95@0,0,0,1", "10,5@0,x,0,1", "10"}) {
        EXPECT_THROW(parse_view_text(text), UsageError) << text;
    }
}

}  // namespace
}  // namespace relief::tools
