// SPDX-License-Identifier: Apache-2.0
// Edits of shader parts without a window: when they apply, their errors, differences and files.
#include "window/shader_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "exercise.h"
#include "relief/shade/picture_steps.h"
#include "relief/shade/scene_file.h"
#include "support/gl_environment.h"
#include "support/shared_data.h"
#include "window/lesson.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string lambert = "phong.glsl#lambert";

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(LineDifference, HasTheLinesOfBothTexts) {
    EXPECT_THAT(line_difference("a\nb\nc\n", "a\nc\nd\n"), ElementsAre("  a", "- b", "  c", "+ d"));
    EXPECT_THAT(line_difference("", "x\n"), ElementsAre("+ x"));
    EXPECT_THAT(line_difference("x\n", ""), ElementsAre("- x"));
    EXPECT_THAT(line_difference("old\n", "new\n"), ElementsAre("- old", "+ new"));
}

/// Edits in a folder of their own, which is $RELIEF_SHADER_DIR.
class Edits : public testing::Test {
  protected:
    test::TemporaryDirectory folder_;
    test::ScopedVariable variable_{"RELIEF_SHADER_DIR", folder_.path().c_str()};
    ShaderEdits edits_;
};

TEST_F(Edits, ApplyWhenTypingPauses) {
    const std::string text = edits_.text(lambert);
    EXPECT_THAT(text, HasSubstr("//@part lambert implements diffuse\n"));
    EXPECT_EQ(edits_.texts(), nullptr);
    edits_.set(lambert, text + "x", 10.0);
    EXPECT_FALSE(edits_.apply(10.3));
    edits_.set(lambert, text + "xy", 10.3);
    EXPECT_FALSE(edits_.apply(10.6)) << "0.3 s after the last letter";
    EXPECT_TRUE(edits_.is_pending());
    EXPECT_TRUE(edits_.apply(10.8));
    EXPECT_FALSE(edits_.is_pending());
    ASSERT_NE(edits_.texts(), nullptr);
    EXPECT_EQ(shader_part_text(lambert, *edits_.texts()).text, text + "xy\n");
    EXPECT_FALSE(edits_.apply(20.0)) << "nothing is new";
    edits_.reset(lambert);
    EXPECT_TRUE(edits_.apply(20.0));
    EXPECT_EQ(edits_.texts(), nullptr);
    EXPECT_FALSE(edits_.has_edits());
}

TEST_F(Edits, StandBesideEachOtherInAFile) {
    edits_.set(lambert, "//@part lambert implements diffuse\nfirst\n", 0.0);
    edits_.set("phong.glsl#color", "//@part color implements highlight_color\nsecond\n", 0.0);
    ASSERT_TRUE(edits_.apply(1.0));
    EXPECT_EQ(edits_.texts()->files.size(), 1U);
    EXPECT_EQ(shader_part_text(lambert, *edits_.texts()).first_line, 4);
    // The part of the color comes first in the file, with three lines.
    EXPECT_THAT(edits_.messages(lambert, "fragment shader: phong.glsl:5(2): error: what"),
                ElementsAre(LineMessage{2, "error: what"}));
    EXPECT_THAT(
        edits_.messages("phong.glsl#color", "phong.glsl:5(2): error: what\nphong.glsl:2: x"),
        ElementsAre(LineMessage{2, "x"}));
    EXPECT_THAT(edits_.messages(lambert, "light.glsl:5(2): error: what"), ElementsAre());
}

TEST_F(Edits, AreSavedAsPartsOfAFile) {
    std::ofstream(folder_ / "phong.glsl") << "// Mine.\n\n//@part other\nkept\n";
    edits_.set(lambert, "//@part lambert implements diffuse\nmine\n", 0.0);
    ASSERT_TRUE(edits_.apply(1.0));
    EXPECT_THAT(edits_.save(folder_ / "new"), ElementsAre("phong.glsl"));
    EXPECT_EQ(bytes_of(folder_ / "new/phong.glsl"), "//@part lambert implements diffuse\nmine\n");
    EXPECT_TRUE(edits_.has_edits()) << "that folder is not read";
    EXPECT_THAT(edits_.save(folder_.path()), ElementsAre("phong.glsl"));
    EXPECT_EQ(bytes_of(folder_ / "phong.glsl"),
              "// Mine.\n\n//@part other\nkept\n\n//@part lambert implements diffuse\nmine\n");
    EXPECT_FALSE(edits_.has_edits()) << "the folder has it now";
    EXPECT_TRUE(edits_.apply(2.0));
    EXPECT_EQ(edits_.text(lambert), "//@part lambert implements diffuse\nmine\n");
    edits_.reset(lambert);
    EXPECT_EQ(edits_.text(lambert), ShaderEdits::original(lambert));
    EXPECT_TRUE(edits_.is_edited(lambert)) << "as an edit of what the folder has";
}

TEST_F(Edits, BeginWithTheHoleOfAnExercise) {
    const Exercise exercise =
        read_exercise(test::source_directory() / "data/exercises/phong-by-reflection.json");
    edits_.begin(exercise);
    EXPECT_TRUE(edits_.apply(0.0)) << "at once";
    EXPECT_THAT(edits_.text("phong.glsl#phong"), HasSubstr("TODO"));
    std::ofstream(folder_ / "phong.glsl") << "//@part phong implements specular\nmine\n";
    ShaderEdits others;
    others.begin(exercise);
    EXPECT_FALSE(others.has_edits()) << "the attempt in the folder stays";
}

TEST(StepChoice, KeepsTheWholePictureUntilAStepIsChosen) {
    const auto scene = std::make_shared<const Scene>(
        load_scene(test::source_directory() / "data/scenes/environment-mapping.json"));
    StepChoice choice;
    EXPECT_EQ(choice.chosen(), nullptr);
    choice.follow(scene, {});
    ASSERT_EQ(choice.steps().size(), 7U);
    EXPECT_EQ(choice.shown(), 6U);
    EXPECT_EQ(choice.chosen(), nullptr);
    choice.show(2);
    ASSERT_NE(choice.chosen(), nullptr);
    EXPECT_EQ(choice.chosen()->name, "highlights");
    choice.follow(std::make_shared<const Scene>(*scene), {});
    EXPECT_EQ(choice.shown(), 2U) << "an edit of the scene keeps the step";
}

TEST(MistakeChoice, ChangesTextsAndSceneOnlyIfOneIsChosen) {
    const auto scene = std::make_shared<const Scene>(
        load_scene(test::source_directory() / "data/scenes/mistakes.json"));
    MistakeChoice choice;
    EXPECT_EQ(choice.texts(nullptr), nullptr);
    EXPECT_EQ(choice.scene(scene), scene);
    choice.choose(find_mistake("green"));
    const std::shared_ptr<const ShaderTexts> texts = choice.texts(nullptr);
    ASSERT_TRUE(texts);
    EXPECT_THAT(texts->files.at("normal_map.glsl"), HasSubstr("vec3(1.0, -1.0, 1.0)"));
    EXPECT_EQ(choice.texts(nullptr), texts) << "the last result is kept";
    EXPECT_EQ(choice.scene(scene), scene);
    choice.choose(find_mistake("srgb"));
    ASSERT_TRUE(choice.texts(nullptr)) << "another object, so that the picture is drawn again";
    EXPECT_TRUE(choice.texts(nullptr)->files.empty());
    const std::shared_ptr<const Scene> wrong = choice.scene(scene);
    EXPECT_EQ(wrong->images.size(), scene->images.size() + 1);
    EXPECT_EQ(choice.scene(scene), wrong);
    choice.choose(nullptr);
    EXPECT_EQ(choice.texts(nullptr), nullptr);
    EXPECT_EQ(choice.scene(scene), scene);
}

class CostOfMistakes : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(CostOfMistakes);

TEST_P(CostOfMistakes, IsMeasuredWhenThePictureRests) {
    DrawRequest request;
    request.scene = std::make_shared<const Scene>(
        load_scene(test::source_directory() / "data/scenes/mistakes.json"));
    request.settings.width = 1280;  // Of which half is measured.
    request.settings.height = 400;
    request.camera = *request.scene->camera;
    RenderCache cache(context());
    MistakeChoice choice;
    EXPECT_FALSE(choice.begin(request, 0.0)) << "none is chosen";
    choice.choose(find_mistake("back-faces"));
    EXPECT_FALSE(choice.begin(request, 1.0));
    EXPECT_TRUE(choice.is_pending());
    EXPECT_FALSE(choice.begin(request, 1.2));
    request.camera.world_from_view[3].x += 0.1F;
    EXPECT_FALSE(choice.begin(request, 1.4)) << "the camera has moved";
    std::optional<DrawTask> task = choice.begin(request, 1.8);
    ASSERT_TRUE(task);
    EXPECT_FALSE((*task)(context(), cache));
    EXPECT_FALSE(choice.is_pending());
    ASSERT_TRUE(choice.cost());
    ASSERT_TRUE(choice.cost()->angles);
    EXPECT_NEAR(choice.cost()->angles->max, 180.0, 1e-3);
    EXPECT_EQ(choice.cost()->change->flip.map.width, 640);
    EXPECT_EQ(choice.json()["chosen"], "back-faces");
    EXPECT_FALSE(choice.begin(request, 9.0)) << "nothing is new";
    choice.choose(find_mistake("green"));
    EXPECT_FALSE(choice.cost()) << "it is that of another mistake";
}

class CheckOfExercise : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(CheckOfExercise);

TEST_P(CheckOfExercise, TellsTheHoleFromTheSolution) {
    const auto exercise = std::make_shared<const Exercise>(
        read_exercise(test::source_directory() / "data/exercises/phong-by-reflection.json"));
    DrawRequest request;
    request.scene = std::make_shared<const Scene>(load_scene(exercise->scene));
    request.revision = 1;
    request.settings.shaders = attempt_at(*exercise).texts;
    RenderCache cache(context());
    ExerciseCheck check;
    std::optional<DrawTask> task = check.begin(exercise, request, {96, 40});
    ASSERT_TRUE(task);
    EXPECT_TRUE(check.is_working());
    EXPECT_FALSE(check.begin(exercise, request, {96, 40})) << "one at a time";
    EXPECT_FALSE((*task)(context(), cache));
    ASSERT_TRUE(check.result());
    EXPECT_FALSE(check.result()->is_solved());
    EXPECT_FALSE(check.begin(exercise, request, {96, 40})) << "nothing is new";
    request.revision = 2;
    request.settings.shaders = nullptr;
    task = check.begin(exercise, request, {96, 40});
    ASSERT_TRUE(task);
    EXPECT_FALSE((*task)(context(), cache));
    EXPECT_TRUE(check.result()->is_solved());
    EXPECT_EQ(check.json()["flip_mean"], 0.0);
}

}  // namespace
}  // namespace relief::tools
