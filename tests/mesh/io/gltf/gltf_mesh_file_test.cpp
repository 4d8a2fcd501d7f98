// SPDX-License-Identifier: Apache-2.0
// Meshes in glTF documents: a new document of a mesh, a mesh that replaces a primitive, and round
// trips of all real models. The Khronos validator must find nothing new; it needs node and the
// folder of the npm package gltf-validator in $RELIEF_GLTF_VALIDATOR.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>

#include "files.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/model.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using nlohmann::json;
using test::message_of;
using test::TemporaryDirectory;
using testing::ElementsAre;
using testing::HasSubstr;

class GltfFromMesh : public testing::Test {
  protected:
    GltfDocument written(const MeshFile& file) {
        GltfDocument::from_mesh(file).write(folder_ / "a.glb");
        return GltfDocument::read(folder_ / "a.glb", report_);
    }
    test::TemporaryDirectory folder_;
    Report report_;
};

TEST_F(GltfFromMesh, WritingAMeshGivesTheBytesOfItsDocument) {
    MeshFile small{test::sphere(24, 12), {}};
    MeshFile large{test::sphere(300, 250), {}};
    ASSERT_GT(large.mesh.positions.size(), 0xFFFFU);
    MeshFile long_normals = large;
    long_normals.mesh.normals[7] *= 3.0F;
    MeshFile not_finite = large;
    not_finite.mesh.texcoords[5].x = std::numeric_limits<float>::quiet_NaN();
    MeshFile parts = large;
    parts.materials.resize(2);
    const auto triangles = static_cast<std::uint32_t>(large.mesh.triangles.size());
    parts.mesh.material_ranges = {{0, 1000, 1}, {1000, 0, 0}, {1000, triangles - 1000, 0}};
    MeshFile one_part = large;
    one_part.materials.resize(1);
    one_part.mesh.material_ranges = {{0, triangles, 0}};
    int number = 0;
    for (const MeshFile* file : {&small, &large, &long_normals, &not_finite, &parts, &one_part}) {
        SCOPED_TRACE(number++);
        Report of_document;
        GltfDocument::from_mesh(*file, of_document).write(folder_ / "document.glb");
        GltfDocument::write_mesh(folder_ / "mesh.glb", *file, report_);
        EXPECT_TRUE(read_file(folder_ / "mesh.glb") == read_file(folder_ / "document.glb"));
    }
}

TEST_F(GltfFromMesh, AMeshComesBackBitForBit) {
    MeshFile file{test::sphere(24, 12), {}};
    file.mesh.name = "ball";
    file.mesh.colors.assign(file.mesh.positions.size(), glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    file.mesh.tangents.assign(file.mesh.positions.size(), glm::vec4(1, 0, 0, -1));
    // An isolated vertex.
    file.mesh.positions.emplace_back(2.0F);
    file.mesh.normals.emplace_back(0, 0, 1);
    file.mesh.texcoords.emplace_back(0.5F);
    file.mesh.colors.emplace_back(1.0F);
    file.mesh.tangents.emplace_back(1, 0, 0, 1);
    const GltfDocument document = written(file);
    ASSERT_EQ(document.triangle_primitives().size(), 1U);
    EXPECT_EQ(document.describe({0, 0}), "mesh 'ball' primitive 0");
    const Mesh mesh = document.mesh({0, 0});
    EXPECT_EQ(mesh.positions, file.mesh.positions);
    EXPECT_EQ(mesh.normals, file.mesh.normals);
    EXPECT_EQ(mesh.texcoords, file.mesh.texcoords);
    EXPECT_EQ(mesh.tangents, file.mesh.tangents);
    EXPECT_EQ(mesh.colors, file.mesh.colors);
    EXPECT_EQ(mesh.triangles, file.mesh.triangles);
}

TEST_F(GltfFromMesh, EveryRangeIsAPrimitiveOverItsOwnVertices) {
    MeshFile file{test::cube(), {}};
    file.mesh.material_ranges = {{0, 2, 1U}, {2, 10, std::nullopt}};
    file.materials.resize(2);
    const GltfDocument document = written(file);
    ASSERT_EQ(document.triangle_primitives().size(), 2U);
    const Mesh first = document.mesh({0, 0});
    EXPECT_EQ(first.positions.size(), 4U);
    EXPECT_THAT(first.material_ranges, ElementsAre(MaterialRange{0, 2, 1U}));
    const Mesh second = document.mesh({0, 1});
    EXPECT_EQ(second.positions.size(), 20U);
    EXPECT_THAT(second.material_ranges, ElementsAre(MaterialRange{0, 10, std::nullopt}));
    EXPECT_EQ(second.positions[second.triangles[0].x],
              file.mesh.positions[file.mesh.triangles[2].x]);
}

TEST_F(GltfFromMesh, NormalsOfAnyLengthBecomeUnitAndUnitOnesKeepTheirBits) {
    MeshFile file{test::cube(), {}};
    file.mesh.normals[0] = {0, 6, 8};
    file.mesh.normals[1] = {0.57735F, 0.57735F, 0.57735F};
    file.mesh.normals[2] = {0, 0, 0};
    const std::vector<glm::vec3> normals = written(file).mesh({0, 0}).normals;
    EXPECT_EQ(normals[0], glm::vec3(0, 0.6F, 0.8F));
    EXPECT_EQ(normals[1], file.mesh.normals[1]);
    EXPECT_EQ(normals[2], glm::vec3(0, 0, 1)) << "glTF requires a direction";
}

TEST_F(GltfFromMesh, PhongMaterialsAreTranslated) {
    MeshFile file{test::cube(), {}};
    MtlMaterial material;
    material.name = "glow";
    material.diffuse = {0.5F, 0.25F, 2.0F};
    material.opacity = 0.75F;
    material.shininess = 510.0F;
    material.emission = {0, 4, 2};
    file.materials = {material};
    file.mesh.material_ranges = {{0, 12, 0U}};
    const GltfMaterial result = written(file).view().materials.at(0);
    EXPECT_EQ(result.name, "glow");
    EXPECT_EQ(result.metallic_roughness->base_color,
              glm::vec3(0.5F, 0.25F, 1.0F));  // glTF limits it to 1.
    EXPECT_EQ(result.opacity, 0.75F);
    EXPECT_EQ(result.metallic_roughness->metallic, 0.0F);
    EXPECT_FLOAT_EQ(result.metallic_roughness->roughness, 0.25F);  // (2 / 512)^(1/4).
    EXPECT_EQ(result.emission, glm::vec3(0, 4, 2));
    EXPECT_EQ(result.alpha_mode, AlphaMode::blend);
    // The conversion back gives the same values, as far as OBJ can hold them.
    const MtlMaterial back = flattened(written(file)).materials.at(0);
    EXPECT_FLOAT_EQ(back.shininess, 510.0F);
    EXPECT_EQ(back.opacity, 0.75F);
    EXPECT_EQ(back.emission, material.emission);
}

TEST_F(GltfFromMesh, OpacityMapsAreTheAlphaOfTheDiffuseMapOrReported) {
    MeshFile file{test::cube(), {}};
    MtlMaterial material;
    material.name = "leaf";
    material.diffuse_map = test::source_directory() / "data/bricks-diffuse.png";
    material.opacity_map = material.diffuse_map;
    file.materials = {material};
    file.mesh.material_ranges = {{0, 12, 0U}};
    const auto alpha_mode = [&] {
        report_ = Report();
        return GltfDocument::from_mesh(file, report_).view().materials.at(0).alpha_mode;
    };
    EXPECT_EQ(alpha_mode(), AlphaMode::blend);
    file.materials[0].opacity_map = "holes.png";
    EXPECT_EQ(alpha_mode(), AlphaMode::opaque);
    EXPECT_EQ(report_.count("map_d 'holes.png' of material 'leaf', which is not its map_Kd"), 1U);
    report_ = Report();
    map_model(file, ModelSpace::object, report_);
    EXPECT_EQ(report_.count("map_d 'holes.png' of material 'leaf', which is not its map_Kd"), 1U);
}

TEST_F(GltfFromMesh, ImagesAreEmbeddedOnceAsTheyAre) {
    RELIEF_NEEDS_SHARED(obj, "data/models/obj/spot/spot_triangulated.obj");
    RELIEF_NEEDS_SHARED(jpeg, "data/models/obj/fuze/fuze uv.jpg");
    MeshFile file = read_mesh(obj, report_);
    MtlMaterial material;
    material.diffuse_map = jpeg;
    material.emission_map = jpeg;
    file.materials = {material, material};
    file.mesh.material_ranges = {{0, static_cast<std::uint32_t>(file.mesh.triangles.size()), 0U}};
    const GltfView view = written(file).view();
    ASSERT_EQ(view.images.size(), 1U);
    EXPECT_EQ(std::get<std::vector<std::byte>>(view.images[0].source).size(),
              std::filesystem::file_size(jpeg));
    EXPECT_EQ(view.materials[1].diffuse_texture->image, 0U);
    EXPECT_EQ(view.materials[0].emission, glm::vec3(1.0F));
    std::ifstream stream(folder_ / "a.glb", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    EXPECT_THAT(bytes.substr(0, 4096), HasSubstr("\"mimeType\":\"image/jpeg\""));
}

TEST_F(GltfFromMesh, NamesOfImagesInLatin1BecomeUtf8) {
    const std::filesystem::path image = folder_ / "Stra\xDF.png";
    std::ofstream(image, std::ios::binary) << "\x89PNG\r\n\x1A\n";
    MeshFile file;
    file.mesh = test::grid(1);
    file.materials.resize(1);
    file.materials[0].diffuse_map = image;
    EXPECT_EQ(written(file).view().images.at(0).name, "Stra\xC3\x9F");
    Report report;
    GltfDocument document = GltfDocument::from_mesh(file, report);
    EXPECT_EQ(report.count("name that is not UTF-8"), 1U);
    document.set_texture(0, TextureSlot::emission, image, GltfImageStorage::embedded, report);
    EXPECT_EQ(report.count("name that is not UTF-8"), 2U);
    EXPECT_EQ(document.view().images.at(1).name, "Stra\xC3\x9F");
    document.add_material("\xDF");
    EXPECT_EQ(message_of<FileError>([&] { document.write(folder_ / "b.glb"); }),
              (folder_ / "b.glb").string() +
                  ": cannot be written: the document has a name that is not UTF-8");
}

TEST_F(GltfFromMesh, AFailureKeepsTheOldDocumentAndItsBuffer) {
    MeshFile file;
    file.mesh = test::grid(1);
    GltfDocument::from_mesh(file).write(folder_ / "a.gltf");
    const std::string text = read_file(folder_ / "a.gltf");
    const std::string buffer = read_file(folder_ / "a.bin");
    file.mesh = test::grid(2);
    GltfDocument document = GltfDocument::from_mesh(file);
    document.add_material("\xDF");
    EXPECT_THROW(document.write(folder_ / "a.gltf"), FileError);
    EXPECT_EQ(read_file(folder_ / "a.gltf"), text);
    EXPECT_EQ(read_file(folder_ / "a.bin"), buffer);
}

TEST_F(GltfFromMesh, ABufferOfTheDocumentThatWasReadIsNotReplacedByThatOfAnother) {
    MeshFile file;
    file.mesh = test::grid(1);
    GltfDocument::from_mesh(file).write(folder_ / "buffer.gltf");
    std::filesystem::rename(folder_ / "buffer.gltf", folder_ / "a.gltf");
    GltfDocument document = GltfDocument::read(folder_ / "a.gltf", report_);
    EXPECT_EQ(message_of<FileError>([&] { document.write(folder_ / "buffer.gltf"); }),
              fmt::format("{}: is a buffer of {}, which would be lost; use another name, or write "
                          ".glb",
                          (folder_ / "buffer.bin").string(), (folder_ / "a.gltf").string()));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "buffer.gltf"));
    document.write(folder_ / "b.gltf");
    document = GltfDocument::read(folder_ / "b.gltf", report_);
    document.write(folder_ / "b.gltf");
    EXPECT_EQ(document.triangle_primitives().size(), 1U);
    EXPECT_TRUE(report_.empty());
}

TEST_F(GltfFromMesh, WithAReportMissingImagesAreLeftOutAndNamed) {
    MeshFile file;
    file.mesh = test::grid(1);
    file.materials.resize(2);
    file.materials[1].name = "brick";
    file.materials[1].diffuse_map = folder_ / "none.png";
    file.materials[1].emission_map = folder_ / "none.png";
    file.materials[1].normal_map = folder_.path();
    Report report;
    const GltfView view = GltfDocument::from_mesh(file, report).view();
    EXPECT_TRUE(view.images.empty());
    ASSERT_EQ(view.materials.size(), 2U);
    EXPECT_FALSE(view.materials[1].diffuse_texture);
    EXPECT_EQ(view.materials[1].emission, glm::vec3(0.0F));
    ASSERT_EQ(report.findings().size(), 3U);
    EXPECT_EQ(to_string(report.findings()[0]),
              "1 x unreadable diffuse texture of material 'brick' (material 1): left out: " +
                  (folder_ / "none.png").string() + ": no such file");
    EXPECT_EQ(report.findings()[2].kind, "unreadable normal map of material 'brick'");
    EXPECT_EQ(report.findings()[2].outcome,
              "left out: " + folder_.path().string() + ": is not a file");
}

TEST_F(GltfFromMesh, MissingAndForeignImagesAreFileErrors) {
    MeshFile file{test::cube(), {}};
    file.materials.resize(1);
    file.materials[0].diffuse_map = folder_ / "none.png";
    EXPECT_THROW(GltfDocument::from_mesh(file), FileError);
    std::ofstream(folder_ / "a.tga") << "no image";
    file.materials[0].diffuse_map = folder_ / "a.tga";
    EXPECT_THROW(GltfDocument::from_mesh(file), FileError);
    EXPECT_THROW(GltfDocument::from_mesh({}), InvalidInput);
}

GltfDocument read(const std::filesystem::path& file) {
    Report report;
    return GltfDocument::read(file, report);
}

json parsed(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return json::parse(stream);
}

/// A document of one grid with a material, changed by `edit`.
GltfDocument grid_with(const TemporaryDirectory& folder, const std::function<void(json&)>& edit) {
    const std::filesystem::path file = folder / "grid.gltf";
    MeshFile contents{test::grid(2), {MtlMaterial{}}};
    contents.mesh.material_ranges = {{0, 8, 0U}};
    GltfDocument::from_mesh(contents).write(file);
    json root = parsed(file);
    edit(root);
    std::ofstream(file) << root;
    return read(file);
}

TEST(GltfGeometry, ReplacementLeavesNoUnusedData) {
    const TemporaryDirectory folder;
    GltfDocument document = grid_with(folder, [](json&) {});
    Mesh sphere = test::sphere(16, 8);
    sphere.colors.assign(sphere.positions.size(), glm::vec4(0.25F, 0.5F, 0.75F, 1.0F));
    document.set_geometry({0, 0}, sphere);
    document.write(folder / "out.gltf");

    const Mesh back = read(folder / "out.gltf").mesh({0, 0});
    EXPECT_EQ(back.positions, sphere.positions);
    EXPECT_EQ(back.normals, sphere.normals);
    EXPECT_EQ(back.texcoords, sphere.texcoords);
    EXPECT_EQ(back.colors, sphere.colors);
    EXPECT_EQ(back.triangles, sphere.triangles);
    ASSERT_EQ(back.material_ranges.size(), 1U);
    EXPECT_EQ(back.material_ranges[0].material, 0U) << "the material stays";

    const json root = parsed(folder / "out.gltf");
    EXPECT_EQ(root["accessors"].size(), 5U) << "four attributes and the indices";
    const std::size_t bytes = sphere.positions.size() * (12 + 12 + 8 + 16);
    EXPECT_EQ(root["buffers"][0]["byteLength"], bytes + sphere.triangles.size() * 12);
    EXPECT_FLOAT_EQ(root["accessors"][root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
                                          .get<std::size_t>()]["max"][1],
                    1.0F);
}

TEST(GltfGeometry, RefusesUnsupportedPrimitives) {
    const auto refusal = [](const std::function<void(json&)>& edit) {
        const TemporaryDirectory folder;
        GltfDocument document = grid_with(folder, edit);
        const std::string message = message_of<InvalidInput>([&] {
            document.set_geometry({0, 0}, test::sphere(8, 4));
        });
        EXPECT_EQ(document.mesh({0, 0}).positions, test::grid(2).positions) << "untouched";
        return message;
    };
    const auto primitive = [](json& root) -> json& { return root["meshes"][0]["primitives"][0]; };
    EXPECT_THAT(refusal([&](json& root) {
                    json& attributes = primitive(root)["attributes"];
                    attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"];
                }),
                HasSubstr("has TEXCOORD_1, which another mesh cannot take over"));
    EXPECT_THAT(refusal([&](json& root) {
                    const json position = primitive(root)["attributes"]["POSITION"];
                    primitive(root)["targets"] = json::array({{{"POSITION", position}}});
                }),
                HasSubstr("has morph targets, which another mesh cannot take over"));
    const TemporaryDirectory folder;
    GltfDocument document = grid_with(folder, [](json&) {});
    EXPECT_EQ(message_of<InvalidInput>([&] {
                  document.set_geometry({0, 0}, {});
              }),
              "the mesh has no triangle");
}

/// Parses the JSON of a file without the reader of relief.
Json json_in(const std::filesystem::path& file) {
    const std::string bytes = read_file(file);
    if (!bytes.starts_with("glTF")) return Json::parse(bytes);
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 12, sizeof(size));
    return Json::parse(bytes.substr(20, size));
}

/// Removes the parts of the JSON that joined buffers and decoding change.
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

/// Removes the members for compression, and the bounds that Draco widens.
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

/// Removes min and max of accessors and returns the number of accessors that had them.
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

/// Returns all models except those that must be refused.
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

TEST_LABELS(not_sanitized);
TEST_F(GltfRoundTrip, CopiesHaveEveryPropertyAndEveryValue) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    std::size_t accessors = 0;
    for (const auto& file : readable_models(models)) {
        SCOPED_TRACE(file);
        const auto out = folder_ / "out.glb";
        Report repairs;
        GltfDocument::read(file, report_).write(out, repairs);
        if (!repairs.empty()) continue;  // The file has faults that glTF forbids.
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
    EXPECT_EQ(accessors, 1113U);
}

/// Returns every attribute of a primitive at every corner of its triangles, except frames.
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

/// Returns the corners of the triangles of a primitive as vertices of its accessors.
std::vector<std::uint32_t> corners_of(const GltfContents& contents, GltfPrimitiveId id) {
    std::vector<std::uint32_t> corners;
    for (const glm::uvec3& t : read_triangles(contents, id).triangles)
        corners.insert(corners.end(), {t.x, t.y, t.z});
    return corners;
}

/// Returns the values of all accessors of points, lines, animations and skins.
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

TEST_LABELS(not_sanitized);
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
                mesh.texcoords.empty() ? TangentMethod::none : TangentMethod::mikktspace};
            document.set_frames(id, with_frames(mesh, options, report_), options, report_);
        }
        Report repairs;
        document.write(out, repairs);
        if (repairs.empty()) {
            EXPECT_TRUE(beside_triangles(out) == beside_triangles(file));
        }
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

/// Returns the output of a command and its exit status.
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
        command_ = fmt::format(
            "node {} --module {}",
            quoted_for_shell(test::source_directory() / "scripts/dev/validate-gltf.mjs"),
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
                options.normals = count % 2 == 0 ? NormalWeight::angle : NormalMode::flat;
                options.tangents =
                    mesh.texcoords.empty() ? TangentMethod::none : TangentMethod::mikktspace;
                document.set_frames(id, with_frames(mesh, options, report_), options, report_);
            }
            const auto out = folder_ / fmt::format("{}.glb", count++);
            document.write(out);
            pairs +=
                fmt::format(" --baseline {} {}", quoted_for_shell(file), quoted_for_shell(out));
        } catch (const FileError&) {
            continue;  // gltf_document_test.cpp lists these files.
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
            file.mesh.texcoords.empty() ? TangentMethod::none : TangentMethod::mikktspace;
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
