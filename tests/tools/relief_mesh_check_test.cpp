// SPDX-License-Identifier: Apache-2.0
// The command `relief-mesh check`: findings, tangent methods, output and exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

/// Writes a square and a collinear triangle.
void write_bad(const Workplace& workplace, const std::string& name) {
    workplace.write(name,
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\nf 1 2 3\nf 2 4 3\nf 1 5 2\n");
}

TEST(CheckCommand, ReportsASoundModel) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result = workplace.run("relief-mesh check square.obj --strict");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    EXPECT_EQ(result.out,
              "file      square.obj: Wavefront OBJ, 1 primitive, 2 triangles: sound\n"
              "notes     4 x boundary edge\n"
              "details   docs/hard-cases.md describes each condition\n");
}

TEST(CheckCommand, ReportsProblemsAndStrictFails) {
    const Workplace workplace;
    write_bad(workplace, "bad.obj");
    workplace.write_square("square.obj");
    const ProgramResult lenient = workplace.run("relief-mesh check square.obj bad.obj");
    EXPECT_EQ(lenient.exit_code, 0);
    EXPECT_EQ(lenient.error, "");
    EXPECT_THAT(lenient.out,
                HasSubstr("file      bad.obj: Wavefront OBJ, 1 primitive, 3 triangles: has "
                          "problems\nproblems  1 x collinear triangle (triangle 2): has collinear "
                          "corners, so no area and no normal\n"));
    EXPECT_THAT(lenient.out,
                HasSubstr("verdict   2 files: 1 sound, 1 with problems, 0 unreadable\n"));

    const ProgramResult strict =
        workplace.run("relief-mesh check square.obj bad.obj --strict --quiet");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_EQ(strict.out, "");
    EXPECT_EQ(strict.error,
              "relief-mesh: warning: 1 file with problems (exit code 3, because of --strict)\n");
}

TEST(CheckCommand, ContinuesAfterUnreadableFiles) {
    const Workplace workplace;
    workplace.write("broken.obj", "v 0 0 zero\n");
    workplace.write_square("square.obj");
    const ProgramResult result =
        workplace.run("relief-mesh check broken.obj missing.ply square.obj --strict");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("relief-mesh: error: broken.obj: line 1: 'zero' is not a "
                                        "number\nrelief-mesh: error: missing.ply: "));
    EXPECT_THAT(result.out,
                HasSubstr("square.obj: Wavefront OBJ, 1 primitive, 2 triangles: sound"));
    EXPECT_THAT(result.out, HasSubstr("3 files: 1 sound, 0 with problems, 2 unreadable\n"));

    const json report = json::parse(
        workplace.run("relief-mesh check broken.obj missing.ply square.obj --json").out);
    EXPECT_EQ(report["unreadable"], 2);
    EXPECT_EQ(report["sound"], 1);
    EXPECT_EQ(report["files"][0]["error"], "broken.obj: line 1: 'zero' is not a number");
    EXPECT_EQ(report["files"][2]["sound"], true);
}

TEST(CheckCommand, PrintsOneJsonObject) {
    const Workplace workplace;
    write_bad(workplace, "bad.obj");
    const ProgramResult result = workplace.run("relief-mesh check bad.obj --json --strict");
    EXPECT_EQ(result.exit_code, 3);
    const json report = json::parse(result.out);
    EXPECT_EQ(report["tool"], "relief-mesh check");
    EXPECT_EQ(report["with_problems"], 1);
    const json part = report["files"][0]["primitives"][0];
    EXPECT_EQ(part["sound"], false);
    EXPECT_EQ(part["triangles"], 3);
    EXPECT_EQ(part["size"], 2.0);
    ASSERT_EQ(part["problems"].size(), 2U);
    EXPECT_EQ(part["problems"][1]["kind"], "vertex with only degenerate triangles");
    EXPECT_EQ(part["problems"][0]["kind"], "collinear triangle");
    EXPECT_EQ(part["problems"][0]["element"], "triangle");
    EXPECT_EQ(part["problems"][0]["count"], 1);
    EXPECT_EQ(part["problems"][0]["first"], json({2}));
    ASSERT_EQ(part["notes"].size(), 1U);
    EXPECT_EQ(part["notes"][0]["kind"], "boundary edge");
}

TEST(CheckCommand, OtherContentOfAFormatIsNotAProblem) {
    const Workplace workplace;
    workplace.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\np 1\nl 1 2\n");
    workplace.write("lost.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/9 2/9 3/9\n");
    const ProgramResult points = workplace.run("relief-mesh check points.obj --strict");
    EXPECT_EQ(points.exit_code, 0);
    EXPECT_THAT(points.out, HasSubstr("notes     1 x point left out, 1 x line left out, 3 x "
                                      "boundary edge\n"));
    const ProgramResult lost = workplace.run("relief-mesh check lost.obj --strict");
    EXPECT_EQ(lost.exit_code, 3);
    EXPECT_THAT(lost.out, HasSubstr("problems  3 x texture coordinate that does not exist (corner "
                                    "0, 1, 2): read as none\n"));
}

TEST(CheckCommand, TextureWithoutGradientIsAProblemForTangents) {
    const Workplace workplace;
    const std::string mesh =
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    workplace.write("a.obj", mesh);
    workplace.write("a.mtl", "newmtl a\nmap_Kd palette.png\n");
    const ProgramResult palette = workplace.run("relief-mesh check a.obj --strict");
    EXPECT_EQ(palette.exit_code, 0) << palette.out;
    EXPECT_THAT(palette.out, HasSubstr("1 x triangle without texture gradient\n"));
    workplace.write("a.mtl", "newmtl a\nmap_Kd palette.png\nnorm normal.png\n");
    EXPECT_EQ(workplace.run("relief-mesh check a.obj --strict").exit_code, 3);
}

TEST(CheckCommand, OverlappingTextureIsAProblemForBaking) {
    const Workplace workplace;
    workplace.write("mirror.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                    "f 1/1 2/2 3/3\nf 4/1 3/2 2/3\n");
    const ProgramResult shown = workplace.run("relief-mesh check mirror.obj --strict");
    EXPECT_EQ(shown.exit_code, 0);
    EXPECT_THAT(shown.out, HasSubstr("notes     4 x boundary edge, 2 x overlapping texture\n"));
    const ProgramResult baked = workplace.run("relief-mesh check mirror.obj --strict --for-baking");
    EXPECT_EQ(baked.exit_code, 3);
    EXPECT_THAT(baked.out,
                HasSubstr("problems  2 x overlapping texture (triangle 0, 1): shares texels with "
                          "another triangle: a bake is ambiguous\n"));
}

TEST(CheckCommand, MeasuresTextureCoordinates) {
    const Workplace workplace;
    // Two squares with the same coordinates; the second one has a material.
    workplace.write("two.mtl", "newmtl red\n");
    workplace.write("two.obj",
                    "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\n"
                    "v 4 1 0\nv 3 1 0\nvt 0.25 0.25\nvt 0.75 0.25\nvt 0.75 0.75\nvt 0.25 0.75\n"
                    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nusemtl red\nf 5/2 6/1 7/4\nf 5/2 7/4 8/3\n");
    const std::string one =
        "1 chart (0 below 64 texels), 25.0 % used, 64 texels per unit (5 to 95 %: 1.00 to 1.00 of "
        "it), stretch L2 1.000, seams 4";
    ProgramResult result = workplace.run("relief-mesh check two.obj --map-size 128");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("texcoords no material: " + one +
                                      "\n          material 0: " + one + ", 1 chart mirrored\n"));
    result = workplace.run("relief-mesh check two.obj --map-size 128x64 --json");
    const json maps = json::parse(result.out)["files"][0]["texcoords"];
    ASSERT_EQ(maps.size(), 2U);
    EXPECT_EQ(maps[1]["material"], "material 0");
    EXPECT_EQ(maps[1]["mirrored_charts"], 1);
    EXPECT_EQ(maps[1]["overlapping"], 0);
    EXPECT_EQ(maps[1]["min_distance"], nullptr);
    EXPECT_NEAR(maps[0]["atlas"]["mean_anisotropy"].get<double>(), 2.0, 1e-9);

    workplace.write_square("square.obj", true);
    EXPECT_THAT(workplace.run("relief-mesh check square.obj --map-size 64").out,
                HasSubstr("texcoords none\n"));
    result = workplace.run("relief-mesh check square.obj --map-size 8");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("--map-size 8"));
}

TEST(CheckCommand, OutputDoesNotDependOnThreads) {
    const Workplace workplace;
    const std::string line =
        "relief-mesh check data/vase.obj data/scenes/pot.glb --json --threads ";
    const ProgramResult one = workplace.run(line + "1");
    EXPECT_EQ(one.exit_code, 0);
    EXPECT_EQ(one.out, workplace.run(line + "3").out);
}

TEST(CheckCommand, RefusesInvalidUse) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    EXPECT_EQ(workplace.run("relief-mesh check").exit_code, 2);
    const ProgramResult image = workplace.run("relief-mesh check square.obj picture.png");
    EXPECT_EQ(image.exit_code, 2);
    EXPECT_EQ(image.out, "") << "known before anything is read";
    EXPECT_EQ(workplace.run("relief-mesh check square.obj --json --quiet").exit_code, 2);
}

// The samples of Khronos are sound models, so their findings are only notes.
TEST(CheckCommand, RealModelsAreSound) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    const Workplace workplace;
    const std::string folder = models.string();
    const ProgramResult result = workplace.run(
        "relief-mesh check --strict " + folder + "/Duck/glTF-Binary/Duck.glb " + folder +
        "/BoomBox/glTF/BoomBox.gltf " + folder + "/Fox/glTF-Binary/Fox.glb " + folder +
        "/CesiumMan/glTF-Binary/CesiumMan.glb " + folder +
        "/TextureSettingsTest/glTF-Binary/TextureSettingsTest.glb");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.error;
    EXPECT_THAT(result.out, HasSubstr("5 files: 5 sound, 0 with problems, 0 unreadable\n"));
}

TEST(CheckCommand, RealModelsHaveTheirProblems) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    const Workplace workplace;
    const std::string folder = models.string();
    EXPECT_THAT(
        workplace
            .run("relief-mesh check " + folder +
                 "/gltf/MetalRoughSpheresNoTextures/glTF-Binary/MetalRoughSpheresNoTextures.glb")
            .out,
        HasSubstr("problems  mesh 'Sphere' primitive 0: 2 x collapsed triangle (triangle "
                  "900, 9579): has two corners at the same position, so no area and no "
                  "normal (196 in 98 primitives)\n"));
    EXPECT_THAT(workplace.run("relief-mesh check " + folder + "/obj/nonmanifold/fan3.obj").out,
                HasSubstr("problems  1 x non-manifold edge (edge of triangle 0)"));
    EXPECT_THAT(workplace.run("relief-mesh check " + folder + "/obj/nonmanifold/moebius.obj").out,
                HasSubstr("problems  4 x flipped neighbors"));
    EXPECT_THAT(
        workplace.run("relief-mesh check " + folder + "/obj/nonmanifold/hourglass_ico.obj").out,
        HasSubstr("sound\nnotes     1 x bow-tie vertex\n"));
}

/// Writes the vase with tangents by a method.
void write_vase(const Workplace& workplace, const std::string& method) {
    const ProgramResult result =
        workplace.run("relief-mesh process data/vase.obj out/vase.gltf --tangents " + method);
    ASSERT_EQ(result.exit_code, 0) << result.error;
}

json tangents_of(const Workplace& workplace, const std::string& file) {
    const ProgramResult result = workplace.run("relief-mesh check --json " + file);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return json::parse(result.out)["files"][0]["primitives"][0]["tangents"];
}

/// Negates the w of the first `count` vertices of out/vase.gltf, or of all for 0.
void negate_signs(const Workplace& workplace, std::size_t count) {
    const json root = json::parse(workplace.read("out/vase.gltf"));
    const std::size_t index = root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"];
    const json& accessor = root["accessors"][index];
    const json& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::string bytes = workplace.read("out/vase.bin");
    const std::size_t all = accessor["count"];
    for (std::size_t v = 0; v < (count == 0 ? all : count); ++v) {
        char* at = bytes.data() + view.value("byteOffset", std::size_t(0)) + 16 * v + 12;
        float w = 0.0F;
        std::memcpy(&w, at, sizeof(w));
        w = -w;
        std::memcpy(at, &w, sizeof(w));
    }
    workplace.write("out/vase.bin", bytes);
}

TEST(CheckTangents, IdentifiesEachMethod) {
    const Workplace workplace;
    for (const std::string method : {"mikktspace", "area-weighted", "lengyel"}) {
        write_vase(workplace, method);
        const json tangents = tangents_of(workplace, "out/vase.gltf");
        EXPECT_EQ(tangents["basis"], method);
        EXPECT_EQ(tangents["variant"], "");
        EXPECT_EQ(tangents["agreements"].size(), 4U);
        EXPECT_EQ(tangents["stored_bits"], 32);
        EXPECT_EQ(tangents["texcoord_set"], 0);
        const ProgramResult text = workplace.run("relief-mesh check out/vase.gltf");
        EXPECT_THAT(text.out, HasSubstr("\ntangents  mesh 'vase' primitive 0: " + method + ": "));
        EXPECT_THAT(text.out, HasSubstr(" corners within 0.1 degrees (median 0.001, "));
    }
}

TEST(CheckTangents, ReportsNegatedSigns) {
    const Workplace workplace;
    write_vase(workplace, "mikktspace");
    negate_signs(workplace, 0);
    EXPECT_EQ(tangents_of(workplace, "out/vase.gltf")["variant"], "w negated");
    EXPECT_THAT(workplace.run("relief-mesh check out/vase.gltf").out,
                HasSubstr("primitive 0: mikktspace, w negated: "));
    write_vase(workplace, "mikktspace");
    negate_signs(workplace, 200);
    const json some = tangents_of(workplace, "out/vase.gltf");
    EXPECT_EQ(some["variant"], "");
    EXPECT_GT(some["agreements"][0]["w_negated"].get<int>(), 600);
    EXPECT_THAT(workplace.run("relief-mesh check out/vase.gltf").out,
                HasSubstr("primitive 0: mikktspace, w negated at "));
}

TEST(CheckTangents, FilesWithoutHaveNoLine) {
    const Workplace workplace;
    EXPECT_THAT(workplace.run("relief-mesh check data/vase.obj").out, Not(HasSubstr("tangents  ")));
    EXPECT_EQ(tangents_of(workplace, "data/vase.obj"), json());
}

TEST(CheckTangents, EqualPrimitivesAppearOnOneLine) {
    const Workplace workplace;
    write_vase(workplace, "mikktspace");
    json document = json::parse(workplace.read("out/vase.gltf"));
    document["meshes"][0]["primitives"].push_back(document["meshes"][0]["primitives"][0]);
    workplace.write("out/vase.gltf", document.dump());
    const std::string text = workplace.run("relief-mesh check out/vase.gltf").out;
    EXPECT_THAT(text, HasSubstr("primitive 0 (and 1 more): mikktspace: "));
    EXPECT_THAT(text, Not(HasSubstr("primitive 1")));
}

TEST(CheckTangents, IdentifiesRealModels) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    const Workplace workplace;
    const auto said_of = [&](const std::string& file) {
        return workplace.run("relief-mesh check " + (models / file).string()).out;
    };
    EXPECT_THAT(said_of("MultiUVTest/glTF-Binary/MultiUVTest.glb"),
                HasSubstr("mikktspace, from texture coordinate set 1: 36 of 36 corners within 0.1 "
                          "degrees"));
    EXPECT_THAT(said_of("TwoSidedPlane/glTF/TwoSidedPlane.gltf"),
                HasSubstr("mikktspace, w negated: 6 of 6 corners"));
    EXPECT_THAT(said_of("AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb"),
                HasSubstr("of unknown basis: there are no texture coordinates"));
    EXPECT_THAT(said_of("BoomBox/glTF/BoomBox.gltf"),
                HasSubstr("of unknown basis; nearest by far is mikktspace: "));
}

}  // namespace
}  // namespace relief::tools
