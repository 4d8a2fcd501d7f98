// SPDX-License-Identifier: Apache-2.0
// What the library promises for any input, held against thousands of small meshes in which
// everything is wrong at once.
#include "hard_cases/hostile_meshes.h"

#include <gtest/gtest.h>

#include "hard_cases/mesh_case.h"
#include "relief/mesh/frames.h"
#include "support/tangent_invariant.h"
#include "support/triangle_orders.h"

namespace relief::test {
namespace {

constexpr std::uint32_t mesh_count = 10000;

std::vector<glm::vec4> tangents_of(const Mesh& mesh, const TangentMethod& method) {
    Report ignored;
    return method.call(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, ignored);
}

class HostileMeshes : public testing::TestWithParam<TangentMethod> {};

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

TEST(HostileMeshesThemselves, HoldEveryKindOfTrouble) {
    std::vector<std::size_t> meshes_with(mesh_conditions().size());
    for (std::uint32_t seed = 0; seed < 500; ++seed) {
        Mesh mesh = hostile_mesh(seed);
        for (const MeshConditionCount& found : diagnose(mesh).found)
            ++meshes_with[static_cast<std::size_t>(found.condition)];
    }
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        if (condition.element == "vertex" && condition.word.find("tangent") != std::string::npos)
            continue;  // They store none.
        EXPECT_GT(meshes_with[static_cast<std::size_t>(condition.condition)], 0U) << condition.word;
    }
}

}  // namespace
}  // namespace relief::test
