// SPDX-License-Identifier: Apache-2.0
// The surfaces and the measures of the experiments on decimation and unwrapping, and their results.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "experiment_checks.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/topology.h"
#include "relief/mesh/unwrap.h"
#include "support/labels.h"
#include "support/shared_data.h"

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

TEST(UnwrappingSurfaces, AreClosedAndHaveTheStatedSizes) {
    const Mesh sphere = wavy_sphere(8, 0.01);
    EXPECT_EQ(sphere.triangles.size(), 12U * 8 * 8);
    for (const glm::vec3& position : sphere.positions)
        EXPECT_NEAR(glm::length(position), 1.0F, 0.08F + 0.03F + 0.06F);
    const Mesh gear = gear_wheel(5, 3);
    for (const Mesh& mesh : {sphere, gear}) {
        // A closed surface has each edge in both directions, and the volume is positive if its
        // triangles face outwards.
        EXPECT_EQ(diagnose(mesh).count(MeshCondition::edge_boundary), 0U);
        EXPECT_EQ(diagnose(mesh).count(MeshCondition::edge_flipped), 0U);
        double volume = 0.0;
        for (const glm::uvec3& t : mesh.triangles)
            volume +=
                static_cast<double>(glm::dot(
                    mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z]))) /
                6.0;
        EXPECT_GT(volume, 0.5);
    }
    EXPECT_EQ(wavy_sphere(8, 0.01).positions, sphere.positions);
    EXPECT_NE(wavy_sphere(8, 0.0).positions, sphere.positions);
}

/// The texture coordinates of the corners of triangles.
std::vector<glm::vec2> corners_of(const Mesh& mesh) {
    std::vector<glm::vec2> corners;
    for (const glm::uvec3& triangle : mesh.triangles)
        for (int i = 0; i < 3; ++i)
            corners.push_back(mesh.texcoords[triangle[i]]);
    return corners;
}

// Two separate rectangles of areas 3 and 1 on a surface.
Mesh two_rectangles(const glm::vec2& first_scale, const glm::vec2& second_scale) {
    Mesh mesh;
    for (const bool is_second : {false, true}) {
        const float width = is_second ? 1.0F : 3.0F;
        const glm::vec2 scale = is_second ? second_scale : first_scale;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec2& corner : {glm::vec2(0, 0), {width, 0}, {width, 1}, {0, 1}}) {
            mesh.positions.emplace_back(corner.y, is_second ? 5.0F : 0.0F, corner.x);
            mesh.texcoords.push_back(scale * corner / 8.0F);
        }
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    }
    return mesh;
}

TEST(StretchErrors, AreThoseOfScaledRectangles) {
    const auto errors = [](const Mesh& mesh, const glm::ivec2& size) {
        return stretch_errors(mesh, corners_of(mesh), size);
    };
    const ErrorStats equal = errors(two_rectangles({1, 1}, {1, 1}), {64, 64});
    EXPECT_EQ(equal.count, 20'000U);
    EXPECT_NEAR(equal.max, 0.0, 1e-4);
    // A map of twice the width stretches by 2 and 1, of which the mean density is the root of 2.
    const double root = std::sqrt(2.0);
    const ErrorStats wide = errors(two_rectangles({1, 1}, {1, 1}), {128, 64});
    EXPECT_NEAR(wide.rms, 100.0 * (root - 1.0), 1e-3);
    EXPECT_NEAR(wide.max, 100.0 * (root - 1.0), 1e-3);
    // A quarter of the area has twice the density: the mean is the root of (3 + 4) / 4.
    const double mean = std::sqrt(7.0 / 4.0);
    const ErrorStats dense = errors(two_rectangles({1, 1}, {2, 2}), {64, 64});
    EXPECT_NEAR(dense.mean, 100.0 * (0.75 * (mean - 1.0) + 0.25 * (2.0 / mean - 1.0)), 1e-3);
    EXPECT_NEAR(dense.max, 100.0 * (2.0 / mean - 1.0), 1e-3);
    const ErrorStats flat = errors(two_rectangles({1, 1}, {1, 0}), {64, 64});
    EXPECT_EQ(flat.undefined, 5'000U);
}

TEST_LABELS(not_sanitized);
TEST(UnwrappingExperiments, ShowThatUnwrappingStretchesLessThanTheSidesOfACube) {
    const Experiment smooth = run_one("unwrapping/smooth-stretch");
    const double given = measurement_of(smooth, "existing charts").error.rms;
    const double usual = measurement_of(smooth, "default").error.rms;
    EXPECT_LT(usual, 0.5 * given);
    EXPECT_LE(measurement_of(smooth, "within 1.1").error.rms, usual);
    EXPECT_LE(measurement_of(smooth, "within 1.1").error.max, 10.0 + 2.0)
        << "relative to the mean density, not to the scale of the chart";
}

TEST(UnwrappingExperiments, CountUnusedTexels) {
    const Experiment texels = run_one("unwrapping/noisy-texels");
    double before = 0.0;
    for (const int padding : {0, 4, 16}) {
        const double unused =
            measurement_of(texels, "padding " + std::to_string(padding)).error.rms;
        EXPECT_GT(unused, before);
        before = unused;
    }
    const Chart& chart = texels.charts.at(0);
    for (std::size_t i = 0; i < chart.curves[0].points.size(); ++i)
        EXPECT_GT(chart.curves[0].points[i].error, chart.curves[1].points[i].error)
            << "the padding alone takes less than all losses together";
    // The covered area is that of the triangles.
    const Mesh mesh = wavy_sphere(16, 0.002);
    UnwrapOptions options;
    options.size = glm::ivec2(512);
    double area = 0.0;
    const Unwrapped unwrapped = unwrap(mesh, options);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::dvec2 origin(unwrapped.corner_texcoords[3 * t]);
        const glm::dvec2 a = glm::dvec2(unwrapped.corner_texcoords[3 * t + 1]) - origin;
        const glm::dvec2 b = glm::dvec2(unwrapped.corner_texcoords[3 * t + 2]) - origin;
        area += 0.5 * std::abs(a.x * b.y - a.y * b.x);
    }
    EXPECT_NEAR(measurement_of(texels, "padding 4").error.rms, 100.0 * (1.0 - area), 1e-3);
}

// A real scan, if there is one: the experiment shows the same order of methods as on the sphere.
TEST_LABELS(slow);
TEST(UnwrappingExperiments, HoldForAScan) {
    RELIEF_NEEDS_SHARED(file, "data/dense/hammer.obj");
    Mesh mesh = read_mesh(file).mesh;
    mesh.texcoords = {};
    PreparedExperiment prepared = unwrapping_stretch(std::move(mesh), "scan of a hammer", 1024);
    const Experiment experiment = measured(std::move(prepared), quick_untimed());
    EXPECT_GT(experiment.measurements.size(), 3U);
    const ErrorStats& usual = measurement_of(experiment, "default").error;
    EXPECT_EQ(usual.undefined, 0U);
    EXPECT_LT(usual.rms, 10.0);
    EXPECT_LE(measurement_of(experiment, "within 1.1").error.rms, usual.rms);
}

}  // namespace
}  // namespace relief::test
