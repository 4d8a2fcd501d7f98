// SPDX-License-Identifier: Apache-2.0
// Measurements on a scene, applying a method, and discarding both.
#include "window/scene_accuracy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief-view/variant_options.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/statistics.h"
#include "tools/window/display.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

using test::eventually;
using testing::Contains;
using testing::SizeIs;

/// A jittered torus with exact normals.
Loaded torus(const std::string& name) {
    AnalyticMesh ground_truth =
        analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, 24, 1);
    ground_truth.mesh.normals.assign(ground_truth.normals.begin(), ground_truth.normals.end());
    Loaded loaded;
    loaded.options.model = name;
    loaded.composed.emplace();
    shade::Scene& scene = loaded.composed->scene();
    scene.meshes.emplace_back(std::move(ground_truth.mesh));
    scene.instances.push_back({});
    return loaded;
}

ViewerState state_of(const std::string& name) {
    ViewerState state{ViewOptions{}};
    state.take(torus(name));
    return state;
}

/// The largest angle in degrees between the normals of the first meshes.
double moved(const ViewerState& before, const ViewerState& after) {
    double most = 0.0;
    const Mesh& a = *before.scene().meshes[0];
    const Mesh& b = *after.scene().meshes[0];
    for (std::size_t i = 0; i < a.normals.size(); ++i) {
        most = std::max(most, degrees_between(glm::dvec3(a.normals[i]), glm::dvec3(b.normals[i])));
    }
    return most;
}

void wait_for(SceneAccuracy& accuracy, ViewerState& state) {
    ASSERT_TRUE(eventually([&] {
        accuracy.follow(state);
        return !accuracy.is_working();
    }));
}

TEST(SceneAccuracy, MeasuresAndOffersEveryWeighting) {
    ViewerState state = state_of("torus.obj");
    SceneAccuracy accuracy([] {});
    accuracy.follow(state);
    accuracy.measure(state);
    EXPECT_TRUE(accuracy.is_measuring());
    wait_for(accuracy, state);
    ASSERT_EQ(accuracy.result().error, "");
    ASSERT_FALSE(accuracy.result().topics.empty());
    const AccuracyTopic& normals = accuracy.result().topics.front();
    EXPECT_EQ(normals.own.experiment.subject, Subject::normals);
    std::vector<std::string> uses;
    for (const std::size_t row : normals.rows) {
        if (normals.uses[row]) uses.push_back(to_text(*normals.uses[row]));
    }
    EXPECT_THAT(uses, Contains("normals=max"));
    EXPECT_THAT(uses, Contains("normals=area"));
    EXPECT_THAT(uses, testing::Not(Contains("")));
    for (const std::size_t row : normals.rows) {
        const Measurement& one = normals.own.experiment.measurements[row];
        EXPECT_EQ(normals.uses[row].has_value(), one.method != "the file's own") << one.method;
    }
}

TEST(SceneAccuracy, ChosenMethodIsAppliedToTheScene) {
    ViewerState state = state_of("torus.obj");
    const ViewerState before = state;
    SceneAccuracy accuracy([] {});
    accuracy.follow(state);
    accuracy.use(Variant(NormalWeight::area));
    accuracy.follow(state);
    wait_for(accuracy, state);
    EXPECT_EQ(accuracy.result().error, "");
    EXPECT_GT(moved(before, state), 0.5);
    EXPECT_TRUE(accuracy.is_used(Variant(NormalWeight::area), state.options()));
    EXPECT_FALSE(accuracy.is_used(Variant(NormalWeight::max), state.options()));
}

TEST(SceneAccuracy, ReloadedSceneGetsTheMethodAndNoOldResults) {
    ViewerState state = state_of("torus.obj");
    const ViewerState before = state;
    SceneAccuracy accuracy([] {});
    accuracy.follow(state);
    accuracy.measure(state);
    wait_for(accuracy, state);
    accuracy.use(Variant(NormalWeight::area));
    accuracy.follow(state);
    wait_for(accuracy, state);
    const ViewerState chosen = state;
    state.take(torus("torus.obj"));
    EXPECT_EQ(moved(before, state), 0.0);
    accuracy.follow(state);
    EXPECT_THAT(accuracy.result().topics, SizeIs(0));
    wait_for(accuracy, state);
    EXPECT_EQ(moved(chosen, state), 0.0);
}

TEST(SceneAccuracy, StoppedMeasurementHasNoResult) {
    ViewerState state = state_of("torus.obj");
    SceneAccuracy accuracy([] {});
    accuracy.follow(state);
    accuracy.measure(state);
    accuracy.stop();
    EXPECT_FALSE(accuracy.is_measuring());
    accuracy.follow(state);
    EXPECT_THAT(accuracy.result().topics, SizeIs(0));
}

TEST(SceneAccuracy, InapplicableMethodIsAnErrorAndNotChosen) {
    ViewerState state = state_of("torus.obj");
    SceneAccuracy accuracy([] {});
    accuracy.follow(state);
    accuracy.use(Variant(TangentMethod::lengyel));  // No map of the scene needs tangents.
    accuracy.follow(state);
    wait_for(accuracy, state);
    EXPECT_NE(accuracy.result().error, "");
    EXPECT_FALSE(accuracy.is_used(Variant(TangentMethod::lengyel), state.options()));
}

}  // namespace
}  // namespace relief::tools
