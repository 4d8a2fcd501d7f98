// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake mesh: maps of one and of several materials and tiles, progress, and refusals.
#include "mesh_bake.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
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

/// A square 0.25 above that of Workplace, whose normals are tilted,
/// or only its left half.
std::string tilted_square(const std::string& normal, double right = 1.0) {
    return fmt::format(
        "v -1 -1 0.25\nv {0} -1 0.25\nv {0} 1 0.25\nv -1 1 0.25\nvn {1}\nf 1//1 2//1 3//1 4//1\n",
        right, normal);
}

std::vector<std::uint16_t> texel(const Image& image, std::size_t index) {
    const auto samples = image.as<std::uint16_t>();
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto first = samples.begin() + static_cast<std::ptrdiff_t>(index * channels);
    return {first, first + image.channels};
}

TEST(MeshBakeCommand, BakesNormalsAndPrintsASummary) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", tilted_square("0.6 0 0.8"));
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 8x4 --report out/report.json");
    EXPECT_EQ(result.error, "");
    ASSERT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out,
                HasSubstr("read      high.obj: 2 triangles\n          low.obj: 2 triangles\nrays   "
                          "   from 0.385 outside to 0.385 inside (automatic); the surface is 0.25 "
                          "to 0.25 outside\n          32 for 32 samples"));
    EXPECT_THAT(
        result.out,
        HasSubstr(
            "map       8 x 4: 32 texels baked, 0 missed\nformat    tangent space, with MikkTSpace "
            "tangents, 16 bit, zero at 32767.5 of 65535 (the decoding of glTF and engines; flat "
            "texels have an error of 0.0012 degrees), green up\nfindings  none\n"));
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
    EXPECT_NEAR(report["max_height"].get<double>(), 0.25, 1e-6);
}

TEST(MeshBakeCommand, MissedTexelsAreFilledOrTransparent) {
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

TEST(MeshBakeCommand, SeveralHighModelsAreBakedTogether) {
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

TEST(MeshBakeCommand, UsesTheAxesOfAGltfNodeForObjectSpace) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", tilted_square("0.6 0 0.8"));
    ASSERT_EQ(workplace.run("relief-mesh process low.obj out/low.gltf").exit_code, 0);
    // A quarter turn about z: the x axis of the low square is the y axis of the world.
    std::string text = workplace.read("out/low.gltf");
    json document = json::parse(text);
    document["nodes"][0]["rotation"] = {0, 0, 0.70710678, 0.70710678};
    workplace.write("out/low.gltf", document.dump());
    const auto baked = [&](const std::string& space) {
        EXPECT_EQ(
            workplace
                .run(
                    "relief-bake mesh high.obj out/low.gltf out/map.exr --size 4 --quiet --space " +
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

/// Different paths of the same file are recognized: no input and no other output is replaced.
TEST(MeshBakeCommand, ReportsAndPicturesAreSeparateFiles) {
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

TEST(MeshBakeRefusal, LeavesAllFilesUnchanged) {
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
         {"relief-bake mesh high.obj low.obj out/map.jpg", 2,
          "out/map.jpg: JPEG compression distorts normals"},
         {"relief-bake mesh high.txt low.obj out/map.png", 2,
          "high.txt: .txt is not a format that can be read"},
         {"relief-bake mesh high.obj low.obj out/map.png --samples 3", 2,
          "--samples 3: not one of 1, 4, 16, 64, 256, auto"},
         {"relief-bake mesh high.obj low.obj out/map.png --sample-angle 3", 2,
          "--sample-angle: has no effect without --samples auto"},
         {"relief-bake mesh high.obj low.obj out/map.png --cage low.obj --offset 1", 2,
          "--offset, --rays, --hardness: have no effect with --cage"},
         {"relief-bake mesh high.obj low.obj out/map.png --rays face --hardness 1", 2,
          "--hardness: has no effect without --rays averaged"},
         {"relief-bake mesh high.obj low.obj out/map.png --size 16384 --samples 64", 2,
          "--size 16384x16384: with 64 samples per texel, the maximum side is 8192"},
         {"relief-bake mesh high.obj low.obj out/map.png --size 0", 2, "--size 0"},
         {"relief-bake mesh high.obj low.obj out/none/map.png", 1,
          "out/none/map.png: the folder out/none does not exist"}});
}

/// Squares of side 2 in a row, with separate materials and texture coordinates.
class Sets : public testing::Test {
  protected:
    struct Square {
        std::string material;
        double u = 0.0, v = 0.0;  ///< Of its lower left corner, v upwards.
        std::string normal = "0 0 1";
    };

    /// Writes the low model, and a high one 0.1 above it with different normals for each square.
    void write(const std::vector<Square>& squares) const {
        std::string low, high;
        for (std::size_t i = 0; i < squares.size(); ++i) {
            const Square& square = squares[i];
            const double x = 2.0 * static_cast<double>(i);
            for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                low += fmt::format("v {} {} 0\nvt {} {}\n", x + 2 * dx, 2 * dy, square.u + dx,
                                   square.v + dy);
                high += fmt::format("v {} {} 0.1\nvn {}\n", x + 2 * dx, 2 * dy, square.normal);
            }
            if (!square.material.empty()) low += "usemtl " + square.material + "\n";
            low += "f -4/-4 -3/-3 -2/-2 -1/-1\n";
            high += "f -4//-4 -3//-3 -2//-2 -1//-1\n";
        }
        place_.write("low.obj", low);
        place_.write("high.obj", high);
    }

    [[nodiscard]] ProgramResult bake(const std::string& output,
                                     const std::string& more = "") const {
        return place_.run("relief-bake mesh high.obj low.obj '" + output +
                          "' --size 8 --rays face " + more);
    }

    /// Decodes the first texel of a map.
    [[nodiscard]] std::vector<double> first_texel(const std::string& file) const {
        const Image map = read_image(place_ / file, ImageUse::data);
        std::vector<double> direction;
        for (std::size_t i = 0; i < 3; ++i)
            direction.push_back((map.as<std::uint16_t>()[i] - 32768.0) / 32767.0);
        return direction;
    }

    static auto near(double x, double y, double z) {
        return testing::Pointwise(testing::DoubleNear(1e-4), std::vector<double>{x, y, z});
    }

    const Workplace place_;
};

const char* const leaning_right = "0.6 0 0.8";
const char* const leaning_up = "0 0.6 0.8";

TEST_F(Sets, MaterialsInTheUnitSquareHaveSeparateMaps) {
    write({{"Skin", 0, 0, leaning_right}, {"Cloth/red", 0, 0, leaning_up}});
    const ProgramResult result = bake("out/<material>_n.png", "--report out/report.json");
    EXPECT_EQ(result.error, "");
    ASSERT_EQ(result.exit_code, 0);
    EXPECT_EQ(place_.outputs(), "Cloth_red_n.png Skin_n.png report.json");
    EXPECT_THAT(first_texel("out/Skin_n.png"), near(0.6, 0, 0.8));
    EXPECT_THAT(first_texel("out/Cloth_red_n.png"), near(0, 0.6, 0.8));
    EXPECT_THAT(result.out,
                HasSubstr("maps      material 'Skin': 8 x 8: 64 texels baked, 0 missed\n          "
                          "material 'Cloth/red': 8 x 8: 64 texels baked, 0 missed\n"));
    EXPECT_THAT(result.out, HasSubstr("wrote     out/Skin_n.png: "));
    EXPECT_THAT(result.out, HasSubstr("\n          out/Cloth_red_n.png: "));
    const json report = json::parse(place_.read("out/report.json"));
    ASSERT_EQ(report["maps"].size(), 2U);
    EXPECT_EQ(report["maps"][1]["output"], "out/Cloth_red_n.png");
    EXPECT_EQ(report["maps"][1]["material"], "Cloth/red");
    EXPECT_EQ(report["maps"][1]["texels_baked"], 64);
    EXPECT_EQ(report["texels_baked"], 128);
    // Two materials that no MTL file defines are reported; texels are not.
    EXPECT_THAT(report["findings"].dump(), testing::Not(HasSubstr("texel")));
}

TEST_F(Sets, WithoutTheWordThereIsOneMapAndAWarning) {
    write({{"Skin", 0, 0, leaning_right}, {"Cloth", 0, 0, leaning_up}});
    const ProgramResult result = bake("out/n.png");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(
        result.error,
        "relief-bake: warning: low.obj: 2 materials share one map, in which some texels belong to "
        "several triangles (<material> in the map's name writes a map for each material)\n");
    EXPECT_THAT(result.out, HasSubstr("64 x texel of several triangles"));
    EXPECT_THAT(result.out, HasSubstr("map       8 x 8: 64 texels baked"));
    // The materials of an atlas share no texel, so there is no warning.
    write({{"Skin", 0, 0, leaning_right}, {"Cloth", 1, 0, leaning_up}});
    EXPECT_EQ(bake("out/n.png").error, "");
}

TEST_F(Sets, EachTileHasAMapWithItsNumber) {
    write({{"", 0, 0, leaning_right}, {"", 1, 0, leaning_up}, {"", 0, 2, "-0.6 0 0.8"}});
    const ProgramResult result = bake("out/n.<UDIM>.png", "--report out/report.json --strict");
    EXPECT_EQ(result.error, "");
    ASSERT_EQ(result.exit_code, 0);
    EXPECT_EQ(place_.outputs(), "n.1001.png n.1002.png n.1021.png report.json");
    EXPECT_THAT(first_texel("out/n.1001.png"), near(0.6, 0, 0.8));
    EXPECT_THAT(first_texel("out/n.1002.png"), near(0, 0.6, 0.8));
    EXPECT_THAT(first_texel("out/n.1021.png"), near(-0.6, 0, 0.8));
    EXPECT_THAT(result.out, HasSubstr("tile 1021: 8 x 8: 64 texels baked, 0 missed\n"));
    const json report = json::parse(place_.read("out/report.json"));
    EXPECT_EQ(report["maps"][2]["tile"], 1021);
    EXPECT_FALSE(report["maps"][2].contains("material"));
}

TEST_F(Sets, BothWordsGiveEveryTileOfEveryMaterial) {
    write({{"A", 0, 0, leaning_right}, {"B", 0, 0, leaning_up}, {"B", 1, 0, leaning_right}});
    EXPECT_EQ(bake("out/<UDIM>_<material>.png").error, "");
    EXPECT_EQ(place_.outputs(), "1001_A.png 1001_B.png 1002_B.png");
    EXPECT_THAT(first_texel("out/1001_B.png"), near(0, 0.6, 0.8));
}

TEST(MeshPairs, AreBakedByTheNamesOfTheirFiles) {
    const Workplace place;
    const std::string high = "v -1 -1 0.05\nv 1 -1 0.05\nv 1 1 0.05\nv -1 1 0.05\n";
    place.write("Rock_high.obj", high + "f 1 2 3 4\n");
    place.write("pot-high.obj", high + "f 1 2 3 4\n");
    place.write_square("Rock_low.obj");
    place.write_square("pot-low.obj");
    const std::string models =
        "relief-bake mesh Rock_high.obj pot-high.obj pot-low.obj Rock_low.obj --size 8 ";
    const ProgramResult result = place.run(models + "-o out/maps/ --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("out/maps/pot.png: 8 x 8, 1 map, 0 texels missed, no "
                                      "findings, "));
    EXPECT_THAT(result.out, HasSubstr("out/maps/Rock.png: 8 x 8, "));
    const json report = json::parse(place.read("out/r.json"));
    ASSERT_EQ(report["files"].size(), 2U);
    EXPECT_EQ(report["files"][1]["high"], json({"Rock_high.obj"}));
    // A single bake writes the same bytes.
    ASSERT_EQ(place.run("relief-bake mesh Rock_high.obj Rock_low.obj out/r.png --size 8").exit_code,
              0);
    EXPECT_EQ(place.read("out/maps/Rock.png"), place.read("out/r.png"));
    // The name of the pair stands in the names of all files.
    ASSERT_EQ(place
                  .run(models + "-o 'out/<model>_n.png' --occlusion-map 'out/<model>_o.png' "
                                "--quiet")
                  .exit_code,
              0);
    EXPECT_TRUE(std::filesystem::exists(place / "out/pot_o.png"));
    EXPECT_TRUE(std::filesystem::exists(place / "out/Rock_n.png"));
    const auto refusal = [&](const std::string& line) {
        const ProgramResult refused = place.run(line);
        EXPECT_EQ(refused.exit_code, 2) << line;
        return refused.first_error_line();
    };
    EXPECT_THAT(refusal(models + "-o out/ --occlusion-map out/o.png"),
                HasSubstr("out/o.png: several bakes would write or read it"));
    EXPECT_THAT(refusal("relief-bake mesh Rock_high.obj pot-low.obj -o out/"),
                HasSubstr("has no "));
    EXPECT_THAT(refusal("relief-bake mesh Rock_high.obj a.obj -o out/"),
                HasSubstr("a.obj: has no pair name (name the models X_high and X_low)"));
}

TEST_F(Sets, SuggestsRepeatForIslandsOutsideTheMap) {
    const auto finding = [&](const std::string& corners) {
        place_.write("high.obj",
                     "v 0 0 0.1\nv 1 0 0.1\nv 1 1 0.1\nv 0 1 0.1\nv 2 0 0.1\n"
                     "v 2 1 0.1\nf 1 2 3 4\nf 2 5 6 3\n");
        place_.write("low.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                     "vt 0 0\nvt 0.4 0\nvt 0.4 1\nvt 0 1\n" +
                         corners + "f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\n");
        return bake("out/n.png").out;
    };
    const std::string advice =
        "2 x triangle outside of the map (triangle 2, 3): is not baked; --outside repeat moves it "
        "into the map";
    // Into a gap; as a mirrored copy; and onto other triangles, which only tiles can hold.
    EXPECT_THAT(finding("vt 1.5 0\nvt 1.9 0\nvt 1.9 1\nvt 1.5 1\n"), HasSubstr(advice + "\n"));
    EXPECT_THAT(finding("vt 1.4 0\nvt 1 0\nvt 1 1\nvt 1.4 1\n"), HasSubstr(advice + "\n"));
    EXPECT_THAT(finding("vt 1.1 0\nvt 1.5 0\nvt 1.5 1\nvt 1.1 1\n"),
                HasSubstr(advice + ", and <UDIM> in the map's name gives a map for each tile\n"));
    EXPECT_THAT(finding("vt -0.9 0\nvt -0.5 0\nvt -0.5 1\nvt -0.9 1\n"), HasSubstr(advice + "\n"));
}

TEST_F(Sets, TrianglesOutsideTheMapAreCountedWithARemedy) {
    write({{"", 0, 0, leaning_right},
           {"", 1, 0, leaning_up},
           {"", 0.5, 3, leaning_up},
           {"", -1, 0, leaning_up}});
    EXPECT_THAT(bake("out/n.png").out,
                HasSubstr("6 x triangle outside of the map (triangle 2, 3, 4, 5, 6, 7): is not "
                          "baked; --outside repeat moves it into the map, and <UDIM> in the map's "
                          "name gives a map for each tile"));
    const ProgramResult tiles = bake("out/n.<UDIM>.png");
    EXPECT_THAT(tiles.out,
                HasSubstr("2 x triangle outside of the map (triangle 6, 7): is not baked\n"));
    EXPECT_EQ(place_.outputs(), "n.1001.png n.1002.png n.1031.png n.1032.png n.png");
    EXPECT_THAT(bake("out/n.png", "--outside repeat").out,
                testing::Not(HasSubstr("outside of the map")));
}

TEST_F(Sets, PaddingToTheBorderFillsEveryMapAndIsNotOpaque) {
    write({{"A", 0, 0, leaning_right}, {"B", 0.75, 0, leaning_up}});
    const std::string line = "--padding border --background transparent ";
    EXPECT_EQ(bake("out/<material>.png", line).exit_code, 0);
    EXPECT_EQ(place_.outputs(), "A.png B.png");
    const Image map = read_image(place_ / "out/B.png", ImageUse::data);
    ASSERT_EQ(map.channels, 4);
    for (std::size_t i = 0; i < 64; ++i) {
        EXPECT_NEAR((map.as<std::uint16_t>()[4 * i + 1] - 32768.0) / 32767.0, 0.6, 1e-4);
        EXPECT_EQ(map.as<std::uint16_t>()[4 * i + 3], i % 8 < 6 ? 0 : 65535);
    }
}

TEST_F(Sets, GltfMaterialsWithoutNamesAreNumbered) {
    write({{"A", 0, 0, leaning_right}, {"B", 0, 0, leaning_up}});
    ASSERT_EQ(place_.run("relief-mesh process low.obj out/low.gltf").exit_code, 0);
    json document = json::parse(place_.read("out/low.gltf"));
    document["materials"][1].erase("name");
    place_.write("out/low.gltf", document.dump());
    const auto run = [&] {
        return place_.run(
            "relief-bake mesh high.obj out/low.gltf 'out/<material>.png' --size 8 --quiet");
    };
    EXPECT_EQ(run().error, "");
    EXPECT_EQ(place_.outputs(), "A.png low.bin low.gltf material-1.png");
    document["meshes"][0]["primitives"][1].erase("material");
    place_.write("out/low.gltf", document.dump());
    EXPECT_EQ(run().error, "");
    EXPECT_EQ(place_.outputs(), "A.png low.bin low.gltf material-1.png no-material.png");
}

TEST_F(Sets, NamesOfTheSameFileAreRefusedBeforeAnyIsWritten) {
    write({{"a/b", 0, 0, leaning_right}, {"c", 0, 0, leaning_up}, {"a:b", 0, 0, leaning_up}});
    const ProgramResult result = bake("out/<material>.png");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error,
              "relief-bake: error: low.obj: material 'a/b' and material 'a:b' would be the same "
              "file out/a_b.png (give one of them another name)\n");
    EXPECT_EQ(place_.outputs(), "");
}

TEST_F(Sets, NoReportReplacesAMap) {
    write({{"A", 0, 0, leaning_right}, {"B", 0, 0, leaning_up}});
    EXPECT_EQ(bake("out/<material>.png", "--report out/../out/B.png").exit_code, 2);
    EXPECT_EQ(place_.outputs(), "");
    place_.write("out/B.png", "old");
    std::filesystem::create_symlink("out/B.png", place_ / "r.json");
    const ProgramResult result = bake("out/<material>.png", "--report r.json");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("out/B.png, the name of a model or an image"));
    EXPECT_EQ(place_.read("out/B.png"), "old");
}

TEST_F(Sets, NoMapIsWrittenIfOneFails) {
    write({{"A", 0, 0, leaning_right}, {"B", 0, 0, leaning_up}});
    std::filesystem::create_directory(place_ / "out/B.png");
    const ProgramResult result = bake("out/<material>.png");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error, "relief-bake: error: out/B.png: is a folder\n");
    EXPECT_EQ(place_.outputs(), "B.png");
}

TEST(SetsRefusal, LeavesAllFilesUnchanged) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write_square("high.obj");
    workplace.write("far.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt -5 0\nvt -4 0\nvt -5 1\nf 1/1 2/2 3/3\n");
    expect_refusals(workplace, "relief-bake", "map.png",
                    {{"relief-bake mesh high.obj low.obj '<UDIM>/n.png'", 2,
                      "<UDIM>/n.png: <UDIM> is in a folder's name"},
                     {"relief-bake mesh high.obj low.obj 'out/<material><material>.png'", 2,
                      "out/<material><material>.png: <material> occurs twice"},
                     {"relief-bake mesh high.obj low.obj 'out/<UDIM>.png' --outside repeat", 2,
                      "--outside repeat: has no effect with <UDIM>"},
                     {"relief-bake mesh high.obj far.obj 'out/<UDIM>.png'", 1,
                      "far.obj: no triangle lies in a UDIM tile"},
                     {"relief-bake mesh high.obj low.obj 'none/<UDIM>.png'", 1,
                      "none/<UDIM>.png: the folder none does not exist"}});
}

TEST(MeshProgress, ShowsSpeedAndRemainingTime) {
    EXPECT_EQ(progress_text(0.5, 0.5, 1'000'000), "2.0 million rays per second");
    EXPECT_EQ(progress_text(0.0, 5.0, 0), "0.0 million rays per second");
    EXPECT_EQ(progress_text(0.25, 4.0, 10'000'000), "2.5 million rays per second, 12 s left");
    EXPECT_EQ(progress_text(0.01, 4.0, 10'000'000), "2.5 million rays per second, 7 min left");
    EXPECT_EQ(progress_text(1.0, 4.0, 4'000'000), "1.0 million rays per second, 0 s left");
}

TEST(MeshProgress, IsShownOnlyOnATerminal) {
    const Workplace place;
    place.write_square("square.obj");
    const std::string line =
        "relief-bake mesh square.obj square.obj out/n.png --size 256 --samples 4";
    EXPECT_EQ(place.run(line).error, "");
    const auto shown = place.run("script -qec '" + line + "' /dev/null < /dev/null");
    if (shown.exit_code == 127) GTEST_SKIP() << "no script(1) to make a terminal";
    EXPECT_EQ(shown.exit_code, 0);
    EXPECT_THAT(shown.out, HasSubstr("bake 100 %, "));
    EXPECT_THAT(shown.out, HasSubstr(" million rays per second ..."));
    const auto quiet = place.run("script -qec '" + line + " --quiet' /dev/null < /dev/null");
    EXPECT_EQ(quiet.out, "");
}

}  // namespace
}  // namespace relief::tools
