// SPDX-License-Identifier: Apache-2.0
#include "window/edit_panels.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "support/invariants.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::half_turn;

const BoundingSphere lit_sphere{{1.0F, 2.0F, 3.0F}, 2.0F};

/// The irradiance of a surface in the center of the sphere that faces the light (lights.h). The
/// cone of a spotlight contains the center.
glm::vec3 irradiance_at_center(const AnyLight& light) {
    if (const auto* directional = std::get_if<DirectionalLight>(&light))
        return directional->irradiance;
    const auto* spot = std::get_if<SpotLight>(&light);
    const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(light);
    if (point.falloff == Falloff::none) return point.intensity;
    const float distance = glm::distance(point.position_world, lit_sphere.center);
    return point.intensity / (distance * distance);
}

/// The direction of the light at the center.
glm::vec3 direction_at_center(const AnyLight& light) {
    if (const auto* directional = std::get_if<DirectionalLight>(&light))
        return glm::normalize(directional->direction_world);
    const auto* spot = std::get_if<SpotLight>(&light);
    const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(light);
    return glm::normalize(lit_sphere.center - point.position_world);
}

TEST(Lights, KeepTheirIrradianceWhenTheirKindChanges) {
    DirectionalLight far;
    far.direction_world = {0.0F, -3.0F, -4.0F};
    far.irradiance = {0.5F, 1.0F, 2.0F};
    PointLight near;
    near.position_world = {1.0F, 5.0F, -1.0F};  // The distance from the center is 5.
    near.intensity = {25.0F, 50.0F, 0.0F};
    PointLight even = near;
    even.falloff = Falloff::none;
    SpotLight spot;
    spot.point = near;
    spot.direction_world = {0.0F, -3.0F, 4.0F};
    for (const AnyLight& light : {AnyLight(far), AnyLight(near), AnyLight(even), AnyLight(spot)}) {
        for (const LightType type : {LightType::directional, LightType::point, LightType::spot}) {
            SCOPED_TRACE(testing::Message()
                         << enum_name(type_of(light)) << " to " << enum_name(type));
            const AnyLight other = converted_to(light, type, lit_sphere);
            EXPECT_EQ(type_of(other), type);
            EXPECT_LT(glm::distance(irradiance_at_center(other), irradiance_at_center(light)),
                      1e-5F * glm::length(irradiance_at_center(light)));
            EXPECT_LT(glm::distance(direction_at_center(other), direction_at_center(light)), 1e-6F);
            if (const auto* turned = std::get_if<SpotLight>(&other)) {
                EXPECT_LT(glm::distance(glm::normalize(turned->direction_world),
                                        direction_at_center(light)),
                          1e-6F)
                    << "the middle is in its cone";
            }
        }
    }
}

TEST(Lights, ArePlacedOutsideTheModel) {
    for (const LightType type : {LightType::point, LightType::spot}) {
        const AnyLight light = converted_to(DirectionalLight{}, type, lit_sphere);
        const auto* spot = std::get_if<SpotLight>(&light);
        const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(light);
        EXPECT_GT(glm::distance(point.position_world, lit_sphere.center), lit_sphere.radius);
    }
}

TEST(Lights, KeepTheirHighlightColor) {
    DirectionalLight far;
    far.highlight_irradiance = glm::vec3(0.25F);
    const AnyLight point = converted_to(far, LightType::point, lit_sphere);
    const AnyLight again = converted_to(point, LightType::directional, lit_sphere);
    ASSERT_TRUE(std::get<DirectionalLight>(again).highlight_irradiance);
    EXPECT_NEAR(std::get<DirectionalLight>(again).highlight_irradiance->x, 0.25F, 1e-6F);
}

TEST(Lights, KeepTheirAmbientLightAndSwitchWhenTheirKindChanges) {
    DirectionalLight far;
    far.ambient = {0.5F, 0.25F, 0.0F};
    far.on = false;
    for (const LightType type : {LightType::point, LightType::spot}) {
        const AnyLight near = converted_to(far, type, lit_sphere);
        Scene scene;
        set_lights(scene, {near});
        EXPECT_EQ(ambient_light(scene), glm::vec3(0.0F));
        const AnyLight again = converted_to(near, LightType::directional, lit_sphere);
        EXPECT_EQ(std::get<DirectionalLight>(again).ambient, far.ambient);
        EXPECT_FALSE(std::get<DirectionalLight>(again).on);
    }
}

TEST(Lights, AtTheCenterOrWithoutADirectionStayFinite) {
    PointLight inside;
    inside.position_world = lit_sphere.center;
    DirectionalLight nowhere;
    nowhere.direction_world = glm::vec3(0.0F);
    for (const AnyLight& light : {AnyLight(inside), AnyLight(nowhere)}) {
        for (const LightType type : {LightType::directional, LightType::point, LightType::spot}) {
            if (type == type_of(light)) continue;
            Scene scene;
            set_lights(scene, {converted_to(light, type, lit_sphere)});
            EXPECT_NO_THROW(validate_transforms(scene));
        }
    }
}

TEST(Lights, AreListedByKindAndRestored) {
    Scene scene;
    scene.point_lights.resize(2);
    scene.point_lights[1].intensity = glm::vec3(7.0F);
    scene.spot_lights.resize(1);
    scene.directional_lights.resize(1);
    const std::vector<AnyLight> lights = lights_of(scene);
    ASSERT_EQ(lights.size(), 4U);
    EXPECT_EQ(type_of(lights[0]), LightType::directional);
    EXPECT_EQ(std::get<PointLight>(lights[2]).intensity.x, 7.0F);
    EXPECT_EQ(type_of(lights[3]), LightType::spot);
    Scene other;
    other.point_lights.resize(5);
    set_lights(other, lights);
    EXPECT_EQ(other.directional_lights.size(), 1U);
    ASSERT_EQ(other.point_lights.size(), 2U);
    EXPECT_EQ(other.point_lights[1].intensity.x, 7.0F);
    EXPECT_EQ(other.spot_lights.size(), 1U);
}

TEST(Lights, RotateWithTheirDirections) {
    const glm::mat3 half(glm::rotate(glm::mat4(1.0F), glm::radians(180.0F), {0.0F, 1.0F, 0.0F}));
    AnyLight spot = SpotLight{};
    std::get<SpotLight>(spot).point.position_world =
        lit_sphere.center + glm::vec3(1.0F, 2.0F, 0.0F);
    std::get<SpotLight>(spot).direction_world = {-1.0F, -2.0F, 0.0F};
    turn(spot, half, lit_sphere.center);
    EXPECT_LT(glm::distance(std::get<SpotLight>(spot).point.position_world,
                            lit_sphere.center + glm::vec3(-1.0F, 2.0F, 0.0F)),
              1e-5F);
    EXPECT_LT(glm::distance(std::get<SpotLight>(spot).direction_world, {1.0F, -2.0F, 0.0F}), 1e-5F);
}

TEST(LightRowsTest, KeepTheIdWhenTheKindChanges) {
    Scene scene;
    scene.directional_lights.resize(2);
    LightRows lights;
    lights.update(scene);
    std::vector<LightRow> rows = lights.rows(scene);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_NE(rows[0].id, rows[1].id);
    const unsigned first = rows[0].id;
    const unsigned second = rows[1].id;
    rows[0].light = converted_to(rows[0].light, LightType::spot, BoundingSphere{});
    rows[0].speed = 1.0F;
    lights.set(scene, rows);
    EXPECT_EQ(scene.spot_lights.size(), 1U);
    rows = lights.rows(scene);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].id, second);
    EXPECT_EQ(rows[1].id, first) << "spots come last";
    EXPECT_EQ(rows[1].speed, 1.0F);
    EXPECT_EQ(rows[0].speed, 0.0F);
}

TEST(LightRowsTest, GiveNewLightsNewIds) {
    Scene scene;
    scene.directional_lights.resize(1);
    LightRows lights;
    lights.update(scene);
    std::vector<LightRow> rows = lights.rows(scene);
    const unsigned first = rows[0].id;
    rows.clear();
    lights.set(scene, rows);
    rows = {{DirectionalLight{}}, {DirectionalLight{}}};
    lights.set(scene, rows);
    rows = lights.rows(scene);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_NE(rows[0].id, rows[1].id);
    EXPECT_NE(rows[0].id, first) << "removed is removed";
    EXPECT_NE(rows[1].id, first);
}

TEST(LightRowsTest, RotateAtTheirSpeeds) {
    Scene scene;
    scene.directional_lights.resize(2);
    scene.directional_lights[0].direction_world = {1.0F, -1.0F, 0.0F};
    scene.directional_lights[1].direction_world = {1.0F, -1.0F, 0.0F};
    LightRows lights;
    lights.update(scene);
    EXPECT_FALSE(lights.is_moving());
    std::vector<LightRow> rows = lights.rows(scene);
    rows[0].speed = half_turn;  // Half a turn per second.
    lights.set(scene, rows);
    EXPECT_TRUE(lights.is_moving());
    for (int i = 0; i < 10; ++i)
        lights.advance(scene, 0.1, glm::vec3(0.0F));
    EXPECT_LT(glm::distance(scene.directional_lights[0].direction_world, {-1.0F, -1.0F, 0.0F}),
              1e-5F);
    EXPECT_EQ(scene.directional_lights[1].direction_world, glm::vec3(1.0F, -1.0F, 0.0F));
}

TEST(LightRowsTest, KeepTheirSpeedsAfterAReload) {
    Scene scene;
    scene.directional_lights.resize(1);
    scene.point_lights.resize(2);
    LightRows lights;
    lights.update(scene);
    std::vector<LightRow> rows = lights.rows(scene);
    rows[2].speed = 0.5F;
    lights.set(scene, rows);
    lights.update(scene);
    EXPECT_EQ(lights.rows(scene)[2].speed, 0.5F);
    scene.directional_lights.clear();
    lights.update(scene);
    ASSERT_EQ(lights.rows(scene).size(), 2U);
    EXPECT_EQ(lights.rows(scene)[1].speed, 0.5F) << "the points are the same";
    scene.point_lights.clear();
    lights.update(scene);
    EXPECT_FALSE(lights.is_moving());
}

}  // namespace
}  // namespace relief::tools
