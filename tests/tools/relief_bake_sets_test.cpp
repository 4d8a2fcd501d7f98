// SPDX-License-Identifier: Apache-2.0
// Several maps from one run of relief-bake mesh: materials, UDIM tiles, both; what is refused, and
// that none is there when one of them fails.
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
using testing::HasSubstr;

/// Squares of side 2 in a row, each with its own material and its own place in texture space.
class Sets : public testing::Test {
  protected:
    struct Square {
        std::string material;
        double u = 0.0, v = 0.0;  ///< Of its lower left corner, v upwards.
        std::string normal = "0 0 1";
    };

    /// Writes the low model, and a high one 0.1 above it whose normals tell squares apart.
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

    /// The direction of a map's first texel, decoded.
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

TEST_F(Sets, MaterialsThatShareTheUnitSquareHaveAMapEach) {
    write({{"Skin", 0, 0, leaning_right}, {"Cloth/red", 0, 0, leaning_up}});
    const ProgramResult result = bake("out/<material>_n.png", "--report out/report.json");
    EXPECT_EQ(result.error, "");
    ASSERT_EQ(result.exit_code, 0);
    EXPECT_EQ(place_.outputs(), "Cloth_red_n.png Skin_n.png report.json");
    EXPECT_THAT(first_texel("out/Skin_n.png"), near(0.6, 0, 0.8));
    EXPECT_THAT(first_texel("out/Cloth_red_n.png"), near(0, 0.6, 0.8));
    EXPECT_THAT(result.out,
                HasSubstr("maps      material 'Skin': 8 x 8: 64 texels baked, 0 missed\n"
                          "          material 'Cloth/red': 8 x 8: 64 texels baked, 0 missed\n"));
    EXPECT_THAT(result.out, HasSubstr("wrote     out/Skin_n.png: "));
    EXPECT_THAT(result.out, HasSubstr("\n          out/Cloth_red_n.png: "));
    const json report = json::parse(place_.read("out/report.json"));
    ASSERT_EQ(report["maps"].size(), 2U);
    EXPECT_EQ(report["maps"][1]["output"], "out/Cloth_red_n.png");
    EXPECT_EQ(report["maps"][1]["material"], "Cloth/red");
    EXPECT_EQ(report["maps"][1]["texels_baked"], 64);
    EXPECT_EQ(report["texels_baked"], 128);
    // Two materials that no MTL file defines; nothing of texels.
    EXPECT_THAT(report["findings"].dump(), testing::Not(HasSubstr("texel")));
}

TEST_F(Sets, WithoutTheWordThereIsOneMapAndAWarningWithTheRemedy) {
    write({{"Skin", 0, 0, leaning_right}, {"Cloth", 0, 0, leaning_up}});
    const ProgramResult result = bake("out/n.png");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error,
              "relief-bake: warning: low.obj: 2 materials share one map, in which some texels "
              "belong to several triangles (<material> in the map's name gives each a map of its "
              "own)\n");
    EXPECT_THAT(result.out, HasSubstr("64 x texel of several triangles"));
    EXPECT_THAT(result.out, HasSubstr("map       8 x 8: 64 texels baked"));
    // The materials of an atlas, which share no texel, are no reason to warn.
    write({{"Skin", 0, 0, leaning_right}, {"Cloth", 1, 0, leaning_up}});
    EXPECT_EQ(bake("out/n.png").error, "");
}

TEST_F(Sets, TilesHaveAMapEachByTheirNumbers) {
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

TEST_F(Sets, WhatIsOutsideOfTheMapIsCountedWithTheRemedy) {
    write({{"", 0, 0, leaning_right},
           {"", 1, 0, leaning_up},
           {"", 0.5, 3, leaning_up},
           {"", -1, 0, leaning_up}});
    EXPECT_THAT(bake("out/n.png").out,
                HasSubstr("6 x triangle outside of the map (triangle 2, 3, 4, 5, 6, 7): is not "
                          "baked; <UDIM> in the map's name gives a map for each tile"));
    const ProgramResult tiles = bake("out/n.<UDIM>.png");
    EXPECT_THAT(tiles.out, HasSubstr("2 x triangle outside of the map (triangle 6, 7): is not "
                                     "baked\n"));
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

TEST_F(Sets, GltfMaterialsWithoutNamesHaveMadeOnes) {
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

TEST_F(Sets, NamesThatWouldBeTheSameFileAreRefusedBeforeAnyIsWritten) {
    write({{"a/b", 0, 0, leaning_right}, {"c", 0, 0, leaning_up}, {"a:b", 0, 0, leaning_up}});
    const ProgramResult result = bake("out/<material>.png");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error,
              "relief-bake: error: low.obj: material 'a/b' and material 'a:b' would be the same "
              "file out/a_b.png (give one of them another name)\n");
    EXPECT_EQ(place_.outputs(), "");
}

TEST_F(Sets, NoReportTakesThePlaceOfAMap) {
    write({{"A", 0, 0, leaning_right}, {"B", 0, 0, leaning_up}});
    const ProgramResult result = bake("out/<material>.png", "--report out/../out/B.png");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("--report out/../out/B.png: is also the input"));
    EXPECT_EQ(place_.outputs(), "");
}

TEST_F(Sets, NoneIsWrittenIfOneCannotBe) {
    write({{"A", 0, 0, leaning_right}, {"B", 0, 0, leaning_up}});
    std::filesystem::create_directory(place_ / "out/B.png");
    const ProgramResult result = bake("out/<material>.png");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error, "relief-bake: error: out/B.png: is a folder\n");
    EXPECT_EQ(place_.outputs(), "B.png");
}

TEST(SetsRefusal, LeavesEverythingAsItWas) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write_square("high.obj");
    workplace.write("far.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt -5 0\nvt -4 0\nvt -5 1\n"
                    "f 1/1 2/2 3/3\n");
    expect_refusals(workplace, "relief-bake", "map.png",
                    {{"relief-bake mesh high.obj low.obj '<UDIM>/n.png'", 2,
                      "<UDIM>/n.png: <UDIM> is in a folder's name"},
                     {"relief-bake mesh high.obj low.obj 'out/<material><material>.png'", 2,
                      "out/<material><material>.png: <material> is there twice"},
                     {"relief-bake mesh high.obj low.obj 'out/<UDIM>.png' --outside repeat", 2,
                      "--outside repeat: has no effect with <UDIM>"},
                     {"relief-bake mesh high.obj far.obj 'out/<UDIM>.png'", 1,
                      "far.obj: no triangle lies in a UDIM tile"},
                     {"relief-bake mesh high.obj low.obj 'none/<UDIM>.png'", 1,
                      "none/<UDIM>.png: the folder none does not exist"}});
}

}  // namespace
}  // namespace relief::tools
