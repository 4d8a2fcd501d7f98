// SPDX-License-Identifier: Apache-2.0
// The nearest point of exact surfaces, samples over the area, and the results of the experiments.
#include "decimation_experiments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiment_checks.h"
#include "experiment_parts.h"
#include "relief/mesh/topology.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

TEST(NearestOnSurface, IsTheFootOfThePerpendicular) {
    for (const AnalyticSurface surface : all_surfaces) {
        const AnalyticMesh mesh = analytic_mesh(surface, Triangulation::jittered, 12, 7);
        const auto nearest = nearest_on_surface(surface, 7);
        for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
            const glm::dvec3 foot = nearest(glm::dvec3(mesh.mesh.positions[v])).position;
            // Positions are rounded to float.
            EXPECT_LT(glm::length(foot - glm::dvec3(mesh.mesh.positions[v])), 1e-7);
            for (const double distance : {-0.03, 0.05}) {
                const ExactPoint found = nearest(foot + distance * mesh.normals[v]);
                EXPECT_LT(glm::length(found.position - foot), 1e-6) << name_of(surface);
                EXPECT_LT(degrees_between(found.normal, mesh.normals[v]), 1e-4) << name_of(surface);
            }
        }
    }
}

TEST(AreaSamples, AreSpreadInProportionToArea) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 1}, {0, 2, 3}};  // Of area 1.5, 0 and 0.5.
    std::size_t flat = 0;
    glm::dvec3 sum(0.0);
    for (const TriangleSample& sample : area_samples(mesh, 4000)) {
        const bool is_flat = sample.normal.z > 0.0;
        EXPECT_EQ(sample.normal, is_flat ? glm::dvec3(0, 0, 3) : glm::dvec3(1, 0, 0));
        EXPECT_EQ(is_flat ? sample.position.z : sample.position.x, 0.0);
        if (!is_flat) continue;
        ++flat;
        EXPECT_LE(sample.position.x / 3.0 + sample.position.y, 1.0 + 1e-12);
        sum += sample.position;
    }
    EXPECT_NEAR(double(flat), 3000.0, 1.0);
    EXPECT_NEAR(sum.x / double(flat), 1.0, 0.01) << "the centroid";
    EXPECT_NEAR(sum.y / double(flat), 1.0 / 3.0, 0.01);
    EXPECT_TRUE(area_samples(Mesh(), 10).empty());
}

TEST(SurfaceErrors, AreTheDistanceAndTheAngleOfShiftedTriangles) {
    // Triangles of a fine sphere that is scaled by 1.01: the distance is 0.01, up to the height of
    // the sphere over its triangles.
    AnalyticMesh sphere = analytic_mesh(AnalyticSurface::sphere, Triangulation::regular, 128, 1);
    for (glm::vec3& position : sphere.mesh.positions)
        position *= 1.01F;
    const ErrorStats distance =
        surface_errors(sphere.mesh, AnalyticSurface::sphere, 1, DecimationError::distance);
    EXPECT_EQ(distance.count, 20'000U);
    EXPECT_NEAR(distance.rms, 0.01, 3e-4);
    EXPECT_LE(distance.max, 0.01 + 1e-6);
    const ErrorStats angle =
        surface_errors(sphere.mesh, AnalyticSurface::sphere, 1, DecimationError::angle);
    // The largest angle is at corners: the edges span 2.8 degrees along a parallel.
    EXPECT_LT(angle.max, 2.0);
    EXPECT_GT(angle.rms, 0.3);
}

}  // namespace
}  // namespace relief::test
