// SPDX-License-Identifier: Apache-2.0
// Normals fitted to meshes without a formula, on surfaces whose normals are known.
#include "relief/mesh/fitted_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::accuracy;

namespace {

/// Returns the RMS error of the fits at inner vertices, in degrees.
double error_of(const FittedNormals& fitted, const AnalyticMesh& reference) {
    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < fitted.corners.size(); ++i) {
        const std::uint32_t vertex = test::vertex_at(reference.mesh, fitted.corners[i]);
        if (reference.inner[vertex] == 0) continue;
        const double degrees = degrees_between(fitted.normals[i], reference.normals[vertex]);
        squares += degrees * degrees;
        ++count;
    }
    return std::sqrt(squares / static_cast<double>(count));
}

double averaged_error(const AnalyticMesh& reference) {
    Report report;
    const std::vector<glm::vec3> normals = vertex_normals(
        reference.mesh.positions, reference.mesh.triangles, NormalWeight::max, report);
    return direction_error(normals, reference.normals, reference.inner).rms;
}

struct Situation {
    AnalyticSurface surface;
    Triangulation triangulation;
    int cells = 48;
};
class FittedNormalsOnSurfaces : public testing::TestWithParam<Situation> {};

TEST_P(FittedNormalsOnSurfaces, AreFarTruerThanAveragedOnesAndKnowHowMuch) {
    const AnalyticMesh reference =
        analytic_mesh(GetParam().surface, GetParam().triangulation, GetParam().cells, 1);
    const FittedNormals fitted = fitted_normals(reference.mesh, {});
    const double error = error_of(fitted, reference);
    EXPECT_LE(error, 0.1 * averaged_error(reference));
    EXPECT_LE(error, fitted.reference_degrees);
    // At a border, triangles are on one side only, and most fits are unreliable. Inside, almost
    // every vertex has a fit.
    const auto inner = std::count(reference.inner.begin(), reference.inner.end(), 1);
    const double share = static_cast<double>(inner) / static_cast<double>(reference.inner.size());
    const auto fits =
        std::count_if(fitted.corners.begin(), fitted.corners.end(), [&](std::uint32_t corner) {
            return reference.inner[test::vertex_at(reference.mesh, corner)] == 1;
        });
    EXPECT_GE(static_cast<double>(fits), 0.97 * share * static_cast<double>(fitted.examined_fans));
}

INSTANTIATE_TEST_SUITE_P(
    All, FittedNormalsOnSurfaces,
    testing::Values(Situation{AnalyticSurface::torus, Triangulation::jittered},
                    Situation{AnalyticSurface::ellipsoid, Triangulation::jittered},
                    Situation{AnalyticSurface::saddle, Triangulation::jittered},
                    Situation{AnalyticSurface::cubic, Triangulation::jittered},
                    Situation{AnalyticSurface::ellipsoid, Triangulation::anisotropic, 192},
                    Situation{AnalyticSurface::cubic, Triangulation::anisotropic, 64}));

TEST(FittedNormals, UncertaintyCoversTheirErrorOnSpheres) {
    // Max's weights are exact on spheres and, by symmetry, on regular grids of a torus.
    for (const auto& [surface, triangulation] :
         {std::pair(AnalyticSurface::sphere, Triangulation::jittered),
          std::pair(AnalyticSurface::torus, Triangulation::regular)}) {
        const AnalyticMesh reference = analytic_mesh(surface, triangulation, 48, 1);
        const FittedNormals fitted = fitted_normals(reference.mesh, {});
        EXPECT_LE(averaged_error(reference), 1e-4);
        EXPECT_LE(error_of(fitted, reference), 0.02);
        EXPECT_LE(error_of(fitted, reference), fitted.reference_degrees);
    }
}

TEST(FittedNormals, GetTruerWithTheFourthPowerOfTheCells) {
    const auto error_with = [](int cells) {
        const AnalyticMesh reference =
            analytic_mesh(AnalyticSurface::cubic, Triangulation::jittered, cells, 3);
        return error_of(fitted_normals(reference.mesh, {}), reference);
    };
    const double order = std::log2(error_with(16) / error_with(32));
    EXPECT_GE(order, 3.0);
    EXPECT_LE(order, 5.5);
}

TEST(FittedNormals, TurnWithTheMesh) {
    const Mesh mesh =
        analytic_mesh(AnalyticSurface::ellipsoid, Triangulation::jittered, 24, 1).mesh;
    const glm::vec3 half_turn(-1.0F, -1.0F, 1.0F);
    Mesh turned = mesh;
    for (glm::vec3& position : turned.positions)
        position *= half_turn;
    const FittedNormals one = fitted_normals(mesh, {});
    const FittedNormals other = fitted_normals(turned, {});
    ASSERT_EQ(other.corners, one.corners);
    double most = 0.0;
    for (std::size_t i = 0; i < one.normals.size(); ++i)
        most = std::max(most,
                        degrees_between(one.normals[i] * glm::dvec3(half_turn), other.normals[i]));
    EXPECT_LE(most, 1e-8);
}

/// A grid over [-1,1]^2 with these heights.
template <typename Height>
Mesh graph_of(const Height& height, int cells) {
    Mesh mesh;
    for (int row = 0; row <= cells; ++row) {
        for (int column = 0; column <= cells; ++column) {
            const double x = 2.0 * column / cells - 1.0;
            const double y = 2.0 * row / cells - 1.0;
            mesh.positions.emplace_back(x, y, height(x, y));
        }
    }
    const auto at = [&](int column, int row) {
        return static_cast<std::uint32_t>(row * (cells + 1) + column);
    };
    for (int row = 0; row < cells; ++row) {
        for (int column = 0; column < cells; ++column) {
            mesh.triangles.emplace_back(at(column, row), at(column + 1, row),
                                        at(column + 1, row + 1));
            mesh.triangles.emplace_back(at(column, row), at(column + 1, row + 1),
                                        at(column, row + 1));
        }
    }
    return mesh;
}

TEST(FittedNormals, AreExactOnPolynomialSurfaces) {
    // The surface is horizontal in the middle, so that the axes of the tangent plane are those of
    // the polynomial.
    const Mesh mesh = graph_of(
        [](double x, double y) {
            return 0.3 * x * x - 0.2 * x * y + 0.25 * y * y * y + 0.2 * x * x * y * y;
        },
        16);
    const std::uint32_t middle = 8 * 17 + 8;
    const FittedNormals fitted = fitted_normals(mesh, {});
    bool is_found = false;
    for (std::size_t i = 0; i < fitted.corners.size(); ++i) {
        if (test::vertex_at(mesh, fitted.corners[i]) != middle) continue;
        is_found = true;
        // The rounding error of floats.
        EXPECT_LE(degrees_between(fitted.normals[i], {0.0, 0.0, 1.0}), 2e-5);
    }
    EXPECT_TRUE(is_found);
}

TEST(FittedNormals, EndAtHardEdges) {
    const Mesh roof = graph_of([](double x, double) { return 0.5 - 0.5 * std::abs(x); }, 16);
    FitOptions options;
    const auto worst_of = [&](const FittedNormals& fitted) {
        double worst = 0.0;
        for (std::size_t i = 0; i < fitted.corners.size(); ++i) {
            const glm::uvec3& triangle = roof.triangles[fitted.corners[i] / 3];
            const double middle = roof.positions[triangle.x].x + roof.positions[triangle.y].x +
                                  roof.positions[triangle.z].x;
            const glm::dvec3 side(middle > 0.0 ? 0.5 : -0.5, 0.0, 1.0);
            worst = std::max(worst, degrees_between(fitted.normals[i], side));
        }
        return worst;
    };
    options.hard_edges.crease_angle = 0.5;
    const FittedNormals parted = fitted_normals(roof, options);
    EXPECT_EQ(parted.fans, 17U * 18U);  // The vertices of the ridge count twice.
    EXPECT_LE(worst_of(parted), 1e-4);
    options.hard_edges.crease_angle.reset();
    const FittedNormals smooth = fitted_normals(roof, options);
    EXPECT_EQ(smooth.fans, 17U * 17U);
    // The fits along the ridge are unreliable.
    EXPECT_LT(smooth.corners.size(), parted.corners.size() * 9 / 10);
}

TEST(FittedNormals, ExcludeFoldedFans) {
    // A steep, symmetric roof: both fits agree on its ridge, but there is no normal.
    const Mesh roof = graph_of([](double x, double) { return 2.0 - 2.0 * std::abs(x); }, 16);
    FitOptions options;
    options.max_fit_difference = 180.0;
    options.max_fit_angle = 180.0;
    const auto beside_the_ridge = [&](const FittedNormals& found) {
        return std::count_if(found.corners.begin(), found.corners.end(), [&](std::uint32_t corner) {
            return roof.positions[test::vertex_at(roof, corner)].x != 0.0F;
        });
    };
    const FittedNormals all = fitted_normals(roof, options);
    options.max_fit_angle = 45.0;
    const FittedNormals found = fitted_normals(roof, options);
    EXPECT_GT(static_cast<std::ptrdiff_t>(all.corners.size()), beside_the_ridge(all) + 10);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(found.corners.size()), beside_the_ridge(all));
    EXPECT_EQ(beside_the_ridge(found), beside_the_ridge(all));
}

TEST(FittedNormals, AreEmptyWithoutASurface) {
    Mesh tetrahedron;
    tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const FittedNormals few = fitted_normals(tetrahedron, {});
    EXPECT_EQ(few.examined_fans, 4U);
    EXPECT_TRUE(few.corners.empty());
    Mesh broken = graph_of([](double, double) { return 0.0; }, 8);
    broken.positions[40].x = std::numeric_limits<float>::quiet_NaN();
    for (const glm::dvec3& normal : fitted_normals(broken, {}).normals)
        EXPECT_LE(degrees_between(normal, {0.0, 0.0, 1.0}), 1e-6);
    EXPECT_TRUE(fitted_normals(Mesh{}, {}).corners.empty());
}

TEST(FittedNormals, SampleLargeMeshesIndependentlyOfThreads) {
    const AnalyticMesh reference =
        analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, 32, 1);
    FitOptions options;
    options.max_fans = 100;
    set_thread_limit(1);
    const FittedNormals one = fitted_normals(reference.mesh, options);
    set_thread_limit(0);
    const FittedNormals all = fitted_normals(reference.mesh, options);
    EXPECT_EQ(one.examined_fans, 100U);
    EXPECT_EQ(one.fans, 1024U);
    EXPECT_EQ(one.corners, all.corners);
    EXPECT_EQ(one.normals, all.normals);
}

}  // namespace
}  // namespace relief
