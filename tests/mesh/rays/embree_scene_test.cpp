// SPDX-License-Identifier: Apache-2.0
// What Embree is asked for: the nearest triangle of each ray, every triangle of one, distances.
#include "rays/embree_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace relief {
namespace {

using testing::UnorderedElementsAre;

/// A right triangle in the plane of this z, from (0, 0) to (1, 0) and (0, 1).
void add_triangle(EmbreeScene& scene, std::uint32_t name, float z) {
    const std::array<glm::vec3, 3> corners = {glm::vec3(0, 0, z), {1, 0, z}, {0, 1, z}};
    static const std::array<glm::uvec3, 1> triangles = {glm::uvec3(0, 1, 2)};
    const auto fill = [&](std::size_t begin, std::size_t end, float* xyz) {
        for (std::size_t i = begin; i < end; ++i)
            xyz = std::copy_n(&corners[i].x, 3, xyz);
    };
    scene.add(name, corners.size(), fill, triangles);
}

/// Downwards from z = 1, as far as z = -far.
void aim(RayPacket& packet, std::size_t lane, float x, float y, float far) {
    packet.origin_x[lane] = x;
    packet.origin_y[lane] = y;
    packet.origin_z[lane] = 1.0F;
    packet.near[lane] = packet.time[lane] = 0.0F;
    packet.direction_x[lane] = packet.direction_y[lane] = 0.0F;
    packet.direction_z[lane] = -1.0F;
    packet.far[lane] = 1.0F + far;
    packet.mask[lane] = std::numeric_limits<std::uint32_t>::max();
    packet.id[lane] = packet.flags[lane] = 0;
    packet.mesh[lane] = packet.instance[lane] = RayPacket::nothing;
}

TEST(EmbreeScene, FindsTheNearestTriangleOfEachRayThatItIsAskedFor) {
    EmbreeScene scene;
    add_triangle(scene, 7, 0.0F);
    add_triangle(scene, 3, -0.5F);
    scene.build();
    RayPacket packet;
    aim(packet, 0, 0.25F, 0.25F, 1.0F);
    aim(packet, 1, 0.75F, 0.75F, 1.0F);
    aim(packet, 2, 0.25F, 0.25F, 1.0F);
    packet.origin_z[2] = -0.25F;  // Between the two.
    aim(packet, 3, 0.25F, 0.25F, -0.1F);
    aim(packet, 4, 0.25F, 0.25F, 1.0F);
    scene.find_nearest(packet, 4);
    EXPECT_EQ(packet.mesh[0], 7U);
    EXPECT_EQ(packet.triangle[0], 0U);
    EXPECT_FLOAT_EQ(packet.far[0], 1.0F);
    EXPECT_FALSE(packet.hits(1));
    EXPECT_EQ(packet.mesh[2], 3U);
    EXPECT_FLOAT_EQ(packet.far[2], 0.25F);
    EXPECT_FALSE(packet.hits(3)) << "ends above the first";
    EXPECT_FALSE(packet.hits(4)) << "was not asked for";
}

TEST(EmbreeScene, LooksAtNoLaneThatItIsNotAskedFor) {
    // Of what the stack held before, which is anything, Embree does not end the program.
    EmbreeScene scene;
    add_triangle(scene, 7, 0.0F);
    scene.build();
    for (const float rubbish : {3.8e22F, std::numeric_limits<float>::quiet_NaN()}) {
        RayPacket packet;
        for (std::size_t lane = 0; lane < RayPacket::size; ++lane) {
            aim(packet, lane, rubbish, rubbish, rubbish);
            packet.direction_x[lane] = packet.near[lane] = rubbish;
        }
        for (const std::size_t count : {7U, 8U, 9U}) {
            for (std::size_t lane = 0; lane < count; ++lane)
                aim(packet, lane, 0.25F, 0.25F, 1.0F);
            RayPacket blocked = packet;
            scene.find_nearest(packet, count);
            scene.find_any(blocked, count);
            for (std::size_t lane = 0; lane < count; ++lane) {
                EXPECT_EQ(packet.mesh[lane], 7U);
                EXPECT_TRUE(blocked.is_blocked(lane));
            }
        }
    }
}

TEST(EmbreeScene, FindsEveryTriangleOfASegmentAndAppendsThem) {
    EmbreeScene scene;
    for (const std::uint32_t name : {0U, 1U, 2U})
        add_triangle(scene, name, -static_cast<float>(name));
    scene.build();
    std::vector<MetTriangle> found = {{9, 9}};
    // Of direction -2, so that 0.75 is z = -0.5.
    scene.find_all({{0.25F, 0.25F, 1.0F}, {0, 0, -2}, 0.0F, 1.25F}, found);
    EXPECT_THAT(found,
                UnorderedElementsAre(MetTriangle{9, 9}, MetTriangle{0, 0}, MetTriangle{1, 0}));
    scene.find_all({{0.25F, 0.25F, 1.0F}, {0, 0, 1}, 0.0F, 9.0F}, found);
    EXPECT_EQ(found.size(), 3U);
}

TEST(EmbreeScene, KnowsHowFarTheNearestTriangleIs) {
    EmbreeScene scene;
    add_triangle(scene, 0, 0.0F);
    add_triangle(scene, 1, -2.0F);
    scene.build();
    EXPECT_FLOAT_EQ(scene.distance_from({0.25F, 0.25F, 0.75F}), 0.75F);
    EXPECT_FLOAT_EQ(scene.distance_from({0.25F, 0.25F, -1.5F}), 0.5F);
    EXPECT_FLOAT_EQ(scene.distance_from({-3.0F, -4.0F, 0.0F}), 5.0F);
    EXPECT_FLOAT_EQ(scene.distance_from({2.0F, 0.0F, 0.0F}), 1.0F);
    EXPECT_FLOAT_EQ(scene.distance_from({1.0F, 1.0F, 0.0F}), 0.70710678F);
    // Nothing is that near; then something is, and any such distance will do.
    EXPECT_FLOAT_EQ(scene.distance_from({0.25F, 0.25F, 0.75F}, 0.7F), 0.75F);
    EXPECT_LE(scene.distance_from({0.25F, 0.25F, 0.75F}, 3.0F), 3.0F);
}

TEST(EmbreeScene, LeavesOutWhatIsNotFiniteAndMayBeEmpty) {
    EmbreeScene scene;
    add_triangle(scene, 0, std::numeric_limits<float>::quiet_NaN());
    scene.build();
    EmbreeScene empty;
    empty.build();
    for (const EmbreeScene* nothing : {&scene, &empty}) {
        std::vector<MetTriangle> found;
        nothing->find_all({{0.25F, 0.25F, 1.0F}, {0, 0, -1}, 0.0F, 9.0F}, found);
        EXPECT_TRUE(found.empty());
        EXPECT_EQ(nothing->distance_from({0, 0, 0}), std::numeric_limits<float>::infinity());
    }
}

TEST(EmbreeScene, FindsWhetherRaysHitAnything) {
    EmbreeScene scene;
    add_triangle(scene, 7, 0.0F);
    scene.build();
    RayPacket packet;
    aim(packet, 0, 0.25F, 0.25F, 1.0F);
    aim(packet, 1, 0.75F, 0.75F, 1.0F);
    aim(packet, 2, 0.25F, 0.25F, -0.1F);
    aim(packet, 3, 0.25F, 0.25F, 1.0F);
    packet.direction_z[3] = 1.0F;
    aim(packet, 4, 0.25F, 0.25F, 1.0F);
    packet.origin_z[4] = -1.0F;  // From behind.
    packet.direction_z[4] = 1.0F;
    aim(packet, 5, 0.25F, 0.25F, 1.0F);
    scene.find_any(packet, 5);
    EXPECT_TRUE(packet.is_blocked(0));
    EXPECT_FALSE(packet.is_blocked(1));
    EXPECT_FALSE(packet.is_blocked(2)) << "ends above";
    EXPECT_FALSE(packet.is_blocked(3)) << "runs away from it";
    EXPECT_TRUE(packet.is_blocked(4));
    EXPECT_FALSE(packet.is_blocked(5)) << "was not asked for";
}

}  // namespace
}  // namespace relief
