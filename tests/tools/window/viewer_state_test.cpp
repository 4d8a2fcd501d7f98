// SPDX-License-Identifier: Apache-2.0
#include "window/viewer_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/workplace.h"
#include "window/draw_thread.h"

namespace relief::tools {
namespace {

using test::Workplace;

class State : public testing::Test {
  protected:
    State() {
        workplace_.write_square("square.obj");
        workplace_.write("far.obj", "v 90 0 0\nv 91 0 0\nv 90 1 0\nf 1 2 3\n");
        state_.set_view({400, 300});
    }

    Loaded read(const std::string& model) {
        Loaded loaded;
        loaded.options.model = workplace_ / model;
        Stages silent(true);
        loaded.composed = compose_scene(loaded.options, silent, loaded.findings);
        return loaded;
    }
    void show(const std::string& model) { state_.take(read(model)); }
    ViewerState& state() { return state_; }

  private:
    Workplace workplace_;
    ViewerState state_{ViewOptions{}};
};

TEST_F(State, WishesNothingWithoutASceneOrAView) {
    EXPECT_FALSE(state().wish());
    show("square.obj");
    ASSERT_TRUE(state().wish());
    EXPECT_EQ(state().wish()->settings.width, 400);
    EXPECT_EQ(state().wish()->settings.height, 300);
    state().set_view({0, 300});
    EXPECT_FALSE(state().wish());
}

TEST_F(State, AnotherModelIsShownWholeTheSameKeepsTheView) {
    show("square.obj");
    EXPECT_NEAR(glm::length(state().camera().target), 0.0F, 1e-5F);
    state().act(Action::top);
    state().act(Action::nearer);
    const OrbitCamera before = state().camera();
    const std::uint64_t revision = state().wish()->revision;
    show("square.obj");
    EXPECT_EQ(state().camera().elevation, before.elevation);
    EXPECT_EQ(state().camera().distance, before.distance);
    EXPECT_GT(state().wish()->revision, revision);
    show("far.obj");
    EXPECT_NEAR(state().camera().target.x, 90.5F, 0.2F);
}

TEST_F(State, EditsStayWhenTheFileIsReadAgainAndAgain) {
    show("square.obj");
    state().edit([](Scene& scene) { scene.exposure = 4.0F; });
    for (int i = 0; i < 2; ++i) {
        show("square.obj");
        EXPECT_EQ(state().scene().exposure, 4.0F);
        EXPECT_EQ(state().json(DrawnPicture{})["edits"]["kept"], 1);
    }
    state().edit([](Scene& scene) { scene.exposure = 1.0F; });
    show("square.obj");
    EXPECT_EQ(state().json(DrawnPicture{})["edits"]["kept"], 0) << "as the file says";
}

TEST_F(State, AnErrorLeavesTheSceneAndGoesWithTheNext) {
    show("square.obj");
    const std::shared_ptr<const Scene> scene = state().wish()->scene;
    Loaded broken;
    broken.options.model = "broken.obj";
    broken.error = "broken.obj: no triangles";
    state().take(std::move(broken));
    EXPECT_EQ(state().wish()->scene, scene);
    EXPECT_EQ(state().error(), "broken.obj: no triangles");
    EXPECT_EQ(state().options().model.filename(), "square.obj");
    show("far.obj");
    EXPECT_EQ(state().error(), "");
}

TEST_F(State, EditsCopyTheSceneAndShareItsMeshes) {
    show("square.obj");
    const std::shared_ptr<const Scene> before = state().wish()->scene;
    const std::uint64_t revision = state().wish()->revision;
    state().edit([](Scene& scene) { scene.exposure = 4.0F; });
    EXPECT_EQ(before->exposure, 1.0F);
    EXPECT_EQ(state().scene().exposure, 4.0F);
    EXPECT_EQ(&*state().scene().meshes[0], &*before->meshes[0]);
    EXPECT_EQ(state().wish()->revision, revision + 1);
}

TEST_F(State, MovingTheCameraIsNoRevision) {
    show("square.obj");
    const DrawWish before = *state().wish();
    state().act(Action::orbit_left);
    EXPECT_EQ(state().wish()->revision, before.revision);
    EXPECT_NE(state().wish()->camera.world_from_view, before.camera.world_from_view);
}

TEST_F(State, AxisKeysLookAlongAxes) {
    show("square.obj");
    const auto looks_from = [&](Action action) {
        state().act(action);
        return glm::vec3(state().wish()->camera.world_from_view[2]);
    };
    EXPECT_NEAR(glm::distance(looks_from(Action::front), {0, 0, 1}), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::distance(looks_from(Action::back), {0, 0, -1}), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::distance(looks_from(Action::right), {1, 0, 0}), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::distance(looks_from(Action::left), {-1, 0, 0}), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::distance(looks_from(Action::top), {0, 1, 0}), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::distance(looks_from(Action::bottom), {0, -1, 0}), 0.0F, 1e-6F);
}

TEST_F(State, TheFieldOfViewStaysWithinItsLimits) {
    show("square.obj");
    for (int i = 0; i < 100; ++i)
        state().act(Action::wider);
    EXPECT_NEAR(glm::degrees(state().camera().vertical_fov), 150.0F, 1e-3F);
    for (int i = 0; i < 200; ++i)
        state().act(Action::narrower);
    EXPECT_NEAR(glm::degrees(state().camera().vertical_fov), 2.0F, 1e-3F);
}

TEST_F(State, TheTurntableTurnsByTimeAndStops) {
    show("square.obj");
    EXPECT_FALSE(state().pass(1.0));
    const float begin = state().camera().azimuth;
    state().act(Action::turntable);
    EXPECT_TRUE(state().pass(0.25));
    EXPECT_TRUE(state().pass(0.25));
    EXPECT_NEAR(state().camera().azimuth, begin - 0.25F, 1e-6F);
    state().act(Action::turntable);
    EXPECT_FALSE(state().pass(1.0));
}

TEST_F(State, LightsTurnRoundTheModelAndKeepTheirStrength) {
    show("square.obj");
    ASSERT_FALSE(state().scene().directional_lights.empty());
    const DirectionalLight before = state().scene().directional_lights[0];
    state().orbit_lights({300.0F, 0.0F});  // As far as the view is high: half a turn.
    const DirectionalLight after = state().scene().directional_lights[0];
    EXPECT_NEAR(after.direction_world.y, before.direction_world.y, 1e-5F);
    EXPECT_NEAR(after.direction_world.x, -before.direction_world.x, 1e-5F);
    EXPECT_NEAR(after.direction_world.z, -before.direction_world.z, 1e-5F);
    EXPECT_EQ(after.irradiance, before.irradiance);
}

TEST_F(State, ShowsDebugViewsByKeyAndKeepsThemForAnotherModel) {
    show("square.obj");
    const std::uint64_t revision = state().wish()->revision;
    state().act(Action::next_view);
    state().act(Action::wireframe);
    state().act(Action::health_markers);
    EXPECT_FALSE(state().wish()->settings.overlays.markers) << "they are looked for elsewhere";
    const HealthWish sought = state().take_health_wish().value();
    EXPECT_EQ(sought.choice, HealthChoice::trouble);
    EXPECT_FALSE(state().take_health_wish()) << "only once";
    state().take(FoundHealth{health_markers(*sought.scene), ""});
    const DrawWish wish = *state().wish();
    EXPECT_NE(wish.revision, revision);
    EXPECT_EQ(wish.settings.view, DebugView::geometric_normal);
    EXPECT_TRUE(wish.settings.overlays.wireframe);
    EXPECT_TRUE(wish.settings.overlays.markers);
    EXPECT_THAT(state().command_line(), testing::HasSubstr(" --show geometric-normal --wireframe "
                                                           "--health-markers trouble"));
    show("far.obj");
    EXPECT_TRUE(state().take_health_wish()->choice) << "of the new model too";
    EXPECT_EQ(state().json(DrawnPicture{})["show"], "geometric-normal");
    EXPECT_EQ(state().json(DrawnPicture{})["overlays"]["wireframe"], true);
    state().act(Action::previous_view);
    state().act(Action::previous_view);
    EXPECT_EQ(state().wish()->settings.view, DebugView::overdraw);
    state().act(Action::plain_view);
    EXPECT_EQ(state().wish()->settings, (FrameSettings{.width = 400, .height = 300}));
}

TEST_F(State, ItsCommandLineBringsTheSameViewBack) {
    show("square.obj");
    state().act(Action::nearer);
    state().act(Action::orbit_left);
    state().act(Action::wider);
    pan_by(state().camera(), {12.0F, 7.0F}, 300);
    const std::string text = state().command_line();
    const Camera before = state().wish()->camera;
    state().act(Action::top);
    state().act(Action::fit);
    state().look_as(text);
    EXPECT_EQ(state().wish()->camera.world_from_view, before.world_from_view);
    EXPECT_EQ(state().wish()->camera.vertical_fov, before.vertical_fov);
    state().look_as("nonsense and more");
    EXPECT_THAT(state().error(), testing::HasSubstr("says nothing of a camera"));
    EXPECT_EQ(state().wish()->camera.world_from_view, before.world_from_view);
    state().look_as("0,0");  // The same place from the front.
    EXPECT_EQ(state().error(), "");
    EXPECT_EQ(state().camera().azimuth, 0.0F);
    EXPECT_GT(glm::length(state().camera().target), 0.0F);
}

TEST_F(State, HidesInstancesFromThePictureAndNotFromTheScene) {
    show("square.obj");
    const std::uint64_t revision = state().wish()->revision;
    state().show({0}, false);
    EXPECT_FALSE(state().is_shown(0));
    EXPECT_EQ(state().wish()->scene->instances.size(), 0U);
    EXPECT_EQ(state().scene().instances.size(), 1U);
    EXPECT_GT(state().wish()->revision, revision);
    state().edit([](Scene& scene) { scene.exposure = 2.0F; });
    EXPECT_EQ(state().wish()->scene->instances.size(), 0U) << "an edit shows nothing";
    show("square.obj");
    EXPECT_FALSE(state().is_shown(0)) << "the same model read again";
    show("far.obj");
    EXPECT_TRUE(state().is_shown(0));
    EXPECT_EQ(state().wish()->scene->instances.size(), 1U);
}

TEST_F(State, LampsGoRoundByThemselvesUntilTheirSpeedIsTakenAway) {
    show("square.obj");
    EXPECT_FALSE(state().is_turning());
    std::vector<LampRow> rows = state().lamps();
    ASSERT_FALSE(rows.empty());
    const glm::vec3 before = state().scene().directional_lights[0].direction_world;
    rows[0].speed = 1.0F;
    state().set_lamps(rows);
    EXPECT_TRUE(state().is_turning());
    const std::uint64_t revision = state().wish()->revision;
    EXPECT_TRUE(state().pass(0.5));
    EXPECT_GT(state().wish()->revision, revision);
    const glm::vec3 after = state().scene().directional_lights[0].direction_world;
    EXPECT_NEAR(after.y, before.y, 1e-5F);
    EXPECT_NEAR(glm::length(after), glm::length(before), 1e-5F);
    EXPECT_GT(glm::distance(after, before), 0.1F);
    show("square.obj");
    EXPECT_EQ(state().lamps()[0].speed, 1.0F) << "the same model read again";
    rows = state().lamps();
    rows[0].speed = 0.0F;
    state().set_lamps(rows);
    EXPECT_FALSE(state().is_turning());
    EXPECT_FALSE(state().pass(0.5));
}

TEST_F(State, AnEditThatFailsChangesNothingAndSaysWhy) {
    show("square.obj");
    const std::shared_ptr<const Scene> scene = state().wish()->scene;
    state().set_environment("nothing.hdr");
    EXPECT_THAT(state().error(), testing::HasSubstr("nothing.hdr"));
    EXPECT_EQ(state().wish()->scene, scene);
    state().try_edit([](Scene& edited) { edited.exposure = 2.0F; });
    EXPECT_EQ(state().error(), "");
}

TEST_F(State, EditsOfTheDefaultMaterialSurviveReadingAgain) {
    const auto show_bare = [&] {
        Loaded bare = read("square.obj");
        bare.composed->scene().materials.clear();
        bare.composed->scene().meshes[0].edit().material_ranges.clear();
        state().take(std::move(bare));
    };
    show_bare();
    state().name_default_material();
    ASSERT_EQ(state().scene().materials.size(), 1U);
    state().edit([](Scene& scene) { scene.materials[0].shininess = 99.0F; });
    show_bare();
    ASSERT_EQ(state().scene().materials.size(), 1U);
    EXPECT_EQ(state().scene().materials[0].shininess, 99.0F);
}

TEST_F(State, SaysItselfAsJson) {
    show("square.obj");
    state().camera().azimuth = glm::radians(40.0F);
    const nlohmann::ordered_json said = state().json(DrawnPicture{});
    EXPECT_NEAR(said["camera"]["azimuth"].get<double>(), 40.0, 1e-5);
    EXPECT_EQ(said["view"], nlohmann::json({400, 300}));
    EXPECT_EQ(said["triangles"], 2);
    EXPECT_EQ(said["drawn"]["frames"], 0);
    EXPECT_EQ(said["error"], "");
}

}  // namespace
}  // namespace relief::tools
