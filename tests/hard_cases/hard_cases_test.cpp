// SPDX-License-Identifier: Apache-2.0
// Every row of the catalogue, and the invariants of tangents on
// thousands of random meshes in which many things are wrong at once.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <set>

#include "hard_cases/hard_cases.h"
#include "hard_cases/mesh_case.h"
#include "hard_cases/random_meshes.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/sanitized.h"

namespace relief::test {
namespace {

class HardCases : public testing::TestWithParam<HardCase> {};

TEST_LABELS_OF("*/8192_texels_across*", alone, not_sanitized);
TEST_P(HardCases, HaveTheirOutcome) {
    ASSERT_FALSE(GetParam().expectations.empty());
    for (const Expectation& expectation : GetParam().expectations)
        EXPECT_EQ(expectation.problem(), "") << expectation.step << ": " << expectation.outcome;
}

std::string test_name(const testing::TestParamInfo<HardCase>& row) {
    std::string name;
    for (const char letter : row.param.name)
        name += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
    return name + "_" + std::to_string(row.index);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, HardCases, testing::ValuesIn(hard_cases()), test_name);

TEST(HardCasesTable, NamesEachRowOnceAndItsSource) {
    std::set<std::string> names;
    for (const HardCase& row : hard_cases()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_FALSE(row.what.empty()) << row.name;
        EXPECT_FALSE(row.source.empty()) << row.name;
    }
}

TEST(HardCasesTable, HasARowForEveryWordOfCheck) {
    std::string all;
    for (const HardCase& row : hard_cases()) {
        for (const Expectation& expectation : row.expectations) {
            if (expectation.step == "check") all += expectation.outcome + ",";
        }
    }
    for (const MeshConditionInfo& condition : mesh_conditions())
        EXPECT_NE(all.find("x " + std::string(condition.word) + ","), std::string::npos)
            << condition.word;
}

constexpr std::uint32_t mesh_count = is_sanitized ? 600 : 10000;

class HostileMeshes : public testing::TestWithParam<NamedTangentMethod> {};

TEST_P(HostileMeshes, HaveSoundTangentsWithTheSameBitsInAnyOrder) {
    for (std::uint32_t seed = 0; seed < mesh_count; ++seed) {
        const Mesh mesh = hostile_mesh(seed);
        const auto tangents = tangents_of(mesh, GetParam());
        ASSERT_EQ(broken_tangents(mesh, tangents), "") << "seed " << seed;
        const std::size_t count = mesh.triangles.size();
        for (const auto& order : {reversed(count), shuffled(count, seed), shuffled(count, ~seed)}) {
            const auto again = tangents_of(with_triangle_order(mesh, order), GetParam());
            ASSERT_TRUE(same_bits(again, corners_in_order(tangents, order))) << "seed " << seed;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, HostileMeshes, testing::ValuesIn(all_tangent_methods()),
                         [](const auto& method) {
                             std::string name = method.param.name;
                             for (char& letter : name)
                                 letter = letter == '-' ? '_' : letter;
                             return name;
                         });

TEST_LABELS(not_sanitized);
TEST(HostileMeshesThemselves, HaveEveryKindOfProblem) {
    std::vector<std::size_t> meshes_with(mesh_conditions().size());
    for (std::uint32_t seed = 0; seed < 500; ++seed) {
        Mesh mesh = hostile_mesh(seed);
        for (const MeshConditionCount& found : diagnose(mesh).conditions)
            ++meshes_with[static_cast<std::size_t>(found.condition)];
    }
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        if (condition.element == "vertex" && condition.word.find("tangent") != std::string::npos)
            continue;  // These meshes store no tangents.
        EXPECT_GT(meshes_with[static_cast<std::size_t>(condition.condition)], 0U) << condition.word;
    }
}

}  // namespace
}  // namespace relief::test
