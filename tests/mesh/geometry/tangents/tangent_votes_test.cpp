// SPDX-License-Identifier: Apache-2.0
// Votes: by hand, many at once against one by one, and sums of them.
#include "geometry/tangents/tangent_votes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "geometry/tangents/tangent_vote_blocks.h"
#include "hard_meshes.h"
#include "support/angle.h"
#include "support/shapes.h"

namespace relief {
namespace {

constexpr std::array all_tangent_weights = {TangentWeight::angle, TangentWeight::area,
                                            TangentWeight::stretch};

TangentInput input_of(const Mesh& mesh) {
    return {mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles};
}

glm::dvec3 vector_of(const CornerVote& vote) {
    return std::ldexp(1.0, vote.exponent) * glm::dvec3(vote.x, vote.y, vote.z);
}

struct AllVotes {
    std::vector<glm::vec4> corners;
    std::vector<Gradient> kinds;
};

AllVotes votes_of(const Mesh& mesh, TangentWeight weight) {
    AllVotes votes{std::vector<glm::vec4>(3 * mesh.triangles.size()), {}};
    votes.kinds = cast_votes(input_of(mesh), weight, votes.corners).kinds;
    return votes;
}

/// One triangle in the xy plane with a right angle at its first corner; u along x, one unit of it
/// 2 long.
Mesh right_angle() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    mesh.normals.assign(3, {0, 0, 3});
    mesh.texcoords = {{0, 0}, {1, 0}, {0, -1}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

TEST(TangentVotes, AreAsLongAsTheirWeights) {
    const Mesh mesh = right_angle();
    const double quarter = std::numbers::pi / 4.0;
    for (const TangentWeight weight : all_tangent_weights) {
        const AllVotes votes = votes_of(mesh, weight);
        EXPECT_EQ(votes.kinds[0], Gradient::upright);
        for (Corner corner = 0; corner < 3; ++corner) {
            const CornerVote vote = vote_at(votes.corners, corner);
            EXPECT_EQ(vote.side, 1);
            EXPECT_EQ(vote.seen, 0);
            double expected = 2.0;  // Area and stretch.
            if (weight == TangentWeight::angle) expected = corner == 0 ? 2.0 * quarter : quarter;
            EXPECT_NEAR(vector_of(vote).x, expected, 4e-9);
            EXPECT_EQ(vector_of(vote).y, 0.0);
            EXPECT_EQ(vector_of(vote).z, 0.0);
        }
    }
}

TEST(TangentVotes, LieInThePlaneOfTheNormalFromWhichTheAngleIsSeen) {
    Mesh mesh = right_angle();
    mesh.normals[0] = {3, 0, 4};
    // Seen along (0.6, 0, 0.8), (2,0,0) is shortened but not turned: still a right angle.
    const CornerVote vote = vote_at(votes_of(mesh, TangentWeight::angle).corners, 0);
    const glm::dvec3 expected = std::numbers::pi / 2.0 * glm::dvec3(0.8, 0.0, -0.6);
    EXPECT_LE(glm::length(vector_of(vote) - expected), 4e-9);
    // Lengyel's gradient is shortened by the projection: 2 times 0.8.
    const CornerVote stretched = vote_at(votes_of(mesh, TangentWeight::stretch).corners, 0);
    EXPECT_NEAR(glm::length(vector_of(stretched)), 1.6, 4e-9);
}

TEST(TangentVotes, ASkewedTextureIsKnownAsSuch) {
    for (const double degrees : {20.0, 45.0, 50.0, 90.0, 130.0, 135.0, 160.0}) {
        SCOPED_TRACE(degrees);
        Mesh mesh = right_angle();
        // v grows along a direction so many degrees from x.
        const double angle = degrees / 180.0 * std::numbers::pi;
        mesh.positions[2] = {2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0};
        const CornerVote vote = vote_at(votes_of(mesh, TangentWeight::angle).corners, 0);
        EXPECT_EQ(vote.seen, degrees < 48.0 || degrees > 132.0 ? seen_skewed : 0);
        for (glm::vec3& normal : mesh.normals)
            normal = -normal;
        const CornerVote behind = vote_at(votes_of(mesh, TangentWeight::angle).corners, 0);
        EXPECT_EQ(behind.seen, vote.seen | seen_from_behind);
    }
}

TEST(TangentVotes, AreTheSameOneByOneAndManyAtOnce) {
    std::vector<test::NamedMesh> meshes = test::hard_meshes();
    meshes.push_back({"sphere", test::sphere(40, 20)});
    for (const test::NamedMesh& hard : meshes) {
        SCOPED_TRACE(hard.name);
        for (const TangentWeight weight : all_tangent_weights) {
            const AllVotes votes = votes_of(hard.mesh, weight);
            for (std::size_t t = 0; t < hard.mesh.triangles.size(); ++t) {
                const auto careful =
                    careful_votes(input_of(hard.mesh), weight, hard.mesh.triangles[t]);
                ASSERT_EQ(votes.kinds[t], careful.kind) << "triangle " << t;
                for (std::size_t k = 0; k < 3; ++k) {
                    const CornerVote vote = vote_at(votes.corners, static_cast<Corner>(3 * t + k));
                    ASSERT_EQ(vote.side, careful.votes[k].side);
                    const glm::dvec3 expected = vector_of(careful.votes[k]);
                    // Directions are rounded to float one by one, 6e-8 a number; along a normal to
                    // which they are nearly parallel, that grows.
                    ASSERT_LE(glm::length(vector_of(vote) - expected), 3e-7 * glm::length(expected))
                        << "triangle " << t;
                }
            }
        }
    }
}

TEST(TangentVotes, AreTheSameBitsWithEverySetOfInstructions) {
    const Mesh sphere = test::sphere(60, 30);
    for (const TangentWeight weight : all_tangent_weights) {
        const AllVotes widest = votes_of(sphere, weight);
        for (const char* bits : {"128", "256"}) {
            setenv("RELIEF_VECTOR_BITS", bits, 1);
            const AllVotes narrow = votes_of(sphere, weight);
            unsetenv("RELIEF_VECTOR_BITS");
            EXPECT_TRUE(test::same_bits(narrow.corners, widest.corners)) << bits;
        }
    }
}

TEST(TangentVotes, SumsAreExactInAnyOrder) {
    // Votes of very different length: the order of adding doubles would show.
    std::vector<CornerVote> votes;
    for (int i = 0; i < 300; ++i) {
        const double length = std::ldexp(1.0, -(i % 40));
        votes.push_back(
            vote_of(length * glm::dvec3(std::cos(i), std::sin(i), std::cos(3 * i)), 1, 0));
    }
    int highest = votes[0].exponent;
    for (const CornerVote& vote : votes)
        highest = std::max(highest, int(vote.exponent));
    const VoteScale scale(highest, votes.size());
    VoteSum forward;
    VoteSum backward;
    glm::dvec3 expected(0.0);
    for (std::size_t i = 0; i < votes.size(); ++i) {
        forward += scale.scaled(votes[i]);
        backward += scale.scaled(votes[votes.size() - 1 - i]);
        expected += vector_of(votes[i]);
    }
    EXPECT_EQ(forward, backward);
    EXPECT_LE(test::degrees_between(forward.vector(), expected), 1e-10);
    EXPECT_FALSE(forward.cancels(1e-6));
    VoteSum nothing = forward;
    for (const CornerVote& vote : votes) {
        const VoteSum scaled = scale.scaled(vote);
        nothing -= scaled;
    }
    EXPECT_EQ(nothing, VoteSum{});
    EXPECT_TRUE(nothing.cancels(1e-6));
}

TEST(TangentVotes, AMillionOfTheLongestDoNotOverflow) {
    const CornerVote longest{(1 << 30) - 1, -(1 << 30) + 1, 0, 0, 1, 0};
    const VoteScale scale(0, 1'000'000);
    VoteSum sum;
    for (int i = 0; i < 1'000'000; ++i)
        sum += scale.scaled(longest);
    EXPECT_EQ(sum.x, -sum.y);
    EXPECT_EQ(sum.x, sum.longest);
    EXPECT_EQ(sum.x % 1'000'000, 0);
    EXPECT_GT(sum.x, std::int64_t(1) << 58) << "the room is used";
}

}  // namespace
}  // namespace relief
