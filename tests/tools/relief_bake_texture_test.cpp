// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake convert with textures as output and input: formats, levels, errors, limits.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/texture_file.h"
#include "support/images.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// Runs relief-bake convert, which must succeed.
ProgramResult run_texture(const Workplace& workplace, const std::string& words) {
    ProgramResult result = workplace.run("relief-bake convert " + words);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return result;
}

/// Writes the exact normals of a surface of 20 x 12 texels.
void write_waves(const Workplace& workplace, const std::string& name) {
    Image slopes = make_image(20, 12, 2, 32, ColorSpace::data);
    for (int i = 0; i < 240; ++i) {
        float* const slope = slopes.as<float>().data() + 2 * i;
        slope[0] = static_cast<float>(0.4 * std::cos(0.3 * (i % 20)));
        slope[1] = static_cast<float>(0.3 * std::sin(0.4 * (i / 20)));
    }
    write_image(workplace / name, encode_normal_map(normals_from_slopes(slopes), {}),
                {{"relief:green", "up"}});
}

TEST(ConvertToTexture, AllLevelsAreInOneFileAndTheirErrorsAreStated) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    const ProgramResult result =
        run_texture(workplace, "map.png out/m.ktx2 --mips --zstd 9 --report out/r.json");
    EXPECT_EQ(workplace.outputs(), "m.ktx2 r.json");
    EXPECT_THAT(result.out, HasSubstr("bc5, quality normal, green up"));
    EXPECT_THAT(result.out, HasSubstr("level 4, 1 x 1: mean error "));
    const GpuTexture texture = read_texture(workplace / "out/m.ktx2");
    EXPECT_EQ(texture.format, TextureFormat::bc5);
    EXPECT_EQ(texture.levels.size(), 5U);
    EXPECT_EQ(texture.swizzle, "rg01");
    EXPECT_EQ(texture.metadata.at("relief:green"), "up");
    EXPECT_EQ(texture.metadata.at("relief:flat"), "32767.5");
    const json levels = json::parse(workplace.read("out/r.json"))["levels"];
    ASSERT_EQ(levels.size(), 5U);
    for (const json& level : levels) {
        const double mean = level["error"]["mean"];
        EXPECT_LT(mean, 1.0);
        EXPECT_LE(mean, level["error"]["p99"]);
        EXPECT_LE(level["error"]["p99"].get<double>(), level["error"]["max"].get<double>() + 1e-9);
    }
    EXPECT_GT(levels[0]["error"]["mean"].get<double>(), 0.01);
    // A single texel is almost exact: within 1/14 of a code, 0.03 degrees per component.
    EXPECT_LT(levels[4]["error"]["mean"].get<double>(), 0.06);
}

TEST(ConvertToTexture, CheckStatesTheErrorOfEachLevelAgainstTheExactMap) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    for (const char* const file : {"out/m.ktx2 --format bc5-snorm", "out/m.dds --format bc7"}) {
        run_texture(workplace, "map.png " + std::string(file) + " --mips --report out/r.json");
        const json converted = json::parse(workplace.read("out/r.json"))["levels"];
        const std::string name = std::string(file).substr(0, std::string(file).find(' '));
        const ProgramResult result =
            workplace.run("relief-bake check " + name + " --exact map.png --json");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        const json exact = json::parse(result.out)["files"][0]["exact"];
        EXPECT_EQ(exact["file"], "map.png");
        ASSERT_EQ(exact["levels"].size(), 5U);
        for (std::size_t i = 0; i < 5; ++i) {
            for (const char* const figure : {"mean", "p99", "max"}) {
                EXPECT_NEAR(exact["levels"][i][figure].get<double>(),
                            converted[i]["error"][figure].get<double>(), 1e-3)
                    << name << " level " << i << " " << figure;
            }
        }
    }
    // Flat texels of the exact map are exactly flat, as for convert.
    write_image(workplace / "flat.png",
                test::image_of<std::uint8_t>(3, {128, 128, 255, 128, 128, 255, 200, 128, 230}));
    run_texture(workplace, "flat.png out/f.ktx2 --format rg16");
    EXPECT_THAT(workplace.run("relief-bake check out/f.ktx2 --exact flat.png").out,
                HasSubstr("mean error 0.001 degrees (99 %: 0.001, maximum: 0.001)"));
    // A map that is compared with itself has no error; the direction of green counts.
    const ProgramResult same = workplace.run("relief-bake check map.png --exact map.png");
    EXPECT_THAT(same.out, HasSubstr("level 0, 20 x 12: mean error 0.000 degrees"));
    const json turned =
        json::parse(workplace.run("relief-bake check map.png --exact map.png --green down --json")
                        .out)["files"][0]["exact"]["levels"][0];
    EXPECT_GT(turned["mean"].get<double>(), 5.0);
    write_image(workplace / "small.png", test::image_of<std::uint8_t>(3, {128, 128, 255}));
    const ProgramResult other = workplace.run("relief-bake check map.png --exact small.png");
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_THAT(other.error, HasSubstr("map.png: has 20 x 12 texels, but small.png has 1 x 1"));
}

/// The mean error of level 0 that `relief-bake check` prints.
double mean_error(const Workplace& workplace, const std::string& words) {
    const ProgramResult result = workplace.run("relief-bake check " + words + " --json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return json::parse(result.out)["files"][0]["exact"]["levels"][0]["mean"].get<double>();
}

TEST(CheckExact, AnUnknownDirectionOfGreenIsThatOfTheOtherMap) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    const double right = [&] {
        run_texture(workplace, "map.png out/m.ktx2");
        return mean_error(workplace, "out/m.ktx2 --exact map.png");
    }();
    EXPECT_LT(right, 1.0);
    // The same codes in a file that states nothing: its green may be up or down.
    write_image(workplace / "silent.png", read_image(workplace / "map.png", ImageUse::data));
    for (const char* const words :
         {"--input-green up", "--input-green down", "--input-green up --green down",
          "--input-green down --green up"}) {
        for (const char* const file : {"out/a.ktx2", "out/a.tif"}) {
            run_texture(workplace, fmt::format("silent.png {} {}", file, words));
            const double error = mean_error(workplace, std::string(file) + " --exact silent.png");
            EXPECT_LT(error, right + 0.01) << file << " " << words;
        }
    }
    // A file that states its direction against a texture that does not.
    run_texture(workplace, "map.png out/a.dds --green down");
    EXPECT_LT(mean_error(workplace, "out/a.dds --exact map.png"), right + 0.01);
    EXPECT_THAT(workplace.run("relief-bake check out/a.dds --exact map.png").out,
                HasSubstr("compared with inverted green"));
    // Neither states it: they are compared as they are, and the result says that they may differ.
    EXPECT_GT(mean_error(workplace, "out/a.dds --exact silent.png"), 5.0);
    EXPECT_THAT(workplace.run("relief-bake check out/a.dds --exact silent.png").out,
                HasSubstr("fit better with inverted green, but none states its direction"));
    EXPECT_LT(mean_error(workplace, "out/a.dds --exact silent.png --input-green down"),
              right + 0.01);
    // Both state it: a wrong direction is an error of the map.
    EXPECT_GT(mean_error(workplace, "out/a.dds --exact map.png --input-green up"), 5.0);
}

TEST(ConvertToTexture, FormatsDifferInError) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    struct Case {
        const char* format;
        double least, most;
    };
    for (const auto& [format, least, most] :
         {Case{"bc5", 0.01, 1.0}, Case{"bc5-snorm", 0.01, 1.0}, Case{"bc7", 0.01, 2.0},
          Case{"rg8", 0.05, 0.3}, Case{"rgba8", 0.05, 0.3}, Case{"rg16", 0.0, 0.01},
          Case{"rgba16", 0.0, 0.01}, Case{"rg16f", 0.0, 0.1}, Case{"rgba16f", 0.0, 0.1}}) {
        for (const char* extension : {"ktx2", "dds"}) {
            const std::string output = std::string("out/m.") + extension;
            run_texture(workplace,
                        "map.png " + output + " --format " + format + " --report out/r.json");
            const double mean =
                json::parse(workplace.read("out/r.json"))["levels"][0]["error"]["mean"];
            EXPECT_GE(mean, least) << format;
            EXPECT_LE(mean, most) << format;
            EXPECT_STREQ(enum_name(read_texture(workplace / output).format), format);
        }
    }
}

TEST(ConvertToTexture, MaxErrorChoosesTheSmallestFormat) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    const auto chosen = [&](const std::string& words) {
        run_texture(workplace, "map.png out/m.ktx2 --report out/r.json --max-error " + words);
        const json report = json::parse(workplace.read("out/r.json"));
        return report["texture_format"].get<std::string>() + " " +
               report["quality"].get<std::string>();
    };
    EXPECT_EQ(chosen("2 --max-error-kind mean"), "bc5 fast");
    EXPECT_EQ(chosen("0.2 --max-error-kind mean"), "rg8 normal");
    EXPECT_EQ(chosen("0.01"), "rg16 normal");
    // 99 % of the texels are within the limit.
    for (const char* limit : {"6", "4", "2", "1", "0.5"}) {
        chosen(limit);
        const json report = json::parse(workplace.read("out/r.json"));
        EXPECT_LE(report["levels"][0]["error"]["p99"].get<double>(), std::stod(limit));
    }
    EXPECT_EQ(chosen("2 --quality best"), "bc5 best");
    EXPECT_EQ(chosen("1 --format rgba16"), "rgba16 normal");
}

TEST(ConvertToTexture, EnginesSetTheDirectionOfGreen) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    run_texture(workplace, "map.png out/m.ktx2 --for unreal");
    const GpuTexture texture = read_texture(workplace / "out/m.ktx2");
    EXPECT_EQ(texture.format, TextureFormat::bc5);
    EXPECT_EQ(texture.metadata.at("relief:green"), "down");
    // The fourth row rises upwards by 0.3 sin(1.2), so its normals point down.
    constexpr std::size_t y_of_fourth_row = 2 * 20 * 3 + 1;
    const Image down_image = decode_texture_level(texture, 0);
    EXPECT_GT(down_image.as<std::uint16_t>()[y_of_fourth_row], 36000);
    run_texture(workplace, "map.png out/m.ktx2 --for unity");
    const Image up_image = decode_texture_level(read_texture(workplace / "out/m.ktx2"), 0);
    EXPECT_LT(up_image.as<std::uint16_t>()[y_of_fourth_row], 30000);
}

TEST(ConvertToTexture, LargeLevelsAreMeasuredInSamplesUnlessAllIsRequested) {
    const Workplace workplace;
    write_waves(workplace, "small.png");
    const auto levels_of = [&](const std::string& options) {
        run_texture(workplace,
                    "small.png out/m.ktx2 --mips --resize 400x400 --report out/r.json " + options);
        return json::parse(workplace.read("out/r.json"))["levels"];
    };
    const json quick = levels_of("");
    const std::string bytes = workplace.read("out/m.ktx2");
    const json full = levels_of("--measure full");
    EXPECT_EQ(workplace.read("out/m.ktx2"), bytes);
    const json none = levels_of("--measure none");
    EXPECT_EQ(workplace.read("out/m.ktx2"), bytes);
    const json sampled = quick[0]["error"];
    EXPECT_NEAR(sampled["mean"], full[0]["error"]["mean"], sampled["mean_margin"].get<double>());
    EXPECT_LE(sampled["max"].get<double>(), full[0]["error"]["max"].get<double>());
    EXPECT_GT(sampled["share_above_max"].get<double>(), 0.0);
    EXPECT_FALSE(full[0]["error"].contains("mean_margin"));
    EXPECT_EQ(quick[1], full[1]);  // 200 x 200 texels are measured in full.
    EXPECT_FALSE(none[0].contains("error"));
}

TEST(ConvertToTexture, RoughnessIsWrittenWithAllLevels) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    run_texture(workplace, "map.png out/m.dds --mips --roughness-from-variance 0.5");
    EXPECT_EQ(workplace.outputs(), "m-roughness.dds m.dds");
    const GpuTexture roughness = read_texture(workplace / "out/m-roughness.dds");
    EXPECT_EQ(roughness.format, TextureFormat::bc4);
    ASSERT_EQ(roughness.levels.size(), 5U);
    const Image largest = decode_texture_level(roughness, 0);
    EXPECT_NEAR(largest.as<std::uint16_t>()[0], 0.5 * 65535, 20);
    const Image smallest = decode_texture_level(roughness, 4);
    EXPECT_GT(smallest.as<std::uint16_t>()[0], 0.6 * 65535);
}

TEST(ConvertFromTexture, TheMapIsReadBackWithItsConventions) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    for (const char* format : {"bc5", "bc5-snorm", "bc7", "rg16"}) {
        run_texture(workplace, std::string("map.png out/m.ktx2 --green down --format ") + format);
        const ProgramResult result =
            run_texture(workplace, "out/m.ktx2 out/back.png --bits 16 --green up");
        EXPECT_THAT(result.out, HasSubstr("green down (from its metadata)"));
        const Image exact = decode_normal_map(read_image(workplace / "map.png", ImageUse::data),
                                              Green::up, FlatCode::half);
        const Image back = decode_normal_map(read_image(workplace / "out/back.png", ImageUse::data),
                                             Green::up, FlatCode::half);
        for (std::size_t i = 0; i < exact.sample_count(); ++i)
            ASSERT_NEAR(exact.as<float>()[i], back.as<float>()[i], 0.08) << format;
    }
    EXPECT_EQ(workplace.run("relief-bake check out/m.ktx2").exit_code, 0);
}

TEST(ConvertToTexture, Refusals) {
    const Workplace workplace;
    write_waves(workplace, "map.png");
    write_image(workplace / "alpha.png", make_image(4, 4, 4, 8, ColorSpace::data));
    write_image(workplace / "old.png", make_image(4, 4, 3, 8, ColorSpace::data));
    expect_refusals(
        workplace, "relief-bake", "old.png",
        {{"relief-bake convert map.png out/m.png --format bc5", 2,
          "--format: has no effect without an output file .ktx2 or .dds"},
         {"relief-bake convert map.png out/m.png --max-error-kind max", 2,
          "--max-error-kind: has no effect without an output file .ktx2 or .dds"},
         {"relief-bake convert map.png out/m.ktx2 --max-error-kind max", 2,
          "--max-error-kind: has no effect without --max-error"},
         {"relief-bake convert map.png out/m.png --measure none", 2,
          "--measure: has no effect without an output file .ktx2 or .dds"},
         {"relief-bake convert map.png out/m.dds --zstd 3", 2, "--zstd: compresses .ktx2 files"},
         {"relief-bake convert map.png out/m.ktx2 --bits 8", 2,
          "--bits, --half: --format sets the bits of textures"},
         {"relief-bake convert map.png out/m.ktx2 --format rg8 --quality best", 2,
          "--quality: has no effect on rg8"},
         {"relief-bake convert map.png out/m.ktx2 --mips --mip-lengths", 2,
          "--mip-lengths: textures store no lengths"},
         {"relief-bake convert map.png out/m.ktx2 --format bc5 --max-error 0.001", 2,
          "--max-error 0.001: the smallest error of the formats is"},
         {"relief-bake convert alpha.png out/m.ktx2", 2,
          "--format bc5: stores no alpha, which the map has"}});
}

}  // namespace
}  // namespace relief::tools
