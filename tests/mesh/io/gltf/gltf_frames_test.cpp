// SPDX-License-Identifier: Apache-2.0
// Replaced frames: everything else is carried over or stays unchanged, and no unused data remains.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using nlohmann::json;
using test::write_gltf_file;
using testing::ElementsAre;
using testing::HasSubstr;

/// The bytes of a document under construction.
class Buffer {
  public:
    /// Adds a view over these values and returns its JSON.
    template <typename Value>
    json view(const std::vector<Value>& values, std::size_t stride = 0) {
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        json result = {{"buffer", 0},
                       {"byteOffset", bytes.size()},
                       {"byteLength", values.size() * sizeof(Value)}};
        if (stride > 0) result["byteStride"] = stride;
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
        return result;
    }
    std::string bytes;
};

json accessor(int view, int component_type, std::size_t count, const char* type) {
    return {
        {"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}};
}

class GltfFrames : public testing::Test {
  protected:
    GltfFrames() {
        root_ = json::parse(R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
                                "scenes": [{"nodes": [0]}], "scene": 0})");
    }
    /// A quad of two triangles with attributes of many types and a morph target.
    void make_quad() {
        root_["extensionsUsed"] = root_["extensionsRequired"] = {"KHR_mesh_quantization"};
        root_["bufferViews"] = {
            buffer_.view<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}),
            buffer_.view<std::int8_t>({0, 0, 127, 9, 0, 0, 127, 9, 0, 0, 127, 9, 0, 0, 127, 9}, 4),
            buffer_.view<std::uint16_t>({0, 0, 65535, 0, 65535, 65535, 0, 65535}),
            buffer_.view<std::uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}),
            buffer_.view<float>({0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4}),
            buffer_.view<std::uint8_t>({0, 1, 2, 0, 2, 3}),
            buffer_.view<std::uint8_t>({21, 0, 0, 0, 22, 0, 0, 0, 23, 0, 0, 0, 24}, 4)};
        json normals = accessor(1, 5120, 4, "VEC3");
        normals["normalized"] = true;
        json texcoords = accessor(2, 5123, 4, "VEC2");
        texcoords["normalized"] = true;
        json positions = accessor(0, 5126, 4, "VEC3");
        positions["min"] = {0, 0, 0};
        positions["max"] = {1, 1, 0};
        positions["name"] = "corners";
        root_["accessors"] = {positions,
                              normals,
                              texcoords,
                              accessor(3, 5121, 4, "VEC4"),
                              accessor(4, 5126, 4, "VEC3"),
                              accessor(5, 5121, 6, "SCALAR"),
                              accessor(6, 5121, 4, "SCALAR")};
        root_["meshes"] = json::parse(R"([{"primitives": [{
            "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "_FOUR": 3, "_ID": 6},
            "indices": 5, "targets": [{"POSITION": 4}]}]}])");
        finish();
    }
    void finish() {
        root_["buffers"] = {{{"byteLength", buffer_.bytes.size()}}};
        write_gltf_file(in_, root_, buffer_.bytes);
    }
    /// Returns the mesh of a primitive with all vertices split: each corner has its own vertex with
    /// a different normal.
    static FramedMesh all_corners_apart(const Mesh& mesh) {
        FramedMesh framed;
        std::vector<std::uint32_t> place(mesh.positions.size(), 0);
        for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
            framed.source_vertex.push_back(i);
        std::vector<bool> is_taken(mesh.positions.size(), false);
        for (glm::uvec3 triangle : mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t vertex = triangle[k];
                if (is_taken[vertex]) {
                    triangle[k] = static_cast<std::uint32_t>(framed.source_vertex.size());
                    framed.source_vertex.push_back(vertex);
                }
                is_taken[vertex] = true;
            }
            framed.mesh.triangles.push_back(triangle);
        }
        for (const std::uint32_t source : framed.source_vertex) {
            framed.mesh.positions.push_back(mesh.positions[source]);
            framed.mesh.normals.emplace_back(static_cast<float>(framed.mesh.normals.size()), 1, 0);
            framed.mesh.tangents.emplace_back(1, 0, 0, -1);
        }
        return framed;
    }
    /// Returns frames without a split.
    static FramedMesh with_normals(Mesh mesh, const glm::vec3& normal) {
        FramedMesh framed;
        mesh.normals.assign(mesh.positions.size(), normal);
        for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
            framed.source_vertex.push_back(i);
        framed.mesh = std::move(mesh);
        return framed;
    }
    GltfDocument read(const std::filesystem::path& file) {
        return GltfDocument::read(file, report_);
    }
    GltfContents contents(const std::filesystem::path& file) { return read_gltf(file, report_); }

    test::TemporaryDirectory folder_;
    std::filesystem::path in_ = folder_ / "in.glb";
    std::filesystem::path out_ = folder_ / "out.glb";
    json root_;
    Buffer buffer_;
    Report report_;
};

TEST_F(GltfFrames, ASplitCarriesEveryAttributeInItsOwnType) {
    make_quad();
    GltfDocument document = read(in_);
    const FramedMesh framed = all_corners_apart(document.mesh({0, 0}));
    ASSERT_EQ(framed.source_vertex.size(), 6U);
    document.set_frames({0, 0}, framed);
    const Mesh mesh = document.mesh({0, 0});
    EXPECT_EQ(mesh.triangles, framed.mesh.triangles);
    EXPECT_EQ(mesh.positions, framed.mesh.positions);
    EXPECT_EQ(mesh.normals, framed.mesh.normals);
    EXPECT_EQ(mesh.tangents, framed.mesh.tangents);
    EXPECT_EQ(mesh.texcoords[5], mesh.texcoords[framed.source_vertex[5]]);
    document.write(out_);

    const GltfContents written = contents(out_);
    const json& primitive = written.root["meshes"][0]["primitives"][0];
    const auto check = [&](const json& index, int component_type, bool is_fraction,
                           const std::vector<std::string>& elements) {
        const json& stored = written.root["accessors"][index.get<std::size_t>()];
        EXPECT_EQ(stored["componentType"], component_type);
        EXPECT_EQ(stored.value("normalized", false), is_fraction);
        const std::string raw = raw_elements(written, index.get<std::size_t>());
        std::string expected;
        for (const std::uint32_t source : framed.source_vertex)
            expected += elements[source];
        EXPECT_EQ(raw, expected);
    };
    const auto floats = [](float x, float y, float z) {
        const float values[] = {x, y, z};
        return std::string(reinterpret_cast<const char*>(values), 12);
    };
    check(primitive["attributes"]["_FOUR"], 5121, false,
          {"\1\2\3\4", "\5\6\7\10", "\11\12\13\14", "\15\16\17\20"});
    check(primitive["attributes"]["_ID"], 5121, false, {"\25", "\26", "\27", "\30"});
    check(primitive["attributes"]["TEXCOORD_0"], 5123, true,
          {std::string("\0\0\0\0", 4), std::string("\xFF\xFF\0\0", 4), "\xFF\xFF\xFF\xFF",
           std::string("\0\0\xFF\xFF", 4)});
    check(primitive["targets"][0]["POSITION"], 5126, false,
          {floats(0, 0, 1), floats(0, 0, 2), floats(0, 0, 3), floats(0, 0, 4)});
    const json& positions =
        written.root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(positions["name"], "corners");
    EXPECT_EQ(positions["max"], json({1, 1, 0}));
    // Everything else was replaced. The accessors are POSITION, NORMAL, TANGENT, TEXCOORD_0,
    // _FOUR, _ID, the target and the indices.
    EXPECT_EQ(written.root["accessors"].size(), 8U);
    EXPECT_EQ(written.root["bufferViews"].size(), 8U);
    EXPECT_EQ(test::unreferenced_bytes(out_), 6U * 3);  // The padding of _ID.
}

TEST_F(GltfFrames, UnchangedFramesChangeNothing) {
    make_quad();
    GltfDocument document = read(in_);
    FramedMesh framed;
    framed.mesh = document.mesh({0, 0});
    framed.source_vertex = {0, 1, 2, 3};
    document.set_frames({0, 0}, framed);
    document.write(out_);
    EXPECT_EQ(contents(out_).root, contents(in_).root);
}

TEST_F(GltfFrames, WithoutASplitOnlyTheFramesAreReplaced) {
    make_quad();
    GltfDocument document = read(in_);
    document.set_frames({0, 0}, with_normals(document.mesh({0, 0}), {0, 1, 0}));
    document.write(out_);
    const GltfContents before = contents(in_);
    const GltfContents after = contents(out_);
    json expected = test::meaning_of(in_);
    json actual = test::meaning_of(out_);
    json& new_normals = actual["meshes"][0]["primitives"][0]["attributes"]["NORMAL"];
    EXPECT_EQ(new_normals["componentType"], 5126);
    new_normals = expected["meshes"][0]["primitives"][0]["attributes"]["NORMAL"];
    expected.erase("accessors");
    actual.erase("accessors");
    EXPECT_EQ(actual, expected);
    EXPECT_EQ(after.root["accessors"].size(), before.root["accessors"].size());
    // 16 bytes of quantized normals are gone, and 48 of float ones were added.
    EXPECT_EQ(after.buffers[0].size, (before.buffers[0].size + 3) / 4 * 4 - 16 + 48);
}

TEST_F(GltfFrames, FramesCanBeReplacedAgainAndAgain) {
    make_quad();
    GltfDocument document = read(in_);
    document.set_frames({0, 0}, all_corners_apart(document.mesh({0, 0})));
    document.write(out_);
    const std::size_t size = contents(out_).buffers[0].size;
    for (int i = 0; i < 3; ++i) {
        const glm::vec3 normal = i == 2 ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
        document.set_frames({0, 0}, with_normals(document.mesh({0, 0}), normal));
    }
    document.write(out_);
    EXPECT_EQ(contents(out_).buffers[0].size, size);
    EXPECT_EQ(read(out_).mesh({0, 0}).normals[0], glm::vec3(0, 0, 1));
}

TEST_F(GltfFrames, RemovingTangentsRemovesTheirDisplacementsToo) {
    make_quad();
    root_["accessors"].push_back(accessor(3, 5121, 4, "VEC4"));
    root_["accessors"].back()["normalized"] = true;
    json& primitive = root_["meshes"][0]["primitives"][0];
    primitive["attributes"]["TANGENT"] = 7;
    primitive["targets"][0]["TANGENT"] = 4;
    finish();
    GltfDocument document = read(in_);
    FramedMesh framed = with_normals(document.mesh({0, 0}), {0, 0, 1});
    framed.mesh.tangents.clear();
    document.set_frames({0, 0}, framed);
    document.write(out_);
    const json after = contents(out_).root["meshes"][0]["primitives"][0];
    EXPECT_FALSE(after["attributes"].contains("TANGENT"));
    EXPECT_FALSE(after["targets"][0].contains("TANGENT"));
    // _FOUR and the POSITION of the target shared the bytes of the accessors, and they are still
    // there.
    EXPECT_TRUE(after["attributes"].contains("_FOUR"));
    EXPECT_TRUE(after["targets"][0].contains("POSITION"));
}

TEST_F(GltfFrames, InterleavedAttributesMoveTogether) {
    std::vector<float> rows;
    for (int i = 0; i < 3; ++i) {
        const float x = static_cast<float>(i);
        rows.insert(rows.end(), {x, x * x, 0, 0, 0, 1, x, 0});
    }
    root_["bufferViews"] = {buffer_.view(rows, 32), buffer_.view<float>({7, 7, 7})};
    root_["accessors"] = {accessor(0, 5126, 3, "VEC3"), accessor(0, 5126, 3, "VEC3"),
                          accessor(0, 5126, 3, "VEC2"), accessor(1, 5126, 1, "VEC3")};
    root_["accessors"][1]["byteOffset"] = 12;
    root_["accessors"][2]["byteOffset"] = 24;
    root_["meshes"] = json::parse(
        R"([{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]}])");
    finish();
    GltfDocument document = read(in_);
    const Mesh before = document.mesh({0, 0});
    document.set_frames({0, 0}, with_normals(before, {0, 1, 0}));
    document.write(out_);
    const Mesh after = read(out_).mesh({0, 0});
    EXPECT_EQ(after.positions, before.positions);
    EXPECT_EQ(after.texcoords, before.texcoords);
    EXPECT_EQ(after.normals[2], glm::vec3(0, 1, 0));
    EXPECT_EQ(contents(out_).buffers[0].size, 3U * 32 + 12);
    EXPECT_EQ(test::unreferenced_bytes(out_), 0U);
}

TEST_F(GltfFrames, OtherUsersOfAnAccessorKeepTheirData) {
    make_quad();
    root_["meshes"].push_back(root_["meshes"][0]);
    root_["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
    finish();
    GltfDocument document = read(in_);
    const Mesh other = document.mesh({1, 0});
    document.set_frames({0, 0}, all_corners_apart(document.mesh({0, 0})));
    document.write(out_);
    const Mesh after = read(out_).mesh({1, 0});
    EXPECT_EQ(after.positions, other.positions);
    EXPECT_EQ(after.normals, other.normals);
    EXPECT_EQ(after.triangles, other.triangles);
}

TEST_F(GltfFrames, EqualResultsShareNewAccessors) {
    make_quad();
    root_["meshes"].push_back(root_["meshes"][0]);
    root_["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
    finish();
    GltfDocument document = read(in_);
    for (std::size_t i = 0; i < 2; ++i)
        document.set_frames({i, 0}, with_normals(document.mesh({i, 0}), {0, 1, 0}));
    document.write(out_);
    const json meshes = contents(out_).root["meshes"];
    EXPECT_EQ(meshes[0], meshes[1]);
    EXPECT_EQ(contents(out_).root["accessors"].size(), 7U);
}

TEST_F(GltfFrames, PrimitiveTakesOnlyItsSharedVertices) {
    root_["bufferViews"] = {
        buffer_.view<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5, 6, 5, 5, 5, 7, 5}),
        buffer_.view<std::uint16_t>({0, 1, 2}), buffer_.view<std::uint16_t>({5, 3, 4})};
    root_["accessors"] = {accessor(0, 5126, 6, "VEC3"), accessor(1, 5123, 3, "SCALAR"),
                          accessor(2, 5123, 3, "SCALAR")};
    root_["accessors"][0]["min"] = {0, 0, 0};
    root_["accessors"][0]["max"] = {6, 7, 5};
    root_["meshes"] = json::parse(R"([{"primitives": [
        {"attributes": {"POSITION": 0}, "indices": 1},
        {"attributes": {"POSITION": 0}, "indices": 2}]}])");
    finish();
    GltfDocument document = read(in_);
    EXPECT_THAT(document.mesh({0, 1}).positions,
                ElementsAre(glm::vec3(5), glm::vec3(6, 5, 5), glm::vec3(5, 7, 5)));
    EXPECT_THAT(document.mesh({0, 1}).triangles, ElementsAre(glm::uvec3(2, 0, 1)));
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::vec3 normal(0, static_cast<float>(i), 1);
        document.set_frames({0, i}, with_normals(document.mesh({0, i}), normal));
    }
    document.write(out_);
    const GltfContents written = contents(out_);
    const json& second = written.root["meshes"][0]["primitives"][1];
    const json& positions =
        written.root["accessors"][second["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(positions["count"], 3);
    EXPECT_EQ(positions["min"], json({5, 5, 5}));
    EXPECT_EQ(written.root["accessors"].size(), 6U);
    // Two times three vertices of two vectors, and two times three indices with padding.
    EXPECT_EQ(written.buffers[0].size, 2U * (3 * 24 + 8));
}

TEST_F(GltfFrames, UnknownExtensionsKeepAllAccessors) {
    make_quad();
    root_["extensionsUsed"] = {"FOO_bar"};
    root_["nodes"][0]["extensions"]["FOO_bar"] = {{"accessor", 1}};
    finish();
    GltfDocument document = read(in_);
    document.set_frames({0, 0}, all_corners_apart(document.mesh({0, 0})));
    document.write(out_);
    const GltfContents before = contents(in_);
    const GltfContents after = contents(out_);
    for (std::size_t i = 0; i < before.root["accessors"].size(); ++i) {
        EXPECT_EQ(raw_elements(after, i), raw_elements(before, i));
    }
}

TEST_F(GltfFrames, CompressedCopiesAreRemovedWithTheirOriginals) {
    make_quad();
    root_["bufferViews"].push_back(buffer_.view<std::uint8_t>(std::vector<std::uint8_t>(400, 7)));
    root_["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    root_["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 7}, {"attributes", {{"POSITION", 0}}}};
    // A view in between forces the one behind to move.
    root_["bufferViews"].push_back(buffer_.view<std::uint8_t>({1, 2, 3, 4}));
    root_["images"] = {{{"bufferView", 8}, {"mimeType", "image/png"}}};
    finish();
    GltfDocument document = read(in_);
    document.set_frames({0, 0}, with_normals(document.mesh({0, 0}), {0, 1, 0}));
    document.write(out_);
    const GltfContents after = contents(out_);
    EXPECT_FALSE(after.root["meshes"][0]["primitives"][0].contains("extensions"));
    EXPECT_EQ(after.root["extensionsUsed"], json::array({"KHR_mesh_quantization"}));
    EXPECT_LT(after.buffers[0].size, 400U);
    EXPECT_EQ(test::meaning_of(out_)["images"], test::meaning_of(in_)["images"]);
}

TEST_F(GltfFrames, IndicesTakeTheSmallestTypeThatLeavesTheRestartValueFree) {
    for (const std::size_t count : {65535U, 65536U}) {
        MeshFile file;
        for (std::size_t i = 0; i < count; ++i) {
            file.mesh.positions.emplace_back(static_cast<float>(i), i % 2, i % 3);
        }
        file.mesh.triangles = {{0, 1, static_cast<std::uint32_t>(count - 2)}};
        GltfDocument document = GltfDocument::from_mesh(file);
        FramedMesh framed = with_normals(document.mesh({0, 0}), {0, 0, 1});
        framed.mesh.triangles[0].z = static_cast<std::uint32_t>(count - 1);
        document.set_frames({0, 0}, framed);
        document.write(out_);
        const json root = contents(out_).root;
        const auto indices = root["meshes"][0]["primitives"][0]["indices"].get<std::size_t>();
        EXPECT_EQ(root["accessors"][indices]["componentType"], count == 65535 ? 5123 : 5125);
        EXPECT_EQ(read(out_).mesh({0, 0}).triangles, framed.mesh.triangles);
    }
}

TEST_F(GltfFrames, FramesOfAnotherMeshAreRefused) {
    make_quad();
    GltfDocument document = read(in_);
    FramedMesh framed = with_normals(document.mesh({0, 0}), {0, 0, 1});
    framed.source_vertex[2] = 4;
    EXPECT_THROW(document.set_frames({0, 0}, framed), InvalidInput);
    framed.source_vertex.pop_back();
    EXPECT_THROW(document.set_frames({0, 0}, framed), InvalidInput);
    EXPECT_THROW(document.set_frames({0, 7}, framed), InvalidInput);
}

TEST_F(GltfFrames, MirroringNodesDoNotAffectObjectSpace) {
    // glTF reverses the winding of the triangles of a node with negative scale. The mesh keeps its
    // winding and its frames.
    RELIEF_NEEDS_SHARED(folder, "data/models/gltf-ext/misc");
    const auto processed = [&](const char* name) {
        GltfDocument document = read(folder / name);
        const FramedMesh framed =
            with_frames(document.mesh({0, 0}), {.normals = NormalWeight::angle}, report_);
        document.set_frames({0, 0}, framed);
        document.write(out_);
        return read(out_).mesh({0, 0});
    };
    const Mesh plain = processed("one_face_123.gltf");
    const Mesh mirrored = processed("one_face_123_mirror.gltf");
    EXPECT_EQ(mirrored.triangles, plain.triangles);
    EXPECT_EQ(mirrored.positions, plain.positions);
    EXPECT_EQ(mirrored.normals, plain.normals);
    EXPECT_EQ(contents(out_).root["nodes"],
              contents(folder / "one_face_123_mirror.gltf").root["nodes"]);
}

/// Processes every primitive as relief-mesh does and compares everything except frames.
void process_and_compare(const std::filesystem::path& file, const std::filesystem::path& out,
                         NormalMode normals) {
    SCOPED_TRACE(file);
    Report report;
    GltfDocument document = GltfDocument::read(file, report);
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Mesh mesh = document.mesh(id);
        FrameOptions options;
        options.normals = normals;
        options.if_missing = NormalMode::flat;
        options.tangents = mesh.texcoords.empty() ? TangentMethod::none : TangentMethod::mikktspace;
        const FramedMesh framed = with_frames(mesh, options, report);
        document.set_frames(id, framed);
        const Mesh stored = document.mesh(id);
        EXPECT_EQ(stored.triangles, framed.mesh.triangles) << document.describe(id);
        EXPECT_EQ(stored.texcoords, framed.mesh.texcoords) << document.describe(id);
        EXPECT_EQ(stored.colors, framed.mesh.colors) << document.describe(id);
        const auto same_bits = [&](const auto& a, const auto& b) {
            return a.size() == b.size() &&
                   (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
        };
        EXPECT_TRUE(same_bits(stored.positions, framed.mesh.positions)) << document.describe(id);
        EXPECT_TRUE(same_bits(stored.normals, framed.mesh.normals)) << document.describe(id);
        EXPECT_TRUE(same_bits(stored.tangents, framed.mesh.tangents)) << document.describe(id);
    }
    Report repairs;
    document.write(out, repairs);
    if (repairs.empty()) {
        EXPECT_TRUE(test::meaning_beside_meshes(out) == test::meaning_beside_meshes(file));
    }
    // Each accessor may need three bytes of padding, and each byte-sized element, too.
    const GltfContents written = read_gltf(out, report);
    std::size_t padding = 4 * array_in(written.root, "bufferViews").size();
    for (const Json& accessor : array_in(written.root, "accessors")) {
        if (element_layout(accessor).size % 4 != 0) padding += 3 * size_in(accessor, "count");
    }
    EXPECT_LE(test::unreferenced_bytes(out), test::unreferenced_bytes(file) + padding);
}

TEST_LABELS(slow);
TEST_F(GltfFrames, ProcessingRealModelsLeavesNoUnusedData) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    int processed = 0;
    for (const auto& file : test::gltf_files_below(models)) {
        try {
            read(file);
        } catch (const FileError&) {
            continue;  // gltf_document_test.cpp lists these files.
        }
        for (const NormalMode normals : {NormalMode::flat, NormalMode(NormalWeight::angle)}) {
            process_and_compare(file, out_, normals);
        }
        ++processed;
    }
    EXPECT_EQ(processed, 102);
}

}  // namespace
}  // namespace relief
