// SPDX-License-Identifier: Apache-2.0
// relief-bake mesh as users run it: files in every format, options, refusals, what is written.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A square to bake, 0.25 above the one that Workplace writes, tilted by its normals: to the right,
/// where asked for; or only its left half.
std::string tilted_square(const std::string& normal, double right = 1.0) {
    return fmt::format(
        "v -1 -1 0.25\nv {0} -1 0.25\nv {0} 1 0.25\nv -1 1 0.25\nvn {1}\n"
        "f 1//1 2//1 3//1 4//1\n",
        right, normal);
}

std::vector<std::uint16_t> texel(const Image& image, std::size_t index) {
    const auto samples = image.as<std::uint16_t>();
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto first = samples.begin() + static_cast<std::ptrdiff_t>(index * channels);
    return {first, first + image.channels};
}

TEST(MeshBakeCommand, BakesNormalsAndSaysWhatItDid) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", tilted_square("0.6 0 0.8"));
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 8x4 --report out/report.json");
    EXPECT_EQ(result.error, "");
    ASSERT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr("read      high.obj: 2 triangles\n"
                                      "          low.obj: 2 triangles\n"
                                      "rays      from 0.385 outside to 0.385 inside (found); the "
                                      "surface lies 0.25 to 0.25 outside\n"
                                      "          32 for 32 samples"));
    EXPECT_THAT(result.out, HasSubstr("map       8 x 4: 32 texels baked, 0 missed\n"
                                      "coded     tangent space, by MikkTSpace's tangents, 16 bit, "
                                      "zero at 32767.5 of 65535 (as glTF and engines decode; flat "
                                      "texels are 0.0012 degrees off), green up\n"
                                      "findings  none\n"));
    const Image map = read_image(workplace / "out/map.png", ImageUse::data);
    EXPECT_EQ(map.width, 8);
    EXPECT_EQ(map.height, 4);
    // 32767.5 * (1.6, 1, 1.8): the last two lie between two codes, and 0.8 is rounded to float.
    for (std::size_t i = 0; i < 32; ++i)
        EXPECT_THAT(texel(map, i), ElementsAre(52428, 32768, AnyOf(58981, 58982)));
    const auto said = read_image_info(workplace / "out/map.png").metadata;
    EXPECT_EQ(said.at("relief:content"), "normal map, tangent space");
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(report["texels_baked"], 32);
    EXPECT_EQ(report["high_triangles"], 2);
    EXPECT_NEAR(report["greatest_height"].get<double>(), 0.25, 1e-6);
}

TEST(MeshBakeCommand, TexelsThatMeetNothingAreFilledOrTransparent) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", tilted_square("0.6 0 0.8", 0.0));
    const std::string line = "relief-bake mesh high.obj low.obj out/map.png --size 8 --padding 1 ";
    const ProgramResult result = workplace.run(line + "--background transparent --strict");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.out, HasSubstr("32 x texel missed by its rays"));
    const Image map = read_image(workplace / "out/map.png", ImageUse::data);
    ASSERT_EQ(map.channels, 4);
    EXPECT_THAT(texel(map, 3), ElementsAre(52428, 32768, AnyOf(58981, 58982), 65535));
    EXPECT_EQ(texel(map, 4), texel(map, 3));
    EXPECT_EQ(texel(map, 5), (std::vector<std::uint16_t>{32768, 32768, 65535, 0}));
    EXPECT_EQ(workplace.run(line).exit_code, 0);
    EXPECT_EQ(texel(read_image(workplace / "out/map.png", ImageUse::data), 5),
              (std::vector<std::uint16_t>{32768, 32768, 65535}));
}

TEST(MeshBakeCommand, SeveralHighModelsAreOne) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("left.obj", tilted_square("0.6 0 0.8", 0.0));
    workplace.write("all.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    ASSERT_EQ(workplace
                  .run("relief-bake mesh left.obj all.obj low.obj out/map.exr --size 8 --space "
                       "world --offset 1 --max-distance 0.5 --quiet")
                  .exit_code,
              0);
    const Image map = read_image(workplace / "out/map.exr", ImageUse::data);
    EXPECT_FLOAT_EQ(map.as<float>()[0], 0.8F);
    EXPECT_FLOAT_EQ(map.as<float>()[3 * 7], 0.5F);
    EXPECT_FLOAT_EQ(map.as<float>()[3 * 7 + 2], 1.0F);
    EXPECT_EQ(read_image_info(workplace / "out/map.exr").metadata.at("relief:content"),
              "normal map, world space");
}

TEST(MeshBakeCommand, TakesTheAxesOfAGltfNodeForObjectSpace) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", tilted_square("0.6 0 0.8"));
    ASSERT_EQ(workplace.run("relief-mesh process low.obj out/low.gltf").exit_code, 0);
    // A quarter turn about z: the low square's x axis is the world's y axis.
    std::string text = workplace.read("out/low.gltf");
    json document = json::parse(text);
    document["nodes"][0]["rotation"] = {0, 0, 0.70710678, 0.70710678};
    workplace.write("out/low.gltf", document.dump());
    const auto baked = [&](const std::string& space) {
        EXPECT_EQ(workplace
                      .run("relief-bake mesh high.obj out/low.gltf out/map.exr --size 4 --quiet "
                           "--space " +
                           space)
                      .error,
                  "");
        const Image map = read_image(workplace / "out/map.exr", ImageUse::data);
        const auto samples = map.as<float>();
        return std::vector<float>{samples[0], samples[1], samples[2]};
    };
    const auto near = [](float x, float y, float z) {
        return testing::Pointwise(testing::FloatNear(1e-6F), std::vector<float>{x, y, z});
    };
    EXPECT_THAT(baked("world"), near(0.8F, 0.5F, 0.9F));
    EXPECT_THAT(baked("object"), near(0.5F, 0.2F, 0.9F));
    EXPECT_THAT(baked("tangent"), near(0.5F, 0.2F, 0.9F));
}

/// By whatever path: nothing that is read or written beside is replaced.
TEST(MeshBakeCommand, ReportsAndPicturesAreFilesOfTheirOwn) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", tilted_square("0 0 1"));
    const std::string low = workplace.read("low.obj");
    const std::string here = (workplace / "out").parent_path().string() + "/";
    for (const std::string& option :
         {"--report " + here + "low.obj", "--report " + here + "out/map.png",
          "--preview " + here + "out/map.png", "--verify --error-map " + here + "out/map.png"}) {
        const ProgramResult result =
            workplace.run("relief-bake mesh high.obj low.obj out/map.png --size 8 " + option);
        EXPECT_EQ(result.exit_code, 2) << option;
        EXPECT_THAT(result.error, HasSubstr(": is also the input or the output")) << option;
        EXPECT_EQ(workplace.read("low.obj"), low) << option;
        EXPECT_EQ(workplace.outputs(), "") << option;
    }
}

TEST(MeshBakeRefusal, LeavesEverythingAsItWas) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write_square("plain.obj", true);
    workplace.write("high.obj", tilted_square("0 0 1"));
    expect_refusals(
        workplace, "relief-bake", "map.png",
        {{"relief-bake mesh high.obj plain.obj out/map.png", 1,
          "plain.obj: no texture coordinates"},
         {"relief-bake mesh high.obj none.obj out/map.png", 1, "none.obj: no such file"},
         {"relief-bake mesh high.obj out/map.png", 2, "2 files are too few"},
         {"relief-bake mesh high.obj low.obj out/map.jpg", 2, "out/map.jpg: JPEG distorts normals"},
         {"relief-bake mesh high.txt low.obj out/map.png", 2,
          "high.txt: .txt is not a format that can be read"},
         {"relief-bake mesh high.obj low.obj out/map.png --samples 3", 2,
          "--samples 3: not one of 1, 4, 16, 64, 256, auto"},
         {"relief-bake mesh high.obj low.obj out/map.png --sample-angle 3", 2,
          "--sample-angle: has no effect without --samples auto"},
         {"relief-bake mesh high.obj low.obj out/map.png --cage low.obj --offset 1", 2,
          "--offset, --rays, --hardness: have no effect with --cage"},
         {"relief-bake mesh high.obj low.obj out/map.png --rays face --hardness 1", 2,
          "--hardness: is for --rays averaged"},
         {"relief-bake mesh high.obj low.obj out/map.png --size 16384 --samples 64", 2,
          "--size 16384x16384: with 64 samples a texel, 8192 are the most along a side"},
         {"relief-bake mesh high.obj low.obj out/map.png --size 0", 2, "--size 0"},
         {"relief-bake mesh high.obj low.obj out/none/map.png", 1,
          "out/none/map.png: the folder out/none does not exist"}});
}

}  // namespace
}  // namespace relief::tools
