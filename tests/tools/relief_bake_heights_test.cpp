// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake heights: heights whose normals are those of the map, and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/statistics.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusal;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// The root mean square angle between two maps of the workplace, in degrees.
double rms_angle(const Workplace& workplace, const char* a, const char* b) {
    Report report;
    const auto normals = [&](const char* file) {
        return decode_normal_map(read_image(workplace / file, ImageUse::data), Green::up,
                                 FlatCode::half, report);
    };
    const Image one = normals(a), other = normals(b);
    double squares = 0.0;
    for (std::size_t i = 0; i < one.sample_count(); i += 3) {
        const auto at = [i](const Image& image) {
            return glm::dvec3(image.as<float>()[i], image.as<float>()[i + 1],
                              image.as<float>()[i + 2]);
        };
        const double angle = degrees_between(at(one), at(other));
        squares += angle * angle;
    }
    return std::sqrt(squares * 3.0 / static_cast<double>(one.sample_count()));
}

/// The command after "inverse", with the output file out/back.png.
std::string way_back(const std::string& summary) {
    const std::size_t begin = summary.find("relief-bake bump");
    std::string line = summary.substr(begin, summary.find('\n', begin) - begin);
    return line.replace(line.find("normals.png"), 11, "out/back.png");
}

TEST(HeightsCommand, PrintsTheInverseCommand) {
    const Workplace workplace;
    workplace.write_bricks("bricks.png");
    EXPECT_EQ(workplace
                  .run("relief-bake bump bricks.png out/map.png --strength 20 --kernel sobel3 "
                       "--wrap repeat --quiet")
                  .exit_code,
              0);
    for (const char* options :
         {"out/heights.png", "out/heights.exr", "out/heights.tif --bits 32"}) {
        const ProgramResult result = workplace.run(std::string("relief-bake heights out/map.png ") +
                                                   options + " --kernel sobel3");
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_THAT(result.out, HasSubstr("findings  none\n"));
        const std::string command = way_back(result.out);
        EXPECT_THAT(command, HasSubstr(" --kernel sobel3 --wrap repeat"));
        EXPECT_EQ(workplace.run(command).exit_code, 0) << command;
        // The error is that of the 16-bit codes of the map and of the heights.
        EXPECT_LT(rms_angle(workplace, "out/map.png", "out/back.png"), 0.02) << options;
    }
}

TEST(HeightsCommand, AMapWithoutHeightsIsAFinding) {
    const Workplace workplace;
    // The slope along x depends on y only: its mean over a row is a ramp, and the rest a curl.
    Image normals = make_image(32, 32, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 32 * 32; ++i) {
        const bool leans_left = i / 32 % 16 < 8;
        normals.as<float>()[3 * i] = leans_left ? 0.6F : -0.6F;
        normals.as<float>()[3 * i + 2] = 0.8F;
    }
    Report report;
    write_image(workplace / "curl.png", encode_normal_map(normals, {.bits = 16}, report));
    const std::string line =
        "relief-bake heights curl.png out/h.png --input-green up --wrap repeat --strict ";
    const ProgramResult result = workplace.run(line + "--report out/r.json");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.out,
                HasSubstr("1 x map whose slopes are not those of a height field (map 0): "));
    EXPECT_THAT(result.out, HasSubstr("degrees (RMS) of it are lost, more than the limit of 5: "));
    const json residual = json::parse(workplace.read("out/r.json"))["residual_degrees"];
    // All of it: atan(0.75).
    EXPECT_NEAR(residual["rms"].get<double>(), 36.87, 0.1);
    EXPECT_EQ(workplace.run(line + "--max-residual 40").exit_code, 0);
    EXPECT_EQ(workplace.run(line + "--max-residual 36").exit_code, 3);
}

TEST(HeightsCommand, DescribesTheHeightsInTheReportAndTheFile) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief-bake heights data/scenes/bricks-normal.png out/heights.png --report "
        "out/report.json --wrap mirror,repeat --level");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(report["tool"], "relief-bake heights");
    EXPECT_EQ(report["green"], "up");
    EXPECT_EQ(report["green_by_slopes"], true);
    EXPECT_EQ(report["wrap"], "mirror,repeat");
    EXPECT_EQ(report["kernel"], "central7");
    EXPECT_EQ(report["bits"], 16);
    EXPECT_EQ(report["strength"], report["highest"]);
    EXPECT_GT(report["highest"], 4.0);
    EXPECT_LT(report["highest"], 6.0);
    EXPECT_LT(report["residual_degrees"]["rms"], 2.0);
    EXPECT_LT(report["step_degrees"], 0.01);
    const auto metadata = read_image_info(workplace / "out/heights.png").metadata;
    EXPECT_EQ(metadata.at("relief:content"), "height map");
    EXPECT_NEAR(std::stod(metadata.at("relief:strength")), report["strength"].get<double>(), 1e-6);
}

TEST(HeightsCommand, RefusesToGuessGreenAndUnsuitableFormats) {
    const Workplace workplace;
    Image flat = make_image(8, 8, 3, 8, ColorSpace::data);
    for (std::size_t i = 0; i < flat.sample_count(); ++i)
        flat.as<std::uint8_t>()[i] = i % 3 == 2 ? 255 : 128;
    write_image(workplace / "flat.png", flat);
    for (const auto& [line, code, message] :
         {test::Refused{"relief-bake heights flat.png out/old.png", 1,
                        "flat.png: the direction of the green channel is unknown, and the slopes "
                        "do not show it (give --input-green)"},
          test::Refused{"relief-bake heights flat.png out/old.png --bits 32", 2,
                        "--bits 32: .png holds 16 or 8 bits"},
          test::Refused{"relief-bake heights flat.png out/old.jpg", 2,
                        "out/old.jpg: the format cannot store heights (use .png, .tif or .exr)"},
          test::Refused{"relief-bake heights flat.png out/old.png --wrap auto,clamp,repeat", 2,
                        "--wrap auto,clamp,repeat: names more than two axes"},
          test::Refused{
              "relief-bake heights flat.png flat.png", 2,
              "flat.png: would replace the normal map (choose another output file or folder)"},
          test::Refused{"relief-bake heights data/bricks-height.png out/old.png", 1,
                        "data/bricks-height.png: has 1 channel, but normals need at least 2"}}) {
        expect_refusal(workplace, "relief-bake", {line, code, message}, "old.png");
    }
    EXPECT_EQ(workplace.run("relief-bake heights flat.png out/h.png --input-green up").exit_code,
              0);
}

}  // namespace
}  // namespace relief::tools
