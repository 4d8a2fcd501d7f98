// SPDX-License-Identifier: Apache-2.0
// relief-bake check as users run it: what it finds, how it says so, and with which exit code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "support/shared_data.h"
#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusal;
using test::ProgramResult;
using test::Refused;
using test::Workplace;
using testing::HasSubstr;

const std::string bricks = "data/scenes/bricks-normal.png";

TEST(MapCheckCommand, SaysThatASoundMapIsSound) {
    const Workplace workplace;
    const ProgramResult result = workplace.run("relief-bake check " + bricks + " --strict");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out, HasSubstr("file      " + bricks +
                                      ": 256 x 256, 3 channels, 8 bit: sound\n"
                                      "content   tangent-space normals\n"
                                      "lengths   mean 1.000, off 1 by 0.003 (RMS), "
                                      "100.0 % within 0.1\n"
                                      "green     up, by its slopes (correlation +1.00"));
    EXPECT_THAT(result.out, HasSubstr("words     docs/map-check.md says what each comes to\n"));
}

TEST(MapCheckCommand, IsStrictAboutTroubleWhenAsked) {
    const Workplace workplace;
    const std::string files = "data/bricks-height.png " + bricks;
    const ProgramResult lenient = workplace.run("relief-bake check " + files);
    EXPECT_EQ(lenient.exit_code, 0);
    EXPECT_THAT(lenient.out,
                HasSubstr("trouble   no normal map: its vectors have no common length, or all its "
                          "channels are the same\n"
                          "          -> relief-bake bump data/bricks-height.png out.png"));
    EXPECT_THAT(lenient.out,
                HasSubstr("verdict   2 files: 1 sound, 1 with trouble, 0 unreadable\n"));
    const ProgramResult strict = workplace.run("relief-bake check " + files + " --strict --quiet");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_EQ(strict.out, "");
    EXPECT_EQ(strict.error,
              "relief-bake: warning: 1 file with trouble (exit code 3, because of --strict)\n");
}

TEST(MapCheckCommand, ComparesGreenWithWhatIsWanted) {
    const Workplace workplace;
    EXPECT_EQ(workplace.run("relief-bake check " + bricks + " --green up --strict").exit_code, 0);
    const ProgramResult down =
        workplace.run("relief-bake check " + bricks + " --green down --strict");
    EXPECT_EQ(down.exit_code, 3);
    EXPECT_THAT(down.out, HasSubstr("trouble   green is not as said: "));
    // Of relief's own maps the file says it.
    EXPECT_EQ(
        workplace.run("relief-bake bump data/bricks-height.png out/dx.png --green down --quiet")
            .exit_code,
        0);
    const ProgramResult own = workplace.run("relief-bake check out/dx.png --strict");
    EXPECT_EQ(own.exit_code, 0);
    EXPECT_THAT(own.out, HasSubstr("remarks   green is down: "));
}

TEST(MapCheckCommand, SaysTheSameAsJson) {
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-bake check data/bricks-height.png " + bricks + " --json");
    const json report = json::parse(result.out);
    EXPECT_EQ(report["tool"], "relief-bake check");
    EXPECT_EQ(report["sound"], 1);
    EXPECT_EQ(report["with_trouble"], 1);
    const json& heights = report["files"][0];
    EXPECT_EQ(heights["content"], "grey");
    EXPECT_EQ(heights["green"], nullptr);
    EXPECT_EQ(heights["trouble"][0]["kind"], "no normal map");
    const json& map = report["files"][1];
    EXPECT_EQ(map["sound"], true);
    EXPECT_EQ(map["content"], "tangent-space");
    EXPECT_EQ(map["curve"], "none");
    EXPECT_EQ(map["green"]["is"], "up");
    EXPECT_GT(map["green"]["confidence"], 0.999999);
    EXPECT_EQ(map["bits_used"], json({8, 8, 8}));
    EXPECT_EQ(map["lengths"]["within"]["0.1"], 1.0);
    EXPECT_TRUE(map["trouble"].empty());
}

TEST(MapCheckCommand, GoesOnAfterAFileThatCannotBeRead) {
    const Workplace workplace;
    workplace.write("broken.png", "\x89PNG");
    const ProgramResult result =
        workplace.run("relief-bake check broken.png missing.png " + bricks + " --strict");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("relief-bake: error: broken.png: "));
    EXPECT_THAT(result.error, HasSubstr("relief-bake: error: missing.png: "));
    EXPECT_THAT(result.out,
                HasSubstr("verdict   3 files: 1 sound, 0 with trouble, 2 unreadable\n"));
}

TEST(MapCheckCommand, RefusesWhatContradictsItself) {
    const Workplace workplace;
    expect_refusal(workplace, "relief-bake",
                   {"relief-bake check data/bricks-height.png --json --quiet", 2,
                    "--json and --quiet contradict each other"},
                   "old.png");
    expect_refusal(workplace, "relief-bake", {"relief-bake check", 2, "MAPS"}, "old.png");
}

TEST(MapCheckCommand, SaysOfEveryBrokenImageWhatIsWrong) {
    RELIEF_NEEDS_SHARED(folder, "data/broken/image");
    const Workplace workplace;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const ProgramResult result =
            workplace.run("relief-bake check '" + entry.path().string() + "' --quiet");
        EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << entry.path();
        EXPECT_EQ(result.exit_code == 1,
                  result.error.starts_with("relief-bake: error: " + entry.path().string() + ": "))
            << result.error;
    }
}

}  // namespace
}  // namespace relief::tools
