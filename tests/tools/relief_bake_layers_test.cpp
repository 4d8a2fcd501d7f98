// SPDX-License-Identifier: Apache-2.0
// Encodes layers, and runs relief-bake mesh with layers and with textures of the high models.
#include "mesh_bake.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/statistics.h"
#include "support/images.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using Floats = std::vector<float>;
using Words = std::vector<std::uint16_t>;
using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

template <typename Sample>
std::vector<Sample> codes(const LayerCoding& coding, const std::vector<float>& values,
                          Report& report, bool has_alpha = false) {
    std::vector<TexelState> states(values.size() / coding.channels(), TexelState::baked);
    states.back() = TexelState::empty;
    const std::vector<std::byte> bytes =
        encode_layer(values, states, coding, has_alpha, 100, report);
    std::vector<Sample> samples(bytes.size() / sizeof(Sample));
    std::memcpy(samples.data(), bytes.data(), bytes.size());
    return samples;
}

TEST(LayerCoding, ZeroIsTheMiddleCodeAndSignsAreMirrored) {
    Report report;
    const std::vector<float> heights = {0.0F, 0.5F, -0.5F, 0.25F, -0.25F};
    EXPECT_EQ(codes<std::uint16_t>({LayerKind::height, 16, 0.5}, heights, report),
              (std::vector<std::uint16_t>{32768, 65535, 1, 49152, 16384}));
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::curvature, 8, 0.5}, heights, report),
              (std::vector<std::uint8_t>{128, 255, 1, 192, 64}));
    EXPECT_EQ(codes<float>({LayerKind::height, 32, 0.5}, heights, report), heights);
    EXPECT_EQ(codes<std::uint16_t>({LayerKind::position, 16, 2.0}, {0.0F, 1.0F, -2.0F}, report),
              (std::vector<std::uint16_t>{32768, 49152, 1}));
    EXPECT_TRUE(report.empty());
    // The displacement of a code is its height.
    for (const int bits : {8, 16}) {
        const LayerCoding coding{LayerKind::height, bits, 0.5};
        const double largest = bits == 8 ? 255.0 : 65535.0;
        const double zero = coding.zero_code();
        EXPECT_NEAR((zero / largest - coding.midlevel()) * coding.strength(), 0.0, 1e-15);
        EXPECT_NEAR((1.0 - coding.midlevel()) * coding.strength(), 0.5, 1e-15);
        EXPECT_NEAR((1.0 / largest - coding.midlevel()) * coding.strength(), -0.5, 1e-15);
    }
}

TEST(LayerCoding, OcclusionIsLinearAndColorsAreSrgb) {
    Report report;
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::occlusion, 8, 1.0}, {0.0F, 0.5F, 1.0F}, report),
              (std::vector<std::uint8_t>{0, 128, 255}));
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::color, 8, 1.0}, {0.0F, 0.5F, 1.0F}, report),
              (std::vector<std::uint8_t>{0, 188, 255}));
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::occlusion, 8, 1.0}, {1.0F, 0.5F}, report, true),
              (std::vector<std::uint8_t>{255, 255, 128, 0}));
    EXPECT_EQ(codes<float>({LayerKind::color, 32, 1.0}, {0.0F, 0.5F, 7.0F}, report, true),
              (std::vector<float>{0.0F, 0.5F, 7.0F, 0.0F}));
    EXPECT_TRUE(report.empty());
}

TEST(LayerCoding, CountsValuesOutsideTheRange) {
    Report report;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(
        codes<std::uint8_t>({LayerKind::height, 8, 0.5}, {0.6F, -infinity, nan, 0.1F}, report),
        (std::vector<std::uint8_t>{255, 1, 128, 153}));
    EXPECT_EQ(report.count("height map outside the range of its file"), 3U);
    EXPECT_EQ(report.findings()[0].first, (std::vector<std::size_t>{100, 101, 102}));
    EXPECT_EQ(codes<std::uint8_t>({LayerKind::color, 8, 1.0}, {1.5F, -0.1F, 1.0F}, report),
              (std::vector<std::uint8_t>{255, 0, 255}));
    EXPECT_EQ(report.count("colors outside the range of its file"), 1U);
}

constexpr const char* every_layer =
    "--height-map out/h.{0} --occlusion-map out/o.{0} --curvature-map out/c.{0} --position-map "
    "out/p.{0} --color-map out/k.{0} ";

/// A colored square 0.25 above that of Workplace, or only its left half.
std::string raised_square(double right = 1.0) {
    return fmt::format(
        "v -1 -1 0.25 0.5 0.25 0\nv {0} -1 0.25 0.5 0.25 0\nv {0} 1 0.25 0.5 0.25 0\nv -1 1 0.25 "
        "0.5 0.25 0\nf 1 2 3 4\n",
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

TEST(MeshBakeLayers, AreWrittenWithTheirRange) {
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
    EXPECT_THAT(
        result.out,
        HasSubstr("layers    out/h.png: height map, 16 bit, -0.5 to 0.5\n          out/o.png: "
                  "ambient occlusion, 16 bit\n          out/c.png: curvature, 16 bit, -1 to 1\n    "
                  "      out/p.png: positions, 16 bit, -1 to 1\n          out/k.png: colors, 8 "
                  "bit, sRGB\n          heights as a displacement: strength 1.000015, midlevel "
                  "0.5000076\n          heights for relief-bake bump: --height 1.000015 "
                  "--texel-size 0.35355\n          2048 rays for occlusion\n"));
    EXPECT_EQ(texel<std::uint16_t>(workplace, "out/h.png", 5), (Words{49152}));
    EXPECT_EQ(texel<std::uint16_t>(workplace, "out/o.png", 5), (Words{65535}));
    EXPECT_EQ(texel<std::uint16_t>(workplace, "out/c.png", 5), (Words{32768}));
    // The center of the sixth of eight texels in the first of four rows, at the height 0.25.
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

TEST(MeshBakeLayers, FloatFilesStoreTheValues) {
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

TEST(MeshBakeLayers, HaveABackgroundAndCountValuesOutsideTheirRange) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", raised_square(0.0));
    const std::string line =
        "relief-bake mesh high.obj low.obj out/map.png --size 8 --padding 1 --height-map out/h.png "
        "--color-map out/k.tif --layer-bits 8 --height-range 0.125 --strict ";
    const ProgramResult result = workplace.run(line + "--background transparent");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.out, HasSubstr("40 x height map outside the range of its file"));
    using Bytes = std::vector<std::uint8_t>;
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/h.png", 4), (Bytes{255, 255}));
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/h.png", 5), (Bytes{128, 0}));
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/k.tif", 4), (Bytes{188, 137, 0, 255}));
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/k.tif", 5), (Bytes{0, 0, 0, 0}));
    EXPECT_EQ(workplace.run(line).exit_code, 3);
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/h.png", 5), (Bytes{128}));
}

TEST(MeshBakeLayers, HeightsWithThePrintedStrengthGiveTheBakedNormals) {
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

TEST(MeshBakeLayers, BentNormalsAreCodedAsTheMap) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", raised_square());
    const std::string line =
        "relief-bake mesh high.obj low.obj out/map.png --size 4 --bent-normal-map out/b.png "
        "--occlusion-map out/o.png --layer-bits 8 ";
    const ProgramResult result = workplace.run(line + "--report out/report.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1024 rays for occlusion and bent normals\n"));
    EXPECT_THAT(result.out, HasSubstr("out/b.png: bent normals, 8 bit\n"));
    using Bytes = std::vector<std::uint8_t>;
    EXPECT_EQ(texel<std::uint8_t>(workplace, "out/b.png", 5), (Bytes{128, 128, 255}));
    EXPECT_EQ(json::parse(workplace.read("out/report.json"))["occlusion_rays"], 1024);
    auto said = read_image_info(workplace / "out/b.png").metadata;
    EXPECT_EQ(said.at("relief:content"), "bent normals, tangent space");
    EXPECT_EQ(said.at("relief:green"), "up");
    ASSERT_EQ(workplace.run(line + "--green down --zero-code 128 --space world").exit_code, 0);
    said = read_image_info(workplace / "out/b.png").metadata;
    EXPECT_EQ(said.at("relief:content"), "bent normals, world space");
    EXPECT_EQ(said.at("relief:flat"), "128");
}

/// A cube from (-1,-1,-0.75) to (1,1,0.25).
std::string block() {
    return "v -1 -1 -.75\nv 1 -1 -.75\nv 1 1 -.75\nv -1 1 -.75\nv -1 -1 .25\nv 1 -1 .25\n"
           "v 1 1 .25\nv -1 1 .25\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n"
           "f 4 1 5 8\n";
}

TEST(MeshBakeLayers, ThicknessIsAShareOfItsDistance) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", block());
    const std::string line =
        "relief-bake mesh high.obj low.obj out/map.png --size 4 --thickness-rays 16 ";
    const ProgramResult result = workplace.run(
        line + "--thickness-map out/t.png --thickness-distance 0.5 --report out/report.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("out/t.png: thickness, 16 bit, 0 to 0.5\n"));
    EXPECT_THAT(result.out, HasSubstr("256 rays for thickness, of which "));
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(report["thickness_rays"], 256);
    EXPECT_EQ(report["maps"][0]["layers"][0]["range"], 0.5);
    EXPECT_EQ(read_image_info(workplace / "out/t.png").metadata.at("relief:range"), "0.5");
    // The middle of the block is 1 thick, twice the length of the rays. Those of texels at its
    // corners leave it at the sides.
    EXPECT_EQ(texel<std::uint16_t>(workplace, "out/t.png", 5), (Words{65535}));
    EXPECT_LT(texel<std::uint16_t>(workplace, "out/t.png", 0)[0], 64500);
    ASSERT_EQ(workplace.run(line + "--thickness-map out/t.exr").exit_code, 0);
    const float middle = texel<float>(workplace, "out/t.exr", 5)[0];
    EXPECT_GT(middle, 0.8F);
    EXPECT_LT(middle, 1.3F);
}

TEST(MeshBakeLayers, IdsAreColorsOfMaterialsObjectsAndFiles) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    // The quarters of the square from the lower left: a material, another one, an object, a file.
    const std::string corners =
        "v -1 -1 0\nv 0 -1 0\nv 1 -1 0\nv -1 0 0\nv 0 0 0\nv 1 0 0\nv -1 1 0\nv 0 1 0\nv 1 1 "
        "0\n";
    workplace.write("high.mtl", "newmtl stone\nnewmtl wood\n");
    workplace.write("high.obj", "mtllib high.mtl\n" + corners +
                                    "o top\nf 4 5 8 7\nusemtl stone\nf 1 2 5 4\nusemtl wood\nf 2 3 "
                                    "6 5\n");
    workplace.write("rest.obj", corners + "f 5 6 9 8\n");
    const std::string line =
        "relief-bake mesh high.obj rest.obj low.obj out/map.png --size 4 --id-map out/ids.";
    const ProgramResult result = workplace.run(line + "png --report out/report.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("out/ids.png: ids, 8 bit\n"));
    const json ids = json::parse(workplace.read("out/report.json"))["maps"][0]["layers"][0]["ids"];
    ASSERT_EQ(ids.size(), 4U);
    const auto color_at = [&](std::size_t index) {
        const auto color = texel<std::uint8_t>(workplace, "out/ids.png", index);
        return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
    };
    const std::vector<std::pair<std::string, std::size_t>> places = {
        {"rest", 3}, {"stone", 12}, {"top", 0}, {"wood", 15}};
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_EQ(ids[i]["name"], places[i].first);
        EXPECT_EQ(ids[i]["color"], color_at(places[i].second)) << places[i].first;
        EXPECT_THAT(result.out, HasSubstr(color_at(places[i].second) + " " + places[i].first));
    }
    EXPECT_THAT(read_image_info(workplace / "out/ids.png").metadata.at("relief:ids"),
                HasSubstr(" stone\n"));
    ASSERT_EQ(workplace.run(line + "exr").exit_code, 0);
    const auto code = texel<std::uint8_t>(workplace, "out/ids.png", 12);
    const auto value = texel<float>(workplace, "out/ids.exr", 12);
    for (std::size_t channel = 0; channel < 3; ++channel)
        EXPECT_FLOAT_EQ(value[channel], static_cast<float>(code[channel]) / 255.0F);
}

TEST(MeshBakeLayers, HaveTheNamesOfTiles) {
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

TEST(MeshBakeLayerRefusal, LeavesAllFilesUnchanged) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", raised_square());
    expect_refusals(
        workplace, "relief-bake", "map.png",
        {{"relief-bake mesh high.obj low.obj out/map.png --height-map out/h.jpg", 2,
          "--height-map out/h.jpg: the format cannot store this layer"},
         {"relief-bake mesh high.obj low.obj out/map.png --height-map out/h.png --layer-bits 32", 2,
          "--layer-bits 32: .png holds 16 or 8 bits"},
         {"relief-bake mesh high.obj low.obj out/map.png --layer-bits 8", 2,
          "--layer-bits: has no effect without a layer's file"},
         {"relief-bake mesh high.obj low.obj out/map.png --height-range 1", 2,
          "--height-range: has no effect without --height-map"},
         {"relief-bake mesh high.obj low.obj out/map.png --curvature-map out/c.exr "
          "--curvature-range 1",
          2, "--curvature-range: has no effect on float files"},
         {"relief-bake mesh high.obj low.obj out/map.png --occlusion-rays 9", 2,
          "--occlusion-rays, --occlusion-distance: have no effect without --occlusion-map or "
          "--bent-normal-map"},
         {"relief-bake mesh high.obj low.obj out/map.png --thickness-distance 1", 2,
          "--thickness-rays, --thickness-distance: have no effect without --thickness-map"},
         {"relief-bake mesh high.obj low.obj out/map.png --thickness-map out/t.png "
          "--thickness-distance 0",
          2, "--thickness-distance 0"},
         {"relief-bake mesh high.obj low.obj out/map.png --id-map out/map.png", 1,
          "low.obj: the map and ids would be the same file out/map.png"},
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

/// A square whose material has a color, a texture, and a normal map that is tilted to the right.
void write_models(const Workplace& workplace) {
    workplace.write_square("low.obj");
    workplace.write("high.obj",
                    "mtllib high.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 "
                    "1\nvt 0 1\nusemtl stone\nf 1/1 2/2 3/3 4/4\n");
    workplace.write("high.mtl", "newmtl stone\nKd 1 0.5 0.25\nmap_Kd color.png\nnorm normal.png\n");
    Image color{1, 1, 3, ColorSpace::srgb, std::vector<std::uint8_t>{188, 188, 255}};
    write_image(workplace / "color.png", color);
    Image normal{1, 1, 3, ColorSpace::data, std::vector<std::uint16_t>{52428, 32768, 58982}};
    write_image(workplace / "normal.png", normal);
    normal.samples = std::vector<std::uint16_t>{32768, 52428, 58982};
    write_image(workplace / "other.png", normal);
}

std::vector<std::uint16_t> normal_of(const Workplace& workplace) {
    const Image map = read_image(workplace / "out/map.png", ImageUse::data);
    const auto samples = map.as<std::uint16_t>();
    return {samples.begin(), samples.begin() + 3};
}

const std::string strict_line = "relief-bake mesh high.obj low.obj out/map.png --size 4 --strict ";

TEST(MeshBakeTextures, NormalMapsOfMaterialsAreAddedUnlessOptionsReplaceThem) {
    const Workplace workplace;
    write_models(workplace);
    const ProgramResult result = workplace.run(strict_line);
    ASSERT_EQ(result.exit_code, 0) << result.error << result.out;
    EXPECT_THAT(result.out,
                HasSubstr("high.obj: 2 triangles, 1 normal map added to their normals\n"));
    EXPECT_EQ(normal_of(workplace), (std::vector<std::uint16_t>{52428, 32768, 58982}));
    ASSERT_EQ(workplace.run(strict_line + "--high-normal-map none").exit_code, 0);
    EXPECT_EQ(normal_of(workplace), (std::vector<std::uint16_t>{32768, 32768, 65535}));
    ASSERT_EQ(workplace.run(strict_line + "--high-normal-map other.png").exit_code, 0);
    EXPECT_EQ(normal_of(workplace), (std::vector<std::uint16_t>{32768, 52428, 58982}));
    EXPECT_EQ(workplace.run(strict_line + "--high-normal-map none.png").exit_code, 1);
}

TEST(MeshBakeTextures, AreNotReplacedByMaps) {
    const Workplace workplace;
    write_models(workplace);
    const std::string line = "relief-bake mesh high.obj low.obj --size 4 ";
    const std::string problem = ": would replace a texture of a high model";
    expect_refusals(workplace, "relief-bake", "map.png",
                    {{line + "normal.png", 2, "normal.png" + problem},
                     {line + "color.png", 2, "color.png" + problem},  // Although it is not read.
                     {line + "out/map.png --high-normal-map other.png --color-map ./other.png", 2,
                      "./other.png" + problem},
                     {line + "out/map.png --preview normal.png", 2,
                      "--preview normal.png: is also the input"}});
}

TEST(MeshBakeTextures, GltfFilesGiveTheSame) {
    const Workplace workplace;
    write_models(workplace);
    ASSERT_EQ(workplace.run("relief-mesh process high.obj out/high.glb").exit_code, 0);
    const ProgramResult result = workplace.run(
        "relief-bake mesh out/high.glb low.obj out/map.png --size 4 --color-map out/k.exr");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 normal map added to their normals, 1 color texture\n"));
    EXPECT_NEAR(normal_of(workplace)[0], 52428, 2);
    const Image colors = read_image(workplace / "out/k.exr", ImageUse::data);
    EXPECT_NEAR(colors.as<float>()[0], 0.50288646F, 1e-6F);
    EXPECT_NEAR(colors.as<float>()[1], 0.25144323F, 1e-6F);
    EXPECT_NEAR(colors.as<float>()[2], 0.25F, 1e-6F);
}

TEST(MeshBakeTextures, ColorsAreThoseOfMaterialsOrOfAFileOrNone) {
    const Workplace workplace;
    write_models(workplace);
    const auto color = [&](const std::string& options) {
        const ProgramResult result =
            workplace.run(strict_line + "--color-map out/k.png " + options);
        EXPECT_EQ(result.exit_code, 0) << result.error << result.out;
        const Image image = read_image(workplace / "out/k.png", ImageUse::data);
        const auto samples = image.as<std::uint8_t>();
        return std::vector<int>{samples[0], samples[1], samples[2]};
    };
    EXPECT_EQ(color(""), (std::vector<int>{188, 137, 137}));
    EXPECT_EQ(color("--high-color none"), (std::vector<int>{255, 255, 255}));
    EXPECT_EQ(color("--high-color color.png"), (std::vector<int>{188, 188, 255}));
    EXPECT_EQ(workplace.run(strict_line + "--high-color none").exit_code, 2);
}

TEST(LayerCoding, ColorsOf8BitsAreRoundedAlongTheCurve) {
    std::vector<float> values = {0.0F, 1.0F, 0.5F};
    for (int code = 1; code < 256; ++code) {
        const float limit = linear_from_srgb((static_cast<float>(code) - 0.5F) / 255.0F);
        for (int step = -150; step < 150; ++step)
            values.push_back(std::bit_cast<float>(std::bit_cast<int>(limit) + step));
    }
    Report report;
    const std::vector<std::uint8_t> stored =
        codes<std::uint8_t>({LayerKind::color, 8, 1.0}, values, report);
    ASSERT_EQ(stored.size(), values.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double coded = static_cast<double>(srgb_from_linear(values[i]));
        if (stored[i] != static_cast<std::uint8_t>(std::round(255.0 * coded))) ++differing;
    }
    EXPECT_EQ(differing, 0U);
    EXPECT_TRUE(report.empty());
}

TEST(LayerCoding, AlphaIsTheOpacityOfTexelsThatAreFilled) {
    const std::vector<float> values(9, 1.0F);
    const std::vector<float> opacity = {0.5F, 0.25F, 1.0F};
    const std::vector<TexelState> states = {TexelState::baked, TexelState::padded,
                                            TexelState::empty};
    const std::vector<std::byte> bytes =
        encode_layer(values, states, {LayerKind::color, 8, 1.0}, true, 0, IgnoredReport(), opacity);
    ASSERT_EQ(bytes.size(), 12U);
    EXPECT_EQ(static_cast<int>(bytes[3]), 128);
    EXPECT_EQ(static_cast<int>(bytes[7]), 64);
    EXPECT_EQ(static_cast<int>(bytes[11]), 0);
}

TEST(MeshBakeTextures, TransparentMaterialsGiveColorsWithAlpha) {
    const Workplace workplace;
    write_models(workplace);
    const auto baked = [&](const std::string& options) {
        const ProgramResult result =
            workplace.run(strict_line + "--color-map out/k.png --high-normal-map none " + options);
        EXPECT_EQ(result.exit_code, 0) << result.error << result.out;
        return texel<std::uint8_t>(workplace, "out/k.png", 5);
    };
    using Bytes = std::vector<std::uint8_t>;
    write_image(workplace / "color.png", test::image_of<std::uint8_t>(4, {188, 188, 255, 128}));
    // An opaque material has no alpha, whatever its texture holds.
    EXPECT_EQ(baked(""), (Bytes{188, 137, 137}));
    workplace.write("high.mtl", "newmtl stone\nKd 1 0.5 0.25\nd 0.5\nmap_Kd color.png\n");
    EXPECT_EQ(baked(""), (Bytes{188, 137, 137, 64}));
    EXPECT_EQ(read_image_info(workplace / "out/k.png").metadata.at("relief:alpha"), "opacity");
    EXPECT_EQ(baked("--background transparent"), (Bytes{188, 137, 137, 64}));
    EXPECT_EQ(baked("--high-color none"), (Bytes{255, 255, 255}));
    workplace.write("high.mtl", "newmtl stone\nKd 1 0.5 0.25\nmap_Kd color.png\nmap_d color.png\n");
    EXPECT_EQ(baked(""), (Bytes{188, 137, 137, 128}));
    workplace.write("high.mtl", "newmtl stone\nKd 1 0.5 0.25\n");
    EXPECT_EQ(baked("--high-color color.png"), (Bytes{188, 188, 255, 128}));
}

}  // namespace
}  // namespace relief::tools
