// SPDX-License-Identifier: Apache-2.0
// The command `relief-mesh compare`: files of all formats, output and exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

json compared(const Workplace& workplace, const std::string& files_and_options) {
    const ProgramResult result = workplace.run("relief-mesh compare --json " + files_and_options);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return json::parse(result.out);
}

/// Writes the square of write_square() with another order of triangles and corners, and another
/// normal at one corner.
void write_other_square(const Workplace& workplace) {
    workplace.write("other.obj",
                    "v 1 1 0\nv -1 1 0\nv -1 -1 0\nv 1 -1 0\n"
                    "vt 1 1\nvt 0 1\nvt 0 0\nvt 1 0\n"
                    "vn 0 0 1\nvn 0 0.5 0.8660254037844386\n"
                    "f 2/2/1 3/3/1 1/1/1\nf 4/4/2 1/1/1 3/3/1\n");
}

TEST(CompareCommand, FormatsOrderAndSplitsDoNotMatter) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj out/vase.glb --tangents mikktspace")
                  .exit_code,
              0);
    ASSERT_EQ(workplace.run("relief-mesh process out/vase.glb out/vase.ply").exit_code, 0);
    for (const std::string pair :
         {"data/vase.obj out/vase.glb", "out/vase.glb data/vase.obj", "out/vase.glb out/vase.ply",
          "out/vase.ply data/vase.obj", "out/vase.glb out/vase.glb"}) {
        SCOPED_TRACE(pair);
        const json result = compared(workplace, pair);
        EXPECT_GT(result["triangles"]["equal"].get<int>(), 0);
        EXPECT_EQ(result["triangles"]["only_in_a"], 0);
        EXPECT_EQ(result["triangles"]["only_in_b"], 0);
        EXPECT_LT(result["normals"]["max"].get<double>(), 0.01);
        EXPECT_TRUE(result["by_texture_coordinate"].get<bool>());
    }
    const json same = compared(workplace, "out/vase.glb out/vase.glb --strict --max-angle 0.01");
    EXPECT_EQ(same["normals"]["corners"], 17280);
    EXPECT_TRUE(same["within"].get<bool>());
    EXPECT_TRUE(same["complete"].get<bool>());
}

TEST(CompareCommand, ReportsAttributesOfOneFileOnly) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj out/vase.glb --tangents mikktspace")
                  .exit_code,
              0);
    ASSERT_EQ(
        workplace.run("relief-mesh process out/vase.glb out/lost.glb --tangents none").exit_code,
        0);
    // The tangents are lost, and the normals are equal.
    EXPECT_EQ(
        workplace.run("relief-mesh compare out/vase.glb out/lost.glb --max-angle 0").exit_code, 0);
    const ProgramResult strict =
        workplace.run("relief-mesh compare out/vase.glb out/lost.glb --max-angle 0 --strict");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_THAT(strict.out, HasSubstr("tangents  only in A\n"));
    EXPECT_FALSE(compared(workplace, "out/lost.glb out/vase.glb")["complete"].get<bool>());

    const ProgramResult nothing =
        workplace.run("relief-mesh compare data/vase.obj out/vase.glb --max-angle 180 --quiet");
    EXPECT_EQ(nothing.exit_code, 1);
    EXPECT_THAT(nothing.error, HasSubstr("out/vase.glb: has neither normals nor tangents in common "
                                         "with data/vase.obj, so --max-angle cannot be checked"));
}

TEST(CompareCommand, LocatesDifferencesOfNormals) {
    const Workplace workplace;
    workplace.write_square("plain.obj");
    ASSERT_EQ(workplace.run("relief-mesh process plain.obj square.obj --normals flat").exit_code,
              0);
    write_other_square(workplace);
    const ProgramResult result = workplace.run("relief-mesh compare square.obj other.obj");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr("matched   2 triangles by position and texture coordinate\n"));
    EXPECT_THAT(result.out, Not(HasSubstr("unmatched")));
    EXPECT_THAT(result.out, HasSubstr("normals   6 corners: rms "));
    EXPECT_THAT(result.out,
                HasSubstr("maximum 30 degrees\n          5 up to 0.01, 1 up to 45 degrees\n"));
    EXPECT_THAT(result.out, HasSubstr("worst     normal: 30 degrees at (1, -1, 0), corner "));

    const json all = compared(workplace, "square.obj other.obj --ignore-uv");
    EXPECT_NEAR(all["normals"]["max"].get<double>(), 30.0, 1e-4);
    EXPECT_NEAR(all["normals"]["mean"].get<double>(), 5.0, 1e-4);
    EXPECT_FALSE(all["by_texture_coordinate"].get<bool>());
    EXPECT_EQ(all["worst_normals"].size(), 1U);
    EXPECT_EQ(all["worst_normals"][0]["position"], json({1, -1, 0}));
    EXPECT_EQ(all["primitives"].size(), 1U);
    EXPECT_EQ(all["within"], json());
}

TEST(CompareCommand, ExitsWithOneBeyondTheLargestAngle) {
    const Workplace workplace;
    workplace.write_square("plain.obj");
    ASSERT_EQ(workplace.run("relief-mesh process plain.obj square.obj --normals flat").exit_code,
              0);
    write_other_square(workplace);
    EXPECT_EQ(workplace.run("relief-mesh compare square.obj other.obj --max-angle 30.01").exit_code,
              0);
    const ProgramResult beyond =
        workplace.run("relief-mesh compare square.obj other.obj --max-angle 29.9 --quiet");
    EXPECT_EQ(beyond.exit_code, 1);
    EXPECT_EQ(beyond.out, "");
    EXPECT_EQ(beyond.error,
              "relief-mesh: error: other.obj: differs from square.obj by more than 29.9 degrees: "
              "normals by 30 degrees\n");
}

TEST(CompareCommand, SignsOfTangentsCount) {
    const Workplace workplace;
    workplace.write_square("plain.obj");
    workplace.write("mirrored.obj",
                    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\n"
                    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
    for (const std::string name : {"plain", "mirrored"}) {
        ASSERT_EQ(workplace
                      .run("relief-mesh process " + name + ".obj out/" + name +
                           ".glb --tangents mikktspace")
                      .exit_code,
                  0);
    }
    const json result = compared(workplace, "out/plain.glb out/mirrored.glb --ignore-uv");
    EXPECT_NEAR(result["tangents"]["max"].get<double>(), 180.0, 1e-4);
    EXPECT_EQ(result["sign_differences"], 6);
    const ProgramResult failed = workplace.run(
        "relief-mesh compare out/plain.glb out/mirrored.glb --ignore-uv --max-angle 180");
    EXPECT_EQ(failed.exit_code, 1) << "however large the angle, the sign differs";
    EXPECT_THAT(failed.error, HasSubstr("6 tangent signs"));
}

TEST(CompareCommand, CountsUnmatchedTriangles) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("less.obj",
                    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
    const ProgramResult strict = workplace.run("relief-mesh compare square.obj less.obj --strict");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_THAT(strict.out, HasSubstr("matched   1 triangle by position and texture coordinate\n"
                                      "unmatched 1 triangle only in A (first: triangle "));
    EXPECT_THAT(strict.out, HasSubstr("normals   in neither\n"));
    EXPECT_EQ(workplace.run("relief-mesh compare square.obj less.obj").exit_code, 0);

    workplace.write("far.obj", "v 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\n");
    const ProgramResult nothing = workplace.run("relief-mesh compare square.obj far.obj");
    EXPECT_EQ(nothing.exit_code, 1);
    EXPECT_THAT(nothing.error, HasSubstr("far.obj: has no triangle in common with square.obj"));
}

TEST(CompareCommand, NearPositionsMatchWithinTheTolerance) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("near.obj",
                    "v -1.00001 -1 0\nv 1 -1 0\nv 1 1.00001 0\nv -1 1 0.00001\n"
                    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
    const json usual = compared(workplace, "square.obj near.obj");
    EXPECT_EQ(usual["triangles"]["near"], 2) << "six digits";
    EXPECT_NEAR(usual["tolerance"].get<double>(), 2e-5, 1e-6) << "of size 2";
    EXPECT_EQ(workplace.run("relief-mesh compare square.obj near.obj --tolerance 0").exit_code, 1);
}

TEST(CompareCommand, ComparesFarMeshesExactly) {
    const Workplace workplace;
    workplace.write("far.obj",
                    "v 5000000.25 0 0\nv 5000001.25 0 0\nv 5000000.25 1 0\n"
                    "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    ASSERT_EQ(workplace.run("relief-mesh process far.obj out/far.glb").exit_code, 0);
    const json result = compared(workplace, "far.obj out/far.glb");
    EXPECT_EQ(result["triangles"]["only_in_a"], 0);
    EXPECT_TRUE(result["world_space"].get<bool>());
}

TEST(CompareCommand, ThreadsChangeNothing) {
    const Workplace workplace;
    for (const std::string method : {"mikktspace", "lengyel"}) {
        ASSERT_EQ(workplace
                      .run("relief-mesh process data/vase.obj out/" + method + ".glb --tangents " +
                           method)
                      .exit_code,
                  0);
    }
    const std::string files = "out/mikktspace.glb out/lengyel.glb";
    const json one = compared(workplace, files + " --threads 1");
    EXPECT_GT(one["tangents"]["max"].get<double>(), 0.01);
    EXPECT_EQ(one["normals"]["max"], 0.0);
    EXPECT_EQ(compared(workplace, files + " --threads 4"), one);
}

TEST(CompareCommand, PrimitivesAreListed) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief-mesh compare data/scenes/knot.glb data/scenes/knot.glb --strict --max-angle 0");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const json all = compared(workplace, "data/scenes/knot.glb data/scenes/knot.glb");
    std::size_t corners = 0;
    for (const json& primitive : all["primitives"])
        corners += primitive["corners"].get<std::size_t>();
    EXPECT_EQ(all["corners"], corners);
}

TEST(CompareCommand, QuantizedModelsAreComparedInWorldSpace) {
    RELIEF_NEEDS_SHARED(folder, "data/models/gltf/Duck");
    const Workplace workplace;
    const std::string files = (folder / "glTF-Binary/Duck.glb").string() + " " +
                              (folder / "glTF-Quantized/Duck.gltf").string();
    EXPECT_EQ(workplace.run("relief-mesh compare " + files).exit_code, 1) << "nothing in common";
    const json result = compared(workplace, files + " --world --ignore-uv --tolerance 0.001");
    EXPECT_EQ(result["triangles"]["only_in_a"], 0);
    EXPECT_TRUE(result["world_space"].get<bool>());
    // The file stores normals in 8 bits.
    EXPECT_GT(result["normals"]["mean"].get<double>(), 0.05);
    EXPECT_LT(result["normals"]["max"].get<double>(), 1.0);
}

TEST(CompareCommand, ProcessingKeepsRealModels) {
    RELIEF_NEEDS_SHARED(folder, "data/models/gltf-ext/misc/DuplicateMeshes");
    const std::string file = (folder / "duplicate_meshes.gltf").string();
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh process " + file + " out/again.glb").exit_code, 0);
    const json result = compared(workplace, file + " out/again.glb --max-angle 0 --strict");
    EXPECT_EQ(result["triangles"]["ambiguous"], 0) << "the same triangles in five primitives";
    EXPECT_EQ(result["primitives"].size(), 7U);
}

TEST(CompareRefusal, IsOneLine) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    expect_refusals(workplace, "relief-mesh", "old",
                    {{"relief-mesh compare square.obj", 2, "B is"},
                     {"relief-mesh compare square.obj none.obj", 1, "none.obj: "},
                     {"relief-mesh compare square.obj square.png", 2,
                      "square.png: .png is not a format that can be read"},
                     {"relief-mesh compare square.obj square.obj --max-angle 181", 2,
                      "--max-angle 181: not between 0 and 180 degrees"},
                     {"relief-mesh compare square.obj square.obj --tolerance -1", 2,
                      "--tolerance -1: not at least 0 units"},
                     {"relief-mesh compare square.obj square.obj --json --quiet", 2,
                      "--json and --quiet contradict each other"},
                     {"relief-mesh compare square.obj square.obj --ignore-uv --uv-tolerance 1", 2,
                      "--ignore-uv and --uv-tolerance contradict each other"}});
}

}  // namespace
}  // namespace relief::tools
