// SPDX-License-Identifier: Apache-2.0
// Another mesh in the place of a primitive's: what is written, what goes, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

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
using testing::HasSubstr;

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
