// SPDX-License-Identifier: Apache-2.0
// Draws the preview of relief-bake mesh, and runs it with --preview.
#include "mesh_preview.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using nlohmann::json;
using test::expect_refusals;
using test::Workplace;
using testing::HasSubstr;
using testing::StartsWith;

/// The low square of Workplace, and a high square above it with tilted normals.
void write_pair(const Workplace& workplace) {
    workplace.write_square("low.obj");
    workplace.write("high.obj",
                    "v -1 -1 0.05\nv 1 -1 0.05\nv 1 1 0.05\nv -1 1 0.05\nvn -0.48 0.36 0.8\nf 1//1 "
                    "2//1 3//1 4//1\n");
}

/// Reads red, green and blue of one column in the middle row of each panel.
std::vector<std::array<int, 3>> colors(const std::filesystem::path& file, std::size_t column) {
    const Image picture = read_image(file, ImageUse::color);
    EXPECT_EQ(picture.width, 96);
    EXPECT_EQ(picture.height, 24);
    EXPECT_EQ(picture.channels, 3);
    std::vector<std::array<int, 3>> result;
    for (const std::size_t panel : {0U, 32U, 64U}) {
        const std::uint8_t* code = &picture.as<std::uint8_t>()[3 * (12 * 96 + panel + column)];
        result.push_back({code[0], code[1], code[2]});
    }
    return result;
}

/// Expects that the low square looks like the high one only with its map.
void expect_alike(const std::filesystem::path& file, std::size_t column = 16) {
    const auto panels = colors(file, column);
    ASSERT_EQ(panels.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(panels[0][i], panels[1][i], 2) << i;
        EXPECT_GT(panels[0][i], panels[2][i] + 20) << i;
    }
}

TEST_LABELS(not_sanitized);
TEST(MeshPreview, TheMapMakesTheLowModelLookLikeTheHighOne) {
    const Workplace workplace;
    write_pair(workplace);
    for (const std::string options :
         {"map.png", "map.png --green down --bits 8 --zero-code 128", "map.exr",
          "map.png --space world", "map.tif --space object --bits 8",
          "map.png --background transparent"}) {
        SCOPED_TRACE(options);
        const auto result =
            workplace.run("relief-bake mesh high.obj low.obj out/" + options +
                          " --size 16 --preview out/preview.png --preview-size 32x24");
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_THAT(result.out, HasSubstr("out/preview.png: "));
        EXPECT_THAT(result.out, HasSubstr("(high, low with the map, low without)\n"));
        expect_alike(workplace / "out/preview.png");
    }
}

TEST(MeshPreview, AnObjectSpaceMapRotatesWithItsNode) {
    const Workplace workplace;
    write_pair(workplace);
    ASSERT_EQ(workplace.run("relief-mesh process low.obj out/low.gltf").exit_code, 0);
    // The low model is rotated about z, scaled by 2 in y and moved; the high model is unchanged.
    json document = json::parse(workplace.read("out/low.gltf"));
    document["nodes"][0]["rotation"] = {0, 0, 0.70710678, 0.70710678};
    document["nodes"][0]["scale"] = {1, 2, 1};
    document["nodes"][0]["translation"] = {0.25, 0, 0.01};
    workplace.write("out/low.gltf", document.dump());
    for (const std::string space : {"object", "world", "tangent"}) {
        SCOPED_TRACE(space);
        const auto result = workplace.run(
            "relief-bake mesh high.obj out/low.gltf out/map.png --size 32 --quiet --space " +
            space + " --preview out/preview.png --preview-size 32x24 --report out/report.json");
        ASSERT_EQ(result.exit_code, 0) << result.error;
        expect_alike(workplace / "out/preview.png");
        EXPECT_EQ(json::parse(workplace.read("out/report.json"))["preview"], "out/preview.png");
    }
}

/// The left half of the square is in tile 1001 ("left"), the right half in tile 1002 ("right").
const char* const two_tiles =
    "mtllib low.mtl\nv -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 1 -1 0\nv 1 1 0\nvt 0.1 0.1\nvt 0.9 "
    "0.1\nvt 0.9 0.9\nvt 0.1 0.9\nvt 1.1 0.1\nvt 1.9 0.1\nvt 1.9 0.9\nvt 1.1 0.9\nusemtl left\nf "
    "1/1 2/2 3/3 4/4\nusemtl right\nf 2/5 5/6 6/7 3/8\n";

TEST(MeshPreview, ShowsAllMapsOfOneBake) {
    const Workplace workplace;
    write_pair(workplace);
    workplace.write("low.mtl", "newmtl left\nnewmtl right\n");
    workplace.write("low.obj", two_tiles);
    for (const std::string& name :
         {std::string("map_<UDIM>.png"), std::string("map_<material>_<UDIM>.png")}) {
        SCOPED_TRACE(name);
        const auto result =
            workplace.run("relief-bake mesh high.obj low.obj 'out/" + name +
                          "' --size 16 --preview out/preview.png --preview-size 32x24");
        ASSERT_EQ(result.exit_code, 0) << result.error;
        expect_alike(workplace / "out/preview.png", 13);
        expect_alike(workplace / "out/preview.png", 19);
    }
}

TEST(MeshPreview, AnIslandOneTileAwayShowsTheRepeatedMap) {
    const Workplace workplace;
    write_pair(workplace);
    workplace.write("low.mtl", "newmtl left\nnewmtl right\n");
    workplace.write("low.obj", two_tiles);
    const auto result = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 16 --preview out/preview.png "
        "--preview-size 32x24");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    expect_alike(workplace / "out/preview.png", 13);
    expect_alike(workplace / "out/preview.png", 19);
}

TEST(MeshPreview, TheHighModelIsShownWithItsOwnNormalMap) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj",
                    "mtllib high.mtl\nv -1 -1 0.05\nv 1 -1 0.05\nv 1 1 0.05\nv -1 1 0.05\n"
                    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nusemtl bent\n"
                    "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    workplace.write("high.mtl", "newmtl bent\nnorm bent.png\n");
    Image normals = make_image(4, 4, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 16; ++i) {
        const std::array<float, 3> normal = {-0.48F, 0.36F, 0.8F};
        std::copy(normal.begin(), normal.end(), &normals.as<float>()[3 * i]);
    }
    Report report;
    write_image(workplace / "bent.png", encode_normal_map(normals, {.bits = 16}, report));
    const std::string line =
        "relief-bake mesh high.obj low.obj out/map.png --size 16 --preview out/preview.png "
        "--preview-size 32x24";
    ASSERT_EQ(workplace.run(line).exit_code, 0);
    expect_alike(workplace / "out/preview.png");
    // Without the map, all panels show a flat square.
    ASSERT_EQ(workplace.run(line + " --high-normal-map none").exit_code, 0);
    const auto flat = colors(workplace / "out/preview.png", 16);
    EXPECT_NEAR(flat[0][0], flat[2][0], 2);
    EXPECT_NEAR(flat[1][0], flat[2][0], 2);
}

TEST(MeshPreview, ModelsOfAnySizeAreDrawn) {
    const Workplace workplace;
    for (const std::string unit : {"1e-30", "1e30"}) {
        SCOPED_TRACE(unit);
        const std::string square = fmt::format(
            "v -{0} -{0} 0\nv {0} -{0} 0\nv {0} {0} 0\nv -{0} {0} 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 "
            "1\nvn -0.48 0.36 0.8\n",
            unit);
        workplace.write("high.obj", square + "f 1//1 2//1 3//1 4//1\n");
        workplace.write("low.obj", square + "f 1/1 2/2 3/3 4/4\n");
        const auto result = workplace.run(
            "relief-bake mesh high.obj low.obj out/map.png --size 16 --preview out/preview.png "
            "--preview-size 32x24");
        ASSERT_EQ(result.exit_code, 0) << result.error;
        expect_alike(workplace / "out/preview.png");
    }
}

TEST(MeshPreview, ChoosesTheViewThatShowsMostOfTheModel) {
    const ViewDirection round = best_view(make_sphere());
    EXPECT_EQ(round.azimuth, default_azimuth);
    EXPECT_EQ(round.elevation, default_elevation);
    Mesh quad = make_quad();  // Faces +z, where the default view stands.
    EXPECT_EQ(best_view(quad).azimuth, default_azimuth);
    EXPECT_EQ(best_view(quad).elevation, default_elevation);
    for (glm::vec3& position : quad.positions)
        position.x = -position.x;  // Faces -z: seen best after half a turn.
    EXPECT_FLOAT_EQ(best_view(quad).azimuth, default_azimuth + 3.14159265F);
    EXPECT_EQ(best_view(quad).elevation, default_elevation);
    for (glm::vec3& position : quad.positions)
        position = {position.x, 0.0F, position.y};  // Faces up.
    EXPECT_FLOAT_EQ(best_view(quad).elevation, 2.5F * default_elevation);
    for (glm::vec3& position : quad.positions)
        position.x = -position.x;  // Faces down.
    EXPECT_FLOAT_EQ(best_view(quad).elevation, -2.5F * default_elevation);
    EXPECT_EQ(best_view(Mesh{}).azimuth, default_azimuth);
}

TEST(MeshPreview, LargeMapsAreReducedByAveragingNormals) {
    const Workplace workplace;
    // 7 x 3 texels of 32 bits: 0.6 0 0.8 and 0 0.6 0.8 alternate; the last column is flat.
    Image normals = make_image(7, 3, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 21; ++i) {
        float* texel = &normals.as<float>()[3 * i];
        const bool is_flat = i % 7 == 6;
        texel[i % 2] = is_flat ? 0.0F : 0.6F;
        texel[2] = is_flat ? 1.0F : 0.8F;
    }
    Report report;
    const NormalMapFormat format{.bits = 16, .green = Green::down};
    const std::filesystem::path map = workplace / "out/map.png";
    write_image(map, encode_normal_map(normals, format, report));
    EXPECT_EQ(std::get<std::filesystem::path>(preview_image(map, format, 7).source), map);
    const ImageSource smaller = preview_image(map, format, 4);
    const Image& image = std::get<Shared<Image>>(smaller.source);
    ASSERT_EQ(image.width, 4);
    ASSERT_EQ(image.height, 2);
    // The mean of two and two normals is (0.3, 0.3, 0.8), normalized; stored green up as (n + 1)
    // / 2.
    const float length = std::sqrt(0.09F + 0.09F + 0.64F);
    EXPECT_NEAR(image.as<float>()[0], 0.5F + 0.15F / length, 1e-4F);
    EXPECT_NEAR(image.as<float>()[1], 0.5F + 0.15F / length, 1e-4F);
    EXPECT_NEAR(image.as<float>()[2], 0.5F + 0.4F / length, 1e-4F);
    // The corner has only one column and one row.
    EXPECT_NEAR(image.as<float>()[3 * 7], 0.5F, 1e-4F);
    EXPECT_NEAR(image.as<float>()[3 * 7 + 2], 1.0F, 1e-4F);
}

TEST(MeshPreview, IsAlsoAPage) {
    const Workplace workplace;
    write_pair(workplace);
    const auto result = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 8 --quiet --preview out/preview.html "
        "--preview-size 64x48");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(workplace.outputs(), "map.png preview.html");
    const std::string page = workplace.read("out/preview.html");
    EXPECT_THAT(page, HasSubstr("<title>preview</title>"));
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    EXPECT_LT(page.size(), 200'000U);
}

TEST(MeshPreview, OpenGLIsLoadedFirstAndOnlyForPreviews) {
    const Workplace workplace;
    write_pair(workplace);
    const std::string line =
        "RELIEF_OSMESA_LIBRARY=/none RELIEF_EGL_LIBRARY=/none relief-bake mesh high.obj low.obj "
        "out/map.png --size 8 --quiet";
    const auto without_gl = workplace.run(line + " --preview out/preview.png");
    EXPECT_EQ(without_gl.exit_code, 1);
    EXPECT_THAT(without_gl.error, StartsWith("relief-bake: error: "));
    EXPECT_EQ(workplace.outputs(), "");
    EXPECT_EQ(workplace.run(line).exit_code, 0);
}

TEST(MeshPreview, FailureReportsThatTheMapsAreComplete) {
    const Workplace workplace;
    write_pair(workplace);
    const auto result = workplace.run(
        "mkdir out/preview.png && relief-bake mesh high.obj low.obj out/map.png --size 8 --quiet "
        "--preview out/preview.png --preview-size 8x8");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, StartsWith("relief-bake: error: no preview: out/preview.png: "));
    EXPECT_THAT(result.error, HasSubstr("(the maps are complete)\n"));
    EXPECT_EQ(read_image(workplace / "out/map.png", ImageUse::data).width, 8);
}

TEST(MeshPreviewRefusal, LeavesAllFilesUnchanged) {
    const Workplace workplace;
    write_pair(workplace);
    expect_refusals(
        workplace, "relief-bake", "map.png",
        {{"relief-bake mesh high.obj low.obj out/map.png --preview-size 64x64", 2,
          "--preview-size: has no effect without --preview"},
         {"relief-bake mesh high.obj low.obj out/map.png --preview out/map.png", 2,
          "--preview out/map.png: is also the input or the output"},
         {"relief-bake mesh high.obj low.obj out/map.png --preview out/p.jpg", 2,
          "--preview out/p.jpg: the format is not supported (use .png or .html)"},
         {"relief-bake mesh high.obj low.obj out/map.png --report out/r.png --preview out/r.png", 2,
          "--report out/r.png: is the name of a model or an image (use .json)"},
         {"relief-bake mesh high.obj low.obj out/map.png --height-map out/h.png --preview "
          "out/h.png",
          2, "--preview out/h.png: is also the input or the output"},
         {"relief-bake mesh high.obj low.obj out/map.png --height-map out/h.png --report out/h.png",
          2, "--report out/h.png: is also the input or the output"},
         {"relief-bake mesh high.obj low.obj 'out/m_<UDIM>.png' --height-map 'out/h_<UDIM>.png' "
          "--preview out/h_1001.png",
          2, "--preview out/h_1001.png: is also the input or the output"},
         {"relief-bake mesh high.obj low.obj 'out/m_<UDIM>.png' --preview out/m_1001.png", 2,
          "--preview out/m_1001.png: is also the input or the output"},
         {"relief-bake mesh high.obj low.obj out/map.png --preview out/no/p.png", 1,
          "out/no/p.png: the folder out/no does not exist"}});
}

}  // namespace
}  // namespace relief::tools
