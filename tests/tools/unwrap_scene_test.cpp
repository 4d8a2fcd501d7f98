// SPDX-License-Identifier: Apache-2.0
// The command `relief-mesh unwrap` on glTF scenes: one map for all meshes, and all other data
// stays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::read_document;
using test::Workplace;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A glTF file with one buffer.
class SceneFile {
  public:
    SceneFile() {
        root["asset"]["version"] = "2.0";
        root["scene"] = 0;
    }

    /// Adds an accessor. \return its index
    template <typename T>
    std::size_t add(const std::vector<T>& values, int component_type, const std::string& type,
                    std::size_t components, const json& more = json::object()) {
        const std::size_t offset = bytes_.size();
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        json accessor = more;
        accessor["bufferView"] = root["bufferViews"].size();
        accessor["componentType"] = component_type;
        accessor["count"] = values.size() / components;
        accessor["type"] = type;
        root["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
        root["accessors"].push_back(accessor);
        return root["accessors"].size() - 1;
    }
    std::size_t add_positions(const std::vector<float>& values) {
        json bounds;
        for (std::size_t k = 0; k < 3; ++k) {
            float low = values[k];
            float high = values[k];
            for (std::size_t i = k; i < values.size(); i += 3) {
                low = std::min(low, values[i]);
                high = std::max(high, values[i]);
            }
            bounds["min"].push_back(low);
            bounds["max"].push_back(high);
        }
        return add(values, 5126, "VEC3", 3, bounds);
    }
    /// A square in the xy plane with side 1. \return its primitive
    json square(float x) {
        json primitive;
        primitive["attributes"]["POSITION"] =
            add_positions({x, 0, 0, x + 1, 0, 0, x + 1, 1, 0, x, 1, 0});
        primitive["indices"] = add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
        return primitive;
    }
    std::size_t add_square_texcoords() {
        return add(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
    }

    void write(const Workplace& workplace) {
        if (!root.contains("scenes")) root["scenes"] = json::parse(R"([{"nodes": [0]}])");
        if (!root.contains("nodes")) root["nodes"] = json::parse(R"([{"mesh": 0}])");
        root["buffers"][0] = {{"uri", "scene.bin"}, {"byteLength", bytes_.size()}};
        workplace.write("scene.bin", bytes_);
        workplace.write("scene.gltf", root.dump());
    }

    json root;

  private:
    std::string bytes_;
};

/// Adds a material with a base color texture.
void add_texture(SceneFile& scene, const json& info) {
    scene.root["materials"].push_back({{"name", "Painted"},
                                       {"pbrMetallicRoughness", {{"baseColorTexture", info}}},
                                       {"emissiveTexture", info}});
    scene.root["textures"] = json::parse(R"([{"source": 0}])");
    scene.root["images"] = json::parse(R"([{"uri": "data:image/png;base64,AAAA"}])");
}

/// A scene of one square with the texture coordinates of its corners.
SceneFile textured_square(const json& material_texture) {
    SceneFile scene;
    json square = scene.square(0);
    square["attributes"]["TEXCOORD_0"] = scene.add_square_texcoords();
    square["material"] = 0;
    add_texture(scene, material_texture);
    scene.root["meshes"][0] = {{"name", "Square"}, {"primitives", {square}}};
    return scene;
}

/// The rectangle that a mesh covers in the map.
struct Box {
    glm::vec2 low{2.0F};
    glm::vec2 high{-1.0F};

    [[nodiscard]] float area() const { return (high.x - low.x) * (high.y - low.y); }
    [[nodiscard]] bool is_apart_from(const Box& other) const {
        return high.x < other.low.x || other.high.x < low.x || high.y < other.low.y ||
               other.high.y < low.y;
    }
};

Box box_of(const GltfDocument& document, GltfPrimitiveId id, int set = 0) {
    Box box;
    for (const glm::vec2& each : document.mesh(id, set).texcoords) {
        box.low = glm::min(box.low, each);
        box.high = glm::max(box.high, each);
    }
    return box;
}

ProgramResult unwrapped(const Workplace& workplace, const std::string& options,
                        const std::string& output = "out/a.glb") {
    return workplace.run("relief-mesh unwrap scene.gltf " + output +
                         " --size 256 --report out/r.json " + options);
}

json report_of(const Workplace& workplace) {
    return json::parse(workplace.read("out/r.json"));
}

TEST(UnwrapScene, GivesAllMeshesOneMapInTheirLargestScale) {
    const Workplace workplace;
    SceneFile scene;
    scene.root["materials"] = json::parse(R"([{"name": "A"}, {"name": "B"}])");
    json left = scene.square(0);
    json right = scene.square(1);
    left["material"] = 0;
    right["material"] = 1;
    scene.root["meshes"][0] = {{"name", "Floor"}, {"primitives", {left, right}}};
    // Its positions are those of a part of the floor.
    scene.root["meshes"][1] = {{"name", "Tile"}, {"primitives", {scene.square(0)}}};
    scene.root["scenes"] = json::parse(R"([{"nodes": [0, 1, 2]}])");
    scene.root["nodes"] = json::parse(
        R"([{"mesh": 0}, {"mesh": 1}, {"mesh": 1, "scale": [3, 3, 3], "translation": [9, 0, 0]}])");
    scene.write(workplace);
    const ProgramResult result = unwrapped(workplace, "--strict");
    ASSERT_EQ(result.exit_code, 0) << result.error << result.out;
    EXPECT_THAT(result.out, HasSubstr("read      scene.gltf: glTF, 6 triangles, 12 vertices\n"));
    EXPECT_THAT(result.out, HasSubstr("atlas     2 charts"));
    EXPECT_THAT(result.out, HasSubstr("1 mesh has several instances, which share texels\n"));
    EXPECT_THAT(result.out, HasSubstr("the density is that of the largest (the first is mesh "
                                      "'Tile' primitive 0)\n"));
    EXPECT_EQ(report_of(workplace)["notes"].size(), 2U);
    const GltfDocument document = read_document(workplace / "out/a.glb");
    const Box a = box_of(document, {0, 0});
    const Box b = box_of(document, {0, 1});
    const Box tile = box_of(document, {1, 0});
    EXPECT_TRUE(tile.is_apart_from(a) && tile.is_apart_from(b));
    EXPECT_NEAR(a.area(), b.area(), 1e-3F * a.area());
    EXPECT_NEAR(tile.area(), 9.0F * a.area(), 1e-2F * tile.area());

    ASSERT_EQ(unwrapped(workplace, "--split-materials").exit_code, 0);
    EXPECT_EQ(report_of(workplace)["atlas"]["charts"], 3);

    ASSERT_EQ(unwrapped(workplace, "--density B=4").exit_code, 0);
    EXPECT_EQ(report_of(workplace)["options"]["density"], "B=4");
    const GltfDocument weighted = read_document(workplace / "out/a.glb");
    const float area_of_a = box_of(weighted, {0, 0}).area();
    EXPECT_NEAR(box_of(weighted, {0, 1}).area(), 16.0F * area_of_a, 0.2F * area_of_a);
    expect_refusals(workplace, "relief-mesh", "old.glb",
                    {{"relief-mesh unwrap scene.gltf out/old.glb --density C=2", 1,
                      "scene.gltf: --density: there is no material 'C', only A, B"},
                     {"relief-mesh unwrap scene.gltf out/old.glb --density colors", 2,
                      "--density colors: 'colors': not equal, color or MATERIAL=FACTOR"},
                     {"relief-mesh unwrap scene.gltf out/old.glb --density color", 1,
                      "scene.gltf: --density color: there are no vertex colors"}});
}

TEST(UnwrapScene, FollowsVertexColors) {
    const Workplace workplace;
    SceneFile scene;
    json square = scene.square(0);
    square["attributes"]["COLOR_0"] = scene.add(std::vector<float>(12, 0.25F), 5126, "VEC3", 3);
    // Without colors, which means white.
    scene.root["meshes"][0]["primitives"] = {square, scene.square(5)};
    scene.write(workplace);
    ASSERT_EQ(unwrapped(workplace, "--density color").exit_code, 0);
    const GltfDocument document = read_document(workplace / "out/a.glb");
    const float area = box_of(document, {0, 0}).area();
    EXPECT_NEAR(box_of(document, {0, 1}).area(), 16.0F * area, 0.2F * area);
}

TEST(UnwrapScene, MeasuresSkinnedMeshesByTheirJoints) {
    const Workplace workplace;
    SceneFile scene;
    scene.root["meshes"][0] = {{"primitives", {scene.square(0)}}};
    json skinned = scene.square(0);
    skinned["attributes"]["JOINTS_0"] =
        scene.add(std::vector<std::uint8_t>(16, 0), 5121, "VEC4", 4);
    skinned["attributes"]["WEIGHTS_0"] = scene.add(
        std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
    scene.root["meshes"][1] = {{"primitives", {skinned}}};
    const std::vector<float> inverse = {0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1};
    scene.root["skins"][0] = {{"joints", {2}},
                              {"inverseBindMatrices", scene.add(inverse, 5126, "MAT4", 16)}};
    scene.root["scenes"] = json::parse(R"([{"nodes": [0, 1, 2]}])");
    // The scale of the node of a skinned mesh has no effect.
    scene.root["nodes"] = json::parse(
        R"([{"mesh": 0}, {"mesh": 1, "skin": 0, "scale": [50, 50, 50]}, {"scale": [4, 4, 4]}])");
    scene.write(workplace);
    ASSERT_EQ(unwrapped(workplace, "").exit_code, 0);
    const GltfDocument document = read_document(workplace / "out/a.glb");
    const float area = box_of(document, {0, 0}).area();
    EXPECT_NEAR(box_of(document, {1, 0}).area(), 4.0F * area, 0.04F * area);
}

/// A cube of eight vertices whose data tells the number of the vertex.
SceneFile numbered_cube() {
    SceneFile scene;
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<float> texcoords;
    std::vector<float> lift;
    std::vector<std::uint16_t> colors;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint8_t> weights;
    std::vector<std::uint8_t> custom;
    for (int i = 0; i < 8; ++i) {
        for (int k = 0; k < 3; ++k) {
            const float side = (i >> k & 1) != 0 ? 1.0F : -1.0F;
            positions.push_back(side);
            normals.push_back(side / std::sqrt(3.0F));
            lift.push_back(k == 0 ? static_cast<float>(i) : 0.0F);
            colors.push_back(static_cast<std::uint16_t>(1000 * i));
        }
        texcoords.insert(texcoords.end(), {static_cast<float>(i), 0.5F});
        for (int k = 0; k < 4; ++k) {
            joints.push_back(k == 0 ? static_cast<std::uint8_t>(i % 2) : 0);
            weights.push_back(k == 0 ? 255 : 0);
            custom.push_back(static_cast<std::uint8_t>(i));
        }
    }
    json cube;
    // Positions and normals are interleaved.
    std::vector<float> both;
    for (std::size_t i = 0; i < 8; ++i) {
        both.insert(both.end(), &positions[3 * i], &positions[3 * i] + 3);
        both.insert(both.end(), &normals[3 * i], &normals[3 * i] + 3);
    }
    const std::size_t position =
        scene.add(both, 5126, "VEC3", 6, {{"min", {-1, -1, -1}}, {"max", {1, 1, 1}}});
    scene.root["bufferViews"].back()["byteStride"] = 24;
    json normal = scene.root["accessors"].back();
    normal["byteOffset"] = 12;
    normal.erase("min");
    normal.erase("max");
    scene.root["accessors"].push_back(normal);
    cube["attributes"] = {
        {"POSITION", position},
        {"NORMAL", position + 1},
        {"TEXCOORD_0", scene.add(texcoords, 5126, "VEC2", 2)},
        {"TEXCOORD_1", scene.add(texcoords, 5126, "VEC2", 2)},
        {"COLOR_0", scene.add(colors, 5123, "VEC3", 3, {{"normalized", true}})},
        {"JOINTS_0", scene.add(joints, 5121, "VEC4", 4)},
        {"WEIGHTS_0", scene.add(weights, 5121, "VEC4", 4, {{"normalized", true}})},
        {"_NUMBER", scene.add(custom, 5121, "VEC4", 4)}};
    // The elements of COLOR_0 are padded to 8 bytes.
    std::vector<std::uint16_t> padded;
    for (std::size_t i = 0; i < 8; ++i)
        padded.insert(padded.end(), {colors[3 * i], colors[3 * i + 1], colors[3 * i + 2], 0});
    scene.add(padded, 5123, "VEC3", 4);
    const std::size_t colored = cube["attributes"]["COLOR_0"].get<std::size_t>();
    scene.root["accessors"][colored]["bufferView"] = scene.root["accessors"].back()["bufferView"];
    scene.root["accessors"].erase(scene.root["accessors"].size() - 1);
    scene.root["bufferViews"].back()["byteStride"] = 8;
    cube["targets"][0]["POSITION"] = scene.add_positions(lift);
    cube["extras"] = {{"tool", "unknown"}, {"list", {1, 2, 3}}};
    cube["indices"] =
        scene.add(std::vector<std::uint16_t>{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                             2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5},
                  5123, "SCALAR", 1);
    scene.root["meshes"][0] = {{"name", "Cube"}, {"primitives", {cube}}, {"weights", {0.0}}};
    scene.root["skins"][0] = {{"joints", {1, 2}}};
    scene.root["scenes"] = json::parse(R"([{"nodes": [0, 1], "extras": {"kept": true}}])");
    scene.root["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0, "name": "Body"},
                                          {"name": "J0", "children": [2]}, {"name": "J1"}])");
    const std::size_t times =
        scene.add(std::vector<float>{0, 1}, 5126, "SCALAR", 1, {{"min", {0.0}}, {"max", {1.0}}});
    const std::size_t moves = scene.add(std::vector<float>{0, 0, 0, 1, 0, 0}, 5126, "VEC3", 3);
    scene.root["animations"][0] = {
        {"samplers", {{{"input", times}, {"output", moves}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}};
    return scene;
}

TEST(UnwrapScene, KeepsAllOtherData) {
    const Workplace workplace;
    numbered_cube().write(workplace);
    const ProgramResult result = unwrapped(workplace, "", "out/a.gltf");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json before = json::parse(workplace.read("scene.gltf"));
    const json after = json::parse(workplace.read("out/a.gltf"));
    for (const char* key : {"scenes", "nodes", "scene"})
        EXPECT_EQ(before[key], after[key]) << key;
    EXPECT_EQ(after["skins"][0]["joints"], json({1, 2}));
    EXPECT_EQ(after["animations"][0]["channels"], before["animations"][0]["channels"]);
    const json& primitive = after["meshes"][0]["primitives"][0];
    EXPECT_EQ(primitive["extras"], before["meshes"][0]["primitives"][0]["extras"]);
    const auto type_of = [&](const char* name) {
        return after["accessors"][primitive["attributes"][name].get<std::size_t>()]
                    ["componentType"];
    };
    EXPECT_EQ(type_of("COLOR_0"), 5123);
    EXPECT_EQ(type_of("WEIGHTS_0"), 5121);
    EXPECT_EQ(type_of("_NUMBER"), 5121);

    const GltfDocument document = read_document(workplace / "out/a.gltf");
    const Mesh mesh = document.mesh({0, 0});
    const Mesh other = document.mesh({0, 0}, 1);
    const GltfDeformation deformation = document.deformation({0, 0});
    ASSERT_GT(mesh.positions.size(), 8U);
    ASSERT_EQ(deformation.targets.size(), 1U);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::vec3& p = mesh.positions[v];
        const int i = (p.x > 0 ? 1 : 0) + (p.y > 0 ? 2 : 0) + (p.z > 0 ? 4 : 0);
        EXPECT_EQ(mesh.normals[v], glm::sign(p) * (1.0F / std::sqrt(3.0F)));
        EXPECT_FLOAT_EQ(mesh.colors[v].x, static_cast<float>(1000 * i) / 65535.0F);
        EXPECT_EQ(other.texcoords[v], glm::vec2(static_cast<float>(i), 0.5F));
        EXPECT_EQ(deformation.joints[0].joints[v].x, static_cast<unsigned>(i % 2));
        EXPECT_EQ(deformation.joints[0].weights[v].x, 1.0F);
        EXPECT_EQ(deformation.targets[0].positions[v].x, static_cast<float>(i));
    }
    // Vertices are split only along seams.
    const json stats = report_of(workplace);
    EXPECT_EQ(stats["vertices_written"], mesh.positions.size());
    for (std::size_t a = 0; a < mesh.positions.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            EXPECT_FALSE(mesh.positions[a] == mesh.positions[b] &&
                         mesh.texcoords[a] == mesh.texcoords[b]);
}

TEST(UnwrapScene, WritesTheRequestedSet) {
    const Workplace workplace;
    SceneFile scene = textured_square({{"index", 0}});
    scene.root["meshes"][1] = {{"name", "Plain"}, {"primitives", {scene.square(5)}}};
    scene.root["nodes"] = json::parse(R"([{"mesh": 0}, {"mesh": 1}])");
    scene.root["scenes"] = json::parse(R"([{"nodes": [0, 1]}])");
    scene.write(workplace);
    const ProgramResult result = unwrapped(workplace, "--uv-set 1");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr("mesh 'Plain' primitive 0: 1 x missing texture coordinate set "
                          "below the new one (set 0): is (0, 0)"));
    EXPECT_THAT(result.out, Not(HasSubstr("replaced texture coordinates")));
    const GltfDocument document = read_document(workplace / "out/a.glb");
    EXPECT_THAT(document.texcoord_sets({0, 0}), ElementsAre(0, 1));
    EXPECT_THAT(document.texcoord_sets({1, 0}), ElementsAre(0, 1));
    EXPECT_EQ(box_of(document, {0, 0}, 0).area(), 1.0F) << "the old set stays";
    EXPECT_TRUE(box_of(document, {0, 0}, 1).is_apart_from(box_of(document, {1, 0}, 1)));
    expect_refusals(workplace, "relief-mesh", "old.glb",
                    {{"relief-mesh unwrap scene.gltf out/old.glb --uv-set 2", 1,
                      "scene.gltf: texture coordinate set 2 would leave a gap (give 0 to 1)"},
                     {"relief-mesh unwrap scene.gltf out/old.obj --uv-set 1", 2,
                      "--uv-set 1: out/old.obj has only texture coordinate set 0"},
                     {"relief-mesh unwrap data/vase.obj out/old.glb --uv-set 1", 2,
                      "--uv-set 1: data/vase.obj has only texture coordinate set 0"}});
}

TEST(UnwrapScene, ReportsOnlyObjMaterialsThatHaveMaps) {
    const Workplace workplace;
    workplace.write("a.obj",
                    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                    "usemtl plain\nf 1/1 2/2 3/3\n");
    for (const bool has_map : {false, true}) {
        workplace.write("a.mtl", std::string("newmtl plain\nKd 0.5 0.5 0.5\n") +
                                     (has_map ? "map_Kd a.png\n" : ""));
        const ProgramResult result = workplace.run("relief-mesh unwrap a.obj out/b.obj --strict");
        EXPECT_EQ(result.exit_code, has_map ? 3 : 0) << result.out << result.error;
    }
}

TEST(UnwrapScene, ReportsOrRemovesTexturesAtReplacedCoordinates) {
    const Workplace workplace;
    SceneFile scene = textured_square({{"index", 0}});
    scene.root["materials"][0]["emissiveTexture"]["texCoord"] = 1;
    scene.root["materials"][0]["emissiveFactor"] = {1, 1, 1};
    scene.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        scene.add_square_texcoords();
    scene.write(workplace);
    ProgramResult result = unwrapped(workplace, "--strict", "out/a.gltf");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.out, HasSubstr("1 x material with textures at replaced texture coordinates "
                                      "(material 0): keeps the textures, which do not fit any "
                                      "more"));
    json material = json::parse(workplace.read("out/a.gltf"))["materials"][0];
    EXPECT_TRUE(material["pbrMetallicRoughness"].contains("baseColorTexture"));
    result = unwrapped(workplace, "--remove-textures", "out/a.gltf");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    json root = json::parse(workplace.read("out/a.gltf"));
    EXPECT_FALSE(root["materials"][0]["pbrMetallicRoughness"].contains("baseColorTexture"));
    EXPECT_TRUE(root["materials"][0].contains("emissiveTexture")) << "it is at another set";
    EXPECT_EQ(root["images"].size(), 1U);
    result = unwrapped(workplace, "--remove-textures --uv-set 1", "out/b.gltf");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    root = json::parse(workplace.read("out/b.gltf"));
    EXPECT_TRUE(root["materials"][0]["pbrMetallicRoughness"].contains("baseColorTexture"));

    scene.root["materials"][0].erase("emissiveTexture");
    scene.write(workplace);
    result = unwrapped(workplace, "--remove-textures", "out/c.gltf");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_FALSE(json::parse(workplace.read("out/c.gltf")).contains("images"));
}

TEST(UnwrapScene, FindsTexturesOfVariantsAndKeepsAnimatedOnes) {
    const Workplace workplace;
    SceneFile scene = textured_square({{"index", 0}});
    scene.root["extensionsUsed"] = {"KHR_materials_variants", "KHR_animation_pointer",
                                    "KHR_texture_transform"};
    scene.root["extensions"]["KHR_materials_variants"]["variants"] =
        json::parse(R"([{"name": "Painted"}])");
    json& primitive = scene.root["meshes"][0]["primitives"][0];
    scene.root["materials"].push_back({{"name", "Plain"}});
    primitive["material"] = 1;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] =
        json::parse(R"([{"material": 0, "variants": [0]}])");
    scene.write(workplace);
    const ProgramResult result = unwrapped(workplace, "--remove-textures", "out/a.gltf");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("(material 0): loses these textures; its factors stay"));
    EXPECT_FALSE(json::parse(workplace.read("out/a.gltf")).contains("images"));

    scene.root["materials"][0]["emissiveTexture"]["extensions"]["KHR_texture_transform"] =
        json::object();
    const std::size_t times =
        scene.add(std::vector<float>{0, 1}, 5126, "SCALAR", 1, {{"min", {0.0}}, {"max", {1.0}}});
    const std::size_t offsets = scene.add(std::vector<float>{0, 0, 1, 1}, 5126, "VEC2", 2);
    json channel = json::parse(R"({"sampler": 0, "target": {"path": "pointer"}})");
    channel["target"]["extensions"]["KHR_animation_pointer"]["pointer"] =
        "/materials/0/emissiveTexture/extensions/KHR_texture_transform/offset";
    scene.root["animations"][0] = {{"samplers", {{{"input", times}, {"output", offsets}}}},
                                   {"channels", {channel}}};
    scene.write(workplace);
    std::filesystem::remove(workplace / "out/a.gltf");
    std::filesystem::remove(workplace / "out/a.bin");
    std::filesystem::remove(workplace / "out/r.json");
    expect_refusals(workplace, "relief-mesh", "old.glb",
                    {{"relief-mesh unwrap scene.gltf out/old.glb --remove-textures", 1,
                      "scene.gltf: material 0: its emissiveTexture cannot be removed, because an "
                      "animation changes it"}});
}

TEST(UnwrapScene, RemovesDisplacementsOfReplacedCoordinates) {
    const Workplace workplace;
    SceneFile scene;
    json square = scene.square(0);
    square["attributes"]["TEXCOORD_0"] = scene.add_square_texcoords();
    square["targets"][0] = {{"POSITION", scene.add_positions(std::vector<float>(12, 1.0F))},
                            {"TEXCOORD_0", scene.add_square_texcoords()}};
    // A level of detail, which no node of the scene has.
    scene.root["meshes"] = {{{"primitives", {square}}}, {{"primitives", {scene.square(0)}}}};
    scene.write(workplace);
    const ProgramResult result = unwrapped(workplace, "", "out/a.gltf");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 x displacements of replaced texture coordinates (morph "
                                      "target 0): are removed"));
    EXPECT_THAT(result.out, HasSubstr("1 x mesh outside of the scene (mesh 1): gets texels of its "
                                      "own, at the scale of its object space"));
    const json target =
        json::parse(workplace.read("out/a.gltf"))["meshes"][0]["primitives"][0]["targets"][0];
    EXPECT_TRUE(target.contains("POSITION"));
    EXPECT_FALSE(target.contains("TEXCOORD_0"));
}

TEST(UnwrapScene, RecomputesTangentsOfReplacedCoordinates) {
    const Workplace workplace;
    SceneFile scene = textured_square({{"index", 0}});
    json& attributes = scene.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] =
        scene.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 3);
    // Perpendicular to the tangents of any chart that is upright or turned.
    const float half = std::sqrt(0.5F);
    std::vector<float> tangents;
    for (int i = 0; i < 4; ++i)
        tangents.insert(tangents.end(), {half, half, 0, 1});
    attributes["TANGENT"] = scene.add(tangents, 5126, "VEC4", 4);
    scene.write(workplace);
    ProgramResult result = unwrapped(workplace, "");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("1 x tangents of replaced texture coordinates (primitive 0): "
                                      "are recomputed by MikkTSpace"));
    const auto tangent = [&] {
        return read_document(workplace / "out/a.glb").mesh({0, 0}).tangents.at(0);
    };
    EXPECT_EQ(std::abs(tangent().x) + std::abs(tangent().y), 1.0F);
    // Tangents of another set stay.
    ASSERT_EQ(unwrapped(workplace, "--uv-set 1").exit_code, 0);
    EXPECT_EQ(tangent(), glm::vec4(half, half, 0, 1));
    attributes.erase("NORMAL");
    scene.write(workplace);
    result = unwrapped(workplace, "");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("are removed, because there are no normals"));
    EXPECT_TRUE(read_document(workplace / "out/a.glb").mesh({0, 0}).tangents.empty());
}

TEST(UnwrapScene, KeepsTheSeamsOfASet) {
    const Workplace workplace;
    // Two squares that share an edge: joined in space, apart in the texture coordinates.
    SceneFile scene;
    json left = scene.square(0);
    left["attributes"]["TEXCOORD_0"] = scene.add_square_texcoords();
    json right = scene.square(1);
    right["attributes"]["TEXCOORD_0"] = left["attributes"]["TEXCOORD_0"];
    scene.root["meshes"][0] = {{"primitives", {left, right}}};
    scene.write(workplace);
    ASSERT_EQ(unwrapped(workplace, "").exit_code, 0);
    EXPECT_EQ(report_of(workplace)["atlas"]["charts"], 1);
    ASSERT_EQ(unwrapped(workplace, "--keep-seams").exit_code, 0);
    EXPECT_EQ(report_of(workplace)["atlas"]["charts"], 2);
    ASSERT_EQ(unwrapped(workplace, "--keep-seams --uv-set 1").exit_code, 0);
    EXPECT_EQ(report_of(workplace)["atlas"]["charts"], 2) << "the seams of the first set";
}

TEST(UnwrapScene, StacksEqualMeshes) {
    const Workplace workplace;
    SceneFile scene;
    for (int i = 0; i < 3; ++i)
        scene.root["meshes"].push_back({{"primitives", {scene.square(static_cast<float>(i))}}});
    scene.root["scenes"] = json::parse(R"([{"nodes": [0, 1, 2]}])");
    // The scale of the last one differs.
    scene.root["nodes"] =
        json::parse(R"([{"mesh": 0}, {"mesh": 1}, {"mesh": 2, "scale": [2, 2, 2]}])");
    scene.write(workplace);
    const ProgramResult result = unwrapped(workplace, "--stack");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("stacked   1 part shares the texels of an equal one\n"));
    const json atlas = report_of(workplace)["atlas"];
    EXPECT_EQ(atlas["charts"], 2);
    EXPECT_EQ(atlas["stacked_parts"], 1);
    const GltfDocument document = read_document(workplace / "out/a.glb");
    EXPECT_EQ(document.mesh({0, 0}).texcoords, document.mesh({1, 0}).texcoords);
    EXPECT_TRUE(box_of(document, {0, 0}).is_apart_from(box_of(document, {2, 0})));
    const ProgramResult checked = workplace.run("relief-mesh check out/a.glb --map-size 256");
    EXPECT_EQ(checked.exit_code, 0) << checked.error;
    EXPECT_THAT(checked.out, HasSubstr("texcoords 2 charts "));
    EXPECT_THAT(checked.out, HasSubstr(", 1 chart shares the texels of an equal one\n"));
}

TEST(UnwrapScene, KeepsMeshesThatTouchApartInChecks) {
    const Workplace workplace;
    SceneFile scene;
    for (int i = 0; i < 2; ++i) {
        json square = scene.square(static_cast<float>(i));
        const float left = 0.25F * static_cast<float>(i);
        square["attributes"]["TEXCOORD_0"] =
            scene.add(std::vector<float>{left, 1, left + 0.25F, 1, left + 0.25F, 0, left, 0}, 5126,
                      "VEC2", 2);
        scene.root["meshes"].push_back({{"primitives", {square}}});
    }
    scene.root["scenes"] = json::parse(R"([{"nodes": [0, 1]}])");
    scene.root["nodes"] = json::parse(R"([{"mesh": 0}, {"mesh": 1}])");
    scene.write(workplace);
    EXPECT_THAT(workplace.run("relief-mesh check scene.gltf --map-size 256").out,
                HasSubstr("texcoords 2 charts "));
    json joined = scene.root;
    joined["meshes"] = json::array(
        {{{"primitives",
           {scene.root["meshes"][0]["primitives"][0], scene.root["meshes"][1]["primitives"][0]}}}});
    joined["nodes"].erase(1);
    joined["scenes"] = json::parse(R"([{"nodes": [0]}])");
    workplace.write("joined.gltf", joined.dump());
    EXPECT_THAT(workplace.run("relief-mesh check joined.gltf --map-size 256").out,
                HasSubstr("texcoords 1 chart "));
}

TEST(UnwrapScene, ContinuesTheWorkOfOtherCommands) {
    const Workplace workplace;
    ASSERT_EQ(workplace
                  .run("relief-mesh process data/vase.obj out/a.glb --tangents mikktspace && "
                       "relief-mesh decimate out/a.glb out/b.glb --triangles 1500 && "
                       "relief-mesh unwrap out/b.glb out/c.glb --remove-textures")
                  .exit_code,
              0);
    const ProgramResult result = workplace.run("relief-mesh check out/c.glb --for-baking --json");
    EXPECT_EQ(result.exit_code, 0) << result.out;
    const json tangents = json::parse(result.out)["files"][0]["primitives"][0]["tangents"];
    EXPECT_EQ(tangents["basis"], "mikktspace");
    EXPECT_EQ(tangents["corners"], tangents["agreements"][0]["agreeing"]);
}

}  // namespace
}  // namespace relief::tools
