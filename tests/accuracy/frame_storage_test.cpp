// SPDX-License-Identifier: Apache-2.0
// Errors of tangent frames that are rotated by known angles, and the results of the experiments.
#include "storage_experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

/// Rounding to float: 2^-24 of a component, 3.4e-6 degrees each.
constexpr double rounding = 1e-5;

/// Frames that are rotated about their normals.
Frames turned(const SampleFrames& ground_truth, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    Frames found{ground_truth.float_normals, ground_truth.float_tangents};
    for (std::size_t i = 0; i < found.normals.size(); ++i) {
        const glm::dvec3 bitangent = glm::cross(ground_truth.normals[i], ground_truth.tangents[i]);
        const glm::dvec3 tangent =
            std::cos(angle) * ground_truth.tangents[i] + std::sin(angle) * bitangent;
        found.tangents[i] = glm::vec4(glm::vec3(tangent), ground_truth.float_tangents[i].w);
    }
    return found;
}

TEST(SampleFrames, EvenOnesAreFramesSpreadEvenly) {
    const SampleFrames frames = even_frames(1000);
    glm::dvec3 sum(0.0);
    glm::dmat3 moments(0.0);
    for (std::size_t i = 0; i < 1000; ++i) {
        EXPECT_NEAR(glm::length(frames.normals[i]), 1.0, 1e-14);
        EXPECT_NEAR(glm::length(frames.tangents[i]), 1.0, 1e-14);
        EXPECT_NEAR(glm::dot(frames.normals[i], frames.tangents[i]), 0.0, 1e-14);
        sum += frames.normals[i];
        moments += glm::outerProduct(frames.normals[i], frames.normals[i]) / 1000.0;
    }
    EXPECT_LE(glm::length(sum), 1.0);  // Of 1000 directions.
    // The squares of evenly spread directions are distributed equally over the axes.
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(moments[i][i], 1.0 / 3.0, 1e-3);
    EXPECT_EQ(frames.float_tangents[0].w, 1.0F);
    EXPECT_EQ(frames.float_tangents[1].w, -1.0F);
}

TEST(FrameErrors, RotatedFramesHaveTheAngleOfRotation) {
    const SampleFrames ground_truth = even_frames(500);
    EXPECT_LE(frame_errors(ground_truth, turned(ground_truth, 0.0)).both.max, rounding);
    const FrameCodeErrors errors = frame_errors(ground_truth, turned(ground_truth, 1.0));
    EXPECT_LE(errors.normal.max, rounding);
    EXPECT_NEAR(errors.tangent.rms, 1.0, rounding);
    EXPECT_NEAR(errors.tangent.max, 1.0, rounding);
    EXPECT_NEAR(errors.both.rms, std::sqrt(0.5), rounding);
    // A direction at 30 degrees to the axis moves on a circle of half the radius.
    const double half = std::numbers::pi / 360.0;
    const double texel = 2.0 * std::asin(0.5 * std::sin(half)) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(errors.texel.rms, texel, rounding);
    EXPECT_EQ(errors.flipped_frames, 0U);
}

TEST(FrameErrors, CountHandsThatAreLost) {
    const SampleFrames ground_truth = even_frames(10);
    Frames found = turned(ground_truth, 0.0);
    found.tangents[3].w = -found.tangents[3].w;
    found.tangents[4].w = -found.tangents[4].w;
    EXPECT_EQ(frame_errors(ground_truth, found).flipped_frames, 2U);
}

}  // namespace
}  // namespace relief::test
