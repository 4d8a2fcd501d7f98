// SPDX-License-Identifier: Apache-2.0
// What relief-mesh check says of the basis of stored tangents.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

/// The vase with tangents by a method.
void write_vase(const Workplace& workplace, const std::string& method) {
    const ProgramResult result =
        workplace.run("relief-mesh process data/vase.obj out/vase.gltf --tangents " + method);
    ASSERT_EQ(result.exit_code, 0) << result.error;
}

json tangents_of(const Workplace& workplace, const std::string& file) {
    const ProgramResult result = workplace.run("relief-mesh check --json " + file);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return json::parse(result.out)["files"][0]["primitives"][0]["tangents"];
}

/// Negates the w of the first so many vertices of out/vase.gltf; 0: of all.
void negate_signs(const Workplace& workplace, std::size_t count) {
    const json root = json::parse(workplace.read("out/vase.gltf"));
    const std::size_t index = root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"];
    const json& accessor = root["accessors"][index];
    const json& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::string bytes = workplace.read("out/vase.bin");
    const std::size_t all = accessor["count"];
    for (std::size_t v = 0; v < (count == 0 ? all : count); ++v) {
        char* at = bytes.data() + view.value("byteOffset", std::size_t(0)) + 16 * v + 12;
        float w = 0.0F;
        std::memcpy(&w, at, sizeof(w));
        w = -w;
        std::memcpy(at, &w, sizeof(w));
    }
    workplace.write("out/vase.bin", bytes);
}

TEST(CheckTangents, EachMethodIsTold) {
    const Workplace workplace;
    for (const std::string method : {"mikktspace", "area-weighted", "lengyel"}) {
        write_vase(workplace, method);
        const json tangents = tangents_of(workplace, "out/vase.gltf");
        EXPECT_EQ(tangents["basis"], method);
        EXPECT_EQ(tangents["variant"], "");
        EXPECT_EQ(tangents["agreements"].size(), 4U);
        EXPECT_EQ(tangents["stored_bits"], 32);
        EXPECT_EQ(tangents["texcoord_set"], 0);
        const ProgramResult text = workplace.run("relief-mesh check out/vase.gltf");
        EXPECT_THAT(text.out, HasSubstr("\ntangents  mesh 'vase' primitive 0: " + method + ": "));
        EXPECT_THAT(text.out, HasSubstr(" corners within 0.1 degrees (half within 0.001, "));
    }
}

TEST(CheckTangents, NegatedSignsAreSaid) {
    const Workplace workplace;
    write_vase(workplace, "mikktspace");
    negate_signs(workplace, 0);
    EXPECT_EQ(tangents_of(workplace, "out/vase.gltf")["variant"], "w negated");
    EXPECT_THAT(workplace.run("relief-mesh check out/vase.gltf").out,
                HasSubstr("primitive 0: mikktspace, w negated: "));
    write_vase(workplace, "mikktspace");
    negate_signs(workplace, 200);
    const json some = tangents_of(workplace, "out/vase.gltf");
    EXPECT_EQ(some["variant"], "");
    EXPECT_GT(some["agreements"][0]["w_negated"].get<int>(), 600);
    EXPECT_THAT(workplace.run("relief-mesh check out/vase.gltf").out,
                HasSubstr("primitive 0: mikktspace, w negated at "));
}

TEST(CheckTangents, FilesWithoutHaveNoLine) {
    const Workplace workplace;
    EXPECT_THAT(workplace.run("relief-mesh check data/vase.obj").out, Not(HasSubstr("tangents  ")));
    EXPECT_EQ(tangents_of(workplace, "data/vase.obj"), json());
}

TEST(CheckTangents, PrimitivesOfWhichTheSameIsSaidShareALine) {
    const Workplace workplace;
    write_vase(workplace, "mikktspace");
    json document = json::parse(workplace.read("out/vase.gltf"));
    document["meshes"][0]["primitives"].push_back(document["meshes"][0]["primitives"][0]);
    workplace.write("out/vase.gltf", document.dump());
    const std::string text = workplace.run("relief-mesh check out/vase.gltf").out;
    EXPECT_THAT(text, HasSubstr("primitive 0 and 1 more alike: mikktspace: "));
    EXPECT_THAT(text, Not(HasSubstr("primitive 1")));
}

TEST(CheckTangents, OfRealModels) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    const Workplace workplace;
    const auto said_of = [&](const std::string& file) {
        return workplace.run("relief-mesh check " + (models / file).string()).out;
    };
    EXPECT_THAT(said_of("MultiUVTest/glTF-Binary/MultiUVTest.glb"),
                HasSubstr("mikktspace, of texture coordinate set 1: 36 of 36 corners within 0.1 "
                          "degrees"));
    EXPECT_THAT(said_of("TwoSidedPlane/glTF/TwoSidedPlane.gltf"),
                HasSubstr("mikktspace, w negated: 6 of 6 corners"));
    EXPECT_THAT(said_of("AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb"),
                HasSubstr("of unknown basis: without texture coordinates none can be told"));
    EXPECT_THAT(said_of("BoomBox/glTF/BoomBox.gltf"),
                HasSubstr("of unknown basis; nearest by far is mikktspace: "));
}

}  // namespace
}  // namespace relief::tools
