// SPDX-License-Identifier: Apache-2.0
#include "window/viewer_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "tools/workplace.h"
#include "window/background_jobs.h"
#include "window/input_files.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::Workplace;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// A cart with two wheels, one of which carries a light, and a stone without a node.
SceneGraph cart() {
    SceneGraph graph;
    graph.nodes.resize(3);
    graph.nodes[0].name = "cart";
    graph.nodes[1].parent = 0;
    graph.nodes[2].parent = 0;
    graph.nodes[2].name = "wheel";
    graph.scene.instances.resize(4);
    graph.instances.resize(3);
    graph.instances[0].node = 0;
    graph.instances[1].node = 1;
    graph.instances[2].node = 2;
    graph.scene.point_lights.resize(2);
    graph.point_lights.resize(2);
    graph.point_lights[1].node = 2;
    graph.scene.camera.emplace();
    graph.camera.node = 0;
    return graph;
}

TEST(SceneTreeTest, ListsTheNodeHierarchy) {
    const SceneTree tree = tree_of(cart());
    ASSERT_EQ(tree.nodes.size(), 3U);
    EXPECT_EQ(tree.nodes[0].name, "cart");
    EXPECT_EQ(tree.nodes[1].name, "node 1") << "it has none";
    EXPECT_THAT(tree.world.children, ElementsAre(0));
    EXPECT_THAT(tree.nodes[0].children, ElementsAre(1, 2));
    EXPECT_THAT(tree.nodes[0].instances, ElementsAre(0));
    EXPECT_THAT(tree.nodes[0].carried, ElementsAre("camera"));
    EXPECT_THAT(tree.nodes[2].instances, ElementsAre(2));
    EXPECT_THAT(tree.nodes[2].carried, ElementsAre("point light 2"));
    EXPECT_THAT(tree.world.instances, ElementsAre(3)) << "the list of what is carried is shorter";
    EXPECT_THAT(tree.world.carried, ElementsAre("point light 1"));
}

TEST(SceneTreeTest, FindsAllInstancesBelowANode) {
    const SceneTree tree = tree_of(cart());
    EXPECT_THAT(instances_below(tree, tree.nodes[0]), UnorderedElementsAre(0, 1, 2));
    EXPECT_THAT(instances_below(tree, tree.nodes[2]), ElementsAre(2));
    EXPECT_THAT(instances_below(tree, tree.world), UnorderedElementsAre(0, 1, 2, 3));
    EXPECT_THAT(instances_below(tree_of({}), tree_of({}).world), IsEmpty());
}

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
    [[nodiscard]] const Workplace& workplace() const { return workplace_; }

  private:
    Workplace workplace_;
    ViewerState state_{ViewOptions{}};
};

TEST_F(State, HasNoRequestWithoutASceneOrAView) {
    EXPECT_FALSE(state().request());
    show("square.obj");
    ASSERT_TRUE(state().request());
    EXPECT_EQ(state().request()->settings.width, 400);
    EXPECT_EQ(state().request()->settings.height, 300);
    state().set_view({0, 300});
    EXPECT_FALSE(state().request());
}

TEST_F(State, AnotherModelResetsTheViewAndTheSameModelKeepsIt) {
    show("square.obj");
    EXPECT_NEAR(glm::length(state().camera().target), 0.0F, 1e-5F);
    state().act(Action::top);
    state().act(Action::zoom_in);
    const OrbitCamera before = state().camera();
    const std::uint64_t revision = state().request()->revision;
    show("square.obj");
    EXPECT_EQ(state().camera().elevation, before.elevation);
    EXPECT_EQ(state().camera().distance, before.distance);
    EXPECT_GT(state().request()->revision, revision);
    show("far.obj");
    EXPECT_NEAR(state().camera().target.x, 90.5F, 0.2F);
}

TEST_F(State, EditsStayWhenTheFileIsReadAgain) {
    show("square.obj");
    state().edit([](Scene& scene) { scene.exposure = 4.0F; });
    for (int i = 0; i < 2; ++i) {
        show("square.obj");
        EXPECT_EQ(state().scene().exposure, 4.0F);
        EXPECT_EQ(state().json(RenderedPicture{})["edits"]["kept"], 1);
    }
    state().edit([](Scene& scene) { scene.exposure = 1.0F; });
    show("square.obj");
    EXPECT_EQ(state().json(RenderedPicture{})["edits"]["kept"], 0) << "as the file says";
}

TEST_F(State, AnErrorKeepsTheSceneAndEndsWithTheNextScene) {
    show("square.obj");
    const std::shared_ptr<const Scene> scene = state().request()->scene;
    Loaded broken;
    broken.options.model = "broken.obj";
    broken.error = "broken.obj: no triangles";
    state().take(std::move(broken));
    EXPECT_EQ(state().request()->scene, scene);
    EXPECT_EQ(state().error(), "broken.obj: no triangles");
    EXPECT_EQ(state().options().model.filename(), "square.obj");
    show("far.obj");
    EXPECT_EQ(state().error(), "");
}

TEST_F(State, EditsCopyTheSceneAndShareItsMeshes) {
    show("square.obj");
    const std::shared_ptr<const Scene> before = state().request()->scene;
    const std::uint64_t revision = state().request()->revision;
    state().edit([](Scene& scene) { scene.exposure = 4.0F; });
    EXPECT_EQ(before->exposure, 1.0F);
    EXPECT_EQ(state().scene().exposure, 4.0F);
    EXPECT_EQ(&*state().scene().meshes[0], &*before->meshes[0]);
    EXPECT_EQ(state().request()->revision, revision + 1);
}

TEST_F(State, LightMarkersAreInThePictureOnly) {
    show("square.obj");
    state().edit([](Scene& scene) { scene.point_lights.push_back({{0.0F, 3.0F, 0.0F}}); });
    const std::uint64_t revision = state().request()->revision;
    state().act(Action::light_markers);
    EXPECT_GT(state().request()->revision, revision);
    const Scene& shown = *state().request()->scene;
    ASSERT_EQ(shown.instances.size(), 2U);
    EXPECT_EQ(shown.instances[1].world_from_object[3], glm::vec4(0.0F, 3.0F, 0.0F, 1.0F));
    EXPECT_EQ(state().scene().instances.size(), 1U);
    state().act(Action::light_markers);
    EXPECT_EQ(state().request()->scene->instances.size(), 1U);
}

TEST_F(State, MovingTheCameraKeepsTheRevision) {
    show("square.obj");
    const DrawRequest before = *state().request();
    state().act(Action::orbit_left);
    EXPECT_EQ(state().request()->revision, before.revision);
    EXPECT_NE(state().request()->camera.world_from_view, before.camera.world_from_view);
}

TEST_F(State, AxisKeysLookAlongAxes) {
    show("square.obj");
    const auto looks_from = [&](Action action) {
        state().act(action);
        return glm::vec3(state().request()->camera.world_from_view[2]);
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
        state().act(Action::widen_fov);
    EXPECT_NEAR(glm::degrees(state().camera().vertical_fov), 150.0F, 1e-3F);
    for (int i = 0; i < 200; ++i)
        state().act(Action::narrow_fov);
    EXPECT_NEAR(glm::degrees(state().camera().vertical_fov), 2.0F, 1e-3F);
}

TEST_F(State, KeysChangeTheExposureByHalfAStop) {
    show("square.obj");
    state().act(Action::brighter);
    EXPECT_FLOAT_EQ(state().scene().exposure, std::sqrt(2.0F));
    for (int i = 0; i < 100; ++i)
        state().act(Action::brighter);
    EXPECT_EQ(state().scene().exposure, 256.0F);
    for (int i = 0; i < 17; ++i)
        state().act(Action::darker);
    EXPECT_NEAR(state().scene().exposure, std::exp2(8.0F - 8.5F), 1e-6);
}

TEST_F(State, TurntableRotatesByTimeAndStops) {
    show("square.obj");
    EXPECT_FALSE(state().advance(1.0));
    const float begin = state().camera().azimuth;
    state().act(Action::turntable);
    EXPECT_TRUE(state().advance(0.25));
    EXPECT_TRUE(state().advance(0.25));
    EXPECT_NEAR(state().camera().azimuth, begin - 0.25F, 1e-6F);
    state().act(Action::turntable);
    EXPECT_FALSE(state().advance(1.0));
}

TEST_F(State, LightsRotateAndKeepTheirIntensity) {
    show("square.obj");
    ASSERT_FALSE(state().scene().directional_lights.empty());
    const DirectionalLight before = state().scene().directional_lights[0];
    // Half a turn, because the distance is the height of the view.
    state().orbit_lights({300.0F, 0.0F});
    const DirectionalLight after = state().scene().directional_lights[0];
    EXPECT_NEAR(after.direction_world.y, before.direction_world.y, 1e-5F);
    EXPECT_NEAR(after.direction_world.x, -before.direction_world.x, 1e-5F);
    EXPECT_NEAR(after.direction_world.z, -before.direction_world.z, 1e-5F);
    EXPECT_EQ(after.irradiance, before.irradiance);
}

TEST_F(State, ShowsDebugViewsByKeyAndKeepsThemForAnotherModel) {
    show("square.obj");
    const std::uint64_t revision = state().request()->revision;
    state().act(Action::next_view);
    state().act(Action::wireframe);
    state().act(Action::health_markers);
    EXPECT_FALSE(state().request()->settings.overlays.markers) << "they are looked for elsewhere";
    const HealthRequest sought = state().take_health_request().value();
    EXPECT_EQ(sought.choice, HealthChoice::problem);
    EXPECT_FALSE(state().take_health_request()) << "only once";
    state().take(HealthResult{health_markers(*sought.scene), ""});
    const DrawRequest request = *state().request();
    EXPECT_NE(request.revision, revision);
    EXPECT_EQ(request.settings.view, DebugView::geometric_normal);
    EXPECT_TRUE(request.settings.overlays.wireframe);
    EXPECT_TRUE(request.settings.overlays.markers);
    EXPECT_THAT(state().command_line(), testing::HasSubstr(" --show geometric-normal --wireframe "
                                                           "--health-markers problems"));
    show("far.obj");
    EXPECT_TRUE(state().take_health_request()->choice) << "of the new model too";
    EXPECT_EQ(state().json(RenderedPicture{})["show"], "geometric-normal");
    EXPECT_EQ(state().json(RenderedPicture{})["overlays"]["wireframe"], true);
    state().act(Action::previous_view);
    state().act(Action::previous_view);
    EXPECT_EQ(state().request()->settings.view, DebugView::overdraw);
    state().act(Action::picture_view);
    EXPECT_EQ(state().request()->settings, (FrameSettings{.width = 400, .height = 300}));
}

TEST_F(State, CommandLineRestoresTheView) {
    show("square.obj");
    state().act(Action::zoom_in);
    state().act(Action::orbit_left);
    state().act(Action::widen_fov);
    pan_by(state().camera(), {12.0F, 7.0F}, 300);
    const std::string text = state().command_line();
    const Camera before = state().request()->camera;
    state().act(Action::top);
    state().act(Action::fit);
    state().apply_view_text(text);
    EXPECT_EQ(state().request()->camera.world_from_view, before.world_from_view);
    EXPECT_EQ(state().request()->camera.vertical_fov, before.vertical_fov);
    state().apply_view_text("nonsense and more");
    EXPECT_THAT(state().error(), testing::HasSubstr("contains no camera"));
    EXPECT_EQ(state().request()->camera.world_from_view, before.world_from_view);
    state().apply_view_text("0,0");  // The same place from the front.
    EXPECT_EQ(state().error(), "");
    EXPECT_EQ(state().camera().azimuth, 0.0F);
    EXPECT_GT(glm::length(state().camera().target), 0.0F);
}

TEST_F(State, TheOrthographicCameraIsSwitchedAndCopied) {
    show("square.obj");
    EXPECT_FALSE(state().request()->camera.orthographic_height);
    state().act(Action::orthographic);
    const Camera before = state().request()->camera;
    ASSERT_TRUE(before.orthographic_height);
    const OrbitCamera& orbit = state().camera();
    EXPECT_FLOAT_EQ(*before.orthographic_height,
                    2.0F * orbit.distance * std::tan(0.5F * orbit.vertical_fov));
    const std::string text = state().command_line();
    EXPECT_THAT(text, testing::HasSubstr(" --orthographic"));
    state().act(Action::orthographic);
    EXPECT_FALSE(state().request()->camera.orthographic_height);
    state().apply_view_text(text);
    EXPECT_EQ(state().request()->camera, before);
    state().apply_view_text("0,0");
    EXPECT_TRUE(state().request()->camera.orthographic_height) << "only the direction changes";
}

TEST_F(State, TheStudioLightsTheSceneWithoutAFile) {
    show("square.obj");
    state().set_environment("studio");
    EXPECT_EQ(state().error(), "");
    ASSERT_TRUE(state().scene().environment);
    EXPECT_TRUE(is_studio(*state().scene().environment));
    EXPECT_TRUE(state().scene().environment->lights);
    EXPECT_FALSE(state().scene().environment->skybox);
    state().act(Action::undo);
    EXPECT_FALSE(state().scene().environment);
}

TEST_F(State, HidesInstancesFromThePictureAndNotFromTheScene) {
    show("square.obj");
    const std::uint64_t revision = state().request()->revision;
    state().show({0}, false);
    EXPECT_FALSE(state().is_shown(0));
    EXPECT_EQ(state().request()->scene->instances.size(), 0U);
    EXPECT_EQ(state().scene().instances.size(), 1U);
    EXPECT_GT(state().request()->revision, revision);
    state().edit([](Scene& scene) { scene.exposure = 2.0F; });
    EXPECT_EQ(state().request()->scene->instances.size(), 0U) << "an edit shows nothing";
    show("square.obj");
    EXPECT_FALSE(state().is_shown(0)) << "the same model read again";
    show("far.obj");
    EXPECT_TRUE(state().is_shown(0));
    EXPECT_EQ(state().request()->scene->instances.size(), 1U);
}

TEST_F(State, LightsRotateUntilTheirSpeedIsZero) {
    show("square.obj");
    EXPECT_FALSE(state().is_turning());
    std::vector<LightRow> rows = state().light_rows();
    ASSERT_FALSE(rows.empty());
    const glm::vec3 before = state().scene().directional_lights[0].direction_world;
    rows[0].speed = 1.0F;
    state().set_light_rows(rows);
    EXPECT_TRUE(state().is_turning());
    const DrawRequest request = *state().request();
    EXPECT_TRUE(state().advance(0.5));
    EXPECT_GT(state().request()->pose, request.pose);
    EXPECT_EQ(state().request()->revision, request.revision) << "nothing is prepared again";
    const glm::vec3 after = state().scene().directional_lights[0].direction_world;
    EXPECT_NEAR(after.y, before.y, 1e-5F);
    EXPECT_NEAR(glm::length(after), glm::length(before), 1e-5F);
    EXPECT_GT(glm::distance(after, before), 0.1F);
    show("square.obj");
    EXPECT_EQ(state().light_rows()[0].speed, 1.0F) << "the same model read again";
    rows = state().light_rows();
    rows[0].speed = 0.0F;
    state().set_light_rows(rows);
    EXPECT_FALSE(state().is_turning());
    EXPECT_FALSE(state().advance(0.5));
}

TEST_F(State, TurnsTheEnvironmentByHalfATurnPerHeightOfTheView) {
    show("square.obj");
    state().turn_environment(100.0F);  // There is none.
    state().set_environment(workplace() / "data/sky");
    state().turn_environment(75.0F);
    EXPECT_NEAR(state().scene().environment->rotation, std::numbers::pi_v<float> / 4, 1e-5F);
    state().turn_environment(300.0F);
    EXPECT_NEAR(state().scene().environment->rotation, -3 * std::numbers::pi_v<float> / 4, 1e-5F);
    state().set_environment(workplace() / "data/sky/posx.jpg");
    EXPECT_NEAR(state().scene().environment->rotation, -3 * std::numbers::pi_v<float> / 4, 1e-5F);
}

TEST_F(State, FailedEditChangesNothingAndReportsTheError) {
    show("square.obj");
    const std::shared_ptr<const Scene> scene = state().request()->scene;
    state().set_environment("nothing.hdr");
    EXPECT_THAT(state().error(), testing::HasSubstr("nothing.hdr"));
    EXPECT_EQ(state().request()->scene, scene);
    state().try_edit([](Scene& edited) { edited.exposure = 2.0F; });
    EXPECT_EQ(state().error(), "");
}

TEST_F(State, UsesAMapOfAnotherKindAnyway) {
    show("square.obj");
    state().name_default_material();
    const std::filesystem::path colors = workplace() / "data/bricks-diffuse.png";
    const auto normal_map = [&] { return map_name(state().scene(), 0, TextureSlot::normal); };
    state().set_map(0, TextureSlot::normal, workplace() / "absent.png");
    EXPECT_FALSE(state().has_refused_map()) << "there is no such file";
    state().set_map(0, TextureSlot::normal, colors);
    EXPECT_THAT(state().error(), testing::HasSubstr("is not a normal map"));
    EXPECT_TRUE(state().has_refused_map());
    EXPECT_FALSE(normal_map());
    EXPECT_FALSE(state().use_refused_map()) << "nothing must be read again";
    EXPECT_EQ(normal_map(), colors.string());
    EXPECT_EQ(state().error(), "");
    EXPECT_FALSE(state().has_refused_map());
    // Another error replaces the refusal.
    state().set_map(0, TextureSlot::bump, workplace() / test::bricks_map);
    EXPECT_TRUE(state().has_refused_map());
    state().set_map(0, TextureSlot::bump, workplace() / "absent.png");
    EXPECT_FALSE(state().has_refused_map());
    EXPECT_EQ(normal_map(), colors.string());
}

TEST_F(State, AMapThatIsRefusedWithTheModelIsAssumedWhenItIsReadAgain) {
    ViewOptions options;
    options.model = workplace() / "square.obj";
    options.normal_map = workplace() / "data/bricks-diffuse.png";
    Loader loader([] {});
    const auto load = [&] {
        loader.start(options);
        while (true) {
            if (std::optional<Loaded> loaded = loader.take())
                return state().take(std::move(*loaded));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    };
    load();
    EXPECT_FALSE(state().has_scene());
    EXPECT_TRUE(state().has_refused_map());
    const std::optional<MapKind> kind = state().use_refused_map();
    ASSERT_EQ(kind, MapKind::normal);
    options.assumed.push_back(*kind);
    load();
    EXPECT_EQ(state().error(), "");
    EXPECT_FALSE(state().has_refused_map());
    ASSERT_TRUE(state().has_scene());
    EXPECT_TRUE(state().scene().materials[0].normal_map);
    // The assumption ends with the map.
    options = with_dropped(options, {"other-normal.png"});
    EXPECT_THAT(options.assumed, IsEmpty());
}

TEST_F(State, UndoesAndRedoesEditsStepByStep) {
    show("square.obj");
    const auto expose = [&](float exposure) {
        state().edit([&](Scene& scene) { scene.exposure = exposure; });
    };
    state().act(Action::undo);
    EXPECT_EQ(state().scene().exposure, 1.0F) << "there is nothing to undo";
    expose(2.0F);
    expose(3.0F);  // The same step, as in a drag.
    state().end_edit_step();
    state().act(Action::brighter);
    const float brightest = state().scene().exposure;
    EXPECT_GT(brightest, 3.0F);

    state().act(Action::undo);
    EXPECT_EQ(state().scene().exposure, 3.0F);
    EXPECT_EQ(state().request()->scene->exposure, 3.0F) << "it is drawn";
    state().act(Action::undo);
    EXPECT_EQ(state().scene().exposure, 1.0F);
    state().act(Action::redo);
    EXPECT_EQ(state().scene().exposure, 3.0F);
    state().act(Action::redo);
    EXPECT_EQ(state().scene().exposure, brightest);
    state().act(Action::redo);
    EXPECT_EQ(state().scene().exposure, brightest) << "there is nothing to redo";

    state().act(Action::undo);
    expose(5.0F);
    state().act(Action::redo);
    EXPECT_EQ(state().scene().exposure, 5.0F) << "an edit ends the list of steps to redo";
    state().act(Action::undo);
    EXPECT_EQ(state().scene().exposure, 3.0F);
    show("square.obj");
    EXPECT_EQ(state().scene().exposure, 3.0F) << "the edit is kept for the file that is read again";
    state().act(Action::undo);
    EXPECT_EQ(state().scene().exposure, 3.0F) << "steps end with the scene that was read before";
}

TEST_F(State, UndoesLightsAndEnvironmentsWithWhatBelongsToThem) {
    show("square.obj");
    std::vector<LightRow> rows = state().light_rows();
    ASSERT_FALSE(rows.empty());
    const std::size_t lights = rows.size();
    rows[0].speed = 1.0F;
    rows.push_back(rows[0]);
    rows.back().id = 0;
    state().set_light_rows(rows);
    state().end_edit_step();
    state().set_environment(workplace() / "data/sky");
    ASSERT_EQ(state().error(), "");
    state().end_edit_step();
    state().set_environment("nothing.hdr");
    EXPECT_NE(state().error(), "");
    EXPECT_EQ(state().options().environment.front().filename(), "sky")
        << "that of the last success";

    state().act(Action::undo);
    EXPECT_EQ(state().error(), "");
    EXPECT_FALSE(state().scene().environment) << "a failed edit is no step";
    EXPECT_TRUE(state().options().environment.empty());
    EXPECT_EQ(state().light_rows().size(), lights + 1);
    EXPECT_TRUE(state().is_turning());
    state().act(Action::undo);
    EXPECT_EQ(state().light_rows().size(), lights);
    EXPECT_FALSE(state().is_turning());
    state().act(Action::redo);
    EXPECT_EQ(state().light_rows().size(), lights + 1);
    EXPECT_TRUE(state().is_turning());
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

TEST_F(State, IsWrittenAsJson) {
    show("square.obj");
    state().camera().azimuth = glm::radians(40.0F);
    const nlohmann::ordered_json described = state().json(RenderedPicture{});
    EXPECT_NEAR(described["camera"]["azimuth"].get<double>(), 40.0, 1e-5);
    EXPECT_EQ(described["view"], nlohmann::ordered_json({400, 300}));
    EXPECT_EQ(described["triangles"], 2);
    EXPECT_EQ(described["drawn"]["frames"], 0);
    EXPECT_EQ(described["error"], "");
}

}  // namespace
}  // namespace relief::tools
