// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake check on maps alone and on maps with their models, and relief-bake mesh
// --verify.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

using nlohmann::json;
using test::bricks_map;
using test::expect_refusal;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

TEST(MapCheckCommand, ReportsASoundMap) {
    const Workplace workplace;
    const ProgramResult result = workplace.run("relief-bake check " + bricks_map + " --strict");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out,
                HasSubstr("file      " + bricks_map +
                          ": 256 x 256, 3 channels, 8 bit: sound\ncontent   tangent-space "
                          "normals\nlengths   mean 1.000, RMS deviation from 1: 0.003, 100.0 % "
                          "within 0.1\ngreen     up, from the slopes (correlation +1.00"));
    EXPECT_THAT(result.out, HasSubstr("details   docs/map-check.md describes each condition\n"));
}

TEST(MapCheckCommand, StrictFailsOnProblems) {
    const Workplace workplace;
    const std::string files = "data/bricks-height.png " + bricks_map;
    const ProgramResult lenient = workplace.run("relief-bake check " + files);
    EXPECT_EQ(lenient.exit_code, 0);
    EXPECT_THAT(
        lenient.out,
        HasSubstr("problems  no normal map: its vectors have no common length, or all its channels "
                  "are the same\n          -> relief-bake bump data/bricks-height.png out.png"));
    EXPECT_THAT(lenient.out,
                HasSubstr("verdict   2 files: 1 sound, 1 with problems, 0 unreadable\n"));
    const ProgramResult strict = workplace.run("relief-bake check " + files + " --strict --quiet");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_EQ(strict.out, "");
    EXPECT_EQ(strict.error,
              "relief-bake: warning: 1 file with problems (exit code 3, because of --strict)\n");
}

TEST(MapCheckCommand, ComparesGreenWithTheExpectedDirection) {
    const Workplace workplace;
    EXPECT_EQ(workplace.run("relief-bake check " + bricks_map + " --green up --strict").exit_code,
              0);
    const ProgramResult down =
        workplace.run("relief-bake check " + bricks_map + " --green down --strict");
    EXPECT_EQ(down.exit_code, 3);
    EXPECT_THAT(down.out, HasSubstr("problems  green is not as stated: "));
    // Maps written by relief state their direction of green.
    EXPECT_EQ(
        workplace.run("relief-bake bump data/bricks-height.png out/dx.png --green down --quiet")
            .exit_code,
        0);
    const ProgramResult own = workplace.run("relief-bake check out/dx.png --strict");
    EXPECT_EQ(own.exit_code, 0);
    EXPECT_THAT(own.out, HasSubstr("notes     green is down: "));
}

TEST(MapCheckCommand, ReportsTheSameAsJson) {
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-bake check data/bricks-height.png " + bricks_map + " --json");
    const json report = json::parse(result.out);
    EXPECT_EQ(report["tool"], "relief-bake check");
    EXPECT_EQ(report["sound"], 1);
    EXPECT_EQ(report["with_problems"], 1);
    const json& heights = report["files"][0];
    EXPECT_EQ(heights["content"], "gray");
    EXPECT_EQ(heights["green"], nullptr);
    EXPECT_EQ(heights["problems"][0]["kind"], "no normal map");
    const json& map = report["files"][1];
    EXPECT_EQ(map["sound"], true);
    EXPECT_EQ(map["content"], "tangent-space");
    EXPECT_EQ(map["curve"], "none");
    EXPECT_EQ(map["green"]["is"], "up");
    EXPECT_GT(map["green"]["confidence"], 0.999999);
    EXPECT_EQ(map["bits_used"], json({8, 8, 8}));
    EXPECT_EQ(map["lengths"]["within"]["0.1"], 1.0);
    EXPECT_TRUE(map["problems"].empty());
}

/// Hills as 8-bit tangent-space normals.
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

/// Returns the remedy for a condition of a map in --json; empty if the map does not have it.
std::string remedy_of(const Workplace& workplace, const std::string& file,
                      const std::string& kind) {
    const json report = json::parse(workplace.run("relief-bake check " + file + " --json").out);
    for (const char* list : {"problems", "notes"}) {
        for (const json& finding : report["files"][0][list]) {
            if (finding["kind"] == kind) return finding["remedy"];
        }
    }
    return "";
}

TEST(MapCheckCommand, NamesRemediesThatWork) {
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

TEST(MapCheckCommand, NotesColorTags) {
    RELIEF_NEEDS_SHARED(file, "data/textures/sand_ambientcg/sand_normal.png");
    const Workplace workplace;
    std::filesystem::copy_file(file, workplace / "sand.png");
    const std::string remedy = remedy_of(workplace, "sand.png", "tagged as a color");
    EXPECT_EQ(remedy, "relief-bake convert sand.png out.png");
    EXPECT_EQ(workplace.run(remedy).exit_code, 0);
    EXPECT_EQ(remedy_of(workplace, "out.png", "tagged as a color"), "");
    EXPECT_NE(remedy_of(workplace, "out.png", "green is down"), "");
}

TEST(MapCheckCommand, ContinuesAfterAnUnreadableFile) {
    const Workplace workplace;
    workplace.write("broken.png", "\x89PNG");
    const ProgramResult result =
        workplace.run("relief-bake check broken.png missing.png " + bricks_map + " --strict");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("relief-bake: error: broken.png: "));
    EXPECT_THAT(result.error, HasSubstr("relief-bake: error: missing.png: "));
    EXPECT_THAT(result.out,
                HasSubstr("verdict   3 files: 1 sound, 0 with problems, 2 unreadable\n"));
}

TEST(MapCheckCommand, RefusesContradictoryOptions) {
    const Workplace workplace;
    expect_refusal(workplace, "relief-bake",
                   {"relief-bake check data/bricks-height.png --json --quiet", 2,
                    "--json and --quiet contradict each other"},
                   "old.png");
    expect_refusal(workplace, "relief-bake", {"relief-bake check", 2, "MAPS"}, "old.png");
}

TEST(MapCheckCommand, ReportsAnErrorForEveryBrokenImage) {
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

/// A curved surface above the square of Workplace: strips whose normals vary along x and y.
std::string verified_waves(double frequency = 3.0) {
    std::string text;
    constexpr int cells = 48;
    for (int row = 0; row <= cells; ++row) {
        for (int column = 0; column <= cells; ++column) {
            const double x = 2.0 * column / cells - 1.0, y = 2.0 * row / cells - 1.0;
            text += fmt::format("v {} {} {}\n", x, y,
                                0.1 * std::sin(frequency * x + 1.0) * std::cos(2.0 * y));
        }
    }
    for (int row = 0; row < cells; ++row) {
        for (int column = 1; column <= cells; ++column) {
            const int a = row * (cells + 1) + column;
            text += fmt::format("f {} {} {} {}\n", a, a + 1, a + cells + 2, a + cells + 1);
        }
    }
    return text;
}

class Verify : public testing::Test {
  protected:
    Verify() {
        workplace.write_square("low.obj");
        workplace.write("high.obj", verified_waves());
    }

    void bake(const std::string& options = "") const {
        const ProgramResult result = workplace.run(
            "relief-bake mesh high.obj low.obj out/map.png --size 64 --quiet " + options);
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
    /// Checks a map against the models. Optionally returns the exit code.
    [[nodiscard]] json check(const std::string& map, const std::string& options = "",
                             int* exit_code = nullptr) const {
        const ProgramResult result = workplace.run(
            "relief-bake check " + map + " --high high.obj --low low.obj --json " + options);
        if (exit_code != nullptr) *exit_code = result.exit_code;
        EXPECT_TRUE(exit_code != nullptr || result.exit_code == 0) << result.error;
        return json::parse(result.out)["files"][0]["surface"];
    }
    /// Changes the red, green and blue codes of the map.
    template <typename Change>
    void change(const Change& each) const {
        Image map = read_image(workplace / "out/map.png", ImageUse::data);
        const auto codes = map.as<std::uint16_t>();
        for (std::size_t i = 0; i < codes.size(); i += 3)
            each(codes[i], codes[i + 1], codes[i + 2]);
        write_image(workplace / "out/map.png", map);
    }

    Workplace workplace;
};

TEST_F(Verify, AFreshMapHasOnlyRoundingErrors) {
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 64 --verify --error-map out/e.png "
        "--report out/report.json --strict");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("from the mean over each texel (16 samples)"));
    EXPECT_THAT(result.out, HasSubstr("verdict   matches this bake\n"));
    const json report = json::parse(workplace.read("out/report.json"));
    const json& check = report["maps"][0]["check"];
    EXPECT_EQ(check["center"]["texels"], 64 * 64);
    EXPECT_LT(check["center"]["max"].get<double>(), 0.003);
    EXPECT_LT(check["error"]["rms"].get<double>(), 0.5);
    EXPECT_EQ(check["stages"]["other"]["rms"], 0.0);
    double shares = 0.0;
    for (const json& stage : check["stages"])
        shares += stage["fraction"].get<double>();
    EXPECT_NEAR(shares, 1.0, 1e-9);
    const Image errors = read_image(workplace / "out/e.png", ImageUse::data);
    EXPECT_EQ(errors.width, 64);
    EXPECT_EQ(errors.channels, 4);
    EXPECT_EQ(read_image_info(workplace / "out/e.png").metadata.at("relief:brightest"),
              fmt::format("{:g}", check["error_map"]["brightest"].get<double>()));
}

TEST_F(Verify, TheFileRecordsItsBake) {
    bake(
        "--samples 4 --rays face --offset 0.5 --max-distance 0.25 --dither blue-noise --bits 8 "
        "--match all");
    const json surface = check("out/map.png");
    EXPECT_EQ(surface["baked"],
              "--dither blue-noise --match all --max-distance 0.25 --offset 0.5 --rays face "
              "--samples 4 --space tangent");
    EXPECT_EQ(surface["file_says"], surface["baked"]);
    EXPECT_EQ(surface["offset"], 0.5);
    EXPECT_EQ(surface["reference_samples"], 64);
    // The repeated bake gives the same codes, including the dither.
    EXPECT_EQ(surface["stages"]["other"]["rms"], 0.0);
    EXPECT_GT(surface["stages"]["quantization"]["rms"].get<double>(), 0.05);
    const json told = check("out/map.png", "--samples 1");
    EXPECT_EQ(told["reference_samples"], 16);
    EXPECT_GT(told["stages"]["other"]["rms"].get<double>(), 0.0);
}

TEST_F(Verify, AnErrorAboveTheLimitIsAProblem) {
    bake();
    int exit_code = -1;
    json surface = check("out/map.png", "--max-error 1 --strict", &exit_code);
    EXPECT_EQ(exit_code, 0);
    EXPECT_TRUE(surface["problems"].empty());
    surface = check("out/map.png", "--max-error 0.01 --max-error-kind p99 --strict", &exit_code);
    EXPECT_EQ(exit_code, 3);
    EXPECT_THAT(surface["problems"][0].get<std::string>(),
                HasSubstr("more than the limit of 0.01 degrees (99 %)"));
}

TEST_F(Verify, InvertedGreenIsReportedAndItsRemedyWorks) {
    bake();
    const double as_baked = check("out/map.png")["error"]["rms"].get<double>();
    change([](std::uint16_t&, std::uint16_t& green, std::uint16_t&) {
        green = static_cast<std::uint16_t>(65535 - green);
    });
    int exit_code = -1;
    const json surface = check("out/map.png", "--strict", &exit_code);
    EXPECT_EQ(exit_code, 3);
    EXPECT_GT(surface["error"]["rms"].get<double>(), 5.0);
    EXPECT_EQ(surface["convention"]["differs_in"], json({"axes"}));
    EXPECT_THAT(surface["problems"][0].get<std::string>(), HasSubstr("green is inverted"));
    const std::string remedy = surface["remedies"][0];
    EXPECT_EQ(remedy, "relief-bake convert out/map.png out.png --axes=x,-y,z");
    ASSERT_EQ(workplace.run(remedy).exit_code, 0);
    EXPECT_NEAR(check("out.png")["error"]["rms"].get<double>(), as_baked, 1e-9);
}

TEST_F(Verify, AnotherSpaceIsReportedAndItsRemedyWorks) {
    bake("--space world");
    change([](std::uint16_t& red, std::uint16_t& green, std::uint16_t& blue) {
        // On a square in the xy plane, tangent space is world space; on a rotated one it is not.
        const std::uint16_t old = red;
        red = blue;
        blue = green;
        green = old;
    });
    const json surface = check("out/map.png", "--space world");
    EXPECT_EQ(surface["convention"]["differs_in"], json({"axes"}));
    const std::string remedy = surface["remedies"][0];
    ASSERT_EQ(workplace.run(remedy).exit_code, 0);
    EXPECT_LT(check("out.png", "--space world")["center"]["max"].get<double>(), 0.003);
}

TEST_F(Verify, NoConventionExplainsAMapOfAnotherModel) {
    workplace.write("other.obj", verified_waves(7.0));
    ASSERT_EQ(
        workplace.run("relief-bake mesh other.obj low.obj out/map.png --size 64 --quiet").exit_code,
        0);
    int exit_code = -1;
    const json surface = check("out/map.png", "--strict", &exit_code);
    EXPECT_EQ(exit_code, 3);
    EXPECT_EQ(surface["convention"]["explained"], false);
    EXPECT_THAT(surface["problems"][0].get<std::string>(),
                HasSubstr("the map differs from this bake"));
}

/// Turns texels of a map to the side.
void bend_texels(const std::filesystem::path& file, const std::vector<glm::ivec2>& texels) {
    Image map = read_image(file, ImageUse::data);
    for (const glm::ivec2& texel : texels) {
        const auto index = static_cast<std::size_t>(texel.y * map.width + texel.x);
        std::uint16_t* const codes = &map.as<std::uint16_t>()[3 * index];
        codes[0] = 65535;
        codes[1] = codes[2] = 32768;
    }
    write_image(file, map);
}

TEST_F(Verify, OutliersAtEdgesAreNotedAndDoNotMakeAnotherBake) {
    bake();
    std::vector<glm::ivec2> border;
    for (int x = 10; x < 50; ++x)
        border.emplace_back(x, 1);
    bend_texels(workplace / "out/map.png", border);
    const json surface = check("out/map.png", "--strict");
    EXPECT_GT(surface["stages"]["other"]["rms"].get<double>(), 5.0);
    EXPECT_TRUE(surface["problems"].empty()) << surface["problems"];
    const json& outliers = surface["outliers"];
    EXPECT_NEAR(outliers["percent"].get<double>(), 100.0 * 40 / 4096, 1e-9);
    EXPECT_EQ(outliers["percent_at_edges"], outliers["percent"]);
    EXPECT_LT(outliers["median"].get<double>(), 1e-6);
    ASSERT_EQ(outliers["texels"].size(), 8U);
    EXPECT_EQ(outliers["texels"][0]["y"], 1);
    const ProgramResult result =
        workplace.run("relief-bake check out/map.png --high high.obj --low low.obj");
    EXPECT_THAT(result.out,
                HasSubstr("outliers  0.98 % of the texels differ from this bake by more than 1 "
                          "degree, 100 % of them at silhouettes and borders of charts: column "));
    EXPECT_THAT(result.out, HasSubstr("verdict   matches this bake\n"));
}

TEST_F(Verify, TheSameOutliersInsideAreAnEdit) {
    bake();
    std::vector<glm::ivec2> inside;
    for (int x = 10; x < 50; ++x)
        inside.emplace_back(x, 32);
    bend_texels(workplace / "out/map.png", inside);
    int exit_code = -1;
    const json surface = check("out/map.png", "--strict", &exit_code);
    EXPECT_EQ(exit_code, 3);
    EXPECT_EQ(surface["outliers"]["percent_at_edges"], 0.0);
    EXPECT_THAT(
        surface["problems"][0].get<std::string>(),
        HasSubstr("degrees (median), and 0.98 % of its texels by more than 1 degree (0.98 % away "
                  "from edges); none of "));
}

TEST(MapCheckCommand, ListsConditionsThatNeedTheModels) {
    const Workplace workplace;
    const Image map = changed(hills(), [n = 0](auto c, int s) mutable {
        const bool is_bent = n++ / 3 == 64 * 5 + 7;
        return is_bent ? (c == 2 ? 20 : 160) : s;
    });
    write_image(workplace / "other.png", map);
    write_image(workplace / "baked.png", map, {{"relief:bake", "--samples 1 --space tangent"}});
    EXPECT_EQ(workplace.run("relief-bake check other.png --strict --quiet").exit_code, 3);
    const ProgramResult result = workplace.run("relief-bake check baked.png --strict");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("baked.png: 64 x 64, 3 channels, 8 bit: sound\n"));
    EXPECT_THAT(result.out,
                HasSubstr("unjudged  1 x texel facing back (column 7, row 5): cannot be judged "
                          "without the models: the high surface may lean so far\n"
                          "          -> relief-bake check baked.png --high HIGH --low LOW\n"));
    const json report =
        json::parse(workplace.run("relief-bake check baked.png --json").out)["files"][0];
    EXPECT_TRUE(report["problems"].empty());
    EXPECT_EQ(report["unjudged"][0]["kind"], "texel facing back");
}

TEST_F(Verify, ACageMustBeGivenAgain) {
    workplace.write("cage.obj", "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\n");
    bake("--cage cage.obj");
    const std::string line = "relief-bake check out/map.png --high high.obj --low low.obj ";
    const ProgramResult result = workplace.run(line);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error,
                HasSubstr("was baked with a cage, but does not name its file (give --cage FILE)"));
    EXPECT_EQ(workplace.run(line + "--cage cage.obj --strict").exit_code, 0);
}

TEST_F(Verify, EachTileIsVerified) {
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj 'out/<UDIM>.png' --size 32 --verify --report "
        "out/report.json --quiet");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_LT(report["maps"][0]["check"]["center"]["max"].get<double>(), 0.003);
    EXPECT_LT(check("out/1001.png")["center"]["max"].get<double>(), 0.003);
    EXPECT_EQ(
        workplace.run("relief-bake check out/1001.png --high high.obj --low low.obj --udim 1002")
            .exit_code,
        1);
}

TEST_F(Verify, ErrorsInDegreesAreWrittenAsFloats) {
    bake();
    const json surface = check("out/map.png", "--error-map out/e.exr");
    const Image errors = read_image(workplace / "out/e.exr", ImageUse::data);
    EXPECT_EQ(errors.channels, 1);
    double squares = 0.0;
    for (const float error : errors.as<float>())
        squares += double{error} * double{error};
    EXPECT_NEAR(std::sqrt(squares / (64 * 64)), surface["error"]["rms"].get<double>(), 1e-6);
}

TEST(VerifyRefusal, LeavesAllFilesUnchanged) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", verified_waves());
    ASSERT_EQ(workplace.run("relief-bake mesh high.obj low.obj map.png --size 8 --quiet").exit_code,
              0);
    expect_refusals(
        workplace, "relief-bake", "e.png",
        {{"relief-bake check map.png --low low.obj", 2, "--low: has no effect without --high"},
         {"relief-bake check map.png --high high.obj", 2, "--high: needs the model of the map"},
         {"relief-bake check map.png map.png --high high.obj --low low.obj", 2,
          "--high: needs a single map, not 2"},
         {"relief-bake check map.png --max-error 1", 2,
          "--max-error: has no effect without --high"},
         {"relief-bake check map.png --high high.obj --low low.obj --max-error-kind max", 2,
          "--max-error-kind: has no effect without --max-error"},
         {"relief-bake check map.png --high high.obj --low low.obj --error-map map.png", 2,
          "--error-map map.png: is also the input or the output"},
         {"relief-bake check map.png --high high.obj --low low.obj --error-map e.jpg", 2,
          "--error-map e.jpg: the format cannot store it"},
         {"relief-bake check map.png --high none.obj --low low.obj", 1, "none.obj: no such file"},
         {"relief-bake mesh high.obj low.obj out/map.png --error-map out/e.png", 2,
          "--error-map: has no effect without --verify"}});
}

}  // namespace
}  // namespace relief::tools
