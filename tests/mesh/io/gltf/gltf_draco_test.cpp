// SPDX-License-Identifier: Apache-2.0
// Primitives compressed by Draco equal the uncompressed ones, and damaged ones end in an error.
#include <draco/compression/encode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using nlohmann::json;
using test::write_gltf_file;
using testing::ElementsAre;
using testing::HasSubstr;

std::string bytes_in(const draco::EncoderBuffer& buffer) {
    return {buffer.data(), buffer.size()};
}

/// Two triangles in their order, without quantization, with a position, a two-component byte
/// attribute and a 16-bit scalar: unique numbers 0, 1 and 2.
std::string packed_quad() {
    draco::Mesh mesh;
    mesh.set_num_points(4);
    const auto add = [&](draco::GeometryAttribute::Type type, draco::DataType data_type,
                         std::int8_t components, const auto& values) {
        draco::GeometryAttribute attribute;
        const auto size = static_cast<std::int64_t>(sizeof(values[0]));
        attribute.Init(type, nullptr, static_cast<std::uint8_t>(components), data_type, false,
                       components * size, 0);
        const int id = mesh.AddAttribute(attribute, true, 4);
        for (unsigned i = 0; i < 4; ++i) {
            mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                                  &values[i * static_cast<unsigned>(components)]);
        }
    };
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.25F};
    const std::vector<std::uint8_t> texcoords = {0, 0, 255, 0, 255, 128, 7, 255};
    const std::vector<std::uint16_t> numbers = {1000, 2000, 3000, 4000};
    add(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, positions);
    add(draco::GeometryAttribute::TEX_COORD, draco::DT_UINT8, 2, texcoords);
    add(draco::GeometryAttribute::GENERIC, draco::DT_UINT16, 1, numbers);
    const auto face = [](unsigned a, unsigned b, unsigned c) {
        return draco::Mesh::Face{draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)};
    };
    mesh.AddFace(face(0, 1, 2));
    mesh.AddFace(face(0, 2, 3));
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    return bytes_in(buffer);
}

std::string packed_points() {
    draco::PointCloudBuilder builder;
    builder.Start(3);
    const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const float values[9] = {};
    builder.SetAttributeValuesForAllPoints(id, values, 12);
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodePointCloudToBuffer(*builder.Finalize(false), &buffer).ok());
    return bytes_in(buffer);
}

class GltfDraco : public testing::Test {
  protected:
    /// A document with one primitive for the bytes of packed_quad().
    static json quad_document(std::size_t packed_size) {
        json root = json::parse(R"({
            "asset": {"version": "2.0"},
            "extensionsUsed": ["KHR_draco_mesh_compression", "KHR_mesh_quantization"],
            "extensionsRequired": ["KHR_draco_mesh_compression"],
            "bufferViews": [{"buffer": 0}],
            "accessors": [
                {"componentType": 5126, "count": 4, "type": "VEC3", "name": "corners",
                 "min": [-1, 0, 0], "max": [1, 1, 1]},
                {"componentType": 5121, "count": 4, "type": "VEC2", "normalized": true},
                {"componentType": 5123, "count": 4, "type": "SCALAR"},
                {"componentType": 5121, "count": 6, "type": "SCALAR"}],
            "meshes": [{"primitives": [{
                "attributes": {"POSITION": 0, "TEXCOORD_0": 1, "_NUMBER": 2}, "indices": 3,
                "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0,
                    "attributes": {"POSITION": 0, "TEXCOORD_0": 1, "_NUMBER": 2}}}}]}],
            "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})");
        root["buffers"] = {{{"byteLength", packed_size}}};
        root["bufferViews"][0]["byteLength"] = packed_size;
        return root;
    }
    GltfContents contents_of(const json& root, const std::string& buffer) {
        write_gltf_file(in_, root, buffer);
        return read_gltf(in_, report_);
    }
    std::string error_of(const json& root, const std::string& buffer) {
        try {
            contents_of(root, buffer);
        } catch (const FileError& error) {
            return error.what();
        }
        return "no error";
    }
    GltfDocument read(const std::filesystem::path& file) {
        return GltfDocument::read(file, report_);
    }

    test::TemporaryDirectory folder_;
    std::filesystem::path in_ = folder_ / "in.glb";
    std::filesystem::path out_ = folder_ / "out.glb";
    Report report_;
    std::mt19937 random_{5};
    std::string packed_ = packed_quad();
    json root_ = quad_document(packed_.size());
    json& primitive_ = root_["meshes"][0]["primitives"][0];
};

TEST_F(GltfDraco, EveryAttributeFillsItsAccessorInItsOwnType) {
    const GltfContents contents = contents_of(root_, packed_);
    const auto positions = float_elements<glm::vec3>(contents, 0);
    EXPECT_THAT(positions, ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0),
                                       glm::vec3(0, 1, 0.25F)));
    EXPECT_EQ(raw_elements(contents, 1), std::string("\x00\x00\xFF\x00\xFF\x80\x07\xFF", 8));
    EXPECT_EQ(float_elements<glm::vec1>(contents, 2)[3].x, 4000.0F);
    EXPECT_THAT(index_elements(contents, 3), ElementsAre(0, 1, 2, 0, 2, 3));
    // Bounds are those of the decoded values. Names and everything else stay.
    EXPECT_EQ(contents.root["accessors"][0]["min"], json({0, 0, 0}));
    EXPECT_EQ(contents.root["accessors"][0]["max"], json({1, 1, 0.25}));
    EXPECT_EQ(contents.root["accessors"][0]["name"], "corners");
    EXPECT_FALSE(contents.root.contains("extensionsRequired"));
    EXPECT_EQ(contents.root["extensionsUsed"], json({"KHR_mesh_quantization"}));
    EXPECT_EQ(contents.unpacked.at("KHR_draco_mesh_compression"), 1U);
    EXPECT_TRUE(report_.empty());
}

TEST_F(GltfDraco, AWrittenDocumentHasThePlainDataAndNoMore) {
    write_gltf_file(in_, root_, packed_);
    read(in_).write(out_);
    const GltfContents written = read_gltf(out_, report_);
    EXPECT_FALSE(written.root["meshes"][0]["primitives"][0].contains("extensions"));
    EXPECT_EQ(written.root["bufferViews"].size(), 4U);
    // Indices, then positions, texture coordinates padded to 4 bytes each, and numbers likewise.
    EXPECT_EQ(written.buffers[0].size, 8U + 48 + 16 + 16);
    EXPECT_TRUE(written.unpacked.empty());
}

TEST_F(GltfDraco, NumbersOfAnotherTypeAreConvertedOrRefused) {
    root_["accessors"][2]["componentType"] = 5126;
    EXPECT_EQ(float_elements<glm::vec1>(contents_of(root_, packed_), 2)[1].x, 2000.0F);
    root_["accessors"][2]["componentType"] = 5121;
    EXPECT_THAT(error_of(root_, packed_),
                HasSubstr("meshes[0].primitives[0]: a number of vertex 0 in its Draco data does "
                          "not fit"));
}

TEST_F(GltfDraco, CountsOfTheDataCountAndAreReported) {
    root_["accessors"][3]["count"] = 9;
    root_["accessors"][1]["count"] = 3;
    const GltfContents contents = contents_of(root_, packed_);
    EXPECT_EQ(index_elements(contents, 3).size(), 6U);
    EXPECT_EQ(contents.root["accessors"][1]["count"], 4);
    EXPECT_EQ(report_.count("accessor count that is not its Draco data's"), 2U);
}

TEST_F(GltfDraco, StripsAndMissingIndicesBecomeTriangles) {
    primitive_["mode"] = 5;
    root_["accessors"][3]["count"] = 4;
    write_gltf_file(in_, root_, packed_);
    EXPECT_THAT(read(in_).mesh({0, 0}).triangles,
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
    primitive_.erase("indices");
    primitive_.erase("mode");
    write_gltf_file(in_, root_, packed_);
    EXPECT_THAT(read(in_).mesh({0, 0}).triangles,
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
    EXPECT_TRUE(report_.empty());
}

TEST_F(GltfDraco, SharedAccessorsStaySharedUnlessTheirDataDiffer) {
    json& primitives = root_["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    GltfContents contents = contents_of(root_, packed_);
    EXPECT_EQ(contents.root["accessors"].size(), 4U);
    EXPECT_EQ(contents.root["meshes"][0]["primitives"][0],
              contents.root["meshes"][0]["primitives"][1]);
    // The texture coordinates of the second primitive have another source, so they get a separate
    // accessor.
    root_["bufferViews"].push_back(root_["bufferViews"][0]);
    json& second = root_["meshes"][0]["primitives"][1];
    second["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 1;
    contents = contents_of(root_, packed_);
    EXPECT_EQ(contents.root["accessors"].size(), 8U);
    EXPECT_EQ(
        raw_elements(contents, 1),
        raw_elements(contents,
                     contents.root["meshes"][0]["primitives"][1]["attributes"]["TEXCOORD_0"]));
}

TEST_F(GltfDraco, UncompressedPrimitivesKeepTheirBytes) {
    json plain = json::parse(R"({"attributes": {"POSITION": 4}})");
    root_["accessors"].push_back(
        {{"bufferView", 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    root_["meshes"][0]["primitives"].push_back(plain);
    std::string buffer = packed_;
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    root_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", 36}});
    const float positions[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    buffer.append(reinterpret_cast<const char*>(positions), 36);
    root_["buffers"][0]["byteLength"] = buffer.size();
    write_gltf_file(in_, root_, buffer);
    read(in_).write(out_);
    const GltfContents written = read_gltf(out_, report_);
    EXPECT_EQ(written.root["meshes"][0]["primitives"][1], plain);
    EXPECT_THAT(read(out_).mesh({0, 1}).positions,
                ElementsAre(glm::vec3(1, 2, 3), glm::vec3(4, 5, 6), glm::vec3(7, 8, 9)));
}

TEST_F(GltfDraco, SparseElementsLieOverTheDecodedOnes) {
    std::string buffer = packed_;
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    const std::size_t begin = buffer.size();
    const float moved[3] = {5, 6, 7};
    buffer.append(reinterpret_cast<const char*>(moved), 12);
    buffer += '\x02';
    root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", 12}});
    root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", begin + 12}, {"byteLength", 1}});
    root_["accessors"][0]["sparse"] = {{"count", 1},
                                       {"indices", {{"bufferView", 2}, {"componentType", 5121}}},
                                       {"values", {{"bufferView", 1}}}};
    root_["buffers"][0]["byteLength"] = buffer.size();
    const auto positions = float_elements<glm::vec3>(contents_of(root_, buffer), 0);
    EXPECT_EQ(positions[1], glm::vec3(1, 0, 0));
    EXPECT_EQ(positions[2], glm::vec3(5, 6, 7));
}

TEST_F(GltfDraco, EveryContradictionIsNamed) {
    const auto with = [&](const char* pointer, const json& value) {
        json root = root_;
        root[json::json_pointer(pointer)] = value;
        return error_of(root, packed_);
    };
    const std::string draco = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    EXPECT_THAT(with((draco + "/attributes/POSITION").c_str(), 7),
                HasSubstr("meshes[0].primitives[0]: its Draco data has no attribute 7"));
    EXPECT_THAT(with((draco + "/attributes/POSITION").c_str(), 1),
                HasSubstr("attribute 1 of its Draco data has 2 components, not 3"));
    EXPECT_THAT(with((draco + "/attributes/POSITION").c_str(), "0"), HasSubstr("is not an index"));
    EXPECT_THAT(with((draco + "/attributes/NORMAL").c_str(), 0),
                HasSubstr("its Draco data has NORMAL, but the primitive does not"));
    EXPECT_THAT(with((draco + "/bufferView").c_str(), 1),
                HasSubstr("bufferView is 1, but there are only 1 bufferViews"));
    EXPECT_THAT(with("/meshes/0/primitives/0/mode", 6), HasSubstr("no primitives of mode 6"));
    EXPECT_THAT(with("/bufferViews/0/byteLength", packed_.size() - 5),
                HasSubstr("its Draco data is damaged"));
    EXPECT_THAT(with("/accessors/3/componentType", 5126), HasSubstr("is used for indices"));
    const std::string points = packed_points();
    EXPECT_THAT(error_of(quad_document(points.size()), points),
                HasSubstr("its Draco data contains points, not triangles"));
    EXPECT_EQ(error_of(root_, packed_), "no error");
}

/// Returns the largest distance of corners, triangle by triangle, of meshes with the same
/// triangles.
float largest_distance(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.triangles.size(), b.triangles.size());
    const auto center = [](const Mesh& mesh, const glm::uvec3& t) {
        return (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0F;
    };
    float largest = 0.0F;
    for (const glm::uvec3& triangle : a.triangles) {
        float nearest = std::numeric_limits<float>::max();
        for (const glm::uvec3& other : b.triangles)
            nearest = std::min(nearest, glm::length(center(a, triangle) - center(b, other)));
        largest = std::max(largest, nearest);
    }
    return largest;
}

TEST_LABELS(not_sanitized);
TEST_F(GltfDraco, RealModelsMatchUncompressedOnes) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    const auto compare = [&](const char* packed, const char* plain, float tolerance) {
        const GltfDocument a = read(models / packed);
        const GltfDocument b = read(models / plain);
        for (const GltfPrimitiveId id : b.triangle_primitives())
            EXPECT_LE(largest_distance(a.mesh(id), b.mesh(id)), tolerance) << packed;
    };
    // 11 bits over the largest extent: at most half a step per axis.
    compare("Box/glTF-Draco/Box.gltf", "Box/glTF-Binary/Box.glb", 1e-3F);
    compare("Duck/glTF-Draco/Duck.gltf", "Duck/glTF-Binary/Duck.glb", 166.0F / 2047.0F);
    compare("RiggedFigure/glTF-Draco/RiggedFigure.gltf",
            "RiggedFigure/glTF-Binary/RiggedFigure.glb", 1.6F / 2047.0F);
    EXPECT_TRUE(report_.empty());
}

TEST_F(GltfDraco, MorphTargetsThatAreNotCompressedFitTheDecodedVertices) {
    RELIEF_NEEDS_SHARED(file,
                        "data/models/gltf/MorphPrimitivesTest/glTF-Draco/MorphPrimitivesTest.gltf");
    const GltfContents contents = read_gltf(file, report_);
    const GltfDocument document = read(file);
    for (std::size_t i = 0; i < 2; ++i) {
        const Json& target = contents.root["meshes"][0]["primitives"][i]["targets"][0];
        const auto moved = float_elements<glm::vec3>(contents, target["POSITION"]);
        const Mesh mesh = document.mesh({0, i});
        ASSERT_EQ(moved.size(), mesh.positions.size());
        // The author moves the inner vertices of a square of one unit.
        for (std::size_t v = 0; v < moved.size(); ++v) {
            const glm::vec3 distance = glm::abs(mesh.positions[v]);
            EXPECT_EQ(moved[v].y > 0.0F, std::max(distance.x, distance.z) < 0.3F) << i << ' ' << v;
        }
    }
}

TEST_F(GltfDraco, FilesWithWrongBytesAreRefusedOrCanBeWorkedWith) {
    RELIEF_NEEDS_SHARED(folder, "data/models/gltf-ext");
    int refused = 0;
    for (const char* name : {"draco/Box_Draco.glb", "misc/DenseSphere.glb"}) {
        for (int i = 0; i < 150; ++i) {
            test::write_damaged_copy(folder / name, in_, random_);
            refused += test::is_refused(in_) ? 1 : 0;
        }
    }
    EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace relief
