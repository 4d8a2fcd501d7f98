// SPDX-License-Identifier: Apache-2.0
// Sequences of pictures: names of numbered files, turntables, animations, and what is refused.
#include "picture_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "picture_sink.h"
#include "relief/mesh/image_file.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::picture_in;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

TEST(NumberedFile, AppendsANumberOrReplacesHashes) {
    EXPECT_EQ(numbered_file("out/spin.png", 7), "out/spin-0007.png");
    EXPECT_EQ(numbered_file("spin.exr", 12345), "spin-12345.exr");
    EXPECT_EQ(numbered_file("out/a##b.png", 3), "out/a03b.png");
    EXPECT_EQ(numbered_file("out/#.png", 12), "out/12.png");
}

TEST(Turntable, ReturnsToItsStart) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult turned = workplace.run(
        "relief-view square.obj --turntable 4 --size 64x64 --output out/t.png --camera 0,0");
    ASSERT_EQ(turned.exit_code, 0) << turned.error;
    EXPECT_EQ(workplace.outputs(), "t-0001.png t-0002.png t-0003.png t-0004.png");
    ASSERT_EQ(workplace.run("relief-view square.obj --size 64x64 --output out/p.png --camera 0,0")
                  .exit_code,
              0);
    const Image still = picture_in(workplace / "out/p.png");
    EXPECT_EQ(picture_in(workplace / "out/t-0001.png").samples, still.samples);
    // A quarter turned, a square is seen edge-on; half turned it fills the same pixels.
    EXPECT_NE(picture_in(workplace / "out/t-0002.png").samples, still.samples);
    EXPECT_THAT(turned.out, HasSubstr("t-0001.png to out/t-0004.png"));
}

TEST(Turntable, RotatesTheModelButNotLightMarkers) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewOptions options;
    options.model = workplace / "square.obj";
    options.turntable = 4;
    options.light_markers = 0.1F;
    options.lights = {PointLight{{3, 0, 0}, glm::vec3(1.0F)}};
    Stages stages(true);
    Report report;
    ComposedScene composed = compose_scene(options, stages, report);
    ASSERT_EQ(composed.scene().instances.size(), 2U);
    const glm::mat4 marker = composed.scene().instances[1].world_from_object;
    for (int i = 1; i < 4; ++i) {
        pose_for(composed, options, i);
        EXPECT_EQ(composed.scene().instances[1].world_from_object, marker) << i;
    }
    // Three quarters of a turn: what pointed right points to the eye.
    const glm::vec3 right(composed.scene().instances[0].world_from_object[0]);
    EXPECT_NEAR(right.z, 1.0F, 1e-6F);
}

TEST(Turntable, AsAnAnimationIsOneFile) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result = workplace.run(
        "relief-view square.obj --turntable 3 --size 32x32 --output out/t.apng --fps 10");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(workplace.outputs(), "t.apng");
    EXPECT_THAT(workplace.read("out/t.apng"), HasSubstr("acTL"));
    EXPECT_THAT(result.out, HasSubstr("frames"));
}

/// A triangle that moves one unit to the right in two seconds.
constexpr const char* moving_triangle = R"({
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
  "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "buffers": [{"byteLength": 68, "uri": "moving.bin"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 32}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
    {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2]},
    {"bufferView": 1, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "VEC3"}],
  "animations": [{"samplers": [{"input": 1, "output": 2}],
                  "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]
})";

void write_moving_triangle(const Workplace& workplace) {
    workplace.write("moving.gltf", moving_triangle);
    const std::array<float, 17> numbers{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 0};
    std::ofstream(workplace / "moving.bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
}

/// Replaces PATH while it exists.
class SearchPath {
  public:
    explicit SearchPath(const std::string& path) : before_(std::getenv("PATH")) {
        ::setenv("PATH", path.c_str(), 1);
    }
    SearchPath(const SearchPath&) = delete;
    SearchPath& operator=(const SearchPath&) = delete;
    ~SearchPath() { ::setenv("PATH", before_.c_str(), 1); }

  private:
    std::string before_;
};

TEST(Video, ReceivesEveryPictureAndReplacesTheFileAtTheEnd) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    // Stands in for ffmpeg: keeps its words, and writes its input to the file it is to write.
    workplace.write("ffmpeg",
                    "#!/bin/sh\necho \"$@\" > words\n"
                    "for last; do :; done\n/bin/cat > \"${last#file:}\"\n");
    std::filesystem::permissions(workplace / "ffmpeg", std::filesystem::perms::owner_all);
    const std::string video =
        "relief-view square.obj --turntable 3 --size 32x16 --camera 0,0 --fps 10 --output v.mp4";
    workplace.write("v.mp4", "an older file");
    {
        const SearchPath path((workplace / ".").string());
        const ProgramResult result = workplace.run(video);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_THAT(result.out, HasSubstr("wrote     v.mp4"));
    }
    EXPECT_THAT(workplace.read("words"), HasSubstr("-pix_fmt rgb24 -s 32x16 -r 10 -i pipe:0"));
    const std::string pictures = workplace.read("v.mp4");
    ASSERT_EQ(pictures.size(), 3U * 32U * 16U * 3U);
    ASSERT_EQ(
        workplace.run("relief-view square.obj --size 32x16 --camera 0,0 --output p.png").exit_code,
        0);
    const Image still = picture_in(workplace / "p.png");
    const auto samples = still.as<std::uint8_t>();
    for (std::size_t i = 0; i < 32U * 16U; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_EQ(static_cast<std::uint8_t>(pictures[3 * i + c]),
                      samples[static_cast<std::size_t>(still.channels) * i + c]);
        }
    }
}

TEST(Video, FailedProgramKeepsTheOldFile) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("ffmpeg", "#!/bin/sh\n/bin/cat > /dev/null\nexit 1\n");
    std::filesystem::permissions(workplace / "ffmpeg", std::filesystem::perms::owner_all);
    workplace.write("v.webm", "an older file");
    const std::string video = "relief-view square.obj --turntable 2 --size 32x16 --output v.webm";
    const auto run_with = [&](const std::string& folder) {
        const SearchPath path(folder);
        return workplace.run(video);
    };
    const ProgramResult failed = run_with((workplace / ".").string());
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_THAT(failed.error, HasSubstr("v.webm: ffmpeg failed"));
    const ProgramResult missing = run_with("/nonexistent");
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.error, HasSubstr("needs the program ffmpeg, which is not installed"));
    EXPECT_EQ(workplace.read("v.webm"), "an older file");
    std::size_t videos = 0;
    for (const auto& entry : std::filesystem::directory_iterator(workplace / "."))
        videos += entry.path().extension() == ".webm" ? 1 : 0;
    EXPECT_EQ(videos, 1U) << "a temporary file stays";
}

TEST(Frames, ShowTheAnimationEvenlySpacedInTime) {
    const Workplace workplace;
    write_moving_triangle(workplace);
    const std::string look = " --size 48x48 --camera 0,0,2 --output out/";
    ASSERT_EQ(workplace.run("relief-view moving.gltf --frames 4" + look + "f#.png").exit_code, 0);
    EXPECT_EQ(workplace.outputs(), "f1.png f2.png f3.png f4.png");
    // The camera stays where the first picture has it, so single pictures at other times differ in
    // framing; the first is the same.
    ASSERT_EQ(workplace.run("relief-view moving.gltf" + look + "p.png").exit_code, 0);
    EXPECT_EQ(picture_in(workplace / "out/f1.png").samples,
              picture_in(workplace / "out/p.png").samples);
    EXPECT_NE(picture_in(workplace / "out/f2.png").samples,
              picture_in(workplace / "out/f1.png").samples);
    EXPECT_NE(picture_in(workplace / "out/f3.png").samples,
              picture_in(workplace / "out/f2.png").samples);
}

TEST(Frames, ShowMaterialsThatMove) {
    const Workplace workplace;
    const std::vector<float> floats = {-9, -9, 0, 9, -9, 0, 0, 9, 0,             // A triangle.
                                       0,  1,  0, 0, 1,  1, 0, 1, 0.25F, 0.5F};  // Keys.
    workplace.write("k.bin",
                    std::string(reinterpret_cast<const char*>(floats.data()), 4 * floats.size()));
    workplace.write("m.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
      "extensionsUsed": ["KHR_animation_pointer", "KHR_materials_unlit"],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
      "materials": [{"alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}}}],
      "buffers": [{"uri": "k.bin", "byteLength": 76}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                      {"buffer": 0, "byteOffset": 44, "byteLength": 32}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                     "min": [-9, -9, 0], "max": [9, 9, 0]},
                    {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
                    {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC4"}],
      "animations": [{"samplers": [{"input": 1, "output": 2}],
        "channels": [{"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer":
          {"pointer": "/materials/0/pbrMetallicRoughness/baseColorFactor"}}}}]}]})");
    const ProgramResult result = workplace.run(
        "relief-view m.gltf --frames 2 --size 32x32 --samples 1 --background '#000000' --output "
        "out/f#.png");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const auto middle = [&](const char* file) {
        const Image picture = picture_in(workplace / "out" / file);
        const std::size_t pixel = static_cast<std::size_t>(picture.channels) * (16 * 32 + 16);
        return std::pair(picture.as<std::uint8_t>()[pixel + 1],
                         picture.as<std::uint8_t>()[pixel + 2]);
    };
    // Linear colors times alpha: blue 1 and green 0; then green 0.5 and blue 0.625, alpha 0.75.
    EXPECT_EQ(middle("f1.png"), std::pair(std::uint8_t{0}, std::uint8_t{255}));
    EXPECT_NEAR(middle("f2.png").first, 255 * srgb_from_linear(0.75F * 0.5F), 2);
    EXPECT_NEAR(middle("f2.png").second, 255 * srgb_from_linear(0.75F * 0.625F), 2);
}

TEST(SequenceRefusal, StatesTheReasonAndWritesNoFile) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    expect_refusals(
        workplace, "relief-view", "old.png",
        {{"square.obj --output out/old.png --turntable 0", 2, "--turntable 0: not between"},
         {"square.obj --output out/old.png --turntable 4 --frames 4", 2,
          "--turntable: contradicts --frames"},
         {"square.obj --output out/old.png --seconds 4", 2, "--seconds: needs --frames"},
         {"square.obj --output out/old.png --turntable 4 --fps 10", 2,
          "--fps: applies to animations and videos"},
         {"square.obj --output out/a.apng", 2,
          "--output out/a.apng: an animation needs several pictures"},
         {"square.obj --output out/old.png --frames 4", 2,
          "--frames: the scene has no animation (use --turntable)"},
         {"square.obj --explain-effects --turntable 4", 2, "--turntable: there is no --output"},
         {"square.obj --output out/old.png --light-markers 0.1", 2,
          "--light-markers: there is no point or spot light to show"},
         {"square.obj --output out/old.png --material golt", 2,
          "--material golt: unknown material; did you mean 'gold'?"},
         {"square.obj --output out/old.png --metallic-roughness 1", 2,
          "--metallic-roughness 1: not metallic,roughness"},
         {"square.obj --output out/old.png --metallic-roughness 1,2", 2,
          "--metallic-roughness 1,2: both numbers must be between 0 and 1"},
         {"square.obj --output out/old.png --metallic-roughness 1,0 --shininess 4", 2,
          "--metallic-roughness: needs the glTF model, and --shininess needs the Phong model"},
         {"square.obj --output out/old.png --shading as_authored --interpolation gouraud", 2,
          "--interpolation gouraud: needs the Phong model"},
         {"square.obj --output out/old.png --height-as bump_map", 2,
          "--height-as: needs --height-map"},
         {"square.obj --output out/old.png --height-depth 8", 2,
          "--height-depth, --height-method: the scene has no height map to displace by (give one "
          "with "
          "--height-map)"},
         {"square.obj --output out/old.png --height-map h.png --height-layers 8", 2,
          "--height-layers: applies to layers and cones"},
         {"square.obj --output out/old.png --height-map h.png --height-method parallax "
          "--height-steps 8",
          2, "--height-steps: applies to maximum mipmaps"},
         {"square.obj --output out/old.png --height-map h.png --height-bound 1 --turntable 4", 2,
          "--height-bound: applies to single pictures"},
         {"square.obj --output out/old.html --height-map h.png --height-bound 1", 2,
          "--height-bound: applies to single pictures"},
         {"square.obj --output out/old.png --height-map h.png --height-bound -1", 2,
          "--height-bound -1: not between 0 and "},
         {"square.obj --output out/old.png --height-map h.png --height-shadow maybe", 2,
          "--height-shadow"},
         {"square.obj --output out/old.png --height-map h.png --height-depth 8 --cone-map c.png", 2,
          "--cone-map: applies to relaxed cones"},
         {"square.obj --output out/old.png --normal-space object", 2,
          "--normal-space: needs --normal-map"},
         {"square.obj --output out/old.png --fresnel conductor", 2,
          "--fresnel: there is no --environment"},
         {"square.obj --output out/old.png --environment-light on", 2,
          "--environment-light: there is no --environment"},
         {"square.obj --output out/old.exr --exposure 1", 2,
          "--exposure: applies to display colors"}});
}

}  // namespace
}  // namespace relief::tools
