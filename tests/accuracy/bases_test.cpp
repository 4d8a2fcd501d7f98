// SPDX-License-Identifier: Apache-2.0
// Bases at points of triangles: by hand, and against each other where they have to agree.
#include "tangents/bases.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/tangents.h"
#include "support/angle.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::grid;

TEST(Bases, OnAPlaneAllAreTheImagesOwn) {
    const Mesh mesh = grid(2);
    Report report;
    const CornerTangents tangents =
        mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
    for (const ShaderBasis basis :
         {ShaderBasis::as_interpolated, ShaderBasis::made_unit, ShaderBasis::derived}) {
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const glm::dmat3 found = basis_at(mesh, tangents, basis, {t, {0.5, 0.2, 0.3}});
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 expected(0.0);
                expected[axis] = 1.0;
                EXPECT_LE(glm::length(found[axis] - expected), 1e-12);
            }
        }
    }
}

TEST(Bases, AMirroredImageTurnsTangentAndHand) {
    Mesh mesh = grid(1);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord.x = 1.0F - texcoord.x;
    const glm::dmat3 found = basis_at(mesh, {}, ShaderBasis::derived, {0});
    EXPECT_LE(glm::length(found[0] - glm::dvec3(-1.0, 0.0, 0.0)), 1e-12);
    EXPECT_LE(glm::length(found[1] - glm::dvec3(0.0, 1.0, 0.0)), 1e-12);
}

TEST(Bases, DerivedTangentsRunAlongTheImagesRowsOnAnyTriangle) {
    const TexturedMesh truth = textured_mesh(AnalyticSurface::torus, Triangulation::anisotropic,
                                             TextureLayout::sheared, 16, 7);
    for (const Sample& sample : samples_of(truth)) {
        const glm::uvec3& t = truth.mesh.triangles[sample.triangle];
        const glm::dmat3 basis = basis_at(truth.mesh, {}, ShaderBasis::derived, sample);
        const glm::dvec3 a(truth.mesh.positions[t.x]);
        const glm::dvec3 e1 = glm::dvec3(truth.mesh.positions[t.y]) - a;
        const glm::dvec3 e2 = glm::dvec3(truth.mesh.positions[t.z]) - a;
        const glm::dvec2 origin(truth.mesh.texcoords[t.x]);
        const glm::dvec2 d1 = glm::dvec2(truth.mesh.texcoords[t.y]) - origin;
        const glm::dvec2 d2 = glm::dvec2(truth.mesh.texcoords[t.z]) - origin;
        // The point of the triangle's plane that is one step of the tangent away, up to the normal.
        const glm::dvec3 steps = glm::inverse(glm::dmat3(e1, e2, basis[2])) * basis[0];
        const glm::dvec2 moved = d1 * steps.x + d2 * steps.y;
        EXPECT_GT(moved.x, 0.0);
        EXPECT_LE(std::abs(moved.y), 1e-9 * moved.x);
        EXPECT_LE(std::abs(glm::dot(basis[0], basis[2])), 1e-12);
        // The bitangent is on the side where v falls.
        const glm::dvec3 up = glm::inverse(glm::dmat3(e1, e2, basis[2])) * basis[1];
        EXPECT_LT((d1 * up.x + d2 * up.y).y, 0.0);
    }
}

TEST(Bases, InterpolatedVectorsStayShortUnlessMadeUnit) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.texcoords = {{0, 0}, {1, 0}, {0, -1}};
    mesh.normals = {{0, 0, 1}, {0, 1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const CornerTangents tangents(3, glm::vec4(1.0F, 0.0F, 0.0F, -1.0F));
    const Sample sample{0, {0.5, 0.25, 0.25}};
    const glm::dmat3 short_one = basis_at(mesh, tangents, ShaderBasis::as_interpolated, sample);
    EXPECT_EQ(short_one[2], glm::dvec3(0.0, 0.5, 0.5));
    // -1 times (0, 0.5, 0.5) x (1, 0, 0).
    EXPECT_EQ(short_one[1], glm::dvec3(0.0, -0.5, 0.5));
    const glm::dmat3 unit = basis_at(mesh, tangents, ShaderBasis::made_unit, sample);
    EXPECT_NEAR(glm::length(unit[2]), 1.0, 1e-15);
    EXPECT_NEAR(glm::length(unit[1]), 1.0, 1e-15);
}

TEST(Bases, TrueTangentsAreThoseOfEachSideOfAMirroredImage) {
    const TexturedMesh truth = textured_mesh(AnalyticSurface::saddle, Triangulation::regular,
                                             TextureLayout::mirrored, 8, 1);
    const CornerTangents tangents = true_tangents(truth);
    std::size_t left = 0;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const glm::uvec3& t = truth.mesh.triangles[corner / 3];
        const double middle =
            (truth.parameters[t.x].x + truth.parameters[t.y].x + truth.parameters[t.z].x) / 3.0;
        EXPECT_EQ(tangents[corner].w, middle < 0.5 ? 1.0F : -1.0F);
        EXPECT_EQ(tangents[corner].x > 0.0F, middle < 0.5);
        left += middle < 0.5 ? 1U : 0U;
    }
    EXPECT_EQ(left, tangents.size() / 2);
    // Only triangles away from the border are looked at, at four points each.
    EXPECT_EQ(samples_of(truth).size(), 4U * 2U * 6U * 6U);
}

}  // namespace
}  // namespace relief
