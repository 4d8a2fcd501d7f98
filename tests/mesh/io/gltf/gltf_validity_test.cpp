// SPDX-License-Identifier: Apache-2.0
// Commands that compute or convert meshes repair values that glTF forbids; writers of documents
// refuse them. Values of documents that renderers trip over are reported.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

/// A square of two triangles with texture coordinates and colors.
struct Square {
    std::vector<float> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    std::vector<float> texcoords = {0, 1, 1, 1, 1, 0, 0, 0};
    std::vector<float> colors = std::vector<float>(16, 1.0F);
    std::vector<std::uint16_t> indices = {0, 1, 2, 0, 2, 3};
    json root = json::parse(R"({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 156}],
        "bufferViews": [{"buffer": 0, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 48, "byteLength": 32},
                        {"buffer": 0, "byteOffset": 80, "byteLength": 64},
                        {"buffer": 0, "byteOffset": 144, "byteLength": 12}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC4"},
            {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "materials": [{}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2},
                                    "indices": 3, "material": 0}]}],
        "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})");

    [[nodiscard]] std::string bytes() const {
        std::string result(156, '\0');
        std::memcpy(result.data(), positions.data(), 48);
        std::memcpy(result.data() + 48, texcoords.data(), 32);
        std::memcpy(result.data() + 80, colors.data(), 64);
        std::memcpy(result.data() + 144, indices.data(), 12);
        return result;
    }
};

class GltfValidity : public testing::Test {
  protected:
    GltfDocument read(const Square& square) {
        test::write_gltf_file(folder_ / "in.glb", square.root, square.bytes());
        report_ = Report();
        return GltfDocument::read(folder_ / "in.glb", report_);
    }
    /// Returns the error of writing, or the written JSON's text.
    std::string written(const GltfDocument& document) {
        std::ofstream(folder_ / "out.gltf") << "old";
        try {
            document.write(folder_ / "out.gltf");
        } catch (const FileError& error) {
            std::string old;
            std::ifstream(folder_ / "out.gltf") >> old;
            EXPECT_EQ(old, "old");
            return error.what();
        }
        std::ifstream stream(folder_ / "out.gltf");
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    std::string findings() const {
        std::string text;
        for (const Finding& finding : report_.findings())
            text += to_string(finding) + "\n";
        return text;
    }

    test::TemporaryDirectory folder_;
    Report report_;
};

TEST_F(GltfValidity, DocumentsWithInvalidVerticesAreNotWritten) {
    EXPECT_THAT(written(read({})), HasSubstr("\"asset\""));
    Square square;
    square.indices[4] = 4;
    EXPECT_THAT(written(read(square)),
                HasSubstr("out.gltf: cannot be written: mesh 0 primitive 0: index 4 names vertex "
                          "4, but there are only 4"));
    square.root["meshes"][0]["primitives"][0]["mode"] = 0;  // Points.
    EXPECT_THAT(written(read(square)), HasSubstr("index 4 names vertex 4, but there are only 4"));
    square = {};
    square.root["accessors"][1]["count"] = 3;
    EXPECT_THAT(written(read(square)), HasSubstr("3 elements of TEXCOORD_0, but 4 of POSITION"));
    for (std::vector<float> Square::*values :
         {&Square::positions, &Square::texcoords, &Square::colors}) {
        square = {};
        (square.*values)[5] = nan_value;
        EXPECT_THAT(written(read(square)),
                    HasSubstr("is not finite, which glTF does not permit (relief-mesh process "
                              "repairs such values)"));
    }
}

TEST_F(GltfValidity, ComputedFramesRepairValues) {
    Square square;
    square.positions[10] = nan_value;
    square.texcoords[0] = std::numeric_limits<float>::infinity();
    square.colors[15] = nan_value;
    GltfDocument document = read(square);
    const GltfPrimitiveId id;
    FrameOptions options;
    options.normals = NormalMode::flat;
    options.tangents = TangentMethod::mikktspace;
    report_ = Report();
    const Mesh before = document.mesh(id);
    Report of_frames;
    document.set_frames(id, with_frames(before, options, of_frames), options, report_);
    EXPECT_EQ(report_.count("invalid POSITION"), 1U) << findings();
    EXPECT_EQ(report_.count("triangle with an invalid POSITION"), 1U);
    EXPECT_EQ(report_.count("invalid TEXCOORD_0"), 1U);
    EXPECT_EQ(report_.count("invalid COLOR_0"), 1U);
    EXPECT_THAT(written(document), HasSubstr("\"asset\""));
    report_ = Report();
    const Mesh mesh = GltfDocument::read(folder_ / "out.gltf", report_).mesh(id);
    EXPECT_EQ(findings(), "");
    ASSERT_EQ(mesh.triangles.size(), 2U);
    // The sound triangle is unchanged; the other one has no area.
    EXPECT_EQ(mesh.positions[mesh.triangles[0].y], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.triangles[1].x, mesh.triangles[1].y);
    EXPECT_EQ(mesh.triangles[1].x, mesh.triangles[1].z);
    const Bounds bounds = bounds_of(mesh);
    EXPECT_EQ(bounds.max, glm::vec3(1, 1, 0));
    for (const glm::vec2& texcoord : mesh.texcoords)
        EXPECT_TRUE(std::isfinite(texcoord.x) && std::isfinite(texcoord.y));
}

TEST_F(GltfValidity, ConvertedMeshesAreRepairedOrRefused) {
    MeshFile contents;
    contents.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {nan_value, 1, 0}};
    contents.mesh.normals = {{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {nan_value, 0, 1}};
    contents.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_THAT(written(GltfDocument::from_mesh(contents)), HasSubstr("NORMAL is not finite"));
    const GltfDocument document = GltfDocument::from_mesh(contents, report_);
    EXPECT_EQ(report_.count("triangle with an invalid POSITION"), 1U);
    EXPECT_EQ(report_.count("invalid NORMAL"), 2U);
    EXPECT_THAT(written(document), HasSubstr("\"asset\""));
    EXPECT_EQ(document.mesh({}).normals[0], glm::vec3(0, 0, 1));
}

TEST_F(GltfValidity, TexturesNeedTextureCoordinates) {
    const std::filesystem::path image = test::source_directory() / "data/scenes/bricks-normal.png";
    Square square;
    const auto with_map = [&] {
        GltfDocument document = read(square);
        document.set_texture(0, TextureSlot::normal, image, GltfImageStorage::external, report_);
        return document;
    };
    EXPECT_THAT(written(with_map()), HasSubstr("bricks-normal.png"));
    EXPECT_EQ(findings(), "");
    // One of two primitives has no texture coordinates.
    json& primitives = square.root["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[1]["attributes"].erase("TEXCOORD_0");
    const GltfDocument document = with_map();
    EXPECT_THAT(findings(), HasSubstr("mesh 0 primitive 1 without texture coordinates for a map"));
    EXPECT_EQ(document.mesh({0, 1}).texcoords, std::vector<glm::vec2>(4, glm::vec2(0.0F)));
    EXPECT_THAT(written(document), HasSubstr("bricks-normal.png"));
    primitives.erase(0);
    EXPECT_THAT([&] { with_map(); },
                testing::ThrowsMessage<InvalidInput>(
                    HasSubstr("mesh 0 primitive 0: has no texture coordinates (unwrap the model "
                              "first)")));
}

TEST_F(GltfValidity, MissingBoundsOfPositionsAreAdded) {
    for (const char* key : {"min", "max"}) {
        for (const json& bound : {json(), json({0, 0}), json({1, 2, 3, 4})}) {
            Square square;
            if (bound.is_null())
                square.root["accessors"][0].erase(key);
            else
                square.root["accessors"][0][key] = bound;
            const GltfDocument document = read(square);
            EXPECT_EQ(findings(), "1 x positions without bounds (accessor 0): get them\n");
            const json root = json::parse(written(document));
            EXPECT_EQ(root["accessors"][0]["min"], json({0, 0, 0}));
            EXPECT_EQ(root["accessors"][0]["max"], json({1, 1, 0}));
        }
    }
}

TEST_F(GltfValidity, LevelsOfDetailAndTransformsAreChecked) {
    Square square;
    square.root["extensionsUsed"] = {"MSFT_lod"};
    square.root["nodes"].push_back({{"mesh", 0}});
    json& levels = square.root["nodes"][0]["extensions"]["MSFT_lod"]["ids"];
    levels = {1};
    read(square);
    EXPECT_EQ(findings(), "");
    levels = {0, 1};
    read(square);
    EXPECT_EQ(findings(), "1 x node that is its own level of detail (node 0): is read as it is\n");
    levels = {1};
    square.root["nodes"][1]["extensions"]["MSFT_lod"]["ids"] = {0};
    read(square);
    EXPECT_EQ(report_.count("level of detail that has levels itself"), 2U);
    levels = {2};
    EXPECT_THAT([&] { read(square); },
                testing::ThrowsMessage<FileError>(
                    HasSubstr("nodes[0].extensions.MSFT_lod.ids[0] is 2, but there are only 2 "
                              "nodes")));
    square = {};
    square.root["nodes"][0]["scale"] = {1, 1e30, 1};
    read(square);
    EXPECT_EQ(findings(), "1 x transform with numbers beyond 1e18 (node 0): is read as it is\n");
}

}  // namespace
}  // namespace relief
