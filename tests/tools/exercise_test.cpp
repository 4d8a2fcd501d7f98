// SPDX-License-Identifier: Apache-2.0
// Exercises: those of data/exercises are solved by the parts that are built in and by nothing less;
// attempts in RELIEF_SHADER_DIR, and files that are no exercises.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "relief/mesh/image.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

FILE_LABELS(cli);

using nlohmann::json;
using test::picture_in;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

const char* const size = " --size 120x60 --output out/picture.png ";

/// Runs an exercise with attempts in the folder my/.
ProgramResult attempt(const Workplace& workplace, const std::string& words) {
    return workplace.run("RELIEF_SHADER_DIR=my relief-view --exercise " + words);
}

class ShippedExercise : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, ShippedExercise,
                         testing::Values("phong-by-reflection", "tangent-space",
                                         "reflection-mapping"),
                         [](const auto& name) {
                             std::string text = name.param;
                             std::replace(text.begin(), text.end(), '-', '_');
                             return text;
                         });

TEST_P(ShippedExercise, IsSolvedByTheBuiltInPartAlone) {
    const Workplace workplace;
    const std::string file = "data/exercises/" + std::string(GetParam()) + ".json";
    const json exercise = json::parse(workplace.read(file));
    const ProgramResult start = attempt(workplace, file + size + "--json --strict");
    EXPECT_EQ(start.exit_code, 3) << start.error;
    const json hole = json::parse(start.out)["exercise"];
    EXPECT_EQ(hole["title"], exercise["title"]);
    EXPECT_EQ(hole["from"], "start");
    EXPECT_EQ(hole["solved"], false);
    EXPECT_GT(hole["flip_mean"], 2 * hole["allowed"].get<double>());
    EXPECT_GE(exercise["hints"].size(), 3U);

    // The part as it is built in.
    const std::string part = exercise["part"];
    const std::string name = part.substr(0, part.find('#'));
    ASSERT_EQ(workplace
                  .run("mkdir my && cp " + (test::source_directory() / "shaders" / name).string() +
                       " my/")
                  .exit_code,
              0);
    const ProgramResult solved = attempt(workplace, file + size + "--strict");
    EXPECT_EQ(solved.exit_code, 0) << solved.error;
    EXPECT_THAT(solved.out, HasSubstr(part + " from $RELIEF_SHADER_DIR"));
    EXPECT_THAT(solved.out, HasSubstr("FLIP 0 (largest 0): solved"));
}

TEST(Exercise, ComparesAnAttemptThatIsNearAndNamesTheLineOfAnError) {
    const Workplace workplace;
    const std::string file = "data/exercises/phong-by-reflection.json";
    ASSERT_EQ(workplace.run("mkdir my").exit_code, 0);
    const std::string head =
        "//@part phong implements specular\n//@include \"phong.glsl#"
        "cosine_power\"\n//@include <highlight_color>\n"
        "//@include <sharpness>\nuniform float shininess;\n"
        "vec3 specular_highlight(Surface surface, vec3 light_world) {\n";
    // A right answer in other words: reflect() written out.
    workplace.write("my/phong.glsl",
                    head +
                        "vec3 n = surface.normal_world;\n"
                        "vec3 r = 2.0 * dot(n, light_world) * n - light_world;\n"
                        "return highlight_color(surface, light_world) * dimmed(shininess) * "
                        "cosine_power(r, surface.view_world, sharpened(shininess));\n}\n");
    EXPECT_EQ(attempt(workplace, file + size + "--strict").exit_code, 0);
    // A wrong one: the direction is not turned round.
    workplace.write("my/phong.glsl", head +
                                         "return highlight_color(surface, light_world) * "
                                         "cosine_power(reflect(light_world, surface.normal_world), "
                                         "surface.view_world, shininess);\n}\n");
    const ProgramResult wrong = attempt(workplace, file + size + "--difference-map out/map.png");
    EXPECT_EQ(wrong.exit_code, 0) << wrong.error;
    EXPECT_THAT(wrong.out, HasSubstr(": not solved, a solution has at most 0.0005"));
    EXPECT_EQ(picture_in(workplace / "out/map.png").width, 120);
    workplace.write("my/phong.glsl", head + "return vec3(0.0)\n}\n");
    const ProgramResult broken = attempt(workplace, file + size);
    EXPECT_EQ(broken.exit_code, 1);
    EXPECT_THAT(broken.error, HasSubstr("phong.glsl:8"));
}

/// The text of an exercise with one member replaced; null removes it.
std::string changed(const char* member, const json& value) {
    json exercise = {{"relief_exercise", 1},
                     {"title", "t"},
                     {"task", "t"},
                     {"scene", "scene.json"},
                     {"part", "phong.glsl#phong"},
                     {"start", "start.glsl"}};
    if (value.is_null())
        exercise.erase(member);
    else
        exercise[member] = value;
    return exercise.dump();
}

TEST(Exercise, RefusesBadFilesByPointer) {
    const Workplace workplace;
    const std::string start = "//@part phong implements specular\n// TODO\n";
    workplace.write("scene.json", workplace.read("data/scenes/shading-specular.json"));
    workplace.write("start.glsl", start);
    workplace.write("empty.glsl", "//@part phong implements specular\n");
    workplace.write("other.glsl", "//@part other\n// TODO\n");
    workplace.write("malformed.glsl", "code\n//@part phong\n");
    struct Row {
        const char* member;
        json value;
        const char* problem;
    };
    const std::vector<Row> rows = {
        {"relief_exercise", 2, "/relief_exercise: must be 1, the only version"},
        {"relief_exercise", nullptr, "has no 'relief_exercise'"},
        {"title", 3, "/title: must be a string"},
        {"hint", "x", "'hint'"},
        {"hints", {"a", 1}, "/hints/1: must be a string"},
        {"scene", "none.json", "/scene: names "},
        {"part", "phong.glsl#none", "/part: there is no part 'none' in shader file 'phong.glsl'"},
        {"start", "none.glsl", "/start: names "},
        {"start", "empty.glsl", "/start: the part has no TODO"},
        {"start", "other.glsl", "has no part 'phong.glsl#phong'"},
        {"start", "malformed.glsl", "/start: malformed.glsl: shader phong.glsl:1: code before"},
        {"solution", "other.glsl", "/solution: other.glsl has no part"},
        {"reference", "none.png", "/reference: names "},
        {"max_flip", 2, "/max_flip: "},
    };
    for (const Row& row : rows) {
        workplace.write("bad.json", changed(row.member, row.value));
        const ProgramResult result = attempt(workplace, "bad.json" + std::string(size));
        EXPECT_EQ(result.exit_code, 1) << row.problem;
        EXPECT_THAT(result.error, HasSubstr("bad.json: ")) << row.problem;
        EXPECT_THAT(result.error, HasSubstr(row.problem));
    }
    workplace.write("unused.json", changed("part", "phong.glsl#clamped_terms"));
    workplace.write("start.glsl", "//@part clamped_terms implements term_limit\n// TODO\n");
    const ProgramResult unused = attempt(workplace, "unused.json" + std::string(size));
    EXPECT_EQ(unused.exit_code, 1);
    EXPECT_THAT(unused.error, HasSubstr("/part: no program of the scene has"));
    EXPECT_EQ(attempt(workplace, "bad.json data/vase.obj" + std::string(size)).exit_code, 2);
}

TEST(Exercise, ComparesWithASolutionOfItsOwnOrAPicture) {
    const Workplace workplace;
    workplace.write("scene.json", workplace.read("data/scenes/shading-specular.json"));
    const std::string hole =
        "//@part lambert implements diffuse\n//@include \"inputs.glsl#diffuse_color\"\n"
        "vec3 diffuse_scattering(float n_dot_l) {\n    return diffuse_color;  // TODO\n}\n";
    std::string half = hole;
    half.replace(half.find("diffuse_color;"), 14, "0.5 * diffuse_color * n_dot_l;");
    workplace.write("start.glsl", hole);
    workplace.write("half.glsl", half);
    json exercise = json::parse(changed("solution", "half.glsl"));
    exercise["part"] = "phong.glsl#lambert";
    workplace.write("own.json", exercise.dump());
    ASSERT_EQ(workplace.run("mkdir my && cp half.glsl my/phong.glsl").exit_code, 0);
    EXPECT_THAT(attempt(workplace, "own.json" + std::string(size)).out,
                HasSubstr("FLIP 0 (largest 0): solved"));
    ASSERT_EQ(workplace.run("cp out/picture.png half.png && rm my/phong.glsl").exit_code, 0);
    exercise.erase("solution");
    exercise["reference"] = "half.png";
    workplace.write("picture.json", exercise.dump());
    EXPECT_THAT(attempt(workplace, "picture.json" + std::string(size)).out,
                HasSubstr(": not solved"));
    const ProgramResult other = attempt(workplace, "picture.json --size 60x60 --output out/a.png");
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_THAT(other.error, HasSubstr("has 120 x 60 pixels, but the picture has 60 x 60"));
}

}  // namespace
}  // namespace relief::tools
