// SPDX-License-Identifier: Apache-2.0
// Meshes in another space: frames go with the surface, and mirrors keep it outside out.
#include "relief/mesh/placed.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "relief/mesh/frames.h"
#include "relief/mesh/shapes.h"
#include "support/angle.h"

namespace relief {
namespace {

using test::degrees_between;

/// Of directions that went through float matrices.
constexpr double placed_rounding = 1e-4;

Mesh framed(Mesh mesh, NormalMode normals) {
    Report report;
    return with_frames(std::move(mesh), {.normals = normals, .tangents = TangentMode::mikktspace},
                       report)
        .mesh;
}

TEST(Placed, AMirrorTurnsTrianglesAndSigns) {
    const Mesh quad = framed(make_quad(), NormalMode::keep);
    const Mesh mirrored = placed(quad, glm::scale(glm::mat4(1.0F), {-1.0F, 1.0F, 1.0F}));
    EXPECT_EQ(mirrored.positions[0], quad.positions[0] * glm::vec3(-1, 1, 1));
    EXPECT_EQ(mirrored.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(mirrored.tangents[0], glm::vec4(-1, 0, 0, -1)) << "bitangent y, as before";
    EXPECT_EQ(mirrored.triangles[0],
              glm::uvec3(quad.triangles[0].x, quad.triangles[0].z, quad.triangles[0].y));
}

TEST(Placed, NormalsStayPerpendicularWhereScalesDiffer) {
    const Mesh sphere = framed(make_sphere(24, 12), NormalMode::keep);
    const Mesh ellipsoid = placed(sphere, glm::scale(glm::mat4(1.0F), {3.0F, 1.0F, 0.5F}));
    for (std::size_t v = 0; v < sphere.positions.size(); ++v) {
        const glm::vec3 gradient = ellipsoid.positions[v] / glm::vec3(9.0F, 1.0F, 0.25F);
        EXPECT_LT(degrees_between(ellipsoid.normals[v], gradient), placed_rounding);
        EXPECT_NEAR(glm::dot(ellipsoid.normals[v], glm::vec3(ellipsoid.tangents[v])), 0.0F, 1e-5F);
        EXPECT_NEAR(glm::length(ellipsoid.normals[v]), 1.0F, 1e-6F);
    }
}

TEST(Placed, FramesAreThoseOfTheMovedMesh) {
    const Mesh torus = framed(make_torus(0.4F, 24, 12), NormalMode::angle);
    for (const float mirror : {1.0F, -1.0F}) {
        const glm::mat4 turn = glm::rotate(glm::mat4(1.0F), 0.7F, glm::vec3(1.0F, 2.0F, 3.0F));
        const Mesh moved = placed(torus, glm::scale(turn, glm::vec3(1e-6F, 1e-6F, mirror * 1e-6F)));
        Mesh again = moved;
        again.tangents.clear();
        again = framed(std::move(again), NormalMode::angle);
        ASSERT_EQ(again.positions.size(), moved.positions.size());
        for (std::size_t v = 0; v < moved.positions.size(); ++v) {
            EXPECT_LT(degrees_between(moved.normals[v], again.normals[v]), 1e-3);
            EXPECT_LT(degrees_between(glm::vec3(moved.tangents[v]), glm::vec3(again.tangents[v])),
                      1e-2);
            ASSERT_EQ(moved.tangents[v].w, again.tangents[v].w);
        }
    }
}

TEST(Placed, NoDirectionIsLost) {
    const Mesh quad = framed(make_quad(), NormalMode::keep);
    const Mesh flat = placed(quad, glm::scale(glm::mat4(1.0F), {0.0F, 1.0F, 1.0F}));
    EXPECT_EQ(flat.tangents[0], quad.tangents[0]);
    const Mesh nothing = placed(quad, glm::mat4(0.0F));
    EXPECT_EQ(nothing.normals, quad.normals);
}

}  // namespace
}  // namespace relief
