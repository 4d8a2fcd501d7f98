// SPDX-License-Identifier: Apache-2.0
// Mean curvature against surfaces in closed form, and vertices without curvature.
#include "relief/mesh/curvature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"

namespace relief {
namespace {

std::vector<float> curvatures(const Mesh& mesh, Report& report) {
    return mean_curvatures(mesh.positions, mesh.triangles, report);
}

std::vector<float> curvatures(const Mesh& mesh) {
    Report report;
    std::vector<float> values = curvatures(mesh, report);
    // The degenerate triangles at the poles of a sphere are excluded.
    EXPECT_EQ(report.count("vertex on an open or non-manifold edge"), 0U);
    EXPECT_EQ(report.count("vertex without a curvature"), 0U);
    return values;
}

struct CurvatureError {
    double mean = 0.0;
    double largest = 0.0;
};

CurvatureError error_of(const Mesh& mesh,
                        const std::function<double(const glm::dvec3&)>& reference) {
    const std::vector<float> values = curvatures(mesh);
    CurvatureError error;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double off =
            std::abs(static_cast<double>(values[i]) - reference(glm::dvec3(mesh.positions[i])));
        error.mean += off / static_cast<double>(values.size());
        error.largest = std::max(error.largest, off);
    }
    return error;
}

/// When edges are halved, the mean error must fall to a third or less: second order.
void expect_second_order(const std::function<Mesh(int)>& mesh_of,
                         const std::function<double(const glm::dvec3&)>& reference, double finest) {
    double before = std::numeric_limits<double>::infinity();
    for (const int cells : {16, 32, 64}) {
        const CurvatureError error = error_of(mesh_of(cells), reference);
        EXPECT_LT(error.mean, before / 3.0) << cells;
        before = error.mean;
    }
    EXPECT_LT(before, finest);
}

TEST(Curvature, SphereHasTheInverseRadius) {
    for (const float radius : {1e-6F, 0.5F, 1.0F, 1e6F}) {
        Mesh mesh = make_sphere(128, 64);
        for (glm::vec3& position : mesh.positions)
            position *= radius;
        const double r = radius;
        EXPECT_LT(error_of(mesh, [&](const glm::dvec3&) { return 1.0 / r; }).largest, 0.002 / r);
        // From inside, the surface is concave.
        for (glm::uvec3& triangle : mesh.triangles)
            std::swap(triangle.y, triangle.z);
        EXPECT_LT(error_of(mesh, [&](const glm::dvec3&) { return -1.0 / r; }).largest, 0.002 / r);
    }
    expect_second_order([](int cells) { return make_sphere(2 * cells, cells); },
                        [](const glm::dvec3&) { return 1.0; }, 2e-4);
}

TEST(Curvature, TorusHasItsClosedForm) {
    constexpr double tube = 0.4;
    // H = (R + 2 r cos t) / (2 r (R + r cos t)); the distance to the axis is R + r cos t.
    const auto reference = [&](const glm::dvec3& place) {
        const double away = std::hypot(place.x, place.z);
        return (2.0 * away - 1.0) / (2.0 * tube * away);
    };
    expect_second_order([](int cells) { return make_torus(0.4F, 2 * cells, cells); }, reference,
                        2e-3);
}

TEST(Curvature, CylinderHasHalfThatOfItsCircle) {
    const Mesh mesh = make_cylinder(128);
    Mesh side;
    side.positions = mesh.positions;
    // The mesh has no ends and is cut across, so that vertices have several fans.
    for (int row = 0; row <= 8; ++row) {
        for (int i = 0; i < 128; ++i) {
            const double angle = i * 6.283185307179586 / 128;
            side.positions.emplace_back(2.0 * std::sin(angle), row / 4.0 - 1.0,
                                        2.0 * std::cos(angle));
        }
    }
    side.positions.erase(
        side.positions.begin(),
        side.positions.begin() + static_cast<std::ptrdiff_t>(mesh.positions.size()));
    for (std::uint32_t row = 0; row < 8; ++row) {
        for (std::uint32_t i = 0; i < 128; ++i) {
            const std::uint32_t a = 128 * row + i;
            const std::uint32_t b = 128 * row + (i + 1) % 128;
            side.triangles.emplace_back(a, b, a + 128);
            side.triangles.emplace_back(b, b + 128, a + 128);
        }
    }
    Report report;
    const std::vector<float> values = curvatures(side, report);
    EXPECT_EQ(report.count("vertex on an open or non-manifold edge"), 256U);
    // Open rims take the value of the next row.
    for (const float value : values)
        EXPECT_NEAR(value, 0.25, 2e-4);
}

TEST(Curvature, PlaneHasNoneAndAnEdgeItsAngleOverItsWidth) {
    Report report;
    for (const float value : curvatures(make_quad(8), report))
        EXPECT_EQ(value, 0.0F);
    // A roof of slope 1 on both sides of a ridge: it bends by 90 degrees over cells of width
    // sqrt(2).
    Mesh roof = make_quad(4);
    for (glm::vec3& position : roof.positions)
        position.z = 0.5F - std::abs(position.x);
    const std::vector<float> values = curvatures(roof, report);
    const double width = 0.5 * std::sqrt(2.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const glm::vec3& place = roof.positions[i];
        if (std::abs(place.y) > 0.9F || std::abs(place.x) > 0.6F) continue;
        // The chord of that angle, 2 sin(45 degrees), halved, divided by the width.
        const double expected = place.x == 0.0F ? std::sqrt(0.5) / width : 0.0;
        EXPECT_NEAR(values[i], expected, 1e-6) << place.x << " " << place.y;
    }
}

TEST(Curvature, IsTheSameForAnyOrderOfTrianglesNumberOfThreadsAndSplitVertices) {
    Mesh mesh = make_torus(0.3F, 150, 70);
    const std::vector<float> usual = curvatures(mesh);
    set_thread_limit(1);
    EXPECT_EQ(curvatures(mesh), usual);
    set_thread_limit(0);
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    for (glm::uvec3& triangle : mesh.triangles)
        triangle = {triangle.y, triangle.z, triangle.x};
    EXPECT_EQ(curvatures(mesh), usual);
    // Every corner has its own vertex.
    Mesh soup;
    for (const glm::uvec3& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (int corner = 0; corner < 3; ++corner)
            soup.positions.push_back(mesh.positions[triangle[corner]]);
        soup.triangles.emplace_back(first, first + 1, first + 2);
    }
    const std::vector<float> split = curvatures(soup);
    for (std::size_t i = 0; i < soup.positions.size(); ++i) {
        const float whole = usual[mesh.triangles[i / 3][static_cast<int>(i % 3)]];
        // Neighbors have another order.
        ASSERT_NEAR(split[i], whole, 1e-5F);
    }
}

TEST(Curvature, CountsVerticesWithoutCurvature) {
    Mesh mesh = make_sphere(16, 8);
    const std::vector<float> sound = curvatures(mesh);
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.positions.insert(mesh.positions.end(),
                          {{5, 0, 0}, {6, 0, 0}, {7, 0, 0}, {nan, 0, 0}, {9, 0, 0}});
    // A degenerate triangle, one that returns to its first corner, and a non-finite one.
    mesh.triangles.insert(
        mesh.triangles.end(),
        {{count, count + 1, count + 2}, {40, 41, 40}, {count, count + 1, count + 3}});
    Report report;
    const std::vector<float> values = curvatures(mesh, report);
    EXPECT_EQ(report.count("triangle without area under curvature"), 3U + 2U * 16U);
    EXPECT_EQ(report.count("vertex on an open or non-manifold edge"), 4U);
    EXPECT_TRUE(std::equal(sound.begin(), sound.end(), values.begin()));
    for (std::size_t i = count; i < values.size(); ++i)
        EXPECT_EQ(values[i], 0.0F);
    // A third triangle at an edge.
    mesh = make_sphere(16, 8);
    mesh.positions.emplace_back(0, 0, 0);
    mesh.triangles.emplace_back(40, 41, count);
    Report more;
    const std::vector<float> finned = curvatures(mesh, more);
    EXPECT_EQ(more.count("vertex on an open or non-manifold edge"), 3U);
    EXPECT_NEAR(finned[40], 1.0F, 0.1F);
}

}  // namespace
}  // namespace relief
