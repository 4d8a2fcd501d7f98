// SPDX-License-Identifier: Apache-2.0
// What Embree is asked for: the nearest triangle of each ray, every triangle of one, distances.
#include "bake/embree_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <list>

namespace relief {
namespace {

using testing::UnorderedElementsAre;

/// A right triangle in the plane of this z, from (0, 0) to (1, 0) and (0, 1).
void add_triangle(EmbreeScene& scene, std::uint32_t name, float z) {
    static std::list<std::array<glm::vec3, 3>> corners;  // Scenes keep no copy.
    static const std::array<glm::uvec3, 1> triangles = {glm::uvec3(0, 1, 2)};
    corners.push_back({glm::vec3(0, 0, z), {1, 0, z}, {0, 1, z}});
    scene.add(name, std::span<const glm::vec3>(corners.back()), triangles);
}

/// Downwards from z = 1, as far as z = -far.
Ray down(double x, double y, double far) {
    return {{x, y, 1.0}, {0.0, 0.0, -1.0}, 0.0, 1.0 + far};
}

const EmbreeSpace space{glm::dvec3(0.0), 2.0};

TEST(EmbreeScene, FindsTheNearestTriangleOfEachRayThatItIsAskedFor) {
    EmbreeScene scene(space, SceneBuild::thorough);
    add_triangle(scene, 7, 0.0F);
    add_triangle(scene, 3, -0.5F);
    scene.build();
    RayPacket packet;
    scene.set(packet, 0, down(0.25, 0.25, 1.0));
    scene.set(packet, 1, down(0.75, 0.75, 1.0));
    scene.set(packet, 2, {{0.25, 0.25, -0.25}, {0, 0, -1}, 0.0, 1.0});  // Between the two.
    scene.set(packet, 3, down(0.25, 0.25, -0.1));
    scene.set(packet, 4, down(0.25, 0.25, 1.0));
    scene.find_nearest(packet, 4);
    EXPECT_EQ(packet.mesh[0], 7U);
    EXPECT_EQ(packet.triangle[0], 0U);
    EXPECT_EQ(packet.distance[0], 1.0);
    EXPECT_FALSE(packet.hits(1));
    EXPECT_EQ(packet.mesh[2], 3U);
    EXPECT_EQ(packet.distance[2], 0.25);
    EXPECT_FALSE(packet.hits(3)) << "ends above the first";
    EXPECT_FALSE(packet.hits(4)) << "was not asked for";
}

TEST(EmbreeScene, EndsOfRaysAreExact) {
    // In double: floats would not tell the two rays apart.
    EmbreeScene scene(space, SceneBuild::thorough);
    add_triangle(scene, 7, 0.0F);
    scene.build();
    for (const bool hits : {true, false}) {
        const double end = hits ? 0.0 : -0x1p-40;
        RayPacket packet;
        scene.set(packet, 0, down(0.25, 0.25, end));
        scene.set(packet, 1, {{0.25, 0.25, 1.0}, {0, 0, -1}, 1.0 - end, 2.0});
        RayPacket blocked = packet;
        scene.find_nearest(packet, 2);
        scene.find_any(blocked, 2);
        for (const std::size_t lane : {0U, 1U}) {
            EXPECT_EQ(packet.hits(lane), hits) << lane;
            EXPECT_EQ(blocked.is_blocked(lane), hits) << lane;
        }
    }
}

TEST(EmbreeScene, LooksAtNoLaneThatItIsNotAskedFor) {
    // Of what the stack held before, which is anything, Embree does not end the program.
    EmbreeScene scene(space, SceneBuild::thorough);
    add_triangle(scene, 7, 0.0F);
    scene.build();
    for (const double rubbish : {3.8e22, std::numeric_limits<double>::quiet_NaN()}) {
        RayPacket packet;
        for (std::size_t lane = 0; lane < RayPacket::size; ++lane)
            scene.set(packet, lane, {glm::dvec3(rubbish), glm::dvec3(rubbish), rubbish, rubbish});
        for (const std::size_t count : {7U, 8U, 9U}) {
            for (std::size_t lane = 0; lane < count; ++lane)
                scene.set(packet, lane, down(0.25, 0.25, 1.0));
            RayPacket blocked = packet;
            scene.find_nearest(packet, count);
            scene.find_any(blocked, count);
            for (std::size_t lane = 0; lane < count; ++lane) {
                EXPECT_EQ(packet.mesh[lane], 7U);
                EXPECT_TRUE(blocked.is_blocked(lane));
            }
        }
        // Asked for all the same, they meet nothing.
        scene.find_nearest(packet, RayPacket::size);
        EXPECT_FALSE(packet.hits(RayPacket::size - 1));
    }
}

TEST(EmbreeScene, KnowsTheFurthestHitUpToAGivenDistance) {
    EmbreeScene scene(space, SceneBuild::thorough);
    for (const std::uint32_t name : {0U, 1U, 2U})
        add_triangle(scene, name, -0.25F * static_cast<float>(name));
    scene.build();
    RayPacket packet;
    scene.set(packet, 0, down(0.25, 0.25, 1.0), 1.25);
    scene.set(packet, 1, down(0.25, 0.25, 1.0), 1.25 - 0x1p-40);
    scene.set(packet, 2, down(0.25, 0.25, 1.0), 0.5);
    scene.set(packet, 3, down(0.25, 0.25, 1.0), 9.0);
    scene.find_nearest(packet, 4);
    for (const std::size_t lane : {0U, 1U, 2U, 3U})
        EXPECT_EQ(packet.distance[lane], 1.0);
    EXPECT_EQ(packet.last[0], 1.25);
    EXPECT_EQ(packet.last[1], 1.0);
    EXPECT_LT(packet.last[2], 0.0) << "there is none";
    EXPECT_EQ(packet.last[3], 1.5);
}

TEST(EmbreeScene, FindsEveryTriangleOfARayAndAppendsThem) {
    EmbreeScene scene(space, SceneBuild::thorough);
    for (const std::uint32_t name : {0U, 1U, 2U})
        add_triangle(scene, name, -static_cast<float>(name));
    scene.build();
    std::vector<MetTriangle> found = {{9, 9}};
    // Of direction -2, so that 0.75 is z = -0.5.
    scene.find_all({{0.25, 0.25, 1.0}, {0, 0, -2}, 0.0, 1.25}, found);
    EXPECT_THAT(found,
                UnorderedElementsAre(MetTriangle{9, 9}, MetTriangle{0, 0}, MetTriangle{1, 0}));
    scene.find_all({{0.25, 0.25, 1.0}, {0, 0, 1}, 0.0, 9.0}, found);
    EXPECT_EQ(found.size(), 3U);
}

TEST(EmbreeScene, OfTrianglesThatCoincideTheFirstInTheGivenOrderIsHit) {
    for (const bool reversed : {false, true}) {
        EmbreeScene scene(space, SceneBuild::thorough,
                          [&](const MetTriangle& a, const MetTriangle& b) {
                              return reversed ? b.mesh < a.mesh : a.mesh < b.mesh;
                          });
        for (const std::uint32_t name : {0U, 1U, 2U})
            add_triangle(scene, name, 0.0F);
        scene.build();
        RayPacket packet;
        scene.set(packet, 0, down(0.25, 0.25, 1.0));
        scene.find_nearest(packet, 1);
        EXPECT_EQ(packet.mesh[0], reversed ? 2U : 0U);
    }
}

TEST(EmbreeScene, KnowsHowFarTheNearestTriangleIs) {
    EmbreeScene scene(space, SceneBuild::thorough);
    add_triangle(scene, 0, 0.0F);
    add_triangle(scene, 1, -2.0F);
    scene.build();
    EXPECT_EQ(scene.distance_from({0.25, 0.25, 0.75}), 0.75);
    EXPECT_EQ(scene.distance_from({0.25, 0.25, -1.5}), 0.5);
    EXPECT_EQ(scene.distance_from({-3.0, -4.0, 0.0}), 5.0);
    EXPECT_EQ(scene.distance_from({2.0, 0.0, 0.0}), 1.0);
    EXPECT_NEAR(scene.distance_from({1.0, 1.0, 0.0}), std::sqrt(0.5), 1e-15);
    // Nothing is that near; then something is, and any such distance will do.
    EXPECT_EQ(scene.distance_from({0.25, 0.25, 0.75}, 0.7), 0.75);
    EXPECT_LE(scene.distance_from({0.25, 0.25, 0.75}, 3.0), 3.0);
}

TEST(EmbreeScene, LeavesOutWhatIsNotFiniteAndMayBeEmpty) {
    EmbreeScene scene(space, SceneBuild::thorough);
    add_triangle(scene, 0, std::numeric_limits<float>::quiet_NaN());
    scene.build();
    EmbreeScene empty(space, SceneBuild::thorough);
    empty.build();
    for (const EmbreeScene* nothing : {&scene, &empty}) {
        std::vector<MetTriangle> found;
        nothing->find_all({{0.25, 0.25, 1.0}, {0, 0, -1}, 0.0, 9.0}, found);
        EXPECT_TRUE(found.empty());
        EXPECT_EQ(nothing->distance_from({0, 0, 0}), std::numeric_limits<double>::infinity());
    }
}

TEST(EmbreeScene, FindsWhetherRaysHitAnything) {
    EmbreeScene scene(space, SceneBuild::thorough);
    add_triangle(scene, 7, 0.0F);
    scene.build();
    RayPacket packet;
    scene.set(packet, 0, down(0.25, 0.25, 1.0));
    scene.set(packet, 1, down(0.75, 0.75, 1.0));
    scene.set(packet, 2, down(0.25, 0.25, -0.1));
    scene.set(packet, 3, {{0.25, 0.25, 1.0}, {0, 0, 1}, 0.0, 2.0});
    scene.set(packet, 4, {{0.25, 0.25, -1.0}, {0, 0, 1}, 0.0, 2.0});  // From behind.
    scene.find_any(packet, 5);
    EXPECT_TRUE(packet.is_blocked(0));
    EXPECT_FALSE(packet.is_blocked(1));
    EXPECT_FALSE(packet.is_blocked(2)) << "ends above";
    EXPECT_FALSE(packet.is_blocked(3)) << "runs away from it";
    EXPECT_TRUE(packet.is_blocked(4));
}

}  // namespace
}  // namespace relief
