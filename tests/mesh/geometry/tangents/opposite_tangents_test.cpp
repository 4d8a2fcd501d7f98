// SPDX-License-Identifier: Apache-2.0
// Sums in which opposite directions do not meet, for few members (by pairs) and many (by steps).
#include "geometry/tangent_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace relief {
namespace {

constexpr glm::dvec3 along_z(0.0, 0.0, 1.0);

/// What a contribution of length 1 comes to in sums.
constexpr double unit = 1 << 20;

TangentSum contribution(const glm::dvec3& vector) {
    const auto at = [&](double number) { return std::llround(unit * number); };
    return {at(vector.x), at(vector.y), at(vector.z), at(glm::length(vector))};
}

/// u as given, v a quarter turn from it.
SidedTerm member(const glm::vec3& u, double weight = 1.0) {
    return {contribution(weight * glm::dvec3(u)), u, glm::vec3(-u.y, u.x, 0.0F)};
}

TEST(OppositeTangents, AnOppositeMemberIsLeftOutOfEachOthersSum) {
    const std::vector<SidedTerm> members = {member({1, 0, 0}), member({-1, 0, 0}, 0.5),
                                            member({0, 1, 0}, 0.25)};
    const std::vector<TangentSum> sums = sums_without_opposites(members, along_z);
    EXPECT_EQ(sums[0].vector(), unit * glm::dvec3(1.0, 0.25, 0.0));
    EXPECT_EQ(sums[1].vector(), unit * glm::dvec3(-0.5, 0.25, 0.0));
    EXPECT_EQ(sums[2].vector(), unit * glm::dvec3(0.5, 0.25, 0.0));
}

TEST(OppositeTangents, OppositeInVAloneIsEnough) {
    std::vector<SidedTerm> members = {member({1, 0, 0}), member({1, 0, 0})};
    members[1].along_v = -members[0].along_v;
    for (const TangentSum& sum : sums_without_opposites(members, along_z))
        EXPECT_EQ(sum.vector(), unit * glm::dvec3(1.0, 0.0, 0.0));
}

TEST(OppositeTangents, AMemberWithoutDirectionOpposesNothing) {
    const std::vector<SidedTerm> members = {member({1, 0, 0}), member({0, 0, 0})};
    for (const TangentSum& sum : sums_without_opposites(members, along_z))
        EXPECT_EQ(sum.vector(), unit * glm::dvec3(1.0, 0.0, 0.0));
}

TEST(OppositeTangents, ManyMembersGiveTheSameAsFew) {
    // 200 members in 8 directions, 45 degrees apart: each misses the 25 of the opposite direction.
    std::vector<SidedTerm> members;
    TangentSum all;
    for (int i = 0; i < 200; ++i) {
        const double angle = std::numbers::pi / 4.0 * (i % 8) + 0.3;
        members.push_back(member({std::cos(angle), std::sin(angle), 0.0}, 1.0 + i % 8));
        all += members.back().term;
    }
    const std::vector<TangentSum> sums = sums_without_opposites(members, along_z);
    for (std::size_t i = 0; i < 200; ++i) {
        TangentSum expected = all;
        for (int opposite = 0; opposite < 25; ++opposite)
            expected -= members[(i + 4) % 8].term;
        EXPECT_EQ(sums[i], expected) << "member " << i;
    }
}

TEST(OppositeTangents, TheOrderOfMembersChangesNoBit) {
    std::vector<SidedTerm> members;
    for (int i = 0; i < 300; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 300.0;
        members.push_back(member({std::cos(angle), std::sin(angle), 0.0}, 1.0 / (1.0 + i)));
    }
    const std::vector<TangentSum> forward = sums_without_opposites(members, along_z);
    std::reverse(members.begin(), members.end());
    const std::vector<TangentSum> backward = sums_without_opposites(members, along_z);
    for (std::size_t i = 0; i < 300; ++i)
        EXPECT_EQ(forward[i], backward[299 - i]);
}

}  // namespace
}  // namespace relief
