// SPDX-License-Identifier: Apache-2.0
// Checks of a baked map: maps with known errors, and the error of each stage.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/invariants.h"
#include "support/labels.h"

namespace relief {
namespace {

using test::bake;
using test::sized;
using test::waves;

const double degree = std::numbers::pi / 180.0;

Image image_of(const std::vector<float>& normals, const BakeOptions& options) {
    Image image = make_image(options.map.width, options.map.height, 3, 32, ColorSpace::data);
    std::copy(normals.begin(), normals.end(), image.as<float>().begin());
    return image;
}

Image baked_map(const Mesh& high, const Mesh& low, const BakeOptions& options, int bits) {
    Report report;
    return encode_normal_map(image_of(bake({high}, low, options).normals, options), {.bits = bits},
                             report);
}

BakeCheck checked(const Mesh& high, const Mesh& low, const BakeOptions& options, const Image& map,
                  std::vector<float>* errors = nullptr) {
    Report report;
    const Baker baker(std::span(&high, 1), low, options, report);
    BakeCheckOptions check;
    check.map = options.map;
    return check_bake(
        baker, map, check,
        [&](int, std::span<const float> degrees) {
            if (errors != nullptr) errors->insert(errors->end(), degrees.begin(), degrees.end());
        },
        report);
}

StageError stage(const BakeCheck& check, BakeStage stage) {
    return check.stages.at(static_cast<std::size_t>(stage));
}

double all_shares(const BakeCheck& check) {
    return std::accumulate(check.stages.begin(), check.stages.end(), 0.0,
                           [](double sum, const StageError& one) { return sum + one.fraction; });
}

/// A square above that of make_quad(), with these normals.
Mesh tilted_square(const glm::vec3& normal, float height = 0.0F) {
    Mesh mesh = make_quad();
    for (glm::vec3& position : mesh.positions)
        position.z = height;
    mesh.normals.assign(mesh.positions.size(), glm::normalize(normal));
    return mesh;
}

TEST(BakeCheck, NormalsRotatedByADegreeHaveAnErrorOfADegree) {
    const BakeOptions options = sized(64, 96);
    Image map = make_image(64, 96, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 64 * 96; ++i) {
        const double around = 0.1 * static_cast<double>(i);
        const glm::dvec3 n(std::sin(degree) * std::cos(around), std::sin(degree) * std::sin(around),
                           std::cos(degree));
        for (int axis = 0; axis < 3; ++axis)
            map.as<float>()[3 * i + static_cast<std::size_t>(axis)] =
                static_cast<float>((n[axis] + 1.0) / 2.0);
    }
    std::vector<float> errors;
    const BakeCheck check = checked(make_quad(), make_quad(), options, map, &errors);
    EXPECT_EQ(check.error.count, 64U * 96U);
    EXPECT_NEAR(check.error.rms, 1.0, 2e-6);
    EXPECT_NEAR(check.error.mean, 1.0, 2e-6);
    EXPECT_NEAR(check.error.max, 1.0, 2e-5);
    EXPECT_NEAR(check.error.p99, 1.0, 0.02);
    EXPECT_NEAR(check.center.rms, 1.0, 2e-6);
    EXPECT_EQ(check.rebaked.max, 0.0);
    EXPECT_NEAR(stage(check, BakeStage::other).error.rms, 1.0, 2e-6);
    EXPECT_NEAR(stage(check, BakeStage::other).fraction, 1.0, 1e-9);
    EXPECT_EQ(check.discontinuous, 0U);
    ASSERT_EQ(errors.size(), 64U * 96U);
    EXPECT_NEAR(errors[1234], 1.0F, 1e-5F);
    // Vectors in all directions follow no convention.
    EXPECT_TRUE(check.convention.was_searched);
    EXPECT_FALSE(check.convention.is_explained);
}

TEST(BakeCheck, MeshOntoItselfIsFlatWithinQuantization) {
    for (const Mesh& mesh : {make_sphere(), make_torus(), make_cube(), make_cylinder()}) {
        for (const int bits : {8, 16}) {
            const BakeOptions options = sized(96, 64);
            const BakeCheck check =
                checked(mesh, mesh, options, baked_map(mesh, mesh, options, bits));
            EXPECT_EQ(check.missed, 0U);
            // No code is zero: flat has an error of half a code in x and in y. The rest is the
            // rounding error of float.
            const double half_a_code = std::atan(std::sqrt(2.0) / (bits == 8 ? 255.0 : 65535.0));
            EXPECT_NEAR(check.error.max, half_a_code / degree, 0.002) << bits;
            EXPECT_FALSE(check.convention.was_searched);
        }
    }
}

TEST(BakeCheck, QuantizationIsTheErrorOfRounding) {
    const Mesh high = tilted_square({0.6F, 0.0F, 0.8F}, 0.1F);
    const BakeOptions options = sized(32, 32);
    const Image map = baked_map(high, make_quad(), options, 8);
    const BakeCheck check = checked(high, make_quad(), options, map);
    // 127.5 * (0.6, 0, 0.8) is (76.5, 0, 102): 76.5 above 127.5 is a code, and the others lie
    // between two.
    const auto code = [&](std::size_t axis) { return map.as<std::uint8_t>()[axis] - 127.5; };
    EXPECT_EQ(code(0), 76.5);
    EXPECT_EQ(code(1), 0.5);
    EXPECT_EQ(std::abs(code(2) - 102.0), 0.5);
    const double rounded = degrees_between({code(0), code(1), code(2)}, {0.6, 0.0, 0.8});
    EXPECT_NEAR(check.error.rms, rounded, 1e-5);
    EXPECT_NEAR(check.center.rms, rounded, 1e-5);
    EXPECT_NEAR(stage(check, BakeStage::quantization).error.rms, rounded, 1e-5);
    EXPECT_NEAR(stage(check, BakeStage::quantization).fraction, 1.0, 1e-3);
    EXPECT_NEAR(stage(check, BakeStage::other).error.rms, 0.0, 1e-9);
    EXPECT_NEAR(all_shares(check), 1.0, 1e-9);
}

TEST_LABELS(not_sanitized);
TEST(BakeCheck, SamplingIsTheErrorOfOneSample) {
    // A texel has a width of one sixteenth. The waves are three times shorter, so one sample cannot
    // resolve them.
    const Mesh high = waves(512, 100.0);
    BakeOptions options = sized(32, 32);
    const auto errors_of = [&](int samples) {
        options.map.samples = samples;
        return checked(high, make_quad(), options, baked_map(high, make_quad(), options, 32));
    };
    const BakeCheck one = errors_of(1);
    EXPECT_EQ(one.reference_samples, 16);
    EXPECT_GT(one.error.rms, 5.0);
    EXPECT_LT(one.center.max, 1e-4);
    EXPECT_NEAR(stage(one, BakeStage::sampling).error.rms, one.error.rms, 1e-4);
    EXPECT_NEAR(stage(one, BakeStage::sampling).fraction, 1.0, 1e-4);
    const BakeCheck sixteen = errors_of(16);
    EXPECT_EQ(sixteen.reference_samples, 256);
    EXPECT_LT(sixteen.error.rms, 1.5);
    EXPECT_GT(sixteen.center.rms, 5.0);
}

TEST(BakeCheck, BasisIsTheAmplificationBySkewedFrames) {
    const Mesh high = tilted_square({0.6F, 0.0F, 0.8F}, 0.1F);
    Mesh low = make_quad();
    // The tangent leaves the plane by 60 degrees, which changes the angle between x and z.
    low.tangents.assign(low.positions.size(), {0.5F, 0.0F, 0.866025F, 1.0F});
    const BakeOptions options = sized(32, 32);
    const BakeCheck check = checked(high, low, options, baked_map(high, low, options, 8));
    EXPECT_GT(stage(check, BakeStage::quantization).error.rms, 0.01);
    EXPECT_GT(check.error.rms, 0.01);
    EXPECT_NEAR(all_shares(check), 1.0, 1e-9);
    const double whole = std::hypot(stage(check, BakeStage::quantization).error.rms,
                                    stage(check, BakeStage::basis).error.rms);
    EXPECT_GE(whole, check.error.rms - 1e-5);
    low.tangents.assign(low.positions.size(), {1.0F, 0.0F, 0.0F, 1.0F});
    const BakeCheck right = checked(high, low, options, baked_map(high, low, options, 8));
    EXPECT_LT(stage(right, BakeStage::basis).error.rms, 1e-3);
}

TEST(BakeCheck, ProjectionCountsTexelsWithDiscontinuities) {
    // Two squares at different heights, tilted to opposite sides, that meet within the same texels.
    Mesh high = tilted_square({0.6F, 0.0F, 0.8F}, 0.3F);
    Mesh other = tilted_square({-0.6F, 0.0F, 0.8F}, 0.0F);
    for (std::size_t i = 0; i < other.positions.size(); ++i) {
        high.positions[i].x = (high.positions[i].x - 1.0F) / 2.0F + 0.02F;
        other.positions[i].x = (other.positions[i].x + 1.0F) / 2.0F + 0.02F;
    }
    const auto vertices = static_cast<std::uint32_t>(high.positions.size());
    for (std::size_t i = 0; i < other.positions.size(); ++i) {
        high.positions.push_back(other.positions[i]);
        high.normals.push_back(other.normals[i]);
        high.texcoords.push_back(other.texcoords[i]);
    }
    for (const glm::uvec3& triangle : other.triangles)
        high.triangles.push_back(triangle + vertices);
    const BakeOptions options = sized(16, 8);
    const BakeCheck check =
        checked(high, make_quad(), options, baked_map(high, make_quad(), options, 32));
    EXPECT_EQ(check.discontinuous, 8U);  // The column from 0 to 0.125.
    EXPECT_GT(stage(check, BakeStage::projection).error.rms, 5.0);
    EXPECT_NEAR(stage(check, BakeStage::projection).fraction, 1.0, 1e-6);
    ASSERT_EQ(check.worst.size(), 8U);
    EXPECT_EQ(check.worst[0].x, 8);
    EXPECT_TRUE(check.worst[0].is_discontinuous);
}

TEST(BakeCheck, MissedTexelsAreCountedWithoutReference) {
    Mesh high = tilted_square({0.0F, 0.0F, 1.0F});
    for (glm::vec3& position : high.positions)
        position.x = (position.x - 1.0F) / 2.0F;
    const BakeOptions options = sized(32, 32);
    std::vector<float> errors;
    const BakeCheck check =
        checked(high, make_quad(), options, baked_map(high, make_quad(), options, 16), &errors);
    EXPECT_EQ(check.missed, 512U);
    EXPECT_EQ(check.error.count, 512U);
    EXPECT_TRUE(std::isnan(errors[16]));
    // A flat texel of 16 bits has an error of half a code in x and y.
    EXPECT_NEAR(errors[15], 0.00124F, 1e-5F);
}

TEST(BakeCheck, TheWorstTexelsAreNamed) {
    const BakeOptions options = sized(64, 200);
    Image map = baked_map(make_quad(), make_quad(), options, 16);
    const auto tilt = [&](int x, int y, double degrees) {
        const auto first = 3 * static_cast<std::size_t>(y * 64 + x);
        map.as<std::uint16_t>()[first] =
            static_cast<std::uint16_t>(32768 + std::lround(32767 * std::sin(degrees * degree)));
        map.as<std::uint16_t>()[first + 2] =
            static_cast<std::uint16_t>(32768 + std::lround(32767 * std::cos(degrees * degree)));
    };
    tilt(5, 190, 20.0);
    tilt(63, 3, 10.0);
    const BakeCheck check = checked(make_quad(), make_quad(), options, map);
    ASSERT_EQ(check.worst.size(), 8U);
    EXPECT_EQ(check.worst[0].x, 5);
    EXPECT_EQ(check.worst[0].y, 190);
    EXPECT_NEAR(check.worst[0].degrees, 20.0, 0.002);
    EXPECT_EQ(check.worst[1].x, 63);
    EXPECT_NEAR(check.worst[1].degrees, 10.0, 0.002);
    // One of them is at the border of the map.
    EXPECT_EQ(check.outliers, 2U);
    EXPECT_EQ(check.outliers_at_edges, 1U);
    ASSERT_EQ(check.worst_outliers.size(), 2U);
    EXPECT_EQ(check.worst_outliers[1].x, 63);
    EXPECT_EQ(check.worst_outliers[1].y, 3);
    EXPECT_NEAR(check.worst_outliers[1].degrees, 10.0, 0.002);
    EXPECT_NEAR(check.error.rms, std::sqrt(500.0 / (64 * 200)), 1e-3);
    // Flat texels have an error of half a 16-bit code in x and y. Percentiles are read from bins.
    EXPECT_LT(check.error.p99, 0.0015);
}

TEST(BakeCheck, IsTheSameForAnyNumberOfThreads) {
    const Mesh high = make_torus(0.43F, 200, 100);
    const Mesh low = make_torus();
    const BakeOptions options = sized(100, 130);
    const Image map = baked_map(high, low, options, 8);
    const BakeCheck usual = checked(high, low, options, map);
    set_thread_limit(1);
    const BakeCheck alone = checked(high, low, options, map);
    set_thread_limit(0);
    EXPECT_EQ(usual.error.rms, alone.error.rms);
    EXPECT_EQ(usual.error.p99, alone.error.p99);
    for (std::size_t i = 0; i < bake_stage_count; ++i)
        EXPECT_EQ(usual.stages[i].fraction, alone.stages[i].fraction);
}

TEST(BakeCheck, ObjectSpaceNeedsNoFrames) {
    const Mesh high = make_torus(0.43F, 200, 100);
    BakeOptions options = sized(64, 64);
    options.space = VectorSpace::object;
    // A quarter turn about z.
    options.output_from_mesh = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
    const Image map = baked_map(high, make_torus(), options, 16);
    const BakeCheck check = checked(high, make_torus(), options, map);
    EXPECT_EQ(check.error.count, 4096U);
    EXPECT_LT(check.center.max, 0.003);
}

TEST(BakeCheck, RefusesMapsOfAnotherSize) {
    const BakeOptions options = sized(16, 16);
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  checked(make_quad(), make_quad(), options,
                          make_image(8, 16, 3, 8, ColorSpace::data));
              }),
              "the map is of 8 x 16 texels, not 16 x 16");
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  checked(make_quad(), make_quad(), options,
                          make_image(16, 16, 2, 8, ColorSpace::data));
              }),
              "the map has 2 channels, but normals need 3");
}

}  // namespace
}  // namespace relief
