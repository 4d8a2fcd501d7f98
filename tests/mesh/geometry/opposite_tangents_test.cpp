// SPDX-License-Identifier: Apache-2.0
// Sums in which opposite directions do not meet, for few members (by pairs) and many (by steps).
#include "geometry/opposite_tangents.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace relief {
namespace {

constexpr glm::dvec3 up(0.0, 0.0, 1.0);

/// u as given, v a quarter turn from it.
SidedTerm member(const glm::vec3& u, double weight = 1.0) {
    return {weight * glm::dvec3(u), u, glm::vec3(-u.y, u.x, 0.0F)};
}

TEST(OppositeTangents, AnOppositeMemberIsLeftOutOfEachOthersSum) {
    const std::vector<SidedTerm> members = {member({1, 0, 0}), member({-1, 0, 0}, 0.5),
                                            member({0, 1, 0}, 0.25)};
    const std::vector<StableSum> sums = sums_without_opposites(members, up);
    EXPECT_EQ(sums[0].vector, glm::dvec3(1.0, 0.25, 0.0));
    EXPECT_EQ(sums[1].vector, glm::dvec3(-0.5, 0.25, 0.0));
    EXPECT_EQ(sums[2].vector, glm::dvec3(0.5, 0.25, 0.0));
}

TEST(OppositeTangents, OppositeInVAloneIsEnough) {
    std::vector<SidedTerm> members = {member({1, 0, 0}), member({1, 0, 0})};
    members[1].along_v = -members[0].along_v;
    for (const StableSum& sum : sums_without_opposites(members, up))
        EXPECT_EQ(sum.vector, glm::dvec3(1.0, 0.0, 0.0));
}

TEST(OppositeTangents, AMemberWithoutDirectionOpposesNothing) {
    const std::vector<SidedTerm> members = {member({1, 0, 0}), member({0, 0, 0})};
    for (const StableSum& sum : sums_without_opposites(members, up))
        EXPECT_EQ(sum.vector, glm::dvec3(1.0, 0.0, 0.0));
}

TEST(OppositeTangents, ManyMembersGiveTheSameAsFew) {
    // 200 members in 8 directions, 45 degrees apart: each misses the 25 of the opposite direction.
    std::vector<SidedTerm> members;
    glm::dvec3 all(0.0);
    for (int i = 0; i < 200; ++i) {
        const double angle = std::numbers::pi / 4.0 * (i % 8) + 0.3;
        members.push_back(member({std::cos(angle), std::sin(angle), 0.0}, 1.0 + i % 8));
        all += members.back().term;
    }
    const std::vector<StableSum> sums = sums_without_opposites(members, up);
    for (std::size_t i = 0; i < 200; ++i) {
        const glm::dvec3 expected = all - 25.0 * members[(i + 4) % 8].term;
        // Sums of 200 terms up to 8, rounded: a few times 1e-13.
        EXPECT_LT(glm::length(sums[i].vector - expected), 1e-12) << "member " << i;
    }
}

TEST(OppositeTangents, TheOrderOfMembersChangesNoBit) {
    std::vector<SidedTerm> members;
    for (int i = 0; i < 300; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 300.0;
        members.push_back(member({std::cos(angle), std::sin(angle), 0.0}, 1.0 / (1.0 + i)));
    }
    const std::vector<StableSum> forward = sums_without_opposites(members, up);
    std::reverse(members.begin(), members.end());
    const std::vector<StableSum> backward = sums_without_opposites(members, up);
    for (std::size_t i = 0; i < 300; ++i)
        EXPECT_EQ(forward[i].vector, backward[299 - i].vector);
}

}  // namespace
}  // namespace relief
