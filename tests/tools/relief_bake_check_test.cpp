// SPDX-License-Identifier: Apache-2.0
// relief-bake check as users run it: what it finds, how it says so, and with which exit code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"
#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::bricks_map;
using test::expect_refusal;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

TEST(MapCheckCommand, SaysThatASoundMapIsSound) {
    const Workplace workplace;
    const ProgramResult result = workplace.run("relief-bake check " + bricks_map + " --strict");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out, HasSubstr("file      " + bricks_map +
                                      ": 256 x 256, 3 channels, 8 bit: sound\n"
                                      "content   tangent-space normals\n"
                                      "lengths   mean 1.000, off 1 by 0.003 (RMS), "
                                      "100.0 % within 0.1\n"
                                      "green     up, by its slopes (correlation +1.00"));
    EXPECT_THAT(result.out, HasSubstr("words     docs/map-check.md says what each comes to\n"));
}

TEST(MapCheckCommand, IsStrictAboutTroubleWhenAsked) {
    const Workplace workplace;
    const std::string files = "data/bricks-height.png " + bricks_map;
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
    EXPECT_EQ(workplace.run("relief-bake check " + bricks_map + " --green up --strict").exit_code,
              0);
    const ProgramResult down =
        workplace.run("relief-bake check " + bricks_map + " --green down --strict");
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
        workplace.run("relief-bake check data/bricks-height.png " + bricks_map + " --json");
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

/// Hills, as tangent-space normals of 8 bits.
Image hills() {
    Report report;
    return normal_map_from_height(
        wave_heights(64, 64, tiling_waves(64, 64, 8, 8.0, 0.5, 3)).heights,
        {Kernel::central3, Wrap::repeat, 1.0}, {.bits = 8}, report);
}

template <typename Change>
Image changed(Image map, Change change) {
    for (std::size_t i = 0; i < map.sample_count(); ++i) {
        std::uint8_t& sample = map.as<std::uint8_t>()[i];
        sample = static_cast<std::uint8_t>(change(i % 3, static_cast<int>(sample)));
    }
    return map;
}

/// The remedy for a condition of a map, as --json has it; empty if it has not the condition.
std::string remedy_of(const Workplace& workplace, const std::string& file,
                      const std::string& kind) {
    const json report = json::parse(workplace.run("relief-bake check " + file + " --json").out);
    for (const char* list : {"trouble", "remarks"}) {
        for (const json& finding : report["files"][0][list]) {
            if (finding["kind"] == kind) return finding["remedy"];
        }
    }
    return "";
}

TEST(MapCheckCommand, NamesRemediesThatHelp) {
    const Workplace workplace;
    const Image sound = hills();
    Image wide = make_image(64, 64, 3, 16, ColorSpace::data);
    for (std::size_t i = 0; i < wide.sample_count(); ++i)
        wide.as<std::uint16_t>()[i] = static_cast<std::uint16_t>(257 * sound.as<std::uint8_t>()[i]);
    Image alpha = make_image(64, 64, 4, 8, ColorSpace::data);
    for (std::size_t i = 0; i < alpha.sample_count(); ++i)
        alpha.as<std::uint8_t>()[i] =
            i % 4 == 3 ? std::uint8_t{255} : sound.as<std::uint8_t>()[i / 4 * 3 + i % 4];
    const std::vector<std::pair<const char*, Image>> maps = {
        {"green is down", changed(hills(), [](auto c, int s) { return c == 1 ? 256 - s : s; })},
        {"not of unit length", changed(hills(), [](auto, int s) { return 128 + (s - 128) / 2; })},
        {"no third component", changed(hills(), [](auto c, int s) { return c == 2 ? 0 : s; })},
        {"texel without direction",
         changed(hills(), [n = 0](auto, int s) mutable { return n++ < 3 ? 128 : s; })},
        {"bits unused", wide},
        {"constant alpha", alpha}};
    for (const auto& [kind, map] : maps) {
        write_image(workplace / "map one.png", map);
        const std::string remedy = remedy_of(workplace, "'map one.png'", kind);
        EXPECT_THAT(remedy, testing::StartsWith("relief-bake convert 'map one.png' out.png --"))
            << kind;
        EXPECT_EQ(workplace.run(remedy).exit_code, 0) << remedy;
        EXPECT_EQ(remedy_of(workplace, "out.png", kind), "") << kind;
    }
}

TEST(MapCheckCommand, NamesTheRemedyForSignedSamples) {
    const Workplace workplace;
    Report report;
    write_image(
        workplace / "signed.exr",
        normals_from_height(wave_heights(64, 64, tiling_waves(64, 64, 8, 8.0, 0.5, 3)).heights,
                            {Kernel::central3, Wrap::repeat, 1.0}, report));
    const std::string remedy = remedy_of(workplace, "signed.exr", "signed samples");
    EXPECT_EQ(remedy, "relief-bake convert signed.exr out.png --input-signed");
    EXPECT_EQ(workplace.run(remedy).exit_code, 0);
    EXPECT_EQ(workplace.run("relief-bake check out.png --strict").exit_code, 0);
    EXPECT_EQ(workplace.run("relief-bake heights signed.exr out/h.png --input-signed").exit_code,
              0);
}

TEST(MapCheckCommand, RemarksOnTagsThatSayColour) {
    RELIEF_NEEDS_SHARED(file, "data/textures/sand_ambientcg/sand_normal.png");
    const Workplace workplace;
    std::filesystem::copy_file(file, workplace / "sand.png");
    const std::string remedy = remedy_of(workplace, "sand.png", "tagged as a colour");
    EXPECT_EQ(remedy, "relief-bake convert sand.png out.png");
    EXPECT_EQ(workplace.run(remedy).exit_code, 0);
    EXPECT_EQ(remedy_of(workplace, "out.png", "tagged as a colour"), "");
    EXPECT_NE(remedy_of(workplace, "out.png", "green is down"), "");
}

TEST(MapCheckCommand, GoesOnAfterAFileThatCannotBeRead) {
    const Workplace workplace;
    workplace.write("broken.png", "\x89PNG");
    const ProgramResult result =
        workplace.run("relief-bake check broken.png missing.png " + bricks_map + " --strict");
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
