// SPDX-License-Identifier: Apache-2.0
// Errors of normals that are rotated by known angles, and the results of the experiments.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "experiment_checks.h"

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

}  // namespace
}  // namespace relief::test
