// SPDX-License-Identifier: Apache-2.0
// Weights that are chosen from the mesh.
#include "relief/mesh/normals.h"

#include <gtest/gtest.h>

#include "hard_meshes.h"
#include "normals/normal_samples.h"
#include "relief/mesh/mesh.h"
#include "support/angle.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::bumpy_ball;
using test::degrees_between;
using test::facing_up;
using test::normals_of;

TEST(ChosenNormals, AreMaxWhereNothingFoldsOver) {
    const Mesh mesh = bumpy_ball();
    Report report;
    const ChosenNormals chosen = chosen_normals(mesh.positions, mesh.triangles, {}, report);
    EXPECT_EQ(chosen.by_area, 0U);
    EXPECT_TRUE(test::same_bits(chosen.normals, normals_of(mesh, NormalWeight::max)));
}

TEST(ChosenNormals, AreAreaAroundAFoldAndMaxElsewhere) {
    // A flat grid with one vertex pulled over its neighbor: the triangles turned over are the
    // small ones, which Max's weights listen to most.
    Mesh mesh = test::grid(8);
    const std::size_t pulled = 4 * 9 + 4;
    mesh.positions[pulled] = {0.5F + 0.14F, 0.5F, 0.0F};
    Report report;
    const ChosenNormals chosen = chosen_normals(mesh.positions, mesh.triangles, {}, report);
    const auto by_max = normals_of(mesh, NormalWeight::max);
    const auto by_area = normals_of(mesh, NormalWeight::area);
    double worst_by_max = 0.0;
    for (std::size_t i = 0; i < by_max.size(); ++i) {
        EXPECT_LE(degrees_between(chosen.normals[i], facing_up),
                  degrees_between(by_area[i], facing_up))
            << i;
        worst_by_max = std::max(worst_by_max, degrees_between(by_max[i], facing_up));
    }
    EXPECT_GT(worst_by_max, 90.0);
    EXPECT_GT(chosen.by_area, 0U);
    EXPECT_LT(chosen.by_area, 8U);
    EXPECT_TRUE(report.empty());
}

}  // namespace
}  // namespace relief
