// SPDX-License-Identifier: Apache-2.0
// What is measured of normals, with answers that are known: right ones err nothing, ones that are a
// degree off err a degree.
#include "normals/normal_methods.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "analytic_words.h"

namespace relief {
namespace {

/// True normals turned by so many degrees, each about an axis of its own in its tangent plane.
std::vector<glm::vec3> turned_normals(const AnalyticMesh& truth, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    std::vector<glm::vec3> normals;
    for (const glm::dvec3& normal : truth.normals) {
        const glm::dvec3 other =
            std::abs(normal.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
        const glm::dvec3 aside = glm::normalize(glm::cross(normal, other));
        normals.emplace_back(std::cos(angle) * normal + std::sin(angle) * aside);
    }
    return normals;
}

TEST(NormalErrors, OfTrueNormalsAreFloatsOwnAndOfTurnedOnesTheTurn) {
    // A float's rounding: 2^-24 of a component, 3.4e-6 degrees each.
    constexpr double rounding = 1e-5;
    for (const AnalyticSurface surface : all_surfaces) {
        const AnalyticMesh truth = analytic_mesh(surface, Triangulation::jittered, 16, 1);
        EXPECT_LE(normal_errors(turned_normals(truth, 0.0), truth).max, rounding);
        const AngleDistribution turned = normal_errors(turned_normals(truth, 1.0), truth);
        EXPECT_NEAR(turned.rms, 1.0, rounding);
        EXPECT_NEAR(turned.mean, 1.0, rounding);
        EXPECT_NEAR(turned.p99, 1.0, rounding);
        EXPECT_NEAR(turned.max, 1.0, rounding);
    }
}

TEST(NormalErrors, AreOfInnerVerticesAndCountWhatIsNoDirection) {
    const AnalyticMesh truth = analytic_mesh(AnalyticSurface::saddle, Triangulation::regular, 8, 1);
    std::vector<glm::vec3> normals = turned_normals(truth, 0.0);
    std::size_t inner = 0;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (truth.inner[v] == 0) normals[v] = glm::vec3(1.0F, 0.0F, 0.0F);
        if (truth.inner[v] != 0 && inner++ == 3) normals[v] = glm::vec3(0.0F);
    }
    const AngleDistribution errors = normal_errors(normals, truth);
    EXPECT_EQ(errors.count, 48U);
    EXPECT_EQ(errors.undefined, 1U);
    EXPECT_LE(errors.max, 1e-5);
}

TEST(NormalMethods, AreEightWeightingsInEachArithmetic) {
    const auto methods = normal_methods(std::array{Arithmetic::float64, Arithmetic::float32});
    std::set<std::string> names;
    for (const NormalMethod& method : methods)
        names.insert(method.name());
    EXPECT_EQ(methods.size(), 16U);
    EXPECT_EQ(names.size(), 16U);
    EXPECT_TRUE(names.contains("area-angle, float32"));
}

TEST(NormalMethods, AgreeOnAPlaneAndDifferOnASurface) {
    Mesh plane;
    plane.positions = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 3, 0}};
    plane.triangles = {{0, 1, 2}, {0, 2, 3}};
    const AnalyticMesh truth =
        analytic_mesh(AnalyticSurface::ellipsoid, Triangulation::jittered, 16, 1);
    std::set<double> errors;
    for (const NormalMethod& method : normal_methods(std::array{Arithmetic::float64})) {
        for (const glm::vec3& normal : method.normals(plane))
            EXPECT_EQ(normal, glm::vec3(0.0F, 0.0F, 1.0F)) << method.weighting;
        errors.insert(normal_errors(method.normals(truth.mesh), truth).rms);
    }
    EXPECT_EQ(errors.size(), 7U);  // "auto" is "max" here.
}

TEST(FanErrors, AreThoseOfTheVertexInTheMiddle) {
    NormalMethod leaning{"leaning", Arithmetic::float64, {}, [](const Mesh& mesh) {
                             std::vector<glm::vec3> normals(mesh.positions.size(),
                                                            glm::vec3(1.0F, 0.0F, 0.0F));
                             normals.front() = glm::vec3(0.0F, 3.0F, 4.0F);
                             return normals;
                         }};
    const AngleDistribution errors = fan_errors(leaning, 5, 10);
    EXPECT_EQ(errors.count, 10U);
    EXPECT_NEAR(errors.rms, std::atan(0.75) * 180.0 / std::numbers::pi, 1e-5);
}

}  // namespace
}  // namespace relief
