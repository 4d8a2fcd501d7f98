// SPDX-License-Identifier: Apache-2.0
// Bakes of the sphere with bumps: the ground truth of the experiments against the formula of the
// surface.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "error_tables/bumpy_reference.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/normals.h"
#include "support/labels.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

constexpr int stacks = 100;
constexpr int side = 96;

/// Bakes a map with a number of rays per texel; returns unit normals in object space.
Image baked(const BumpyBake& bake, int samples) {
    Image normals = make_image(side, side, 3, 32, ColorSpace::data);
    BakeMapOptions map = bake.map();
    map.samples = samples;
    Report report;
    bake.baker().bake(
        map,
        [&](const BakedRows& rows) {
            std::copy(rows.normals.begin(), rows.normals.end(),
                      normals.as<float>().begin() + std::ptrdiff_t{3} * side * rows.first_row);
        },
        report);
    return object_from_tangent(normals, bake.baker().low(), {}, report).normals;
}

std::vector<test::TexelReference> references(const BumpyBake& bake) {
    Report report;
    Mesh rays = bake.baker().low();  // Rays run along smoothed normals.
    rays.normals = vertex_normals(rays.positions, rays.triangles, NormalWeight::angle, report);
    return test::texel_references(BumpySphere(stacks), rays,
                                  {BumpyBake::low_slices, BumpyBake::low_stacks}, side);
}

/// The RMS angle between a map and the formula, in degrees. Can negate x to simulate a defect.
double rms_of(const Image& map, const std::vector<test::TexelReference>& all,
              glm::dvec3 test::TexelReference::*which, double x_sign = 1.0) {
    double squares = 0.0;
    for (const test::TexelReference& ground_truth : all) {
        const float* const n = &map.as<float>()[3 * ground_truth.texel];
        const double degrees =
            degrees_between(glm::dvec3(x_sign * double{n[0]}, n[1], n[2]), ground_truth.*which);
        squares += degrees * degrees;
    }
    return std::sqrt(squares / static_cast<double>(all.size()));
}

TEST(BumpySphere, HasTheNormalsOfItsFormula) {
    // Derivatives of the radius, r = 1 + 0.02 sin(12 longitude) sin(12 polar), by both angles.
    const auto position = [](double longitude, double polar) {
        const double radius = 1.0 + 0.02 * std::sin(12.0 * longitude) * std::sin(12.0 * polar);
        return radius * glm::dvec3(std::sin(polar) * std::sin(longitude), std::cos(polar),
                                   std::sin(polar) * std::cos(longitude));
    };
    for (const double longitude : {0.1, 1.3, -2.0}) {
        for (const double polar : {0.4, 1.5, 2.6}) {
            constexpr double step = 1e-5;
            const glm::dvec3 east =
                position(longitude + step, polar) - position(longitude - step, polar);
            const glm::dvec3 south =
                position(longitude, polar + step) - position(longitude, polar - step);
            const glm::dvec3 at = position(longitude, polar);
            const SurfacePoint found = BumpySphere::on_surface(1.2 * at, -glm::normalize(at));
            EXPECT_LT(degrees_between(found.normal, glm::cross(south, east)), 1e-5);
            EXPECT_LT(glm::distance(found.position, at), 1e-12);
        }
    }
}

/// The RMS angle between two maps over all texels, in degrees.
double rms_between(const Image& a, const Image& b) {
    const std::span<const float> one = a.as<float>();
    const std::span<const float> other = b.as<float>();
    double squares = 0.0;
    for (std::size_t i = 0; i < one.size(); i += 3) {
        const double degrees = degrees_between(glm::dvec3(one[i], one[i + 1], one[i + 2]),
                                               glm::dvec3(other[i], other[i + 1], other[i + 2]));
        squares += degrees * degrees;
    }
    return std::sqrt(squares * 3.0 / static_cast<double>(one.size()));
}

TEST_LABELS(not_sanitized);
TEST(BakeTruth, ManyRaysConvergeToTheFormula) {
    const BumpyBake bake(stacks, side);
    const std::vector<test::TexelReference> all = references(bake);
    ASSERT_GT(all.size(), 150U);
    const Image many = baked(bake, 256);
    const Image one = baked(bake, 1);
    // 256 rays of the baker, and 256 exact intersections in the same squares.
    EXPECT_LT(rms_of(many, all, &test::TexelReference::mesh), 0.1);
    // One ray has the exact normal in the middle, but only approximates the mean.
    EXPECT_LT(rms_of(one, all, &test::TexelReference::mesh_middle), 0.1);
    EXPECT_GT(rms_of(one, all, &test::TexelReference::mesh), 0.3);
    // The experiments use such a bake with 256 rays over all texels, including the poles.
    const BakeMeasurement found =
        measure_bake(bake.reference(), {1}, std::vector<NormalMapFormat>{{.bits = 32}});
    const double between = rms_between(one, many);
    EXPECT_NEAR(found.errors.front().rms, between, 0.1 * between);
    // A map with negated x is detected.
    EXPECT_GT(rms_of(many, all, &test::TexelReference::mesh, -1.0), 20.0);
}

}  // namespace
}  // namespace relief
