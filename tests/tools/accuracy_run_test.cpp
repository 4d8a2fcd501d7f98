// SPDX-License-Identifier: Apache-2.0
// The commands `relief-accuracy run`, and `relief-accuracy own` on meshes, maps and pairs: tables,
// files and errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "support/labels.h"
#include "support/sanitized.h"
#include "tools/schema_page.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

TEST_LABELS(slow, not_sanitized);
TEST(AccuracyRun, PrintsATableAndWritesTheReport) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief-accuracy run storage --quick --repeats 3 --passes 2 --output out/report");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out, HasSubstr("storage/frames: Tangent frames in few bits\n"));
    EXPECT_THAT(result.out, HasSubstr("out/report/accuracy.json: "));
    const json report = json::parse(workplace.read("out/report/accuracy.json"));
    EXPECT_EQ(report["command"], "relief-accuracy run storage --quick --repeats 3 --passes 2");
    EXPECT_EQ(report["settings"]["passes"], 2);
    EXPECT_EQ(report["settings"]["repeats"], 3);
    const json& first = report["experiments"][0]["measurements"][0];
    EXPECT_EQ(first["cost"]["one_thread"]["rounds"].size(), 3U);
    EXPECT_GT(first["cost"]["one_thread"]["median"].get<double>(), 0.0);
    EXPECT_THAT(test::schema_faults(report, test::schema_rows("## accuracy.json"), false),
                testing::IsEmpty());
    EXPECT_THAT(workplace.read("out/report/accuracy.csv"),
                HasSubstr("\nstorage/frames,storage,\"float32, nearest\","
                          "encoding=float32; rounding=nearest,degrees,"));
}

TEST(AccuracyRun, ErrorsAloneAreTheSameEachTimeForAnyThreadsAndProcessor) {
    const Workplace workplace;
    const std::string line = "relief-accuracy run storage --quick --no-times --json";
    const ProgramResult first = workplace.run(line);
    ASSERT_EQ(first.exit_code, 0) << first.error;
    EXPECT_THAT(first.out, Not(HasSubstr("one_thread")));
    // glibc then chooses functions for processors without fused multiplication.
    const ProgramResult second =
        workplace.run("GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4 " + line);
    EXPECT_EQ(second.exit_code, 0) << second.error;
    EXPECT_EQ(second.out, first.out);
    if (test::is_sanitized) return;  // Sanitizers find no more in a third run.
    const json one = json::parse(workplace.run(line + " --threads 1").out);
    EXPECT_EQ(one["experiments"][0]["measurements"],
              json::parse(first.out)["experiments"][0]["measurements"]);
    EXPECT_EQ(workplace.outputs(), "") << "nothing is written unless asked for";
}

TEST(AccuracyRun, InterruptedWhileItMeasuresLeavesNoHalfReport) {
    const Workplace workplace;
    // The rounds take longer than the time to the signal, and the folder is created first.
    const ProgramResult result = test::run_program_until(
        {"relief-accuracy", "run", "storage", "--repeats", "1000", "--output", "out/report",
         "--quiet"},
        workplace / ".", [&] { return std::filesystem::exists(workplace / "out/report"); }, SIGINT);
    EXPECT_EQ(result.exit_code, 128 + SIGINT) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_TRUE(std::filesystem::is_empty(workplace / "out/report"));
}

TEST(AccuracyRefusal, IsOneLine) {
    const Workplace workplace;
    workplace.write("taken", "a file");
    expect_refusals(
        workplace, "relief-accuracy", "old",
        {{"relief-accuracy run", 2, "SUBJECT is missing"},
         {"relief-accuracy run colour", 2, "colour: not one of all, "},
         {"relief-accuracy run storage all", 2, "all: includes the other subjects"},
         {"relief-accuracy run storage storage", 2, "storage: given twice"},
         {"relief-accuracy run storage --repeats 2", 2, "--repeats 2: not between 3 and 1000"},
         {"relief-accuracy run storage --repeats 5 --no-times", 2,
          "--no-times and --repeats contradict each other"},
         {"relief-accuracy run storage --json --quiet", 2,
          "--json and --quiet contradict each other"},
         {"relief-accuracy run storage --quiet", 2,
          "--quiet without --output would discard the results"},
         {"relief-accuracy run storage --output taken", 1, "taken: exists, but is not a folder"}});
}

/// Returns the error of a method in a report.
const json& error_of(const json& experiment, const std::string& method) {
    for (const json& one : experiment["measurements"]) {
        if (one["method"] == method) return one["error"];
    }
    throw std::runtime_error("no method " + method);
}

/// Runs `relief-accuracy own` quickly and without times.
ProgramResult own(const Workplace& workplace, const std::string& arguments) {
    return workplace.run("relief-accuracy own " + arguments + " --quick --no-times");
}

/// The same; returns the JSON of the report.
json own_report(const Workplace& workplace, const std::string& arguments) {
    const ProgramResult result = own(workplace, arguments + " --json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return json::parse(result.out);
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, MeasuresAMeshAndRecommends) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result = own(workplace, "square.obj --truth surface");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("square.obj: a mesh"));
    EXPECT_THAT(result.out, HasSubstr("own/square.obj/normals"));
    EXPECT_THAT(result.out, HasSubstr("no recommendation: the mesh is too coarse"));
    EXPECT_THAT(result.out, HasSubstr("To do it: relief-mesh process square.obj"));
    EXPECT_EQ(workplace.outputs(), "") << "nothing is written unless asked for";
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, JsonHoldsTheCommandThatRepeatsIt) {
    const Workplace workplace;
    workplace.write_square("a square.obj");
    const json report = json::parse(
        own(workplace, "'a square.obj' --crease 30 --max-error 5 --json --threads 2").out);
    EXPECT_EQ(report["command"],
              "relief-accuracy own 'a square.obj' --crease 30 --max-error 5 --quick --no-times "
              "--threads 2");
    EXPECT_EQ(report["experiments"][0]["command"], report["command"]);
    EXPECT_EQ(report["experiments"][1]["id"], "own/a square.obj/tangents");
    EXPECT_NEAR(error_of(report["experiments"][1], "mikktspace")["max"].get<double>(), 0.0, 1e-4);
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, DistinguishesHeightsFromNormals) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    const ProgramResult heights = own(workplace, "bricks.png --strength 4");
    ASSERT_EQ(heights.exit_code, 0) << heights.error;
    EXPECT_THAT(heights.out, HasSubstr("bricks.png: a height map of "));
    EXPECT_THAT(heights.out, HasSubstr("(if not: --image normals)"));
    EXPECT_THAT(heights.out, HasSubstr("To do it: relief-bake bump bricks.png OUT."));
    ASSERT_EQ(workplace.run("relief-bake bump bricks.png out/normals.png --strength 4").exit_code,
              0);
    const ProgramResult normals = own(workplace, "out/normals.png");
    EXPECT_THAT(normals.out, HasSubstr("out/normals.png: a normal map of 16 bits"));
    EXPECT_THAT(normals.out, HasSubstr("(if not: --image heights)"));
    const ProgramResult told = own(workplace, "out/normals.png --image heights");
    EXPECT_THAT(told.out, HasSubstr("a height map of 16 bits"));
    EXPECT_THAT(told.out, Not(HasSubstr("if not:")));
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, NeedsHighAndLowForAPair) {
    const Workplace workplace;
    workplace.write_square("high.obj");
    workplace.write_square("low.obj");
    const json report = own_report(workplace, "--high high.obj --low low.obj --size 16");
    EXPECT_EQ(report["experiments"].size(), 1U);
    EXPECT_EQ(report["experiments"][0]["subject"], "bake");
    EXPECT_LE(error_of(report["experiments"][0], "1 sample, 16 bit")["max"].get<double>(), 0.01);
    EXPECT_EQ(own_report(workplace, "high.obj low.obj")["experiments"].size(), 8U);
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, JpegFilesHaveAnUnknownError) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    const Image heights = read_image(workplace / "bricks.png", ImageUse::data);
    Image coarse = make_image(heights.width, heights.height, 1, 8, ColorSpace::data);
    for (std::size_t i = 0; i < coarse.sample_count(); ++i)
        coarse.as<std::uint8_t>()[i] =
            static_cast<std::uint8_t>(heights.as<std::uint16_t>()[i] / 257U);
    write_image(workplace / "bricks.jpg", coarse);
    const ProgramResult result = own(workplace, "bricks.jpg");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("and the unknown loss of the file's JPEG compression"));
    EXPECT_THAT(result.out, Not(HasSubstr("expected")));
    const ProgramResult bounded = own(workplace, "bricks.jpg --max-error 90");
    EXPECT_EQ(bounded.exit_code, 1);
    EXPECT_THAT(bounded.out, HasSubstr("no method is known to be within 90 degrees (99 %)"));
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, UnreachableLimitExitsWith1) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    EXPECT_EQ(own(workplace, "bricks.png --max-error 90").exit_code, 0);
    const ProgramResult strict = own(workplace, "bricks.png --max-error 0");
    EXPECT_EQ(strict.exit_code, 1);
    EXPECT_THAT(strict.out,
                HasSubstr("no method is within 0 degrees (99 %): the smallest error is "));
}

/// Returns heights of smooth bumps, 0 to 1.
double bump_at(int x, int y) {
    return 0.5 + 0.2 * std::sin(0.2 * x) + 0.2 * std::sin(0.15 * y + 0.1 * x);
}

Image image_of_bumps(int channels, const std::function<double(int channel, double bump)>& value) {
    constexpr int side = 64;
    Image image = make_image(side, side, channels, 8, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            for (int channel = 0; channel < channels; ++channel) {
                image.as<std::uint8_t>()[static_cast<std::size_t>((y * side + x) * channels +
                                                                  channel)] =
                    static_cast<std::uint8_t>(255.0 * value(channel, bump_at(x, y)));
            }
        }
    }
    return image;
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, WarnsAboutPhotographs) {
    const Workplace workplace;
    const auto in_color = [](int channel, double bump) {
        return channel == 0 ? bump : channel == 1 ? bump * bump : 0.2;
    };
    write_image(workplace / "photo.png", image_of_bumps(3, in_color));
    const ProgramResult photo = own(workplace, "photo.png");
    ASSERT_EQ(photo.exit_code, 0) << photo.error;
    EXPECT_THAT(photo.out, HasSubstr("photo.png: a height map of 8 bits"));
    EXPECT_THAT(photo.out, HasSubstr("findings  4096 x texel whose red, green and blue differ"));
    const json found = own_report(workplace, "photo.png");
    EXPECT_EQ(found["experiments"][0]["input_findings"].size(), 1U);
    write_image(workplace / "gray.png", image_of_bumps(3, [](int, double bump) { return bump; }));
    EXPECT_THAT(own(workplace, "gray.png").out, HasSubstr("findings  none\n"));
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, MeasuresHeightsInAlpha) {
    const Workplace workplace;
    const auto in_alpha = [](int channel, double bump) {
        return channel == 3 ? bump : channel == 0 ? 0.9 : 0.3;
    };
    write_image(workplace / "packed.png", image_of_bumps(4, in_alpha));
    write_image(workplace / "alone.png", image_of_bumps(1, [](int, double bump) { return bump; }));
    const json blind = own_report(workplace, "packed.png --image heights")["experiments"][0];
    EXPECT_THAT(blind["input_findings"].dump(),
                HasSubstr("texel whose alpha differs from the first one's"));
    const json packed = own_report(workplace, "packed.png --channel alpha --image heights");
    const json& in_packed = packed["experiments"][0];
    const json alone = own_report(workplace, "alone.png --image heights")["experiments"][0];
    EXPECT_EQ(packed["command"],
              "relief-accuracy own packed.png --image heights --channel alpha --quick --no-times");
    EXPECT_TRUE(in_packed["input_findings"].empty());
    // The heights of a packed map are floats, so rounding differs.
    const std::string method = "sobel3, float64, 16 bit";
    EXPECT_NEAR(error_of(in_packed, method)["rms"].get<double>(),
                error_of(alone, method)["rms"].get<double>(), 1e-4);
    EXPECT_GT(error_of(alone, method)["rms"].get<double>(), 1e-3);
    const auto finding = in_packed["finding"].get<std::string>();
    EXPECT_THAT(finding, HasSubstr(" --channel alpha"));
    const std::string command = finding.substr(finding.find("relief-bake bump packed.png OUT."));
    const std::string extension = command.substr(command.find("OUT.") + 3, 4);
    const std::string done =
        std::string(command).replace(command.find("OUT."), 7, "out" + extension);
    EXPECT_EQ(workplace.run(done).exit_code, 0) << done;
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, ReportsNonFiniteHeights) {
    const Workplace workplace;
    Image heights = to_float(image_of_bumps(1, [](int, double bump) { return bump; }));
    heights.as<float>()[70] = std::numeric_limits<float>::quiet_NaN();
    heights.as<float>()[900] = std::numeric_limits<float>::infinity();
    write_image(workplace / "nan.exr", heights);
    const ProgramResult result = own(workplace, "nan.exr");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr("findings  2 x non-finite height (column 6, row 1; column 4, row 14): "));
}

TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, CanKeepANormalMapUnchanged) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    ASSERT_EQ(workplace.run("relief-bake bump bricks.png map.png --bits 8").exit_code, 0);
    const json experiment = own_report(workplace, "map.png")["experiments"][0];
    EXPECT_EQ(error_of(experiment, "as it is")["max"], 0.0);
    EXPECT_EQ(experiment["measurements"][0]["cost"]["stored_bytes"], 3.0);
    const auto finding = experiment["finding"].get<std::string>();
    EXPECT_THAT(finding, testing::StartsWith("as it is: "));
    EXPECT_THAT(finding, testing::EndsWith("To do it: relief-bake convert map.png OUT.png"));
    ASSERT_EQ(workplace.run("relief-bake convert map.png out.png").exit_code, 0);
    EXPECT_TRUE(read_image(workplace / "out.png", ImageUse::data).samples ==
                read_image(workplace / "map.png", ImageUse::data).samples);
}

/// On constant heights, the distance of a view from its point on the surface is the depth there
/// times the tangent of the angle.
TEST_LABELS(not_sanitized);
TEST(AccuracyOwn, MeasuresReliefMappingBetweenTwoAngles) {
    const Workplace workplace;
    Image heights = make_image(16, 16, 1, 8, ColorSpace::data);
    for (std::uint8_t& code : heights.as<std::uint8_t>())
        code = 51;  // A fifth: of 10 texels, 8 are left.
    write_image(workplace / "flat.png", heights);
    const auto measured = [&](const std::string& angles) {
        return own_report(workplace,
                          "flat.png --image heights --height-depth 10 --view-angles " + angles);
    };
    const json at_60 = measured("60,60");
    EXPECT_EQ(at_60["command"],
              "relief-accuracy own flat.png --image heights --height-depth 10 --view-angles 60,60 "
              "--quick --no-times");
    ASSERT_EQ(at_60["experiments"].size(), 2U);
    const json& relief = at_60["experiments"][1];
    EXPECT_EQ(relief["id"], "own/flat.png/relief");
    EXPECT_EQ(relief["input"],
              "16 x 16 texels, 10 deep, on a plane; 60 to 60 degrees from its normal");
    // Distances are stored as floats.
    for (const char* kind : {"rms", "mean", "p99", "max"})
        EXPECT_NEAR(error_of(relief, "normal map")[kind].get<double>(), 8.0 * std::sqrt(3.0), 1e-6);
    EXPECT_EQ(error_of(relief, "normal map")["count"], 2000);
    EXPECT_EQ(error_of(relief, "parallax")["max"], 0.0);
    EXPECT_EQ(error_of(relief, "maximum mipmaps")["max"], 0.0);
    // Between two angles, the mean is that of the tangent: ln(cos A / cos B) / (B - A).
    const json between = measured("30,60")["experiments"][1];
    const double mean = 8.0 * std::log(std::sqrt(3.0)) / (std::numbers::pi / 6.0);
    EXPECT_NEAR(error_of(between, "normal map")["mean"].get<double>(), mean, 0.2);
    EXPECT_LE(error_of(between, "normal map")["max"].get<double>(), 8.0 * std::sqrt(3.0));
    EXPECT_EQ(error_of(measured("0,0")["experiments"][1], "normal map")["max"], 0.0);
    // Where heights change, parallax has an error, which grows with the angle.
    workplace.write_bricks("bricks.png");
    const auto of_parallax = [&](const std::string& angles) {
        const json report =
            own_report(workplace, "bricks.png --height-depth 12 --view-angles " + angles);
        const json& bricks = report["experiments"][1];
        EXPECT_EQ(error_of(bricks, "maximum mipmaps")["max"], 0.0);
        return error_of(bricks, "parallax")["rms"].get<double>();
    };
    const double steep = of_parallax("0,30");
    EXPECT_NEAR(steep, 0.26, 0.05);  // Of 2,000 rays on a corner of the bricks.
    EXPECT_GT(of_parallax("60,80"), 10.0 * steep);
}

TEST(OwnRefusal, NamesWrongDepthsAndAngles) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write_bricks("h.png");
    const std::string angles = "not two ascending angles within 0 to 89";
    const std::string own = "relief-accuracy own h.png --height-depth 8 --view-angles ";
    expect_refusals(workplace, "relief-accuracy", "old",
                    {{own + "60,45", 2, "--view-angles 60,45: " + angles},
                     {own + "45,90", 2, "--view-angles 45,90: " + angles},
                     {own + "-5,20", 2, "--view-angles -5,20: " + angles},
                     {own + "45", 2, "--view-angles 45: " + angles},
                     {own + "45,60,70", 2, "--view-angles 45,60,70: " + angles},
                     {own + "steep,60", 2, "--view-angles steep,60: 'steep': not a number"},
                     {"relief-accuracy own h.png --view-angles 45,60", 2,
                      "--view-angles: applies only to relief mapping, --height-depth"},
                     {"relief-accuracy own h.png --height-depth 0", 2,
                      "--height-depth 0: not between 0.01 and 16384 texels"},
                     {"relief-accuracy own square.obj --height-depth 8", 2,
                      "--height-depth: applies only to height maps"},
                     {"relief-accuracy own h.png --image normals --height-depth 8", 2,
                      "--height-depth: applies only to height maps"}});
}

TEST(OwnRefusal, IsOneLine) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_refusals(workplace, "relief-accuracy", "old",
                    {{"relief-accuracy own", 2,
                      "no input (name a mesh, a map, or --high and "
                      "--low)"},
                     {"relief-accuracy own --high square.obj", 2,
                      "--high: requires the other mesh of the pair (give --low FILE)"},
                     {"relief-accuracy own square.obj square.obj", 2, "square.obj: given twice"},
                     {"relief-accuracy own square.obj --strength 3", 2,
                      "--strength: applies only to height maps"},
                     {"relief-accuracy own square.obj --channel alpha", 2,
                      "--channel: applies only to height maps"},
                     {"relief-accuracy own square.obj --size 64", 2,
                      "--size: applies only to a pair, --high and --low"},
                     {"relief-accuracy own square.obj --max-error-kind max", 2,
                      "--max-error-kind: has no effect without --max-error (give --max-error DEG)"},
                     {"relief-accuracy own square.obj --no-times --max-time 3", 2,
                      "--no-times and --max-time contradict each other"},
                     {"relief-accuracy own other.obj --truth file --no-times", 1,
                      "other.obj: the mesh has no normals to compare with"},
                     {"relief-accuracy own --high square.obj --low other.obj --no-times", 1,
                      "other.obj: no texture coordinates for the map"}});
}

}  // namespace
}  // namespace relief::tools
