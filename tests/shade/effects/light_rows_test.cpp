// SPDX-License-Identifier: Apache-2.0
// Lights as numbers, by hand.
#include "effects/light_rows.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relief {
namespace {

Features counts(std::uint32_t directional, std::uint32_t point, std::uint32_t spot) {
    Features f;
    f.directional_lights = directional;
    f.point_lights = point;
    f.spot_lights = spot;
    return f;
}

TEST(LightRows, HoldEveryKindInOrder) {
    Scene scene;
    scene.directional_lights = {{{0, -2, 0}, {1, 2, 3}}};
    scene.point_lights = {{{4, 5, 6}, {7, 8, 9}, std::nullopt}, {{1, 1, 1}, {2, 2, 2}, 4.0F}};
    const std::vector<glm::vec4> rows = light_rows(scene, counts(1, 2, 0));
    ASSERT_EQ(rows.size(), 6U);
    EXPECT_EQ(rows[0], glm::vec4(0, 1, 0, 0));  // To the light, unit.
    EXPECT_EQ(rows[1], glm::vec4(1, 2, 3, 0));
    EXPECT_EQ(rows[2], glm::vec4(4, 5, 6, 0));
    EXPECT_EQ(rows[3], glm::vec4(7, 8, 9, 1));  // By the inverse square.
    EXPECT_EQ(rows[4], glm::vec4(1, 1, 1, 0.25F));
    const LightRowLayout layout = light_row_layout(counts(1, 2, 0));
    EXPECT_EQ(layout.first_point, 2U);
    EXPECT_EQ(layout.first_spot, 6U);
    EXPECT_EQ(layout.count, 6U);
}

TEST(LightRows, OfASpotFadeFromTheInnerToTheOuterCone) {
    Scene scene;
    SpotLight spot;
    spot.direction_world = {0, 0, -3};
    spot.inner_cone = 0.25F;
    spot.outer_cone = 0.5F;
    scene.spot_lights = {spot};
    const std::vector<glm::vec4> rows = light_rows(scene, counts(0, 0, 1));
    ASSERT_EQ(rows.size(), 3U);
    const auto share = [&](float angle) { return std::cos(angle) * -rows[2].z + rows[2].w; };
    // Cosines near 1 in float, times a scale of 11: some 1e-6.
    EXPECT_NEAR(share(0.25F), 1.0F, 1e-5F);
    EXPECT_NEAR(share(0.5F), 0.0F, 1e-5F);
    EXPECT_EQ(glm::vec2(rows[2]), glm::vec2(0, 0));
}

TEST(LightRows, LeaveBlackLightsOut) {
    Scene scene;
    scene.directional_lights = {{{0, -1, 0}, {0, 0, 0}}, {{1, 0, 0}, {1, 1, 1}}};
    const std::vector<glm::vec4> rows = light_rows(scene, counts(1, 0, 0));
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0], glm::vec4(-1, 0, 0, 0));
}

TEST(LightRows, OfForcedLightsAreBlack) {
    const std::vector<glm::vec4> rows = light_rows(Scene{}, counts(1, 1, 1));
    ASSERT_EQ(rows.size(), 7U);
    for (const glm::vec4& row : rows)
        EXPECT_EQ(row, glm::vec4(0));
}

TEST(LightRows, SayWhichLampsDoNotFallOff) {
    Scene scene;
    scene.point_lights = {{{4, 5, 6}, {7, 8, 9}, std::nullopt, Falloff::none}};
    EXPECT_EQ(light_rows(scene, counts(0, 1, 0))[1], glm::vec4(7, 8, 9, 0));
}

TEST(LightRows, HoldTheColoursOfHighlightsWhereTheyDiffer) {
    Scene scene;
    scene.directional_lights = {{{0, -1, 0}, {1, 1, 1}, glm::vec3(0.5F)}};
    scene.point_lights = {{{4, 5, 6}, {7, 8, 9}}};
    scene.spot_lights = {SpotLight{{{1, 2, 3}, {0, 0, 0}}}};
    scene.spot_lights[0].point.highlight_intensity = glm::vec3(3.0F);  // Shines by it alone.
    Features f = counts(1, 1, 1);
    f.highlight_colors = true;
    const std::vector<glm::vec4> rows = light_rows(scene, f);
    ASSERT_EQ(rows.size(), 10U);
    EXPECT_EQ(rows[2], glm::vec4(0.5F, 0.5F, 0.5F, 0));
    EXPECT_EQ(rows[5], glm::vec4(7, 8, 9, 0));
    EXPECT_EQ(rows[9], glm::vec4(3, 3, 3, 0));
    EXPECT_EQ(light_row_layout(f).first_spot, 6U);
}

TEST(LightRows, MakeDirectionsOfAnyLengthUnit) {
    Scene scene;
    scene.directional_lights = {{{0, -1e-30F, 0}, {1, 1, 1}}, {{3e38F, 0, 0}, {1, 1, 1}}};
    const std::vector<glm::vec4> rows = light_rows(scene, counts(2, 0, 0));
    EXPECT_EQ(rows[0], glm::vec4(0, 1, 0, 0));
    EXPECT_EQ(rows[2], glm::vec4(-1, 0, 0, 0));
}

}  // namespace
}  // namespace relief
