// SPDX-License-Identifier: Apache-2.0
// Round trips of all real models. The JSON is compared property by property, parsed from the files;
// accessors are compared by value. The Khronos validator must find nothing new in processed models
// and new documents; it needs node and the folder of the npm package gltf-validator in
// $RELIEF_GLTF_VALIDATOR.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>

#include "file_bytes.h"
#include "gltf_semantics.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_reader.h"
#include "relief/mesh/error.h"
#include "relief/mesh/gltf_document.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

/// The JSON as it stands in a file, past all of relief's own reading.
Json json_in(const std::filesystem::path& file) {
    const std::string bytes = read_file(file);
    if (!bytes.starts_with("glTF")) return Json::parse(bytes);
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 12, sizeof(size));
    return Json::parse(bytes.substr(20, size));
}

/// Takes out of a file's JSON what joining its buffers changes, and what decoding does.
Json without_layout(Json root) {
    for (const char* key : {"buffers", "bufferViews"})
        root.erase(key);
    const auto erase = [](Json& object, std::initializer_list<const char*> keys) {
        for (const char* key : keys)
            object.erase(key);
    };
    for (auto& accessor : root["accessors"]) {
        erase(accessor, {"bufferView", "byteOffset"});
        if (!accessor.contains("sparse")) continue;
        erase(accessor["sparse"]["indices"], {"bufferView", "byteOffset"});
        erase(accessor["sparse"]["values"], {"bufferView", "byteOffset"});
    }
    for (auto& image : root["images"])
        erase(image, {"bufferView", "uri", "mimeType"});
    if (root["accessors"].is_null()) root.erase("accessors");
    if (root["images"].is_null()) root.erase("images");
    return root;
}

bool is_compression(const Json& name) {
    const std::string text = name;
    return text.ends_with("_compression");
}

/// Takes out what says that something is compressed, and the bounds that Draco widens.
Json without_compression(Json root) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        if (!root.contains(list)) continue;
        Json kept = Json::array();
        for (const Json& name : root[list]) {
            if (!is_compression(name)) kept.push_back(name);
        }
        root[list] = kept;
        if (kept.empty()) root.erase(list);
    }
    for (Json& mesh : root["meshes"]) {
        for (Json& primitive : mesh["primitives"]) {
            const bool is_draco =
                find(primitive, "extensions", "KHR_draco_mesh_compression") != nullptr;
            if (!is_draco) continue;
            primitive["extensions"].erase("KHR_draco_mesh_compression");
            if (primitive["extensions"].empty()) primitive.erase("extensions");
        }
    }
    return root;
}

/// Drops min and max of accessors, and says how many had them.
std::size_t drop_bounds(Json& root) {
    std::size_t count = 0;
    if (!root.contains("accessors")) return count;
    for (Json& accessor : root["accessors"])
        count += accessor.erase("min") + accessor.erase("max");
    return count;
}

bool has_draco(const std::filesystem::path& file) {
    return json_in(file).dump().find("KHR_draco_mesh_compression") != std::string::npos;
}

/// Models that are read: all but those that must be refused.
std::vector<std::filesystem::path> readable_models(const std::filesystem::path& models) {
    std::vector<std::filesystem::path> files;
    for (const auto& file : test::gltf_files_below(models)) {
        const std::string name = file.stem().string();
        if (name != "Compatibility_04" && name != "Compatibility_05") files.push_back(file);
    }
    return files;
}

class GltfRoundTrip : public testing::Test {
  protected:
    test::TemporaryDirectory folder_;
    Report report_;
};

TEST_F(GltfRoundTrip, CopiesHaveEveryPropertyAndEveryValue) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    std::size_t accessors = 0;
    for (const auto& file : readable_models(models)) {
        SCOPED_TRACE(file);
        const auto out = folder_ / "out.glb";
        GltfDocument::read(file, report_).write(out);
        Json before = without_compression(without_layout(json_in(file)));
        Json after = without_layout(json_in(out));
        if (has_draco(file)) {
            EXPECT_EQ(drop_bounds(before), drop_bounds(after));
        }
        EXPECT_EQ(Json::diff(before, after), Json::array());
        const GltfContents from = read_gltf(file, report_);
        const GltfContents to = read_gltf(out, report_);
        ASSERT_EQ(array_in(from.root, "accessors").size(), array_in(to.root, "accessors").size());
        for (std::size_t i = 0; i < array_in(from.root, "accessors").size(); ++i) {
            ASSERT_TRUE(raw_elements(from, i) == raw_elements(to, i)) << "accessor " << i;
            ++accessors;
        }
    }
    EXPECT_EQ(accessors, 1179U);
}

/// Every attribute of a primitive at every corner of its triangles, but for frames.
std::map<std::string, std::string> corner_values(const GltfContents& contents,
                                                 const Json& primitive,
                                                 const std::vector<std::uint32_t>& corners) {
    std::map<std::string, std::string> values;
    const auto add = [&](const Json& attributes, const std::string& prefix) {
        for (const auto& [name, accessor] : attributes.items()) {
            if (name == "NORMAL" || name == "TANGENT") continue;
            const auto number = accessor.get<std::size_t>();
            const Json& accessor_json = contents.root["accessors"][number];
            const std::string all = raw_elements(contents, number);
            const std::size_t size = element_layout(accessor_json).size;
            std::string& at_corners = values[fmt::format(
                "{}{} {} {} {}", prefix, name, accessor_json["type"].get<std::string>(),
                accessor_json["componentType"].get<int>(), bool_in(accessor_json, "normalized"))];
            for (const std::uint32_t vertex : corners)
                at_corners += all.substr(vertex * size, size);
        }
    };
    add(primitive["attributes"], "");
    for (std::size_t i = 0; i < array_in(primitive, "targets").size(); ++i)
        add(primitive["targets"][i], fmt::format("target {} ", i));
    return values;
}

/// The corners of a primitive's triangles as vertices of its accessors.
std::vector<std::uint32_t> corners_of(const GltfContents& contents, GltfPrimitiveId id) {
    std::vector<std::uint32_t> corners;
    for (const glm::uvec3& t : read_triangles(contents, id).triangles)
        corners.insert(corners.end(), {t.x, t.y, t.z});
    return corners;
}

/// All accessors that primitives of points and lines, animations and skins use, as values.
Json beside_triangles(const std::filesystem::path& file) {
    Json root = test::meaning_of(file);
    root.erase("accessors");
    if (!root.contains("meshes")) return root;
    for (Json& mesh : root["meshes"]) {
        for (Json& primitive : mesh["primitives"]) {
            if (size_in(primitive, "mode", 4) < 4) continue;
            for (const char* key : {"attributes", "indices", "mode", "targets"})
                primitive.erase(key);
        }
    }
    return root;
}

TEST_F(GltfRoundTrip, ProcessingChangesFramesAndNothingElseAtAnyCorner) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    const auto out = folder_ / "out.glb";
    std::size_t primitives = 0;
    for (const auto& file : readable_models(models)) {
        SCOPED_TRACE(file);
        GltfDocument document = GltfDocument::read(file, report_);
        const auto ids = document.triangle_primitives();
        for (const GltfPrimitiveId id : ids) {
            const Mesh mesh = document.mesh(id);
            const FrameOptions options{
                NormalMode::flat, NormalMode::flat,
                mesh.texcoords.empty() ? TangentMode::none : TangentMode::mikktspace};
            document.set_frames(id, with_frames(mesh, options, report_), options, report_);
        }
        document.write(out);
        EXPECT_TRUE(beside_triangles(out) == beside_triangles(file));
        const GltfContents before = read_gltf(file, report_);
        const GltfContents after = read_gltf(out, report_);
        for (const GltfPrimitiveId id : ids) {
            EXPECT_TRUE(corner_values(before, primitive_json(before, id), corners_of(before, id)) ==
                        corner_values(after, primitive_json(after, id), corners_of(after, id)))
                << document.describe(id);
            ++primitives;
        }
    }
    EXPECT_EQ(primitives, 452U);
}

/// What a command prints, and its exit status.
std::pair<std::string, int> output_of(const std::string& command) {
    std::string text;
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr)
        text += part.data();
    return {text, ::pclose(pipe)};
}

std::string quoted_for_shell(const std::filesystem::path& path) {
    std::string text = "'";
    for (const char c : path.string())
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
    return text;
}

class GltfValidator : public testing::Test {
  protected:
    void SetUp() override {
        const char* module = std::getenv("RELIEF_GLTF_VALIDATOR");
        if (module == nullptr) GTEST_SKIP() << "needs $RELIEF_GLTF_VALIDATOR and node";
        command_ =
            fmt::format("node {} --module {}",
                        quoted_for_shell(test::source_directory() / "scripts/validate-gltf.mjs"),
                        quoted_for_shell(module));
        if (output_of("node --version").second != 0) GTEST_SKIP() << "needs node";
    }
    std::string command_;
    test::TemporaryDirectory folder_;
    Report report_;
};

TEST_F(GltfValidator, ProcessedModelsHaveNoNewErrorsOrWarnings) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    std::string pairs;
    int count = 0;
    for (const auto& file : test::gltf_files_below(models)) {
        try {
            GltfDocument document = GltfDocument::read(file, report_);
            for (const GltfPrimitiveId id : document.triangle_primitives()) {
                const Mesh mesh = document.mesh(id);
                FrameOptions options;
                options.normals = count % 2 == 0 ? NormalMode::angle : NormalMode::flat;
                options.tangents =
                    mesh.texcoords.empty() ? TangentMode::none : TangentMode::mikktspace;
                document.set_frames(id, with_frames(mesh, options, report_), options, report_);
            }
            const auto out = folder_ / fmt::format("{}.glb", count++);
            document.write(out);
            pairs +=
                fmt::format(" --baseline {} {}", quoted_for_shell(file), quoted_for_shell(out));
        } catch (const FileError&) {
            continue;  // gltf_document_test.cpp knows which these are.
        }
    }
    const auto [text, status] = output_of(command_ + pairs);
    EXPECT_EQ(status, 0) << text;
    EXPECT_EQ(count, 102);
}

TEST_F(GltfValidator, MadeDocumentsAreValid) {
    RELIEF_NEEDS_SHARED(objects, "data/models/obj");
    std::string files;
    int count = 0;
    for (const char* name : {"fuze/fuze.obj", "spot/spot_quadrangulated.obj", "pirate.obj",
                             "teapot.obj", "tinyobj/cornell_box.obj"}) {
        MeshFile file = read_mesh(objects / name, report_);
        FrameOptions options;
        options.tangents =
            file.mesh.texcoords.empty() ? TangentMode::none : TangentMode::mikktspace;
        file.mesh = with_frames(std::move(file.mesh), options, report_).mesh;
        const auto out = folder_ / fmt::format("{}.glb", count++);
        GltfDocument::from_mesh(file).write(out);
        files += fmt::format(" {}", quoted_for_shell(out));
    }
    const auto [text, status] = output_of(command_ + files);
    EXPECT_EQ(status, 0) << text;
}

}  // namespace

}  // namespace relief
