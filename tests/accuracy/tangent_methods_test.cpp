// SPDX-License-Identifier: Apache-2.0
// What is measured of tangents, with answers that are known.
#include "tangents/tangent_methods.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tangents/textured_cases.h"

namespace relief {
namespace {

/// A float's rounding: 2^-24 of a component, 3.4e-6 degrees each.
constexpr double rounding = 2e-5;

/// A level square with an upright image, as fine as is asked: all of its frames are the axes.
TexturedMesh level_square() {
    TexturedMesh square;
    square.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.mesh.normals.assign(4, {0.0F, 0.0F, 1.0F});
    square.mesh.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    square.parameters = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    square.inner.assign(4, 1);
    square.frame_at = [](const glm::dvec2&) {
        return SurfaceFrame{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, 1.0};
    };
    return square;
}

/// Tangents that are so many degrees off, on the level square.
CornerTangents turned(double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return CornerTangents(6, glm::vec4(std::cos(angle), std::sin(angle), 0.0, 1.0));
}

/// How far a direction 30 degrees off an axis goes that is turned about it by an angle.
double texel_turn(double degrees) {
    const double half = degrees * std::numbers::pi / 360.0;
    return 2.0 * std::asin(0.5 * std::sin(half)) * 180.0 / std::numbers::pi;
}

TEST(TangentErrors, OfTurnedTangentsAreTheTurn) {
    const TexturedMesh square = level_square();
    for (const ShaderBasis basis : {ShaderBasis::as_interpolated, ShaderBasis::made_unit}) {
        EXPECT_LE(texel_errors(square, turned(0.0), basis).max, rounding);
        EXPECT_NEAR(inner_tangent_errors(square, turned(1.0), basis).rms, 1.0, rounding);
        EXPECT_NEAR(texel_errors(square, turned(1.0), basis).rms, texel_turn(1.0), rounding);
        EXPECT_NEAR(texel_errors(square, turned(1.0), basis).max, texel_turn(1.0), rounding);
    }
    EXPECT_NEAR(corner_tangent_errors(square, turned(1.0)).rms, 1.0, rounding);
    EXPECT_EQ(corner_tangent_errors(square, turned(1.0)).count, 6U);
}

TEST(TangentErrors, OfAWrongHandAreThoseOfAMirroredTexel) {
    const TexturedMesh square = level_square();
    const CornerTangents mirrored(6, glm::vec4(1.0F, 0.0F, 0.0F, -1.0F));
    const AngleDistribution errors = texel_errors(square, mirrored, ShaderBasis::as_interpolated);
    // Two of four texels tilt up or down: 30 degrees one way instead of the other.
    EXPECT_NEAR(errors.max, 60.0, rounding);
    EXPECT_NEAR(errors.mean, 30.0, rounding);
}

TEST(MismatchErrors, AreNoneInOneBasisAndTheTurnBetweenTwo) {
    const TexturedMesh square = level_square();
    const TangentMethod right{"right", [](const Mesh&) { return turned(0.0); }};
    const TangentMethod off{"off", [](const Mesh&) { return turned(1.0); }};
    EXPECT_LE(mismatch_errors(square, off, off).max, rounding);
    EXPECT_NEAR(mismatch_errors(square, right, off).rms, texel_turn(1.0), rounding);
    EXPECT_NEAR(mismatch_errors(square, off, right).rms, texel_turn(1.0), rounding);
}

TEST(TangentMethods, AreExactOnALevelSquare) {
    const TexturedMesh square = level_square();
    std::set<std::string> names;
    for (const TangentMethod& method : tangent_methods()) {
        names.insert(method.name);
        for (const TangentMethod& read : {method, made_unit(method)}) {
            if (!method.tangents && read.basis == ShaderBasis::made_unit) continue;
            EXPECT_LE(texel_errors(square, read.tangents_of(square.mesh), read.basis).max,
                      rounding);
        }
    }
    EXPECT_EQ(names,
              (std::set<std::string>{"mikktspace", "area-weighted", "lengyel", "screen-space"}));
}

TEST(TexturedCases, HaveNamesOfTheirOwnAndMeshesOfTheirCells) {
    std::set<std::string> ids;
    for (const TexturedCase& one : textured_cases()) {
        EXPECT_TRUE(ids.insert(one.id).second);
        const std::size_t triangles = one.mesh(8).mesh.triangles.size();
        EXPECT_EQ(triangles, one.has_cells ? 128U : 10U) << one.name;
    }
    EXPECT_EQ(ids.size(), 18U);
}

}  // namespace
}  // namespace relief
