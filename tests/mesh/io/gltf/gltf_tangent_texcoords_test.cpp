// SPDX-License-Identifier: Apache-2.0
// Which texture coordinate set a primitive's tangents belong to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf_semantics.h"
#include "relief/mesh/error.h"
#include "relief/mesh/gltf_document.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

/// A document with a primitive of one triangle that has these sets and this material.
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

TEST_F(GltfTangentTexcoordsTest, TheNormalTextureSaysWhich) {
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

TEST_F(GltfTangentTexcoordsTest, TurningAndMirroringAreSaid) {
    EXPECT_FALSE(of(two_, transformed({{"rotation", 0.0}})).is_turned);
    EXPECT_FALSE(of(two_, transformed({{"rotation", 6.2831853}})).is_turned) << "a full turn";
    EXPECT_FALSE(of(two_, transformed({{"scale", {0.25, 8}}})).is_turned);
    EXPECT_TRUE(of(two_, transformed({{"rotation", 1.5707963}})).is_turned);
    EXPECT_TRUE(of(two_, transformed({{"rotation", 3.1415927}})).is_turned) << "half a turn";
    EXPECT_TRUE(of(two_, transformed({{"rotation", -0.01}})).is_turned);
    EXPECT_TRUE(of(two_, transformed({{"scale", {-1, 1}}})).is_turned);
    EXPECT_TRUE(of(two_, transformed({{"scale", {1, -2}}})).is_turned);
}

TEST_F(GltfTangentTexcoordsTest, OtherTexturesInTangentSpaceStandIn) {
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

TEST_F(GltfTangentTexcoordsTest, WhatIsNoTextureIsRefused) {
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
