// SPDX-License-Identifier: Apache-2.0
// Errors of bakes with several samples and formats: they equal those of check_bake(), and the error
// of sampling is separate from that of rounding; and bakes of the sphere with bumps against its
// formula.
#include "relief/accuracy/bake_accuracy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "error_tables/bumpy_reference.h"
#include "experiment_parts.h"
#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/labels.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

struct WavyBake {
    Mesh high = test::waves(256, 20.0);
    BakeOptions options = sized(64, 192);
    Report report;
    Baker baker{std::span(&high, 1), make_quad(), options, report};
    std::vector<NormalMapFormat> formats = {{.bits = 8}, {.bits = 16}};

    BakeCheck check_of(int samples, const NormalMapFormat& format) {
        BakeMapOptions map = options.map;
        map.samples = samples;
        const Image normals = whole_bake(baker, map).normals;
        BakeCheckOptions check;
        check.map = map;
        check.reference_samples = 64;
        return check_bake(baker, encode_normal_map(normals, format, report), check, {}, report);
    }
};

/// The bakes that several tests measure.
WavyBake& shared_bake() {
    static WavyBake bake;
    return bake;
}

/// All texels with 256 samples as the reference, the default.
const BakeReference& whole_map() {
    static const BakeReference reference(shared_bake().baker, shared_bake().options.map, 64 * 192);
    return reference;
}

TEST_LABELS(not_sanitized);
TEST(BakeAccuracy, EqualsACheckOfTheWholeMap) {
    WavyBake& all = shared_bake();
    const BakeReference reference(all.baker, all.options.map, 64 * 192, 64);
    EXPECT_TRUE(reference.is_whole());
    EXPECT_EQ(reference.texels(), 64U * 192U);
    EXPECT_EQ(reference.samples(), 64);
    for (const int samples : {1, 4}) {
        const auto measured = measure_bake(reference, {samples}, all.formats);
        EXPECT_GE(measured[0].rays, static_cast<std::size_t>(samples) * 64U * 192U);
        for (std::size_t i = 0; i < 2; ++i) {
            const BakeCheck check = all.check_of(samples, all.formats[i]);
            EXPECT_NEAR(measured[i].error.rms, check.error.rms, 1e-9);
            EXPECT_EQ(measured[i].error.max, check.error.max);
            const auto codes = static_cast<std::size_t>(BakeStage::quantization);
            EXPECT_NEAR(measured[i].quantization.rms, check.stages.at(codes).error.rms, 1e-6);
        }
    }
}

TEST_LABELS(not_sanitized);
TEST(BakeAccuracy, MoreSamplesAndBitsHaveSmallerErrors) {
    const WavyBake& all = shared_bake();
    const BakeReference& reference = whole_map();
    EXPECT_EQ(reference.samples(), 256);
    const auto one = measure_bake(reference, {1}, all.formats);
    const auto four = measure_bake(reference, {4}, all.formats);
    EXPECT_LT(four[1].error.rms, one[1].error.rms / 2.0);
    EXPECT_LT(four[1].error.rms, four[0].error.rms);
    EXPECT_LT(four[1].quantization.rms, 0.001);
    EXPECT_GT(four[0].quantization.rms, 0.05);
    // A map with one sample at the center is exact there.
    EXPECT_LT(one[1].center.max, 0.002);
}

TEST(BakeAccuracy, ErrorMapsHoldTheErrorsOfEachTexel) {
    const WavyBake& all = shared_bake();
    const BakeReference part(all.baker, all.options.map, 1);
    for (const BakeReference* reference : {&whole_map(), &part}) {
        const auto measured = measure_bake(*reference, {4}, all.formats);
        const Image map = bake_error_map(*reference, {4}, all.formats[0]);
        EXPECT_EQ(map.width, 64);
        EXPECT_EQ(static_cast<std::size_t>(map.height), reference->texels() / 64);
        const std::span<const float> texel_errors = map.as<float>();
        const ErrorStats all_errors = error_stats({texel_errors.begin(), texel_errors.end()});
        EXPECT_EQ(all_errors.count, measured[0].error.count);
        EXPECT_NEAR(all_errors.rms, measured[0].error.rms, 1e-6);
        EXPECT_NEAR(all_errors.max, measured[0].error.max, 1e-6);
    }
}

TEST(BakeAccuracy, APartHasNearlyTheErrorsOfTheWhole) {
    const WavyBake& all = shared_bake();
    const BakeReference part(all.baker, all.options.map, 1);
    EXPECT_FALSE(part.is_whole());
    EXPECT_EQ(part.texels(), 64U * 64U);
    EXPECT_NEAR(measure_bake(part, {1}, all.formats)[1].error.rms,
                measure_bake(whole_map(), {1}, all.formats)[1].error.rms, 0.01);
}

TEST_LABELS(not_sanitized);
TEST(BakeAccuracy, SeparatesSamplingFromRoundingUpTo256Samples) {
    WavyBake& all = shared_bake();
    const BakeReference reference(all.baker, all.options.map, 64, 1024);
    EXPECT_EQ(reference.samples(), 1024);
    const auto few = measure_bake(reference, {16}, all.formats);
    const auto many = measure_bake(reference, {256}, all.formats);
    // A map is not compared with its own samples. Four times as many samples per side are better.
    EXPECT_GT(many[0].sampling_error.rms, 0.0);
    EXPECT_LT(many[0].sampling_error.rms, 0.5 * few[0].sampling_error.rms);
    // Rounding and sampling are independent, and their sum is the error.
    EXPECT_NEAR(many[0].error.rms, std::hypot(many[0].sampling_error.rms, many[0].quantization.rms),
                0.05 * many[0].error.rms);
    // Larger maps have no memory for this number of samples, even if their charts are small.
    BakeMapOptions large = all.options.map;
    large.width = 2112;
    large.height = 64;
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord *= 0.1F;
    const Baker baker(std::span(&all.high, 1), low, all.options, all.report);
    EXPECT_EQ(BakeReference(baker, large, 64, 1024).samples(), 256);
}

constexpr int stacks = 100;
constexpr int map_side = 96;

/// Bakes a map with a number of rays per texel; returns unit normals in object space.
Image baked(const BumpyBake& bake, int samples) {
    BakeMapOptions map = bake.map();
    map.samples = samples;
    Report report;
    return object_from_tangent(whole_bake(bake.baker(), map).normals, bake.baker().low(), {},
                               report)
        .normals;
}

std::vector<test::TexelReference> references(const BumpyBake& bake) {
    Report report;
    Mesh rays = bake.baker().low();  // Rays run along smoothed normals.
    rays.normals = vertex_normals(rays.positions, rays.triangles, NormalWeight::angle, report);
    return test::texel_references(BumpySphere(stacks), rays,
                                  {BumpyBake::low_slices, BumpyBake::low_stacks}, map_side);
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
            const ExactPoint found = BumpySphere::on_surface(1.2 * at, -glm::normalize(at));
            EXPECT_LT(degrees_between(found.normal, glm::cross(south, east)), 1e-5);
            EXPECT_LT(glm::distance(found.position, at), 1e-12);
        }
    }
}

TEST_LABELS(not_sanitized);
TEST(BakeTruth, ManyRaysConvergeToTheFormula) {
    const BumpyBake bake(stacks, map_side);
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
    const auto found =
        measure_bake(bake.reference(), {1}, std::vector<NormalMapFormat>{{.bits = 32}});
    const double between = map_errors(one, directions_of(many)).rms;
    EXPECT_NEAR(found.front().error.rms, between, 0.1 * between);
    // A map with negated x is detected.
    EXPECT_GT(rms_of(many, all, &test::TexelReference::mesh, -1.0), 20.0);
}

}  // namespace
}  // namespace relief::test
