// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake mesh with models that do not fit, and with parts that are paired by name.
#include "mesh_bake.h"
#include "relief/mesh/bake_check.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Placement {
    double scale = 1.0;
    double x = 0.0, y = 0.0, z = 0.0;
};

/// An ellipsoid with texture coordinates, with half as many rows as columns.
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

/// The left and the right half of the square of Workplace, at these heights.
std::string halves(double left, double right) {
    return fmt::format(
        "v -1 -1 {0}\nv 0 -1 {0}\nv 0 1 {0}\nv -1 1 {0}\nf 1 2 3 4\nv 0 -1 {1}\nv 1 -1 {1}\nv 1 1 "
        "{1}\nv 0 1 {1}\nf 5 6 7 8\n",
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
    /// Runs the bake while out/ holds old files, and requires that they are unchanged.
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
    expect_nothing_written(
        "",
        "relief-bake: error: high.obj: is 98 away from low.obj, but rays are only 1.732 long: the "
        "bounding box of high.obj is (99, -1, -1) to (101, 1, 1), diagonal 3.464; that of low.obj "
        "is (-1, -1, -1) to (1, 1, 1), diagonal 3.464; the high model is moved by (100, 0, 0), and "
        "has the size of the low one: was one of them exported without its transform?");
}

TEST_F(BakeFit, ShiftedHighModelMissesTooMuch) {
    write_spheres({.x = 3});
    const std::string error =
        "% of --max-missed; the bounding box of high.obj is (2, -1, -1) to (4, 1, 1)";
    expect_nothing_written("", error);
    expect_nothing_written("--compare", error);
    expect_nothing_written("--max-error 5", error);
    expect_nothing_written("--max-missed 80 --preview out/preview.png",
                           "more than the 80 % of --max-missed");
    // A large map is first baked at a reduced size.
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
    EXPECT_THAT(bake().error,
                AllOf(HasSubstr("is the high model in meters and the low one in inches?"),
                      HasSubstr("--allow-size-mismatch")));
    write_spheres({.scale = 100});
    EXPECT_THAT(bake().error,
                HasSubstr("is the high model in centimeters and the low one in meters?"));
    EXPECT_EQ(bake("--allow-size-mismatch").error, "");
    // A factor of up to 10 is accepted.
    write_spheres({.scale = 9.9});
    EXPECT_EQ(bake().exit_code, 0);
}

/// A bent tube, whose normals differ if it is scaled or moved.
std::string bent_tube(int columns, const Placement& at = {}) {
    std::string text;
    const int rows = columns / 2;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const double along = 2.0 * std::numbers::pi * column / columns;
            const double around = 2.0 * std::numbers::pi * row / rows;
            const double ring = 1.0 + 0.3 * std::cos(around);
            text += fmt::format(
                "v {} {} {}\nvt {} {}\n", at.x + at.scale * ring * std::cos(along),
                at.y + at.scale * ring * std::sin(along), at.z + at.scale * 0.3 * std::sin(around),
                static_cast<double>(column) / columns, 1.0 - static_cast<double>(row) / rows);
        }
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 1; column <= columns; ++column) {
            const int a = row * (columns + 1) + column;
            const int b = a + columns + 1;
            text += fmt::format("f {0}/{0} {3}/{3} {2}/{2} {1}/{1}\n", a, b, b + 1, a + 1);
        }
    }
    return text;
}

TEST_F(BakeFit, AScaleOrAShiftWithinTheBoxesIsAFinding) {
    workplace.write("low.obj", bent_tube(24));
    workplace.write("high.obj", bent_tube(48));
    const std::string strict = "--strict --max-missed 100 ";
    EXPECT_EQ(bake(strict).exit_code, 0);
    for (const auto& [high, text] :
         {std::pair(Placement{.scale = 2.54}, "high model of another size (model 0): is about 2.5"),
          {{.scale = 3.28}, "is the high model in feet and the low one in meters?"},
          {{.x = 0.3}, "high model at another position (model 0): is moved by (0.3, "}}) {
        workplace.write("high.obj", bent_tube(48, high));
        const ProgramResult result = workplace.run(
            "relief-bake mesh high.obj low.obj out/map.png --size 32 --max-missed 100 --report "
            "out/report.json");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        EXPECT_THAT(result.out, HasSubstr(text));
        EXPECT_EQ(bake(strict).exit_code, 3);
        const json report = json::parse(workplace.read("out/report.json"));
        EXPECT_NEAR(report["agreement"]["correction"]["scale"].get<double>(), high.scale, 0.1);
    }
    workplace.write("high.obj", bent_tube(48, {.scale = 2.54}));
    EXPECT_THAT(workplace
                    .run("relief-bake mesh high.obj low.obj out/map.png --size 32 --max-missed 100 "
                         "--allow-size-mismatch")
                    .out,
                Not(HasSubstr("high model of another size")));
}

TEST_F(BakeFit, AMapWithoutACoveredTexelIsAnError) {
    const std::string corners = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
    workplace.write_square("high.obj");
    workplace.write("low.obj", corners + "vt 2 0\nvt 3 0\nvt 3 1\nvt 2 1\nf 1/1 2/2 3/3 4/4\n");
    expect_nothing_written("",
                           "low.obj: covers no texel of the map: its texture coordinates are (2, "
                           "0) to (3, 1), outside of the unit square (give --outside repeat, or "
                           "<UDIM> in the map's name; nothing is written)");
    expect_nothing_written("--max-missed 100", "covers no texel of the map");
    EXPECT_EQ(bake("--outside repeat").exit_code, 0);
    workplace.write("low.obj", corners + "vt 0.5 0.5\nf 1/1 2/1 3/1 4/1\n");
    expect_nothing_written("", "to (0.5, 0.5), without any area (unwrap it");
    // One of two materials covers texels.
    workplace.write("low.obj", corners +
                                   "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl A\nf 1/1 2/2 3/3\n"
                                   "usemtl B\nf 1/1 3/1 4/1\n");
    workplace.write("out/report.json", "");
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj 'out/<material>.png' --size 16 --report "
        "out/report.json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 x map without a covered texel"));
}

TEST_F(BakeFit, RotatedAxesAreAFindingAndACause) {
    workplace.write("low.obj", ellipsoid(16, 0.3, 1, 0.3));
    workplace.write("high.obj", ellipsoid(48, 0.3, 0.3, 1));
    const ProgramResult result = bake("--report out/report.json --max-missed 100");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(workplace.read("out/report.json"),
                HasSubstr("high box that fits only with y and z swapped"));
    EXPECT_EQ(bake("--strict --max-missed 100").exit_code, 3);
    EXPECT_THAT(bake("--max-missed 0").error, HasSubstr("is one of them Y up and the other Z up?"));
}

TEST_F(BakeFit, DistantPlanesAreBakedOnlyWithLongRays) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", halves(10, 10));
    expect_nothing_written("", "is 10 away from low.obj, but rays are only 1.414 long");
    expect_nothing_written("--offset 5 --max-distance 6", "but rays are only 6 long");
    EXPECT_EQ(bake("--offset 10.5").error, "");
    workplace.write("high.obj", halves(0.1, 0.1));
    expect_nothing_written("--offset 0 --max-distance 0", "is 0.1 away from low.obj");
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

TEST_F(BakeFit, MissingSurfacesAreAnError) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    workplace.write("out/map.png", "old");
    EXPECT_EQ(bake().error,
              "relief-bake: error: high.obj: has no triangle with finite corners (nothing can be "
              "baked from it)\n");
    workplace.write("high.obj", "v 1 0 0\nv 0 1 0\n");
    EXPECT_EQ(bake().error, "relief-bake: error: high.obj: has no triangle\n");
    // The high model is beside the low square, but within the length of rays.
    workplace.write("high.obj", "v 1.5 0 0\nv 2.5 0 0\nv 1.5 1 0\nf 1 2 3\n");
    EXPECT_THAT(bake("--max-missed 100").error,
                HasSubstr("low.obj: no ray hits high.obj: all 1024 texels are missed; "));
    EXPECT_EQ(workplace.read("out/map.png"), "old");
}

TEST_F(BakeFit, FacesThatPointInwardsAreReported) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", "v -1 -1 0.1\nv 1 -1 0.1\nv 1 1 0.1\nv -1 1 0.1\nf 4 3 2 1\n");
    EXPECT_THAT(bake().error, HasSubstr("1024 of them see only back faces of high.obj (flip its "
                                        "faces, or give --back-faces take)"));
    EXPECT_EQ(bake("--back-faces take").error, "");
}

TEST_F(BakeFit, MissedTexelsHavePositionsAndASufficientLength) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", halves(0.1, 0.375));
    const std::string line =
        "relief-bake mesh high.obj low.obj out/map.png --size 8 --offset 0.25 --max-distance 0 "
        "--report out/report.json ";
    const ProgramResult result = workplace.run(line);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr("missed    32 texels, 50 % of those covered: column 4, row 0 at "
                          "(0.125, 0.875, 0); column 5, row 0 at (0.375, 0.875, 0); "));
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
    // The reported length is sufficient.
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
    expect_nothing_written(
        rays + "--strict --max-missed 49.9",
        "512 of 1024 texels (50 %) hit nothing, more than the 49.9 % of --max-missed");
}

TEST_F(BakeFit, StrictPassesMirroredIslandsAndFailsOverlaps) {
    // Two squares with the same texture coordinates; those of the second are mirrored, or not.
    const std::string corners =
        "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt "
        "1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
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
    workplace.write(
        "high.obj",
        "v -1 -1 0.1\nv 1 -1 0.1\nv 1 1 0.1\nv -1 1 0.1\nvn 0.8 0 -0.6\nf 1//1 2//1 3//1 4//1\n");
    EXPECT_EQ(bake("--strict").exit_code, 3);
    const ProgramResult limited = bake("--strict --max-error 1");
    EXPECT_EQ(limited.exit_code, 0) << limited.error;
}

TEST_F(BakeFit, NoMapIsWrittenIfOneMissesTooMuch) {
    // Two squares in a row with separate materials; only the first has a high surface above it.
    workplace.write(
        "low.obj",
        "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt "
        "1 0\nvt 1 1\nvt 0 1\nusemtl A\nf 1/1 2/2 3/3 4/4\nusemtl B\nf 5/1 6/2 7/3 8/4\n");
    workplace.write("high.obj", "v -1 -1 0.1\nv 0.1 -1 0.1\nv 0.1 1 0.1\nv -1 1 0.1\nf 1 2 3 4\n");
    const std::string line =
        "relief-bake mesh high.obj low.obj 'out/<material>.png' --size 16 --quiet --height-map "
        "'out/<material>-height.exr' ";
    const ProgramResult result = workplace.run(line);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("low.obj: material 'B': "));
    EXPECT_EQ(workplace.outputs(), "");
    EXPECT_EQ(workplace.run(line + "--max-missed 95").exit_code, 0);
    EXPECT_EQ(workplace.outputs(), "A-height.exr A.png B-height.exr B.png");
}

TEST_F(BakeFit, ADistantPartIsReported) {
    workplace.write("low.obj",
                    "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 "
                    "0\nvt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\no lid_low\nf 1/1 2/2 "
                    "3/3 4/4\no rim_low\nf 5/2 6/5 7/6 8/3\n");
    workplace.write("high.obj",
                    "o lid_high\nv -1 -1 0.1\nv 0 -1 0.1\nv 0 1 0.1\nv -1 1 0.1\nf 1 2 3 4\no "
                    "rim_high\nv 0 -1 7\nv 1 -1 7\nv 1 1 7\nv 0 1 7\nf 5 6 7 8\n");
    EXPECT_THAT(bake().error, HasSubstr("high.obj: part 'rim': is 7 away from low.obj"));
}

TEST_F(BakeFit, ACheckOfAMapReportsTheSame) {
    workplace.write_square("low.obj");
    workplace.write("high.obj", halves(0.1, 0.1));
    ASSERT_EQ(bake("--offset 0.25 --max-distance 0").exit_code, 0);
    const std::string line = "relief-bake check out/map.png --high high.obj --low low.obj ";
    EXPECT_EQ(workplace.run(line + "--strict --quiet").exit_code, 0);
    workplace.write("high.obj", halves(0.1, 0.375));
    EXPECT_THAT(workplace.run(line).out, Not(HasSubstr("hit nothing, more than")));
    const ProgramResult missed = workplace.run(line + "--max-missed 40 --strict");
    EXPECT_EQ(missed.exit_code, 3);
    EXPECT_THAT(missed.out, HasSubstr("the rays of 50 % of the texels hit nothing, more than 40 %; "
                                      "the bounding box of high.obj is "));
    workplace.write("high.obj", halves(70, 70));
    const ProgramResult apart = workplace.run(line);
    EXPECT_EQ(apart.exit_code, 1);
    EXPECT_THAT(apart.error, HasSubstr("high.obj: is 70 away from low.obj"));
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

TEST(ModelPairs, NamesAreTheTextBeforeTheWord) {
    const auto low = [](const char* name) { return pair_name(name, BakeSide::low).value_or("-"); };
    EXPECT_EQ(low("Bolt_low"), "bolt");
    EXPECT_EQ(low("bolt.LOW"), "bolt");
    EXPECT_EQ(low("big bolt-low.001"), "big bolt");
    EXPECT_EQ(low("a low b_low_c"), "a low b");
    EXPECT_EQ(low("below"), "-");
    EXPECT_EQ(low("bolt_lower"), "-");
    EXPECT_EQ(low("bolt_high"), "-");
    EXPECT_EQ(low("_low"), "-");
    EXPECT_EQ(low("low"), "-");
    EXPECT_EQ(low(""), "-");
    EXPECT_EQ(pair_name("bolt_high_cap", BakeSide::high), "bolt");
}

/// A model of one mesh, in which each triangle is an object.
MapModel model(const std::vector<std::string>& objects) {
    MapModel result;
    MapModelPart part;
    part.objects = objects;
    part.mesh = make_quad();
    part.mesh.triangles.clear();
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        part.mesh.triangles.emplace_back(0, 1, 2);
        part.object_of.push_back(i);
    }
    result.parts.push_back(std::move(part));
    return result;
}

TEST(ModelPairs, PartsAreNamedByTheirObjectsElseByTheirFiles) {
    const MapModel low = model({"a_low", "b_low", "A_LOW"});
    const MapModel a = model({"one", "two"}), b = model({"x", "b_high"});
    const std::vector<NamedModel> high = {{"dir/a_high.obj", &a}, {"a-high-2.obj", &b}};
    const ModelPairs pairs = pair_models(high, {"low.obj", &low}, PartMatching::automatic);
    ASSERT_EQ(pairs.pairs.size(), 2U);
    EXPECT_EQ(pairs.pairs[0].name, "a");
    EXPECT_THAT(pairs.pairs[0].low, ElementsAre(0, 2));
    ASSERT_EQ(pairs.pairs[0].high.size(), 3U);
    EXPECT_EQ(pairs.pairs[0].high[2].model, 1U);
    EXPECT_THAT(pairs.pairs[0].high[2].triangles, ElementsAre(0));
    EXPECT_EQ(pairs.pairs[1].name, "b");
    EXPECT_THAT(pairs.pairs[1].low, ElementsAre(1));
    EXPECT_TRUE(pair_models(high, {"low.obj", &low}, PartMatching::all).pairs.empty());
}

TEST(ModelPairs, PartsWithoutACounterpartAreSeenByAllRefusedOrCounted) {
    const MapModel low = model({"a_low", "b_low", "c"}), full = model({"a_low", "b_low"});
    const MapModel high = model({"a_high", "b_high", "floor"}), some = model({"a_high"});
    const std::vector<NamedModel> all = {{"h.obj", &high}}, one = {{"h.obj", &some}};
    const ModelPairs automatic = pair_models(all, {"l.obj", &full}, PartMatching::automatic);
    EXPECT_THAT(automatic.pairs, IsEmpty());
    EXPECT_THAT(automatic.unpaired, ElementsAre("parts without a name"));
    EXPECT_THAT(pair_models(one, {"l.obj", &full}, PartMatching::automatic).unpaired,
                ElementsAre("b"));
    const ModelPairs named = pair_models(all, {"l.obj", &full}, PartMatching::name);
    EXPECT_EQ(named.pairs.size(), 2U);
    EXPECT_EQ(named.report.count("high part without a low one"), 1U);
    EXPECT_EQ(test::message_of<FileError>([&] {
                  pair_models(all, {"l.obj", &low}, PartMatching::name);
              }),
              "l.obj: 1 of its parts has no high part of the same name: c (name them X_low and "
              "X_high, or use --match all)");
    EXPECT_EQ(test::message_of<FileError>([&] {
                  pair_models(one, {"l.obj", &low}, PartMatching::name);
              }),
              "l.obj: 2 of its parts have no high part of the same name: c, b_low (name them X_low "
              "and X_high, or use --match all)");
}

TEST(ModelPairs, EqualNamesOfObjectsAreMatchedWithoutAConvention) {
    const MapModel low = model({"Lid", "Base"}), one = model({"Lid"}), named = model({"lid_low"});
    const MapModel high = model({"lid", "BASE", "base"}), more = model({"lid", "base", "floor"});
    const std::vector<NamedModel> two = {{"h_high.obj", &high}}, three = {{"h.obj", &more}};
    const ModelPairs pairs = pair_models(two, {"l_low.obj", &low}, PartMatching::automatic);
    ASSERT_EQ(pairs.pairs.size(), 2U);
    EXPECT_EQ(pairs.pairs[0].name, "base");
    EXPECT_THAT(pairs.pairs[0].low, ElementsAre(1));
    EXPECT_EQ(pairs.pairs[0].high.size(), 2U);
    EXPECT_THAT(pairs.pairs[1].low, ElementsAre(0));
    EXPECT_EQ(pair_models(two, {"l.obj", &low}, PartMatching::name).pairs.size(), 2U);
    // A part without a counterpart, a single part, and a name of the convention.
    EXPECT_THAT(pair_models(three, {"l.obj", &low}, PartMatching::automatic).pairs, IsEmpty());
    EXPECT_THAT(pair_models(two, {"l.obj", &one}, PartMatching::automatic).pairs, IsEmpty());
    EXPECT_THAT(pair_models(two, {"l.obj", &named}, PartMatching::automatic).pairs, IsEmpty());
}

/// Two squares of side 2 side by side, each with half of the map, and a high square 0.05 above
/// each. The right high square also covers the left one, 0.02 above it.
class PairedBake : public testing::Test {
  protected:
    PairedBake() {
        place_.write("low.obj",
                     "o left_low\nv -2 -1 0\nv 0 -1 0\nv 0 1 0\nv -2 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 "
                     "1\nvt 0 1\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3 4/4\no right_low\nv 0 -1 0\nv 2 -1 "
                     "0\nv 2 1 0\nv 0 1 0\nf 5/2 6/5 7/6 8/3\n");
        place_.write("high.obj", high("left_high", "right_high"));
    }

    static std::string high(const std::string& left, const std::string& right) {
        return fmt::format(
            "o {}\nv -2 -1 0.05\nv 0 -1 0.05\nv 0 1 0.05\nv -2 1 0.05\nvn 0.6 0 0.8\nvn 0 0.6 "
            "0.8\nf 1//1 2//1 3//1 4//1\no {}\nv -2 -1 0.07\nv 2 -1 0.07\nv 2 1 0.07\nv -2 1 "
            "0.07\nf 5//2 6//2 7//2 8//2\n",
            left, right);
    }

    [[nodiscard]] ProgramResult bake(const std::string& more) const {
        return place_.run("relief-bake mesh high.obj low.obj out/n.png --size 8x4 " + more);
    }

    /// Decodes the red channel of a texel.
    [[nodiscard]] double x_of(std::size_t texel) const {
        const Image map = read_image(place_ / "out/n.png", ImageUse::data);
        return (map.as<std::uint16_t>()[3 * texel] - 32768.0) / 32767.0;
    }

    const Workplace place_;
};

TEST_F(PairedBake, NeighborsDoNotReceiveEachOthersRays) {
    const ProgramResult all = bake("--match all");
    EXPECT_EQ(all.error, "");
    EXPECT_NEAR(x_of(0), 0.0, 1e-4);
    const ProgramResult result = bake("--report out/report.json");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr("          2 parts matched by name: left, right\n"));
    EXPECT_NEAR(x_of(0), 0.6, 1e-4);
    EXPECT_NEAR(x_of(7), 0.0, 1e-4);
    const json report = json::parse(place_.read("out/report.json"));
    EXPECT_EQ(report["pairs"],
              json::parse(R"([{"name": "left", "high_triangles": 2, "low_triangles": 2},
                              {"name": "right", "high_triangles": 2, "low_triangles": 2}])"));
}

TEST_F(PairedBake, GltfNodesAreMatchedLikeObjects) {
    for (const char* name : {"left", "right"}) {
        const bool is_left = std::string(name) == "left";
        place_.write(std::string(name) + "_high.obj",
                     is_left ? "v -2 -1 0.05\nv 0 -1 0.05\nv 0 1 0.05\nv -2 1 0.05\nvn 0.6 0 "
                               "0.8\nf 1//1 2//1 3//1 4//1\n"
                             : "v -2 -1 0.07\nv 2 -1 0.07\nv 2 1 0.07\nv -2 1 0.07\nvn 0 0.6 "
                               "0.8\nf 1//1 2//1 3//1 4//1\n");
    }
    EXPECT_EQ(place_
                  .run("relief-bake mesh left_high.obj right_high.obj low.obj out/n.png --size 8x4 "
                       "--match name --quiet")
                  .error,
              "");
    EXPECT_NEAR(x_of(0), 0.6, 1e-4);
    // Each mesh has a node with its name.
    ASSERT_EQ(place_.run("relief-mesh process high.obj out/high.gltf").exit_code, 0);
    json document = json::parse(place_.read("out/high.gltf"));
    document["nodes"][0]["name"] = "left_high";
    place_.write("out/high.gltf", document.dump());
    const ProgramResult result =
        place_.run("relief-bake mesh out/high.gltf low.obj out/n.png --size 8x4");
    EXPECT_THAT(result.out, HasSubstr("          not matched by name: no counterpart for right\n"));
    EXPECT_EQ(place_.run("relief-bake mesh out/high.gltf low.obj out/n.png --size 8x4 --match name")
                  .error,
              "relief-bake: error: low.obj: 1 of its parts has no high part of the same name: "
              "right_low (name them X_low and X_high, or use --match all)\n");
}

TEST_F(PairedBake, WithoutACounterpartAllPartsSeeEachOther) {
    place_.write("high.obj", high("left_high", "floor"));
    EXPECT_THAT(
        bake("").out,
        HasSubstr(
            "          not matched by name: no counterpart for parts without a name, right\n"));
    EXPECT_NEAR(x_of(0), 0.0, 1e-4);
}

}  // namespace
}  // namespace relief::tools
