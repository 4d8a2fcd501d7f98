// SPDX-License-Identifier: Apache-2.0
// Faults of a document that glTF forbids but that can be read are repaired when it is written, with
// a finding each, or refused with a remedy. One table has a row for each fault.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A skinned triangle with all attributes and an animation; each accessor has its own buffer view.
struct FaultyTriangle {
    std::string bytes;
    json root = json::parse(R"({
        "asset": {"version": "2.0"},
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.5}}],
        "meshes": [{"primitives": [{"material": 0, "indices": 6, "attributes": {
            "POSITION": 0, "NORMAL": 1, "TANGENT": 2, "COLOR_0": 3, "JOINTS_0": 4, "WEIGHTS_0": 5,
            "TEXCOORD_0": 10}}]}],
        "nodes": [{"mesh": 0, "skin": 0}, {"rotation": [0, 0, 0, 1]}],
        "skins": [{"joints": [1], "inverseBindMatrices": 7}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}],
                        "samplers": [{"input": 8, "output": 9}]}],
        "scenes": [{"nodes": [0, 1]}], "scene": 0})");

    FaultyTriangle() {
        add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 5126, 34962);
        root["accessors"][0]["min"] = {0, 0, 0};
        root["accessors"][0]["max"] = {1, 1, 0};
        add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126, 34962);
        add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 5126, 34962);
        add<float>(std::vector<float>(12, 1.0F), "VEC4", 5126, 34962);
        add<std::uint8_t>(std::vector<std::uint8_t>(12, 0), "VEC4", 5121, 34962);
        add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 5126, 34962);
        add<std::uint16_t>({0, 1, 2}, "SCALAR", 5123, 34963);
        add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4", 5126, 0);
        add<float>({0, 1}, "SCALAR", 5126, 0);
        root["accessors"][8]["min"] = {0};
        root["accessors"][8]["max"] = {1};
        add<float>({0, 0, 0, 1, 0, 0, 0, 1}, "VEC4", 5126, 0);
        add<float>({0, 0, 1, 0, 0, 1}, "VEC2", 5126, 34962);
    }

    template <typename Value>
    void add(const std::vector<Value>& values, const char* type, int component, int target) {
        const std::string name = type;
        const std::size_t components = name == "SCALAR" ? 1
                                       : name == "MAT4" ? 16
                                                        : static_cast<std::size_t>(name[3] - '0');
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        json view = {{"buffer", 0},
                     {"byteOffset", bytes.size()},
                     {"byteLength", values.size() * sizeof(Value)}};
        if (target != 0) view["target"] = target;
        const json accessor = {{"bufferView", root["bufferViews"].size()},
                               {"componentType", component},
                               {"type", type},
                               {"count", values.size() / components}};
        root["accessors"].push_back(accessor);
        root["bufferViews"].push_back(view);
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
        root["buffers"][0]["byteLength"] = bytes.size();
    }

    /// Sets a float of an accessor.
    void set(std::size_t accessor, std::size_t at, float value) {
        const json& view =
            root["bufferViews"][root["accessors"][accessor]["bufferView"].get<std::size_t>()];
        std::memcpy(bytes.data() + view["byteOffset"].get<std::size_t>() + 4 * at, &value, 4);
    }
    json& primitive() { return root["meshes"][0]["primitives"][0]; }
};

struct Fault {
    const char* name;
    void (*make)(FaultyTriangle&);
    const char* finding;  ///< Or the error if the document is not written.
};

const Fault repaired[] = {
    {"LongNormal", [](FaultyTriangle& t) { t.set(1, 5, 1.5F); },
     "1 x normal that is not of unit length (vertex 1): is normalized\n"},
    {"ZeroNormal", [](FaultyTriangle& t) { t.set(1, 5, 0.0F); },
     "1 x normal of length 0 (vertex 1): becomes (0,0,1)\n"},
    {"ShortTangent", [](FaultyTriangle& t) { t.set(2, 0, 0.5F); },
     "1 x tangent that is not of unit length (vertex 0): is normalized\n"},
    {"SignOfTangent", [](FaultyTriangle& t) { t.set(2, 11, -0.2F); },
     "1 x tangent whose w is neither 1 nor -1 (vertex 2): gets the nearer one\n"},
    {"BrightColor", [](FaultyTriangle& t) { t.set(3, 0, 1.5F); },
     "1 x color that is not between 0 and 1 (vertex 0): becomes the nearer of the two\n"},
    {"SumOfWeights", [](FaultyTriangle& t) { t.set(5, 4, 0.9F); },
     "1 x weights whose sum is not 1 (vertex 1): are divided by it\n"},
    {"NoWeights", [](FaultyTriangle& t) { t.set(5, 4, 0.0F); },
     "1 x vertex without weights (vertex 1): follows its first joint\n"},
    {"JointTwice",
     [](FaultyTriangle& t) {
         t.set(5, 0, 0.5F);
         t.set(5, 1, 0.5F);
     },
     "1 x joint with two weights (vertex 0): gets their sum\n"},
    {"BindMatrix", [](FaultyTriangle& t) { t.set(7, 3, 0.5F); },
     "1 x inverse bind matrix whose last row is not (0,0,0,1) (joint 0): gets that row\n"},
    {"AnimatedRotation", [](FaultyTriangle& t) { t.set(9, 7, 2.0F); },
     "1 x rotation of an animation that is not of unit length (key 1): is normalized\n"},
    {"BoundsOfTimes", [](FaultyTriangle& t) { t.root["accessors"][8]["max"] = {2}; },
     "1 x bounds that differ from the values (accessor 8): are recomputed\n"},
    {"BoundsOfAnyData",
     [](FaultyTriangle& t) {
         t.root["accessors"][6]["min"] = {1};
         t.root["accessors"][6]["max"] = {2};
     },
     "1 x bounds that differ from the values (accessor 6): are recomputed\n"},
    {"SharedViewWithoutStride",
     [](FaultyTriangle& t) {
         t.root["bufferViews"][0]["byteLength"] = 72;
         t.root["accessors"][1]["bufferView"] = 0;
         t.root["accessors"][1]["byteOffset"] = 36;
     },
     "2 x vertex data that shares a buffer view without byteStride (accessor 0, 1): is stored "
     "anew\n"},
    {"StrideOfIndices",
     [](FaultyTriangle& t) {
         t.bytes.resize(t.bytes.size() + 12);
         t.root["buffers"][0]["byteLength"] = t.bytes.size();
         t.root["bufferViews"][6] = {{"buffer", 0},
                                     {"byteOffset", t.bytes.size() - 12},
                                     {"byteLength", 12},
                                     {"byteStride", 4}};
     },
     "1 x byteStride of data that is not of vertices (accessor 6): is stored anew\n"},
    {"TargetOfVertices", [](FaultyTriangle& t) { t.root["bufferViews"][0]["target"] = 34963; },
     "1 x vertex data in a buffer view with another target (accessor 0): is stored anew\n"},
    {"StrideOfNothing",
     [](FaultyTriangle& t) {
         t.root["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 12}, {"byteStride", 5}});
     },
     "1 x byteStride of a buffer view without vertices (buffer view 11): is left out\n"},
    {"EmptyArray", [](FaultyTriangle& t) { t.root["nodes"][1]["children"] = json::array(); },
     "1 x empty array 'children' (node 1): is left out\n"},
    {"Factor",
     [](FaultyTriangle& t) {
         t.root["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1.5;
     },
     "1 x metallicFactor out of range (material 0): becomes the nearest permitted value\n"},
    {"FactorOfAnExtension",
     [](FaultyTriangle& t) {
         t.root["extensionsUsed"] = {"KHR_materials_volume"};
         t.root["materials"][0]["extensions"]["KHR_materials_volume"] = {
             {"attenuationDistance", 0}};
     },
     "1 x attenuationDistance out of range (material 0): becomes the nearest permitted value\n"},
    {"UndeclaredExtension",
     [](FaultyTriangle& t) {
         t.root["materials"][0]["extensions"]["KHR_materials_ior"] = {{"ior", 1.4}};
     },
     "1 x KHR_materials_ior that extensionsUsed does not name (document 0): is added there\n"},
    {"MisplacedExtension",
     [](FaultyTriangle& t) {
         t.root["extensionsUsed"] = {"KHR_materials_ior"};
         t.root["nodes"][0]["extensions"]["KHR_materials_ior"] = {{"ior", 1.4}};
     },
     "1 x KHR_materials_ior in the wrong place (node 0): is left out\n"},
    {"OptionalQuantization",
     [](FaultyTriangle& t) { t.root["extensionsUsed"] = {"KHR_mesh_quantization"}; },
     "1 x KHR_mesh_quantization that extensionsRequired does not name (document 0): is added "
     "there\n"},
    {"AttributeName", [](FaultyTriangle& t) { t.primitive()["attributes"]["HEAT"] = 3; },
     "1 x attribute 'HEAT' without a leading underscore (primitive 0): gets it\n"},
    {"TexcoordsFrom1",
     [](FaultyTriangle& t) {
         t.primitive()["attributes"]["TEXCOORD_1"] = 10;
         t.primitive()["attributes"].erase("TEXCOORD_0");
     },
     "1 x missing TEXCOORD_0 below TEXCOORD_1 (primitive 0): becomes a copy of that\n"},
    {"WeightsOfNode", [](FaultyTriangle& t) { t.root["nodes"][1]["weights"] = {1}; },
     "1 x weights of a node without a mesh (node 1): is left out\n"},
    {"MatrixAndRotation",
     [](FaultyTriangle& t) {
         t.root["nodes"][1]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
     },
     "1 x rotation beside a matrix (node 1): is left out\n"},
    {"Rotation",
     [](FaultyTriangle& t) {
         t.root["nodes"][1]["rotation"] = {0, 0, 0, 2};
     },
     "1 x rotation that is not of unit length (node 1): is normalized\n"},
};

const Fault refused[] = {
    {"Sheared",
     [](FaultyTriangle& t) {
         t.root["nodes"][1].erase("rotation");
         t.root["nodes"][1]["matrix"] = {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
     },
     "nodes[1]: its matrix is not a translation, rotation and scale, which glTF requires (apply"},
    {"JointOutOfRange",
     [](FaultyTriangle& t) {
         const json& view = t.root["bufferViews"][4];
         t.bytes[view["byteOffset"].get<std::size_t>() + 4] = 3;
     },
     "nodes[0]: JOINTS_0 names joint 3, but its skin has only 1 (export the skin again)"},
    {"TwoRoots",
     [](FaultyTriangle& t) {
         t.root["nodes"].push_back({{"name", "other"}});
         t.root["skins"][0]["joints"] = {1, 2};
     },
     "skins[0] has joints without a common root (give them a common parent node)"},
    {"NoChannels", [](FaultyTriangle& t) { t.root["animations"][0]["channels"] = json::array(); },
     "animations[0].channels is empty, which glTF does not permit (remove it)"},
    {"InfiniteTime", [](FaultyTriangle& t) { t.set(8, 1, std::numeric_limits<float>::infinity()); },
     "element 1 of accessors[8] is not finite, which glTF does not permit (correct or remove"},
    {"UriOfImage",
     [](FaultyTriangle& t) {
         t.root["images"] = {{{"uri", ":"}}};
     },
     "images[0].uri ':' is no URI (name a file beside the document)"},
    {"ColorsFrom1",
     [](FaultyTriangle& t) {
         t.primitive()["attributes"]["COLOR_1"] = 3;
         t.primitive()["attributes"].erase("COLOR_0");
     },
     "mesh 0 primitive 0: has 1 sets of COLOR_n, but no COLOR_0 (number them from 0)"},
};

class GltfRepair : public testing::TestWithParam<Fault> {
  protected:
    GltfDocument read(const FaultyTriangle& triangle) {
        test::write_gltf_file(folder_ / "in.glb", triangle.root, triangle.bytes);
        return GltfDocument::read(folder_ / "in.glb");
    }
    /// Writes a document. \return the findings
    std::string findings_of_writing(const GltfDocument& document) {
        Report report;
        document.write(folder_ / "out.glb", report);
        std::string text;
        for (const Finding& finding : report.findings())
            text += to_string(finding) + "\n";
        return text;
    }
    test::TemporaryDirectory folder_;
};

TEST_F(GltfRepair, ChangesNothingInAValidDocument) {
    const FaultyTriangle triangle;
    EXPECT_EQ(findings_of_writing(read(triangle)), "");
    EXPECT_EQ(test::meaning_of(folder_ / "in.glb"), test::meaning_of(folder_ / "out.glb"));
}

TEST_P(GltfRepair, OfAFaultIsReportedOnce) {
    FaultyTriangle triangle;
    GetParam().make(triangle);
    const GltfDocument document = read(triangle);
    EXPECT_EQ(findings_of_writing(document), GetParam().finding);
    // The object keeps what was read.
    EXPECT_EQ(findings_of_writing(document), GetParam().finding);
    Report of_reading;
    const GltfDocument again = GltfDocument::read(folder_ / "out.glb", of_reading);
    EXPECT_TRUE(of_reading.empty());
    EXPECT_EQ(findings_of_writing(again), "");
}

INSTANTIATE_TEST_SUITE_P(Faults, GltfRepair, testing::ValuesIn(repaired),
                         [](const auto& fault) { return std::string(fault.param.name); });

/// Writes a document of one material whose factors all have a value. \return the factors by path
std::map<std::string, json> written_factors(double value, const std::filesystem::path& folder,
                                            Report& report) {
    FaultyTriangle triangle;
    std::vector<std::string> paths;
    const auto add = [&](const auto& field) {
        using Value = decltype(field.default_value());
        const std::string path = fmt::format("/materials/0/{}", field.gltf);
        constexpr bool is_number =
            std::is_same_v<Value, float> || std::is_same_v<Value, std::optional<float>>;
        if constexpr (is_number || std::is_same_v<Value, glm::vec3>) {
            if (*field.gltf == '\0' || path.ends_with("Texture/strength")) return;
            triangle.root[json::json_pointer(path)] = value;
            if constexpr (!is_number) {
                const std::size_t count = path.ends_with("baseColorFactor") ? 4 : 3;
                triangle.root[json::json_pointer(path)] = std::vector<double>(count, value);
            }
            paths.push_back(path);
        }
    };
    for_each_field<Material>(add);
    for_each_field<MetallicRoughness>(add);
    for (const auto& [name, extension] : triangle.root["materials"][0]["extensions"].items())
        triangle.root["extensionsUsed"].push_back(name);
    test::write_gltf_file(folder / "in.glb", triangle.root, triangle.bytes);
    GltfDocument::read(folder / "in.glb").write(folder / "out.glb", report);
    const json root = test::meaning_of(folder / "out.glb");
    std::map<std::string, json> result;
    for (const std::string& path : paths) {
        const json& factor = root[json::json_pointer(path)];
        result[path] = factor.is_array() ? factor[0] : factor;
    }
    return result;
}

TEST_F(GltfRepair, KeepsEveryFactorWithinWhatGltfPermits) {
    Report low;
    Report high;
    const auto least = written_factors(-1e9, folder_.path(), low);
    const auto most = written_factors(1e9, folder_.path(), high);
    const auto check = [&](const auto& field) {
        const auto found = least.find(fmt::format("/materials/0/{}", field.gltf));
        if (found == least.end()) return;
        SCOPED_TRACE(field.gltf);
        constexpr FieldRange all;
        const FieldRange& range = field.gltf_range;
        EXPECT_EQ(found->second, range.min == all.min ? -1e9 : static_cast<double>(range.min));
        EXPECT_EQ(most.at(found->first),
                  range.max == all.max ? 1e9 : static_cast<double>(range.max));
    };
    for_each_field<Material>(check);
    for_each_field<MetallicRoughness>(check);
    EXPECT_GT(least.size(), 15U);
}

class GltfRefusal : public GltfRepair {};

TEST_P(GltfRefusal, NamesThePlaceAndTheRemedy) {
    FaultyTriangle triangle;
    GetParam().make(triangle);
    const GltfDocument document = read(triangle);
    EXPECT_THAT([&] { findings_of_writing(document); },
                testing::ThrowsMessage<FileError>(HasSubstr(GetParam().finding)));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.glb"));
}

INSTANTIATE_TEST_SUITE_P(Faults, GltfRefusal, testing::ValuesIn(refused),
                         [](const auto& fault) { return std::string(fault.param.name); });

}  // namespace
}  // namespace relief
