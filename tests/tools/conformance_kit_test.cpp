// SPDX-License-Identifier: Apache-2.0
// The conformance kit itself: its files are what its program writes, its expected results have a
// second witness, and it tells sound bases from broken ones.
#include "conformance_kit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "conformance_judge.h"
#include "relief/mesh/tangents.h"
#include "support/shapes.h"
#include "support/shared_data.h"
#include "tools/run_program.h"
#include "tools/tangent_definition.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using test::Twist;

const fs::path kit_folder = test::source_directory() / "conformance/kit";

const std::vector<KitMesh>& kit() {
    static const std::vector<KitMesh> meshes = read_kit(kit_folder);
    return meshes;
}

std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Three vertices for every triangle, with a tangent each.
Mesh loose(const Mesh& mesh, const std::vector<glm::vec4>& tangents) {
    Mesh result = test::soup(mesh);
    result.tangents = tangents;
    return result;
}

std::vector<glm::vec4> relief_tangents(const Mesh& mesh) {
    Report ignored;
    return mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                               ignored);
}

/// The plain definition does not cover these (tangent_definition.h).
bool is_beyond_the_definition(const KitMesh& mesh) {
    return mesh.name == "degenerate" || mesh.name == "non-manifold" || mesh.name == "folded-back" ||
           mesh.name == "folded-over";
}

TEST(ConformanceKit, IsWhatItsProgramWrites) {
    const test::TemporaryDirectory folder;
    const test::ProgramResult result =
        test::run_program({"relief-make-conformance-kit", "again"}, folder.path());
    ASSERT_EQ(result.exit_code, 0) << result.error;
    std::set<std::string> written;
    for (const auto& entry : fs::directory_iterator(folder / "again"))
        written.insert(entry.path().filename().string());
    EXPECT_EQ(written.size(), 42U) << "40 meshes, one of them as quads too, and the list";
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(kit_folder)) {
        bytes += entry.file_size();
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() == ".f32") continue;
        EXPECT_EQ(written.erase(name), 1U) << name;
        EXPECT_TRUE(bytes_of(entry.path()) == bytes_of(folder / "again" / name)) << name;
    }
    EXPECT_THAT(written, testing::IsEmpty()) << "not in the kit";
    EXPECT_LT(bytes, 500'000U) << "small enough to keep anywhere";
    EXPECT_EQ(test::run_program({"relief-make-conformance-kit"}, folder.path()).exit_code, 2);
}

TEST(ConformanceKit, JudgesNearlyAllCornersOfItsMeshes) {
    std::map<std::string, std::size_t> not_judged;
    std::size_t judged = 0;
    for (const KitMesh& mesh : kit()) {
        for (const glm::vec4& expected : mesh.expected) {
            ++judged;
            if (expected.w == 0.0F) ++not_judged[mesh.name];
        }
    }
    EXPECT_EQ(judged, 8853U);
    // Only where the reference contradicts itself.
    EXPECT_THAT(not_judged, testing::ElementsAre(testing::Pair("degenerate", 40),
                                                 testing::Pair("non-manifold", 90),
                                                 testing::Pair("scrambled", 2)));
}

TEST(ConformanceKit, AgreesWithThePlainDefinitionInDoublePrecision) {
    std::size_t checked = 0;
    for (const KitMesh& mesh : kit()) {
        if (mesh.group == KitGroup::stability || is_beyond_the_definition(mesh)) continue;
        const Judgement judgement =
            judge(mesh, loose(mesh.mesh, test::tangents_by_definition(mesh.mesh)));
        EXPECT_TRUE(judgement.passes(mesh.group))
            << mesh.name << ": " << judgement.other_sign << " signs, " << judgement.too_far
            << " directions, at most " << judgement.degrees.max << " degrees";
        checked += judgement.judged;
    }
    EXPECT_EQ(checked, 7855U);
}

TEST(ConformanceKit, IsPassedByReliefOnEveryMesh) {
    for (const KitMesh& mesh : kit()) {
        const Judgement judgement = judge(mesh, loose(mesh.mesh, relief_tangents(mesh.mesh)));
        EXPECT_TRUE(judgement.passes(mesh.group)) << mesh.name;
        EXPECT_LE(judgement.degrees.max, 1e-4) << mesh.name;
    }
}

TEST(ConformanceKit, FindsHandednessOfTheOtherConvention) {
    for (const KitMesh& mesh : kit()) {
        if (mesh.group == KitGroup::stability) continue;
        std::vector<glm::vec4> tangents = relief_tangents(mesh.mesh);
        for (glm::vec4& tangent : tangents)
            tangent.w = -tangent.w;
        const Judgement judgement = judge(mesh, loose(mesh.mesh, tangents));
        EXPECT_FALSE(judgement.passes(mesh.group)) << mesh.name;
        EXPECT_EQ(judgement.other_sign, judgement.judged) << mesh.name;
        EXPECT_EQ(judgement.too_far, 0U) << mesh.name;
    }
}

/// The meshes that a twisted basis does not pass.
std::set<std::string> failed_by(Twist twist) {
    std::set<std::string> failed;
    for (const KitMesh& mesh : kit()) {
        if (mesh.group != KitGroup::conformance || is_beyond_the_definition(mesh)) continue;
        const auto tangents = test::tangents_by_definition(mesh.mesh, twist);
        if (!judge(mesh, loose(mesh.mesh, tangents)).passes(mesh.group)) failed.insert(mesh.name);
    }
    return failed;
}

TEST(ConformanceKit, FindsTangentsAveragedAcrossMirrors) {
    EXPECT_THAT(failed_by(Twist::across_mirrors),
                testing::ElementsAre("hills-mirrored", "scrambled", "torus-mirrored"));
}

TEST(ConformanceKit, FindsWeightsOfArea) {
    const auto failed = failed_by(Twist::area_weights);
    for (const char* name : {"sphere", "torus-mirrored", "fan", "scrambled", "sheared", "quads"})
        EXPECT_EQ(failed.count(name), 1U) << name;
    EXPECT_EQ(failed.count("facets"), 0U) << "where nothing is averaged";
}

/// One tangent for each stored vertex: that of its last corner.
TEST(ConformanceKit, FindsCornersPutBackOnTheirOldVertices) {
    for (const KitMesh& mesh : kit()) {
        if (mesh.name != "torus-mirrored") continue;
        const std::vector<glm::vec4> tangents = relief_tangents(mesh.mesh);
        Mesh theirs = mesh.mesh;
        theirs.tangents.resize(theirs.positions.size());
        for (std::size_t corner = 0; corner < tangents.size(); ++corner)
            theirs.tangents[theirs.triangles[corner / 3][static_cast<int>(corner % 3)]] =
                tangents[corner];
        const Judgement judgement = judge(mesh, theirs);
        EXPECT_GT(judgement.other_sign, 0U);
        EXPECT_GT(judgement.mixed, 0U) << "triangles with two handednesses";
        EXPECT_FALSE(judgement.passes(mesh.group));
    }
}

}  // namespace
}  // namespace relief::tools
