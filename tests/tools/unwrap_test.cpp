// SPDX-License-Identifier: Apache-2.0
// The command `relief-mesh unwrap`: a mesh without texture coordinates becomes one that the baker
// accepts. tests/mesh/atlas checks the coordinates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "relief/mesh/image_file.h"
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
    // A perimeter of 232 texels and half of the padding, with round corners.
    EXPECT_THAT(result.out, HasSubstr("          the padding of 1 chart costs 8.8 % of them\n"));
    EXPECT_THAT(result.out, HasSubstr("padding   6 texels, enough up to mip level 1\n"));
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["tool"], "relief-mesh unwrap");
    for (const char* stage : {"joining triangles", "dividing into charts", "flattening charts",
                              "packing charts", "measuring charts"})
        EXPECT_GE(report["unwrap_milliseconds"][stage].get<double>(), 0.0) << stage;
    EXPECT_EQ(report["options"]["size"], json({64, 128}));
    EXPECT_EQ(report["options"]["padding"], 6);
    EXPECT_EQ(report["atlas"]["charts"], 1);
    EXPECT_EQ(report["atlas"]["safe_mip_level"], 1);
    EXPECT_NEAR(report["atlas"]["padding_share"].get<double>(), 0.088, 1e-3);
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

/// Returns twice the signed area of a triangle in the map, with v upwards.
float signed_area(const Mesh& mesh, std::size_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::vec2 a = mesh.texcoords[t.y] - mesh.texcoords[t.x];
    const glm::vec2 b = mesh.texcoords[t.z] - mesh.texcoords[t.x];
    return a.y * b.x - a.x * b.y;
}

TEST(UnwrapCommand, RepacksExistingCharts) {
    const Workplace workplace;
    // The second square covers a quarter of the first one in the map, and is mirrored.
    workplace.write("out/a.obj",
                    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\n"
                    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt .5 0\nvt 0 0\nvt 0 .5\nvt .5 .5\n"
                    "f 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n");
    const std::string command = "relief-mesh unwrap out/a.obj out/b.obj --size 256 --repack ";
    ProgramResult result = workplace.run(command + "--report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 x mirrored chart (chart 1): stays mirrored"));
    const json atlas = json::parse(workplace.read("out/r.json"))["atlas"];
    EXPECT_EQ(atlas["charts"], 2);
    const auto written = [&] { return read_mesh(workplace / "out/b.obj").mesh; };
    Mesh mesh = written();
    EXPECT_NEAR(signed_area(mesh, 2), -0.25F * signed_area(mesh, 0), 1e-4F);
    EXPECT_NEAR(atlas["used"].get<double>(), 1.25 * static_cast<double>(signed_area(mesh, 0)),
                1e-3);
    result = workplace.run(command + "--fix-mirrored --strict");
    EXPECT_THAT(result.out, HasSubstr("1 x mirrored chart (chart 1): is reflected"));
    EXPECT_EQ(result.exit_code, 3);
    mesh = written();
    EXPECT_NEAR(signed_area(mesh, 2), 0.25F * signed_area(mesh, 0), 1e-4F);
    EXPECT_EQ(workplace.run("relief-mesh check out/b.obj --for-baking").exit_code, 0);
}

TEST(UnwrapCommand, ReportsRepackedChartsThatOverlapThemselves) {
    const Workplace workplace;
    // The second triangle lies on the first one.
    workplace.write("out/a.obj",
                    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt .9 .2\n"
                    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
    const ProgramResult result = workplace.run("relief-mesh unwrap out/a.obj out/b.obj --repack");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 x chart with overlapping or inverted triangles (chart 0): "
                                      "keeps its shape"));
}

TEST(UnwrapCommand, NumbersTilesUpwards) {
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-mesh unwrap data/vase.obj out/a.obj --size 128 --udim 11");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr(" % of 11 tiles of 128 x 128 texels used\n"));
    // OBJ has v upwards, so that tile 1011 is in 1 to 2.
    const std::string text = workplace.read("out/a.obj");
    float low = 2.0F;
    float high = -2.0F;
    float right = 0.0F;
    for (std::size_t at = text.find("\nvt "); at != std::string::npos;
         at = text.find("\nvt ", at + 1)) {
        float u = 0.0F;
        float v = 0.0F;
        std::istringstream(text.substr(at + 4, 60)) >> u >> v;
        low = std::min(low, v);
        high = std::max(high, v);
        right = std::max(right, u);
    }
    EXPECT_TRUE(low > 0.0F && low < 0.2F) << low;
    EXPECT_TRUE(high > 1.0F && high < 2.0F) << high;
    EXPECT_TRUE(right > 9.5F && right < 10.0F) << right;
    const ProgramResult checked =
        workplace.run("relief-mesh check out/a.obj --map-size 128 --json");
    const json report = json::parse(checked.out);
    for (const json& map : report["files"][0]["texcoords"]) {
        EXPECT_EQ(map["outside"], 0);
        EXPECT_EQ(map["overlapping"], 0);
        for (const json& tile : map["tiles"])
            EXPECT_TRUE(tile >= 1001 && tile <= 1011) << tile;
    }
    EXPECT_THAT(workplace.run("relief-mesh check out/a.obj --map-size 128").out,
                testing::ContainsRegex(", in [0-9]+ tiles: 100"));
}

TEST(UnwrapCommand, SplitsAtEveryEdgeThatIsNotFlat) {
    const Workplace workplace;
    // Two squares in a tilted plane, and one that is folded by a tenth of a degree.
    workplace.write("out/a.obj",
                    "v 0 0 0\nv 1 0 .3\nv 2 0 .6\nv 3 0 .902\nv 0 1 .1\nv 1 1 .4\nv 2 1 .7\n"
                    "v 3 1 1.002\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n");
    const std::string command = "relief-mesh unwrap out/a.obj out/b.obj --size 128x64 ";
    EXPECT_THAT(workplace.run(command).out, HasSubstr("atlas     1 chart "));
    EXPECT_THAT(workplace.run(command + "--split-hard 1").out, HasSubstr("atlas     1 chart "));
    EXPECT_THAT(workplace.run(command + "--split-hard 0").out, HasSubstr("atlas     2 charts "));
}

TEST(UnwrapCommand, DrawsItsCharts) {
    const Workplace workplace;
    for (const std::string shows : {"charts", "density", "stretch"}) {
        const ProgramResult result = workplace.run(
            "relief-mesh unwrap data/vase.obj out/a.glb --size 4096x1024 --picture out/" + shows +
            ".png --picture-shows " + shows);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        const ImageInfo picture = read_image_info(workplace / ("out/" + shows + ".png"));
        EXPECT_EQ(picture.width, 2048) << "at most";
        EXPECT_EQ(picture.height, 512);
    }
    EXPECT_NE(workplace.read("out/charts.png"), workplace.read("out/density.png"));
    EXPECT_NE(workplace.read("out/density.png"), workplace.read("out/stretch.png"));
}

TEST(UnwrapCommand, RefusesWhatItCannotDo) {
    const Workplace workplace;
    workplace.write_square("out/plain.obj", true);
    std::filesystem::rename(workplace / "out/plain.obj", workplace / "plain.obj");
    expect_refusals(
        workplace, "relief-mesh", "old.glb",
        {{"relief-mesh unwrap data/vase.obj out/old.stl", 2, "out/old.stl"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --size 8", 2, "--size 8"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --size 64x", 2, "--size 64x"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --padding 257", 2, "--padding 257"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --picture out/a.bmp", 2,
          "--picture out/a.bmp: the format is not supported"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --picture-shows stretch", 2,
          "--picture-shows: has no effect without --picture"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --fix-mirrored", 2,
          "--fix-mirrored: has no effect without --repack"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --repack --max-stretch 2", 2,
          "--max-stretch: has no effect with --repack, which keeps charts"},
         {"relief-mesh unwrap plain.obj out/old.glb --repack", 1,
          "plain.obj: there are no texture coordinates to repack"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --size 16 --padding 16", 1,
          "data/vase.obj: the padding leaves no room in the map"},
         {"relief-mesh unwrap data/vase.obj out/old.glb --texels-per-unit 1e6", 1,
          "data/vase.obj: the charts do not fit into the map at the requested density"}});
}

}  // namespace
}  // namespace relief::tools
