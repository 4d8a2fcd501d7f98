// SPDX-License-Identifier: Apache-2.0
// Documents of some hundred bytes that stand for gigabytes are refused before anything is decoded,
// and the limit of memory raises the budget.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/model.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// One triangle, and an accessor of a thousand positions in the buffer.
json thousand_positions() {
    return json::parse(R"({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 12000}],
        "bufferViews": [{"buffer": 0, "byteLength": 12000}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 999, "type": "VEC3"},
            {"bufferView": 0, "componentType": 5126, "count": 3000, "type": "SCALAR"},
            {"bufferView": 0, "componentType": 5126, "count": 187, "type": "MAT4"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})");
}

class GltfBudget : public testing::Test {
  protected:
    ~GltfBudget() override { set_input_limits({}); }

    std::string error_of(const json& root) {
        test::write_gltf_file(folder_ / "a.glb", root, std::string(12000, '\0'));
        try {
            GltfDocument::read(folder_ / "a.glb");
        } catch (const FileError& error) {
            return error.what();
        }
        return "no error";
    }

    test::TemporaryDirectory folder_;
};

TEST_F(GltfBudget, LimitsAccessorsWithoutData) {
    json root = thousand_positions();
    EXPECT_EQ(error_of(root), "no error");
    root["accessors"].push_back({{"componentType", 5126}, {"count", 24'000'000}, {"type", "VEC3"}});
    const std::string error = error_of(root);
    EXPECT_THAT(error, HasSubstr("a.glb: accessors[3]: the contents of the file up to here take "
                                 "274.7 MiB of memory, but a file of "));
    EXPECT_THAT(error, HasSubstr("may take only 256.0 (--max-memory raises this limit)"));
    set_input_limits({.memory = std::uint64_t{300} << 20});
    EXPECT_EQ(error_of(root), "no error");
    root["accessors"][3]["count"] = (std::uint64_t{1} << 53) - 1;
    EXPECT_THAT(error_of(root), HasSubstr("accessors[3]: the contents"));
}

TEST_F(GltfBudget, LimitsSharedData) {
    json root = thousand_positions();
    for (int i = 0; i < 30'000; ++i)
        root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
    EXPECT_THAT(error_of(root), HasSubstr("meshes[0].primitives["));

    root = thousand_positions();
    for (int i = 0; i < 30'000; ++i)
        root["skins"].push_back({{"joints", {0}}, {"inverseBindMatrices", 2}});
    EXPECT_THAT(error_of(root), HasSubstr("skins["));

    root = thousand_positions();
    root["animations"] =
        json::parse(R"([{"samplers": [{"input": 1, "output": 0}], "channels": []}])");
    for (int i = 0; i < 20'000; ++i) {
        root["animations"][0]["channels"].push_back(
            {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}});
    }
    EXPECT_THAT(error_of(root), HasSubstr("animations[0].channels["));

    root = thousand_positions();
    for (int i = 0; i < 30'000; ++i)
        root["images"].push_back({{"bufferView", 0}, {"mimeType", "image/png"}});
    EXPECT_THAT(error_of(root), HasSubstr("images["));
}

TEST_F(GltfBudget, LimitsInstances) {
    json root = thousand_positions();
    root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = 0;
    EXPECT_EQ(error_of(root), "no error");
    root["accessors"][0].erase("bufferView");
    root["accessors"][0]["count"] = 900'000;
    EXPECT_THAT(error_of(root), HasSubstr("nodes[0]: the contents"));

    root = thousand_positions();
    for (int i = 0; i < 1'000; ++i) {
        root["meshes"][0]["primitives"].push_back(
            {{"attributes", {{"POSITION", 0}}}, {"indices", 3}});
        root["nodes"].push_back({{"mesh", 0}});
    }
    root["accessors"].push_back({{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
    EXPECT_THAT(error_of(root), HasSubstr("nodes["));
}

TEST_F(GltfBudget, LimitsWhatDrawingNeeds) {
    // A node that instances a mesh takes 2.5 KiB, but at least 10 bytes of the file.
    json nodes = thousand_positions();
    for (int i = 1; i < 120'000; ++i)
        nodes["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(error_of(nodes), "no error");

    const auto with_primitives = [](std::size_t count) {
        json root = thousand_positions();
        root["accessors"][0]["count"] = 3;
        for (std::size_t i = 1; i < count; ++i)
            root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
        return root;
    };
    // 20 KiB for each primitive, and 2.5 for its instance.
    EXPECT_EQ(error_of(with_primitives(11'000)), "no error");
    EXPECT_THAT(error_of(with_primitives(14'000)), HasSubstr("meshes[0].primitives[13"));

    json root = thousand_positions();
    root["materials"] = json::array();
    for (int i = 0; i < 140'000; ++i)
        root["materials"].push_back(json::object());
    EXPECT_THAT(error_of(root), HasSubstr("materials: the contents of the file up to here take "
                                          "273.4 MiB"));
}

TEST_F(GltfBudget, LimitsInstancesThatAreJoinedInWorldSpace) {
    json root = thousand_positions();
    for (int i = 1; i <= 200; ++i) {
        root["nodes"].push_back({{"mesh", 0}});
        root["scenes"][0]["nodes"].push_back(i);
    }
    test::write_gltf_file(folder_ / "a.glb", root, std::string(12000, '\0'));
    const auto flat = [&] { return flattened(GltfDocument::read(folder_ / "a.glb")); };
    const auto joined = [&] { return joined_model(GltfDocument::read(folder_ / "a.glb"), true); };
    set_input_limits({.memory = 16 << 20});
    EXPECT_EQ(flat().mesh.positions.size(), 201U * 999U);
    EXPECT_EQ(joined().mesh.positions.size(), 201U * 999U);

    set_input_limits({.memory = 1 << 20});  // 256 times the bytes of the file are less than needed.
    for (const std::string& error : {test::message_of<InvalidInput>([&] { flat(); }),
                                     test::message_of<InvalidInput>([&] { joined(); })}) {
        EXPECT_THAT(error, HasSubstr("nodes["));
        EXPECT_THAT(error, HasSubstr("--max-memory raises this limit"));
    }
    EXPECT_NO_THROW(joined_model(GltfDocument::read(folder_ / "a.glb"), false));
}

TEST_F(GltfBudget, PrimitivesThatUseFewVerticesOfALargeAccessorAreReadInProportion) {
    constexpr std::size_t vertices = 1'000'000;
    constexpr std::size_t primitives = 2'000;
    json root = thousand_positions();
    std::string buffer(12 * vertices + 6, '\0');
    buffer[buffer.size() - 2] = 2;
    buffer[buffer.size() - 4] = 1;
    root["buffers"][0]["byteLength"] = buffer.size();
    root["bufferViews"] = {{{"buffer", 0}, {"byteLength", 12 * vertices}},
                           {{"buffer", 0}, {"byteOffset", 12 * vertices}, {"byteLength", 6}}};
    root["accessors"] = {
        {{"bufferView", 0}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}}};
    root["meshes"][0]["primitives"] = json::array();
    for (std::size_t i = 0; i < primitives; ++i) {
        root["meshes"][0]["primitives"].push_back(
            {{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
    }
    test::write_gltf_file(folder_ / "a.glb", root, buffer);
    const GltfDocument document = GltfDocument::read(folder_ / "a.glb");
    const auto start = std::chrono::steady_clock::now();
    for (const GltfPrimitiveId id : document.triangle_primitives())
        ASSERT_EQ(document.mesh(id).positions.size(), 3U);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    // Reading all vertices for each takes 20 s.
    EXPECT_LT(seconds.count(), 5.0);
}

}  // namespace
}  // namespace relief
