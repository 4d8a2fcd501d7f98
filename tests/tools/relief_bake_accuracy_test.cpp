// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake mesh --max-error and --compare.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// Waves above the square of Workplace. A texel of a map of 32 covers a fifth of a wave.
std::string smooth_waves() {
    std::string text;
    constexpr int cells = 300;
    for (int column = 0; column <= cells; ++column) {
        const double x = 2.0 * column / cells - 1.0;
        const double height = 0.01 * std::sin(20.0 * x);
        text += fmt::format("v {0} -1 {1}\nv {0} 1 {1}\n", x, height);
    }
    for (int column = 0; column < cells; ++column) {
        const int a = 2 * column + 1;
        text += fmt::format("f {} {} {} {}\n", a, a + 2, a + 3, a + 1);
    }
    return text;
}

class BakeAccuracy : public testing::Test {
  protected:
    BakeAccuracy() {
        workplace.write_square("low.obj");
        workplace.write("high.obj", smooth_waves());
    }
    [[nodiscard]] json baked(const std::string& options) const {
        const ProgramResult result = workplace.run(
            "relief-bake mesh high.obj low.obj out/map.png --size 32 --report out/report.json " +
            options);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return json::parse(workplace.read("out/report.json"));
    }
    Workplace workplace;
};

TEST_F(BakeAccuracy, IncreasesSamplesAndBitsUntilTheErrorIsWithinTheLimit) {
    const json loose = baked("--max-error 5");
    EXPECT_EQ(loose["selected"]["samples"], 1);
    EXPECT_EQ(loose["selected"]["bits"], 8);
    EXPECT_EQ(loose["bits"], 8);
    EXPECT_EQ(read_image_info(workplace / "out/map.png").bits, 8);
    const json tight = baked("--max-error 0.1");
    EXPECT_GT(tight["selected"]["samples"].get<int>(), 1);
    EXPECT_EQ(tight["selected"]["bits"], 16);
    EXPECT_LE(tight["selected"]["p99"].get<double>(), 0.1);
    const json& before = tight["steps"][tight["steps"].size() - 4];
    EXPECT_GT(before["p99"].get<double>(), 0.1);
    const auto said = read_image_info(workplace / "out/map.png").metadata;
    EXPECT_EQ(said.at("relief:bake"),
              fmt::format("--samples {} --space tangent", tight["selected"]["samples"].get<int>()));
    // The file has the measured method.
    const json checked = baked("--max-error 0.1 --verify");
    EXPECT_NEAR(checked["maps"][0]["check"]["error"]["rms"].get<double>(),
                tight["selected"]["rms"].get<double>(), 0.01);
}

TEST_F(BakeAccuracy, KeepsGivenSamplesAndBits) {
    // Directions in the plane y = 0 have no exact code in 8 bits, so that rounding alone is 0.25
    // degrees.
    const json bits = baked("--max-error 0.3 --bits 8");
    EXPECT_EQ(bits["selected"]["bits"], 8);
    const json samples = baked("--max-error 5 --samples 16");
    EXPECT_EQ(samples["selected"]["samples"], 16);
    EXPECT_EQ(samples["steps"].size(), 2U);
}

/// The minimum error in an error message.
double min_in(const std::string& error) {
    const std::string before = "the minimum is ";
    const std::size_t at = error.find(before);
    return at == std::string::npos ? -1.0 : std::stod(error.substr(at + before.size()));
}

TEST_LABELS(not_sanitized);
TEST_F(BakeAccuracy, FailsWithTheMinimumErrorOfAllChoices) {
    const auto error_of = [&](const std::string& options) {
        const ProgramResult result =
            workplace.run("relief-bake mesh high.obj low.obj out/" + options + " --size 32");
        EXPECT_EQ(result.exit_code, 1) << options;
        EXPECT_EQ(workplace.outputs(), "") << options;
        return result.error;
    };
    // Rounding is the larger part of the error.
    const std::string rounding = error_of("map.png --max-error 0.05 --bits 8");
    EXPECT_THAT(
        rounding,
        HasSubstr(
            "no choice of samples and bits is within 0.05 degrees (99 %): the minimum is 0."));
    EXPECT_THAT(rounding, HasSubstr(" 8 bit; rounding to 8 bits alone causes 0."));
    EXPECT_THAT(rounding, HasSubstr("(16 bits are within the limit, with 0.0"));
    EXPECT_THAT(rounding, HasSubstr(": give --bits 16)"));
    // Sampling is the larger part. Rounding alone exceeds the limit too, so 256 samples are tried.
    const std::string both = error_of("map.png --max-error 0.0001");
    EXPECT_THAT(both, HasSubstr("with 256 samples, 16 bit; sampling alone causes 0.0"));
    EXPECT_THAT(both, HasSubstr("(allow a larger error)"));
    const std::string floats = error_of("map.exr --max-error 0.000001");
    EXPECT_THAT(floats, HasSubstr("with 256 samples, 32 bit; sampling alone causes "));
    EXPECT_LE(min_in(floats), min_in(both));
    // The minimum errors of the messages can be reached.
    const json eight = baked(fmt::format("--max-error {} --bits 8", 1.02 * min_in(rounding)));
    EXPECT_LE(eight["selected"]["p99"].get<double>(), 1.02 * min_in(rounding));
    const json sixteen = baked(fmt::format("--max-error {}", 1.02 * min_in(both)));
    EXPECT_EQ(sixteen["selected"]["samples"], 256);
    EXPECT_LT(min_in(both),
              0.5 * baked("--max-error 1 --samples 16 --bits 16")["selected"]["p99"].get<double>());
    std::filesystem::remove(workplace / "out/map.png");
    std::filesystem::remove(workplace / "out/report.json");
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 32 --max-error 0.0001 "
        "--max-error-kind max --samples 4");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("within 0.0001 degrees (maximum)"));
    EXPECT_EQ(workplace.outputs(), "");
}

TEST_F(BakeAccuracy, WithoutTexelsNoErrorIsWithinALimit) {
    // The high model is beside the low square, so that no ray hits it.
    workplace.write("high.obj", "v 1.5 0 0\nv 2.5 0 0\nv 1.5 1 0\nf 1 2 3\n");
    for (const char* option : {"--max-error 5", "--compare"}) {
        const ProgramResult result = workplace.run(
            std::string("relief-bake mesh high.obj low.obj out/map.png --size 32 ") + option);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_THAT(result.error, HasSubstr("no ray hits high.obj: all 1024 texels"));
        EXPECT_EQ(workplace.outputs(), "");
    }
}

TEST_F(BakeAccuracy, ComparesEverySampleCountAndDepth) {
    const json report = baked("--compare");
    const json& all = report["comparison"];
    ASSERT_EQ(all.size(), 28U);
    const auto error_of = [&](const json& samples, int bits, const std::string& dither) {
        for (const json& one : all) {
            if (one["samples"] == samples && one["bits"] == bits && one["dither"] == dither)
                return one["rms"].get<double>();
        }
        return -1.0;
    };
    EXPECT_GT(error_of(1, 16, "none"), 2.0 * error_of(4, 16, "none"));
    EXPECT_GT(error_of(4, 16, "none"), 2.0 * error_of(16, 16, "none"));
    EXPECT_GT(error_of(16, 8, "none"), error_of(16, 16, "none"));
    EXPECT_GT(error_of(16, 8, "blue-noise"), error_of(16, 8, "none"));
    std::size_t pareto_optimal = 0;
    for (const json& one : all)
        pareto_optimal += one["efficient"].get<bool>() ? 1 : 0;
    EXPECT_GE(pareto_optimal, 2U);
    EXPECT_EQ(report["reference"]["samples"], 256);
    EXPECT_TRUE(report["reference"]["whole"].get<bool>());
    // The map is also baked as usual.
    EXPECT_EQ(report["samples"], 32 * 32);
}

TEST_LABELS(not_sanitized);
TEST_F(BakeAccuracy, Uses256SamplesIfFewerAreNotEnough) {
    const json few = baked("--max-error 10 --samples 64 --bits 16");
    const double bound = 0.6 * few["selected"]["p99"].get<double>();
    const json report = baked(fmt::format("--max-error {}", bound));
    EXPECT_EQ(report["selected"]["samples"], 256);
    EXPECT_EQ(report["selected"]["bits"], 16);
    EXPECT_LE(report["selected"]["p99"].get<double>(), bound);
    // The reference has more samples than the map, so the error is that of the samples, not 0.
    EXPECT_EQ(report["reference"]["samples"], 1024);
    EXPECT_GT(report["selected"]["sampling"].get<double>(), 0.1 * bound);
    EXPECT_EQ(report["samples"], 256 * 32 * 32);
}

TEST(BakeAccuracyRefusal, LeavesAllFilesUnchanged) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", smooth_waves());
    expect_refusals(workplace, "relief-bake", "map.png",
                    {{"relief-bake mesh high.obj low.obj out/map.png --max-error-kind max", 2,
                      "--max-error-kind: has no effect without --max-error"},
                     {"relief-bake mesh high.obj low.obj out/map.png --max-error 1 --compare", 2,
                      "--compare, --max-error: contradict each other"},
                     {"relief-bake mesh high.obj low.obj 'out/<UDIM>.png' --compare", 2,
                      "--compare: needs a single map, not <material> or <UDIM>"},
                     {"relief-bake mesh high.obj low.obj out/map.exr --half --max-error 1", 2,
                      "--max-error, --half: errors of half floats are not measured"}});
}

}  // namespace
}  // namespace relief::tools
