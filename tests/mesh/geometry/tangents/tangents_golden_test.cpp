// SPDX-License-Identifier: Apache-2.0
// Conformance: relief's tangents against those of the MikkTSpace reference implementation, corner
// by corner, on its own output for twelve meshes (see golden.h).
#include <gtest/gtest.h>

#include "golden.h"
#include "hard_meshes.h"
#include "relief/mesh/tangents.h"
#include "support/angle.h"
#include "support/shared_data.h"

namespace relief::test {
namespace {

// What the reference's own answers for other face orders are held to.
constexpr double conforming_degrees = 0.01;

std::vector<glm::vec4> golden_tangents_of(const Mesh& mesh) {
    Report report;
    return mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                               report);
}

/// How a mesh compares with the reference.
struct Comparison {
    std::size_t compared = 0;
    std::size_t unstable = 0;   ///< The reference has two answers.
    std::size_t untouched = 0;  ///< The reference has none, and relief has.
    std::size_t other_sign = 0;
    std::size_t too_far = 0;
    double worst_degrees = 0.0;
};

Comparison compare(const Golden& golden, const std::vector<glm::vec4>& tangents) {
    Comparison result;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::size_t file_corner = golden.file_corner[corner];
        if (!golden.is_stable(file_corner)) {
            ++result.unstable;
            continue;
        }
        const glm::vec4& expected = golden.tangents[file_corner];
        const bool other_sign = tangents[corner].w != expected.w;
        const double degrees = degrees_between(tangents[corner], expected);
        if (golden.is_untouched(file_corner) && (other_sign || degrees > conforming_degrees)) {
            ++result.untouched;
            continue;
        }
        ++result.compared;
        result.other_sign += other_sign ? 1 : 0;
        result.too_far += degrees > conforming_degrees ? 1 : 0;
        result.worst_degrees = std::max(result.worst_degrees, degrees);
    }
    return result;
}

TEST(GoldenTangents, EveryStableCornerAgreesInSignAndWithinAHundredthOfADegree) {
    RELIEF_NEEDS_SHARED(folder, "golden");
    const auto files = golden_files(folder);
    ASSERT_GE(files.size(), 12U);
    for (const std::filesystem::path& file : files) {
        SCOPED_TRACE(file.filename());
        const Golden golden = read_golden(file);
        const Comparison result = compare(golden, golden_tangents_of(golden.mesh));
        EXPECT_EQ(result.other_sign, 0U);
        EXPECT_EQ(result.too_far, 0U) << "worst: " << result.worst_degrees << " degrees";
        // Only in the mesh made of bad triangles has the reference corners without an answer.
        const bool is_bad = golden.name == "degenerate_mix";
        EXPECT_EQ(result.unstable, is_bad ? 77U : 0U);
        EXPECT_EQ(result.untouched, is_bad ? 58U : 0U);
        EXPECT_GE(result.compared, 1000U);
    }
}

TEST(GoldenTangents, KeepTheInvariantsWhereTheReferenceBreaksThem) {
    RELIEF_NEEDS_SHARED(folder, "golden");
    for (const std::filesystem::path& file : golden_files(folder)) {
        SCOPED_TRACE(file.filename());
        const Mesh mesh = read_golden(file).mesh;
        expect_tangent_invariants(mesh, golden_tangents_of(mesh));
    }
}

TEST(GoldenTangents, PermutingTrianglesChangesNoBit) {
    RELIEF_NEEDS_SHARED(folder, "golden");
    for (const std::filesystem::path& file : golden_files(folder)) {
        SCOPED_TRACE(file.filename());
        const Mesh mesh = read_golden(file).mesh;
        const auto order = shuffled(mesh.triangles.size());
        const auto expected = golden_tangents_of(mesh);
        const auto permuted = golden_tangents_of(with_triangle_order(mesh, order));
        EXPECT_TRUE(same_bits(permuted, corners_in_order(expected, order)));
    }
}

}  // namespace
}  // namespace relief::test
