// SPDX-License-Identifier: Apache-2.0
// Errors of normals and tangents that are rotated by known angles, and tangent bases inside
// triangles, computed by hand.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "experiment_checks.h"
#include "relief/mesh/tangents.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

/// Exact normals, each rotated by `degrees` about its own axis in the tangent plane.
std::vector<glm::vec3> turned_normals(const AnalyticMesh& ground_truth, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    std::vector<glm::vec3> normals;
    for (const glm::dvec3& normal : ground_truth.normals) {
        const glm::dvec3 other =
            std::abs(normal.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
        const glm::dvec3 aside = glm::normalize(glm::cross(normal, other));
        normals.emplace_back(std::cos(angle) * normal + std::sin(angle) * aside);
    }
    return normals;
}

TEST(NormalErrors, RotatedNormalsHaveTheAngleOfRotation) {
    // Rounding to float: 2^-24 of a component, 3.4e-6 degrees each.
    constexpr double rounding = 1e-5;
    for (const AnalyticSurface surface : all_surfaces) {
        const AnalyticMesh ground_truth = analytic_mesh(surface, Triangulation::jittered, 16, 1);
        EXPECT_LE(normal_errors(turned_normals(ground_truth, 0.0), ground_truth).max, rounding);
        const ErrorStats turned = normal_errors(turned_normals(ground_truth, 1.0), ground_truth);
        EXPECT_NEAR(turned.rms, 1.0, rounding);
        EXPECT_NEAR(turned.mean, 1.0, rounding);
        EXPECT_NEAR(turned.p99, 1.0, rounding);
        EXPECT_NEAR(turned.max, 1.0, rounding);
    }
}

TEST(NormalErrors, CoverInnerVerticesAndCountZeroVectors) {
    const AnalyticMesh ground_truth =
        analytic_mesh(AnalyticSurface::saddle, Triangulation::regular, 8, 1);
    std::vector<glm::vec3> normals = turned_normals(ground_truth, 0.0);
    std::size_t inner = 0;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (ground_truth.inner[v] == 0) normals[v] = glm::vec3(1.0F, 0.0F, 0.0F);
        if (ground_truth.inner[v] != 0 && inner++ == 3) normals[v] = glm::vec3(0.0F);
    }
    const ErrorStats errors = normal_errors(normals, ground_truth);
    EXPECT_EQ(errors.count, 48U);
    EXPECT_EQ(errors.undefined, 1U);
    EXPECT_LE(errors.max, 1e-5);
}

TEST(NormalMethods, AgreeOnAPlaneAndDifferOnASurface) {
    Mesh plane;
    plane.positions = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 3, 0}};
    plane.triangles = {{0, 1, 2}, {0, 2, 3}};
    const AnalyticMesh ground_truth =
        analytic_mesh(AnalyticSurface::ellipsoid, Triangulation::jittered, 16, 1);
    std::set<double> errors;
    for (const NormalMethod& method : normal_methods(std::array{Arithmetic::float64})) {
        for (const glm::vec3& normal : method.compute(plane))
            EXPECT_EQ(normal, glm::vec3(0.0F, 0.0F, 1.0F)) << method.name;
        errors.insert(normal_errors(method.compute(ground_truth.mesh), ground_truth).rms);
    }
    EXPECT_EQ(errors.size(), 7U);  // "auto" equals "max" here.
}

TEST(FanErrors, AreThoseOfTheVertexInTheMiddle) {
    NormalMethod leaning{"leaning", {}, [](const Mesh& mesh) {
                             std::vector<glm::vec3> normals(mesh.positions.size(),
                                                            glm::vec3(1.0F, 0.0F, 0.0F));
                             normals.front() = glm::vec3(0.0F, 3.0F, 4.0F);
                             return normals;
                         }};
    const ErrorStats errors = fan_errors(leaning, 5, 10);
    EXPECT_EQ(errors.count, 10U);
    EXPECT_NEAR(errors.rms, std::atan(0.75) * 180.0 / std::numbers::pi, 1e-5);
}

const TangentFrames derived{{}, ShaderBasis::derived};

TEST(Bases, OnAPlaneAllAreTheImagesOwn) {
    const Mesh mesh = grid(2);
    Report report;
    const CornerTangents tangents =
        mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
    for (const ShaderBasis basis :
         {ShaderBasis::as_interpolated, ShaderBasis::made_unit, ShaderBasis::derived}) {
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const glm::dmat3 found = basis_at(mesh, {tangents, basis}, {t, {0.5, 0.2, 0.3}});
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
    const glm::dmat3 found = basis_at(mesh, derived, {0});
    EXPECT_LE(glm::length(found[0] - glm::dvec3(-1.0, 0.0, 0.0)), 1e-12);
    EXPECT_LE(glm::length(found[1] - glm::dvec3(0.0, 1.0, 0.0)), 1e-12);
}

TEST(Bases, DerivedTangentsRunAlongTheImagesRowsOnAnyTriangle) {
    const TexturedMesh ground_truth = textured_mesh(
        AnalyticSurface::torus, Triangulation::anisotropic, TextureLayout::sheared, 16, 7);
    for (const Sample& sample : samples_of(ground_truth)) {
        const glm::uvec3& t = ground_truth.mesh.triangles[sample.triangle];
        const glm::dmat3 basis = basis_at(ground_truth.mesh, derived, sample);
        const glm::dvec3 a(ground_truth.mesh.positions[t.x]);
        const glm::dvec3 e1 = glm::dvec3(ground_truth.mesh.positions[t.y]) - a;
        const glm::dvec3 e2 = glm::dvec3(ground_truth.mesh.positions[t.z]) - a;
        const glm::dvec2 origin(ground_truth.mesh.texcoords[t.x]);
        const glm::dvec2 d1 = glm::dvec2(ground_truth.mesh.texcoords[t.y]) - origin;
        const glm::dvec2 d2 = glm::dvec2(ground_truth.mesh.texcoords[t.z]) - origin;
        // The point in the plane of the triangle at one tangent from the corner, except for the
        // normal.
        const glm::dvec3 steps = glm::inverse(glm::dmat3(e1, e2, basis[2])) * basis[0];
        const glm::dvec2 moved = d1 * steps.x + d2 * steps.y;
        EXPECT_GT(moved.x, 0.0);
        EXPECT_LE(std::abs(moved.y), 1e-9 * moved.x);
        EXPECT_LE(std::abs(glm::dot(basis[0], basis[2])), 1e-12);
        // The bitangent points towards decreasing v.
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
    const glm::dmat3 short_one = basis_at(mesh, {tangents}, sample);
    EXPECT_EQ(short_one[2], glm::dvec3(0.0, 0.5, 0.5));
    // -1 times (0, 0.5, 0.5) x (1, 0, 0).
    EXPECT_EQ(short_one[1], glm::dvec3(0.0, -0.5, 0.5));
    const glm::dmat3 unit = basis_at(mesh, {tangents, ShaderBasis::made_unit}, sample);
    EXPECT_NEAR(glm::length(unit[2]), 1.0, 1e-15);
    EXPECT_NEAR(glm::length(unit[1]), 1.0, 1e-15);
}

TEST(Bases, TrueTangentsAreThoseOfEachSideOfAMirroredImage) {
    const TexturedMesh ground_truth = textured_mesh(AnalyticSurface::saddle, Triangulation::regular,
                                                    TextureLayout::mirrored, 8, 1);
    const CornerTangents tangents = exact_tangents(ground_truth);
    std::size_t left = 0;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const glm::uvec3& t = ground_truth.mesh.triangles[corner / 3];
        const double middle = (ground_truth.parameters[t.x].x + ground_truth.parameters[t.y].x +
                               ground_truth.parameters[t.z].x) /
                              3.0;
        EXPECT_EQ(tangents[corner].w, middle < 0.5 ? 1.0F : -1.0F);
        EXPECT_EQ(tangents[corner].x > 0.0F, middle < 0.5);
        left += middle < 0.5 ? 1U : 0U;
    }
    EXPECT_EQ(left, tangents.size() / 2);
    // Only triangles away from the border count, with four points each.
    EXPECT_EQ(samples_of(ground_truth).size(), 4U * 2U * 6U * 6U);
}

/// Rounding to float: 2^-24 of a component, 3.4e-6 degrees each.
constexpr double rounding = 2e-5;

/// A level square with an upright texture; all of its frames are the axes.
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

/// Tangents on the level square with an error of `degrees`.
TangentFrames turned(double degrees, ShaderBasis basis = ShaderBasis::as_interpolated) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return {CornerTangents(6, glm::vec4(std::cos(angle), std::sin(angle), 0.0, 1.0)), basis};
}

/// The angle by which a direction at 30 degrees to an axis moves if it is rotated about the axis.
double texel_turn(double degrees) {
    const double half = degrees * std::numbers::pi / 360.0;
    return 2.0 * std::asin(0.5 * std::sin(half)) * 180.0 / std::numbers::pi;
}

TEST(TangentErrors, RotatedTangentsHaveTheAngleOfRotation) {
    const TexturedMesh square = level_square();
    for (const ShaderBasis basis : {ShaderBasis::as_interpolated, ShaderBasis::made_unit}) {
        EXPECT_LE(texel_errors(square, turned(0.0, basis)).max, rounding);
        EXPECT_NEAR(inner_tangent_errors(square, turned(1.0, basis)).rms, 1.0, rounding);
        EXPECT_NEAR(texel_errors(square, turned(1.0, basis)).rms, texel_turn(1.0), rounding);
        EXPECT_NEAR(texel_errors(square, turned(1.0, basis)).max, texel_turn(1.0), rounding);
    }
    const std::vector<float> corners = corner_tangent_angles(square, turned(1.0).tangents);
    EXPECT_EQ(corners.size(), 6U);
    EXPECT_NEAR(error_stats(corners).rms, 1.0, rounding);
}

TEST(TangentErrors, WrongHandednessMirrorsTheTexel) {
    const TexturedMesh square = level_square();
    const CornerTangents mirrored(6, glm::vec4(1.0F, 0.0F, 0.0F, -1.0F));
    const ErrorStats errors = texel_errors(square, {mirrored});
    // Two of four texels are tilted up or down: by 30 degrees to one side instead of the other.
    EXPECT_NEAR(errors.max, 60.0, rounding);
    EXPECT_NEAR(errors.mean, 30.0, rounding);
}

TEST(MismatchErrors, AreNoneInOneBasisAndTheTurnBetweenTwo) {
    const TexturedMesh square = level_square();
    const FrameMethod right{"right", {}, [](const Mesh&) { return turned(0.0); }};
    const FrameMethod off{"off", {}, [](const Mesh&) { return turned(1.0); }};
    EXPECT_LE(mismatch_errors(square, off, off).max, rounding);
    EXPECT_NEAR(mismatch_errors(square, right, off).rms, texel_turn(1.0), rounding);
    EXPECT_NEAR(mismatch_errors(square, off, right).rms, texel_turn(1.0), rounding);
}

TEST(TangentMethods, AreExactOnALevelSquare) {
    const TexturedMesh square = level_square();
    std::set<std::string> names;
    for (const FrameMethod& method : tangent_methods()) {
        names.insert(method.name);
        EXPECT_LE(texel_errors(square, method.compute(square.mesh)).max, rounding);
        if (!method.has_work) continue;
        EXPECT_LE(texel_errors(square, made_unit(method).compute(square.mesh)).max, rounding);
    }
    EXPECT_EQ(names,
              (std::set<std::string>{"mikktspace", "area-weighted", "lengyel", "screen-space"}));
}

}  // namespace
}  // namespace relief::test
