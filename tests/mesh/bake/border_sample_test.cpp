// SPDX-License-Identifier: Apache-2.0
// Samples moved inside by hand; then whole bakes of open meshes onto themselves, whose borders
// texels touch.
#include "bake/low_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/shapes.h"
#include "relief/mesh/threads.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::sized;

/// Legs of 3 and 4: the inscribed circle has radius 1.
Mesh right_triangle() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

glm::dvec3 place(const Mesh& mesh, const CoveredTexel& texel) {
    const glm::dvec3 weights(texel.weights());
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 3; ++i)
        sum += weights[i] * glm::dvec3(mesh.positions[mesh.triangles[texel.triangle][i]]);
    return sum;
}

CoveredTexel at(float second, float third) {
    return {0, second, third, false};
}

TEST(BorderSample, MovesToTheDistanceFromTheEdgesThatItIsOn) {
    const Mesh mesh = right_triangle();
    // On the leg along x; on the corner of both legs.
    const auto on_edge = moved_inside(mesh, at(0.25F, 0.0F), 0.01);
    ASSERT_TRUE(on_edge);
    EXPECT_NEAR(place(mesh, *on_edge).y, 0.01, 1e-6);
    EXPECT_LT(glm::distance(place(mesh, *on_edge), {1, 0.01, 0}), 0.011);
    const auto on_corner = moved_inside(mesh, at(0.0F, 0.0F), 0.01);
    ASSERT_TRUE(on_corner);
    EXPECT_LT(glm::distance(place(mesh, *on_corner), {0.01, 0.01, 0}), 1e-6);
    EXPECT_EQ(on_corner->triangle, 0U);
}

TEST(BorderSample, StaysWhereItIsFarEnoughInside) {
    EXPECT_FALSE(moved_inside(right_triangle(), at(0.25F, 0.25F), 0.01));
    EXPECT_FALSE(moved_inside(right_triangle(), at(0.25F, 0.0F), 0.0));
}

TEST(BorderSample, GoesToTheCentreOfTheInscribedCircleOfATriangleThatIsTooSmall) {
    const auto moved = moved_inside(right_triangle(), at(1.0F, 0.0F), 2.0);
    ASSERT_TRUE(moved);
    EXPECT_LT(glm::distance(place(right_triangle(), *moved), {1, 1, 0}), 1e-6);
}

TEST(BorderSample, HasNowhereToGoWhereThereIsNoArea) {
    Mesh line = right_triangle();
    line.positions[2] = {2, 0, 0};
    EXPECT_FALSE(moved_inside(line, at(0.5F, 0.0F), 0.01));
    line.positions[2].x = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(moved_inside(line, at(0.5F, 0.0F), 0.01));
}

/// Turned in space, and in the image, where its borders run across texels; not around the origin.
Mesh askew(Mesh mesh) {
    const glm::dvec3 x = glm::normalize(glm::dvec3(0.7, -0.5, 0.4));
    const glm::dvec3 z = glm::normalize(glm::cross(x, glm::dvec3(0.2, 0.9, 0.1)));
    const glm::dmat3 turn(x, glm::cross(z, x), z);
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(turn * glm::dvec3(position) * 0.37 + glm::dvec3(1.3, -0.7, 2.1));
    for (glm::vec2& texcoord : mesh.texcoords) {
        const glm::dvec2 from = glm::dvec2(texcoord) - 0.5;
        texcoord =
            glm::vec2(0.5 + 0.61 * from.x - 0.23 * from.y, 0.5 + 0.23 * from.x + 0.61 * from.y);
    }
    mesh.normals.clear();
    mesh.tangents.clear();
    return mesh;
}

Mesh open_grid() {
    Mesh mesh = make_quad(9);
    for (glm::vec3& position : mesh.positions)
        position.z = 0.2F * std::sin(3.0F * position.x) * std::cos(2.0F * position.y);
    return askew(mesh);
}

Mesh strip_of_one() {
    Mesh mesh = right_triangle();
    mesh.texcoords = {{0.0F, 0.1F}, {1.0F, 0.3F}, {0.2F, 0.9F}};
    return askew(mesh);
}

/// Triangles that have nothing in common.
Mesh confetti() {
    const Mesh grid = open_grid();
    Mesh mesh;
    for (const glm::uvec3& triangle : grid.triangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int i = 0; i < 3; ++i) {
            mesh.positions.push_back(grid.positions[triangle[i]] +
                                     glm::vec3(0, 0, 0.01F * static_cast<float>(first)));
            mesh.texcoords.push_back(grid.texcoords[triangle[i]]);
        }
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

TEST(OpenBorders, NoTexelOfAMeshOntoItselfIsMissed) {
    for (const Mesh& mesh : {open_grid(), strip_of_one(), confetti()}) {
        for (const int samples : {1, 4}) {
            BakeOptions options = sized(256, 256);
            options.samples = samples;
            const BakedImage image = bake({mesh}, mesh, options);
            EXPECT_GT(image.result.coverage.touched, 100U);
            EXPECT_EQ(image.result.texels_missed, 0U);
            EXPECT_FALSE(image.report.count("texel missed by its rays"));
            double worst = 0.0;
            for (std::size_t i = 0; i < image.states.size(); ++i)
                worst = std::max(worst, degrees_between(image.normal(i), {0, 0, 1}));
            EXPECT_LT(worst, 0.02);
            EXPECT_LT(image.result.max_height, 1e-6);
            EXPECT_GT(image.result.min_height, -1e-6);
        }
    }
}

TEST(OpenBorders, AreNotMissedFromACageEither) {
    const Mesh mesh = open_grid();
    Mesh cage = mesh;
    // Outwards everywhere, the grid being nearly flat.
    const glm::dvec3 a(mesh.positions[mesh.triangles[0].x]);
    const glm::dvec3 b(mesh.positions[mesh.triangles[0].y]);
    const glm::dvec3 c(mesh.positions[mesh.triangles[0].z]);
    const glm::vec3 outwards(glm::normalize(glm::cross(b - a, c - a)));
    for (glm::vec3& position : cage.positions)
        position += 0.05F * outwards;
    BakeOptions options = sized(256, 256);
    options.cage = &cage;
    const BakedImage image = bake({mesh}, mesh, options);
    EXPECT_GT(image.result.coverage.touched, 100U);
    EXPECT_EQ(image.result.texels_missed, 0U);
}

TEST(OpenBorders, AreTheSameForAnyNumberOfThreads) {
    const Mesh mesh = confetti();
    const BakedImage usual = bake({mesh}, mesh, sized(200, 200));
    set_thread_limit(1);
    const BakedImage alone = bake({mesh}, mesh, sized(200, 200));
    set_thread_limit(0);
    EXPECT_EQ(usual.normals, alone.normals);
    EXPECT_EQ(usual.heights, alone.heights);
    EXPECT_EQ(usual.result.rays, alone.result.rays);
}

TEST(OpenBorders, WhatIsReallyMissedStaysMissed) {
    // The high mesh ends a thousandth of its size before the low one: by far less than a texel.
    const Mesh low = strip_of_one();
    Mesh high = low;
    const glm::vec3 centre = (low.positions[0] + low.positions[1] + low.positions[2]) / 3.0F;
    for (glm::vec3& position : high.positions)
        position = centre + 0.999F * (position - centre);
    const BakedImage image = bake({high}, low, sized(64, 64));
    EXPECT_GT(image.result.coverage.touched, 50U);
    EXPECT_GE(image.result.texels_missed, image.result.coverage.touched);
    EXPECT_LE(image.result.texels_missed, image.result.coverage.touched + 5);
    EXPECT_EQ(image.report.count("texel missed by its rays"), image.result.texels_missed);
}

}  // namespace
}  // namespace relief
