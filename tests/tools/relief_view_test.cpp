// SPDX-License-Identifier: Apache-2.0
// relief-view as users run it: pixels whose value follows from the options by hand, what it says,
// and how it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::picture_in;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

using Pixel = std::array<int, 4>;

/// 8-bit pixel; alpha is 255 where the file has none.
Pixel pixel(const Image& image, int x, int y) {
    Pixel result = {0, 0, 0, 255};
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t start = static_cast<std::size_t>(y * image.width + x) * channels;
    for (std::size_t i = 0; i < channels; ++i)
        result[i] = image.as<std::uint8_t>()[start + i];
    return result;
}

/// Looks straight at the square of Workplace::write_square, in 33 x 33 pixels.
constexpr const char* look_quietly =
    "relief-view square.obj --camera 0,0 --size 33x33 --samples 1 --quiet ";

/// The pixel in the middle of what that shows.
Pixel middle_of(const Workplace& workplace, const std::string& options) {
    workplace.write_square("square.obj");
    const ProgramResult result = workplace.run(look_quietly + options + " --output out/p.png");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.out + result.error, "");
    if (result.exit_code != 0) return {};
    return pixel(picture_in(workplace / "out/p.png"), 16, 16);
}

/// 0.8, the diffuse color of a model without materials, sRGB-coded: 1.055 * 0.8^(1/2.4) - 0.055.
constexpr Pixel white_lit = {231, 231, 231, 255};

TEST(ViewCommand, ALightOfIntensity1ShowsTheDiffuseColorOfASurfaceThatFacesIt) {
    const Workplace workplace;
    EXPECT_EQ(middle_of(workplace, "--light directional:0,0"), white_lit);
    EXPECT_EQ(middle_of(workplace, "--light directional:0,0,1,#ff0000"), (Pixel{231, 0, 0, 255}));
    EXPECT_EQ(middle_of(workplace, "--light directional:180,0"), (Pixel{0, 0, 0, 255}))
        << "from behind";
}

TEST(ViewCommand, PointAndSpotLightsFallOffWithTheSquaredDistance) {
    const Workplace workplace;
    EXPECT_EQ(middle_of(workplace, "--light point:0,0,2,4"), white_lit);
    EXPECT_EQ(middle_of(workplace, "--light spot:0,0,2,0,0,0,20,4"), white_lit);
    EXPECT_EQ(middle_of(workplace, "--light spot:0,0,2,1,0,0,20,4"), (Pixel{0, 0, 0, 255}))
        << "outside the cone";
}

TEST(ViewCommand, NoLightAndNoAmbientLightIsBlack) {
    const Workplace workplace;
    EXPECT_EQ(middle_of(workplace, "--light none"), (Pixel{0, 0, 0, 255}));
    EXPECT_EQ(middle_of(workplace, "--light none --ambient 1"), white_lit);
}

TEST(ViewCommand, AddsLightsWithANote) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result =
        workplace.run("relief-view square.obj --output out/p.png --size 33x33 --camera 0,0");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "") << "progress is for terminals";
    EXPECT_THAT(result.out,
                HasSubstr("read      square.obj: 1 mesh, 2 triangles\nlight     2 directional "
                          "lights and ambient light\nnotes     the model has no "
                          "light, so a key light and a fill light were added\nfindings  none\n"));
    EXPECT_THAT(result.out, HasSubstr("wrote     out/p.png: "));
    EXPECT_GT(pixel(picture_in(workplace / "out/p.png"), 16, 16)[0], 100);
}

TEST(ViewCommand, MentionsAmbientLightOnlyIfASurfaceShowsIt) {
    const Workplace workplace;
    workplace.write("scene.json", R"({"relief_scene": 1, "ambient": 0.5, "nodes": [
        {"shape": "quad", "material": {"diffuse": 1, "ambient": 0}}],
        "lights": [{"type": "point", "position": [0, 0, 1]}, {"type": "point", "on": false}]})");
    const auto lights = [&](const std::string& model) {
        const ProgramResult result =
            workplace.run("relief-view " + model + " --size 8x8 --output out/p.png");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return result.out;
    };
    EXPECT_THAT(lights("scene.json"), HasSubstr("light     1 point light\n"));
    EXPECT_THAT(lights("scene.json --material gold"),
                HasSubstr("light     1 point light and ambient light\n"));
}

TEST(ViewCommand, BackgroundIsAColorOrTransparent) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const auto corner = [&](const std::string& options) {
        EXPECT_EQ(workplace.run(look_quietly + options + " --output out/p.png").exit_code, 0);
        return pixel(picture_in(workplace / "out/p.png"), 0, 0);
    };
    EXPECT_EQ(corner(""), (Pixel{0x1e, 0x21, 0x26, 255}));
    EXPECT_EQ(picture_in(workplace / "out/p.png").channels, 3) << "nothing to see through";
    EXPECT_EQ(corner("--background '#ff8000'"), (Pixel{0xff, 0x80, 0x00, 255}));
    EXPECT_EQ(corner("--background transparent"), (Pixel{0, 0, 0, 0}));
    EXPECT_EQ(picture_in(workplace / "out/p.png").channels, 4);
    EXPECT_EQ(pixel(picture_in(workplace / "out/p.png"), 16, 16)[3], 255) << "the model covers";
}

TEST(ViewCommand, TheCameraShowsAllOfTheModelAndComesNearerWhenAsked) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const auto covered = [&](const std::string& camera) {
        const std::string line =
            "relief-view square.obj --quiet --size 64x64 --background "
            "transparent --output out/p.png --camera " +
            camera;
        EXPECT_EQ(workplace.run(line).exit_code, 0);
        const Image image = picture_in(workplace / "out/p.png");
        int count = 0;
        int on_border = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const bool hit = pixel(image, x, y)[3] != 0;
                count += hit ? 1 : 0;
                on_border += hit && (x == 0 || y == 0 || x == 63 || y == 63) ? 1 : 0;
            }
        }
        return std::pair(count, on_border);
    };
    const auto [whole, at_border] = covered("0,0");
    EXPECT_GT(whole, 64 * 64 / 5) << "not lost in the distance";
    EXPECT_EQ(at_border, 0);
    const auto [far, far_border] = covered("0,0,2");
    EXPECT_NEAR(static_cast<double>(far) / whole, 0.25, 0.03) << "pixels of the edges";
    EXPECT_EQ(covered("0,0,0.5").first, 64 * 64) << "so near that it fills the picture";
}

TEST(ViewCommand, ExrHoldsLinearRadiance) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result =
        workplace.run(std::string(look_quietly) + "--light directional:0,0,10 --output out/p.exr");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const Image image = picture_in(workplace / "out/p.exr");
    ASSERT_EQ(image.bits(), 32);
    const auto middle = static_cast<std::size_t>((16 * 33 + 16) * image.channels);
    EXPECT_NEAR(image.as<float>()[middle], 8.0F, 1e-2) << "half-float frame buffer";
}

/// A picture of one color.
void write_plain(const std::filesystem::path& file, std::array<std::uint8_t, 3> color) {
    Image image = make_image(8, 8, 3, 8, ColorSpace::srgb);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<std::uint8_t>()[i] = color[i % 3];
    write_image(file, image);
}

TEST(ViewCommand, ADiffuseMapIsTheColor) {
    const Workplace workplace;
    write_plain(workplace / "map.png", {200, 100, 50});
    EXPECT_EQ(middle_of(workplace, "--light directional:0,0 --diffuse-map map.png"),
              (Pixel{200, 100, 50, 255}));
}

TEST(ViewCommand, AFlatHeightMapChangesNothingAndARampTiltsTheLight) {
    const Workplace workplace;
    write_image(workplace / "flat.png", make_image(8, 8, 1, 8, ColorSpace::data));
    EXPECT_EQ(middle_of(workplace, "--light directional:0,0 --height-map flat.png"), white_lit);
    // Rises by one texel a texel to the right: the normal leans 45 degrees to the left.
    Image ramp = make_image(64, 64, 1, 8, ColorSpace::data);
    for (std::size_t i = 0; i < ramp.sample_count(); ++i)
        ramp.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i % 64);
    write_image(workplace / "ramp.png", ramp);
    EXPECT_EQ(middle_of(workplace,
                        "--light directional:-45,0 --height-map ramp.png --strength "
                        "255"),
              white_lit);
    EXPECT_EQ(middle_of(workplace,
                        "--light directional:45,0 --height-map ramp.png --strength "
                        "255")[0],
              0);
}

TEST(ViewCommand, ANormalMapIsReadByItsGreenDirection) {
    const Workplace workplace;
    // Leans 45 degrees up in the image, in the OpenGL convention: green = 128 + 127 / sqrt(2).
    write_plain(workplace / "leans.png", {128, 218, 218});
    const std::string map = " --normal-map leans.png";
    const int up = middle_of(workplace, "--light directional:0,45" + map)[0];
    EXPECT_NEAR(up, 231, 1) << "8-bit normals";
    EXPECT_EQ(middle_of(workplace, "--light directional:0,45 --green down" + map)[0], 0);
    EXPECT_EQ(middle_of(workplace, "--light directional:0,45 --normal-scale 0" + map)[0],
              middle_of(workplace, "--light directional:0,45")[0]);
}

/// Six plain faces, each of its own color, as posx.png and so on.
constexpr std::array<std::pair<const char*, std::array<std::uint8_t, 3>>, 6> faces = {
    {{"posx", {255, 0, 0}},
     {"negx", {0, 255, 0}},
     {"posy", {0, 0, 255}},
     {"negy", {255, 255, 0}},
     {"posz", {0, 255, 255}},
     {"negz", {255, 0, 255}}}};

void write_sky(const Workplace& workplace) {
    std::filesystem::create_directory(workplace / "sky");
    for (const auto& [name, color] : faces)
        write_plain(workplace / "sky" / (std::string(name) + ".png"), color);
}

TEST(ViewCommand, EnvironmentIsBehindTheModelInEveryForm) {
    const Workplace workplace;
    write_sky(workplace);
    workplace.write_square("square.obj");
    const auto corner = [&](const std::string& words) {
        const ProgramResult result =
            workplace.run("relief-view --quiet --size 33x33 --fov 20 --output out/p.png " + words);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return pixel(picture_in(workplace / "out/p.png"), 0, 0);
    };
    const Pixel behind = {255, 0, 255, 255};  // negz
    EXPECT_EQ(corner("--camera 0,0 --environment sky square.obj"), behind);
    EXPECT_EQ(corner("square.obj --camera 0,0 --environment sky"), behind);
    EXPECT_EQ(corner("--environment sky/posx.png sky/negx.png sky/posy.png sky/negy.png "
                     "sky/posz.png sky/negz.png --camera 0,0 square.obj"),
              behind);
    EXPECT_EQ(corner("--environment sky/posx.png sky/negx.png sky/posy.png sky/negy.png "
                     "sky/posz.png sky/negz.png square.obj --camera 0,0"),
              behind);
    EXPECT_EQ(corner("--camera 0,0 --environment sky/posy.png square.obj"), (Pixel{0, 0, 255, 255}))
        << "a panorama";
    EXPECT_EQ(corner("square.obj --camera 90,0 --environment sky"), (Pixel{0, 255, 0, 255}))
        << "seen from +x, what lies behind is -x";
    EXPECT_EQ(corner("--camera 0,0 --environment sky --environment-rotation 90 square.obj"),
              (Pixel{255, 0, 0, 255}))
        << "posx turned from +x to -z";
    const Pixel blurred = corner("--camera 0,0 --environment sky --background-blur 1 square.obj");
    EXPECT_GT(blurred[0], blurred[1]) << "most of it is negz, which is magenta";
    EXPECT_GT(blurred[1], 60) << "it contains light of faces with green";
}

TEST(ViewCommand, ShadowsAndOcclusionDarkenHiddenSurfaces) {
    const Workplace workplace;
    workplace.write("box.json", R"({"relief_scene": 1, "ambient": 0.5, "background": 0,
        "camera": {"eye": [0, 0, 8]},
        "materials": {"gray": {"ambient": 1, "diffuse": 0.5, "specular": 0}},
        "nodes": [{"shape": {"quad": {"cells": 8}}, "scale": 2, "material": "gray"},
                  {"shape": "cube", "scale": 0.3, "translation": [1, 0, 0.6], "material": "gray"}],
        "lights": [{"type": "directional", "direction": [-1, 0, -0.6]}]})");
    const auto middle = [&](const std::string& options) {
        const ProgramResult result =
            workplace.run("relief-view --quiet --size 33x33 --output out/p.png " + options);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return pixel(picture_in(workplace / "out/p.png"), 16, 16);
    };
    // The middle is in the shadow of the cube, which also hides light from the side.
    const Pixel open = middle("box.json");
    const Pixel shaded = middle("box.json --shadow 2");
    const Pixel occluded = middle("box.json --shadow 2 --ambient-occlusion 0.5");
    EXPECT_LT(shaded[0] + 20, open[0]);
    EXPECT_LT(occluded[0] + 1, shaded[0]);
    const ProgramResult saved = workplace.run(
        "relief-view --quiet box.json --shadow 2 --ambient-occlusion 0.5 --save-scene "
        "saved.json");
    EXPECT_EQ(saved.exit_code, 0) << saved.error;
    EXPECT_EQ(middle("saved.json"), occluded);
    EXPECT_EQ(middle("saved.json --ambient-occlusion 0"), shaded);
}

TEST(ViewCommand, MirrorShowsTheEnvironmentBehindTheCamera) {
    const Workplace workplace;
    write_sky(workplace);
    EXPECT_EQ(middle_of(workplace, "--environment sky --reflectivity 1 --light none"),
              (Pixel{0, 255, 255, 255}))
        << "posz";
    EXPECT_EQ(middle_of(workplace, "--environment sky --reflectivity 1 --light none --no-skybox"),
              (Pixel{0, 255, 255, 255}));
    EXPECT_EQ(middle_of(workplace,
                        "--environment sky --reflectivity 1 --light none "
                        "--environment-rotation 90"),
              (Pixel{0, 255, 0, 255}))
        << "negx turned from -x to +z";
}

TEST(ViewCommand, HighlightsFollowShininess) {
    const Workplace workplace;
    // The light 60 degrees off: its half vector is 30 degrees from the normal, so the highlight is
    // 0.25 cos(30)^N on top of 0.8 * cos(60) = 0.4.
    const std::string light = "--light directional:60,0 ";
    const int without = middle_of(workplace, light)[0];
    const int wide = middle_of(workplace, light + "--shininess 2")[0];
    const int narrow = middle_of(workplace, light + "--shininess 500")[0];
    const auto coded = [](double linear) {
        return static_cast<int>(std::lround(255 * srgb_from_linear(static_cast<float>(linear))));
    };
    EXPECT_EQ(without, coded(0.4));
    EXPECT_NEAR(wide, coded(0.4 + 0.25 * 0.75), 1) << "rounding of the light's direction";
    EXPECT_EQ(narrow, coded(0.4));
    // Phong's reflected ray is 60 degrees off: 0.25 cos(60)^2.
    EXPECT_NEAR(middle_of(workplace, light + "--shininess 2 --specular phong")[0],
                coded(0.4 + 0.25 * 0.25), 1);
}

TEST(ViewCommand, ExplainsEffectsWithoutDrawing) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    write_image(workplace / "flat.png", make_image(8, 8, 1, 8, ColorSpace::data));
    const ProgramResult bare = workplace.run("relief-view square.obj --explain-effects");
    ASSERT_EQ(bare.exit_code, 0) << bare.error;
    EXPECT_THAT(bare.out, HasSubstr("skybox, prefiltered environment, environment BRDF table, "
                                    "environment irradiance, environment map: the scene has no "
                                    "environment\n"));
    EXPECT_THAT(bare.out, testing::ContainsRegex("off [^:]*, normal map, "));
    EXPECT_EQ(workplace.outputs(), "");
    const ProgramResult mapped =
        workplace.run("relief-view square.obj --explain-effects --height-map flat.png");
    EXPECT_THAT(mapped.out, testing::ContainsRegex("on +normal map "));
}

TEST(ViewCommand, PrintsOneJsonObject) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result = workplace.run(
        "relief-view square.obj --json --explain-effects --size 20x10 --output out/p.png");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json summary = json::parse(result.out);
    EXPECT_EQ(summary["triangles"], 2);
    EXPECT_EQ(summary["notes"].size(), 1U);
    EXPECT_EQ(summary["picture"]["width"], 20);
    EXPECT_EQ(summary["picture"]["programs"], 1);
    EXPECT_EQ(summary["picture"]["textures"], 0);
    ASSERT_EQ(summary["effects"]["draws"].size(), 1U);
    EXPECT_FALSE(summary["effects"]["draws"][0]["effects"].empty());
    EXPECT_EQ(picture_in(workplace / "out/p.png").height, 10);
}

TEST(ViewCommand, DrawsRealModelsWithTheirOwnMaps) {
    RELIEF_NEEDS_SHARED(bottle, "data/models/gltf/WaterBottle/glTF/WaterBottle.gltf");
    const Workplace workplace;
    const ProgramResult result = workplace.run("relief-view " + bottle.string() +
                                               " --output out/bottle.png --size 256x256 --json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_GE(json::parse(result.out)["picture"]["textures"], 2) << "color and normals";
}

/// A square with a material whose base color texture has this image.
void write_textured_square(const Workplace& workplace, const json& image) {
    std::string bytes;
    const auto append = [&](const auto& values) {
        bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(values));
    };
    append(std::array<float, 12>{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
    append(std::array<float, 8>{0, 1, 1, 1, 1, 0, 0, 0});
    append(std::array<std::uint16_t, 6>{0, 1, 2, 0, 2, 3});
    workplace.write("square.bin", bytes);
    const json document = {
        {"asset", {{"version", "2.0"}}},
        {"buffers", {{{"uri", "square.bin"}, {"byteLength", bytes.size()}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteLength", 48}},
          {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 32}},
          {{"buffer", 0}, {"byteOffset", 80}, {"byteLength", 12}}}},
        {"accessors",
         {{{"bufferView", 0},
           {"componentType", 5126},
           {"count", 4},
           {"type", "VEC3"},
           {"min", {-1, -1, 0}},
           {"max", {1, 1, 0}}},
          {{"bufferView", 1}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}},
          {{"bufferView", 2}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}}},
        {"images", {image}},
        {"textures", {{{"source", 0}}}},
        {"materials",
         {{{"name", "wall"},
           {"pbrMetallicRoughness",
            {{"baseColorFactor", {0.5, 0.25, 1.0, 1.0}}, {"baseColorTexture", {{"index", 0}}}}},
           {"extensions", {{"KHR_materials_unlit", json::object()}}}}}},
        {"meshes",
         {{{"primitives",
            {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}},
              {"indices", 2},
              {"material", 0}}}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"scenes", {{{"nodes", {0}}}}},
        {"scene", 0}};
    workplace.write("square.gltf", document.dump());
}

/// The base color factor without a texture: 0.5, 0.25 and 1, sRGB-coded.
constexpr Pixel untextured = {188, 137, 255, 255};

TEST(ViewCommand, ImagesOfModelsThatCannotBeReadAreNamedAndDrawnWithout) {
    const Workplace workplace;
    workplace.write("damaged.png", "\x89PNG\r\n\x1A\nnot much");
    write_plain(workplace / "../outside.png", {255, 255, 255});
    const std::string line =
        "relief-view square.gltf --camera 0,0 --size 33x33 --samples 1 --output out/p.png";
    const std::vector<std::pair<std::string, std::string>> uris = {
        {"gone.png", "gone.png: no such file"},
        {"damaged.png", "damaged.png: "},
        {"../outside.png", "images[0].uri '../outside.png' leads out of"},
        {"/etc/passwd", "images[0].uri '/etc/passwd' leads out of"},
        {"file:///etc/passwd", "images[0].uri 'file:///etc/passwd' leads out of"},
        {"http://localhost/a.png", "images[0].uri 'http://localhost/a.png' leads out of"},
        {"https://localhost/a.png", "images[0].uri 'https://localhost/a.png' leads out of"},
        {"", "images[0] names no file and has no bytes"},
        {".", ": is not a file"},
        {"data:,abc", "square.gltf: images[0]: "},
        {"data:image/png;base64,iVBORw0KGgo=", "square.gltf: images[0]: "}};
    for (const auto& [uri, problem] : uris) {
        write_textured_square(workplace, {{"uri", uri}});
        const ProgramResult result = workplace.run(line);
        ASSERT_EQ(result.exit_code, 0) << uri << result.error;
        EXPECT_THAT(result.out,
                    HasSubstr("1 x unreadable diffuse texture of material 'wall' (image 0): drawn "
                              "without it: square.gltf: "))
            << uri;
        EXPECT_THAT(result.out, HasSubstr(problem));
        EXPECT_EQ(pixel(picture_in(workplace / "out/p.png"), 16, 16), untextured) << uri;
        const ProgramResult strict = workplace.run(line + " --strict");
        EXPECT_EQ(strict.exit_code, 3) << uri;
        EXPECT_THAT(strict.error, HasSubstr("square.gltf: ")) << uri;
        EXPECT_THAT(strict.error, HasSubstr("exit code 3, because of --strict")) << uri;
    }
    write_textured_square(workplace, {{"bufferView", 0}, {"mimeType", "image/png"}});
    const json summary = json::parse(workplace.run(line + " --json --explain-effects").out);
    EXPECT_EQ(summary["findings"][0]["kind"], "unreadable diffuse texture of material 'wall'");
    EXPECT_EQ(pixel(picture_in(workplace / "out/p.png"), 16, 16), untextured) << "embedded";
    for (const json& effect : summary["effects"]["draws"][0]["effects"]) {
        if (effect["effect"] == "diffuse texture") {
            EXPECT_EQ(effect["reason"], "its image cannot be read");
        }
    }
    EXPECT_EQ(summary["effects"]["draws"][0]["textures"].size(), 0U);
    std::filesystem::remove(workplace / "../outside.png");
}

TEST(ViewCommand, ImagesOfMtlAndSceneFilesThatCannotBeReadAreNamedAndDrawnWithout) {
    const Workplace workplace;
    workplace.write_square("plain.obj");
    workplace.write("square.mtl", "newmtl wall\nKd 0.5 0.25 1\nillum 0\nmap_Kd gone.png\n");
    workplace.write("square.obj", "mtllib square.mtl\nusemtl wall\n" + workplace.read("plain.obj"));
    workplace.write("scene.json", R"({"relief_scene": 1, "nodes": [{"shape": "quad", "material":
        {"name": "wall", "unlit": true, "diffuse": [0.5, 0.25, 1],
         "diffuse_texture": "gone.png"}}]})");
    for (const std::string model : {"square.obj", "scene.json"}) {
        const ProgramResult result =
            workplace.run("relief-view " + model +
                          " --camera 0,0 --size 33x33 --samples 1 --strict --output out/p.png");
        EXPECT_EQ(result.exit_code, 3) << result.error;
        EXPECT_THAT(result.out, HasSubstr("1 x unreadable diffuse texture of material 'wall' "
                                          "(image 0): drawn without it: " +
                                          model + ": "));
        EXPECT_THAT(result.out, HasSubstr("gone.png: no such file"));
        EXPECT_EQ(pixel(picture_in(workplace / "out/p.png"), 16, 16), untextured) << model;
    }
}

TEST(ViewCommand, SavedScenesKeepTheUpAxisAndTheNormals) {
    const Workplace workplace;
    workplace.write(
        "roof.stl",
        "solid r\nfacet normal 0 0 0\nouter loop\nvertex 0 0 1\nvertex 1 0 0\nvertex 0 1 "
        "1\nendloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 1\nvertex 0 1 "
        "1\nvertex -1 0 0\nendloop\nendfacet\nendsolid r\n");
    const auto draw = [&](const std::string& words) {
        const ProgramResult result =
            workplace.run("relief-view " + words + " --size 40x30 --quiet --output out/p.png");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return picture_in(workplace / "out/p.png").samples;
    };
    std::filesystem::create_directory(workplace / "out");
    const auto hard = draw("roof.stl");
    // The studio has no file, but a name in scene files.
    const auto studio = draw("roof.stl --environment studio --save-scene out/studio.json");
    EXPECT_NE(studio, hard);
    EXPECT_EQ(draw("out/studio.json"), studio);
    const auto smooth = draw("roof.stl --crease 120 --save-scene out/smooth.json");
    EXPECT_NE(smooth, hard);
    EXPECT_NE(draw("roof.stl --up y --crease 120"), smooth);
    EXPECT_EQ(draw("out/smooth.json"), smooth);
}

TEST(ViewRefusal, StatesTheReasonAndWritesNoFile) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write_square("plain.obj", true);
    write_plain(workplace / "map.png", {128, 128, 255});
    write_sky(workplace);
    std::filesystem::create_directory(workplace / "empty");
    workplace.write("noise.png", "this is no image");
    std::filesystem::create_directory(workplace / "own");
    write_plain(workplace / "own/wood.png", {128, 128, 255});
    workplace.write("own/crate.mtl", "newmtl wood\nmap_Kd wood.png\n");
    workplace.write("own/crate.obj",
                    "mtllib crate.mtl\nusemtl wood\n" + workplace.read("plain.obj"));
    workplace.write("own/scene.json", R"({"relief_scene": 1, "nodes": [{"model": "crate.obj"}]})");
    std::filesystem::create_symlink("crate.obj", workplace / "own/link.glb");
    expect_refusals(
        workplace, "relief-view", "old.png",
        {{"--explain-effects", 2, "MODEL is missing (see relief-view --help)"},
         {"square.obj --normal-map gone.png --output out/old.png", 1, "gone.png: no such file"},
         {"square.obj --normal-map data/bricks-height.png --output out/old.png", 1,
          "data/bricks-height.png: has 1 channel, but normals need at least 2"},
         {"square.obj --diffuse-map gone.png --output out/old.png", 1, "gone.png: no such file"},
         {"square.obj --strict", 2,
          "--strict: the window shows the findings and has no exit code for them (add --output)"},
         {"square.obj --json", 2, "--json: the window prints no summary (add --output)"},
         {"square.obj --output out/old.png --dump-state out/state.json", 2,
          "--dump-state: no window is opened (leave --output out)"},
         {"square.obj --output out/old.png --ui-scale 2", 2,
          "--ui-scale: no window is opened (leave it out)"},
         {"square.obj --ui-scale 5", 2, "--ui-scale 5: not between 0.5 and 4"},
         {"square.obj --output out/old.png --no-state", 2,
          "--no-state: no window is opened (leave it out)"},
         {"square.obj --output out/p.jpg", 2,
          "--output out/p.jpg: unsupported format (use .png, .exr, .apng, .mp4, "
          ".webm or .html)"},
         {"square.obj --output out/old.png --size 5", 2, "--size 5: not a size like 1920x1080"},
         {"square.obj --output out/old.png --samples 2", 2, "--samples 2: not one of 1, 4"},
         {"square.obj --output out/old.png --fov 180", 2,
          "--fov 180: not between 1 and 170 degrees"},
         {"square.obj --output out/old.png --camera 10", 2,
          "--camera 10: not azimuth,elevation or azimuth,elevation,factor"},
         {"square.obj --output out/old.png --camera 10,x", 2, "--camera 10,x: 'x': not a number"},
         {"square.obj --output out/old.png --camera 0,0,0", 2,
          "--camera 0,0,0: '0': not between 0.01 and 1000"},
         {"square.obj --output out/old.png --light sun", 2,
          "--light sun: not a light (start with directional:, point: or spot:, or use none)"},
         {"square.obj --output out/old.png --light none --light point:0,0,1", 2,
          "--light none: contradicts the other lights"},
         {"square.obj --output out/old.png --normal-map map.png --height-map map.png", 2,
          "--height-map: contradicts --normal-map"},
         {"square.obj --output out/old.png --green up", 2, "--green: needs --normal-map"},
         {"square.obj --output out/old.png --strength 2", 2, "--strength: needs --height-map"},
         {"square.obj --output out/old.png --kernel sobel3", 2, "--kernel: needs --height-map"},
         {"square.obj --output out/old.png --normal-scale 2", 2,
          "--normal-scale: the model has no normal map to scale (give one with --normal-map "
          "or --height-map)"},
         {"square.obj --output out/old.png --no-skybox", 2,
          "--no-skybox: there is no --environment"},
         {"square.obj --output out/old.png --reflectivity 0.5", 2,
          "--reflectivity: there is no --environment"},
         {"square.obj --output out/old.png --environment none --reflectivity 0.5", 2,
          "--reflectivity: there is no --environment"},
         {"square.obj --output out/old.png --environment-tint", 2,
          "--environment-tint: there is no --environment"},
         {"square.obj --output out/old.png --clamp-terms --metallic-roughness 1,0.5", 2,
          "--metallic-roughness: needs the glTF model, and --clamp-terms needs the Phong model"},
         {"square.obj --output out/old.png --environment-rotation 90", 2,
          "--environment-rotation: there is no --environment"},
         {"square.obj --output out/old.png --background-blur 0.5", 2,
          "--background-blur: there is no --environment"},
         {"square.obj --output out/old.png --light none --shadow 2", 2,
          "--shadow: there is no light that could cast one"},
         {"square.obj --output out/old.png --shadow 31", 2, "--shadow"},
         {"square.obj --output out/old.png --ambient-occlusion -1", 2, "--ambient-occlusion"},
         {"square.obj --output out/old.png --environment sky --no-skybox --background-blur 0.5", 2,
          "--background-blur: the environment is not visible behind the model"},
         {"square.obj --output out/old.png --left-handed", 2,
          "--left-handed: there is no --environment"},
         {"square.obj --output out/old.png --environment-layout cross", 2,
          "--environment-layout: there is no --environment"},
         {"square.obj --output out/old.png --environment sky --background '#000000'", 2,
          "--background: the environment hides it"},
         {"square.obj --output out/old.png --environment sky --no-skybox", 2,
          "--environment: has no effect"},
         {"square.obj --output out/old.png --environment sky map.png", 2,
          "--environment: takes one file, six files or a folder, not 2 files"},
         {"square.obj --output out/old.png --backend vulkan", 2,
          "--backend vulkan: not one of auto, osmesa, egl"},
         {"own/crate.obj --output own/wood.png", 2,
          "--output own/wood.png: is also the input or the output"},
         {"own/scene.json --save-model own/link.glb", 2,
          "--save-model own/link.glb: is also the input or the output"},
         {"missing.obj --output out/old.png", 1, "missing.obj: "},
         {"empty --output out/old.png", 1,
          "empty: is a folder, not a model (it contains no model)"},
         {". --output out/old.png", 1,
          ".: is a folder, not a model (name a file in it: plain.obj, square.obj)"},
         {"square.obj --output out/old.png --normal-map map.png --interpolation gouraud", 2,
          "--normal-map: does not show with --interpolation gouraud or flat"},
         {"square.obj --output out/old.png --normals flat --crease 30", 2,
          "--crease: contradicts --normals flat"},
         {"scene.json --output out/old.png --up z", 2,
          "--up: applies to model files, not to scene files (rotate the nodes of the scene)"},
         {"square.obj --output out/old.png --animation walk", 2,
          "--animation: the model has no animation of its own to choose"},
         {"map.png --output out/old.png", 1, "map.png: "},
         {"square.obj --output nowhere/p.png", 1, "nowhere/p.png: "},
         {"plain.obj --output out/old.png --normal-map map.png", 1,
          "plain.obj: no texture coordinates for --normal-map (unwrap the model first, or "
          "leave --normal-map out)"},
         {"square.obj --output out/old.png --normal-map missing.png", 1, "missing.png: "},
         {"square.obj --output out/old.png --height-map noise.png", 1, "noise.png: "},
         {"square.obj --output out/old.png --diffuse-map noise.png", 1, "noise.png: "},
         {"square.obj --output out/old.png --environment missing.hdr", 1, "missing.hdr: "},
         {"square.obj --output out/old.png --environment empty", 1,
          "empty: no file whose name ends in posx (name the six files in the order +x -x +y "
          "-y +z -z)"}});
}

}  // namespace
}  // namespace relief::tools
