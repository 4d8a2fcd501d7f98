// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake bump: written maps, automatic choices, limits of the error, and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/height_march.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

using nlohmann::json;
using test::degrees_between;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

constexpr int small_side = 16;

/// Writes 16-bit heights that rise by `step` per column; row 0 is at the top.
void write_ramp(const Workplace& workplace, const std::string& name, bool upwards, int step) {
    Image image = make_image(small_side, small_side, 1, 16, ColorSpace::data);
    const auto samples = image.as<std::uint16_t>();
    for (int y = 0; y < small_side; ++y) {
        for (int x = 0; x < small_side; ++x) {
            const int height = upwards ? small_side - 1 - y : x;
            samples[static_cast<std::size_t>(y * small_side + x)] =
                static_cast<std::uint16_t>(height * step);
        }
    }
    write_image(workplace / name, image);
}

/// Reads the normal in the middle of a map.
glm::dvec3 middle_normal(const std::filesystem::path& file, Green green) {
    Report report;
    const Image normals =
        decode_normal_map(read_image(file, ImageUse::data), green, FlatCode::half, report);
    const std::size_t texel = (small_side / 2 * small_side + small_side / 2) * 3;
    const auto samples = normals.as<float>();
    return {samples[texel], samples[texel + 1], samples[texel + 2]};
}

/// Rounding of 16-bit codes as an angle: half a code of 1/32767 in each component.
constexpr double shown_degrees_of_16_bit = 0.005;

TEST(BumpCommand, StoresTheSlopeOfTheStrength) {
    const Workplace workplace;
    // 65535 / 257 = 255 steps of 1/255 each; with strength 255 the slope is 1.
    write_ramp(workplace, "ramp.png", false, 257);
    const ProgramResult result = workplace.run(
        "relief-bake bump ramp.png out/normal.png --strength 255 --wrap clamp --kernel sobel3");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out,
                HasSubstr("read      ramp.png: 16 x 16, 1 channel, 16 bit\nslopes    sobel3, "
                          "strength 255 texels, clamp at the border\nformat    16 bit, zero at "
                          "32767.5 of 65535 (the decoding of glTF and engines; flat texels have an "
                          "error of 0.0012 degrees), green up\nfindings  none\n"));
    EXPECT_LT(degrees_between(middle_normal(workplace / "out/normal.png", Green::up), {-1, 0, 1}),
              shown_degrees_of_16_bit);
    EXPECT_EQ(workplace.outputs(), "normal.png");
}

TEST(BumpCommand, GreenDownIsTheMirrorOfGreenUp) {
    const Workplace workplace;
    write_ramp(workplace, "ramp.png", true, 257);
    for (const std::string green : {"up", "down"}) {
        const ProgramResult result =
            workplace.run("relief-bake bump ramp.png out/" + green +
                          ".png --strength 255 --wrap clamp --green " + green);
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
    // Heights grow upwards in the image, so the normals point down.
    const glm::dvec3 looks_down{0, -1, 1};
    EXPECT_LT(degrees_between(middle_normal(workplace / "out/up.png", Green::up), looks_down),
              shown_degrees_of_16_bit);
    EXPECT_LT(degrees_between(middle_normal(workplace / "out/down.png", Green::down), looks_down),
              shown_degrees_of_16_bit);
    EXPECT_EQ(read_image_info(workplace / "out/up.png").metadata.at("relief:green"), "up");
    EXPECT_EQ(read_image_info(workplace / "out/down.png").metadata.at("relief:green"), "down");
}

TEST(BumpCommand, AConstantMapIsExactlyFlatInEveryDepth) {
    const Workplace workplace;
    write_image(workplace / "flat.png", make_image(4, 3, 1, 8, ColorSpace::data));
    for (const std::string output : {"a.png --bits 8", "b.png", "c.tif --bits 32", "d.exr"}) {
        const ProgramResult result = workplace.run("relief-bake bump flat.png out/" + output);
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
    EXPECT_EQ(read_image(workplace / "out/a.png", ImageUse::data).bits(), 8);
    EXPECT_EQ(read_image(workplace / "out/b.png", ImageUse::data).bits(), 16);
    EXPECT_EQ(read_image(workplace / "out/c.tif", ImageUse::data).bits(), 32);
    EXPECT_EQ(read_image(workplace / "out/d.exr", ImageUse::data).bits(), 32);
    for (const char* name : {"out/a.png", "out/b.png", "out/c.tif", "out/d.exr"}) {
        Report report;
        const Image normals =
            decode_normal_map(read_image(workplace / name, ImageUse::data), Green::up,
                              FlatCode::half, report, FlatTexels::exact);
        for (std::size_t i = 0; i < normals.sample_count(); ++i)
            ASSERT_EQ(normals.as<float>()[i], i % 3 == 2 ? 1.0F : 0.0F) << name;
    }
}

TEST(BumpCommand, EveryKernelGivesTheSameDepth) {
    const Workplace workplace;
    write_ramp(workplace, "ramp.png", false, 257);
    for (const std::string kernel :
         {"forward", "central3", "prewitt3", "sobel3", "scharr3", "sobel5", "scharr5", "central5",
          "central7", "gaussian", "gaussian --kernel-radius 4"}) {
        const ProgramResult result = workplace.run(
            "relief-bake bump ramp.png out/n.png --strength 255 --wrap clamp --kernel " + kernel);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_LT(degrees_between(middle_normal(workplace / "out/n.png", Green::up), {-1, 0, 1}),
                  shown_degrees_of_16_bit)
            << kernel;
    }
}

TEST(BumpCommand, HeightAndTexelSizeHaveTheSameUnitAndDifferPerAxis) {
    const Workplace workplace;
    write_ramp(workplace, "ramp.png", false, 257);
    // A step is 0.51 m / 255 = 2 mm over texels that are 4 mm wide: the slope is 0.5.
    const ProgramResult result = workplace.run(
        "relief-bake bump ramp.png out/n.png --height 0.51 --texel-size 0.004x0.5 --wrap clamp "
        "--kernel sobel3 --report out/report.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(
        result.out,
        HasSubstr(
            "slopes    sobel3, height 0.51 over texels of 0.004 x 0.5, clamp at the border\n"));
    EXPECT_LT(degrees_between(middle_normal(workplace / "out/n.png", Green::up), {-0.5, 0, 1}),
              shown_degrees_of_16_bit);
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(report["strength"], 0.51);
    EXPECT_EQ(report["texel_size"], json({0.004, 0.5}));
    EXPECT_EQ(report["kernel_radius"], nullptr);
}

TEST(BumpCommand, EachAxisHasABorderMode) {
    const Workplace workplace;
    write_ramp(workplace, "ramp.png", false, 257);
    const auto left_normal = [&](const std::string& wrap) {
        const ProgramResult result = workplace.run(
            "relief-bake bump ramp.png out/n.png --strength 255 --kernel central3 --report "
            "out/report.json --wrap " +
            wrap);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        EXPECT_EQ(json::parse(workplace.read("out/report.json"))["wrap"], wrap);
        Report report;
        const Image map = decode_normal_map(read_image(workplace / "out/n.png", ImageUse::data),
                                            Green::up, FlatCode::half, report);
        return glm::dvec3(map.as<float>()[0], map.as<float>()[1], map.as<float>()[2]);
    };
    // The slope of the ramp is 1; across the seam it falls by 15 - 1 over 2 texels.
    EXPECT_LT(degrees_between(left_normal("clamp,repeat"), {-1, 0, 1}), shown_degrees_of_16_bit);
    EXPECT_LT(degrees_between(left_normal("repeat,clamp"), {7, 0, 1}), shown_degrees_of_16_bit);
    EXPECT_LT(degrees_between(left_normal("mirror,clamp"), {-0.5, 0, 1}), shown_degrees_of_16_bit);
}

TEST(BumpCommand, WrapAutoReportsTheSeams) {
    const Workplace workplace;
    write_ramp(workplace, "ramp.png", false, 257);
    const ProgramResult ramp =
        workplace.run("relief-bake bump ramp.png out/n.png --wrap auto --report out/report.json");
    ASSERT_EQ(ramp.exit_code, 0) << ramp.error;
    EXPECT_THAT(ramp.out, HasSubstr("clamp,repeat at the border (differences across the seams are "
                                    "15 and 0 times those inside)\n"));
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(report["wrap"], "clamp,repeat");
    EXPECT_NEAR(report["seams"][0].get<double>(), 15.0, 1e-9);
    EXPECT_EQ(report["seams"][1], 0.0);
    const ProgramResult bricks =
        workplace.run("relief-bake bump data/bricks-height.png out/b.png --wrap auto");
    EXPECT_THAT(bricks.out, HasSubstr(" repeat at the border (differences across"));
    const ProgramResult half =
        workplace.run("relief-bake bump ramp.png out/n.png --wrap mirror,auto");
    EXPECT_THAT(half.out, HasSubstr(" mirror,repeat at the border (differences across"));
}

TEST(BumpCommand, NegativeStrengthTurnsBumpsIntoDents) {
    const Workplace workplace;
    write_ramp(workplace, "ramp.png", false, 257);
    ASSERT_EQ(workplace.run("relief-bake bump ramp.png out/n.png --strength -255").exit_code, 0);
    EXPECT_LT(degrees_between(middle_normal(workplace / "out/n.png", Green::up), {1, 0, 1}),
              shown_degrees_of_16_bit);
}

TEST(BumpCommand, ANaNTexelIsAFindingAndStrictExitsWith3) {
    const Workplace workplace;
    Image image = make_image(8, 8, 1, 32, ColorSpace::data);
    image.as<float>()[27] = std::numeric_limits<float>::quiet_NaN();
    write_image(workplace / "nan.exr", image);
    const std::string line =
        "relief-bake bump nan.exr out/n.png --kernel sobel3 --report out/report.json";
    const ProgramResult lenient = workplace.run(line);
    EXPECT_EQ(lenient.exit_code, 0) << lenient.error;
    const json report = json::parse(workplace.read("out/report.json"));
    ASSERT_EQ(report["findings"].size(), 1U);
    EXPECT_EQ(report["findings"][0]["first"], json({27}));
    EXPECT_EQ(report["bits"], 16);
    EXPECT_EQ(report["kernel"], "sobel3");

    const ProgramResult strict = workplace.run(line + " --strict --quiet");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_EQ(strict.error,
              "relief-bake: warning: nan.exr: 1 finding (exit code 3, because of --strict)\n");
    EXPECT_EQ(strict.out, "");
}

TEST(BumpCommand, OutputDoesNotDependOnThreads) {
    const Workplace workplace;
    for (const std::string threads : {"1", "2"}) {
        ASSERT_EQ(workplace
                      .run("relief-bake bump data/bricks-height.png out/" + threads +
                           ".png --threads " + threads)
                      .exit_code,
                  0);
    }
    EXPECT_EQ(workplace.read("out/1.png"), workplace.read("out/2.png"));
}

TEST(BumpCommand, ConvertsARealFloatMap) {
    RELIEF_NEEDS_SHARED(mountain, "data/textures/height_only/mountain1_256_float.exr");
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-bake bump " + mountain.string() + " out/m.exr --strength 60");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("256 x 256, 1 channel, 32 bit"));
    EXPECT_THAT(result.out, HasSubstr("format    32 bit float, green up"));
}

/// Adds up all normals of a map.
glm::dvec3 mean_normal(const std::filesystem::path& file) {
    Report report;
    const Image normals =
        decode_normal_map(read_image(file, ImageUse::data), Green::up, FlatCode::half, report);
    glm::dvec3 sum{};
    for (std::size_t i = 0; i < normals.sample_count(); ++i)
        sum[static_cast<int>(i % 3)] += static_cast<double>(normals.as<float>()[i]);
    return sum;
}

TEST(BumpCommand, DitheredMapsHaveTheCorrectMean) {
    const Workplace workplace;
    write_ramp(workplace, "ramp.png", false, 257);
    // A slope of 0.355 has no exact 8-bit code.
    const glm::dvec3 ground_truth(-0.355, 0, 1);
    const std::string line =
        "relief-bake bump ramp.png out/n.png --strength 90.525 --wrap clamp --bits 8";
    ASSERT_EQ(workplace.run(line).exit_code, 0);
    EXPECT_GT(degrees_between(mean_normal(workplace / "out/n.png"), ground_truth), 0.1);
    for (const std::string dither : {"ordered", "blue-noise"}) {
        const ProgramResult result = workplace.run(line + " --dither " + dither);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_THAT(result.out, HasSubstr("format    8 bit, zero at 127.5 of 255 (the decoding of "
                                          "glTF and engines), green up, dithered " +
                                          dither + "\n"));
        EXPECT_LT(degrees_between(mean_normal(workplace / "out/n.png"), ground_truth), 0.02);
    }
}

TEST(BumpCommand, HalfFloatsAreSmallerAndHaveElevenBits) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    const std::string line = "relief-bake bump bricks.png out/";
    ASSERT_EQ(workplace.run(line + "float.exr").exit_code, 0);
    ASSERT_EQ(workplace.run(line + "half.exr --half").exit_code, 0);
    EXPECT_LT(std::filesystem::file_size(workplace / "out/half.exr"),
              std::filesystem::file_size(workplace / "out/float.exr") * 6 / 10);
    const Image exact = read_image(workplace / "out/float.exr", ImageUse::data);
    const Image half = read_image(workplace / "out/half.exr", ImageUse::data);
    for (std::size_t i = 0; i < exact.sample_count(); ++i)
        ASSERT_NEAR(half.as<float>()[i], exact.as<float>()[i], 0x1p-12);
    EXPECT_THAT(workplace.run(line + "moments.exr --slope-moments --half").out,
                HasSubstr("slope moments, 32 bit float, dh/dy up, half floats\n"));
}

TEST(BumpCommand, ConeMapsHoldHeightsAndCones) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    const ProgramResult run = workplace.run(
        "relief-bake bump bricks.png out/n.png --wrap repeat --cone-map out/cones.png "
        "--report out/report.json");
    ASSERT_EQ(run.exit_code, 0) << run.error;
    EXPECT_THAT(run.out, HasSubstr("out/cones.png: "));
    EXPECT_THAT(workplace.read("out/report.json"), HasSubstr("\"cone_map\": \"out/cones.png\""));
    const Image heights = read_image(workplace / "bricks.png", ImageUse::data);
    const Image cones = read_image(workplace / "out/cones.png", ImageUse::data);
    EXPECT_EQ(cones.samples,
              relaxed_cones(HeightField(height_field(heights), Wrap::repeat), 16).samples);
    // With the cones of another border mode, rays across the border may pass by a hit.
    ASSERT_EQ(workplace
                  .run("relief-bake bump bricks.png out/n.png --wrap clamp --cone-map "
                       "out/clamped.tif")
                  .exit_code,
              0);
    EXPECT_NE(read_image(workplace / "out/clamped.tif", ImageUse::data).samples, cones.samples);
}

TEST(BumpCommand, EveryCompressionEffortWritesTheSameImage) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    const std::string line = "relief-bake bump bricks.png out/";
    for (const std::string effort : {"normal.png", "fast.png --fast", "small.png --small"})
        ASSERT_EQ(workplace.run(line + effort).exit_code, 0);
    const Image normal = read_image(workplace / "out/normal.png", ImageUse::data);
    for (const char* name : {"out/fast.png", "out/small.png"})
        EXPECT_EQ(read_image(workplace / name, ImageUse::data).samples, normal.samples);
}

TEST(BumpCommand, InvertTurnsBumpsIntoDentsAndChannelsAreChosen) {
    const Workplace workplace;
    // Red rises and green falls to the right, by 257 / 65535 per texel.
    Image image = make_image(small_side, small_side, 3, 16, ColorSpace::data);
    for (std::size_t i = 0; i < small_side * small_side; ++i) {
        const auto x = static_cast<int>(i % small_side);
        image.as<std::uint16_t>()[3 * i] = static_cast<std::uint16_t>(257 * x);
        image.as<std::uint16_t>()[3 * i + 1] = static_cast<std::uint16_t>(257 * (small_side - x));
    }
    write_image(workplace / "h.tif", image);
    const auto slope = [&](const std::string& options) {
        const ProgramResult result = workplace.run(
            "relief-bake bump h.tif out/n.exr --strength 255 --wrap clamp " + options);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        const std::vector<float> samples = std::get<std::vector<float>>(
            read_image(workplace / "out/n.exr", ImageUse::data).samples);
        const std::size_t texel = (small_side / 2 * small_side + small_side / 2) * 3;
        return (1.0 - 2.0 * static_cast<double>(samples[texel])) /
               (2.0 * static_cast<double>(samples[texel + 2]) - 1.0);
    };
    EXPECT_NEAR(slope("--channel red"), 1.0, 1e-5);
    EXPECT_NEAR(slope("--channel green"), -1.0, 1e-5);
    EXPECT_NEAR(slope(""), 0.0, 1e-5) << "the mean is constant";
    EXPECT_NEAR(slope("--channel red --invert"), -1.0, 1e-5);
}

TEST(BumpCommand, ReportsOmittedChannelsAndKeptAlpha) {
    const Workplace workplace;
    Image image = make_image(4, 4, 2, 8, ColorSpace::data);
    for (std::size_t i = 0; i < 16; ++i)
        image.as<std::uint8_t>()[2 * i + 1] = i < 3 ? 0 : 255;
    write_image(workplace / "h.png", image);
    const ProgramResult result =
        workplace.run("relief-bake bump h.png out/n.png --xy --alpha keep --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("2 channels, 8 bit, 3 transparent texels left flat\n"));
    EXPECT_THAT(result.out, HasSubstr("green up, without z, alpha kept\n"));
    EXPECT_EQ(read_image_info(workplace / "out/n.png").channels, 4);
    const json report = json::parse(workplace.read("out/r.json"));
    EXPECT_EQ(report["transparent"], 3);
    EXPECT_EQ(report["by_rows"], false);
    EXPECT_EQ(report["xy_only"], true);
    EXPECT_EQ(report["alpha"], "keep");
}

TEST(BumpCommand, ConvertsManyMapsAndTilesInOneCall) {
    const Workplace workplace;
    write_ramp(workplace, "a.png", false, 257);
    write_ramp(workplace, "b.1001.tif", true, 257);
    write_ramp(workplace, "b.1002.tif", true, 514);
    workplace.write("bad.png", "this is no image");
    const ProgramResult result = workplace.run(
        "relief-bake bump a.png bad.png 'b.<UDIM>.tif' -o out/maps/ --strength 255 --wrap clamp "
        "--kernel sobel3 --report out/r.json");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, testing::StartsWith("relief-bake: error: bad.png: "));
    EXPECT_THAT(result.out,
                testing::MatchesRegex(
                    "out/maps/a.png: 16 x 16, sobel3, no findings, [^\n]*\nout/maps/b.1001.tif: "
                    "[^\n]*\nout/maps/b.1002.tif: [^\n]*\nin all    4 files, 1 failed\n"));
    const glm::dvec3 steep = middle_normal(workplace / "out/maps/b.1002.tif", Green::up);
    EXPECT_LT(degrees_between(steep, glm::dvec3(0.0, -2.0, 1.0)), shown_degrees_of_16_bit);
    const json report = json::parse(workplace.read("out/r.json"));
    EXPECT_EQ(report["tool"], "relief-bake bump");
    EXPECT_EQ(report["failed"], 1);
    ASSERT_EQ(report["files"].size(), 4U);
    EXPECT_EQ(report["files"][0]["kernel"], "sobel3");
    EXPECT_EQ(report["files"][2]["output"], "out/maps/b.1001.tif");
}

TEST(BumpCommand, AMapKeepsItsNameInAFolderIfTheFormatStoresNormals) {
    const Workplace workplace;
    write_image(workplace / "a.jpg", make_image(4, 3, 1, 8, ColorSpace::data));
    ASSERT_EQ(workplace.run("relief-bake bump a.jpg -o out/").exit_code, 0);
    EXPECT_EQ(workplace.outputs(), "a.png");
}

TEST(BakeRefusal, ExplainsAndLeavesNoFiles) {
    const Workplace workplace;
    write_image(workplace / "flat.png", make_image(4, 3, 1, 8, ColorSpace::data));
    workplace.write("noise.png", "this is no image");
    expect_refusals(
        workplace, "relief-bake", "old.png",
        {{"relief-bake bump missing.png out/old.png", 1, "missing.png: "},
         {"relief-bake bump noise.png out/old.png", 1, "noise.png: "},
         {"relief-bake bump out out/old.png", 1, "out: "},
         {"relief-bake bump flat.png nowhere/n.png", 1, "nowhere/n.png: "},
         {"relief-bake bump flat.png out/n.jpg", 2,
          "out/n.jpg: JPEG compression distorts normals (use .png, .tif, .exr, .ktx2 or .dds)"},
         {"relief-bake bump flat.png out/n.hdr", 2, "out/n.hdr: "},
         {"relief-bake bump flat.png out/n", 2,
          "out/n: the format cannot store a normal map (use .png, .tif, .exr, .ktx2 or .dds)"},
         {"relief-bake bump flat.png out/n.png --bits 32", 2, "--bits 32: .png holds 16 or 8 bits"},
         {"relief-bake bump flat.png out/n.exr --bits 16", 2,
          "--bits 16: .exr holds 32 bits (--half stores half floats)"},
         {"relief-bake bump flat.png out/n.png --bits 12", 2, "--bits 12: not one of 8, 16, 32"},
         {"relief-bake bump flat.png out/n.exr --zero-code 127.5", 2,
          "--zero-code: has no effect on 32-bit output, where zero is exact"},
         {"relief-bake bump flat.png out/n.exr --dither ordered", 2,
          "--dither: has no effect on 32-bit output, which is not rounded to codes"},
         {"relief-bake bump flat.png out/n.png --half", 2, "--half: is for .exr, not n.png"},
         {"relief-bake bump flat.png out/n.png --fast --small", 2,
          "--fast, --small: contradict each other"},
         {"relief-bake bump flat.png out/n.png --strength abc", 2, "--strength abc: not a number"},
         {"relief-bake bump flat.png out/n.png --strength 1e31", 2,
          "--strength 1e31: not between -1e+30 and 1e+30"},
         {"relief-bake bump flat.png out/n.png --kernel sobel", 2,
          "--kernel sobel: not one of auto, forward, central3, prewitt3, sobel3, scharr3, sobel5, "
          "scharr5, central5, central7, gaussian"},
         {"relief-bake bump flat.png out/n.png --kernel-radius 3", 2,
          "--kernel-radius: has no effect without --kernel gaussian"},
         {"relief-bake bump flat.png out/n.png --kernel gaussian --kernel-radius 65", 2,
          "--kernel-radius 65: "},
         {"relief-bake bump flat.png out/n.png --wrap repeat,tile", 2,
          "--wrap repeat,tile: not one of repeat, clamp, mirror, auto"},
         {"relief-bake bump flat.png out/n.png --height 1", 2,
          "--height: needs the size of a texel in the same unit (give --texel-size, or --strength "
          "instead)"},
         {"relief-bake bump flat.png out/n.png --texel-size 1", 2,
          "--texel-size: has no effect without --height (give --height)"},
         {"relief-bake bump flat.png out/n.png --height 1 --texel-size 0x1", 2,
          "--texel-size 0x1: "},
         {"relief-bake bump flat.png out/n.png --height 1 --strength 2 --texel-size 1", 2,
          "--strength, --height: both set the depth of the map"},
         {"relief-bake bump flat.png out/n.png --report flat.png", 2,
          "--report flat.png: is also the input or the output"},
         {"relief-bake bump flat.png out/n.png --report height.png", 2,
          "--report height.png: is the name of a model or an image (use .json)"},
         {"relief-bake bump flat.png out/n.png --channel blue", 1,
          "flat.png: a gray image has no blue channel to take heights from"},
         {"relief-bake bump flat.png out/n.png --slope-moments", 2,
          "--bits 32: .png holds 16 or 8 bits"},
         {"relief-bake bump flat.png out/n.exr --slope-moments --xy", 2,
          "--xy, --slope-moments: contradict each other"},
         {"relief-bake bump flat.png out/n.png --cone-map out/cones.jpg", 2,
          "--cone-map out/cones.jpg: needs two channels of 16 bits or more (use .png, .tif or "
          ".exr)"},
         {"relief-bake bump flat.png out/n.png --cone-map out/n.png", 2, "--cone-map out/n.png: "},
         {"relief-bake bump flat.png out/n.png --cone-map out/c.png --invert", 2,
          "--invert, --cone-map: cones are those of the heights as they are read"},
         {"relief-bake bump flat.png flat.png", 2,
          "flat.png: would replace the height map (choose another output file or folder)"},
         {"relief-bake bump flat.png -o ./", 2, "./flat.png: would replace the height map"},
         {"relief-bake bump flat.png out/n.'<UDIM>'.png", 2,
          "flat.png, out/n.<UDIM>.png: <UDIM> must be in both names or in none"},
         {"relief-bake bump flat.png", 2, "OUT is missing (see relief-bake bump --help)"},
         {"relief-bake", 2,
          "a command is missing: bump or mesh or merge or convert or check or heights or pack or "
          "textures "
          "(see "
          "relief-bake --help)"}});
}

/// Writes the heights of a field.
BumpField write_field(const Workplace& workplace, const std::string& name, FieldCoding coding) {
    BumpField field = make_bump_field({"", FieldShape::waves, 32.0, 0.3, coding, 0.0, 5}, 160, 128);
    write_image(workplace / name, field.heights);
    return field;
}

std::string strength_of(const BumpField& field) {
    return " --strength " + std::to_string(field.options.strength);
}

ErrorStats errors_of(const Workplace& workplace, const std::string& name, const BumpField& field) {
    Report report;
    const Image normals = decode_normal_map(read_image(workplace / name, ImageUse::data), Green::up,
                                            FlatCode::half, report);
    return normal_error(normals, field);
}

double error_of(const Workplace& workplace, const std::string& name, const BumpField& field) {
    return errors_of(workplace, name, field).rms;
}

double p99_error_of(const Workplace& workplace, const std::string& name, const BumpField& field) {
    return errors_of(workplace, name, field).p99;
}

TEST(BumpAccuracyCommand, ChoosesTheKernelFromTheMapWithAReason) {
    const Workplace workplace;
    const BumpField coarse = write_field(workplace, "coarse.png", FieldCoding::bits8);
    const BumpField fine = write_field(workplace, "fine.png", FieldCoding::bits16);
    const ProgramResult of_coarse = workplace.run("relief-bake bump coarse.png out/c.png" +
                                                  strength_of(coarse) + " --report out/c.json");
    ASSERT_EQ(of_coarse.exit_code, 0) << of_coarse.error;
    EXPECT_THAT(of_coarse.out, HasSubstr("slopes    gaussian of radius "));
    EXPECT_THAT(of_coarse.out, HasSubstr("because   8 bits used: steps of 0."));
    const json report = json::parse(workplace.read("out/c.json"));
    EXPECT_EQ(report["kernel"], "gaussian");
    EXPECT_THAT(report["kernel_reason"].get<std::string>(), HasSubstr("8 bits used"));
    EXPECT_EQ(report["destaircased_step"], nullptr);
    const ProgramResult of_fine =
        workplace.run("relief-bake bump fine.png out/f.png" + strength_of(fine));
    EXPECT_THAT(of_fine.out, HasSubstr("slopes    central"));
    EXPECT_THAT(of_fine.out, HasSubstr("because   16 bits used: detail outweighs"));

    // It is more accurate than the former default kernel.
    ASSERT_EQ(
        workplace.run("relief-bake bump coarse.png out/s.png --kernel sobel3" + strength_of(coarse))
            .exit_code,
        0);
    EXPECT_LT(2.0 * error_of(workplace, "out/c.png", coarse),
              error_of(workplace, "out/s.png", coarse));
}

TEST(BumpAccuracyCommand, DestaircasingReducesTheErrorOfAn8BitMap) {
    const Workplace workplace;
    const BumpField field = write_field(workplace, "h.png", FieldCoding::bits8);
    const std::string line = "relief-bake bump h.png" + strength_of(field);
    ASSERT_EQ(workplace.run(line + " out/plain.png").exit_code, 0);
    const ProgramResult smooth =
        workplace.run(line + " out/smooth.png --destaircase --report out/r.json");
    ASSERT_EQ(smooth.exit_code, 0) << smooth.error;
    EXPECT_THAT(
        smooth.out,
        HasSubstr("steps     smoothed: steps of 1/255; heights moved by at most half a step"));
    EXPECT_NEAR(json::parse(workplace.read("out/r.json"))["destaircased_step"].get<double>(),
                1.0 / 255.0, 1e-12);
    EXPECT_LT(1.2 * error_of(workplace, "out/smooth.png", field),
              error_of(workplace, "out/plain.png", field));
}

TEST(BumpAccuracyCommand, SelectsTheFastestMethodWithinALimit) {
    const Workplace workplace;
    const BumpField field = write_field(workplace, "h.png", FieldCoding::bits16);
    const std::string line = "relief-bake bump h.png" + strength_of(field);
    const ProgramResult loose = workplace.run(line + " out/a.png --max-error 0.5");
    ASSERT_EQ(loose.exit_code, 0) << loose.error;
    EXPECT_THAT(loose.out, HasSubstr(", 8 bit: 0."));
    EXPECT_EQ(read_image(workplace / "out/a.png", ImageUse::data).bits(), 8);
    const ProgramResult tight = workplace.run(line + " out/b.png --max-error 0.02 --report out/r");
    ASSERT_EQ(tight.exit_code, 0) << tight.error;
    EXPECT_EQ(read_image(workplace / "out/b.png", ImageUse::data).bits(), 16);
    const json report = json::parse(workplace.read("out/r"));
    EXPECT_LE(report["selected"]["degrees"]["p99"].get<double>(), 0.02);
    EXPECT_EQ(report["selected"]["expected_degrees"]["statistic"], "p99");
    EXPECT_EQ(report["selected"]["kernel"], report["kernel"]);
    EXPECT_EQ(report["bits"], 16);
    EXPECT_TRUE(report["reference"]["whole"].get<bool>());
    // Options on the command line are kept.
    const ProgramResult fixed =
        workplace.run(line + " out/c.png --max-error 2 --bits 16 --kernel scharr3");
    EXPECT_THAT(fixed.out, HasSubstr("selected  scharr3 in float32, 16 bit: "));
    // Nothing is written if no method is within the limit.
    const ProgramResult none =
        workplace.run(line + " out/d.png --max-error 0.02 --max-error-kind max --bits 8");
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_THAT(none.error, HasSubstr("h.png: no method is within 0.02 degrees (maximum): "));
    EXPECT_THAT(workplace.outputs(), testing::Not(HasSubstr("d.png")));
}

TEST(BumpAccuracyCommand, ALimitIncludesTheErrorOfTheMap) {
    const Workplace workplace;
    const BumpField field =
        make_bump_field({"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits8, 1.0, 5}, 160, 128);
    write_image(workplace / "noisy.png", field.heights);
    const std::string line = "relief-bake bump noisy.png" + strength_of(field);
    // The map itself has an error of some degrees, although all kernels agree.
    const ProgramResult refused = workplace.run(line + " out/a.png --max-error 0.5");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.error, HasSubstr("noisy.png: no method is within 0.5 degrees (99 %): the "
                                         "map itself has an expected error of "));
    EXPECT_THAT(refused.error, HasSubstr("limit only the added error with --max-added-error"));
    EXPECT_THAT(workplace.outputs(), testing::Not(HasSubstr("a.png")));
    const ProgramResult added =
        workplace.run(line + " out/b.png --max-added-error 0.5 --report out/b.json");
    ASSERT_EQ(added.exit_code, 0) << added.error;
    EXPECT_THAT(added.out, HasSubstr(" degrees (99 %) expected\n"));
    EXPECT_THAT(added.out, HasSubstr(" from the map itself, "));
    const json expected = json::parse(workplace.read("out/b.json"))["selected"]["expected_degrees"];
    EXPECT_LE(expected["added"].get<double>(), 0.5);
    EXPECT_NEAR(expected["total"].get<double>(),
                std::hypot(expected["map"].get<double>(), expected["added"].get<double>()), 1e-9);
    // The reported error is the true error.
    EXPECT_NEAR(expected["total"].get<double>() / p99_error_of(workplace, "out/b.png", field), 1.0,
                0.4);
}

TEST_LABELS(not_sanitized);
TEST(BumpAccuracyCommand, ALimitWithinTheRangeOfTheExpectedErrorIsAFinding) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    const std::string line = "relief-bake bump bricks.png --strength 12 --report out/r.json";
    const ProgramResult within = workplace.run(line + " out/a.png --max-error 4 --strict");
    EXPECT_EQ(within.exit_code, 3);
    EXPECT_THAT(within.out, HasSubstr("error limit that may be exceeded"));
    EXPECT_THAT(within.out, HasSubstr("and --max-error is 4: the map does not show "));
    const json report = json::parse(workplace.read("out/r.json"));
    const json expected = report["selected"]["expected_degrees"];
    EXPECT_LE(expected["total"].get<double>(), 4.0);
    EXPECT_GT(expected["total_upper"].get<double>(), 4.0);
    // The upper end of every method is below this limit.
    const ProgramResult above = workplace.run(line + " out/b.png --max-error 30 --strict");
    EXPECT_EQ(above.exit_code, 0) << above.out;
    EXPECT_THAT(above.out, testing::Not(HasSubstr("error limit")));
}

TEST(BumpAccuracyCommand, ReportsTheResultIfGrainIsDetail) {
    const Workplace workplace;
    const BumpField field =
        make_bump_field({"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits8, 1.5, 5}, 160, 128);
    write_image(workplace / "noisy.png", field.heights);
    const std::string line = "relief-bake bump noisy.png" + strength_of(field);
    const ProgramResult result = workplace.run(line + " out/a.png --report out/a.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("fine grain that may be noise or detail"));
    EXPECT_THAT(result.out, HasSubstr("(--grain detail)"));
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["grain"]["taken_for"], "noise");
    EXPECT_TRUE(report["grain"]["ambiguous"].get<bool>());
    EXPECT_GT(report["grain"]["otherwise"]["expected_degrees"].get<double>(),
              5.0 * report["expected_degrees"].get<double>());
    EXPECT_GE(report["expected_degrees_upper"].get<double>(),
              report["expected_degrees"].get<double>());
    ASSERT_EQ(workplace.run(line + " out/b.png --grain detail --report out/b.json").exit_code, 0);
    const json detail = json::parse(workplace.read("out/b.json"));
    EXPECT_EQ(detail["grain"]["taken_for"], "detail");
    EXPECT_NE(detail["kernel"], "gaussian");
}

TEST(BumpAccuracyCommand, ReportsColorPictures) {
    const Workplace workplace;
    Image picture = make_image(64, 64, 4, 8, ColorSpace::data);
    for (std::size_t i = 0; i < picture.sample_count(); ++i)
        picture.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i * 37 % 251);
    write_image(workplace / "photo.png", picture);
    const ProgramResult result =
        workplace.run("relief-bake bump photo.png out/a.png --kernel sobel3");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("color image read as heights"));
    EXPECT_THAT(result.out, HasSubstr("select a channel with --channel"));
    EXPECT_THAT(result.out, HasSubstr("alpha with values between 0 and 1"));
    EXPECT_EQ(
        workplace.run("relief-bake bump photo.png out/b.png --kernel sobel3 --strict").exit_code,
        3);
    const ProgramResult chosen =
        workplace.run("relief-bake bump photo.png out/c.png --kernel sobel3 --channel red");
    EXPECT_THAT(chosen.out, testing::Not(HasSubstr("color image")));
}

TEST(BumpAccuracyCommand, ComparesAllMethodsOnTheMap) {
    const Workplace workplace;
    const BumpField field = write_field(workplace, "h.png", FieldCoding::bits16);
    const ProgramResult result = workplace.run("relief-bake bump h.png out/n.png --compare" +
                                               strength_of(field) + " --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("measured on all of the map, against the kernel selected"));
    EXPECT_THAT(result.out, HasSubstr("MPixel/s\n"));
    EXPECT_THAT(result.out, HasSubstr("* no other method is both faster and more accurate\n"));
    const json report = json::parse(workplace.read("out/r.json"));
    ASSERT_EQ(report["comparison"].size(), 20U);
    int pareto_optimal = 0;
    for (const json& one : report["comparison"]) {
        EXPECT_GT(one["milliseconds"]["median"].get<double>(), 0.0);
        EXPECT_LE(one["degrees"]["rms"].get<double>(), one["degrees"]["max"].get<double>());
        pareto_optimal += one["efficient"].get<bool>() ? 1 : 0;
    }
    EXPECT_GE(pareto_optimal, 1);
}

TEST(BumpAccuracyRefusal, ExplainsAndLeavesNoFiles) {
    const Workplace workplace;
    write_image(workplace / "flat.png", make_image(4, 4, 1, 8, ColorSpace::data));
    expect_refusals(workplace, "relief-bake", "old.png",
                    {{"relief-bake bump flat.png out/n.png --max-error-kind max", 2,
                      "--max-error-kind: has no effect without --max-error (give --max-error DEG)"},
                     {"relief-bake bump flat.png out/n.png --max-error -1", 2, "--max-error -1: "},
                     {"relief-bake bump flat.png out/n.png --max-error 1 --compare", 2,
                      "--compare, --max-error: contradict each other"},
                     {"relief-bake bump flat.png out/n.exr --max-error 1 --slope-moments", 2,
                      "--max-error, --slope-moments: errors are measured only for normals"},
                     {"relief-bake bump flat.png out/n.exr --compare --half", 2,
                      "--compare, --half: errors of half floats are not measured"}});
}

}  // namespace
}  // namespace relief::tools
