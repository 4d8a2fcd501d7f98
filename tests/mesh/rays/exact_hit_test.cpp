// SPDX-License-Identifier: Apache-2.0
// Whether a ray meets a triangle: held to whole numbers, and to closed surfaces, which let no ray
// through.
#include "bake/triangle_clusters.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace relief {
namespace {

using Corners = std::array<glm::dvec3, 3>;

/// Within -1 to 1.
double number(std::mt19937& random) {
    return static_cast<double>(random()) / 2147483648.0 - 1.0;
}

TEST(ExactHit, SaysWhereARayMeetsATriangle) {
    const Corners corners = {glm::dvec3(0, 0, 1), {4, 0, 1}, {0, 4, 5}};
    ExactHit hit;
    // (1, 2) has the weights 1/4, 1/4, 1/2, and lies at z = 3.
    ASSERT_TRUE(intersect(frame_of({1, 2, 9}, {0, 0, -2}), corners, hit));
    EXPECT_EQ(hit.weights, glm::dvec3(0.25, 0.25, 0.5));
    EXPECT_EQ(hit.distance, 3.0);
    EXPECT_TRUE(hit.faces_origin);
    ASSERT_TRUE(intersect(frame_of({1, 2, -1}, {0, 0, 1}), corners, hit));
    EXPECT_EQ(hit.weights, glm::dvec3(0.25, 0.25, 0.5));
    EXPECT_EQ(hit.distance, 4.0);
    EXPECT_FALSE(hit.faces_origin);
    // Behind its origin: the line is asked for, not the ray.
    ASSERT_TRUE(intersect(frame_of({1, 2, -1}, {0, 0, -1}), corners, hit));
    EXPECT_EQ(hit.distance, -4.0);
    EXPECT_FALSE(intersect(frame_of({3, 2, 9}, {0, 0, -1}), corners, hit));
    EXPECT_FALSE(intersect(frame_of({-0x1p-40, 2, 9}, {0, 0, -1}), corners, hit));
    EXPECT_TRUE(intersect(frame_of({0, 2, 9}, {0, 0, -1}), corners, hit)) << "on an edge";
    EXPECT_EQ(hit.weights.y, 0.0);
    EXPECT_TRUE(intersect(frame_of({0, 4, 9}, {0, 0, -1}), corners, hit)) << "on a vertex";
    EXPECT_EQ(hit.weights, glm::dvec3(0, 0, 1));
}

TEST(ExactHit, WhatIsSeenEdgeOnOrHasNoAreaOrIsNotFiniteIsNotMet) {
    ExactHit hit;
    const Corners upright = {glm::dvec3(0, 0, 0), {1, 0, 0}, {0, 0, 1}};
    EXPECT_FALSE(intersect(frame_of({0.25, 0, 9}, {0, 0, -1}), upright, hit));
    EXPECT_FALSE(intersect(frame_of({0, 0, 9}, {0, 0, -1}), upright, hit));
    const Corners line = {glm::dvec3(0, 0, 0), {1, 1, 0}, {3, 3, 0}};
    EXPECT_FALSE(intersect(frame_of({1, 1, 9}, {0, 0, -1}), line, hit));
    const Corners broken = {glm::dvec3(0, 0, 0), {1, 0, 0}, {0, std::nan(""), 0}};
    EXPECT_FALSE(intersect(frame_of({0.1, 0.1, 9}, {0, 0, -1}), broken, hit));
}

/// The sign by whole numbers of 128 bits.
int sign_of(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by) {
    const __int128 cross = static_cast<__int128>(ax) * by - static_cast<__int128>(ay) * bx;
    return cross > 0 ? 1 : (cross < 0 ? -1 : 0);
}

TEST(ExactHit, TheSignOfACrossProductIsExact) {
    std::mt19937_64 random(1);
    std::size_t equal_when_rounded = 0;
    for (int i = 0; i < 20000; ++i) {
        // Of 52 bits, and nearly parallel: b is a / 8, rounded, and one of its neighbours.
        const auto ax = static_cast<std::int64_t>(random() >> 12);
        const auto ay = static_cast<std::int64_t>(random() >> 12);
        const std::int64_t bx = ax / 8 + static_cast<std::int64_t>(random() % 3) - 1;
        const std::int64_t by = ay / 8 + static_cast<std::int64_t>(random() % 3) - 1;
        const glm::dvec2 a(static_cast<double>(ax), static_cast<double>(ay));
        const glm::dvec2 b(static_cast<double>(bx), static_cast<double>(by));
        const double cross = exact_cross(a, b);
        ASSERT_EQ((cross > 0.0) - (cross < 0.0), sign_of(ax, ay, bx, by)) << ax << " " << ay;
        ASSERT_EQ(exact_cross(b, a), -cross);
        if (a.x * b.y == a.y * b.x && cross != 0.0) ++equal_when_rounded;
    }
    EXPECT_GT(equal_when_rounded, 0U) << "the case that needs the remainders";
}

TEST(ExactHit, NoRayPassesBetweenTheTrianglesOfAClosedSurface) {
    // A fan around the origin, moved by numbers that make every coordinate be rounded. Rays run
    // through its center and through points of its spokes.
    std::mt19937 random(2);
    for (int round = 0; round < 2000; ++round) {
        constexpr std::size_t spokes = 7;
        const glm::dvec3 center(glm::vec3(number(random), number(random), number(random)));
        std::array<glm::dvec3, spokes> rim;
        for (std::size_t i = 0; i < spokes; ++i) {
            const double turn = (static_cast<double>(i) + 0.4 * number(random)) * 6.283 / spokes;
            rim[i] = glm::dvec3(glm::vec3(
                center + glm::dvec3(std::cos(turn), std::sin(turn), 0.3 * number(random))));
        }
        const double share = round % 2 == 0 ? 0.0 : 0.5 * (number(random) + 1.0);
        const glm::dvec3 target = glm::mix(center, rim[random() % spokes], share);
        const glm::dvec3 origin =
            target + glm::dvec3(0.2 * number(random), 0.2 * number(random), 3.0);
        const RayFrame frame = frame_of(origin, glm::normalize(target - origin));
        int hits = 0;
        for (std::size_t i = 0; i < spokes; ++i) {
            ExactHit hit;
            if (intersect(frame, {center, rim[i], rim[(i + 1) % spokes]}, hit)) {
                ++hits;
                EXPECT_NEAR(hit.distance, glm::distance(origin, target), 1e-14);
                EXPECT_GE(std::min({hit.weights.x, hit.weights.y, hit.weights.z}), 0.0);
            }
        }
        EXPECT_TRUE(hits >= 1 || share > 0.999) << round;
    }
}

}  // namespace
}  // namespace relief
