// SPDX-License-Identifier: Apache-2.0
#include "window/lamps.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace relief::tools {
namespace {

const Ball lit_ball{{1.0F, 2.0F, 3.0F}, 2.0F};

/// What a lamp sheds on a surface in the ball's middle that faces it, as lights.h says; a spot's
/// cone holds the middle.
glm::vec3 shed_on_middle(const Lamp& lamp) {
    if (const auto* directional = std::get_if<DirectionalLight>(&lamp))
        return directional->irradiance;
    const auto* spot = std::get_if<SpotLight>(&lamp);
    const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(lamp);
    if (point.falloff == Falloff::none) return point.intensity;
    const float distance = glm::distance(point.position_world, lit_ball.center);
    return point.intensity / (distance * distance);
}

/// The way the light travels there.
glm::vec3 way_through_middle(const Lamp& lamp) {
    if (const auto* directional = std::get_if<DirectionalLight>(&lamp))
        return glm::normalize(directional->direction_world);
    const auto* spot = std::get_if<SpotLight>(&lamp);
    const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(lamp);
    return glm::normalize(lit_ball.center - point.position_world);
}

TEST(Lamps, BecomeAnyOtherKindAndLightTheMiddleAlike) {
    DirectionalLight far;
    far.direction_world = {0.0F, -3.0F, -4.0F};
    far.irradiance = {0.5F, 1.0F, 2.0F};
    PointLight near;
    near.position_world = {1.0F, 5.0F, -1.0F};  // 5 from the middle.
    near.intensity = {25.0F, 50.0F, 0.0F};
    PointLight even = near;
    even.falloff = Falloff::none;
    SpotLight spot;
    spot.point = near;
    spot.direction_world = {0.0F, -3.0F, 4.0F};
    for (const Lamp& lamp : {Lamp(far), Lamp(near), Lamp(even), Lamp(spot)}) {
        for (const LampKind kind : {LampKind::directional, LampKind::point, LampKind::spot}) {
            SCOPED_TRACE(testing::Message() << name_of(kind_of(lamp)) << " to " << name_of(kind));
            const Lamp other = as_kind(lamp, kind, lit_ball);
            EXPECT_EQ(kind_of(other), kind);
            EXPECT_LT(glm::distance(shed_on_middle(other), shed_on_middle(lamp)),
                      1e-5F * glm::length(shed_on_middle(lamp)));
            EXPECT_LT(glm::distance(way_through_middle(other), way_through_middle(lamp)), 1e-6F);
            if (const auto* turned = std::get_if<SpotLight>(&other)) {
                EXPECT_LT(glm::distance(glm::normalize(turned->direction_world),
                                        way_through_middle(lamp)),
                          1e-6F)
                    << "the middle is in its cone";
            }
        }
    }
}

TEST(Lamps, GetAPlaceOutsideOfTheModel) {
    for (const LampKind kind : {LampKind::point, LampKind::spot}) {
        const Lamp lamp = as_kind(DirectionalLight{}, kind, lit_ball);
        const auto* spot = std::get_if<SpotLight>(&lamp);
        const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(lamp);
        EXPECT_GT(glm::distance(point.position_world, lit_ball.center), lit_ball.radius);
    }
}

TEST(Lamps, KeepTheColourOfTheirHighlights) {
    DirectionalLight far;
    far.highlight_irradiance = glm::vec3(0.25F);
    const Lamp point = as_kind(far, LampKind::point, lit_ball);
    const Lamp again = as_kind(point, LampKind::directional, lit_ball);
    ASSERT_TRUE(std::get<DirectionalLight>(again).highlight_irradiance);
    EXPECT_NEAR(std::get<DirectionalLight>(again).highlight_irradiance->x, 0.25F, 1e-6F);
}

TEST(Lamps, InTheModelsMiddleOrOfNoDirectionStayFinite) {
    PointLight inside;
    inside.position_world = lit_ball.center;
    DirectionalLight nowhere;
    nowhere.direction_world = glm::vec3(0.0F);
    for (const Lamp& lamp : {Lamp(inside), Lamp(nowhere)}) {
        for (const LampKind kind : {LampKind::directional, LampKind::point, LampKind::spot}) {
            if (kind == kind_of(lamp)) continue;
            Scene scene;
            set_lamps(scene, {as_kind(lamp, kind, lit_ball)});
            EXPECT_NO_THROW(validate_places(scene));
        }
    }
}

TEST(Lamps, AreListedByKindAndPutBack) {
    Scene scene;
    scene.point_lights.resize(2);
    scene.point_lights[1].intensity = glm::vec3(7.0F);
    scene.spot_lights.resize(1);
    scene.directional_lights.resize(1);
    const std::vector<Lamp> lamps = lamps_of(scene);
    ASSERT_EQ(lamps.size(), 4U);
    EXPECT_EQ(kind_of(lamps[0]), LampKind::directional);
    EXPECT_EQ(std::get<PointLight>(lamps[2]).intensity.x, 7.0F);
    EXPECT_EQ(kind_of(lamps[3]), LampKind::spot);
    Scene other;
    other.point_lights.resize(5);
    set_lamps(other, lamps);
    EXPECT_EQ(other.directional_lights.size(), 1U);
    ASSERT_EQ(other.point_lights.size(), 2U);
    EXPECT_EQ(other.point_lights[1].intensity.x, 7.0F);
    EXPECT_EQ(other.spot_lights.size(), 1U);
}

TEST(Lamps, TurnAboutThePlaceWithTheirDirections) {
    const glm::mat3 half(glm::rotate(glm::mat4(1.0F), glm::radians(180.0F), {0.0F, 1.0F, 0.0F}));
    Lamp spot = SpotLight{};
    std::get<SpotLight>(spot).point.position_world = lit_ball.center + glm::vec3(1.0F, 2.0F, 0.0F);
    std::get<SpotLight>(spot).direction_world = {-1.0F, -2.0F, 0.0F};
    turn(spot, half, lit_ball.center);
    EXPECT_LT(glm::distance(std::get<SpotLight>(spot).point.position_world,
                            lit_ball.center + glm::vec3(-1.0F, 2.0F, 0.0F)),
              1e-5F);
    EXPECT_LT(glm::distance(std::get<SpotLight>(spot).direction_world, {1.0F, -2.0F, 0.0F}), 1e-5F);
}

}  // namespace
}  // namespace relief::tools
