// SPDX-License-Identifier: Apache-2.0
// glTF documents are read, written and read again without loss; broken files end in an error that
// names them; URIs; the texture coordinate sets of tangents.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <set>

#include "io/gltf/gltf_contents.h"
#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"
#include "support/labels.h"
#include "support/sanitized.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using nlohmann::json;
using test::meaning_of;
using test::write_gltf_file;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class GltfDocumentTest : public testing::Test {
  protected:
    GltfDocument read(const std::filesystem::path& file) {
        return GltfDocument::read(file, report_);
    }
    std::string error_of(const json& root, const std::string& buffer = {}) {
        write_gltf_file(folder_ / "e.glb", root, buffer);
        return error_of_file(folder_ / "e.glb");
    }
    std::string error_of_file(const std::filesystem::path& file) {
        try {
            read(file);
        } catch (const FileError& error) {
            EXPECT_THAT(error.what(), HasSubstr(file.string() + ": "));
            return error.what();
        }
        return "no error";
    }

    test::TemporaryDirectory folder_;
    Report report_;
};

json triangle_json() {
    return json::parse(R"({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 42}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})");
}

std::string triangle_bytes() {
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::uint16_t indices[] = {0, 1, 2};
    std::string bytes(42, '\0');
    std::memcpy(bytes.data(), positions, 36);
    std::memcpy(bytes.data() + 36, indices, 6);
    return bytes;
}

TEST_F(GltfDocumentTest, PropertiesThatNobodyKnowsAreKept) {
    json root = triangle_json();
    root["asset"]["minVersion"] = "2.0";
    root["asset"]["copyright"] = "somebody";
    root["extras"] = {{"large", 12345678901234}, {"null", nullptr},       {"empty", json::object()},
                      {"none", json::array()},   {"negative zero", -0.0}, {"tenth", 0.1},
                      {"text", "\u00e9\u2764"}};
    root["unheard of"] = {1, 2, 3};
    root["nodes"][0]["extensions"]["FOO_bar"] = {{"accessor", 0}};
    root["extensionsUsed"] = {"FOO_bar", "KHR_animation_pointer"};
    root["animations"] = json::parse(R"([{"channels": [{"sampler": 0, "target": {"path": "pointer",
        "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/0/scale"}}}}],
        "samplers": [{"input": 0, "output": 0, "extras": 1}]}])");
    write_gltf_file(folder_ / "a.glb", root, triangle_bytes());
    for (const char* name : {"b.glb", "b.gltf"}) {
        read(folder_ / "a.glb").write(folder_ / name);
        EXPECT_EQ(meaning_of(folder_ / name), meaning_of(folder_ / "a.glb"));
    }
    // The JSON also stays the same, except for the URI of the buffer.
    std::ifstream stream(folder_ / "b.gltf");
    json written = json::parse(stream);
    EXPECT_EQ(written["buffers"][0]["uri"], "b.bin");
    written["buffers"][0].erase("uri");
    EXPECT_EQ(written, root);
    EXPECT_TRUE(report_.empty());
}

TEST_F(GltfDocumentTest, ChunksThatNobodyKnowsAreKept) {
    write_gltf_file(folder_ / "a.glb", triangle_json(), triangle_bytes());
    std::fstream stream(folder_ / "a.glb", std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(0, std::ios::end);
    stream.write("\x04\0\0\0XYZWdata", 12);
    const auto length = static_cast<std::uint32_t>(stream.tellp());
    stream.seekp(8);
    stream.write(reinterpret_cast<const char*>(&length), 4);
    stream.close();
    read(folder_ / "a.glb").write(folder_ / "b.glb");
    std::ifstream written(folder_ / "b.glb", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(written)), {});
    EXPECT_TRUE(bytes.ends_with(std::string_view("\x04\0\0\0XYZWdata", 12)));
}

// Except models with faults that glTF forbids, which are repaired with findings.
TEST_F(GltfDocumentTest, EveryReadableModelMeansTheSameAfterACopy) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    // A later version and an invented extension.
    const std::set<std::string> refused = {"Compatibility_04.gltf", "Compatibility_05.gltf"};
    int copied = 0;
    int repaired = 0;
    for (const auto& file : test::gltf_files_below(models)) {
        if (refused.contains(file.filename().string())) {
            EXPECT_THAT(error_of_file(file),
                        testing::AnyOf(HasSubstr("requires "), HasSubstr("minVersion is 2.1")));
            continue;
        }
        const json before = meaning_of(file);
        const auto target = folder_ / std::to_string(copied++);
        std::filesystem::create_directory(target);
        for (const char* name : {"copy.glb", "copy.gltf"}) {
            Report repairs;
            read(file).write(target / name, repairs);
            if (repairs.empty())
                EXPECT_TRUE(meaning_of(target / name) == before) << file << " as " << name;
            else
                ++repaired;
        }
    }
    EXPECT_EQ(copied, 102);
    EXPECT_LT(repaired, 40);
}

TEST_LABELS(not_sanitized);
TEST_F(GltfDocumentTest, AnIndependentReaderFindsTheSamePositions) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    int compared = 0;
    for (const auto& file : test::gltf_files_below(models)) {
        const GltfDocument document = read(file);
        document.write(folder_ / "a.glb");
        tinygltf::TinyGLTF loader;
        loader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int,
                                 const unsigned char*, int, void*) { return true; },
                              nullptr);
        tinygltf::Model model;
        std::string error;
        std::string warning;
        ASSERT_TRUE(loader.LoadBinaryFromFile(&model, &error, &warning, folder_ / "a.glb"))
            << file << error;
        for (const GltfPrimitiveId id : document.triangle_primitives()) {
            const auto& primitive = model.meshes[id.mesh].primitives[id.primitive];
            const auto& accessor =
                model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))];
            const Mesh mesh = document.mesh(id);
            if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT ||
                accessor.sparse.isSparse || accessor.count != mesh.positions.size()) {
                continue;
            }
            const auto& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
            const unsigned char* data =
                model.buffers[static_cast<std::size_t>(view.buffer)].data.data() + view.byteOffset +
                accessor.byteOffset;
            const auto stride = static_cast<std::size_t>(accessor.ByteStride(view));
            for (std::size_t i = 0; i < accessor.count; ++i) {
                ASSERT_EQ(std::memcmp(data + i * stride, &mesh.positions[i], 12), 0)
                    << file << document.describe(id) << i;
            }
            ++compared;
        }
    }
    EXPECT_GT(compared, 300);
}

bool is_valid(const Mesh& mesh) {
    try {
        validate(mesh);
        return true;
    } catch (const InvalidInput&) {
        return false;
    }
}

TEST_F(GltfDocumentTest, EveryBrokenFileIsRefusedOrCanBeWorkedWith) {
    RELIEF_NEEDS_SHARED(broken, "data/broken/gltf");
    int refused = 0;
    int kept = 0;
    for (const auto& file : test::gltf_files_below(broken)) {
        try {
            const GltfDocument document = read(file);
            for (const GltfPrimitiveId id : document.triangle_primitives()) {
                try {
                    const Mesh mesh = document.mesh(id);
                    EXPECT_TRUE(is_valid(mesh)) << file;
                } catch (const InvalidInput& error) {
                    EXPECT_THAT(error.what(), HasSubstr("primitive")) << file;
                }
            }
            EXPECT_NO_THROW(static_cast<void>(document.view())) << file;
            document.write(folder_ / "a.glb");
            EXPECT_NO_THROW(read(folder_ / "a.glb")) << file;
            ++kept;
        } catch (const FileError& error) {
            EXPECT_THAT(error.what(), testing::AnyOf(HasSubstr(file.string() + ": "),
                                                     HasSubstr("a.glb: cannot be written: ")));
            ++refused;
        }
    }
    EXPECT_EQ(refused, 44);
    EXPECT_EQ(kept, 20);
}

TEST_F(GltfDocumentTest, EveryTruncationOfAFileIsRefused) {
    write_gltf_file(folder_ / "a.glb", triangle_json(), triangle_bytes());
    for (auto length = std::filesystem::file_size(folder_ / "a.glb"); length-- > 0;) {
        std::filesystem::resize_file(folder_ / "a.glb", length);
        EXPECT_NE(error_of_file(folder_ / "a.glb"), "no error") << length;
    }
}

TEST_F(GltfDocumentTest, FilesWithWrongBytesAreRefusedOrCanBeWorkedWith) {
    // Sparse accessors, a strip and an image make more of the format reachable.
    json root = triangle_json();
    root["accessors"][0]["sparse"] = {{"count", 2},
                                      {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                      {"values", {{"bufferView", 0}}}};
    root["meshes"][0]["primitives"][0]["mode"] = 5;
    root["images"] = {{{"bufferView", 1}, {"mimeType", "image/png"}}};
    root["nodes"][0]["children"] = {1};
    root["nodes"].push_back(
        {{"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", 0}}}}}}}});
    root["nodes"][1]["mesh"] = 0;
    write_gltf_file(folder_ / "a.glb", root, triangle_bytes());
    std::ifstream stream(folder_ / "a.glb", std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(stream)), {});
    std::mt19937 random(3);
    constexpr int file_count = test::is_sanitized ? 700 : 2000;
    int kept = 0;
    for (int i = 0; i < file_count; ++i) {
        std::string bytes = whole;
        for (unsigned k = 0; k <= random() % 3; ++k) {
            char& byte = bytes[random() % bytes.size()];
            // Digits replace digits, so that most files stay valid JSON.
            if (byte >= '0' && byte <= '9') {
                byte = static_cast<char>('0' + random() % 10);
            } else if (random() % 3 == 0) {
                byte = static_cast<char>(random());
            }
        }
        // ext4 waits for the disk when a file is truncated or replaced.
        std::filesystem::remove(folder_ / "b.glb");
        std::filesystem::remove(folder_ / "c.glb");
        std::ofstream(folder_ / "b.glb", std::ios::binary) << bytes;
        try {
            GltfDocument document = read(folder_ / "b.glb");
            for (const GltfPrimitiveId id : document.triangle_primitives()) {
                FramedMesh framed;
                framed.mesh = document.mesh(id);
                ASSERT_TRUE(is_valid(framed.mesh));
                framed.mesh.normals.assign(framed.mesh.positions.size(), glm::vec3(0, 0, 1));
                for (std::uint32_t v = 0; v < framed.mesh.positions.size(); ++v) {
                    framed.source_vertex.push_back(v);
                }
                document.set_frames(id, framed);
            }
            static_cast<void>(flattened(document));
            document.write(folder_ / "c.glb");
            read(folder_ / "c.glb");
            ++kept;
        } catch (const FileError&) {
        } catch (const InvalidInput&) {
        }
    }
    EXPECT_GT(kept, file_count / 8);
}

TEST_F(GltfDocumentTest, FactorsOfMaterialsHaveTheirTypeAndTexturesExist) {
    const auto error_with = [&](const char* path, const json& value) {
        json root = triangle_json();
        root["materials"] = json::array({json::object()});
        root[json::json_pointer(fmt::format("/materials/0/{}", path))] = value;
        return error_of(root, triangle_bytes());
    };
    const auto check_factor = [&](const auto& field) {
        if (*field.gltf == '\0') return;
        EXPECT_THAT(error_with(field.gltf, "text"), HasSubstr("materials[0].")) << field.gltf;
    };
    for_each_field<Material>(check_factor);
    for_each_field<MetallicRoughness>(check_factor);
    for (const UndrawnFactor& factor : undrawn_factors)
        EXPECT_THAT(error_with(factor.gltf, "text"), HasSubstr("is not a number")) << factor.gltf;
    for (const char* color : {"pbrMetallicRoughness/baseColorFactor",
                              "extensions/KHR_materials_volume/attenuationColor"})
        EXPECT_THAT(error_with(color, {1, 1}), HasSubstr("is not an array of numbers")) << color;
    for (const TextureSlotInfo& slot : texture_slots) {
        if (*slot.gltf == '\0') continue;
        EXPECT_THAT(error_with(slot.gltf, {{"index", 7}}),
                    HasSubstr("index is 7, but there are only 0 textures"))
            << slot.gltf;
    }
}

/// A position in the JSON, a wrong value, and its error message.
struct DocumentFault {
    const char* pointer;
    json value;
    const char* message;
};

TEST_F(GltfDocumentTest, ErrorsHavePointerValueAndLimit) {
    const std::vector<DocumentFault> faults = {
        {"/asset/version", "1.0", "asset.version is 1.0, but only 2 is read"},
        {"/asset/minVersion", "2.1", "asset.minVersion is 2.1"},
        {"/asset/version", 2, "asset.version is not a string"},
        {"/scene", 1, "scene is 1, but there are only 1 scenes"},
        {"/nodes/0/mesh", 7, "nodes[0].mesh is 7, but there are only 1 meshes"},
        {"/nodes/0/mesh", -1, "nodes[0].mesh is not an index"},
        {"/nodes/0/mesh", 0.5, "nodes[0].mesh is not an index"},
        {"/nodes/0/children", {0}, "nodes[0] is its own ancestor"},
        {"/nodes/0/matrix", {1, 2}, "nodes[0].matrix is not an array of numbers"},
        {"/nodes/0/extensions", 1, "nodes[0].extensions is not an object"},
        {"/meshes/0/primitives/0/attributes/POSITION", 2,
         "meshes[0].primitives[0].attributes.POSITION is 2, but there are only 2 accessors"},
        {"/meshes/0/primitives/0/mode", 7, "meshes[0].primitives[0].mode is 7"},
        {"/accessors/0/count", 4,
         "accessors[0] covers bytes 0 to 48, but bufferViews[0] has only 36"},
        {"/accessors/0/count", 4611686018427387904, "accessors[0].count is not a whole number"},
        {"/accessors/0/count", 4503599627370496, "accessors[0] covers bytes 0 to"},
        {"/accessors/0/byteOffset", 1, "accessors[0] covers bytes 1 to 37"},
        {"/accessors/0/componentType", 5130, "accessors[0].componentType is 5130"},
        {"/accessors/0/type", "VEC5", "accessors[0].type is 'VEC5'"},
        {"/accessors/0/sparse",
         {{"count", 4},
          {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
          {"values", {{"bufferView", 0}}}},
         "accessors[0].sparse.count is 4, but there are only 3"},
        {"/accessors/0/sparse",
         {{"count", 3},
          {"indices", {{"bufferView", 1}, {"componentType", 5125}}},
          {"values", {{"bufferView", 0}}}},
         "accessors[0].sparse.indices covers bytes 0 to 12, but bufferViews[1] has only 6"},
        {"/bufferViews/1/byteLength", 7, "bufferViews[1] covers bytes 36 to 43"},
        {"/bufferViews/0/byteStride", 2, "bufferViews[0].byteStride is 2"},
        {"/bufferViews/0/byteStride", 4,
         "accessors[0] has elements of 12 bytes, but bufferViews[0].byteStride is 4"},
        {"/accessors/0/componentType", 5125,
         "meshes[0].primitives[0].attributes.POSITION has integers of 32 bits"},
        {"/bufferViews/0/byteStride", 16, "accessors[0] covers bytes 0 to 44"},
        {"/buffers/0/byteLength", 100, "buffers[0] claims 100 bytes, but has only 44"},
        {"/buffers/0/uri", "../a.bin", "buffers[0].uri '../a.bin' lies outside"},
        {"/buffers/0/uri", "/etc/passwd", "lies outside"},
        {"/buffers/0/uri", "file:///etc/passwd", "lies outside"},
        {"/buffers/0/uri", "%2e%2e/a.bin", "lies outside"},
        {"/buffers/0/uri", "none.bin", "none.bin: no such file"},
        {"/buffers/0/uri", "data:application/octet-stream;base64,AAA*", "is not base64"},
        {"/buffers/0/uri", "data:application/octet-stream;base64,AAAA",
         "buffers[0] claims 42 bytes, but has only 3"},
        {"/extensionsRequired", {"FOO_bar"}, "requires the extension FOO_bar"},
        {"/images", {{{"uri", "data:image/png;base64,A"}}}, "images[0].uri: base64 data ends"},
    };
    for (const DocumentFault& fault : faults) {
        json root = triangle_json();
        root[json::json_pointer(fault.pointer)] = fault.value;
        EXPECT_THAT(error_of(root, triangle_bytes()), HasSubstr(fault.message))
            << fault.pointer << " = " << fault.value;
    }
    EXPECT_EQ(error_of(triangle_json(), triangle_bytes()), "no error");
}

/// A skinned triangle with colors, joints and weights behind its positions and indices.
struct SkinnedTriangle {
    json root = triangle_json();
    std::vector<float> colors = std::vector<float>(12, 0.5F);
    std::vector<std::uint8_t> joints = std::vector<std::uint8_t>(12, 1);
    std::vector<float> weights = std::vector<float>(12, 0.25F);

    SkinnedTriangle() {
        root["buffers"][0]["byteLength"] = 152;
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 44}, {"byteLength", 48}});
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 92}, {"byteLength", 48}});
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 140}, {"byteLength", 12}});
        for (int i = 2; i < 5; ++i) {
            root["accessors"].push_back({{"bufferView", i},
                                         {"componentType", i == 4 ? 5121 : 5126},
                                         {"count", 3},
                                         {"type", "VEC4"}});
        }
        json& attributes = root["meshes"][0]["primitives"][0]["attributes"];
        attributes["COLOR_0"] = 2;
        attributes["WEIGHTS_0"] = 3;
        attributes["JOINTS_0"] = 4;
        root["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0}, {}])");
        root["skins"] = json::parse(R"([{"joints": [0, 1]}])");
    }

    [[nodiscard]] std::string bytes() const {
        std::string all = triangle_bytes() + std::string(110, '\0');
        std::memcpy(&all[44], colors.data(), 48);
        std::memcpy(&all[92], weights.data(), 48);
        std::memcpy(&all[140], joints.data(), 12);
        return all;
    }
};

TEST_F(GltfDocumentTest, ReturnsSkinsAndMorphTargets) {
    SkinnedTriangle triangle;
    triangle.joints[5] = 0;
    triangle.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}, json::object()};
    triangle.root["meshes"][0]["weights"] = {0.5, 0.25};
    triangle.root["nodes"][0]["weights"] = {0.75};
    write_gltf_file(folder_ / "a.glb", triangle.root, triangle.bytes());
    const GltfDocument document = read(folder_ / "a.glb");
    const GltfDeformation how = document.deformation({});
    ASSERT_EQ(how.joints.size(), 1U);
    EXPECT_EQ(how.joints[0].joints[1], glm::uvec4(1, 0, 1, 1));
    EXPECT_EQ(how.joints[0].weights[2], glm::vec4(0.25F));
    ASSERT_EQ(how.targets.size(), 2U);
    EXPECT_EQ(how.targets[0].positions, document.mesh({}).positions);
    EXPECT_TRUE(how.targets[1].positions.empty());
    const GltfView view = document.view();
    EXPECT_EQ(view.nodes[0].morph_weights, (std::vector<float>{0.75F, 0.0F}));
    EXPECT_EQ(view.nodes[0].skin, 0U);
    EXPECT_FALSE(view.nodes[1].skin);
    EXPECT_EQ(view.skins[0].joints, (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(view.skins[0].joint_from_mesh[1], glm::mat4(1.0F)) << "the file has none";
}

TEST_F(GltfDocumentTest, ValuesWithoutMeaningAreReported) {
    const auto findings = [&](const SkinnedTriangle& triangle) {
        write_gltf_file(folder_ / "a.glb", triangle.root, triangle.bytes());
        report_ = Report();
        read(folder_ / "a.glb");
        std::string text;
        for (const Finding& finding : report_.findings())
            text += to_string(finding) + "\n";
        return text;
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(findings({}), "");
    SkinnedTriangle triangle;
    triangle.colors[5] = nan;
    EXPECT_EQ(findings(triangle), "1 x non-finite color (accessor 2): is read as it is\n");
    triangle.root["accessors"].push_back(
        {{"bufferView", 2}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
    json& attributes = triangle.root["meshes"][0]["primitives"][0]["attributes"];
    attributes.erase("COLOR_0");
    attributes["TEXCOORD_0"] = 5;
    EXPECT_EQ(findings(triangle),
              "1 x non-finite texture coordinate (accessor 5): is read as it is\n");
    for (const float weight : {nan, -1.0F, 5.0F, std::numeric_limits<float>::infinity()}) {
        triangle = {};
        triangle.weights[11] = weight;
        EXPECT_EQ(findings(triangle),
                  "1 x weight that is not between 0 and 1 (accessor 3): is read as it is\n")
            << weight;
    }
    triangle = {};
    triangle.joints[7] = 2;
    EXPECT_EQ(findings(triangle),
              "1 x joint that its skin does not have (node 0): is read as it is\n");
    for (const json& rotation : {json({0, 0, 0, 0}), json({5, 0, 0, 1})}) {
        triangle = {};
        triangle.root["nodes"][1]["rotation"] = rotation;
        EXPECT_EQ(findings(triangle),
                  "1 x rotation that is not of unit length (node 1): is read as it is\n");
    }
    triangle = {};
    triangle.root["accessors"][0]["componentType"] = 5122;
    EXPECT_EQ(findings(triangle),
              "1 x integer vectors without KHR_mesh_quantization (accessor 0): are read as they "
              "are\n");
    triangle.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    EXPECT_EQ(findings(triangle), "");
}

TEST_F(GltfDocumentTest, WrongBoundsOfPositionsAreReplaced) {
    json root = triangle_json();
    root["accessors"][0]["min"] = {-9, -9, -9};
    root["accessors"][0]["max"] = {-8, -8, -8};
    write_gltf_file(folder_ / "a.glb", root, triangle_bytes());
    read(folder_ / "a.glb").write(folder_ / "b.glb");
    EXPECT_EQ(report_.count("wrong bounds of positions"), 1U);
    report_ = Report();
    read(folder_ / "b.glb").write(folder_ / "c.gltf");
    EXPECT_TRUE(report_.empty());
    std::ifstream stream(folder_ / "c.gltf");
    const json written = json::parse(stream);
    EXPECT_EQ(written["accessors"][0]["min"], json({0.0, 0.0, 0.0}));
    EXPECT_EQ(written["accessors"][0]["max"], json({1.0, 1.0, 0.0}));
    // Six digits are no error.
    root["accessors"][0]["max"] = {1.000001, 0.999999, 0};
    root["accessors"][0]["min"] = {0, 0, 0};
    write_gltf_file(folder_ / "a.glb", root, triangle_bytes());
    read(folder_ / "a.glb");
    EXPECT_TRUE(report_.empty());
}

TEST_F(GltfDocumentTest, DeepJsonAndSharedOrCyclicNodesAreRefused) {
    const std::string deep =
        "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(100'000, '[') +
        std::string(100'000, ']') + "}";
    std::ofstream(folder_ / "d.gltf") << deep;
    EXPECT_THAT(error_of_file(folder_ / "d.gltf"), HasSubstr("nested deeper than 256"));
    json root = triangle_json();
    root["nodes"] = json::parse(R"([{"children": [1, 1]}, {}])");
    EXPECT_THAT(error_of(root, triangle_bytes()), HasSubstr("nodes[1] has more than one parent"));
    root["nodes"] = json::parse(R"([{}, {"children": [2]}, {"children": [1]}])");
    EXPECT_THAT(error_of(root, triangle_bytes()), HasSubstr("nodes[1] is its own ancestor"));
}

TEST_F(GltfDocumentTest, AccessorsWithoutDataAreZeros) {
    json root = triangle_json();
    root["accessors"][0].erase("bufferView");
    write_gltf_file(folder_ / "a.glb", root, triangle_bytes());
    EXPECT_EQ(read(folder_ / "a.glb").mesh({0, 0}).positions[1], glm::vec3(0.0F));
}

TEST_F(GltfDocumentTest, RefusesContradictoryMeshes) {
    const auto error = [&](const char* pointer, const json& value, std::string bytes) {
        json root = triangle_json();
        root[json::json_pointer(pointer)] = value;
        write_gltf_file(folder_ / "a.glb", root, bytes);
        const GltfDocument document = read(folder_ / "a.glb");
        try {
            static_cast<void>(document.mesh({0, 0}));
        } catch (const InvalidInput& input) {
            return std::string(input.what());
        }
        return std::string("no error");
    };
    std::string bytes = triangle_bytes();
    bytes[38] = 3;
    EXPECT_EQ(error("/meshes/0/name", "Body", bytes),
              "mesh 'Body' primitive 0: index 1 names vertex 3, but there are only 3");
    EXPECT_THAT(error("/accessors/1/count", 2, triangle_bytes()),
                HasSubstr("2 indices are not a multiple of 3"));
    EXPECT_THAT(error("/meshes/0/primitives/0/attributes/NORMAL", 1, triangle_bytes()),
                HasSubstr("accessors[1] is of type SCALAR, but VEC3 is needed"));
    EXPECT_THAT(error("/meshes/0/primitives/0/indices", 0, triangle_bytes()),
                HasSubstr("accessors[0] is used for indices"));
    const GltfDocument cube = GltfDocument::from_mesh({test::cube(), {}});
    EXPECT_THROW(static_cast<void>(cube.mesh({0, 1})), InvalidInput);
    EXPECT_THROW(static_cast<void>(cube.mesh({5, 0})), InvalidInput);
}

TEST_F(GltfDocumentTest, StripsAndFansAreUnrolledWithTheirWinding) {
    const std::uint16_t indices[] = {0, 1, 2, 3, 4};
    const float positions[15] = {};
    std::string bytes(70, '\0');
    std::memcpy(bytes.data(), positions, 60);
    std::memcpy(bytes.data() + 60, indices, 10);
    json root = triangle_json();
    root["buffers"][0]["byteLength"] = 70;
    root["bufferViews"][0]["byteLength"] = 60;
    root["bufferViews"][1] = {{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 10}};
    root["accessors"][0]["count"] = 5;
    root["accessors"][1]["count"] = 5;
    json& primitive = root["meshes"][0]["primitives"][0];
    primitive["mode"] = 5;
    write_gltf_file(folder_ / "a.glb", root, bytes);
    EXPECT_THAT(read(folder_ / "a.glb").mesh({0, 0}).triangles,
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(1, 3, 2), glm::uvec3(2, 3, 4)));
    primitive["mode"] = 6;
    primitive.erase("indices");
    write_gltf_file(folder_ / "a.glb", root, bytes);
    EXPECT_THAT(read(folder_ / "a.glb").mesh({0, 0}).triangles,
                ElementsAre(glm::uvec3(1, 2, 0), glm::uvec3(2, 3, 0), glm::uvec3(3, 4, 0)));
}

TEST_F(GltfDocumentTest, SparseElementsReplaceTheirBase) {
    RELIEF_NEEDS_SHARED(file,
                        "data/models/gltf/SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf");
    const Mesh mesh = read(file).mesh({0, 0});
    // The sample's author moves vertices 8, 10 and 12.
    EXPECT_EQ(mesh.positions[8], glm::vec3(1, 2, 0));
    EXPECT_EQ(mesh.positions[9], glm::vec3(2, 1, 0));
    EXPECT_EQ(mesh.positions[10], glm::vec3(3, 3, 0));
    EXPECT_EQ(mesh.positions[12], glm::vec3(5, 4, 0));
}

TEST_F(GltfDocumentTest, QuantizedModelsMatchFloatModels) {
    RELIEF_NEEDS_SHARED(folder, "data/models/gltf/Duck");
    const MeshFile exact = flattened(read(folder / "glTF-Binary/Duck.glb"));
    const MeshFile quantized = flattened(read(folder / "glTF-Quantized/Duck.gltf"));
    const Bounds a = bounds_of(exact.mesh);
    const Bounds b = bounds_of(quantized.mesh);
    EXPECT_EQ(exact.mesh.triangles.size(), 4212U);
    EXPECT_EQ(quantized.mesh.triangles.size(), 4212U);
    // 14 bits over a length of 1.7.
    EXPECT_LT(glm::length(a.min - b.min), 1e-3F);
    EXPECT_LT(glm::length(a.max - b.max), 1e-3F);
}

TEST_F(GltfDocumentTest, MissingImagesAreNamedWithTheirMaterialsAndTextures) {
    json root = triangle_json();
    root["images"] = {{{"uri", "gone.png"}}, {{"uri", "lost.png"}}};
    root["textures"] = {{{"source", 0}},
                        {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}},
                        {{"source", 1}}};
    root["materials"] = {
        {{"name", "wall"},
         {"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}}},
        {{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatTexture", {{"index", 0}}}}}}}}};
    write_gltf_file(folder_ / "a.glb", root, triangle_bytes());
    (void)read(folder_ / "a.glb");
    EXPECT_EQ(report_.count("missing image 'gone.png', baseColorTexture, "
                            "metallicRoughnessTexture of material 'wall', clearcoatTexture of "
                            "material 1"),
              1U);
    EXPECT_EQ(report_.count("missing image 'lost.png'"), 1U);
}

TEST_F(GltfDocumentTest, ImagesInFilesAreCopiedAlongOrPutInside) {
    json root = triangle_json();
    root["images"] = {
        {{"uri", "sub/my%20image.png"}}, {{"uri", "gone.png"}}, {{"uri", "../out.png"}}};
    std::filesystem::create_directories(folder_ / "in/sub");
    std::filesystem::create_directories(folder_ / "out");
    const std::string png = "\x89PNG\r\n\x1A\nnot much";
    std::ofstream(folder_ / "in/sub/my image.png", std::ios::binary) << png;
    write_gltf_file(folder_ / "in/a.glb", root, triangle_bytes());
    const GltfDocument document = read(folder_ / "in/a.glb");
    EXPECT_EQ(report_.count("missing image 'gone.png'"), 1U);
    EXPECT_EQ(report_.count("image outside the document's folder"), 1U);
    // In the original folder, all names stay valid. From another one, "../out.png" would not.
    document.write(folder_ / "in/b.gltf");
    EXPECT_EQ(meaning_of(folder_ / "in/b.gltf"), meaning_of(folder_ / "in/a.glb"));
    EXPECT_THROW(document.write(folder_ / "out/b.gltf"), FileError);

    root["images"].erase(2);
    write_gltf_file(folder_ / "in/a.glb", root, triangle_bytes());
    const GltfDocument moved = read(folder_ / "in/a.glb");
    moved.write(folder_ / "out/b.gltf");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/sub/my image.png"));
    EXPECT_EQ(meaning_of(folder_ / "out/b.gltf"), meaning_of(folder_ / "in/a.glb"));
    moved.write(folder_ / "out/b.gltf");  // A second write succeeds.
    std::ofstream(folder_ / "out/sub/my image.png", std::ios::binary) << "another";
    EXPECT_THROW(moved.write(folder_ / "out/b.gltf"), FileError);
    moved.write(folder_ / "out/c.glb");
    const GltfView view = read(folder_ / "out/c.glb").view();
    EXPECT_EQ(std::get<std::vector<std::byte>>(view.images[0].source).size(), png.size());
}

TEST_F(GltfDocumentTest, ListsContentThatOtherFormatsCannotStore) {
    RELIEF_NEEDS_SHARED(gltf, "data/models/gltf");
    EXPECT_THAT(read(gltf / "Fox/glTF-Binary/Fox.glb").unsupported_contents(),
                ElementsAre("3 animations", "1 skin", "2 further vertex attributes"));
    EXPECT_THAT(read(gltf / "SimpleMorph/glTF-Embedded/SimpleMorph.gltf").unsupported_contents(),
                ElementsAre("1 animation", "2 morph targets"));
    EXPECT_THAT(read(gltf / "Cameras/glTF-Embedded/Cameras.gltf").unsupported_contents(),
                ElementsAre("2 cameras"));
}

TEST_F(GltfDocumentTest, ListsCompressionByExtension) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    const auto said = [&](const std::filesystem::path& file) {
        std::vector<std::string> lines;
        for (const GltfCompression& entry : read(file).compression()) {
            lines.push_back(fmt::format("{} {} {} {}", entry.extension, entry.element,
                                        entry.decoded, entry.copies));
        }
        return lines;
    };
    EXPECT_THAT(said(models / "gltf-ext/meshopt/pirate.glb"),
                ElementsAre("EXT_meshopt_compression buffer view 3 0"));
    EXPECT_THAT(said(models / "gltf/MorphPrimitivesTest/glTF-Draco/MorphPrimitivesTest.gltf"),
                ElementsAre("KHR_draco_mesh_compression primitive 2 0"));
    EXPECT_THAT(said(models / "gltf/Duck/glTF-Binary/Duck.glb"), testing::IsEmpty());
}

TEST_F(GltfDocumentTest, OtherExtensionsAndMissingFilesAreErrors) {
    const GltfDocument document = GltfDocument::from_mesh({test::cube(), {}});
    EXPECT_THROW(document.write(folder_ / "a.obj"), FileError);
    EXPECT_THROW(document.write(folder_ / "none/a.glb"), FileError);
    EXPECT_THAT(error_of_file(folder_ / "none.glb"), HasSubstr("no such file"));
}

TEST(GltfUri, OnlyRelativeNamesThatStayBelowAreInside) {
    const std::filesystem::path folder = "/models";
    EXPECT_EQ(path_inside(folder, "a.bin"), "/models/a.bin");
    EXPECT_EQ(path_inside(folder, "./sub/../a%20b%C3%A9.bin"), "/models/a b\xC3\xA9.bin");
    EXPECT_EQ(path_inside(folder, "..a/b"), "/models/..a/b");
    for (const char* uri : {"../a", "sub/../../a", "/a", "%2Fetc/passwd", "..", "%2e%2e/a", "",
                            "file:a", "https://example.org/a.bin", "C:\\a.bin", "a%00b"}) {
        EXPECT_EQ(path_inside(folder, uri), std::nullopt) << uri;
    }
}

TEST(GltfUri, NamesWithUnencodedPercentSignsAreFound) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "100%25.bin") << "x";
    EXPECT_EQ(path_inside(folder.path(), "100%25.bin"), folder / "100%25.bin");
    std::ofstream(folder / "100%.bin") << "x";
    EXPECT_EQ(path_inside(folder.path(), "100%.bin"), folder / "100%.bin");
    EXPECT_EQ(path_inside(folder.path(), "100%25.bin"), folder / "100%.bin");
}

TEST(GltfUri, FileNamesComeBackFromTheirUris) {
    const std::string name = "a b%\xE2\x9D\xA4#?.bin";
    EXPECT_EQ(uri_of(name), "a%20b%25%E2%9D%A4%23%3F.bin");
    EXPECT_EQ(path_inside("/m", uri_of(name)), std::filesystem::path("/m") / name);
}

TEST(GltfUri, DataUrisAreDecoded) {
    // The test vectors of RFC 4648.
    const std::pair<const char*, const char*> vectors[] = {
        {"", ""},    {"Zg==", "f"},        {"Zm8=", "fo"},        {"Zm9v", "foo"},
        {"Zg", "f"}, {"Zm9vYg==", "foob"}, {"Zm9vYmE=", "fooba"}, {"Zm9vYmFy", "foobar"},
    };
    for (const auto& [text, bytes] : vectors) {
        const DataUri data = decode_data_uri(std::string("data:image/png;base64,") + text);
        EXPECT_EQ(data.bytes, bytes);
        EXPECT_EQ(data.media_type, "image/png");
    }
    EXPECT_EQ(decode_data_uri("data:,a%20b").bytes, "a b");
    EXPECT_THROW(decode_data_uri("data:;base64,Zm9vY"), InvalidInput);
    EXPECT_THROW(decode_data_uri("data:;base64,Zm 9"), InvalidInput);
    EXPECT_THROW(decode_data_uri("data:nothing"), InvalidInput);
}

/// A document with a primitive of one triangle with these sets and this material.
class GltfTangentTexcoordsTest : public testing::Test {
  protected:
    GltfTangentTexcoords of(const std::vector<std::string>& attributes, const json& material) {
        return document(attributes, material).tangent_texcoords({0, 0});
    }
    std::vector<int> sets(const std::vector<std::string>& attributes) {
        return document(attributes, {}).texcoord_sets({0, 0});
    }
    GltfDocument document(const std::vector<std::string>& attributes, const json& material) {
        json root = json::parse(R"({"asset": {"version": "2.0"}, "images": [{"uri": "a.png"}],
            "textures": [{"source": 0}],
            "buffers": [{"uri": "data:application/octet-stream;base64,AAAA", "byteLength": 36}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteLength": 24}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})");
        root["buffers"][0]["uri"] = "data:application/octet-stream;base64," + std::string(48, 'A');
        json& primitive = root["meshes"][0]["primitives"][0];
        for (const std::string& name : attributes)
            primitive["attributes"][name] = 1;
        if (!material.is_null()) {
            root["materials"] = json::array({material});
            primitive["material"] = 0;
        }
        test::write_gltf_file(folder_ / "a.gltf", root);
        return GltfDocument::read(folder_ / "a.gltf", report_);
    }
    static json transformed(const json& transform) {
        return {{"normalTexture",
                 {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}};
    }

    test::TemporaryDirectory folder_;
    Report report_;
    const std::vector<std::string> two_ = {"TEXCOORD_0", "TEXCOORD_1"};
};

TEST_F(GltfTangentTexcoordsTest, SetsAreNumberedByTheirNames) {
    EXPECT_THAT(sets({}), IsEmpty());
    EXPECT_THAT(sets({"TEXCOORD_10", "TEXCOORD_2", "TEXCOORD_0", "TEXCOORD_", "TEXCOORD_1x",
                      "TEXCOORD_-1", "_TEXCOORD_7"}),
                ElementsAre(0, 2, 10));
}

TEST_F(GltfTangentTexcoordsTest, WithoutANormalTextureItIsTheFirstSet) {
    EXPECT_EQ(of({}, {}), (GltfTangentTexcoords{0, "", {}, false}));
    EXPECT_EQ(of({"TEXCOORD_1", "TEXCOORD_3"}, {}), (GltfTangentTexcoords{1, "", {}, false}));
    const json base = {
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}};
    EXPECT_EQ(of(two_, base), (GltfTangentTexcoords{0, "", {}, false}));
}

TEST_F(GltfTangentTexcoordsTest, NormalTextureSelectsTheSet) {
    EXPECT_EQ(of(two_, {{"normalTexture", {{"index", 0}}}}),
              (GltfTangentTexcoords{0, "normalTexture", {}, false}));
    EXPECT_EQ(of(two_, {{"normalTexture", {{"index", 0}, {"texCoord", 1}}}}),
              (GltfTangentTexcoords{1, "normalTexture", {}, false}));
}

TEST_F(GltfTangentTexcoordsTest, TheTransformHasTheLastWord) {
    json material = transformed({{"texCoord", 1}, {"scale", {4, 4}}, {"offset", {0.5, 0}}});
    EXPECT_EQ(of(two_, material), (GltfTangentTexcoords{1, "normalTexture", {}, false}));
    material["normalTexture"]["texCoord"] = 0;
    EXPECT_EQ(of(two_, material).set, 1);
}

TEST_F(GltfTangentTexcoordsTest, RotationAndMirroringAreReported) {
    EXPECT_FALSE(of(two_, transformed({{"rotation", 0.0}})).is_rotated);
    EXPECT_FALSE(of(two_, transformed({{"rotation", 6.2831853}})).is_rotated) << "a full turn";
    EXPECT_FALSE(of(two_, transformed({{"scale", {0.25, 8}}})).is_rotated);
    EXPECT_TRUE(of(two_, transformed({{"rotation", 1.5707963}})).is_rotated);
    EXPECT_TRUE(of(two_, transformed({{"rotation", 3.1415927}})).is_rotated) << "half a turn";
    EXPECT_TRUE(of(two_, transformed({{"rotation", -0.01}})).is_rotated);
    EXPECT_TRUE(of(two_, transformed({{"scale", {-1, 1}}})).is_rotated);
    EXPECT_TRUE(of(two_, transformed({{"scale", {1, -2}}})).is_rotated);
}

TEST_F(GltfTangentTexcoordsTest, OtherTangentSpaceTexturesAreTheFallback) {
    const json clearcoat = {
        {"extensions",
         {{"KHR_materials_clearcoat",
           {{"clearcoatNormalTexture", {{"index", 0}, {"texCoord", 1}}}}},
          {"KHR_materials_anisotropy", {{"anisotropyTexture", {{"index", 0}}}}}}}};
    EXPECT_EQ(of(two_, clearcoat), (GltfTangentTexcoords{1, "clearcoatNormalTexture", {}, false}));
    json anisotropy = clearcoat;
    anisotropy["extensions"].erase("KHR_materials_clearcoat");
    anisotropy["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"]["texCoord"] = 1;
    EXPECT_EQ(of(two_, anisotropy), (GltfTangentTexcoords{1, "anisotropyTexture", {}, false}));
    json both = clearcoat;
    both["normalTexture"] = {{"index", 0}};
    EXPECT_EQ(of(two_, both), (GltfTangentTexcoords{0, "normalTexture", {}, false}));
}

TEST_F(GltfTangentTexcoordsTest, AMissingSetFallsBackToTheFirst) {
    EXPECT_EQ(of({"TEXCOORD_1"}, {{"normalTexture", {{"index", 0}, {"texCoord", 2}}}}),
              (GltfTangentTexcoords{1, "normalTexture", 2, false}));
    EXPECT_EQ(of({}, {{"normalTexture", {{"index", 0}}}}),
              (GltfTangentTexcoords{0, "normalTexture", 0, false}));
}

TEST_F(GltfTangentTexcoordsTest, RefusesInvalidTextures) {
    EXPECT_THROW(of(two_, json::parse(R"({"extensions": {"KHR_materials_clearcoat":
                     {"clearcoatNormalTexture": {"index": 0, "texCoord": "one"}}}})")),
                 FileError);
    EXPECT_THROW(static_cast<void>(document(two_, {}).tangent_texcoords({0, 1})), InvalidInput);
}

TEST_F(GltfTangentTexcoordsTest, RealModelsNameTheirSets) {
    RELIEF_NEEDS_SHARED(folder, "data/models/gltf-ext/misc/UnusedTexCoords");
    const GltfDocument model = GltfDocument::read(folder / "TexCoord2.gltf", report_);
    EXPECT_THAT(model.texcoord_sets({0, 0}), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
}

}  // namespace

}  // namespace relief
