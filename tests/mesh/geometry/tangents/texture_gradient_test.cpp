// SPDX-License-Identifier: Apache-2.0
// What single triangles say: by hand, at every scale that a float has, and where they say nothing.
#include "geometry/texture_gradient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/angle.h"

namespace relief {
namespace {

using test::degrees_between;

/// A triangle in the xy plane whose u grows along x by 1 in 2 units of length, and whose v up grows
/// along y by 1 in 3.
struct Sample {
    std::vector<glm::vec3> positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    std::vector<glm::vec2> texcoords = {{0, 0}, {1, 0}, {0, -1}};

    [[nodiscard]] TriangleGradient gradient(const glm::uvec3& triangle = {0, 1, 2}) const {
        return triangle_gradient(positions, texcoords, triangle);
    }
};

TEST(TextureGradient, SaysWhereUAndVGrowAndHowFarTheTextureIsStretched) {
    const TriangleGradient found = Sample().gradient();
    EXPECT_EQ(found.kind, Gradient::upright);
    EXPECT_EQ(found.along_u, glm::vec3(1, 0, 0));
    EXPECT_EQ(found.along_v, glm::vec3(0, 1, 0));
    EXPECT_DOUBLE_EQ(found.stretch, 2.0);
}

TEST(TextureGradient, AMirroredTextureTurnsUOnly) {
    Sample sample;
    for (glm::vec2& texcoord : sample.texcoords)
        texcoord.x = -texcoord.x;
    EXPECT_EQ(sample.gradient().kind, Gradient::mirrored);
    EXPECT_EQ(sample.gradient().along_u, glm::vec3(-1, 0, 0));
    EXPECT_EQ(sample.gradient().along_v, glm::vec3(0, 1, 0));
}

TEST(TextureGradient, ScalesChangeTheStretchAlone) {
    for (const int exponent : {-140, -126, -60, 60, 125}) {
        SCOPED_TRACE(exponent);
        Sample sample;
        for (glm::vec3& position : sample.positions)
            position *= std::ldexp(1.0F, exponent);
        EXPECT_EQ(sample.gradient().along_u, glm::vec3(1, 0, 0));
        EXPECT_DOUBLE_EQ(sample.gradient().stretch, std::ldexp(2.0, exponent));
        sample = {};
        for (glm::vec2& texcoord : sample.texcoords)
            texcoord *= std::ldexp(1.0F, exponent);
        EXPECT_EQ(sample.gradient().along_v, glm::vec3(0, 1, 0));
        EXPECT_DOUBLE_EQ(sample.gradient().stretch, std::ldexp(2.0, -exponent));
    }
}

TEST(TextureGradient, EdgesBeyondTheRangeOfFloatsAreStillEdges) {
    Sample sample;
    sample.positions = {{-3e38F, 0, 0}, {3e38F, 0, 0}, {-3e38F, 3e38F, 0}};
    EXPECT_EQ(sample.gradient().kind, Gradient::upright);
    EXPECT_LE(degrees_between(sample.gradient().along_u, {1, 0, 0}), 1e-5);
}

TEST(TextureGradient, AnAxisWhoseSquareVanishesInFloatIsStillADirection) {
    // u grows by 1 and v by 1e-30 over the same edge: the axis along u is 1e-30 long.
    Sample sample;
    sample.texcoords = {{0, 0}, {1, -1e-30F}, {1, -2e-30F}};
    const TriangleGradient found = sample.gradient();
    ASSERT_TRUE(has_gradient(found.kind));
    EXPECT_NEAR(glm::length(found.along_u), 1.0F, 1e-6F);
    // Position = 2 * first * (1,0,0) + ...: u = (2 d1 - d2), v = d2 - d1 up to their lengths.
    EXPECT_LE(degrees_between(found.along_u, {4, -3, 0}), 1e-4);
    EXPECT_LE(degrees_between(found.along_v, {-2, 3, 0}), 1e-4);
}

TEST(TextureGradient, WhatHasNoneSaysWhy) {
    Sample sample;
    EXPECT_EQ(sample.gradient({0, 1, 1}).kind, Gradient::coinciding);
    sample.texcoords[2] = {2, 0};
    EXPECT_EQ(sample.gradient().kind, Gradient::none) << "texture on a line";
    EXPECT_EQ(sample.gradient().along_u, glm::vec3(0.0F));
    sample = {};
    sample.positions[2] = {4, 0, 0};
    EXPECT_TRUE(has_gradient(sample.gradient().kind)) << "a line in space has one direction";
    sample.texcoords = {{0, 0}, {1, 1}, {2, 2}};
    EXPECT_EQ(sample.gradient().kind, Gradient::none);
    sample = {};
    sample.texcoords[1].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(sample.gradient().kind, Gradient::non_finite);
    sample = {};
    sample.positions[0].z = std::numeric_limits<float>::infinity();
    EXPECT_EQ(sample.gradient().kind, Gradient::non_finite);
}

}  // namespace
}  // namespace relief
