// SPDX-License-Identifier: Apache-2.0
// The files of `relief make --keep-stages`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

constexpr const char* small_maps = " --triangles 200 --size 32 --padding 2 --occlusion-rays 2";

TEST(KeptStages, HaveTheMeshAfterEachStageAndTheMaps) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        std::string("relief make data/vase.obj out/vase.glb --keep-stages out/new/s") + small_maps);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("01-repair.glb"));
    const auto read = [&](const char* name) {
        return test::read_document(workplace / "out/new/s" / name).mesh({0, 0});
    };
    const Mesh asset = test::read_document(workplace / "out/vase.glb").mesh({0, 0});
    EXPECT_GT(read("01-repair.glb").triangles.size(), 200U);
    const Mesh decimated = read("03-decimate.glb");
    EXPECT_EQ(decimated.triangles.size(), asset.triangles.size());
    EXPECT_TRUE(decimated.texcoords.empty());
    const Mesh unwrapped = read("04-unwrap.glb");
    EXPECT_FALSE(unwrapped.texcoords.empty());
    EXPECT_TRUE(unwrapped.tangents.empty());
    const Mesh framed = read("05-frames.glb");
    EXPECT_EQ(framed.positions, asset.positions);
    EXPECT_EQ(framed.tangents, asset.tangents);
    EXPECT_EQ(read_image_info(workplace / "out/new/s/06-bake-normal.png").width, 32);
    EXPECT_EQ(read_image_info(workplace / "out/new/s/06-bake-occlusion.png").width, 8);
}

TEST(KeptStages, AreThoseOfOneAssetAndNoInputs) {
    const Workplace workplace;
    ProgramResult result = workplace.run(
        "relief make data/vase.obj data/urn-low.obj -o out/ --keep-stages out/stages");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("--keep-stages out/stages: keeps the stages of one asset"));
    workplace.write("out/01-repair.glb", "old");
    result = workplace.run("relief make out/01-repair.glb out/a.glb --keep-stages out");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("out/01-repair.glb: would replace an input"));
    // A failure leaves the old files.
    workplace.write("out/empty.ply", "");
    EXPECT_EQ(workplace.run("relief make out/empty.ply out/a.glb --keep-stages out").exit_code, 1);
    EXPECT_EQ(workplace.outputs(), "01-repair.glb empty.ply");
    EXPECT_EQ(workplace.read("out/01-repair.glb"), "old");
}

}  // namespace
}  // namespace relief::tools
