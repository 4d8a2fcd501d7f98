// SPDX-License-Identifier: Apache-2.0
// relief-bake on models that do not belong together as they are: other units, other places, turned
// axes, too short rays, faces that point inwards; and which findings --strict fails.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Placement {
    double scale = 1.0;
    double x = 0.0, y = 0.0, z = 0.0;
};

/// An ellipsoid with texture coordinates, by columns and half as many rows.
std::string ellipsoid(int columns, double rx, double ry, double rz, const Placement& at = {}) {
    std::string text;
    const int rows = columns / 2;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const double around = 2.0 * std::numbers::pi * column / columns;
            const double down = std::numbers::pi * row / rows;
            text += fmt::format(
                "v {} {} {}\nvt {} {}\n", at.x + at.scale * rx * std::sin(down) * std::cos(around),
                at.y + at.scale * ry * std::sin(down) * std::sin(around),
                at.z + at.scale * rz * std::cos(down), static_cast<double>(column) / columns,
                1.0 - static_cast<double>(row) / rows);
        }
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 1; column <= columns; ++column) {
            const int a = row * (columns + 1) + column;
            const int b = a + columns + 1;
            text += fmt::format("f {0}/{0} {1}/{1} {2}/{2} {3}/{3}\n", a, b, b + 1, a + 1);
        }
    }
    return text;
}

/// Squares side by side over that of Workplace: left and right half, at these heights.
std::string halves(double left, double right) {
    return fmt::format(
        "v -1 -1 {0}\nv 0 -1 {0}\nv 0 1 {0}\nv -1 1 {0}\nf 1 2 3 4\n"
        "v 0 -1 {1}\nv 1 -1 {1}\nv 1 1 {1}\nv 0 1 {1}\nf 5 6 7 8\n",
        left, right);
}

class BakeFit : public testing::Test {
  protected:
    void write_spheres(const Placement& high) const {
        workplace.write("low.obj", ellipsoid(16, 1, 1, 1));
        workplace.write("high.obj", ellipsoid(48, 1, 1, 1, high));
    }
    [[nodiscard]] ProgramResult bake(const std::string& options = "") const {
        return workplace.run("relief-bake mesh high.obj low.obj out/map.png --size 32 --quiet " +
                             options);
    }
    /// Runs it where out/ holds old files, and requires that they stay as they are.
    void expect_nothing_written(const std::string& options, const std::string& error) const {
        workplace.write("out/map.png", "old");
        workplace.write("out/height.png", "old");
        workplace.write("out/report.json", "old");
        const ProgramResult result =
            bake("--height-map out/height.png --report out/report.json " + options);
        EXPECT_EQ(result.exit_code, 1) << options;
        EXPECT_THAT(result.error, HasSubstr(error)) << options;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(workplace.outputs(), "height.png map.png report.json");
        for (const char* file : {"out/map.png", "out/height.png", "out/report.json"})
            EXPECT_EQ(workplace.read(file), "old") << file;
    }

    const Workplace workplace;
};

TEST_F(BakeFit, AHighModelFarAwayIsAnErrorThatNamesBothBoxes) {
    write_spheres({.x = 100});
    expect_nothing_written("",
                           "relief-bake: error: high.obj: lies 98 away from low.obj, but rays "
                           "reach only 1.732: the box of high.obj is (99, -1, -1) to (101, 1, "
                           "1), diagonal 3.464; that of low.obj is (-1, -1, -1) to (1, 1, 1), "
                           "diagonal 3.464; the high model is moved by (100, 0, 0), and as "
                           "large as the low one: was one of them exported without its "
                           "transform?");
}

TEST_F(BakeFit, AHighModelBesideTheLowOneMissesTooMuch) {
    write_spheres({.x = 3});
    const std::string error = "% of --max-missed; the box of high.obj is (2, -1, -1) to (4, 1, 1)";
    expect_nothing_written("", error);
    expect_nothing_written("--compare", error);
    expect_nothing_written("--max-error 5", error);
    expect_nothing_written("--max-missed 80 --preview out/preview.png",
                           "more than the 80 % of --max-missed");
    // A large map is baked in small first.
    const ProgramResult large =
        workplace.run("relief-bake mesh high.obj low.obj out/map.png --quiet");
    EXPECT_THAT(large.error, HasSubstr("texels of a map of 256 x 256 ("));
    EXPECT_EQ(bake("--max-missed 100").exit_code, 0);
}

TEST_F(BakeFit, OtherUnitsAreAnErrorUnlessAllowed) {
    for (const auto& [scale, words] : {std::pair(100.0, "is 100 times as large as low.obj"),
                                       {0.0254, "is 39.37 times as small as low.obj"}}) {
        write_spheres({.scale = scale});
        expect_nothing_written("", words);
    }
    EXPECT_THAT(bake().error, AllOf(HasSubstr("is the high model in meters and the low one in "
                                              "inches?"),
                                    HasSubstr("--allow-size-mismatch")));
    write_spheres({.scale = 100});
    EXPECT_THAT(bake().error,
                HasSubstr("is the high model in centimeters and the low one in meters?"));
    EXPECT_EQ(bake("--allow-size-mismatch").error, "");
    // A factor of 10 is no error yet.
    write_spheres({.scale = 9.9});
    EXPECT_EQ(bake().exit_code, 0);
}

TEST_F(BakeFit, TurnedAxesAreAFindingAndACause) {
    workplace.write("low.obj", ellipsoid(16, 0.3, 1, 0.3));
    workplace.write("high.obj", ellipsoid(48, 0.3, 0.3, 1));
    const ProgramResult result = bake("--report out/report.json --max-missed 100");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(workplace.read("out/report.json"),
                HasSubstr("high box that fits only with y and z swapped"));
    EXPECT_EQ(bake("--strict --max-missed 100").exit_code, 3);
    EXPECT_THAT(bake("--max-missed 0").error, HasSubstr("is one of them Y up and the other Z up?"));
}

TEST_F(BakeFit, PlanesApartAreBakedOnlyWithRaysThatAreToldToReach) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", halves(10, 10));
    expect_nothing_written("", "lies 10 away from low.obj, but rays reach only 1.414");
    expect_nothing_written("--offset 5 --max-distance 6", "but rays reach only 6");
    EXPECT_EQ(bake("--offset 10.5").error, "");
    workplace.write("high.obj", halves(0.1, 0.1));
    expect_nothing_written("--offset 0 --max-distance 0", "lies 0.1 away from low.obj");
    EXPECT_EQ(bake().exit_code, 0);
}

TEST_F(BakeFit, ACageThatDoesNotReachIsAnError) {
    workplace.write_square("low.obj");
    workplace.write_square("cage.obj");
    workplace.write("high.obj", halves(0.1, 0.1));
    expect_nothing_written("--cage cage.obj", "or move the cage outwards");
}

TEST_F(BakeFit, ATransformOfTheLowModelCounts) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", halves(0.1, 0.1));
    ASSERT_EQ(workplace.run("relief-mesh process low.obj out/low.gltf").exit_code, 0);
    json document = json::parse(workplace.read("out/low.gltf"));
    document["nodes"][0]["translation"] = {0, 50, 0};
    workplace.write("out/low.gltf", document.dump());
    const ProgramResult result =
        workplace.run("relief-bake mesh high.obj out/low.gltf out/map.png --size 8 --quiet");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("the high model is moved by (0, -50, 0.1)"));
}

TEST_F(BakeFit, NothingToHitIsAnError) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    workplace.write("out/map.png", "old");
    EXPECT_EQ(bake().error,
              "relief-bake: error: high.obj: has no triangle whose corners are finite "
              "(nothing can be baked from it)\n");
    workplace.write("high.obj", "v 1 0 0\nv 0 1 0\n");
    EXPECT_EQ(bake().error, "relief-bake: error: high.obj: has no triangle\n");
    // Beside the low square, within the length of rays.
    workplace.write("high.obj", "v 1.5 0 0\nv 2.5 0 0\nv 1.5 1 0\nf 1 2 3\n");
    EXPECT_THAT(bake("--max-missed 100").error,
                HasSubstr("low.obj: no ray hits high.obj: all 1024 texels are missed; "));
    EXPECT_EQ(workplace.read("out/map.png"), "old");
}

TEST_F(BakeFit, FacesThatPointInwardsAreNamed) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", "v -1 -1 0.1\nv 1 -1 0.1\nv 1 1 0.1\nv -1 1 0.1\nf 4 3 2 1\n");
    EXPECT_THAT(bake().error,
                HasSubstr("1024 of them see high.obj only from behind (turn its faces round, or "
                          "give --back-faces take)"));
    EXPECT_EQ(bake("--back-faces take").error, "");
}

TEST_F(BakeFit, MissedTexelsHavePlacesAndTheLengthThatHits) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", halves(0.1, 0.375));
    const std::string line =
        "relief-bake mesh high.obj low.obj out/map.png --size 8 --offset 0.25 --max-distance 0 "
        "--report out/report.json ";
    const ProgramResult result = workplace.run(line);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("missed    32 texels, 50 % of those covered: (4, 0) at "
                                      "(0.125, 0.875, 0); (5, 0) at (0.375, 0.875, 0); "));
    EXPECT_THAT(result.out, HasSubstr("          32 of them would be hit with --offset 0.3754\n"));
    const json report = json::parse(workplace.read("out/report.json"));
    const json& missed = report["maps"][0]["missed"];
    EXPECT_EQ(missed["percent"], 50.0);
    EXPECT_EQ(missed["first"][0]["x"], 4);
    EXPECT_EQ(missed["first"][0]["position"], json({0.125, 0.875, 0.0}));
    EXPECT_EQ(missed["clipped_outside"]["texels"], 32);
    EXPECT_NEAR(missed["clipped_outside"]["longest"].get<double>(), 0.375, 1e-6);
    EXPECT_EQ(missed["clipped_inside"]["texels"], 0);
    EXPECT_EQ(missed["measuring_rays"], 64);
    EXPECT_EQ(report["boxes"]["high"]["max"], json({1.0, 1.0, 0.375}));
    EXPECT_EQ(report["texels_missed"], 32);
    // The length is enough.
    const ProgramResult longer = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 8 --offset 0.3754 --max-distance 0 "
        "--strict");
    EXPECT_EQ(longer.exit_code, 0) << longer.error << longer.out;
}

TEST_F(BakeFit, StrictFailsMissedTexelsUnlessALimitIsGiven) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", halves(0.1, 0.375));
    const std::string rays = "--offset 0.25 --max-distance 0 ";
    EXPECT_EQ(bake(rays).exit_code, 0);
    EXPECT_EQ(bake(rays + "--strict").exit_code, 3);
    EXPECT_EQ(bake(rays + "--strict --max-missed 50").exit_code, 0);
    expect_nothing_written(rays + "--strict --max-missed 49.9",
                           "512 of 1024 texels (50 %) are missed by their rays, more than the "
                           "49.9 % of --max-missed");
}

TEST_F(BakeFit, StrictPassesMirroredIslandsAndFailsOverlaps) {
    // Two squares with the same texture; that of the second is mirrored, or not.
    const std::string corners =
        "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    workplace.write("high.obj", halves(0.1, 0.1));
    workplace.write("low.obj", corners + "f 5/2 6/1 7/4 8/3\n");
    const ProgramResult mirrored = bake("--strict --report out/report.json");
    EXPECT_EQ(mirrored.exit_code, 0) << mirrored.error;
    EXPECT_THAT(workplace.read("out/report.json"), HasSubstr("texel of mirrored triangles"));
    workplace.write("low.obj", corners + "f 5/1 6/2 7/3 8/4\n");
    EXPECT_EQ(bake("--strict").exit_code, 3);
}

TEST_F(BakeFit, StrictPassesNormalsBehindTheSurfaceWithinAnErrorLimit) {
    workplace.write_square("low.obj");
    // A steep fold whose normals point below the low square.
    workplace.write("high.obj",
                    "v -1 -1 0.1\nv 1 -1 0.1\nv 1 1 0.1\nv -1 1 0.1\nvn 0.8 0 -0.6\n"
                    "f 1//1 2//1 3//1 4//1\n");
    EXPECT_EQ(bake("--strict").exit_code, 3);
    const ProgramResult limited = bake("--strict --max-error 1");
    EXPECT_EQ(limited.exit_code, 0) << limited.error;
}

TEST_F(BakeFit, OfSeveralMapsNoneIsWrittenIfOneMissesTooMuch) {
    // Two squares in a row, a material each; only the first has something above it.
    workplace.write("low.obj",
                    "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 0\n"
                    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl A\nf 1/1 2/2 3/3 4/4\n"
                    "usemtl B\nf 5/1 6/2 7/3 8/4\n");
    workplace.write("high.obj", "v -1 -1 0.1\nv 0.1 -1 0.1\nv 0.1 1 0.1\nv -1 1 0.1\nf 1 2 3 4\n");
    const std::string line =
        "relief-bake mesh high.obj low.obj 'out/<material>.png' --size 16 --quiet "
        "--height-map 'out/<material>-height.exr' ";
    const ProgramResult result = workplace.run(line);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("low.obj: material 'B': "));
    EXPECT_EQ(workplace.outputs(), "");
    EXPECT_EQ(workplace.run(line + "--max-missed 95").exit_code, 0);
    EXPECT_EQ(workplace.outputs(), "A-height.exr A.png B-height.exr B.png");
}

TEST_F(BakeFit, APartThatIsAwayFromItsCounterpartIsNamed) {
    workplace.write("low.obj",
                    "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 0\n"
                    "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\n"
                    "o lid_low\nf 1/1 2/2 3/3 4/4\no rim_low\nf 5/2 6/5 7/6 8/3\n");
    workplace.write("high.obj",
                    "o lid_high\nv -1 -1 0.1\nv 0 -1 0.1\nv 0 1 0.1\nv -1 1 0.1\nf 1 2 3 4\n"
                    "o rim_high\nv 0 -1 7\nv 1 -1 7\nv 1 1 7\nv 0 1 7\nf 5 6 7 8\n");
    EXPECT_THAT(bake().error, HasSubstr("high.obj: part 'rim': lies 7 away from low.obj"));
}

TEST_F(BakeFit, ACheckOfAMapSaysTheSame) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", halves(0.1, 0.1));
    ASSERT_EQ(bake("--offset 0.25 --max-distance 0").exit_code, 0);
    const std::string line = "relief-bake check out/map.png --high high.obj --low low.obj ";
    EXPECT_EQ(workplace.run(line + "--strict --quiet").exit_code, 0);
    workplace.write("high.obj", halves(0.1, 0.375));
    EXPECT_THAT(workplace.run(line).out, Not(HasSubstr("missed by their rays, more than")));
    const ProgramResult missed = workplace.run(line + "--max-missed 40 --strict");
    EXPECT_EQ(missed.exit_code, 3);
    EXPECT_THAT(missed.out, HasSubstr("50 % of the texels are missed by their rays, more than 40; "
                                      "the box of high.obj is "));
    workplace.write("high.obj", halves(70, 70));
    const ProgramResult apart = workplace.run(line);
    EXPECT_EQ(apart.exit_code, 1);
    EXPECT_THAT(apart.error, HasSubstr("high.obj: lies 70 away from low.obj"));
    const ProgramResult useless = workplace.run("relief-bake check out/map.png --max-missed 4");
    EXPECT_EQ(useless.exit_code, 2);
    EXPECT_THAT(useless.error, HasSubstr("--max-missed: has no effect without --high"));
}

TEST_F(BakeFit, SwappedModelsAreAWarning) {
    workplace.write("low.obj", ellipsoid(48, 1, 1, 1));
    workplace.write("high.obj", ellipsoid(16, 1, 1, 1));
    const ProgramResult result = bake();
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.error, HasSubstr("relief-bake: warning: low.obj: has 2304 triangles, more "
                                        "than four times as many as the high model, 256"));
}

}  // namespace
}  // namespace relief::tools
