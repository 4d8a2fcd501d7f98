// SPDX-License-Identifier: Apache-2.0
// Continuing an asset with the maps of `relief make --keep-stages`, or before remeshing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

/// An asset with all kinds of maps, and the files of its stages in out/s.
class BakedAsset : public testing::Test {
  protected:
    void SetUp() override {
        std::string text = "mtllib in.mtl\n" + workplace.read("data/vase.obj");
        const std::size_t middle = text.find("\nf ", text.size() / 2);
        const std::size_t first = text.find("\nf ");
        text.insert(middle, "\nusemtl b");
        text.insert(first, "\nusemtl a");
        workplace.write("out/in.obj", text);
        workplace.write("out/in.mtl", "newmtl a\nKd 1 0.2 0.1\nnewmtl b\nKd 0.1 0.5 0.2\n");
        ASSERT_EQ(workplace.run("relief-mesh process out/in.obj out/in.gltf").exit_code, 0);
        json document = json::parse(workplace.read("out/in.gltf"));
        for (json& material : document["materials"]) {
            if (material["name"] == "a") {
                material["pbrMetallicRoughness"]["metallicFactor"] = 0.75;
                material["pbrMetallicRoughness"]["roughnessFactor"] = 0.25;
            } else if (material["name"] == "b") {
                material["emissiveFactor"] = {1, 0.5, 0};
            }
        }
        workplace.write("out/in.gltf", document.dump());
        const ProgramResult made = run();
        ASSERT_EQ(made.exit_code, 0) << made.error;
        asset = workplace.read("out/a.glb");
    }

    [[nodiscard]] ProgramResult run(const std::string& more = "") const {
        return workplace.run(
            "relief make out/in.gltf -o out/a.glb --triangles 200 --size 64 --padding 1 "
            "--occlusion-rays 2 --layers height,bent,thickness,ids --lods 1 --for unity "
            "--keep-stages out/s "
            "--report out/a.json " +
            more);
    }

    [[nodiscard]] std::filesystem::path map(const std::string& name) const {
        return workplace / ("out/s/06-bake-" + name + ".png");
    }

    void expect_refusal(const std::string& words) const {
        const ProgramResult result = run("--from write");
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_THAT(result.error, HasSubstr(words));
        EXPECT_TRUE(workplace.read("out/a.glb") == asset);
    }

    /// Returns a map of the asset's file.
    [[nodiscard]] Image stored(TextureSlot slot) const {
        const GltfView view = test::read_document(workplace / "out/a.glb").view();
        const Texture* texture = find_texture(view.materials.front(), slot);
        return read_image(std::get<std::vector<std::byte>>(view.images[texture->image].source),
                          "map", slot_info(slot).use);
    }

    Workplace workplace;
    std::string asset;
};

TEST_F(BakedAsset, IsTheSameIfNoMapWasEdited) {
    for (const char* name :
         {"normal", "color", "orm", "emission", "height", "bent", "thickness", "ids"})
        ASSERT_TRUE(std::filesystem::exists(map(name))) << name;
    std::map<std::string, std::string> beside;
    for (const char* name : {"MaskMap", "Height", "bent", "thickness", "ids"}) {
        const std::string file = std::string("out/a_") + name + ".png";
        beside[file] = workplace.read(file);
        ASSERT_FALSE(beside[file].empty()) << file;
    }
    std::filesystem::remove(workplace / "out/a.glb");
    const json before = json::parse(workplace.read("out/a.json"));
    const ProgramResult result = run("--from write");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_TRUE(workplace.read("out/a.glb") == asset) << "other bytes";
    for (const auto& [file, bytes] : beside)
        EXPECT_TRUE(workplace.read(file) == bytes) << file;
    EXPECT_THAT(result.out, Not(HasSubstr("that was edited")));
    const json after = json::parse(workplace.read("out/a.json"));
    for (const char* key : {"maps", "material", "texels_baked", "rays", "occlusion_rays",
                            "thickness_rays", "levels", "source"})
        EXPECT_EQ(after[key], before[key]) << key;
    std::vector<std::string> stages;
    for (const json& stage : after["stages"])
        stages.push_back(stage["stage"]);
    EXPECT_EQ(stages, (std::vector<std::string>{"read", "write", "verify"}));
}

TEST_F(BakedAsset, HasAnEditedMapInAllForms) {
    // A program stores colors with 16 bits and alpha.
    Image color = read_image(map("color"), ImageUse::color);
    ASSERT_EQ(color.channels, 3);
    Image edited = color;
    edited.channels = 4;
    std::vector<std::uint16_t> samples;
    for (std::size_t i = 0; i < color.sample_count(); i += 3) {
        for (const int code : {17, 99, 250})
            samples.push_back(static_cast<std::uint16_t>(257 * code + 100));
        samples.push_back(65535);
    }
    edited.samples = std::move(samples);
    write_image(map("color"), edited);
    const ProgramResult result = run("--from write");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("stage file that was edited"));
    const Image stored_color = stored(TextureSlot::base_color);
    EXPECT_EQ(stored_color.channels, 3);
    const auto texels = stored_color.as<std::uint8_t>();
    for (std::size_t i = 0; i < texels.size(); i += 3)
        ASSERT_EQ((std::vector<int>{texels[i], texels[i + 1], texels[i + 2]}),
                  (std::vector<int>{17, 99, 250}));
    // The edited map is the result of its stage now, as it is.
    EXPECT_EQ(read_image(map("color"), ImageUse::color).channels, 4);
    const std::string painted = workplace.read("out/a.glb");
    const ProgramResult again = run("--from write");
    EXPECT_THAT(again.out, Not(HasSubstr("that was edited")));
    EXPECT_TRUE(workplace.read("out/a.glb") == painted);
    // The maps of engines are made from it.
    Image orm = read_image(map("orm"), ImageUse::data);
    std::ranges::fill(orm.as<std::uint8_t>(), 0);
    write_image(map("orm"), orm);
    ASSERT_EQ(run("--from write").exit_code, 0);
    const Image mask = read_image(workplace / "out/a_MaskMap.png", ImageUse::data);
    const auto codes = mask.as<std::uint8_t>();
    ASSERT_EQ(mask.channels, 4);
    for (std::size_t i = 3; i < codes.size(); i += 4)
        ASSERT_EQ(codes[i], 255) << "smoothness";
}

TEST_F(BakedAsset, IsRefusedIfMapsDoNotFitOrAreStale) {
    const std::string color = workplace.read("out/s/06-bake-color.png");
    write_image(map("color"), read_image(map("normal"), ImageUse::data));  // Any content is valid.
    Image image = read_image(map("color"), ImageUse::color);
    image.height /= 2;
    std::get<std::vector<std::uint8_t>>(image.samples).resize(image.sample_count());
    write_image(map("color"), image);
    expect_refusal("06-bake-color.png: has 64 x 32 texels, but was baked with 64 x 64");
    image = read_image(map("normal"), ImageUse::data);
    image.channels = 4;
    image.samples = std::vector<std::uint8_t>(image.sample_count(), 7);
    write_image(map("color"), image);
    expect_refusal("has transparent texels, but the map was baked without opacity");
    workplace.write("out/s/06-bake-color.png", "no image");
    expect_refusal("06-bake-color.png: ");
    std::filesystem::remove(map("color"));
    expect_refusal("06-bake-color.png: is missing, but --from write needs it");
    workplace.write("out/s/06-bake-color.png", color);
    // Options of the bake, and earlier files.
    const ProgramResult stale = run("--from write --samples 4");
    EXPECT_EQ(stale.exit_code, 1);
    EXPECT_THAT(stale.error, HasSubstr("is stale: --samples was 1, and is 4 now"));
    const std::string frames = workplace.read("out/s/05-frames.glb");
    workplace.write("out/s/05-frames.glb", frames + " ");
    expect_refusal("05-frames.glb: has changed, but the files of later stages were made before");
    workplace.write("out/s/05-frames.glb", frames);
    EXPECT_EQ(run("--from write --loss --max-error 5").exit_code, 2);
    // Options of later stages may change.
    EXPECT_EQ(run("--from write").exit_code, 0);
    json record = json::parse(workplace.read("out/s/stages.json"));
    record.erase("bake");
    workplace.write("out/s/stages.json", record.dump());
    expect_refusal("stages.json: has no bake, or is damaged");
}

TEST_F(BakedAsset, ReportsFilesOfMapsThatWereNotBaked) {
    std::filesystem::copy(map("color"), map("occlusion"));
    const ProgramResult result = run("--from write");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("06-bake-occlusion.png is not used"));
    EXPECT_TRUE(workplace.read("out/a.glb") == asset);
}

class StartAtRemesh : public testing::Test {
  protected:
    [[nodiscard]] ProgramResult run(const std::string& more,
                                    const std::string& resolution = "24") const {
        return workplace.run(
            "relief make data/vase.obj out/a.glb --triangles 100 --size 32 --padding 1 "
            "--occlusion-rays 0 --keep-stages out/s --report out/a.json --resolution " +
            resolution + " " + more);
    }
    Workplace workplace;
};

TEST_F(StartAtRemesh, GivesTheSameIfNoFileWasEdited) {
    for (const char* remesh : {"--remesh always", "--remesh auto"}) {
        SCOPED_TRACE(remesh);
        ASSERT_EQ(run(remesh).exit_code, 0);
        const std::string asset = workplace.read("out/a.glb");
        const json before = json::parse(workplace.read("out/a.json"));
        const ProgramResult result = run(std::string(remesh) + " --from remesh");
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_TRUE(workplace.read("out/a.glb") == asset) << "other bytes";
        EXPECT_EQ(json::parse(workplace.read("out/a.json"))["remesh"], before["remesh"]);
    }
}

TEST_F(StartAtRemesh, ReplacesAnEditedMeshWithOtherOptions) {
    ASSERT_EQ(run("--remesh always").exit_code, 0);
    // A cube instead of the vase: rays still hit the vase where they can.
    workplace.write("out/box.obj",
                    "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 "
                    "1\nf 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n");
    ASSERT_EQ(workplace.run("relief-mesh process out/box.obj out/s/01-repair.glb").exit_code, 0);
    const ProgramResult result = run("--remesh always --from remesh", "16");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("stage file that was edited"));
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["remesh"]["remeshed"], true);
    float widest = 0.0F;
    for (const glm::vec3& p : test::read_document(workplace / "out/a.glb").mesh({0, 0}).positions)
        widest = std::max(widest, p.x);
    EXPECT_NEAR(widest, 1.0F, 1e-3F);
    for (const char* more : {"--remesh never", "--keep-uvs"}) {
        const ProgramResult refused = workplace.run(
            std::string("relief make data/vase.obj out/a.glb --keep-stages out/s --from remesh ") +
            more);
        EXPECT_EQ(refused.exit_code, 2);
        EXPECT_THAT(refused.error, HasSubstr("--from remesh: nothing is remeshed"));
    }
}

}  // namespace
}  // namespace relief::tools
