// SPDX-License-Identifier: Apache-2.0
// Meshes in glTF documents: a new document of a mesh (vertices, ranges, materials, images), and a
// mesh that replaces that of a primitive.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "gltf_semantics.h"
#include "relief/mesh/error.h"
#include "relief/mesh/gltf_document.h"
#include "support/message_of.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
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

TEST_F(GltfFromMesh, AMeshComesBackBitForBit) {
    MeshFile file{test::sphere(24, 12), {}};
    file.mesh.name = "ball";
    file.mesh.colors.assign(file.mesh.positions.size(), glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    file.mesh.tangents.assign(file.mesh.positions.size(), glm::vec4(1, 0, 0, -1));
    file.mesh.positions.emplace_back(std::numeric_limits<float>::infinity());  // Isolated.
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
    EXPECT_EQ(normals[2], glm::vec3(0.0F));
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
    EXPECT_EQ(result.base_color, glm::vec4(0.5F, 0.25F, 1.0F, 0.75F));  // glTF ends at 1.
    EXPECT_EQ(result.metallic, 0.0F);
    EXPECT_FLOAT_EQ(result.roughness, 0.25F);  // (2 / 512)^(1/4)
    EXPECT_EQ(result.emission, glm::vec3(0, 4, 2));
    EXPECT_EQ(result.alpha_mode, GltfMaterial::AlphaMode::blend);
    // And back: what OBJ can hold is the same.
    const MtlMaterial back = flattened(written(file)).materials.at(0);
    EXPECT_FLOAT_EQ(back.shininess, 510.0F);
    EXPECT_EQ(back.opacity, 0.75F);
    EXPECT_EQ(back.emission, material.emission);
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
    EXPECT_EQ(view.materials[1].base_color_texture->image, 0U);
    EXPECT_EQ(view.materials[0].emission, glm::vec3(1.0F));
    std::ifstream stream(folder_ / "a.glb", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    EXPECT_THAT(bytes.substr(0, 4096), HasSubstr("\"mimeType\":\"image/jpeg\""));
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
    EXPECT_FALSE(view.materials[1].base_color_texture);
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

TEST(GltfGeometry, IsReplacedAndNothingDeadStaysBehind) {
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

TEST(GltfGeometry, WhatAMeshCannotTakeOverIsRefusedAndStays) {
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

}  // namespace

}  // namespace relief
