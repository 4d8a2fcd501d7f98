// SPDX-License-Identifier: Apache-2.0
// relief-bake mesh with other layers than normals, as users run it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "relief/mesh/direction_error.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

constexpr const char* every_layer =
    "--height-map out/h.{0} --occlusion-map out/o.{0} --curvature-map out/c.{0} --position-map "
    "out/p.{0} --color-map out/k.{0} ";

/// A square 0.25 above that of Workplace, of a colour; or only its left half.
std::string raised_square(double right = 1.0) {
    return fmt::format(
        "v -1 -1 0.25 0.5 0.25 0\nv {0} -1 0.25 0.5 0.25 0\nv {0} 1 0.25 0.5 0.25 0\n"
        "v -1 1 0.25 0.5 0.25 0\nf 1 2 3 4\n",
        right);
}

template <typename Sample>
std::vector<Sample> texel(const Workplace& workplace, const std::string& file, std::size_t index) {
    const Image image = read_image(workplace / file, ImageUse::data);
    const auto samples = image.as<Sample>();
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto first = samples.begin() + static_cast<std::ptrdiff_t>(index * channels);
    return {first, first + image.channels};
}

using Words = std::vector<std::uint16_t>;
using Floats = std::vector<float>;

TEST(MeshBakeLayers, AreWrittenBesideTheMapWithWhatTheirNumbersMean) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", raised_square());
    const std::string line = "relief-bake mesh high.obj low.obj out/map.png --size 8x4 ";
    ASSERT_EQ(workplace.run(line).exit_code, 0);
    const std::string alone = workplace.read("out/map.png");
    const ProgramResult result =
        workplace.run(line + fmt::format(fmt::runtime(every_layer), "png") +
                      "--height-range 0.5 --report out/report.json");
    EXPECT_EQ(result.error, "");
    ASSERT_EQ(result.exit_code, 0);
    EXPECT_EQ(workplace.read("out/map.png"), alone);
    EXPECT_THAT(result.out,
                HasSubstr("layers    out/h.png: height map, 16 bit, -0.5 to 0.5\n"
                          "          out/o.png: ambient occlusion, 16 bit\n"
                          "          out/c.png: curvature, 16 bit, -1 to 1\n"
                          "          out/p.png: positions, 16 bit, -1 to 1\n"
                          "          out/k.png: colours, 8 bit, sRGB\n"
                          "          heights as a displacement: strength 1.000015, midlevel "
                          "0.5000076\n"
                          "          heights for relief-bake bump: --height 1.000015 --texel-size "
                          "0.35355\n"
                          "          2048 rays for occlusion\n"));
    EXPECT_EQ(texel<std::uint16_t>(workplace, "out/h.png", 5), (Words{49152}));
    EXPECT_EQ(texel<std::uint16_t>(workplace, "out/o.png", 5), (Words{65535}));
    EXPECT_EQ(texel<std::uint16_t>(workplace, "out/c.png", 5), (Words{32768}));
    // The centre of the sixth of eight texels, in the first of four rows; 0.25 high.
    EXPECT_EQ(texel<std::uint16_t>(workplace, "out/p.png", 5), (Words{45056, 57343, 40960}));
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/k.png", 5),
              (std::vector<std::uint8_t>{188, 137, 0}));
    const auto said = read_image_info(workplace / "out/h.png").metadata;
    EXPECT_EQ(said.at("relief:content"), "height map");
    EXPECT_EQ(said.at("relief:range"), "0.5");
    EXPECT_EQ(said.at("relief:zero"), "32768");
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(report["occlusion_rays"], 2048);
    const json layers = report["maps"][0]["layers"];
    ASSERT_EQ(layers.size(), 5U);
    EXPECT_EQ(layers[0]["content"], "height map");
    EXPECT_EQ(layers[0]["range"], 0.5);
    EXPECT_EQ(layers[4]["bits"], 8);
}

TEST(MeshBakeLayers, OfFloatsAreTheNumbersThemselves) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", raised_square());
    const ProgramResult result =
        workplace.run("relief-bake mesh high.obj low.obj out/map.png --size 4 " +
                      fmt::format(fmt::runtime(every_layer), "exr"));
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(texel<float>(workplace, "out/h.exr", 0), (Floats{0.25F}));
    EXPECT_EQ(texel<float>(workplace, "out/o.exr", 0), (Floats{1.0F}));
    EXPECT_EQ(texel<float>(workplace, "out/c.exr", 0), (Floats{0.0F}));
    EXPECT_EQ(texel<float>(workplace, "out/p.exr", 0), (Floats{-0.75F, 0.75F, 0.25F}));
    EXPECT_EQ(texel<float>(workplace, "out/k.exr", 0), (Floats{0.5F, 0.25F, 0.0F}));
}

TEST(MeshBakeLayers, HaveABackgroundAndCountWhatIsBeyondTheirRange) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", raised_square(0.0));
    const std::string line =
        "relief-bake mesh high.obj low.obj out/map.png --size 8 --padding 1 --height-map out/h.png "
        "--color-map out/k.tif --layer-bits 8 --height-range 0.125 --strict ";
    const ProgramResult result = workplace.run(line + "--background transparent");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.out, HasSubstr("40 x height map beyond what its file holds"));
    using Bytes = std::vector<std::uint8_t>;
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/h.png", 4), (Bytes{255, 255}));
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/h.png", 5), (Bytes{128, 0}));
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/k.tif", 4), (Bytes{188, 137, 0, 255}));
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/k.tif", 5), (Bytes{0, 0, 0, 0}));
    EXPECT_EQ(workplace.run(line).exit_code, 3);
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/h.png", 5), (Bytes{128}));
}

TEST(MeshBakeLayers, HeightsMakeTheNormalsThatAreBakedByTheStrengthPrinted) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    std::string text;
    constexpr int cells = 200;
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x) {
            const double u = 2.0 * x / cells - 1.0, v = 2.0 * y / cells - 1.0;
            text += fmt::format("v {} {} {}\n", u, v, 0.04 * std::sin(9 * u) * std::cos(7 * v));
        }
    }
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            const int a = y * (cells + 1) + x + 1, b = a + cells + 1;
            text += fmt::format("f {} {} {} {}\n", a, a + 1, b + 1, b);
        }
    }
    workplace.write("high.obj", text);
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 256 --height-map out/h.png");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const std::string before = "for relief-bake bump: ";
    const std::size_t begin = result.out.find(before) + before.size();
    const std::string options = result.out.substr(begin, result.out.find('\n', begin) - begin);
    ASSERT_EQ(workplace.run("relief-bake bump out/h.png out/n.png --wrap clamp " + options).error,
              "");
    Report report;
    const auto normals = [&](const char* file) {
        return decode_normal_map(read_image(workplace / file, ImageUse::data), Green::up,
                                 FlatCode::half, report);
    };
    const Image baked = normals("out/map.png");
    const Image made = normals("out/n.png");
    double sum = 0.0, slope = 0.0;
    const auto normal = [](const Image& image, std::size_t i) {
        const std::span<const float> n = image.as<float>();
        return glm::dvec3(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
    };
    for (std::size_t i = 0; i < 256UL * 256UL; ++i) {
        sum += degrees_between(normal(baked, i), normal(made, i)) / (256 * 256);
        slope += degrees_between(normal(baked, i), {0, 0, 1}) / (256 * 256);
    }
    EXPECT_GT(slope, 8.0);
    EXPECT_LT(sum, 0.15);
}

TEST(MeshBakeLayers, HaveTheNamesOfTilesToo) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", raised_square());
    ASSERT_EQ(workplace
                  .run("relief-bake mesh high.obj low.obj 'out/<material>.<UDIM>.png' --size 4 "
                       "--occlusion-map 'out/<material>-ao.<UDIM>.png'")
                  .exit_code,
              0);
    EXPECT_EQ(workplace.outputs(), "no-material-ao.1001.png no-material.1001.png");
}

TEST(MeshBakeLayerRefusal, LeavesEverythingAsItWas) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", raised_square());
    expect_refusals(
        workplace, "relief-bake", "map.png",
        {{"relief-bake mesh high.obj low.obj out/map.png --height-map out/h.jpg", 2,
          "--height-map out/h.jpg: no format for it"},
         {"relief-bake mesh high.obj low.obj out/map.png --height-map out/h.png --layer-bits 32", 2,
          "--layer-bits 32: .png holds 16 or 8 bits"},
         {"relief-bake mesh high.obj low.obj out/map.png --layer-bits 8", 2,
          "--layer-bits: has no effect without a layer's file"},
         {"relief-bake mesh high.obj low.obj out/map.png --height-range 1", 2,
          "--height-range: has no effect without --height-map"},
         {"relief-bake mesh high.obj low.obj out/map.png --curvature-map out/c.exr "
          "--curvature-range 1",
          2, "--curvature-range: has no effect on floats"},
         {"relief-bake mesh high.obj low.obj out/map.png --occlusion-rays 9", 2,
          "--occlusion-rays, --occlusion-distance: have no effect without --occlusion-map"},
         {"relief-bake mesh high.obj low.obj out/map.png --occlusion-map out/o.png "
          "--occlusion-rays 0",
          2, "--occlusion-rays 0"},
         {"relief-bake mesh high.obj low.obj out/map.png --occlusion-map 'out/o.<UDIM>.png'", 2,
          "out/o.<UDIM>.png: <UDIM> must be in the names of all files, or of none"},
         {"relief-bake mesh high.obj low.obj out/map.png --occlusion-map out/map.png", 1,
          "low.obj: the map and ambient occlusion would be the same file out/map.png"},
         {"relief-bake mesh high.obj low.obj out/map.png --color-map out/none/k.png", 1,
          "out/none/k.png: the folder out/none does not exist"}});
}

}  // namespace
}  // namespace relief::tools
