// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake convert: conventions, axes, size, details, mip levels, and spaces of a mesh.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/normal_map_input.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/statistics.h"
#include "support/images.h"
#include "support/invariants.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

using nlohmann::json;
using test::bricks_map;
using test::expect_refusal;
using test::expect_refusals;
using test::normals_image;
using test::ProgramResult;
using test::resized_waves;
using test::Workplace;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int side = 64;

/// A surface that tiles, with an RMS slope of 0.5.
std::vector<HeightWave> waves() {
    return tiling_waves(side, side, 8, 12, 0.5, 11);
}

BumpField ground_truth() {
    return wave_heights(side, side, waves());
}

/// Writes the exact normals of the surface.
void write_normals(const Workplace& workplace, const std::string& name,
                   const NormalMapFormat& format = {},
                   const std::map<std::string, std::string>& metadata = {}) {
    Report report;
    write_image(workplace / name,
                encode_normal_map(normals_image(side, side, waves()), format, report), metadata);
}

Image decoded(const std::filesystem::path& file, Green green = Green::up,
              FlatCode flat = FlatCode::half) {
    Report report;
    return decode_normal_map(read_image(file, ImageUse::data), green, flat, report);
}

std::string green_of(const std::filesystem::path& file) {
    const auto metadata = read_image_info(file).metadata;
    const auto entry = metadata.find("relief:green");
    return entry == metadata.end() ? "unknown" : entry->second;
}

/// Runs a line that must succeed.
ProgramResult run(const Workplace& workplace, const std::string& line) {
    ProgramResult result = workplace.run("relief-bake convert " + line);
    EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.error;
    EXPECT_EQ(result.error, "");
    return result;
}

/// The rounding error of 16 bits: half a code in three components.
constexpr double degrees_of_16_bit = 0.0016;

TEST(ConvertCommand, FlippingGreenTwiceGivesTheSameTexels) {
    const Workplace workplace;
    for (const FlatCode flat : {FlatCode::middle, FlatCode::half}) {
        for (const int bits : {8, 16}) {
            const NormalMapFormat format{bits, Green::up, flat};
            write_normals(workplace, "gl.png", format, normal_map_metadata(format));
            const ProgramResult there = run(workplace, "gl.png out/dx.png --flip green");
            EXPECT_THAT(there.out, HasSubstr("steps     green inverted, all codes kept\n"));
            EXPECT_EQ(green_of(workplace / "out/dx.png"), "down");
            EXPECT_LT(
                normal_error(decoded(workplace / "out/dx.png", Green::down, flat), ground_truth())
                    .max,
                bits == 8 ? 0.4 : degrees_of_16_bit);
            run(workplace, "out/dx.png out/back.png --flip green");
            EXPECT_EQ(workplace.read("out/back.png"), workplace.read("gl.png"));
            run(workplace, "out/dx.png out/up.png --green up");
            EXPECT_EQ(workplace.read("out/up.png"), workplace.read("gl.png"));
        }
    }
}

TEST(ConvertCommand, GreenIsNotGuessed) {
    const Workplace workplace;
    write_normals(workplace, "map.png");
    const ProgramResult refused = workplace.run("relief-bake convert map.png out/n.png --green up");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_EQ(refused.error,
              "relief-bake: error: map.png: the direction of its green channel is unknown (give "
              "--input-green, or --flip green to invert it in any case)\n");
    EXPECT_THAT(run(workplace, "map.png out/n.png --flip green").out, HasSubstr("green unknown\n"));
    EXPECT_EQ(green_of(workplace / "out/n.png"), "unknown");
    run(workplace, "map.png out/n.png --input-green up --green down");
    EXPECT_EQ(green_of(workplace / "out/n.png"), "down");
    EXPECT_LT(normal_error(decoded(workplace / "out/n.png", Green::down), ground_truth()).max,
              degrees_of_16_bit);
    // An unknown direction of green is accepted if it has no effect.
    run(workplace, "map.png out/n.png --strength 2");
    EXPECT_EQ(green_of(workplace / "out/n.png"), "unknown");
}

TEST(ConvertCommand, GreenIsDetectedFromTheSlopesOnRequest) {
    const Workplace workplace;
    write_normals(workplace, "up.png");
    write_normals(workplace, "down.png", {16, Green::down});
    for (const std::string name : {"up", "down"}) {
        const ProgramResult result =
            run(workplace, name + ".png out/n.png --input-green auto --green up");
        EXPECT_THAT(result.out, HasSubstr("green " + name + " (from its slopes)"));
        EXPECT_LT(normal_error(decoded(workplace / "out/n.png"), ground_truth()).max,
                  degrees_of_16_bit);
    }
    Image flat = make_image(64, 64, 3, 8, ColorSpace::data);
    for (std::size_t i = 0; i < flat.sample_count(); ++i)
        flat.as<std::uint8_t>()[i] = i % 3 == 2 ? 255 : 128;
    write_image(workplace / "flat.png", flat);
    const ProgramResult refused =
        workplace.run("relief-bake convert flat.png out/n.png --input-green auto --green up");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.error, HasSubstr("flat.png: its slopes do not determine the direction of "
                                         "green (give up or down instead of auto)"));
}

TEST(ConvertCommand, SignedFloatMapsAreRecognized) {
    const Workplace workplace;
    write_image(workplace / "signed.exr", normals_image(side, side, waves()));
    const ProgramResult refused = workplace.run("relief-bake convert signed.exr out/n.png");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.error,
                HasSubstr("signed.exr: has samples below 0, so it stores n instead of "
                          "(n + 1) / 2 (give --input-signed)"));
    EXPECT_THAT(run(workplace, "signed.exr out/n.png --input-signed").out,
                HasSubstr("zero is 0 (given)\n"));
    EXPECT_LT(normal_error(decoded(workplace / "out/n.png"), ground_truth()).max,
              degrees_of_16_bit);
    write_normals(workplace, "map.png");
    EXPECT_EQ(workplace.run("relief-bake convert map.png out/m.png --input-signed").exit_code, 2);
}

TEST(ConvertCommand, LargeMapsStayInTheirFiles) {
    const Workplace workplace;
    write_normals(workplace, "map.png", {}, {{"relief:green", "down"}, {"relief:flat", "32768"}});
    const InputMap whole = read_normal_map(workplace / "map.png", {});
    const InputMap opened = open_normal_map(workplace / "map.png", {}, 64 * 64 * 6 - 1);
    EXPECT_FALSE(whole.image.empty());
    EXPECT_TRUE(opened.image.empty());
    EXPECT_EQ(opened.info.bits, 16);
    EXPECT_EQ(opened.flat, FlatCode::middle);
    EXPECT_EQ(opened.green, Green::down);
    EXPECT_EQ(opened.conventions, whole.conventions);
    EXPECT_FALSE(open_normal_map(workplace / "map.png", {}, 64 * 64 * 6).image.empty());
    MapInputOptions detect;
    detect.detects_green = true;
    EXPECT_FALSE(open_normal_map(workplace / "map.png", detect, 0).image.empty());
    write_image(workplace / "signed.exr", normals_image(side, side, waves()));
    const auto refused = [&] { open_normal_map(workplace / "signed.exr", {}, 0); };
    EXPECT_THAT(test::message_of<FileError>(refused), HasSubstr("has samples below 0"));
}

TEST(ConvertCommand, MapsAxes) {
    const Workplace workplace;
    write_normals(workplace, "map.png", {}, {{"relief:green", "up"}});
    EXPECT_THAT(run(workplace, "map.png out/n.png --axes x,z,-y").out,
                HasSubstr("steps     axes mapped to x,z,-y, all codes kept\n"));
    EXPECT_EQ(green_of(workplace / "out/n.png"), "unknown");
    const Image before = decoded(workplace / "map.png");
    const Image after = decoded(workplace / "out/n.png");
    for (std::size_t i = 0; i < before.sample_count(); i += 3) {
        ASSERT_EQ(after.as<float>()[i], before.as<float>()[i]);
        ASSERT_EQ(after.as<float>()[i + 1], before.as<float>()[i + 2]);
        ASSERT_EQ(after.as<float>()[i + 2], -before.as<float>()[i + 1]);
    }
    run(workplace, "out/n.png out/back.png --axes=x,-z,y");
    EXPECT_EQ(read_image(workplace / "out/back.png", ImageUse::data).samples,
              read_image(workplace / "map.png", ImageUse::data).samples);
    run(workplace, "map.png out/red.png --flip red");
    EXPECT_EQ(green_of(workplace / "out/red.png"), "up");
    run(workplace, "map.png out/axes.png --axes=-x,y,z");
    EXPECT_EQ(workplace.read("out/axes.png"), workplace.read("out/red.png"));
}

TEST(ConvertCommand, DepthAndZeroCodeChangeWithoutChangingNormals) {
    const Workplace workplace;
    const NormalMapFormat half{16, Green::up, FlatCode::half};
    write_normals(workplace, "half.png", half, normal_map_metadata(half));
    EXPECT_THAT(run(workplace, "half.png out/middle.png --zero-code 128").out,
                HasSubstr("format    16 bit, zero at 32768 of 65535 (glTF and engines decode zero "
                          "at 32767.5, which tilts normals by 0.0012 degrees), green up\n"));
    EXPECT_EQ(read_image_info(workplace / "out/middle.png").metadata.at("relief:flat"), "32768");
    EXPECT_LT(normal_error(decoded(workplace / "out/middle.png", Green::up, FlatCode::middle),
                           ground_truth())
                  .max,
              2 * degrees_of_16_bit);
    run(workplace, "half.png out/n.exr");
    EXPECT_EQ(read_image_info(workplace / "out/n.exr").bits, 32);
    EXPECT_LT(normal_error(decoded(workplace / "out/n.exr"), ground_truth()).max,
              degrees_of_16_bit);
    EXPECT_THAT(run(workplace, "half.png out/8.png --bits 8 --dither blue-noise").out,
                HasSubstr("format    8 bit, zero at 127.5 of 255 (the decoding of glTF and "
                          "engines), green up, dithered blue-noise"));
    EXPECT_LT(
        normal_error(decoded(workplace / "out/8.png", Green::up, FlatCode::half), ground_truth())
            .max,
        0.8);
    // The bit depth is that of the input if the format supports it.
    run(workplace, "out/8.png out/again.tif");
    EXPECT_EQ(read_image_info(workplace / "out/again.tif").bits, 8);
    run(workplace, "out/n.exr out/again.png");
    EXPECT_EQ(read_image_info(workplace / "out/again.png").bits, 16);
}

TEST(ConvertCommand, RebuildsZFromTwoChannels) {
    const Workplace workplace;
    write_normals(workplace, "map.png");
    Image map = read_image(workplace / "map.png", ImageUse::data);
    Image xy = make_image(side, side, 2, 16, ColorSpace::data);
    Image swizzled = make_image(side, side, 4, 16, ColorSpace::data);
    for (std::size_t i = 0; i < std::size_t{side} * side; ++i) {
        const std::uint16_t x = map.as<std::uint16_t>()[3 * i];
        const std::uint16_t y = map.as<std::uint16_t>()[3 * i + 1];
        xy.as<std::uint16_t>()[2 * i] = swizzled.as<std::uint16_t>()[4 * i + 3] = x;
        xy.as<std::uint16_t>()[2 * i + 1] = swizzled.as<std::uint16_t>()[4 * i + 1] = y;
    }
    write_image(workplace / "xy.png", xy);
    write_image(workplace / "ag.png", swizzled);
    for (const std::string line :
         {"xy.png out/n.png --rebuild-z rg", "ag.png out/n.png --rebuild-z ag"}) {
        EXPECT_THAT(run(workplace, line).out, HasSubstr("steps     z computed from x and y\n"));
        EXPECT_LT(normal_error(decoded(workplace / "out/n.png"), ground_truth()).max, 0.003);
        EXPECT_EQ(read_image_info(workplace / "out/n.png").channels, 3);
    }
    const ProgramResult refused = workplace.run("relief-bake convert xy.png out/m.png");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_EQ(refused.error,
              "relief-bake: error: xy.png: has only 2 channels, and no z (give --rebuild-z rg to "
              "compute z)\n");
}

TEST(ConvertCommand, StrengthScalesSlopesAndResizingKeepsThem) {
    const Workplace workplace;
    write_normals(workplace, "map.png");
    std::vector<HeightWave> steep = waves();
    for (HeightWave& wave : steep)
        wave.amplitude *= -3.0;
    run(workplace, "map.png out/n.png --strength -3");
    EXPECT_LT(normal_error(decoded(workplace / "out/n.png"), wave_heights(side, side, steep)).max,
              4 * degrees_of_16_bit);
    EXPECT_THAT(run(workplace, "map.png out/n.png --resize 150%").out,
                HasSubstr("resized to 150 % by slopes (best)\n"));
    EXPECT_LT(normal_error(decoded(workplace / "out/n.png"),
                           wave_heights(96, 96, resized_waves(waves(), 64.0 / 96)))
                  .rms,
              0.02);
    run(workplace, "map.png out/n.png --resize 48x48 --resize-filter lanczos --resize-of vectors");
    EXPECT_LT(normal_error(decoded(workplace / "out/n.png"),
                           wave_heights(48, 48, resized_waves(waves(), 64.0 / 48)))
                  .rms,
              0.05);
}

TEST(ConvertCommand, DetailsAreBlendedForEitherDirectionOfGreen) {
    const Workplace workplace;
    const std::vector<HeightWave> detail_waves = tiling_waves(32, 32, 4, 8, 0.3, 21);
    std::vector<HeightWave> both = waves();
    both.insert(both.end(), detail_waves.begin(), detail_waves.end());
    Report report;
    const Image detail = normals_image(32, 32, detail_waves);
    write_normals(workplace, "base.png", {}, {{"relief:green", "up"}});
    write_image(workplace / "detail.png",
                encode_normal_map(detail, {16, Green::down, FlatCode::half}, report));
    const std::string line =
        "base.png out/n.png --detail detail.png --detail-green down --detail-zero-code 127.5 "
        "--detail-repeat 2 --blend partial-derivative";
    EXPECT_THAT(run(workplace, line).out,
                HasSubstr("detail detail.png blended (partial-derivative, 2 x 2 times)\n"));
    EXPECT_LT(normal_error(decoded(workplace / "out/n.png"), wave_heights(side, side, both)).max,
              0.005);
    // If the base is mapped first, the detail follows.
    run(workplace, line + " --flip green");
    EXPECT_LT(
        normal_error(decoded(workplace / "out/n.png", Green::down), wave_heights(side, side, both))
            .max,
        0.005);
    run(workplace, line + " --detail-strength 0");
    EXPECT_LT(normal_error(decoded(workplace / "out/n.png"), ground_truth()).max,
              2 * degrees_of_16_bit);
}

TEST(ConvertCommand, MipLevelsStoreLengthsAndRoughness) {
    const Workplace workplace;
    // A checkerboard of slopes +-0.5 along x: every level is flat, with variance 0.125.
    Image slopes = make_image(8, 4, 2, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 32; ++i)
        slopes.as<float>()[2 * i] = (i + i / 8) % 2 == 0 ? 0.5F : -0.5F;
    Report report;
    write_image(workplace / "map.png",
                encode_normal_map(normals_from_slopes(slopes, report), {}, report));
    const ProgramResult result = run(
        workplace,
        "map.png out/m.png --mips --mip-lengths --roughness-from-variance 0.6 --report out/r.json");
    EXPECT_EQ(workplace.outputs(),
              "m-mip01.png m-mip02.png m-mip03.png m-roughness-mip01.png m-roughness-mip02.png "
              "m-roughness-mip03.png m-roughness.png m.png r.json");
    EXPECT_THAT(
        result.out,
        HasSubstr(
            "3 mip levels of averaged normals, lengths in alpha, compensated for roughness 0.6\n"));
    const double length = 1.0 / std::sqrt(1.25);
    const double roughness = std::pow(0.6 * 0.6 * 0.6 * 0.6 + 0.25, 0.25);
    const json levels = json::parse(workplace.read("out/r.json"))["levels"];
    ASSERT_EQ(levels.size(), 4U);
    EXPECT_EQ(levels[0]["mean_length"], 1.0);
    EXPECT_NEAR(levels[0]["mean_roughness"].get<double>(), 0.6, 1e-6);
    EXPECT_EQ(levels[3]["width"], 1);
    for (std::size_t level = 1; level < 4; ++level) {
        EXPECT_NEAR(levels[level]["mean_length"].get<double>(), length, 1e-5);
        EXPECT_NEAR(levels[level]["min_length"].get<double>(), length, 1e-5);
        EXPECT_NEAR(levels[level]["mean_roughness"].get<double>(), roughness, 1e-5);
        const Image map =
            read_image(workplace / fmt::format("out/m-mip0{}.png", level), ImageUse::data);
        ASSERT_EQ(map.channels, 4);
        EXPECT_THAT(std::vector<std::uint16_t>(map.as<std::uint16_t>().begin(),
                                               map.as<std::uint16_t>().begin() + 4),
                    ElementsAre(32768, 32768, 65535,
                                testing::AllOf(testing::Gt(58615), testing::Lt(58619))));
        const Image rough = read_image(workplace / fmt::format("out/m-roughness-mip0{}.png", level),
                                       ImageUse::data);
        EXPECT_NEAR(rough.as<std::uint16_t>()[0], roughness * 65535, 1.0);
        EXPECT_EQ(rough.channels, 1);
    }
}

TEST(ConvertCommand, AlphaIsKeptOrDropped) {
    const Workplace workplace;
    write_normals(workplace, "map.png", {8});
    Image alpha = make_image(side, side, 1, 32, ColorSpace::data);
    for (std::size_t i = 0; i < alpha.sample_count(); ++i)
        alpha.as<float>()[i] = i % side < side / 2 ? 0.2F : 0.8F;
    write_image(workplace / "alpha.png",
                with_alpha(read_image(workplace / "map.png", ImageUse::data), alpha));
    run(workplace, "alpha.png out/flip.png --flip both");
    run(workplace, "alpha.png out/wide.png --strength 0.5 --bits 16");
    run(workplace, "alpha.png out/half.png --resize 50% --wrap clamp --resize-filter box");
    for (const char* name : {"out/flip.png", "out/wide.png", "out/half.png"}) {
        const Image map = read_image(workplace / name, ImageUse::data);
        ASSERT_EQ(map.channels, 4) << name;
        const Image kept = channel_of(map, 3);
        EXPECT_FLOAT_EQ(kept.as<float>()[0], 0.2F) << name;
        EXPECT_FLOAT_EQ(kept.as<float>()[kept.sample_count() - 1], 0.8F) << name;
    }
    run(workplace, "alpha.png out/dropped.png --alpha drop");
    EXPECT_EQ(read_image(workplace / "out/dropped.png", ImageUse::data).samples,
              read_image(workplace / "map.png", ImageUse::data).samples);
    const ProgramResult refused =
        workplace.run("relief-bake convert alpha.png out/m.png --mips --mip-lengths");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.error,
                HasSubstr("--mip-lengths: alpha.png has an alpha channel (give --alpha drop)"));
}

TEST(ConvertCommand, CountsNormalsThatAreNotUnitAndTexelsWithoutDirection) {
    const Workplace workplace;
    Image map = make_image(4, 1, 3, 8, ColorSpace::data);
    map.samples =
        std::vector<std::uint8_t>{128, 128, 255, 128, 128, 200, 128, 128, 128, 0, 128, 128};
    write_image(workplace / "map.png", map);
    const ProgramResult result = workplace.run(
        "relief-bake convert map.png out/n.png --normalize --strict --report out/r.json");
    EXPECT_EQ(result.exit_code, 3);
    const json report = json::parse(workplace.read("out/r.json"));
    // With zero at 127.5, code 128 is 1 / 255.
    const double off_zero = 1.0 / 255.0;
    const auto length = [&](double z) { return std::sqrt(2.0 * off_zero * off_zero + z * z); };
    const double gray = std::sqrt(3.0) * off_zero;
    EXPECT_NEAR(report["input_lengths"]["min"].get<double>(), gray, 1e-6);
    EXPECT_NEAR(report["input_lengths"]["max"].get<double>(), length(1.0), 1e-6);
    EXPECT_NEAR(report["input_lengths"]["mean"].get<double>(),
                (2.0 * length(1.0) + length(145.0 / 255.0) + gray) / 4, 1e-6);
    EXPECT_THAT(result.out, HasSubstr("normalized (lengths were 0.007 to 1.000, mean 0.644)\n"));
    const json findings = report["findings"];
    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(findings[0]["kind"], "normal not of unit length");
    EXPECT_EQ(findings[0]["first"], json({1, 2}));
    EXPECT_EQ(findings[1]["kind"], "normal without direction");
    EXPECT_EQ(findings[1]["first"], json({2}));
    EXPECT_EQ(
        std::get<std::vector<std::uint8_t>>(
            read_image(workplace / "out/n.png", ImageUse::data).samples),
        (std::vector<std::uint8_t>{128, 128, 255, 128, 128, 255, 128, 128, 255, 0, 128, 128}));
    // Mapping axes changes no length and reports nothing.
    EXPECT_EQ(
        workplace.run("relief-bake convert map.png out/n.png --flip green --strict").exit_code, 0);
}

TEST(ConvertCommand, MetadataIsKeptUnlessItChanges) {
    const Workplace workplace;
    write_normals(workplace, "map.png", {},
                  {{"relief:green", "up"},
                   {"relief:content", "normal map, object space"},
                   {"relief:basis", "mikktspace"},
                   {"Author", "somebody"},
                   {"Software", "another"}});
    run(workplace, "map.png out/n.tif --flip green --bits 8");
    const auto metadata = read_image_info(workplace / "out/n.tif").metadata;
    EXPECT_EQ(metadata.at("relief:green"), "down");
    EXPECT_EQ(metadata.at("relief:flat"), "127.5");
    EXPECT_EQ(metadata.at("relief:content"), "normal map, object space");
    EXPECT_EQ(metadata.at("relief:basis"), "mikktspace");
}

TEST(ConvertCommand, AMapMayReplaceItsInputAndManyAreWrittenToAFolder) {
    const Workplace workplace;
    write_normals(workplace, "a.png");
    write_normals(workplace, "b.tif");
    workplace.write("bad.png", "this is no image");
    const ProgramResult result =
        workplace.run("relief-bake convert a.png bad.png b.tif -o out/maps/ --flip green");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, testing::StartsWith("relief-bake: error: bad.png: "));
    EXPECT_THAT(result.out, testing::MatchesRegex(
                                "out/maps/a.png: 64 x 64, no findings, [^\n]*\nout/maps/b.tif: 64 "
                                "x 64, no findings, [^\n]*\nin all    3 files, 1 failed\n"));
    const std::string before = workplace.read("a.png");
    run(workplace, "a.png a.png --flip green");
    EXPECT_NE(workplace.read("a.png"), before);
    run(workplace, "a.png a.png --flip green");
    EXPECT_EQ(decoded(workplace / "a.png").samples, decoded(workplace / "b.tif").samples);
}

TEST(ConvertCommand, OutputDoesNotDependOnThreads) {
    const Workplace workplace;
    write_normals(workplace, "map.png");
    for (const std::string threads : {"1", "2"}) {
        run(workplace, "map.png out/" + threads +
                           ".png --detail map.png --resize 130% --strength 2 --bits 8 --dither "
                           "ordered --threads " +
                           threads);
    }
    EXPECT_EQ(workplace.read("out/1.png"), workplace.read("out/2.png"));
}

TEST(ConvertCommand, ARealDirectXMapIsConvertedToOpenGl) {
    RELIEF_NEEDS_SHARED(file, "data/textures/sand_ambientcg/sand_normal.png");
    const Workplace workplace;
    run(workplace, file.string() + " out/gl.png --input-green down --green up");
    const Image before = read_image(file, ImageUse::data);
    const Image after = read_image(workplace / "out/gl.png", ImageUse::data);
    ASSERT_EQ(after.channels, before.channels);
    for (std::size_t i = 0; i < before.sample_count(); ++i) {
        const int code = before.as<std::uint8_t>()[i];
        ASSERT_EQ(after.as<std::uint8_t>()[i], i % 3 == 1 ? 255 - code : code);
    }
}

TEST(ConvertRefusal, ExplainsAndLeavesNoFiles) {
    const Workplace workplace;
    write_image(workplace / "map.png", make_image(4, 3, 3, 8, ColorSpace::data));
    write_image(workplace / "gray.png", make_image(4, 3, 1, 8, ColorSpace::data));
    for (const char* name : {"n.png", "n-mip01.png", "n-roughness.png"})
        write_image(workplace / name, make_image(4, 3, 3, 8, ColorSpace::data));
    expect_refusals(
        workplace, "relief-bake", "old.png",
        {{"relief-bake convert missing.png out/old.png", 1, "missing.png: "},
         {"relief-bake convert gray.png out/old.png", 1,
          "gray.png: has 1 channel, but normals need at least 2 (relief-bake bump converts height "
          "maps)"},
         {"relief-bake convert map.png out/n.jpg", 2,
          "out/n.jpg: JPEG compression distorts normals"},
         {"relief-bake convert map.png out/n.png --flip blue", 2,
          "--flip blue: not one of green, red, both"},
         {"relief-bake convert map.png out/n.png --flip red --axes y,x,z", 2,
          "--flip, --axes: both set the axes"},
         {"relief-bake convert map.png out/n.png --flip green --green up", 2,
          "--flip, --green: both set the direction of green"},
         {"relief-bake convert map.png out/n.png --axes x,y", 2,
          "--axes x,y: not x, y and z in some order, like x,-y,z"},
         {"relief-bake convert map.png out/n.png --axes x,x,z", 2,
          "--axes x,x,z: not x, y and z in some order"},
         {"relief-bake convert map.png out/n.png --axes x,y,z", 2, "--axes x,y,z: changes nothing"},
         {"relief-bake convert map.png out/n.png --blend udn", 2,
          "--blend: has no effect without --detail"},
         {"relief-bake convert map.png out/n.png --detail-repeat 4", 2,
          "--detail-repeat: has no effect without --detail"},
         {"relief-bake convert map.png out/n.png --wrap clamp", 2,
          "--wrap: has no effect without --resize"},
         {"relief-bake convert map.png out/n.png --resize-filter box", 2,
          "--resize-filter: has no effect without --resize or --detail"},
         {"relief-bake convert map.png out/n.png --roughness-from-variance 0.2", 2,
          "--roughness-from-variance: has no effect without --mips"},
         {"relief-bake convert map.png out/n.png --normalize --rebuild-z rg", 2,
          "--normalize: has no effect with --rebuild-z, which normalizes"},
         {"relief-bake convert map.png out/n.png --resize 0x4", 2, "--resize 0x4: "},
         {"relief-bake convert map.png out/n.png --resize 50", 2,
          "--resize 50: not a size like 512x512 or 50%"},
         {"relief-bake convert map.png out/n.png --dither ordered", 2,
          "--dither: has no effect if all codes are kept"},
         {"relief-bake convert map.png out/n.png --detail missing.png", 1, "missing.png: "},
         {"relief-bake convert map.png out/old.png --detail out/old.png", 2,
          "out/old.png: would replace the detail map"},
         {"relief-bake convert map.png n.png --mips --detail n-mip01.png", 2,
          "n-mip01.png: would replace the detail map"},
         {"relief-bake convert n-mip01.png n.png --mips", 2,
          "n-mip01.png: would replace the normal map"},
         {"relief-bake convert n.png n-mip01.png -o out/ --mips", 2,
          "n.png and n-mip01.png: would both be written to out/n-mip01.png (convert them by "
          "separate calls, to different folders)"},
         {"relief-bake convert n-roughness.png n.png -o out/ --mips --roughness-from-variance 0.4",
          2, "n-roughness.png and n.png: would both be written to out/n-roughness.png"},
         {"relief-bake convert map.png", 2, ""}});
}

/// The maximum difference of two files' samples, in codes.
int largest_difference(const Workplace& workplace, const char* a, const std::filesystem::path& b) {
    const Image one = read_image(workplace / a, ImageUse::data);
    const Image other = read_image(workplace / b, ImageUse::data);
    EXPECT_EQ(one.sample_count(), other.sample_count());
    int largest = 0;
    for (std::size_t i = 0; i < one.sample_count(); ++i)
        largest =
            std::max(largest, std::abs(one.as<std::uint16_t>()[i] - other.as<std::uint16_t>()[i]));
    return largest;
}

TEST(ConvertSpace, ARoundTripGivesTheSameMapWithinACode) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ASSERT_EQ(workplace
                  .run("relief-bake convert " + bricks_map +
                       " out/map.png --bits 16 --zero-code 128 --normalize --quiet")
                  .exit_code,
              0);
    for (const char* mesh : {"square.obj", "data/scenes/knot.glb", "data/vase.obj"}) {
        const std::string outside = " --outside repeat";
        const ProgramResult there = workplace.run(
            std::string(
                "relief-bake convert out/map.png out/object.png --input-green up --to-object ") +
            mesh + outside);
        ASSERT_EQ(there.exit_code, 0) << there.error;
        EXPECT_THAT(there.out, HasSubstr(std::string("to the object space of ") + mesh));
        EXPECT_THAT(there.out, HasSubstr("object space\n"));
        EXPECT_EQ(read_image_info(workplace / "out/object.png").metadata.at("relief:content"),
                  "normal map, object space");
        const ProgramResult back = workplace.run(
            std::string("relief-bake convert out/object.png out/back.png --to-tangent ") + mesh +
            outside);
        ASSERT_EQ(back.exit_code, 0) << back.error;
        EXPECT_EQ(read_image_info(workplace / "out/back.png").metadata.at("relief:content"),
                  "normal map, tangent space");
        if (back.out.find("100.0 % of the map") == std::string::npos) continue;
        EXPECT_LE(largest_difference(workplace, "out/map.png", "out/back.png"), 4) << mesh;
    }
}

TEST(ConvertSpace, InvertsGreenOnRequest) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    // The image is upright on the square, so its object space is tangent space with green up.
    for (const char* green : {"up", "down"}) {
        const std::string flat = " --bits 16 --zero-code 128 --quiet";
        ASSERT_EQ(workplace
                      .run("relief-bake convert " + bricks_map +
                           " out/tangent.png --input-green up --green " + green + flat)
                      .exit_code,
                  0);
        ASSERT_EQ(
            workplace
                .run("relief-bake convert out/tangent.png out/object.png --to-object square.obj" +
                     flat)
                .exit_code,
            0);
        ASSERT_EQ(workplace
                      .run("relief-bake convert out/object.png out/back.png --to-tangent "
                           "square.obj --green " +
                           std::string(green) + flat)
                      .exit_code,
                  0);
        EXPECT_LE(largest_difference(workplace, "out/tangent.png", "out/back.png"), 2) << green;
    }
}

TEST(ConvertSpace, ReportsWhetherTangentsAreThoseOfTheFile) {
    const Workplace workplace;
    const std::string line = "relief-bake convert " + bricks_map +
                             " out/object.png --input-green up --to-object data/scenes/knot.glb";
    EXPECT_THAT(workplace.run(line + " --tangents lengyel").out,
                HasSubstr(", with new tangents; "));
    ASSERT_EQ(workplace
                  .run("relief-mesh process data/scenes/knot.glb out/own.glb --tangents mikktspace "
                       "--quiet")
                  .exit_code,
              0);
    EXPECT_THAT(workplace
                    .run("relief-bake convert " + bricks_map +
                         " out/object.png --input-green up --to-object out/own.glb")
                    .out,
                HasSubstr(", with the file's tangents; "));
}

TEST(ConvertSpace, RefusesImpossibleConversions) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write_square("bare.obj", true);
    const std::string start = "relief-bake convert " + bricks_map + " out/old.png ";
    const std::string no_green = start + "--to-object square.obj";
    const std::string bare = start + "--input-green up --to-object bare.obj";
    const std::string missing = start + "--input-green up --to-object missing.obj";
    const std::string both = start + "--to-object square.obj --to-tangent square.obj";
    const std::string useless = start + "--udim 1002";
    const std::string green = start + "--to-object square.obj --green down";
    for (const auto& [line, code, message] :
         {test::Refused{no_green.c_str(), 1,
                        "data/scenes/bricks-normal.png: the direction of its green channel is "
                        "unknown (give --input-green)"},
          test::Refused{bare.c_str(), 1, "bare.obj: no texture coordinates (unwrap it first)"},
          test::Refused{missing.c_str(), 1, "missing.obj: "},
          test::Refused{both.c_str(), 2, "--to-object, --to-tangent: contradict each other"},
          test::Refused{useless.c_str(), 2,
                        "--udim: has no effect without --to-object or --to-tangent"},
          test::Refused{green.c_str(), 2,
                        "--green, --to-object: object space has no green direction"}}) {
        expect_refusal(workplace, "relief-bake", {line, code, message}, "old.png");
    }
}

}  // namespace
}  // namespace relief::tools
