// SPDX-License-Identifier: Apache-2.0
#include "window/lamp_rows.h"
#include "support/angle.h"

#include <gtest/gtest.h>

#include <numbers>

namespace relief::tools {
namespace {

using test::half_turn;

TEST(LampRowsTest, KnowALampWhateverItsKindBecomes) {
    Scene scene;
    scene.directional_lights.resize(2);
    LampRows lamps;
    lamps.meet(scene);
    std::vector<LampRow> rows = lamps.rows(scene);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_NE(rows[0].id, rows[1].id);
    const unsigned first = rows[0].id;
    const unsigned second = rows[1].id;
    rows[0].lamp = as_kind(rows[0].lamp, LampKind::spot, Ball{});
    rows[0].speed = 1.0F;
    lamps.set(scene, rows);
    EXPECT_EQ(scene.spot_lights.size(), 1U);
    rows = lamps.rows(scene);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].id, second);
    EXPECT_EQ(rows[1].id, first) << "spots come last";
    EXPECT_EQ(rows[1].speed, 1.0F);
    EXPECT_EQ(rows[0].speed, 0.0F);
}

TEST(LampRowsTest, GiveNewOnesNumbersOfTheirOwn) {
    Scene scene;
    scene.directional_lights.resize(1);
    LampRows lamps;
    lamps.meet(scene);
    std::vector<LampRow> rows = lamps.rows(scene);
    const unsigned first = rows[0].id;
    rows.clear();
    lamps.set(scene, rows);
    rows = {{DirectionalLight{}}, {DirectionalLight{}}};
    lamps.set(scene, rows);
    rows = lamps.rows(scene);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_NE(rows[0].id, rows[1].id);
    EXPECT_NE(rows[0].id, first) << "removed is removed";
    EXPECT_NE(rows[1].id, first);
}

TEST(LampRowsTest, GoRoundByTimeEachAtItsSpeed) {
    Scene scene;
    scene.directional_lights.resize(2);
    scene.directional_lights[0].direction_world = {1.0F, -1.0F, 0.0F};
    scene.directional_lights[1].direction_world = {1.0F, -1.0F, 0.0F};
    LampRows lamps;
    lamps.meet(scene);
    EXPECT_FALSE(lamps.is_moving());
    std::vector<LampRow> rows = lamps.rows(scene);
    rows[0].speed = half_turn;  // In a second.
    lamps.set(scene, rows);
    EXPECT_TRUE(lamps.is_moving());
    for (int i = 0; i < 10; ++i)
        lamps.pass(scene, 0.1, glm::vec3(0.0F));
    EXPECT_LT(glm::distance(scene.directional_lights[0].direction_world, {-1.0F, -1.0F, 0.0F}),
              1e-5F);
    EXPECT_EQ(scene.directional_lights[1].direction_world, glm::vec3(1.0F, -1.0F, 0.0F));
}

TEST(LampRowsTest, MeetTheSameSceneAgainAndKeepTheirSpeeds) {
    Scene scene;
    scene.directional_lights.resize(1);
    scene.point_lights.resize(2);
    LampRows lamps;
    lamps.meet(scene);
    std::vector<LampRow> rows = lamps.rows(scene);
    rows[2].speed = 0.5F;
    lamps.set(scene, rows);
    lamps.meet(scene);
    EXPECT_EQ(lamps.rows(scene)[2].speed, 0.5F);
    scene.directional_lights.clear();
    lamps.meet(scene);
    ASSERT_EQ(lamps.rows(scene).size(), 2U);
    EXPECT_EQ(lamps.rows(scene)[1].speed, 0.5F) << "the points are the same";
    scene.point_lights.clear();
    lamps.meet(scene);
    EXPECT_FALSE(lamps.is_moving());
}

}  // namespace
}  // namespace relief::tools
