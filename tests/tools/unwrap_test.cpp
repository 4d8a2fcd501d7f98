// SPDX-License-Identifier: Apache-2.0
// The command `relief-mesh unwrap`: a mesh without texture coordinates becomes one that the baker
// accepts. tests/mesh/atlas checks the coordinates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "relief/mesh/mesh_file.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

TEST(UnwrapCommand, MakesAMeshReadyForBaking) {
    const Workplace workplace;
    workplace.write_square("out/plain.obj", true);
    ProgramResult result = workplace.run("relief-bake mesh data/vase.obj out/plain.obj out/n.png");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("unwrap it with relief-mesh unwrap"));
    result = workplace.run(
        "relief-mesh unwrap out/plain.obj out/a.obj --size 64x128 --padding 6 --report out/a.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("atlas     1 chart (0 below 64 texels), "));
    EXPECT_THAT(result.out, HasSubstr(" % of 64 x 128 texels used\n"));
    EXPECT_THAT(result.out, HasSubstr("padding   6 texels, enough up to mip level 1\n"));
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["tool"], "relief-mesh unwrap");
    EXPECT_EQ(report["options"]["size"], json({64, 128}));
    EXPECT_EQ(report["options"]["padding"], 6);
    EXPECT_EQ(report["atlas"]["charts"], 1);
    EXPECT_NEAR(report["atlas"]["area"].get<double>(), 4.0, 1e-6);
    // A square of 58 texels, with half of the padding and a thousandth of a texel on each side.
    EXPECT_NEAR(report["atlas"]["texels_per_unit"].get<double>(), 29.0, 0.3);
    EXPECT_NEAR(report["atlas"]["seam_length"].get<double>(), 8.0, 1e-6);

    Report ignored;
    const Mesh mesh = read_mesh(workplace / "out/a.obj", ignored).mesh;
    ASSERT_EQ(mesh.texcoords.size(), 4U);
    result = workplace.run("relief-bake mesh out/a.obj out/a.obj out/n.png --size 32");
    EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST(UnwrapCommand, WritesTheSameBytesForAnyNumberOfThreads) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh unwrap data/vase.obj out/a.glb --threads 1").exit_code, 0);
    ASSERT_EQ(workplace.run("relief-mesh unwrap data/vase.obj out/b.glb --threads 5").exit_code, 0);
    EXPECT_EQ(workplace.read("out/a.glb"), workplace.read("out/b.glb"));
    EXPECT_EQ(workplace.run("relief-mesh check out/a.glb").exit_code, 0);
}

TEST(UnwrapCommand, RefusesWhatItCannotDo) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj vase.glb").exit_code, 0);
    expect_refusals(
        workplace, "relief-mesh", "old.glb",
        {{"relief-mesh unwrap vase.glb out/old.glb", 2,
          "vase.glb: glTF files cannot be unwrapped yet"},
         {"relief-mesh unwrap data/vase.obj out/old.stl", 2, "out/old.stl"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --size 8", 2, "--size 8"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --size 64x", 2, "--size 64x"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --padding 257", 2, "--padding 257"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --size 16 --padding 16", 1,
          "data/vase.obj: the padding leaves no room in the map"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --texels-per-unit 1e6", 1,
          "data/vase.obj: the charts do not fit into the map at the requested density"}});
}

}  // namespace
}  // namespace relief::tools
