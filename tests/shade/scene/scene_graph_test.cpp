// SPDX-License-Identifier: Apache-2.0
// Poses by hand: chains of nodes, key frames, orbits, turntables, and invalid input.
#include "relief/shade/scene_graph.h"
#include "relief/shade/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_variant.h"
#include "scene/scene_parts.h"
#include "support/invariants.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

constexpr float pi = std::numbers::pi_v<float>;
/// A few rounding errors of sines and products of order 1 to 10.
constexpr float place_rounding = 2e-6F;

void expect_place(const glm::vec3& a, const glm::vec3& b, float tolerance = place_rounding) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

/// A cube, one light of each kind and a camera, each on its own node below a common one.
SceneGraph one_of_each() {
    SceneGraph graph;
    Scene& scene = graph.scene;
    scene.meshes = {test::cube()};
    scene.instances.emplace_back();
    scene.directional_lights.emplace_back();
    scene.point_lights.emplace_back();
    scene.spot_lights.emplace_back();
    scene.spot_lights[0].inner_cone = 0.1F;
    scene.camera.emplace();
    graph.nodes.resize(6);
    for (std::size_t i = 1; i < 6; ++i) {
        graph.nodes[i].parent = 0;
        graph.nodes[i].translation = glm::vec3(static_cast<float>(i), 0.0F, 0.0F);
    }
    graph.instances = {{1}};
    graph.directional_lights = {{2}};
    graph.point_lights = {{3}};
    graph.spot_lights = {{4}};
    graph.camera = {5};
    return graph;
}

TEST(Pose, MovesObjectsWithTheirNodes) {
    SceneGraph graph = one_of_each();
    // A rotation by 90 degrees about y maps x to -z and z to x.
    graph.nodes[0].rotation = glm::angleAxis(pi / 2, glm::vec3(0, 1, 0));
    graph.nodes[0].translation = {0, 10, 0};
    pose(graph, 0.0);
    const Scene& scene = graph.scene;
    expect_place(scene.instances[0].world_from_object[3], {0, 10, -1});
    expect_place(scene.directional_lights[0].direction_world, {-1, 0, 0});
    expect_place(scene.point_lights[0].position_world, {0, 10, -3});
    expect_place(scene.spot_lights[0].point.position_world, {0, 10, -4});
    expect_place(scene.spot_lights[0].direction_world, {-1, 0, 0});
    expect_place(scene.camera->world_from_view[3], {0, 10, -5});
    expect_place(scene.camera->world_from_view[2], {1, 0, 0});
    EXPECT_NO_THROW(validate(graph));
}

TEST(Pose, KeepsObjectsWithoutNode) {
    SceneGraph graph = one_of_each();
    graph.point_lights = {Carried{}};
    graph.spot_lights.clear();
    graph.scene.point_lights[0].position_world = {7, 8, 9};
    graph.scene.spot_lights[0].point.position_world = {1, 1, 1};
    pose(graph, 3.0);
    EXPECT_EQ(graph.scene.point_lights[0].position_world, glm::vec3(7, 8, 9));
    EXPECT_EQ(graph.scene.spot_lights[0].point.position_world, glm::vec3(1, 1, 1));
    EXPECT_NO_THROW(validate(graph));
}

TEST(Pose, FindsParentsInAnyOrder) {
    SceneGraph graph;
    graph.nodes.resize(3);
    graph.nodes[0].parent = 1;
    graph.nodes[1].parent = 2;
    for (SceneNode& node : graph.nodes)
        node.translation = {1, 0, 0};
    graph.nodes[2].scale = glm::vec3(2.0F);
    graph.scene.point_lights.resize(1);
    graph.point_lights = {{0}};
    pose(graph, 0.0);
    EXPECT_EQ(graph.scene.point_lights[0].position_world, glm::vec3(5, 0, 0));  // 1 + 2 (1 + 1).
}

TEST(Pose, GivesADirectionEvenAtScaleZero) {
    SceneGraph graph = one_of_each();
    for (const float scale : {0.0F, 1e-30F, 1e30F, -2.0F}) {
        graph.nodes[0].scale = glm::vec3(scale);
        pose(graph, 0.0);
        EXPECT_EQ(graph.scene.directional_lights[0].direction_world,
                  glm::vec3(0, 0, scale < 0.0F ? 1 : -1))
            << scale;
        EXPECT_NO_THROW(validate(*graph.scene.camera)) << scale;
        EXPECT_NEAR(glm::determinant(glm::mat3(graph.scene.camera->world_from_view)), 1.0F,
                    place_rounding);
    }
}

TEST(Pose, KeepsTheFarPlaneBehindMovingObjects) {
    SceneGraph graph = one_of_each();
    graph.camera_sees_all = true;
    for (const float away : {10.0F, 1000.0F}) {
        graph.nodes[1].translation = {0, 0, -away};
        pose(graph, 0.0);
        EXPECT_GT(graph.scene.camera->far, away + 1.0F);
        EXPECT_LT(graph.scene.camera->far, 1.05F * (away + 7.0F));
    }
}

KeyChannel keys(KeyChannel::Property property, KeyInterpolation interpolation,
                std::vector<float> times, std::vector<glm::vec4> values) {
    return {0, property, interpolation, std::move(times), std::move(values)};
}

TEST(KeyFrames, StepLineAndSpline) {
    using P = KeyChannel::Property;
    const KeyChannel step =
        keys(P::translation, KeyInterpolation::step, {1, 2}, {{0, 0, 0, 0}, {4, 0, 0, 0}});
    EXPECT_EQ(value_at(step, 0.0).x, 0.0F);
    EXPECT_EQ(value_at(step, 1.99).x, 0.0F);
    EXPECT_EQ(value_at(step, 2.0).x, 4.0F);
    EXPECT_EQ(value_at(step, 9.0).x, 4.0F);
    KeyChannel line = step;
    line.interpolation = KeyInterpolation::linear;
    EXPECT_EQ(value_at(line, 0.5).x, 0.0F);
    EXPECT_EQ(value_at(line, 1.25).x, 1.0F);
    EXPECT_EQ(value_at(line, 3.0).x, 4.0F);
    // A Hermite curve over two seconds, from 0 with slope 1 to 4 with slope 0. Its middle is (0 +
    // 4) / 2 + 2 (1 - 0) / 8.
    const KeyChannel spline =
        keys(P::scale, KeyInterpolation::cubic_spline, {0, 2},
             {{9, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}, {4, 0, 0, 0}, {9, 0, 0, 0}});
    EXPECT_NEAR(value_at(spline, 1.0).x, 2.25F, place_rounding);
    EXPECT_EQ(value_at(spline, 0.0).x, 0.0F);
    EXPECT_EQ(value_at(spline, 2.0).x, 4.0F);
}

TEST(KeyFrames, TurnOnTheShortestArc) {
    using P = KeyChannel::Property;
    const float s = std::sqrt(0.5F);
    // A rotation by 90 degrees about y, with the opposite sign and another length.
    const KeyChannel turn =
        keys(P::rotation, KeyInterpolation::linear, {0, 1}, {{0, 0, 0, 2}, {0, -3 * s, 0, -3 * s}});
    const glm::vec4 half = value_at(turn, 0.5);
    EXPECT_NEAR(std::abs(half.y), std::sin(pi / 8), place_rounding);
    EXPECT_NEAR(std::abs(half.w), std::cos(pi / 8), place_rounding);
    EXPECT_NEAR(glm::length(value_at(turn, 2.0)), 1.0F, place_rounding);
    // If a spline of rotations passes through zero, it keeps the key before.
    const KeyChannel through = keys(P::rotation, KeyInterpolation::cubic_spline, {0, 1},
                                    {{}, {0, 0, 0, 1}, {}, {}, {0, 0, 0, -1}, {}});
    EXPECT_EQ(value_at(through, 0.5), glm::vec4(0, 0, 0, 1));
}

SceneGraph moving_light(Animation animation) {
    SceneGraph graph;
    graph.nodes.resize(1);
    graph.scene.point_lights.resize(1);
    graph.scene.spot_lights.resize(1);
    graph.point_lights = {{0}};
    graph.spot_lights = {{0}};
    graph.animations = {std::move(animation)};
    return graph;
}

glm::vec3 light_at(SceneGraph& graph, double seconds) {
    pose(graph, seconds);
    return graph.scene.point_lights[0].position_world;
}

TEST(Pose, PlaysKeysAgainAndAgain) {
    SceneGraph graph =
        moving_light(KeyAnimation{"move",
                                  {keys(KeyChannel::Property::translation, KeyInterpolation::linear,
                                        {0, 4}, {{0, 0, 0, 0}, {8, 0, 0, 0}})}});
    EXPECT_EQ(duration(graph), 4.0);
    EXPECT_EQ(light_at(graph, 1.0).x, 2.0F);
    EXPECT_EQ(light_at(graph, 5.0).x, 2.0F);
    EXPECT_EQ(light_at(graph, -1.0).x, 6.0F);
    EXPECT_EQ(light_at(graph, 4.0).x, 0.0F);
}

TEST(Clips, PlayAloneIfTheyMoveTheSame) {
    const auto slide = [](const char* name, std::size_t node, float length) {
        KeyChannel channel;
        channel.node = node;
        channel.times = {0.0F, length};
        channel.values = {glm::vec4(0.0F), glm::vec4(length, 0.0F, 0.0F, 0.0F)};
        return KeyAnimation{name, {channel}};
    };
    SceneGraph graph = one_of_each();
    graph.animations = {slide("walk", 1, 2.0F), Orbit{.node = 3}, slide("", 2, 3.0F)};
    EXPECT_FALSE(clips_exclude_each_other(graph));
    EXPECT_THAT(clip_names(graph), testing::ElementsAre("walk", "animation 2"));
    graph.animations.emplace_back(slide("run", 1, 4.0F));
    EXPECT_TRUE(clips_exclude_each_other(graph));
    std::get<Orbit>(graph.animations[1]).azimuth_speed = 0.0F;
    EXPECT_DOUBLE_EQ(duration(graph), 4.0);
    graph.clip = 0;
    EXPECT_DOUBLE_EQ(duration(graph), 2.0);
    pose(graph, 1.0);
    expect_place(graph.scene.instances[0].world_from_object[3], {1, 0, 0});
    graph.clip = 2;
    pose(graph, 1.0);
    expect_place(graph.scene.instances[0].world_from_object[3], {1, 0, 0});
    EXPECT_DOUBLE_EQ(duration(graph), 4.0);
    SceneGraph whole;
    whole.nodes.resize(1);
    append(whole, graph, 0);
    EXPECT_THAT(clip_names(whole), testing::ElementsAre("run"));
}

KeyChannel pointing(std::string pointer, std::size_t index, std::vector<glm::vec4> values) {
    KeyChannel channel =
        keys(KeyChannel::Property::pointer, KeyInterpolation::linear, {0, 2}, std::move(values));
    channel.node = index;
    channel.pointer = std::move(pointer);
    return channel;
}

/// Lights, cameras and materials with numbers that move for two seconds.
SceneGraph with_moving_numbers() {
    SceneGraph graph;
    graph.scene.materials.resize(2);
    graph.scene.materials[1].metallic_roughness.emplace();
    graph.scene.directional_lights.resize(1);
    graph.scene.point_lights.resize(1);
    graph.scene.spot_lights.resize(1);
    graph.cameras.resize(2);
    graph.cameras[1].camera.orthographic_height = 1.0F;
    choose_camera(graph, 1);
    graph.animations = {KeyAnimation{
        "",
        {pointing("materials.emission", 0, {{0, 0, 0, 0}, {2, 4, 6, 8}}),
         pointing("materials.metallic_roughness.roughness", 1, {{0, 0, 0, 0}, {3, 0, 0, 0}}),
         pointing("materials.metallic_roughness.attenuation_distance", 1,
                  {{4, 0, 0, 0}, {6, 0, 0, 0}}),
         pointing("directional_lights.color", 0, {{0, 0, 0, 0}, {2, 2, 2, 0}}),
         pointing("point_lights.range", 0, {{1, 0, 0, 0}, {3, 0, 0, 0}}),
         pointing("spot_lights.color", 0, {{1, 1, 1, 0}, {3, 3, 3, 0}}),
         pointing("spot_lights.outer_cone", 0, {{0.5F, 0, 0, 0}, {-1, 0, 0, 0}}),
         pointing("cameras.fov", 0, {{0, 0, 0, 0}, {1, 0, 0, 0}}),
         pointing("cameras.orthographic_height", 1, {{1, 0, 0, 0}, {5, 0, 0, 0}})}}};
    graph.scene.spot_lights[0].inner_cone = 0.4F;
    return graph;
}

TEST(Pose, SetsNumbersAndColorsWithinTheirRanges) {
    SceneGraph graph = with_moving_numbers();
    EXPECT_NO_THROW(validate(graph));
    EXPECT_TRUE(moves_materials(graph));
    EXPECT_EQ(duration(graph), 2.0);
    pose(graph, 1.0);
    const Scene& scene = graph.scene;
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.materials[1].metallic_roughness->roughness, 1.0F) << "1.5 is limited";
    EXPECT_EQ(scene.materials[1].metallic_roughness->attenuation_distance, 5.0F);
    EXPECT_EQ(scene.directional_lights[0].irradiance, glm::vec3(1.0F));
    EXPECT_EQ(scene.point_lights[0].range, 2.0F);
    EXPECT_EQ(scene.spot_lights[0].point.intensity, glm::vec3(2.0F));
    EXPECT_EQ(scene.spot_lights[0].outer_cone, 1e-3F) << "-0.25 is limited";
    EXPECT_LT(scene.spot_lights[0].inner_cone, 1e-3F) << "it stays within the outer cone";
    EXPECT_EQ(graph.cameras[0].camera.vertical_fov, 0.5F);
    EXPECT_EQ(scene.camera->orthographic_height, 3.0F) << "this camera is chosen";
    EXPECT_NO_THROW(validate(graph));
    pose(graph, 0.0);
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(0.0F));
    EXPECT_GT(graph.cameras[0].camera.vertical_fov, 0.0F) << "0 is no field of view";

    graph.scene.materials.pop_back();
    EXPECT_NO_THROW(pose(graph, 1.0));
    EXPECT_EQ(test::message_of<InvalidInput>([&] { validate(graph); }),
              "animation 0: an animation moves 'materials.metallic_roughness.roughness' of object "
              "1, which does not exist");
    graph.scene.materials.emplace_back().metallic_roughness.emplace();
    auto& channels = std::get<KeyAnimation>(graph.animations[0]).channels;
    for (const char* nothing :
         {"", "materials", "materials.", "materials.name", "nodes.color",
          "materials.metallic_roughness", "materials.metallic_roughness.red"}) {
        channels[0].pointer = nothing;
        EXPECT_THROW(validate(graph), InvalidInput) << nothing;
    }
    channels.erase(channels.begin(), channels.begin() + 3);
    EXPECT_FALSE(moves_materials(graph));
}

TEST(Append, KeepsTheNumbersThatAnimationsMove) {
    SceneGraph whole = with_moving_numbers();
    whole.nodes.resize(1);
    whole.animations.clear();
    append(whole, with_moving_numbers(), 0);
    EXPECT_NO_THROW(validate(whole));
    pose(whole, 1.0);
    EXPECT_EQ(whole.scene.materials[0].emission, glm::vec3(0.0F));
    EXPECT_EQ(whole.scene.materials[2].emission, glm::vec3(1, 2, 3));
    EXPECT_EQ(whole.scene.point_lights[1].range, 2.0F);
    EXPECT_EQ(whole.scene.spot_lights[1].point.intensity, glm::vec3(2.0F));
    EXPECT_EQ(whole.scene.directional_lights[1].irradiance, glm::vec3(1.0F));
}

TEST(Clips, ExcludeEachOtherIfTheyMoveTheSameNumber) {
    SceneGraph graph = with_moving_numbers();
    graph.animations.emplace_back(
        KeyAnimation{"", {pointing("materials.emission", 1, {{0, 0, 0, 0}, {2, 4, 6, 8}})}});
    EXPECT_FALSE(clips_exclude_each_other(graph));
    std::get<KeyAnimation>(graph.animations[1]).channels[0].node = 0;
    EXPECT_TRUE(clips_exclude_each_other(graph));
}

TEST(Pose, OrbitsOnSphericalCoordinates) {
    Orbit orbit;
    orbit.center = {1, 2, 3};
    orbit.radius = 5.0F;
    orbit.azimuth = pi / 2;
    orbit.azimuth_speed = pi;
    orbit.faces_center = true;
    SceneGraph graph = moving_light(orbit);
    EXPECT_NEAR(duration(graph), 2.0, 1e-6);
    expect_place(light_at(graph, 0.0), {6, 2, 3});
    expect_place(graph.scene.spot_lights[0].direction_world, {-1, 0, 0});
    expect_place(light_at(graph, 0.5), {1, 2, -2});
    // A day later, the light is in the same place except for the rounding of the speed: 43200 turns
    // of 4e-8 each.
    expect_place(light_at(graph, 86400.0), {6, 2, 3}, 0.05F);
    std::get<Orbit>(graph.animations[0]).elevation = pi / 2;
    expect_place(light_at(graph, 0.3), {1, 7, 3});
    expect_place(graph.scene.spot_lights[0].direction_world, {0, -1, 0});
}

TEST(Pose, TurnsTablesAboutTheirAxis) {
    SceneGraph graph = moving_light(Turntable{0, {0, 0, 2}, pi / 2, pi / 2});
    graph.nodes[0].translation = {10, 0, 0};
    graph.point_lights[0].node_from_object = looking_along({1, 0, 0}, {0, 0, -1});
    EXPECT_NEAR(duration(graph), 4.0, 1e-6);
    expect_place(light_at(graph, 0.0), {10, 1, 0});
    expect_place(light_at(graph, 1.0), {9, 0, 0});
    std::get<Turntable>(graph.animations[0]).speed = 0.0F;
    EXPECT_EQ(duration(graph), 0.0);
}

TEST(LookingAlong, PutsMinusZThere) {
    for (const glm::vec3 direction :
         {glm::vec3(0, -1, 0), {0, 1, 0}, {3, 0, 0}, {1, -2, 3}, {0, 0, 1}}) {
        const glm::mat4 matrix = looking_along({1, 2, 3}, direction);
        expect_place(-matrix[2], glm::normalize(direction));
        EXPECT_NEAR(glm::determinant(matrix), 1.0F, place_rounding);
        EXPECT_EQ(matrix[3], glm::vec4(1, 2, 3, 1));
        EXPECT_GE(matrix[1].y, -place_rounding);
    }
}

/// Returns the message of validate(), or "valid".
std::string verdict(const std::function<void(SceneGraph&)>& spoil) {
    SceneGraph graph = one_of_each();
    graph.nodes[1].name = "wheel";
    spoil(graph);
    try {
        validate(graph);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "valid";
}

// Walking from each node to its root would take minutes.
TEST(ValidateGraph, ALongChainOfNodesIsLinear) {
    SceneGraph graph;
    graph.nodes.resize(300'000);
    for (std::size_t i = 1; i < graph.nodes.size(); ++i)
        graph.nodes[i].parent = i - 1;
    EXPECT_NO_THROW(validate(graph));
    graph.nodes[0].parent = 150'000;
    EXPECT_THAT(test::message_of<InvalidInput>([&] { validate(graph); }),
                "node 0 is its own ancestor");
}

TEST(ValidateGraph, NamesTheFirstOffence) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    using P = KeyChannel::Property;
    const auto with = [](Animation animation) {
        return [animation](SceneGraph& g) { g.animations = {animation}; };
    };
    const auto with_keys = [&](const KeyChannel& channel) {
        return with(KeyAnimation{"", {channel}});
    };
    EXPECT_EQ(verdict([](SceneGraph&) {}), "valid");
    EXPECT_EQ(verdict([](SceneGraph& g) { g.nodes[0].parent = 1; }), "node 0 is its own ancestor");
    EXPECT_EQ(verdict([](SceneGraph& g) { g.nodes[1].parent = 9; }),
              "node 'wheel''s parent names node 9, but there are only 6");
    EXPECT_EQ(verdict([&](SceneGraph& g) { g.nodes[1].scale.x = nan; }),
              "node 'wheel' has a transform that is not finite");
    EXPECT_EQ(verdict([](SceneGraph& g) {
                  g.nodes[1].rotation = {0, 0, 0, 0};
              }),
              "node 'wheel' has a rotation without a length");
    EXPECT_EQ(verdict([](SceneGraph& g) { g.point_lights.resize(2); }),
              "nodes carry 2 point lights, but there are only 1");
    EXPECT_EQ(verdict([](SceneGraph& g) { g.camera.node = 6; }),
              "number 0 of the cameras names node 6, but there are only 6");
    EXPECT_EQ(verdict(with(Orbit{.node = 7})), "animation 0 names node 7, but there are only 6");
    EXPECT_EQ(verdict(with(Orbit{.node = 1, .radius = -1})),
              "animation 0: radius is -1, but must be finite and at least 0");
    EXPECT_EQ(verdict(with(Turntable{.node = 1, .axis = {0, 0, 0}})),
              "animation 0: axis is (0, 0, 0), but must have a length");
    EXPECT_EQ(verdict([&](SceneGraph& g) {
                  g.nodes[1].matrix = glm::mat4(1.0F);
                  g.animations = {Orbit{.node = 1}};
              }),
              "animation 0 moves node 'wheel', which has a matrix instead of translation, rotation "
              "and scale");
    EXPECT_EQ(verdict(with_keys(keys(P::scale, KeyInterpolation::step, {}, {}))),
              "animation 0: a channel has no keys");
    EXPECT_EQ(verdict(with_keys(keys(P::scale, KeyInterpolation::cubic_spline, {0}, {{}}))),
              "animation 0: a channel of 1 keys has 1 values, but needs 3");
    EXPECT_EQ(verdict(with_keys(keys(P::scale, KeyInterpolation::step, {1, 1}, {{}, {}}))),
              "animation 0: time 1 of a channel is 1, but times must be finite and ascending");
    EXPECT_EQ(verdict(with_keys(keys(P::scale, KeyInterpolation::step, {0}, {{0, nan, 0, 0}}))),
              "animation 0: value 0 of a channel is (0, nan, 0, 0), but must be finite");
    EXPECT_EQ(verdict(with_keys(keys(P::rotation, KeyInterpolation::step, {0}, {{}}))),
              "animation 0: rotation 0 of a channel has no length");
}

TEST(Pose, RefusesCycles) {
    SceneGraph graph = one_of_each();
    EXPECT_THROW(pose(graph, std::numeric_limits<double>::infinity()), InvalidInput);
    graph.nodes[0].parent = 3;
    EXPECT_THROW(pose(graph, 0.0), InvalidInput);
    graph.nodes[0].parent = 0;
    EXPECT_THROW(pose(graph, 0.0), InvalidInput);
    graph.nodes[0].parent = 100;
    EXPECT_THROW(pose(graph, 0.0), InvalidInput);
    graph.nodes[0].parent.reset();
    graph.instances[0].node = 100;
    EXPECT_THROW(pose(graph, 0.0), InvalidInput);
    graph.instances[0].node = 1;
    graph.animations = {Orbit{.node = 100}};
    EXPECT_THROW(pose(graph, 0.0), InvalidInput);
    graph.animations = {KeyAnimation{
        "", {keys(KeyChannel::Property::scale, KeyInterpolation::linear, {0, 1}, {{}})}}};
    EXPECT_THROW(pose(graph, 0.0), InvalidInput);
}

TEST(LoadSceneGraph, MovesTheBoxOfARealAnimation) {
    RELIEF_NEEDS_SHARED(file, "data/models/gltf/BoxAnimated/glTF-Binary/BoxAnimated.glb");
    Report report;
    SceneGraph graph = load_scene_graph(file, {}, report);
    EXPECT_NEAR(duration(graph), 3.70833, 1e-4);
    EXPECT_EQ(load_scene(file, report).instances[0].world_from_object,
              graph.scene.instances[0].world_from_object);
    const Bounds before = world_bounds(graph.scene);
    pose(graph, 1.8);
    const Bounds after = world_bounds(graph.scene);
    EXPECT_GT(after.max.y, before.max.y + 0.5F);  // The inner box moved up.
    pose(graph, 0.0);
    EXPECT_EQ(world_bounds(graph.scene).max, before.max);
}

/// Two joints of a bar of two quads: the first one stands still, the second one is at y = 1.
SceneGraph bar_with_joints() {
    SceneGraph graph;
    graph.nodes.resize(3);  // The mesh, and two joints.
    graph.nodes[0].translation = {50.0F, 0.0F, 0.0F};
    graph.nodes[2].parent = 1;
    graph.nodes[2].translation = {0.0F, 1.0F, 0.0F};
    Mesh bar;
    bar.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {1, 2, 0}};
    bar.normals.assign(6, {0, 0, 1});
    bar.triangles = {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}};
    graph.scene.meshes.emplace_back(bar);
    graph.instances.push_back({0});
    DeformedInstance deformed;
    GltfDeformation how;
    how.joints.push_back({std::vector<glm::uvec4>(6, {0, 1, 9, 0}), {}});
    how.joints[0].weights = {{1, 0, 0, 0}, {1, 0, 0, 0}, {2, 2, 0, 0},
                             {1, 1, 7, 0}, {0, 1, 0, 0}, {0, 1, 0, 0}};
    graph.scene.instances.emplace_back().pose.emplace().deformation = how;
    deformed.joints = {1, 2};
    deformed.joint_from_mesh.assign(2, glm::mat4(1.0F));
    deformed.joint_from_mesh[1][3] = {0, -1, 0, 1};
    graph.deformed.push_back(std::move(deformed));
    return graph;
}

TEST(Deformation, JointsMoveVerticesByTheirWeights) {
    SceneGraph graph = bar_with_joints();
    validate(graph);
    pose(graph, 0.0);
    EXPECT_EQ(graph.scene.instances[0].world_from_object, glm::mat4(1.0F))
        << "joints place the mesh, not its node";
    for (std::size_t i = 0; i < 6; ++i)
        expect_place(deformed_mesh(graph.scene, 0)->positions[i],
                     graph.scene.meshes[0]->positions[i]);
    // The upper joint leans to the viewer by 90 degrees: y becomes z.
    graph.nodes[2].rotation = glm::angleAxis(pi / 2, glm::vec3(1, 0, 0));
    pose(graph, 0.0);
    const Mesh bent = deformed_mesh(graph.scene, 0);
    expect_place(bent.positions[0], {0, 0, 0});
    expect_place(bent.positions[2], {0, 1, 0});  // On the axis of the joint.
    expect_place(bent.positions[5], {1, 1, 1});
    expect_place(bent.normals[5], {0, -1, 0});
    expect_place(bent.normals[0], {0, 0, 1});
    // Half of each rotation; the joint that does not exist has no weight.
    expect_place(bent.normals[3], {0, -std::sqrt(0.5F), std::sqrt(0.5F)});
    EXPECT_EQ(graph.scene.meshes[0]->positions[5], glm::vec3(1, 2, 0)) << "the mesh is at rest";
}

TEST(Deformation, MorphTargetsAddTheirDisplacements) {
    SceneGraph graph = bar_with_joints();
    DeformedInstance& deformed = graph.deformed[0];
    deformed.joints.clear();
    deformed.joint_from_mesh.clear();
    GltfDeformation how;
    how.targets.resize(2);
    how.targets[0].positions.assign(6, {0, 0, 4});
    how.targets[1].positions.assign(6, {8, 0, 0});
    how.targets[1].normals.assign(6, {0, 0, -2});
    graph.scene.instances[0].pose->deformation = how;
    deformed.weights = {0.5F, 0.0F};
    pose(graph, 0.0);
    expect_place(deformed_mesh(graph.scene, 0)->positions[1], {1, 0, 2});
    expect_place(graph.scene.instances[0].world_from_object[3], {50, 0, 0});
    KeyChannel channel;
    channel.property = KeyChannel::Property::weights;
    channel.times = {0.0F, 2.0F};
    channel.weights = {0.0F, 0.0F, 0.0F, 1.0F};
    graph.animations.emplace_back(KeyAnimation{"", {channel}});
    validate(graph);
    pose(graph, 1.0);
    expect_place(deformed_mesh(graph.scene, 0)->positions[1], {5, 0, 0});
    expect_place(deformed_mesh(graph.scene, 0)->normals[1],
                 {0, 0, 1});  // Without a length: at rest.
    pose(graph, 1.5);
    expect_place(deformed_mesh(graph.scene, 0)->normals[1], {0, 0, -1});
    channel.interpolation = KeyInterpolation::cubic_spline;
    // In-tangents, values and out-tangents of both keys: the slope is 1 at the start.
    channel.weights = {0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    EXPECT_FLOAT_EQ(weights_at(channel, 1.0)[1], 0.5F + 2.0F * 0.125F);
    channel.weights.pop_back();
    EXPECT_THROW(check_keys(channel), InvalidInput);
}

TEST(Deformation, FollowsTheVerticesOfVariants) {
    SceneGraph graph = bar_with_joints();
    graph.nodes[2].rotation = glm::angleAxis(pi / 2, glm::vec3(1, 0, 0));
    pose(graph, 0.0);
    const Mesh bent = deformed_mesh(graph.scene, 0);
    Report report;
    const Scene variant =
        with_variant(graph.scene, prepare_variant(NormalMode::flat, graph.scene, {}, report));
    EXPECT_NO_THROW(validate(variant));
    const Mesh faceted = deformed_mesh(variant, 0);
    ASSERT_EQ(faceted.positions.size(), 12U) << "each triangle has vertices of its own";
    for (std::size_t i = 0; i < bent.triangles.size(); ++i) {
        const glm::uvec3 corners = bent.triangles[i];
        const glm::vec3 a = bent.positions[corners.x];
        const glm::vec3 plane_normal = glm::normalize(
            glm::cross(bent.positions[corners.y] - a, bent.positions[corners.z] - a));
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = faceted.triangles[i][k];
            expect_place(faceted.positions[vertex], bent.positions[corners[k]]);
            expect_place(faceted.normals[vertex], plane_normal);
        }
    }
}

TEST(Deformation, RealModelsAreSkinnedAndMorphed) {
    RELIEF_NEEDS_SHARED(fox, "data/models/gltf/Fox/glTF-Binary/Fox.glb");
    RELIEF_NEEDS_SHARED(morph,
                        "data/models/gltf/AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb");
    for (const auto& file : {fox, morph}) {
        Report report;
        SceneGraph graph = load_scene_graph(file, {}, report);
        EXPECT_TRUE(report.empty());
        ASSERT_EQ(graph.deformed.size(), 1U);
        const Mesh before = deformed_mesh(graph.scene, 0);
        const auto at_rest = graph.scene.meshes[0].identity();
        pose(graph, 0.4);
        EXPECT_NE(deformed_mesh(graph.scene, 0)->positions, before.positions);
        EXPECT_TRUE(at_rest.is(graph.scene.meshes[0])) << "a pose changes no mesh";
        EXPECT_NO_THROW(validate(graph.scene));
        pose(graph, 0.0);
        EXPECT_EQ(deformed_mesh(graph.scene, 0)->positions, before.positions);
    }
    EXPECT_EQ(clip_names(load_scene_graph(fox, {})).size(), 3U);
}

}  // namespace
}  // namespace relief
