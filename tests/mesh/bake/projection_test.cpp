// SPDX-License-Identifier: Apache-2.0
// Stacks of sheets across one line, each facing up or down: which of them belongs to the point.
#include "bake/projection.h"

#include <gtest/gtest.h>

namespace relief {
namespace {

struct Sheet {
    float height;
    bool faces_up;
};

/// Squares from -1 to 1 across the z axis.
Mesh stack(const std::vector<Sheet>& sheets) {
    Mesh mesh;
    for (const Sheet& sheet : sheets) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
            mesh.positions.emplace_back(corner, sheet.height);
        const glm::uvec3 up(first, first + 1, first + 2), other(first, first + 2, first + 3);
        for (const glm::uvec3& triangle : {up, other}) {
            mesh.triangles.push_back(
                sheet.faces_up ? triangle : glm::uvec3(triangle.x, triangle.z, triangle.y));
        }
    }
    return mesh;
}

/// Where the surface lies that belongs to the origin, seen from +z, within 1; -100: nowhere.
double found(const std::vector<Sheet>& sheets, BackFaces back_faces = BackFaces::skip) {
    const Mesh mesh = stack(sheets);
    const RayScene scene({{mesh.positions, mesh.triangles}});
    const ProjectionLine line{{0.1, 0.2, 0.0}, {0, 0, 1}, 1.0, 1.0};
    ProjectedPoint point;
    Projection(scene, back_faces).find({&line, 1}, {&point, 1});
    return point.hit.is_hit() ? point.height : -100.0;
}

TEST(Projection, OneSheetIsFoundOnEitherSideOfThePoint) {
    for (const float height : {0.5F, 0.01F, 0.0F, -0.01F, -0.5F})
        EXPECT_NEAR(found({{height, true}}), height, 1e-12);
    EXPECT_EQ(found({}), -100.0);
    EXPECT_EQ(found({{1.5F, true}}), -100.0);
    EXPECT_EQ(found({{-1.5F, true}}), -100.0);
}

TEST(Projection, OfTwoParallelSheetsTheOuterOneIsFound) {
    EXPECT_NEAR(found({{0.1F, true}, {-0.1F, true}}), 0.1F, 1e-12);
    EXPECT_NEAR(found({{0.1F, true}, {0.3F, true}}), 0.3F, 1e-12);
    EXPECT_NEAR(found({{-0.3F, true}, {-0.1F, true}}), -0.1F, 1e-12);
}

TEST(Projection, TheOtherSideOfAThinWallIsNot) {
    // The surface itself, inside and outside of which the point lies; then a wall that faces it.
    for (const float own : {-0.02F, 0.0F, 0.02F})
        EXPECT_NEAR(found({{own, true}, {0.2F, false}, {0.22F, true}}), own, 1e-12) << own;
    // The line begins within the wall.
    EXPECT_NEAR(found({{-0.02F, true}, {0.2F, false}}), -0.02F, 1e-12);
    EXPECT_NEAR(found({{0.02F, true}, {0.2F, false}, {1.2F, true}}), 0.02F, 1e-12);
    // The wall that the surface itself is a side of: thinner than the surfaces are apart.
    EXPECT_NEAR(found({{0.3F, true}, {0.28F, false}}), 0.3F, 1e-12);
    EXPECT_NEAR(found({{-0.3F, true}, {-0.32F, false}}), -0.3F, 1e-12);
}

TEST(Projection, OfSolidsThatPassThroughEachOtherTheOutermostSideIsFound) {
    // A plate, and a bolt in it whose foot is above the point.
    EXPECT_NEAR(found({{-0.5F, false}, {0.1F, true}, {0.05F, false}, {0.4F, true}}), 0.4F, 1e-12);
    // And a wall beyond.
    EXPECT_NEAR(found({{-0.5F, false},
                       {0.1F, true},
                       {0.05F, false},
                       {0.4F, true},
                       {0.6F, false},
                       {0.7F, true}}),
                0.4F, 1e-12);
}

TEST(Projection, BackFacesArePassedOrTakenAsTold) {
    EXPECT_EQ(found({{0.2F, false}}), -100.0);
    EXPECT_NEAR(found({{0.2F, false}}, BackFaces::take), 0.2F, 1e-12);
    EXPECT_NEAR(found({{-0.2F, false}, {-0.4F, true}}), -0.4F, 1e-12);
    EXPECT_NEAR(found({{-0.2F, false}, {-0.4F, true}}, BackFaces::take), -0.2F, 1e-12);
}

TEST(Projection, CountsItsRays) {
    const Mesh mesh = stack({{-0.1F, true}});
    const RayScene scene({{mesh.positions, mesh.triangles}});
    std::vector<ProjectionLine> lines(40, {{0.1, 0.2, 0.0}, {0, 0, 1}, 1.0, 1.0});
    std::vector<ProjectedPoint> points(lines.size());
    const Projection projection(scene, BackFaces::skip);
    EXPECT_EQ(projection.find(lines, points), 40U);
    // Outwards of the point too: there is nothing in between.
    for (ProjectionLine& line : lines)
        line.point.z = -0.2;
    EXPECT_EQ(projection.find(lines, points), 40U);
    EXPECT_NEAR(points.back().height, 0.1, 1e-7);
}

}  // namespace
}  // namespace relief
