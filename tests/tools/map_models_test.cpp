// SPDX-License-Identifier: Apache-2.0
// The models of a bake: texture coordinates, normals and space, also in `relief-bake mesh` and
// `convert`.
#include "common/model_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::Workplace;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two triangles at a right angle without normals, one facing +z and one -x. The normal texture
/// uses set 1, in which they divide the middle of the image; set 0 is one point. The scene has two
/// instances: scaled by 2, and moved by 10 along x.
class MapModels : public testing::Test {
  protected:
    MapModels() {
        const std::vector<float> numbers = {
            0,    -1,   0,    0,    1,    0,    1,    0,    0, 0, 0, -1,  // POSITION
            0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F,               // TEXCOORD_0
            0.5F, 1,    0.5F, 0,    1,    0.5F, 0,    0.5F,               // TEXCOORD_1
            1,    0,    0,    1,    1,    0,    0,    1,    1, 0, 0, 1,  1, 0, 0, 1};
        const std::vector<std::uint32_t> triangles = {0, 2, 1, 0, 1, 3};
        std::string bytes(reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size());
        bytes.append(reinterpret_cast<const char*>(triangles.data()), 4 * triangles.size());
        workplace_.write("fold.bin", bytes);
        const auto view = [](int offset, int length) {
            return json{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
        };
        const auto floats = [](int view_index, const char* type) {
            return json{
                {"bufferView", view_index}, {"componentType", 5126}, {"count", 4}, {"type", type}};
        };
        document_ = {
            {"asset", {{"version", "2.0"}}},
            {"buffers", {{{"uri", "fold.bin"}, {"byteLength", bytes.size()}}}},
            {"bufferViews",
             {view(0, 48), view(48, 32), view(80, 32), view(112, 64), view(176, 24)}},
            {"accessors",
             {floats(0, "VEC3"),
              floats(1, "VEC2"),
              floats(2, "VEC2"),
              floats(3, "VEC4"),
              {{"bufferView", 4}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}}},
            {"images", {{{"uri", "map.png"}}}},
            {"textures", {{{"source", 0}}}},
            {"materials", {{{"normalTexture", {{"index", 0}, {"texCoord", 1}}}}}},
            {"meshes",
             {{{"primitives",
                {{{"attributes",
                   {{"POSITION", 0}, {"TEXCOORD_0", 1}, {"TEXCOORD_1", 2}, {"TANGENT", 3}}},
                  {"indices", 4},
                  {"material", 0}}}}}}},
            {"nodes",
             {{{"mesh", 0}, {"scale", {2, 2, 2}}}, {{"mesh", 0}, {"translation", {10, 0, 0}}}}},
            {"scenes", {{{"nodes", {0, 1}}}}},
            {"scene", 0}};
        // Accessors of positions must have min and max.
        document_["accessors"][0]["min"] = {0, -1, -1};
        document_["accessors"][0]["max"] = {1, 1, 0};
        write();
    }

    void write() const { workplace_.write("fold.gltf", document_.dump()); }

    [[nodiscard]] MapModel read(ModelSpace space, Report& report) const {
        return read_map_model(workplace_ / "fold.gltf", space, report);
    }

    Workplace workplace_;
    json document_;
};

TEST_F(MapModels, NormalsAreFlatAndTextureCoordinatesThoseOfTheNormalTexture) {
    Report report;
    const MapModel model = read(ModelSpace::object, report);
    ASSERT_EQ(model.parts.size(), 1U);
    EXPECT_EQ(model.parts[0].name, "mesh 0 primitive 0");
    const Mesh& mesh = model.parts[0].mesh;
    ASSERT_EQ(mesh.positions.size(), 6U) << "both triangles have vertices of their own";
    const glm::vec3 normals[] = {{0, 0, 1}, {-1, 0, 0}};
    const glm::vec2 texcoords[] = {{0.5F, 1}, {0.5F, 0}, {1, 0.5F}, {0, 0.5F}};
    const int corners[2][3] = {{0, 2, 1}, {0, 1, 3}};
    for (std::size_t triangle = 0; triangle < 2; ++triangle) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = mesh.triangles[triangle][corner];
            EXPECT_EQ(mesh.normals[vertex], normals[triangle]);
            EXPECT_EQ(mesh.texcoords[vertex], texcoords[corners[triangle][corner]]);
        }
    }
    EXPECT_THAT(mesh.tangents, IsEmpty()) << "they are for normals that nobody knows";
    EXPECT_THAT(report.findings(), Contains(Field(&Finding::kind, "tangents without normals")));
}

TEST_F(MapModels, WorldSpaceHasEveryInstance) {
    Report report;
    MapModel model = read(ModelSpace::world, report);
    ASSERT_EQ(model.parts.size(), 2U);
    EXPECT_FALSE(model.world_from_object);
    const Mesh all = joined(std::move(model.parts));
    EXPECT_EQ(bounds_of(all).min, glm::vec3(0, -2, -2));
    EXPECT_EQ(bounds_of(all).max, glm::vec3(11, 2, 0));
    EXPECT_EQ(all.normals.size(), 12U);
    EXPECT_EQ(all.triangles[2], all.triangles[0] + 6U);
    document_["scenes"][0]["nodes"] = {0};
    write();
    EXPECT_EQ(read(ModelSpace::world, report).world_from_object, glm::dmat3(2.0));
}

TEST_F(MapModels, JoinedKeepsCommonAttributes) {
    Report report;
    MapModel model = read(ModelSpace::world, report);
    model.parts[1].mesh.texcoords.clear();
    EXPECT_THAT([&] { require_texcoords("fold.gltf", model, "has none", "give some"); },
                testing::ThrowsMessage<FileError>(
                    HasSubstr("fold.gltf: mesh 0 primitive 0: has none (give some)")));
    const Mesh all = joined(std::move(model.parts));
    EXPECT_EQ(all.normals.size(), 12U);
    EXPECT_THAT(all.texcoords, IsEmpty());
}

TEST_F(MapModels, PartsWithoutColorsAreWhiteIfOthersHaveColors) {
    Report report;
    MapModel model = read(ModelSpace::world, report);
    EXPECT_THAT(joined(model.parts).colors, IsEmpty());
    const std::size_t first = model.parts[0].mesh.positions.size();
    model.parts[1].mesh.colors.assign(model.parts[1].mesh.positions.size(),
                                      glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
    const Mesh all = joined(std::move(model.parts));
    ASSERT_EQ(all.colors.size(), all.positions.size());
    EXPECT_EQ(all.colors[first - 1], glm::vec4(1.0F));
    EXPECT_EQ(all.colors[first], glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
}

TEST_F(MapModels, BakedAndConvertedByTheSameRules) {
    document_["scenes"][0]["nodes"] = {0};
    write();
    const std::string bake =
        "relief-bake mesh fold.gltf fold.gltf out/map.exr --size 8 --space object --quiet";
    // The normal map would be applied if it existed.
    const auto refused = workplace_.run(bake);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.error,
                HasSubstr("map.png is missing (put it there, or use --high-normal-map none"));
    ASSERT_EQ(workplace_.run(bake + " --high-normal-map none").error, "");
    const Image baked = read_image(workplace_ / "out/map.exr", ImageUse::data);
    const auto texel = [](const Image& image, std::size_t index) {
        const auto samples = image.as<float>();
        return std::vector<float>{samples[3 * index], samples[3 * index + 1],
                                  samples[3 * index + 2]};
    };
    // The texels are in row 4, left and right of the edge.
    EXPECT_THAT(texel(baked, 34), ElementsAre(0.0F, 0.5F, 0.5F));
    EXPECT_THAT(texel(baked, 37), ElementsAre(0.5F, 0.5F, 1.0F));
    // The object space of a bake is that of convert, so the tangent-space map is flat.
    ASSERT_EQ(workplace_
                  .run("relief-bake convert out/map.exr out/tangent.exr --to-tangent fold.gltf "
                       "--quiet")
                  .error,
              "");
    const Image flat = read_image(workplace_ / "out/tangent.exr", ImageUse::data);
    for (const std::size_t index : {34U, 37U})
        EXPECT_THAT(texel(flat, index), testing::Pointwise(testing::FloatNear(1e-6F),
                                                           std::vector<float>{0.5F, 0.5F, 1.0F}));
}

}  // namespace
}  // namespace relief::tools
