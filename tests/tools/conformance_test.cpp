// SPDX-License-Identifier: Apache-2.0
// The judgment of hand-made meshes, the files of the conformance kit, and the command
// `relief-mesh conformance`.
#include "conformance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "relief/mesh/tangents.h"
#include "support/shapes.h"
#include "support/shared_data.h"
#include "tools/tangent_definition.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ProgramResult;
using test::Twist;
using test::Workplace;
using testing::HasSubstr;

/// Returns a square of two triangles with an upright image.
KitMesh square(KitGroup group = KitGroup::conformance) {
    KitMesh kit;
    kit.name = "square";
    kit.group = group;
    kit.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    kit.mesh.normals.assign(4, {0, 0, 1});
    kit.mesh.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    kit.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    kit.expected.assign(6, {1, 0, 0, 1});
    return kit;
}

/// Returns the mesh with the expected tangents.
Mesh answer_to(const KitMesh& kit) {
    Mesh mesh = kit.mesh;
    mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
    return mesh;
}

TEST(ConformanceJudge, PassesExpectedTangents) {
    const KitMesh kit = square();
    const Judgment judgment = judge(kit, answer_to(kit));
    EXPECT_TRUE(judgment.passes(kit.group));
    EXPECT_EQ(judgment.corners, 6U);
    EXPECT_EQ(judgment.judged, 6U);
    EXPECT_EQ(judgment.degrees.max, 0.0);
}

TEST(ConformanceJudge, FindsTrianglesInAnyOrderBegunAnywhereWithMinusZeros) {
    const KitMesh kit = square();
    Mesh theirs = answer_to(kit);
    theirs.positions[0] = {-0.0F, 0.0F, -0.0F};
    theirs.texcoords[1].y = 1.0F;
    theirs.triangles = {{2, 3, 0}, {1, 2, 0}};
    const Judgment judgment = judge(kit, theirs);
    EXPECT_EQ(judgment.judged, 6U);
    EXPECT_TRUE(judgment.passes(kit.group));
}

TEST(ConformanceJudge, ListsMissingAndExtraCorners) {
    const KitMesh kit = square();
    Mesh theirs = answer_to(kit);
    theirs.triangles = {{0, 1, 2}, {0, 1, 3}};
    const Judgment judgment = judge(kit, theirs);
    EXPECT_EQ(judgment.missing, 3U);
    EXPECT_EQ(judgment.extra, 3U);
    EXPECT_EQ(judgment.judged, 3U);
    EXPECT_FALSE(judgment.passes(kit.group));
    theirs.triangles = {{0, 2, 1}, {0, 2, 3}};
    EXPECT_EQ(judge(kit, theirs).missing, 3U) << "the other way round";
}

TEST(ConformanceJudge, LetsTrianglesWithoutAreaBeLeftOut) {
    KitMesh kit = square();
    kit.mesh.triangles.emplace_back(0, 1, 1);
    kit.expected.resize(9, {1, 0, 0, 1});
    Mesh theirs = answer_to(kit);
    theirs.triangles.pop_back();
    const Judgment judgment = judge(kit, theirs);
    EXPECT_EQ(judgment.omitted, 3U);
    EXPECT_EQ(judgment.missing, 0U);
    EXPECT_TRUE(judgment.passes(kit.group));
}

TEST(ConformanceJudge, DistinguishesEqualTrianglesByNormals) {
    KitMesh kit = square();
    for (std::uint32_t v = 0; v < 3; ++v) {
        kit.mesh.positions.push_back(kit.mesh.positions[v]);
        kit.mesh.texcoords.push_back(kit.mesh.texcoords[v]);
        kit.mesh.normals.emplace_back(0.6F, 0, 0.8F);
    }
    kit.mesh.triangles.emplace_back(4, 5, 6);
    kit.expected.resize(9, {0.8F, 0, -0.6F, 1});
    Mesh theirs = answer_to(kit);
    for (std::size_t v = 4; v < 7; ++v)
        theirs.tangents[v] = {0.8F, 0, -0.6F, 1};
    std::swap(theirs.triangles[0], theirs.triangles[2]);
    EXPECT_TRUE(judge(kit, theirs).passes(kit.group));
}

TEST(ConformanceJudge, CountsEveryFault) {
    const KitMesh kit = square();
    const auto judged = [&](const glm::vec4& tangent) {
        Mesh theirs = answer_to(kit);
        theirs.tangents[1] = tangent;  // This changes one of six corners.
        const Judgment judgment = judge(kit, theirs);
        EXPECT_FALSE(judgment.passes(kit.group));
        return judgment;
    };
    EXPECT_EQ(judged({std::numeric_limits<float>::quiet_NaN(), 0, 0, 1}).not_finite, 1U);
    EXPECT_EQ(judged({1.01F, 0, 0, 1}).not_unit, 1U);
    EXPECT_EQ(judged({0.8F, 0, 0.6F, 1}).not_perpendicular, 1U);
    EXPECT_EQ(judged({1, 0, 0, 0.5F}).invalid_sign, 1U);
    EXPECT_EQ(judged({1, 0, 0, -1}).other_sign, 1U);
    EXPECT_EQ(judged({1, 0, 0, -1}).mixed_signs, 3U) << "all corners of its triangle";
    const Judgment off = judged({std::cos(0.0002F), std::sin(0.0002F), 0, 1});
    EXPECT_EQ(off.too_far, 1U) << "0.0115 degrees";
    EXPECT_NEAR(off.degrees.max, 0.01146, 1e-4);
    EXPECT_NEAR(off.degrees.mean, 0.01146 / 6, 1e-4);
    EXPECT_EQ(off.worst_corner, 1U);
    Mesh near = answer_to(kit);
    near.tangents[1] = {std::cos(0.00017F), std::sin(0.00017F), 0, 1};
    EXPECT_TRUE(judge(kit, near).passes(kit.group)) << "0.0097 degrees";
}

TEST(ConformanceJudge, ChecksOnlyUsabilityOnHardMeshes) {
    KitMesh kit = square(KitGroup::stability);
    kit.expected.clear();
    Mesh theirs = answer_to(kit);
    theirs.tangents.assign(4, {0, 1, 0, -1});
    EXPECT_TRUE(judge(kit, theirs).passes(kit.group)) << "any direction in the plane";
    theirs.tangents[2] = {0, 1, 2e-6F, -1};
    EXPECT_EQ(judge(kit, theirs).not_perpendicular, 2U);
    kit.mesh.normals.assign(4, {0, 0, 0});
    EXPECT_TRUE(judge(kit, theirs).passes(kit.group)) << "a normal without direction binds nothing";
}

TEST(ConformanceJudge, PassesOverCornersThatTheKitExcuses) {
    KitMesh kit = square();
    kit.expected[1] = glm::vec4(0.0F);
    Mesh theirs = answer_to(kit);
    theirs.tangents[1] = {0, 1, 0, 1};
    const Judgment judgment = judge(kit, theirs);
    EXPECT_EQ(judgment.judged, 5U);
    EXPECT_TRUE(judgment.passes(kit.group));
}

void process_kit(const Workplace& workplace) {
    const ProgramResult result = workplace.run(
        "relief-mesh process conformance/kit/*.glb -o out/kit/ --tangents mikktspace --quiet");
    ASSERT_EQ(result.exit_code, 0) << result.error;
}

TEST(ConformanceCommand, ReliefConforms) {
    const Workplace workplace;
    process_kit(workplace);
    const ProgramResult result = workplace.run("relief-mesh conformance out/kit --strict");
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_EQ(result.error, "");
    EXPECT_THAT(result.out,
                HasSubstr("sphere                  conforms: 672 of 672 corners compared, "
                          "error in degrees: mean "));
    EXPECT_THAT(result.out, HasSubstr("unsorted-bucket         defect corrected: "));
    EXPECT_THAT(result.out,
                HasSubstr("verdict   conforms on 23 of 23 meshes; usable tangents on 16 "
                          "of 16 hard ones\n"));
    const json report = json::parse(workplace.run("relief-mesh conformance out/kit --json").out);
    EXPECT_EQ(report["conforms"], true);
    EXPECT_EQ(report["stable"], true);
    EXPECT_EQ(report["meshes"].size(), 40U);
    EXPECT_EQ(report["meshes"][1]["name"], "sphere");
    EXPECT_EQ(report["meshes"][1]["group"], "conformance");
    EXPECT_EQ(report["meshes"][1]["judged"], 672);
    EXPECT_LT(report["meshes"][1]["degrees"]["max"], 1e-4);
    EXPECT_FALSE(report["meshes"][39].contains("degrees")) << "nothing to compare with";
}

TEST(ConformanceCommand, AcceptsTriangulatedQuads) {
    const Workplace workplace;
    process_kit(workplace);
    const ProgramResult quads = workplace.run(
        "relief-mesh process conformance/kit/quads.obj out/kit/quads.glb --tangents mikktspace "
        "--quiet");
    ASSERT_EQ(quads.exit_code, 0) << quads.error;
    const ProgramResult result = workplace.run("relief-mesh conformance out/kit");
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_THAT(result.out, HasSubstr("quads                   conforms: 384 of 384 corners"));
}

TEST(ConformanceCommand, ExitsWith1IfTangentsDiffer) {
    const Workplace workplace;
    process_kit(workplace);
    std::filesystem::copy_file(workplace / "conformance/kit/sphere.glb",
                               workplace / "out/kit/sphere.glb",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::copy_file(workplace / "out/kit/fan.glb", workplace / "out/kit/facets.glb",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::remove(workplace / "out/kit/soup.glb");
    std::ofstream(workplace / "out/kit/quads.glb") << "glTF";
    const ProgramResult result = workplace.run("relief-mesh conformance out/kit");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, HasSubstr("sphere                  NOT COMPARED: has no tangents\n"));
    EXPECT_THAT(result.out, HasSubstr("facets                  DIFFERS: 0 of 294 corners compared; "
                                      "294 missing, 450 not in this mesh\n"));
    EXPECT_THAT(
        result.out,
        HasSubstr("soup                    NOT COMPARED: there is no soup.glb or soup.gltf\n"));
    EXPECT_THAT(result.out, HasSubstr("quads                   NOT COMPARED: out/kit/quads.glb: "));
    EXPECT_THAT(result.out, HasSubstr("verdict   DIFFERS on 4 of 23 meshes;"));
    const json report = json::parse(workplace.run("relief-mesh conformance out/kit --json").out);
    EXPECT_EQ(report["tool"], "relief-mesh conformance");
    EXPECT_EQ(report["conforms"], false);
    EXPECT_EQ(report["meshes"][1]["error"], "has no tangents");
}

TEST(ConformanceCommand, IsStrictAboutHardMeshesWhenAsked) {
    const Workplace workplace;
    process_kit(workplace);
    std::filesystem::remove(workplace / "out/kit/slivers.glb");
    EXPECT_EQ(workplace.run("relief-mesh conformance out/kit --quiet").exit_code, 0);
    const ProgramResult strict = workplace.run("relief-mesh conformance out/kit --quiet --strict");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_EQ(strict.out, "");
    EXPECT_EQ(strict.error,
              "relief-mesh: warning: 1 mesh with unusable tangents (exit code 3, because of "
              "--strict)\n");
}

TEST(ConformanceCommand, NamesTheFoldersOfKitAndResults) {
    const Workplace workplace;
    EXPECT_EQ(workplace.run("relief-mesh conformance out --kit data").error,
              "relief-mesh: error: data/kit.json: cannot be read (--kit names the folder of the "
              "kit: conformance/kit of relief's sources)\n");
    const ProgramResult result = workplace.run("relief-mesh conformance nowhere");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error,
              "relief-mesh: error: nowhere: no such folder (it must contain the program's output "
              "for each mesh of the kit, with the same names)\n");
    EXPECT_EQ(workplace.run("relief-mesh conformance out --json --quiet").exit_code, 2);
}

TEST(ConformanceCommand, RefusesAKitThatIsNone) {
    const Workplace workplace;
    std::filesystem::create_directory(workplace / "kit");
    const auto error_of = [&](const std::string& list) {
        workplace.write("kit/kit.json", list);
        return workplace.run("relief-mesh conformance out --kit kit").error;
    };
    EXPECT_THAT(error_of("{"), HasSubstr("kit/kit.json: "));
    EXPECT_THAT(error_of(R"({"format":2})"), HasSubstr("is of another format than 1"));
    EXPECT_THAT(error_of(R"({"format":1,"meshes":[{"name":"a","group":"odd","about":""}]})"),
                HasSubstr("group: not one of conformance, defect, stability"));
    std::filesystem::copy_file(workplace / "conformance/kit/fan.glb", workplace / "kit/fan.glb");
    workplace.write("kit/fan.f32", "short");
    EXPECT_THAT(error_of(R"({"format":1,"meshes":[{"name":"fan","group":"defect","about":""}]})"),
                HasSubstr("kit/fan.f32: does not contain 450 tangents of 16 bytes"));
}

const fs::path kit_folder = test::source_directory() / "conformance/kit";

const std::vector<KitMesh>& kit() {
    static const std::vector<KitMesh> meshes = read_kit(kit_folder);
    return meshes;
}

std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Returns a mesh with three vertices and tangents per triangle.
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

/// Meshes outside of the plain definition (tangent_definition.h).
bool is_beyond_the_definition(const KitMesh& mesh) {
    return mesh.name == "degenerate" || mesh.name == "non-manifold" || mesh.name == "folded-back" ||
           mesh.name == "folded-over";
}

TEST(ConformanceKit, MatchesItsGenerator) {
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
    // The excluded corners are those on which the reference contradicts itself.
    EXPECT_THAT(not_judged, testing::ElementsAre(testing::Pair("degenerate", 40),
                                                 testing::Pair("non-manifold", 90),
                                                 testing::Pair("scrambled", 2)));
}

TEST(ConformanceKit, AgreesWithThePlainDefinitionInDoublePrecision) {
    std::size_t checked = 0;
    for (const KitMesh& mesh : kit()) {
        if (mesh.group == KitGroup::stability || is_beyond_the_definition(mesh)) continue;
        const Judgment judgment =
            judge(mesh, loose(mesh.mesh, test::tangents_by_definition(mesh.mesh)));
        EXPECT_TRUE(judgment.passes(mesh.group))
            << mesh.name << ": " << judgment.other_sign << " signs, " << judgment.too_far
            << " directions, at most " << judgment.degrees.max << " degrees";
        checked += judgment.judged;
    }
    EXPECT_EQ(checked, 7855U);
}

TEST(ConformanceKit, IsPassedByReliefOnEveryMesh) {
    for (const KitMesh& mesh : kit()) {
        const Judgment judgment = judge(mesh, loose(mesh.mesh, relief_tangents(mesh.mesh)));
        EXPECT_TRUE(judgment.passes(mesh.group)) << mesh.name;
        EXPECT_LE(judgment.degrees.max, 1e-4) << mesh.name;
    }
}

TEST(ConformanceKit, FindsHandednessOfTheOtherConvention) {
    for (const KitMesh& mesh : kit()) {
        if (mesh.group == KitGroup::stability) continue;
        std::vector<glm::vec4> tangents = relief_tangents(mesh.mesh);
        for (glm::vec4& tangent : tangents)
            tangent.w = -tangent.w;
        const Judgment judgment = judge(mesh, loose(mesh.mesh, tangents));
        EXPECT_FALSE(judgment.passes(mesh.group)) << mesh.name;
        EXPECT_EQ(judgment.other_sign, judgment.judged) << mesh.name;
        EXPECT_EQ(judgment.too_far, 0U) << mesh.name;
    }
}

/// Returns the meshes that a twisted basis fails.
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

/// Returns a tangent per stored vertex, that of its last corner.
TEST(ConformanceKit, FindsCornersPutBackOnTheirOldVertices) {
    for (const KitMesh& mesh : kit()) {
        if (mesh.name != "torus-mirrored") continue;
        const std::vector<glm::vec4> tangents = relief_tangents(mesh.mesh);
        Mesh theirs = mesh.mesh;
        theirs.tangents.resize(theirs.positions.size());
        for (std::size_t corner = 0; corner < tangents.size(); ++corner)
            theirs.tangents[theirs.triangles[corner / 3][static_cast<int>(corner % 3)]] =
                tangents[corner];
        const Judgment judgment = judge(mesh, theirs);
        EXPECT_GT(judgment.other_sign, 0U);
        EXPECT_GT(judgment.mixed_signs, 0U) << "triangles with two handednesses";
        EXPECT_FALSE(judgment.passes(mesh.group));
    }
}

}  // namespace
}  // namespace relief::tools
