// SPDX-License-Identifier: Apache-2.0
// The kinds of maps: files state them, every command honors them, and refuses maps of a wrong kind.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

#include "common/map_kind.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/texture_file.h"
#include "support/images.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::IsEmpty;

/// A color image that is no normal map, like a photograph.
Image colors() {
    Image image = make_image(32, 32, 3, 8, ColorSpace::srgb);
    for (int i = 0; i < 32 * 32; ++i) {
        const double u = i % 32 / 32.0, v = i / 32 / 32.0;
        const double channels[] = {0.2 + 0.3 * u, 0.5 * v + 0.2 * std::sin(9 * u), 0.1 + 0.2 * v};
        for (int c = 0; c < 3; ++c) {
            image.as<std::uint8_t>()[static_cast<std::size_t>(3 * i + c)] =
                static_cast<std::uint8_t>(255.0 * std::clamp(channels[c], 0.0, 1.0));
        }
    }
    return image;
}

/// Heights with slopes along both axes.
Image heights() {
    Image image = make_image(32, 32, 1, 16, ColorSpace::data);
    for (int i = 0; i < 32 * 32; ++i) {
        const double wave = std::sin(0.4 * (i % 32)) * std::cos(0.3 * (i / 32));
        image.as<std::uint16_t>()[static_cast<std::size_t>(i)] =
            static_cast<std::uint16_t>(30000.0 + 20000.0 * wave);
    }
    return image;
}

/// The largest difference of two pictures of the same size, in codes.
int difference(const Image& a, const Image& b) {
    int largest = 0;
    for (std::size_t i = 0; i < a.sample_count(); ++i)
        largest = std::max(largest, std::abs(a.as<std::uint8_t>()[i] - b.as<std::uint8_t>()[i]));
    return largest;
}

class MapKinds : public testing::Test {
  protected:
    MapKinds() {
        place_.write_square("square.obj");
        write_image(place_ / "photo.png", colors());
        write_image(place_ / "height.png", heights());
        run("bump height.png stated-normal.png --strength 4 --kernel sobel3");
        // The same texels in a file that states nothing.
        const Image normals = read_image(place_ / "stated-normal.png", ImageUse::data);
        write_image(place_ / "normal.png", normals);
        write_image(place_ / "colors.png", normals, write_description({.kind = MapKind::color}, 8));
        write_image(place_ / "object.png", normals,
                    write_description({.kind = MapKind::object_normal}, 8));
    }

    void run(const std::string& words) const { run_tool("relief-bake " + words); }
    void run_tool(const std::string& line) const {
        const ProgramResult result = place_.run(line);
        EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.error;
    }
    void refuses(const std::string& line, const std::string& error) const {
        const std::string before = place_.outputs();
        const ProgramResult result = place_.run(line);
        EXPECT_EQ(result.exit_code, 1) << line << result.out;
        EXPECT_THAT(result.error, HasSubstr(error)) << line;
        EXPECT_EQ(place_.outputs(), before) << line;
    }
    [[nodiscard]] MapDescription description_of(const std::string& file) const {
        return read_description(read_image_info(place_ / file).metadata);
    }

    const Workplace place_;
};

/// A command that reads a map, with % for its name, and the kind as which it reads it.
struct Reader {
    std::string line;
    MapKind kind;
};

const std::vector<Reader> readers = {
    {"relief-bake convert % out/a.png --bits 8", MapKind::normal},
    {"relief-bake convert % out/a.png --flip green", MapKind::normal},
    {"relief-bake convert % out/a.ktx2 --kind normal", MapKind::normal},
    {"relief-bake convert normal.png out/a.png --detail % --input-green up", MapKind::normal},
    {"relief-bake heights % out/a.png --input-green up", MapKind::normal},
    {"relief-bake check normal.png --exact %", MapKind::normal},
    {"relief-bake mesh square.obj square.obj out/a.png --size 4 --high-normal-map %",
     MapKind::normal},
    {"relief-mesh material square.obj out/a.glb --normal %", MapKind::normal},
    {"relief-view square.obj --output out/a.png --size 8x8 --normal-map %", MapKind::normal},
    {"relief-bake bump % out/a.png --kernel sobel3", MapKind::height},
    {"relief-view square.obj --output out/a.png --size 8x8 --height-map %", MapKind::height},
};

std::string with_file(std::string line, const std::string& file) {
    return line.replace(line.find('%'), 1, file);
}

TEST_F(MapKinds, AWrongKindIsAnErrorThatAssumeOverrides) {
    for (const Reader& reader : readers) {
        const bool wants_normals = reader.kind == MapKind::normal;
        const std::string assume = fmt::format("--assume {}", enum_name(reader.kind));
        // Stated, and judged by the texels.
        for (const char* const file :
             wants_normals ? std::initializer_list<const char*>{"colors.png", "photo.png"}
                           : std::initializer_list<const char*>{"stated-normal.png", "normal.png"})
            refuses(with_file(reader.line, file), assume + " reads it anyway)");
        const std::string wrong = wants_normals ? "photo.png" : "normal.png";
        const bool can_be_read = reader.line.find("--detail") == std::string::npos &&
                                 reader.line.find("--exact") == std::string::npos;
        if (!can_be_read) continue;
        EXPECT_EQ(place_.run(with_file(reader.line, wrong) + " " + assume).exit_code, 0)
            << reader.line;
        EXPECT_EQ(place_.run("rm -f out/*").exit_code, 0);
    }
}

TEST_F(MapKinds, TexelsDecideForDdsWhichHoldsNoText) {
    run("convert stated-normal.png out/normal.dds --format bc5");
    run("convert photo.png out/photo.dds --kind color --format bc7");
    for (const Reader& reader : readers) {
        const bool wants_normals = reader.kind == MapKind::normal;
        if (reader.line.starts_with("relief-mesh material")) continue;  // glTF has no DDS.
        refuses(with_file(reader.line, wants_normals ? "out/photo.dds" : "out/normal.dds"),
                fmt::format("--assume {} reads it anyway)", enum_name(reader.kind)));
    }
    run("bump out/normal.dds out/a.png --kernel sobel3 --assume height");
    // Green is unknown, and stays so.
    run("convert out/normal.dds out/b.png");
    EXPECT_FALSE(description_of("out/b.png").green);
    run("convert out/normal.dds out/c.png --input-green down");
    EXPECT_EQ(description_of("out/c.png").green, Green::down);
}

TEST_F(MapKinds, ErrorsNameTheCommandThatConverts) {
    const Image gray = read_image(place_ / "height.png", ImageUse::data);
    Image colors_of_gray = make_image(gray.width, gray.height, 3, 16, ColorSpace::data);
    for (std::size_t i = 0; i < colors_of_gray.sample_count(); ++i)
        colors_of_gray.as<std::uint16_t>()[i] = gray.as<std::uint16_t>()[i / 3];
    write_image(place_ / "gray.png", colors_of_gray);
    refuses("relief-mesh material square.obj out/a.glb --normal gray.png",
            "gray.png: is gray, like a height map or a mask, so it is not a normal map (convert "
            "it with relief-bake bump; --assume normal reads it anyway)");
    refuses("relief-bake bump stated-normal.png out/a.png",
            "stated-normal.png: is a normal map in tangent space, as its metadata say (convert it "
            "with relief-bake heights; --assume height reads it anyway)");
    refuses("relief-mesh material square.obj out/a.glb --normal object.png",
            "object.png: is a normal map in object space, as its metadata say (convert it with "
            "relief-bake convert --to-tangent MESH; --assume normal reads it anyway)");
    refuses("relief-mesh material square.obj out/a.glb --base-color stated-normal.png",
            "stated-normal.png: is a normal map in tangent space, as its metadata say (give a "
            "color map; --assume color reads it anyway)");
    refuses("relief-bake pack out/a.png --roughness stated-normal.png:g",
            "as its metadata say (give a roughness map; --assume roughness reads it anyway)");
    EXPECT_EQ(place_.run("relief-bake heights photo.png out/a.png --assume height").exit_code, 2);
}

TEST_F(MapKinds, OneChannelIsNoNormalMapWhateverIsAssumed) {
    for (const Reader& reader : readers) {
        if (reader.kind != MapKind::normal) continue;
        const std::string line = with_file(reader.line, "height.png");
        const bool can_assume =
            line.find("--detail") == std::string::npos && line.find("--exact") == std::string::npos;
        for (const char* const assume : {"", " --assume normal"}) {
            if (!can_assume && *assume != 0) continue;
            refuses(line + assume,
                    "height.png: has 1 channel, but normals need at least 2 (relief-bake bump "
                    "converts height maps)");
        }
    }
}

TEST_F(MapKinds, MapsOfSceneFilesAreErrors) {
    struct Row {
        std::string map;  ///< In JSON.
        std::string error;
        std::string assume;
    };
    const std::vector<Row> rows = {
        {R"("normal_map": "photo.png")",
         "photo.png: is not a normal map: its texels are colors, or several masks (give a normal "
         "map in tangent space; --assume normal reads it anyway)",
         "normal"},
        // One channel cannot be read as normals.
        {R"("normal_map": {"texture": "height.png"})", "has 1 channel, but normals need at least 2",
         ""},
        {R"("bump_map": "normal.png")", "relief-bake heights; --assume height", "height"},
        {R"("bump_map": "stated-normal.png")", "as its metadata say", "height"},
        {R"("diffuse_texture": "stated-normal.png")", "give a color map; --assume color", "color"},
    };
    for (const Row& row : rows) {
        place_.write("scene.json", R"({"relief_scene": 1, "ambient": 0.2,
            "lights": [{"type": "directional", "direction": [0, -1, -1]}],
            "nodes": [{"model": "square.obj", "material": "floor"}],
            "materials": {"floor": {"diffuse": 0.8, )" +
                                       row.map + "}}}");
        const std::string line = "relief-view scene.json --output out/a.png --size 8x8";
        refuses(line, "scene.json: ");
        refuses(line, " of material 'floor': ");
        refuses(line, row.error);
        if (row.assume.empty()) continue;
        const ProgramResult result = place_.run(line + " --strict --assume " + row.assume);
        EXPECT_EQ(result.exit_code, 0) << row.map << result.out << result.error;
        EXPECT_EQ(place_.run("rm out/a.png").exit_code, 0);
    }
}

TEST_F(MapKinds, MapsOfModelsAreFindings) {
    place_.write("m.mtl", "newmtl m\nKd 1 1 1\nmap_Bump normal.png\n");
    place_.write("m.obj", "mtllib m.mtl\nusemtl m\n" + place_.read("square.obj"));
    run_tool("relief-mesh material square.obj out/m.glb --assume normal --normal photo.png");
    for (const auto& [model, finding, assume] :
         {std::tuple("m.obj", "bump map that seems to be a normal map", "height"),
          std::tuple("out/m.glb", "normal map that is not a normal map: its texels are colors",
                     "normal")}) {
        const std::string line =
            fmt::format("relief-view {} --output out/a.png --size 8x8 --strict", model);
        const ProgramResult found = place_.run(line);
        EXPECT_EQ(found.exit_code, 3) << model;
        EXPECT_THAT(found.out, HasSubstr(finding));
        EXPECT_EQ(place_.run(line + " --assume " + assume).exit_code, 0) << model;
    }
}

TEST_F(MapKinds, AChannelOfAnotherMapCanBeHeights) {
    run("bump height.png out/parallax.png --alpha height --kernel sobel3");
    run("bump out/parallax.png out/a.png --channel alpha --kernel sobel3");
    run("bump colors.png out/b.png --channel red --kernel sobel3");
    refuses("relief-bake bump stated-normal.png out/c.png --channel red", "heights; --assume");
}

TEST_F(MapKinds, MaterialsTakeOnlyTheConventionsOfGltf) {
    run("convert stated-normal.png out/down.png --flip green");
    run("convert stated-normal.png out/128.png --zero-code 128 --bits 8");
    run("bump height.png out/xy.png --xy --kernel sobel3");
    run("pack out/unity.png --roughness height.png --for unity");
    const std::string material = "relief-mesh material square.obj out/a.glb ";
    refuses(material + "--normal out/down.png",
            "out/down.png: has green down, but glTF has green up, as its metadata say (convert it "
            "with relief-bake convert out/down.png OUT.png --flip green)");
    refuses(material + "--normal out/128.png", "OUT.png --zero-code 127.5)");
    refuses(material + "--normal out/xy.png", "OUT.png --rebuild-z rg)");
    refuses(material + "--metallic-roughness out/unity.png", "is packed for Unity");
    EXPECT_EQ(place_.run(material + "--normal out/down.png --assume normal").exit_code, 0);
    // The remedy works.
    run("convert out/down.png out/up.png --flip green");
    EXPECT_EQ(place_.run(material + "--normal out/up.png").exit_code, 0);
    // Codes without z can be mapped, but not decoded.
    run("convert out/xy.png out/xy2.png --flip green");
    EXPECT_TRUE(description_of("out/xy2.png").xy_only);
    refuses("relief-bake convert out/xy.png out/a.png --bits 8", "--rebuild-z rg)");
    run("convert out/xy.png out/xyz.png --rebuild-z rg");
    EXPECT_FALSE(description_of("out/xyz.png").xy_only);
}

TEST_F(MapKinds, EveryMapStatesItsKindColorSpaceAndAlpha) {
    const auto expect = [&](const std::string& file, MapKind kind, ColorSpace space,
                            std::optional<AlphaContent> alpha = std::nullopt) {
        const MapDescription stated = description_of(file);
        EXPECT_EQ(stated.kind, kind) << file;
        EXPECT_EQ(stated.color_space, space) << file;
        EXPECT_EQ(stated.alpha, alpha) << file;
    };
    const ColorSpace data = ColorSpace::data;
    for (const char* const extension : {"png", "tif", "exr"}) {
        const std::string name = fmt::format("out/n.{}", extension);
        run(fmt::format("bump height.png {} --alpha height --kernel sobel3", name));
        expect(name, MapKind::normal, data, AlphaContent::height);
        EXPECT_EQ(description_of(name).green, Green::up);
        run(fmt::format("convert {0} out/c.{1} --flip green", name, extension));
        expect(fmt::format("out/c.{}", extension), MapKind::normal, data, AlphaContent::height);
        EXPECT_EQ(description_of(fmt::format("out/c.{}", extension)).green, Green::down);
    }
    run("convert out/n.png out/d.png --alpha drop --bits 8");
    expect("out/d.png", MapKind::normal, data);
    run("convert out/d.png out/l.png --mips --mip-lengths --roughness-from-variance 0.3");
    expect("out/l-mip02.png", MapKind::normal, data, AlphaContent::length);
    expect("out/l-roughness.png", MapKind::roughness, data);
    run("convert out/d.png out/d.ktx2");
    expect("out/d.ktx2", MapKind::normal, data);
    run("convert out/d.png out/o.png --to-object square.obj");
    expect("out/o.png", MapKind::object_normal, data);
    run("heights out/d.png out/h.png");
    expect("out/h.png", MapKind::height, data);
    run("pack out/p.png --roughness height.png");
    expect("out/p.png", MapKind::packed, data);
    run("mesh square.obj square.obj out/b.png --size 4 --color-map out/bc.png --occlusion-map "
        "out/bo.png --background transparent --verify --error-map out/be.png");
    expect("out/b.png", MapKind::normal, data, AlphaContent::coverage);
    expect("out/bc.png", MapKind::color, ColorSpace::srgb, AlphaContent::coverage);
    expect("out/bo.png", MapKind::occlusion, data, AlphaContent::coverage);
    expect("out/be.png", MapKind::error, ColorSpace::srgb, AlphaContent::coverage);
    // `check` shows what is stated.
    const json checked =
        json::parse(place_.run("relief-bake check out/n.png --json").out)["files"][0]["stated"];
    EXPECT_EQ(checked["content"], "normal map, tangent space");
    EXPECT_EQ(checked["alpha"], "height");
    EXPECT_THAT(place_.run("relief-bake check out/c.png").out,
                HasSubstr("a normal map in tangent space, green down, zero is 127.5 of 255, height "
                          "in alpha\n"));
}

TEST_F(MapKinds, TheStatedGreenIsThatOfTheBakedTexture) {
    run("convert stated-normal.png out/down.png --flip green");
    const std::string bake = "mesh square.obj square.obj out/a.png --size 16 --high-normal-map ";
    run(bake + "stated-normal.png");
    const std::string up = place_.read("out/a.png");
    run(bake + "out/down.png");
    EXPECT_EQ(place_.read("out/a.png"), up);
}

TEST_F(MapKinds, TheStatedConventionsAreThoseOfThePicture) {
    run("convert stated-normal.png out/down.png --flip green");
    const auto picture = [&](const std::string& words) {
        const ProgramResult result =
            place_.run("relief-view square.obj --output out/view.png --size 16x16 " + words);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return test::picture_in(place_ / "out/view.png");
    };
    // Textures are filtered as they are stored, so that rounding may differ.
    const Image up = picture("--normal-map stated-normal.png");
    EXPECT_LE(difference(picture("--normal-map out/down.png"), up), 1);
    EXPECT_GT(difference(picture("--normal-map out/down.png --green up"), up), 5);
    EXPECT_EQ(difference(picture("--normal-map object.png"),
                         picture("--normal-map normal.png --normal-space object")),
              0);
    // A model file with such a texture, which other programs would show with inverted green.
    ASSERT_EQ(place_
                  .run("relief-mesh material square.obj out/m.gltf --assume normal --normal "
                       "out/down.png")
                  .exit_code,
              0);
    ASSERT_EQ(place_.run("relief-mesh material square.obj out/u.gltf --normal stated-normal.png")
                  .exit_code,
              0);
    const auto of_model = [&](const std::string& model) {
        const ProgramResult result =
            place_.run("relief-view " + model + " --output out/view.png --size 16x16");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return std::pair(test::picture_in(place_ / "out/view.png"), result.out);
    };
    const auto [as_stated, out] = of_model("out/m.gltf");
    EXPECT_LE(difference(as_stated, of_model("out/u.gltf").first), 1);
    EXPECT_THAT(out, HasSubstr("normal map that states green down"));
}

TEST_F(MapKinds, FewTexelsAreNotJudged) {
    write_image(place_ / "one.png", test::image_of<std::uint8_t>(3, {200, 60, 10}));
    run("convert one.png out/a.png --bits 16");
}

TEST(MapKindOfRealImages, TexelsDistinguishNormalMapsFromOtherImages) {
    RELIEF_NEEDS_SHARED(textures, "data/textures");
    std::size_t normals = 0, others = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(textures)) {
        const std::string name = entry.path().filename().string();
        const std::string extension = entry.path().extension().string();
        const bool is_decoder_test = entry.path().string().find("/decoder/") != std::string::npos;
        if (is_decoder_test || name.find("4096") != std::string::npos) continue;
        if (extension != ".png" && extension != ".jpg" && extension != ".exr") continue;
        const bool is_normal = name.find("norm") != std::string::npos ||
                               name.find("nrm") != std::string::npos || name == "parallax-n.png";
        const MapContent content = judged_content(read_sample(entry.path()));
        EXPECT_EQ(content == MapContent::tangent_normals, is_normal) << name;
        (is_normal ? normals : others) += 1;
    }
    EXPECT_GE(normals, 8U);
    EXPECT_GE(others, 12U);
}

}  // namespace
}  // namespace relief::tools
