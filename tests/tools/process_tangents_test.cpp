// SPDX-License-Identifier: Apache-2.0
// The tangents of `relief-mesh process`: their texture coordinates, and the rules of glTF.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "relief/mesh/gltf_document.h"
#include "support/invariants.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::degrees_between;
using test::expect_refusal;
using test::ProgramResult;
using test::Workplace;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// The tolerance of float tangents that are read from a file.
constexpr double tangent_tolerance = 1e-4;

/// The offsets of the attributes in the file below.
enum Accessor { position, normal, tangent, set_0, set_1, lift };

/// A glTF file with a triangle in the xy plane. The texture coordinates of set 0 grow with x, those
/// of set 1 with y. It has a morph target, and tangents along (0,0,1), which match no set.
class ProcessTangents : public testing::Test {
  protected:
    void write(json attributes, const json& material = {}, const json& targets = {}) {
        write_all(json::array({primitive(std::move(attributes), material, targets)}), material);
    }
    static json primitive(json attributes, const json& material = {}, const json& targets = {}) {
        json result = {{"attributes", std::move(attributes)}};
        if (!material.is_null()) result["material"] = 0;
        if (!targets.is_null()) result["targets"] = targets;
        return result;
    }
    void write_all(const json& primitives, const json& material = {}) {
        const std::vector<float> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0,           // position
                                            0, 0, 1, 0, 0, 1, 0, 0, 1,           // normal
                                            0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1,  // tangent
                                            0, 1, 1, 1, 0, 0,                    // set 0
                                            0, 0, 0, 1, 1, 0,                    // set 1
                                            0, 0, 0, 0, 0, 0, 0, 0, 1};          // lift
        const std::size_t lengths[] = {9, 9, 12, 6, 6, 9};
        const char* types[] = {"VEC3", "VEC3", "VEC4", "VEC2", "VEC2", "VEC3"};
        json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
        if (material.dump().find("KHR_texture_transform") != std::string::npos)
            root["extensionsUsed"] = {"KHR_texture_transform"};
        root["scenes"] = json::parse(R"([{"nodes": [0]}])");
        root["nodes"] = json::parse(R"([{"mesh": 0}])");
        root["buffers"][0] = {{"uri", "model.bin"}, {"byteLength", 4 * numbers.size()}};
        std::size_t offset = 0;
        for (std::size_t i = 0; i < 6; ++i) {
            root["bufferViews"].push_back(
                {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", 4 * lengths[i]}});
            root["accessors"].push_back(
                {{"bufferView", i}, {"componentType", 5126}, {"count", 3}, {"type", types[i]}});
            offset += 4 * lengths[i];
        }
        root["accessors"][0]["min"] = {0, 0, 0};
        root["accessors"][0]["max"] = {1, 1, 0};
        root["meshes"][0] = {{"name", "Tri"}, {"primitives", primitives}};
        if (!material.is_null()) root["materials"] = json::array({material});
        root["textures"] = json::parse(R"([{"source": 0}])");
        root["images"] = json::parse(R"([{"uri": "data:image/png;base64,AAAA"}])");
        workplace_.write("model.bin", std::string(reinterpret_cast<const char*>(numbers.data()),
                                                  4 * numbers.size()));
        workplace_.write("model.gltf", root.dump());
    }

    ProgramResult process(const std::string& options) const {
        return workplace_.run("relief-mesh process model.gltf out/model.glb --report out/r.json " +
                              options);
    }
    [[nodiscard]] json report() const { return json::parse(workplace_.read("out/r.json")); }
    [[nodiscard]] GltfDocument written() const {
        Report report;
        return GltfDocument::read(workplace_ / "out/model.glb", report);
    }
    /// Returns the first tangent of the output.
    [[nodiscard]] glm::vec4 first_tangent() const {
        const Mesh mesh = written().mesh({0, 0});
        return mesh.tangents.empty() ? glm::vec4(0.0F) : mesh.tangents.front();
    }

    const Workplace workplace_;
    const json both_ = {
        {"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", set_0}, {"TEXCOORD_1", set_1}};
};

void expect_along(const glm::vec4& tangent, const glm::vec3& direction, float w) {
    EXPECT_LT(degrees_between(glm::vec3(tangent), direction), tangent_tolerance);
    EXPECT_EQ(tangent.w, w);
}

TEST_F(ProcessTangents, ComeFromTheSetAskedFor) {
    write(both_);
    const ProgramResult first = process("--tangents mikktspace");
    ASSERT_EQ(first.exit_code, 0) << first.error;
    EXPECT_THAT(first.out, HasSubstr("tangents  computed, MikkTSpace, from texture coordinate set "
                                     "0 (the first)\n"));
    expect_along(first_tangent(), {1, 0, 0}, 1);
    const ProgramResult second = process("--tangents mikktspace --uv-set 1");
    ASSERT_EQ(second.exit_code, 0) << second.error;
    EXPECT_THAT(second.out, HasSubstr("from texture coordinate set 1 (requested)\n"));
    // u grows with y and v with x, so the image is rotated.
    expect_along(first_tangent(), {0, 1, 0}, 1);
    EXPECT_EQ(report()["options"]["uv_set"], 1);
    EXPECT_EQ(report()["primitives"][0]["texcoord_set"], 1);
    EXPECT_EQ(report()["primitives"][0]["texcoord_set_reason"], "requested");
    EXPECT_THAT(written().texcoord_sets({0, 0}), ElementsAre(0, 1)) << "all sets stay";
    EXPECT_EQ(written().mesh({0, 0}, 0).texcoords[1], glm::vec2(1, 1));
    EXPECT_EQ(written().mesh({0, 0}, 1).texcoords[1], glm::vec2(0, 1));
}

TEST_F(ProcessTangents, FollowTheNormalTextureByDefault) {
    write(both_, {{"normalTexture", {{"index", 0}, {"texCoord", 1}}}});
    const ProgramResult result = process("--tangents mikktspace --strict");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("from texture coordinate set 1 (of normalTexture)\n"));
    EXPECT_THAT(result.out, Not(HasSubstr("notes")));
    expect_along(first_tangent(), {0, 1, 0}, 1);
    EXPECT_THAT(report()["primitives"][0]["notes"], IsEmpty());

    const ProgramResult other = process("--tangents mikktspace --uv-set 0");
    ASSERT_EQ(other.exit_code, 0) << other.error;
    expect_along(first_tangent(), {1, 0, 0}, 1);
    EXPECT_THAT(other.out, HasSubstr("notes     mesh 'Tri' primitive 0: normalTexture uses texture "
                                     "coordinate set 1, the tangents use 0\n"));
}

TEST_F(ProcessTangents, OfNewNormalsUseTheSetOfTheNormalTexture) {
    json attributes = both_;
    attributes["TANGENT"] = tangent;
    write(attributes, {{"normalTexture", {{"index", 0}, {"texCoord", 1}}}});
    ASSERT_EQ(process("--normals angle").exit_code, 0);
    expect_along(first_tangent(), {0, 1, 0}, 1);
    ASSERT_EQ(process("--normals angle --uv-set 0").exit_code, 0);
    expect_along(first_tangent(), {1, 0, 0}, 1);
    ASSERT_EQ(process("").exit_code, 0);
    expect_along(first_tangent(), {0, 0, 1}, 1);
}

TEST_F(ProcessTangents, AreMadeByTheMethodNamed) {
    const std::vector<std::pair<std::string, std::string>> methods = {
        {"mikktspace", "MikkTSpace"}, {"area-weighted", "area-weighted"}, {"lengyel", "lengyel"}};
    std::set<std::string> contents;
    for (const auto& [word, words] : methods) {
        const ProgramResult result = workplace_.run(
            "relief-mesh process data/vase.obj out/vase.glb --report out/r.json --tangents " +
            word);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_THAT(result.out, HasSubstr("tangents  computed, " + words + "\n"));
        EXPECT_EQ(report()["options"]["tangents"], word);
        EXPECT_EQ(report()["primitives"][0]["tangent_method"], word);
        contents.insert(workplace_.read("out/vase.glb"));
    }
    EXPECT_EQ(contents.size(), 3U) << "each gives others";
    // With new normals, kept tangents are recomputed by MikkTSpace.
    ASSERT_EQ(workplace_
                  .run("relief-mesh process out/vase.glb out/new.glb --normals area --report "
                       "out/r.json")
                  .exit_code,
              0);
    EXPECT_EQ(report()["primitives"][0]["tangent_method"], "mikktspace");
}

TEST_F(ProcessTangents, UseStoredCoordinatesForAnyTransform) {
    const auto tangent_with = [&](const json& transform) {
        write(both_, {{"normalTexture",
                       {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}});
        const ProgramResult result = process("--tangents mikktspace --strict");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return first_tangent();
    };
    const auto notes = [&] { return report()["primitives"][0]["notes"].size(); };
    const glm::vec4 plain = tangent_with(json::object());
    EXPECT_EQ(notes(), 0U);
    EXPECT_EQ(tangent_with({{"scale", {3, 0.5}}, {"offset", {0.1, 0.2}}}), plain);
    EXPECT_EQ(notes(), 0U);
    EXPECT_EQ(tangent_with({{"rotation", 0.7}}), plain);
    EXPECT_EQ(notes(), 1U);
    EXPECT_EQ(tangent_with({{"scale", {-1, 1}}}), plain);
    EXPECT_THAT(report()["primitives"][0]["notes"][0].get<std::string>(),
                HasSubstr("rotates or mirrors normalTexture"));
    expect_along(tangent_with({{"texCoord", 1}}), {0, 1, 0}, 1);
}

TEST_F(ProcessTangents, OfMorphTargetsUseTheSameSet) {
    write(both_, {{"normalTexture", {{"index", 0}, {"texCoord", 1}}}},
          json::array({{{"POSITION", lift}}}));
    // The third corner moves to (0,1,1), and the tangent along y with it.
    ASSERT_EQ(process("--normals flat --tangents mikktspace").exit_code, 0);
    const std::string glb = workplace_.read("out/model.glb");
    EXPECT_THAT(glb, HasSubstr("TANGENT"));
    const ProgramResult back =
        workplace_.run("relief-mesh process out/model.glb out/back.gltf --report out/r.json");
    ASSERT_EQ(back.exit_code, 0) << back.error;
    const json root = json::parse(workplace_.read("out/back.gltf"));
    const std::size_t index = root["meshes"][0]["primitives"][0]["targets"][0]["TANGENT"];
    const json view =
        root["bufferViews"][root["accessors"][index]["bufferView"].get<std::size_t>()];
    const std::string bytes = workplace_.read("out/back.bin");
    glm::vec3 displacement;
    std::memcpy(&displacement, bytes.data() + view.value("byteOffset", 0), sizeof(displacement));
    EXPECT_LT(degrees_between(glm::vec3(0, 1, 0) + displacement, {0, 1, 1}), tangent_tolerance);
}

TEST_F(ProcessTangents, GivenWithoutNormalsAreIgnored) {
    write({{"POSITION", position}, {"TANGENT", tangent}, {"TEXCOORD_0", set_0}});
    const ProgramResult kept = process("--strict");
    EXPECT_EQ(kept.exit_code, 3) << "it is said";
    EXPECT_THAT(kept.out, HasSubstr("normals   computed, one per triangle\n"
                                    "tangents  computed, MikkTSpace\n"));
    EXPECT_THAT(kept.out, HasSubstr("tangents without normals (primitive 0): are ignored, as glTF "
                                    "requires, and recomputed\n"));
    expect_along(first_tangent(), {1, 0, 0}, 1);
    EXPECT_EQ(written().mesh({0, 0}).normals.front(), glm::vec3(0, 0, 1));
    EXPECT_EQ(process("--strict --tangents mikktspace").exit_code, 0) << "asked for: no fallback";
    EXPECT_EQ(process("--strict --tangents none").exit_code, 0);
}

TEST_F(ProcessTangents, GivenWithoutNormalsAndTexcoordsAreRemoved) {
    write({{"POSITION", position}, {"TANGENT", tangent}});
    const ProgramResult kept = process("--strict");
    EXPECT_EQ(kept.exit_code, 3);
    EXPECT_THAT(kept.out, HasSubstr("tangents  removed\n"));
    EXPECT_TRUE(written().mesh({0, 0}).tangents.empty());
}

TEST_F(ProcessTangents, AreKeptIfTheyCannotBeComputed) {
    write_all(
        json::array({primitive({{"POSITION", position}, {"NORMAL", normal}, {"TANGENT", tangent}}),
                     primitive(both_), primitive({{"POSITION", position}})}));
    const ProgramResult result = process("--tangents mikktspace");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    expect_along(first_tangent(), {0, 0, 1}, 1);
    expect_along(written().mesh({0, 1}).tangents.front(), {1, 0, 0}, 1);
    EXPECT_TRUE(written().mesh({0, 2}).tangents.empty());
    const json findings = report()["findings"];
    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(findings[0]["kind"], "primitive without texture coordinates");
    EXPECT_EQ(findings[0]["outcome"], "keeps its tangents");
    EXPECT_EQ(findings[1]["outcome"], "gets no tangents");
    // With new normals, old tangents cannot be kept.
    ASSERT_EQ(process("--tangents mikktspace --normals flat").exit_code, 0);
    EXPECT_TRUE(written().mesh({0, 0}).tangents.empty());
}

TEST_F(ProcessTangents, ReportAMissingSetOfAPrimitive) {
    write_all(json::array(
        {primitive(both_),
         primitive({{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", set_0}})}));
    const ProgramResult some = process("--tangents mikktspace --uv-set 1");
    ASSERT_EQ(some.exit_code, 0) << some.error;
    EXPECT_EQ(report()["findings"][0]["kind"],
              "primitive without the requested texture coordinate set");
    EXPECT_TRUE(written().mesh({0, 1}).tangents.empty());
}

TEST_F(ProcessTangents, RefuseASetThatNoPrimitiveHas) {
    write(both_);
    expect_refusal(workplace_, "relief-mesh",
                   {"relief-mesh process model.gltf out/old.glb --tangents mikktspace --uv-set 2",
                    1, "model.gltf: no primitive has texture coordinate set 2 (available: 0, 1)"},
                   "old.glb");
}

TEST_F(ProcessTangents, OfATextureOnAMissingSetUseTheFirst) {
    write({{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", set_0}},
          {{"normalTexture", {{"index", 0}, {"texCoord", 1}}}});
    const ProgramResult result = process("--tangents mikktspace --strict");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(report()["findings"][0]["kind"], "texture on a missing texture coordinate set");
    EXPECT_EQ(report()["primitives"][0]["texcoord_set_reason"], "the first");
    expect_along(first_tangent(), {1, 0, 0}, 1);
}

TEST_F(ProcessTangents, RefuseSetsWithoutEffect) {
    write(both_);
    workplace_.write_square("square.obj");
    for (const test::Refused& refused :
         {test::Refused{
              "relief-mesh process square.obj out/old.glb --tangents mikktspace --uv-set 1", 2,
              "--uv-set 1: square.obj: has only texture coordinate set 0 (only glTF "
              "has several)"},
          test::Refused{"relief-mesh process model.gltf out/old.glb --uv-set 1", 2,
                        "--uv-set 1: applies only to computed tangents (give --tangents "
                        "mikktspace)"},
          test::Refused{"relief-mesh process model.gltf out/old.glb --tangents none --uv-set 0", 2,
                        "--uv-set 0: applies only to computed tangents (give --tangents "
                        "mikktspace)"},
          test::Refused{
              "relief-mesh process model.gltf out/old.glb --tangents mikktspace --uv-set x", 2,
              "--uv-set x: not a whole number"}}) {
        SCOPED_TRACE(refused.line);
        expect_refusal(workplace_, "relief-mesh", refused, "old.glb");
    }
}

TEST(ProcessTangentsOfRealModels, BothSetsOfACubeGiveTangents) {
    RELIEF_NEEDS_SHARED(file, "data/models/gltf/MultiUVTest/glTF-Binary/MultiUVTest.glb");
    const Workplace workplace;
    Report report;
    std::vector<Mesh> results;
    for (const int set : {0, 1}) {
        const ProgramResult result = workplace.run(
            "relief-mesh process " + file.string() +
            " out/cube.glb --tangents mikktspace --strict --uv-set " + std::to_string(set));
        ASSERT_EQ(result.exit_code, 0) << result.error << result.out;
        const GltfDocument cube = GltfDocument::read(workplace / "out/cube.glb", report);
        EXPECT_THAT(cube.texcoord_sets({0, 0}), ElementsAre(0, 1));
        results.push_back(cube.mesh({0, 0}));
    }
    EXPECT_NE(results[0].tangents, results[1].tangents);
}

}  // namespace
}  // namespace relief::tools
