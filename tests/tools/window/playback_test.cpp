// SPDX-License-Identifier: Apache-2.0
// Playback without a window: time, speed, clips, and the lights that leave their nodes.
#include "window/playback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "tools/workplace.h"
#include "window/background_jobs.h"
#include "window/viewer_state.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::Workplace;
using testing::ElementsAre;

constexpr float quarter = 0.5F * std::numbers::pi_v<float>;
constexpr float pose_rounding = 1e-5F;  // Of float sines and products.

/// A node that slides along x, by `distance` in two seconds.
KeyAnimation slide(const char* name, std::size_t node, float distance) {
    KeyChannel channel;
    channel.node = node;
    channel.times = {0.0F, 2.0F};
    channel.values = {glm::vec4(0.0F), glm::vec4(distance, 0.0F, 0.0F, 0.0F)};
    return {name, {channel}};
}

/// A quad on a sliding node, and a point light that orbits at a quarter turn per second.
SceneGraph moving_scene() {
    SceneGraph graph;
    graph.nodes.resize(2);
    graph.scene.meshes.emplace_back(make_quad(1));
    graph.scene.instances.emplace_back();
    graph.instances.push_back({0});
    graph.scene.point_lights.resize(1);
    graph.point_lights.push_back({1});
    graph.animations.emplace_back(slide("walk", 0, 4.0F));
    graph.animations.emplace_back(slide("run", 0, 8.0F));
    graph.animations.emplace_back(Orbit{.node = 1, .azimuth_speed = quarter});
    graph.clip = 0;
    return graph;
}

/// The x of the quad after posing.
float x_of(Playback& playback, Scene& scene, const LightCarriers& carriers = {}) {
    playback.pose(scene, carriers);
    return scene.instances[0].world_from_object[3].x;
}

TEST(PlaybackTest, PlaysPausesAndStepsAtItsSpeed) {
    SceneGraph graph = moving_scene();
    Playback playback;
    EXPECT_FALSE(playback.has_motion());
    EXPECT_FALSE(playback.advance(1.0)) << "there is nothing to play";
    playback.take(graph, false);
    EXPECT_TRUE(playback.is_playing());
    EXPECT_NEAR(playback.duration(), 4.0, 1e-6) << "a turn of the light";
    EXPECT_TRUE(playback.advance(0.5));
    EXPECT_FLOAT_EQ(x_of(playback, graph.scene), 1.0F);
    playback.set_speed(2.0F);
    EXPECT_TRUE(playback.advance(0.25));
    EXPECT_FLOAT_EQ(x_of(playback, graph.scene), 2.0F);
    playback.set_playing(false);
    EXPECT_FALSE(playback.advance(1.0));
    EXPECT_EQ(playback.time(), 1.0);
    playback.step(-3.0);
    EXPECT_EQ(playback.time(), 0.0);
    playback.set_time(4.5);
    EXPECT_NEAR(playback.time_in_clip(), 0.5, 1e-6);
}

TEST(PlaybackTest, SetsNumbersOfTheSceneInTheWindow) {
    SceneGraph graph = moving_scene();
    graph.scene.materials.resize(1);
    const auto pointing = [](const char* pointer) {
        KeyAnimation animation = slide("", 0, 4.0F);
        animation.channels[0].property = KeyChannel::Property::pointer;
        animation.channels[0].pointer = pointer;
        return animation;
    };
    graph.clip.reset();
    graph.animations = {pointing("materials.emission"), pointing("point_lights.color")};
    Playback playback;
    playback.take(graph, false);
    EXPECT_TRUE(playback.moves_materials());
    Scene scene = graph.scene;
    scene.materials[0].shininess = 7.0F;  // Edited in the window.
    playback.pose(scene, {}, 1.0);
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(2, 0, 0));
    EXPECT_EQ(scene.materials[0].shininess, 7.0F);
    EXPECT_EQ(scene.point_lights[0].intensity, glm::vec3(2, 0, 0));
    scene.point_lights.insert(scene.point_lights.begin(), PointLight{});
    playback.pose(scene, {}, 0.5);
    EXPECT_EQ(scene.point_lights[0].intensity, glm::vec3(1.0F)) << "another light";
    EXPECT_EQ(scene.point_lights[1].intensity, glm::vec3(2, 0, 0));
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(1, 0, 0));
}

TEST(PlaybackTest, PlaysOneClipOrAll) {
    SceneGraph graph = moving_scene();
    Playback playback;
    playback.take(graph, false);
    EXPECT_THAT(playback.clips(), ElementsAre("walk", "run"));
    playback.set_time(1.0);
    playback.set_clip(1);
    EXPECT_EQ(playback.time(), 0.0) << "from its start";
    playback.set_time(1.0);
    EXPECT_FLOAT_EQ(x_of(playback, graph.scene), 4.0F);
    playback.set_time(1.0);
    playback.take(graph, true);
    EXPECT_EQ(playback.clip(), 1U) << "the same scene, read again";
    EXPECT_EQ(playback.time(), 1.0);
    playback.take(graph, false);
    EXPECT_EQ(playback.clip(), 0U);
    EXPECT_EQ(playback.time(), 0.0);
}

TEST(PlaybackTest, ReachesEverywhereThatItGoes) {
    Playback playback;
    playback.take(moving_scene(), false);
    EXPECT_FLOAT_EQ(playback.reach().min.x, -1.0F);
    EXPECT_GT(playback.reach().max.x, 4.0F);
    EXPECT_LE(playback.reach().max.x, 5.0F);
}

TEST(PlaybackTest, MovesOnlyLightsOnNodes) {
    SceneGraph graph = moving_scene();
    Playback playback;
    playback.take(graph, false);
    playback.set_time(1.0);
    graph.scene.point_lights[0].position_world = {7.0F, 7.0F, 7.0F};
    playback.pose(graph.scene, {});
    EXPECT_EQ(graph.scene.point_lights[0].position_world, glm::vec3(7.0F));
    LightCarriers carriers;
    carriers.point = graph.point_lights;
    playback.pose(graph.scene, carriers);
    EXPECT_NEAR(graph.scene.point_lights[0].position_world.x, 1.0F, pose_rounding);
    EXPECT_NEAR(graph.scene.point_lights[0].position_world.z, 0.0F, pose_rounding);
}

TEST(PlaybackTest, AnOrbitChangesItsSpeedWithoutAJump) {
    SceneGraph graph = moving_scene();
    Playback playback;
    playback.take(graph, false);
    EXPECT_FALSE(playback.orbit_speed(0));
    EXPECT_EQ(playback.orbit_speed(1), quarter);
    LightCarriers carriers;
    carriers.point = graph.point_lights;
    playback.set_time(1.0);
    playback.set_orbit_speed(1, -2.0F * quarter);
    playback.pose(graph.scene, carriers);
    EXPECT_NEAR(graph.scene.point_lights[0].position_world.x, 1.0F, pose_rounding);
    playback.set_time(1.5);
    playback.pose(graph.scene, carriers);
    EXPECT_NEAR(graph.scene.point_lights[0].position_world.z, 1.0F, pose_rounding)
        << "a quarter back in half a second";
}

class PlayingState : public testing::Test {
  protected:
    PlayingState() { state_.set_view({64, 48}); }

    void show(const std::string& scene) {
        workplace_.write_square("square.obj");
        workplace_.write("scene.json", "{\"relief_scene\": 1, " + scene + "}");
        show_again();
    }
    void show_again() {
        Loaded loaded;
        loaded.options = options_;
        loaded.options.model = workplace_ / "scene.json";
        Stages silent(true);
        loaded.composed = compose_scene(loaded.options, silent, loaded.findings);
        state_.take(std::move(loaded));
    }
    /// Shows moving_scene() as if read from `model`, with a quad of `size`, and the camera that
    /// frames it.
    void show_clips(const char* model, float size = 1.0F, std::optional<double> time = {}) {
        Loaded loaded;
        loaded.options.model = model;
        loaded.options.time = time;
        loaded.composed.emplace();
        loaded.composed->graph = moving_scene();
        Scene& scene = loaded.composed->graph.scene;
        scene.meshes[0] = transformed(make_quad(1), glm::scale(glm::mat4(1.0F), glm::vec3(size)));
        loaded.composed->camera = framed(scene, 0.0F, 0.0F, 0.6F, 4.0F / 3.0F);
        state_.take(std::move(loaded));
    }
    void choose_clip(std::size_t clip) {
        state_.change_playback([&](Playback& playback) { playback.set_clip(clip); });
    }
    glm::vec3 light() const { return state_.scene().point_lights.at(0).position_world; }

    Workplace workplace_;
    ViewOptions options_;
    ViewerState state_{ViewOptions{}};
};

constexpr const char* orbiting_light = R"("nodes": [{"model": "square.obj"},
    {"orbit": {"radius": 2, "azimuth_speed": 90}, "light": {"type": "point", "intensity": 3}}])";

TEST_F(PlayingState, MovesWithoutPreparingTheSceneAgain) {
    show(orbiting_light);
    EXPECT_TRUE(state_.is_turning());
    const DrawRequest before = *state_.request();
    EXPECT_TRUE(state_.advance(1.0));
    const DrawRequest after = *state_.request();
    EXPECT_EQ(after.revision, before.revision);
    EXPECT_NE(after.pose, before.pose);
    EXPECT_NEAR(light().x, 2.0F, pose_rounding);
    state_.act(Action::play);
    EXPECT_FALSE(state_.is_turning()) << "a paused animation costs nothing";
    EXPECT_FALSE(state_.advance(1.0));
    EXPECT_EQ(state_.request()->pose, after.pose);
    state_.act(Action::step_forward);
    EXPECT_NE(state_.request()->pose, after.pose);
}

TEST_F(PlayingState, FitsTheMotionUnlessItIsFar) {
    const auto cameras = [&](const std::string& radius, std::optional<double> time) {
        state_ = ViewerState{ViewOptions{}};
        state_.set_view({64, 48});
        options_.time = time;
        show(R"("nodes": [{"model": "square.obj", "orbit": {"azimuth_speed": 90, "radius": )" +
             radius + "}}]");
        const OrbitCamera opened = state_.camera();
        state_.act(Action::fit);
        return std::pair(opened, state_.camera());
    };
    const auto [first_pose, fitted_pose] = cameras("0.5", 0.0);
    const auto [motion, fitted_motion] = cameras("0.5", std::nullopt);
    EXPECT_NEAR(first_pose.target.z, 0.5F, pose_rounding);
    EXPECT_NEAR(motion.target.z, 0.0F, pose_rounding) << "the center of the circle";
    EXPECT_NEAR(fitted_motion.target.z, 0.0F, pose_rounding);
    // Half the diagonals of the square and of the box that contains its motion.
    const float growth = glm::length(glm::vec3(1.5F, 1.0F, 0.5F)) / std::sqrt(2.0F);
    EXPECT_NEAR(motion.distance, growth * first_pose.distance, 1e-4F);
    EXPECT_NEAR(cameras("9", std::nullopt).first.distance, cameras("9", 0.0).first.distance,
                pose_rounding);
}

TEST_F(PlayingState, FitsAnotherClipUnlessTheCameraWasMoved) {
    const auto far_end = [&](float x) {
        const Camera camera = state_.request()->camera;
        const glm::vec3 corner(x + 1.0F, 0.0F, 0.0F);
        return -(glm::inverse(camera.world_from_view) * glm::vec4(corner, 1.0F)).z / camera.far;
    };
    show_clips("two-clips.gltf");
    EXPECT_NEAR(state_.camera().target.x, 2.0F, pose_rounding) << "the middle of -1 and 5";
    const float distance = state_.camera().distance;
    choose_clip(1);
    EXPECT_NEAR(state_.camera().target.x, 4.0F, pose_rounding);
    EXPECT_GT(state_.camera().distance, 1.5F * distance);

    choose_clip(0);
    EXPECT_NEAR(state_.camera().distance, distance, pose_rounding * distance);
    state_.act(Action::left);
    state_.camera().distance *= 1.5F;
    const OrbitCamera moved = state_.camera();
    EXPECT_GT(far_end(0.0F), 0.0F);
    choose_clip(1);
    EXPECT_EQ(state_.camera(), moved);
    EXPECT_LE(far_end(7.0F), 1.0F) << "the far plane is behind all that this clip reaches";
    EXPECT_LE(far_end(-1.0F), 1.0F);
    state_.act(Action::fit);
    EXPECT_NEAR(state_.camera().target.x, 4.0F, pose_rounding);
}

TEST_F(PlayingState, DoesNotFitAnotherClipIfTheCameraFitsNoneOrTheModelChanged) {
    show_clips("a.gltf", 1.0F, 0.0);
    const OrbitCamera of_pose = state_.camera();
    choose_clip(1);
    EXPECT_EQ(state_.camera(), of_pose) << "--time shows one pose";

    show_clips("b.gltf");
    show_clips("b.gltf");
    choose_clip(1);
    const OrbitCamera of_clip = state_.camera();
    EXPECT_NEAR(of_clip.target.x, 4.0F, pose_rounding) << "a reload without changes";
    show_clips("b.gltf", 2.0F);
    choose_clip(0);
    EXPECT_EQ(state_.camera(), of_clip) << "a reload of another size";
}

TEST_F(PlayingState, OpensPausedAtAGivenTime) {
    options_.time = 2.0;
    show(orbiting_light);
    EXPECT_FALSE(state_.is_turning());
    EXPECT_NEAR(light().z, -2.0F, pose_rounding);
}

TEST_F(PlayingState, ListsTheTrueSpeedsAndChangesThem) {
    show(orbiting_light);
    std::vector<LightRow> rows = state_.light_rows();
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_NEAR(rows[0].speed, quarter, pose_rounding);
    state_.advance(1.0);
    rows = state_.light_rows();
    rows[0].speed = 2.0F * quarter;
    state_.set_light_rows(rows);
    state_.advance(1.0);
    EXPECT_NEAR(light().x, -2.0F, pose_rounding) << "half a turn from the right";
}

TEST_F(PlayingState, ColorEditsKeepTheNodeAndPositionEditsDetach) {
    show(orbiting_light);
    std::vector<LightRow> rows = state_.light_rows();
    std::get<PointLight>(rows[0].light).intensity = glm::vec3(5.0F);
    state_.set_light_rows(rows);
    state_.advance(1.0);
    EXPECT_NEAR(light().x, 2.0F, pose_rounding);
    EXPECT_EQ(state_.scene().point_lights[0].intensity, glm::vec3(5.0F));
    rows = state_.light_rows();
    std::get<PointLight>(rows[0].light).position_world = {0.0F, 9.0F, 0.0F};
    state_.set_light_rows(rows);
    state_.advance(1.0);
    EXPECT_EQ(light(), glm::vec3(0.0F, 9.0F, 0.0F));
    show_again();
    EXPECT_EQ(light(), glm::vec3(0.0F, 9.0F, 0.0F)) << "an edit stays";
}

TEST_F(PlayingState, MotionIsNotAnEdit) {
    show(orbiting_light);
    state_.advance(1.0);
    EXPECT_NEAR(state_.scene_at_rest()->point_lights[0].position_world.z, 2.0F, pose_rounding);
    show_again();
    EXPECT_EQ(state_.json(RenderedPicture{})["edits"]["kept"], 0);
    EXPECT_NEAR(light().x, 2.0F, pose_rounding) << "the time goes on";
}

TEST_F(PlayingState, TheCameraFollowsUntilItIsMoved) {
    show(R"("nodes": [{"model": "square.obj"},
        {"orbit": {"radius": 5, "azimuth_speed": 90, "faces_center": true}, "camera": {}}])");
    state_.advance(1.0);
    EXPECT_NEAR(state_.camera().azimuth, quarter, pose_rounding);
    orbit_by(state_.camera(), {5.0F, 0.0F}, 48);
    const float azimuth = state_.camera().azimuth;
    state_.advance(1.0);
    EXPECT_EQ(state_.camera().azimuth, azimuth);
}

TEST(PlaybackTest, FollowsTheChosenCamera) {
    SceneGraph graph = moving_scene();
    graph.cameras.push_back({"fixed", Camera{}, {}, false});
    graph.cameras.push_back({"", Camera{}, {0}, false});
    choose_camera(graph, 0);
    Playback playback;
    playback.take(graph, false);
    EXPECT_THAT(playback.cameras(), ElementsAre("fixed", "camera 2"));
    EXPECT_FALSE(playback.camera()) << "it does not move";
    playback.choose_camera(1);
    ASSERT_TRUE(playback.camera());
    playback.set_time(1.0);
    Scene scene = graph.scene;
    EXPECT_NEAR(x_of(playback, scene), 2.0F, pose_rounding);
    EXPECT_NEAR(playback.shown_camera().world_from_view[3].x, 2.0F, pose_rounding);
    playback.take(graph, true);
    EXPECT_EQ(playback.chosen_camera(), 1U) << "the file was read again";
    playback.take(graph, false);
    EXPECT_EQ(playback.chosen_camera(), 0U);
    choose_camera(graph, 1);
    playback.take(graph, false);
    EXPECT_EQ(playback.chosen_camera(), 1U) << "--model-camera";
}

}  // namespace
}  // namespace relief::tools
