// SPDX-License-Identifier: Apache-2.0
// Normals and tangents with memory that is used again, and tangents of corners in the caller's
// memory.
#include "relief/mesh/execution.h"

#include <gtest/gtest.h>

#include <thread>

#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
namespace {

std::vector<glm::vec3> normals_of(const Mesh& mesh, NormalWeight weight, unsigned threads) {
    NormalOptions options;
    options.weight = weight;
    std::vector<glm::vec3> normals(mesh.positions.size());
    vertex_normals(mesh.positions, mesh.triangles, options, normals, IgnoredReport(),
                   {.threads = threads});
    return normals;
}

std::vector<glm::vec4> tangents_of_corners(const Mesh& mesh, unsigned threads) {
    std::vector<glm::vec4> tangents(3 * mesh.triangles.size());
    corner_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, tangents,
                    IgnoredReport(), {.threads = threads});
    return tangents;
}

TEST(Workspaces, ServeTheNextCallAndChangeNoBit) {
    const Mesh large = test::sphere(200, 150);
    const Mesh small = test::sphere(20, 15);
    Workspace workspace;
    EXPECT_EQ(workspace.size(), 0U);
    std::size_t with_one_thread = 0;
    for (const unsigned threads : {1U, 2U, 1U}) {
        for (const Mesh* mesh : {&large, &small, &large}) {
            const auto angle = normals_of(*mesh, NormalWeight::angle, 1);
            const auto area = normals_of(*mesh, NormalWeight::area, 1);
            const auto tangents = mikktspace_tangents(mesh->positions, mesh->normals,
                                                      mesh->texcoords, mesh->triangles);
            const WorkspaceScope scope(workspace);
            EXPECT_TRUE(test::same_bits(normals_of(*mesh, NormalWeight::angle, threads), angle));
            EXPECT_TRUE(test::same_bits(normals_of(*mesh, NormalWeight::area, threads), area));
            EXPECT_TRUE(test::same_bits(tangents_of_corners(*mesh, threads), tangents));
        }
        if (with_one_thread == 0) with_one_thread = workspace.size();
    }
    EXPECT_GT(with_one_thread, 33 * large.positions.size()) << "the sums of normals";
    EXPECT_LE(with_one_thread, workspace.size());
    workspace.clear();
    EXPECT_EQ(workspace.size(), 0U);
}

TEST(Workspaces, ServeOnlyTheThreadOfTheirScope) {
    const Mesh mesh = test::sphere(20, 15);
    Workspace outer, inner;
    const WorkspaceScope scope(outer);
    {
        const WorkspaceScope nested(inner);
        (void)normals_of(mesh, NormalWeight::max, 1);
    }
    EXPECT_EQ(outer.size(), 0U);
    EXPECT_GT(inner.size(), 0U);
    std::thread([&] { (void)normals_of(mesh, NormalWeight::max, 1); }).join();
    EXPECT_EQ(outer.size(), 0U);
    (void)normals_of(mesh, NormalWeight::max, 1);
    EXPECT_EQ(outer.size(), inner.size());
}

TEST(Workspaces, GetTheMemoryOfAFailedCallBack) {
    const Mesh mesh = test::sphere(20, 15);
    Mesh broken = mesh;
    broken.triangles.back().y = 100'000;
    Workspace workspace;
    const WorkspaceScope scope(workspace);
    EXPECT_THROW((void)normals_of(broken, NormalWeight::area, 1), InvalidInput);
    EXPECT_GT(workspace.size(), 32 * mesh.positions.size());
}

TEST(CornerTangents, RefuseMemoryOfAnotherSize) {
    const Mesh mesh = test::grid(1);
    std::vector<glm::vec4> tangents(5);
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  corner_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                                  tangents);
              }),
              "there is memory for 5 tangents, but there are 6 corners");
}

}  // namespace
}  // namespace relief
