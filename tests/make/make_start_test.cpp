// SPDX-License-Identifier: Apache-2.0
// Continuing an asset with the files of `relief make --keep-stages`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

/// Makes an asset with the files of its stages in out/s, and continues from there.
class StartedAsset : public testing::Test {
  protected:
    static constexpr const char* options =
        " --size 32 --padding 1 --occlusion-rays 2 --keep-stages out/s";

    /// The input has a triangle with two sides beside a vase.
    void SetUp() override {
        const std::string vase = workplace.read("data/vase.obj");
        workplace.write("out/in.obj", vase + "v 9 9 0\nv 9 8 0\nv 8 9 0\nf -1 -2 -3\nf -3 -2 -1\n");
        const ProgramResult made = run("--triangles 200");
        ASSERT_EQ(made.exit_code, 0) << made.error;
        asset = workplace.read("out/a.glb");
    }

    [[nodiscard]] ProgramResult run(const std::string& more) const {
        return workplace.run("relief make out/in.obj out/a.glb " + more + options);
    }

    Workplace workplace;
    std::string asset;
};

TEST_F(StartedAsset, IsTheSameIfNoFileWasEdited) {
    for (const char* stage : {"decimate", "unwrap", "frames", "bake"}) {
        SCOPED_TRACE(stage);
        std::filesystem::remove(workplace / "out/a.glb");
        const ProgramResult result = run(std::string("--triangles 200 --from ") + stage);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_TRUE(workplace.read("out/a.glb") == asset) << "other bytes";
        EXPECT_THAT(result.out, Not(HasSubstr("that was edited")));
    }
}

TEST_F(StartedAsset, HasTheMeshOfAnEditedFile) {
    // A person replaces the decimated mesh by another one.
    ASSERT_EQ(workplace
                  .run("relief-mesh decimate out/s/03-decimate.glb out/s/03-decimate.glb "
                       "--triangles 100")
                  .exit_code,
              0);
    const ProgramResult result = run("--triangles 200 --from unwrap");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("stage file that was edited"));
    const Mesh mesh = test::read_document(workplace / "out/a.glb").mesh({0, 0});
    EXPECT_LE(mesh.triangles.size(), 100U);
    // The files of later stages are new, and can be used without the finding.
    const ProgramResult again = run("--triangles 200 --from bake");
    ASSERT_EQ(again.exit_code, 0) << again.error;
    EXPECT_THAT(again.out, Not(HasSubstr("that was edited")));
    EXPECT_EQ(test::read_document(workplace / "out/a.glb").mesh({0, 0}).positions, mesh.positions);
}

TEST_F(StartedAsset, IsRefusedIfFilesAreStaleOrMissing) {
    const auto expect_refusal = [&](const std::string& more, int code, const std::string& words) {
        const ProgramResult result = run(more);
        EXPECT_EQ(result.exit_code, code) << more;
        EXPECT_THAT(result.error, HasSubstr(words)) << more;
        EXPECT_TRUE(workplace.read("out/a.glb") == asset) << more;
    };
    expect_refusal("--triangles 300 --from unwrap", 1, "is stale: --triangles was 200, and is 300");
    expect_refusal("--triangles 200 --crease 40 --from frames", 1, "is stale: --crease was 60");
    expect_refusal("--triangles 200 --from repair", 2, "--from repair: not one of");
    expect_refusal("--triangles 200 --max-error 5 --from bake", 2, "need all stages");
    const std::string decimated = workplace.read("out/s/03-decimate.glb");
    workplace.write("out/s/03-decimate.glb", decimated + " ");
    expect_refusal("--triangles 200 --from frames", 1,
                   "03-decimate.glb: has changed, but the files of later stages were made before");
    workplace.write("out/s/03-decimate.glb", decimated);
    std::filesystem::remove(workplace / "out/s/05-frames.glb");
    expect_refusal("--triangles 200 --from bake", 1,
                   "05-frames.glb: is missing, but --from bake needs it");
    workplace.write("out/in.obj", workplace.read("out/in.obj") + "# more\n");
    expect_refusal("--triangles 200 --from unwrap", 1, "out/in.obj has changed since");
    workplace.write("out/s/stages.json",
                    R"({"inputs": 1, "options": 2, "files": [], "remeshed": 3})");
    expect_refusal("--triangles 200 --from unwrap", 1, "stages.json: is damaged");
    std::filesystem::remove(workplace / "out/s/stages.json");
    expect_refusal("--triangles 200 --from unwrap", 1, "stages.json: is missing");
    const ProgramResult alone = workplace.run("relief make data/vase.obj out/a.glb --from bake");
    EXPECT_EQ(alone.exit_code, 2);
    EXPECT_THAT(alone.error, HasSubstr("--from bake: needs files of stages"));
}

TEST_F(StartedAsset, IsRefusedIfAFileOfTheModelIsLeftOutOrAdded) {
    const std::string both = "--triangles 200 --with data/urn-low.obj";
    const ProgramResult added = run(both + " --from bake");
    EXPECT_EQ(added.exit_code, 1);
    EXPECT_THAT(added.error, HasSubstr("data/urn-low.obj was not a part of the model"));
    EXPECT_TRUE(workplace.read("out/a.glb") == asset);
    ASSERT_EQ(run(both).exit_code, 0);
    EXPECT_EQ(run(both + " --from bake").exit_code, 0);
    const ProgramResult left_out = run("--triangles 200 --from bake");
    EXPECT_EQ(left_out.exit_code, 1);
    EXPECT_THAT(left_out.error, HasSubstr("data/urn-low.obj was a part of the model"));
}

// An option of a later stage may change.
TEST_F(StartedAsset, CanHaveOtherMaps) {
    const ProgramResult result = workplace.run(
        "relief make out/in.obj out/b.glb --triangles 200 --size 64 --padding 1 --keep-stages "
        "out/s "
        "--occlusion-rays 0 --from unwrap");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(test::read_document(workplace / "out/b.glb").view().images.size(), 1U);
}

TEST(StartedRemesh, ContinuesWithTheClosedSurface) {
    const Workplace workplace;
    const std::string line =
        "relief make data/vase.obj out/a.glb --triangles 100 --size 32 --padding 1 "
        "--occlusion-rays 0 --remesh always --resolution 24 --keep-stages out/s";
    ASSERT_EQ(workplace.run(line).exit_code, 0);
    const std::string asset = workplace.read("out/a.glb");
    ASSERT_TRUE(std::filesystem::exists(workplace / "out/s/02-remesh.glb"));
    for (const char* stage : {"decimate", "bake"}) {
        const ProgramResult result = workplace.run(line + " --from " + stage);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_TRUE(workplace.read("out/a.glb") == asset) << stage;
    }
}

}  // namespace
}  // namespace relief::tools
