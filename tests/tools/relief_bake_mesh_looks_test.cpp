// SPDX-License-Identifier: Apache-2.0
// relief-bake mesh with textures of the high models: their own, by option, or none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relief/mesh/image_file.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// A square with a material of a colour, a texture, and a normal map that leans to the right.
void write_models(const Workplace& workplace) {
    workplace.write_square("low.obj");
    workplace.write("high.obj",
                    "mtllib high.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl stone\nf 1/1 2/2 3/3 4/4\n");
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

TEST(MeshBakeLooks, NormalMapsOfMaterialsGoOnTopUnlessToldOtherwise) {
    const Workplace workplace;
    write_models(workplace);
    const ProgramResult result = workplace.run(strict_line);
    ASSERT_EQ(result.exit_code, 0) << result.error << result.out;
    EXPECT_THAT(result.out,
                HasSubstr("high.obj: 2 triangles, 1 normal map on top of their normals\n"));
    EXPECT_EQ(normal_of(workplace), (std::vector<std::uint16_t>{52428, 32768, 58982}));
    ASSERT_EQ(workplace.run(strict_line + "--high-normal-map none").exit_code, 0);
    EXPECT_EQ(normal_of(workplace), (std::vector<std::uint16_t>{32768, 32768, 65535}));
    ASSERT_EQ(workplace.run(strict_line + "--high-normal-map other.png").exit_code, 0);
    EXPECT_EQ(normal_of(workplace), (std::vector<std::uint16_t>{32768, 52428, 58982}));
    EXPECT_EQ(workplace.run(strict_line + "--high-normal-map none.png").exit_code, 1);
}

TEST(MeshBakeLooks, OfGltfFilesAreTheSame) {
    const Workplace workplace;
    write_models(workplace);
    ASSERT_EQ(workplace.run("relief-mesh process high.obj out/high.glb").exit_code, 0);
    const ProgramResult result = workplace.run(
        "relief-bake mesh out/high.glb low.obj out/map.png --size 4 --color-map out/k.exr");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 normal map on top of their normals, 1 colour texture\n"));
    EXPECT_NEAR(normal_of(workplace)[0], 52428, 2);
    const Image colors = read_image(workplace / "out/k.exr", ImageUse::data);
    EXPECT_NEAR(colors.as<float>()[0], 0.50288646F, 1e-6F);
    EXPECT_NEAR(colors.as<float>()[1], 0.25144323F, 1e-6F);
    EXPECT_NEAR(colors.as<float>()[2], 0.25F, 1e-6F);
}

TEST(MeshBakeLooks, ColoursAreThoseOfMaterialsOrOfAFileOrNone) {
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

}  // namespace
}  // namespace relief::tools
