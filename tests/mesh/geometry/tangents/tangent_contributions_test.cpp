// SPDX-License-Identifier: Apache-2.0
// Contributions: by hand, many at once against one by one, and sums of them.
#include "geometry/tangent_contributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

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

glm::dvec3 vector_of(const CornerContribution& contribution) {
    return std::ldexp(1.0, contribution.exponent) *
           glm::dvec3(contribution.x, contribution.y, contribution.z);
}

struct AllContributions {
    std::vector<glm::vec4> corners;
    std::vector<Gradient> kinds;
};

AllContributions contributions_of(const Mesh& mesh, TangentWeight weight) {
    AllContributions contributions{std::vector<glm::vec4>(3 * mesh.triangles.size()), {}};
    contributions.kinds =
        compute_contributions(input_of(mesh), weight, contributions.corners).kinds;
    return contributions;
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

TEST(TangentContributions, AreAsLongAsTheirWeights) {
    const Mesh mesh = right_angle();
    const double quarter = std::numbers::pi / 4.0;
    for (const TangentWeight weight : all_tangent_weights) {
        const AllContributions contributions = contributions_of(mesh, weight);
        EXPECT_EQ(contributions.kinds[0], Gradient::upright);
        for (Corner corner = 0; corner < 3; ++corner) {
            const CornerContribution contribution = contribution_at(contributions.corners, corner);
            EXPECT_EQ(contribution.side, 1);
            EXPECT_EQ(contribution.seen, 0);
            double expected = 2.0;  // Area and stretch.
            if (weight == TangentWeight::angle) expected = corner == 0 ? 2.0 * quarter : quarter;
            EXPECT_NEAR(vector_of(contribution).x, expected, 4e-9);
            EXPECT_EQ(vector_of(contribution).y, 0.0);
            EXPECT_EQ(vector_of(contribution).z, 0.0);
        }
    }
}

TEST(TangentContributions, LieInThePlaneOfTheNormalFromWhichTheAngleIsSeen) {
    Mesh mesh = right_angle();
    mesh.normals[0] = {3, 0, 4};
    // Seen along (0.6, 0, 0.8), (2,0,0) is shortened but not turned: still a right angle.
    const CornerContribution contribution =
        contribution_at(contributions_of(mesh, TangentWeight::angle).corners, 0);
    const glm::dvec3 expected = std::numbers::pi / 2.0 * glm::dvec3(0.8, 0.0, -0.6);
    EXPECT_LE(glm::length(vector_of(contribution) - expected), 4e-9);
    // Lengyel's gradient is shortened by the projection: 2 times 0.8.
    const CornerContribution stretched =
        contribution_at(contributions_of(mesh, TangentWeight::stretch).corners, 0);
    EXPECT_NEAR(glm::length(vector_of(stretched)), 1.6, 4e-9);
}

TEST(TangentContributions, ASkewedTextureIsKnownAsSuch) {
    for (const double degrees : {20.0, 45.0, 50.0, 90.0, 130.0, 135.0, 160.0}) {
        SCOPED_TRACE(degrees);
        Mesh mesh = right_angle();
        // v grows along a direction so many degrees from x.
        const double angle = degrees / 180.0 * std::numbers::pi;
        mesh.positions[2] = {2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0};
        const CornerContribution contribution =
            contribution_at(contributions_of(mesh, TangentWeight::angle).corners, 0);
        EXPECT_EQ(contribution.seen, degrees < 48.0 || degrees > 132.0 ? seen_skewed : 0);
        for (glm::vec3& normal : mesh.normals)
            normal = -normal;
        const CornerContribution behind =
            contribution_at(contributions_of(mesh, TangentWeight::angle).corners, 0);
        EXPECT_EQ(behind.seen, contribution.seen | seen_from_behind);
    }
}

TEST(TangentContributions, AreTheSameOneByOneAndManyAtOnce) {
    std::vector<test::NamedMesh> meshes = test::hard_meshes();
    meshes.push_back({"sphere", test::sphere(40, 20)});
    for (const test::NamedMesh& hard : meshes) {
        SCOPED_TRACE(hard.name);
        for (const TangentWeight weight : all_tangent_weights) {
            const AllContributions contributions = contributions_of(hard.mesh, weight);
            for (std::size_t t = 0; t < hard.mesh.triangles.size(); ++t) {
                const auto careful =
                    contributions_of_any(input_of(hard.mesh), weight, hard.mesh.triangles[t]);
                ASSERT_EQ(contributions.kinds[t], careful.kind) << "triangle " << t;
                for (std::size_t k = 0; k < 3; ++k) {
                    const CornerContribution contribution =
                        contribution_at(contributions.corners, static_cast<Corner>(3 * t + k));
                    ASSERT_EQ(contribution.side, careful.contributions[k].side);
                    const glm::dvec3 expected = vector_of(careful.contributions[k]);
                    // Directions are rounded to float one by one, 6e-8 a number; along a normal to
                    // which they are nearly parallel, that grows.
                    ASSERT_LE(glm::length(vector_of(contribution) - expected),
                              3e-7 * glm::length(expected))
                        << "triangle " << t;
                }
            }
        }
    }
}

TEST(TangentContributions, AreTheSameBitsWithEverySetOfInstructions) {
    const Mesh sphere = test::sphere(60, 30);
    for (const TangentWeight weight : all_tangent_weights) {
        const AllContributions widest = contributions_of(sphere, weight);
        for (const char* bits : {"128", "256"}) {
            setenv("RELIEF_VECTOR_BITS", bits, 1);
            const AllContributions narrow = contributions_of(sphere, weight);
            unsetenv("RELIEF_VECTOR_BITS");
            EXPECT_TRUE(test::same_bits(narrow.corners, widest.corners)) << bits;
        }
    }
}

TEST(TangentContributions, SumsAreExactInAnyOrder) {
    // Contributions of very different length: the order of adding doubles would show.
    std::vector<CornerContribution> contributions;
    for (int i = 0; i < 300; ++i) {
        const double length = std::ldexp(1.0, -(i % 40));
        contributions.push_back(
            contribution_of(length * glm::dvec3(std::cos(i), std::sin(i), std::cos(3 * i)), 1, 0));
    }
    int highest = contributions[0].exponent;
    for (const CornerContribution& contribution : contributions)
        highest = std::max(highest, int(contribution.exponent));
    const ContributionScale scale(highest, contributions.size());
    TangentSum forward;
    TangentSum backward;
    glm::dvec3 expected(0.0);
    for (std::size_t i = 0; i < contributions.size(); ++i) {
        forward += scale.scaled(contributions[i]);
        backward += scale.scaled(contributions[contributions.size() - 1 - i]);
        expected += vector_of(contributions[i]);
    }
    EXPECT_EQ(forward, backward);
    EXPECT_LE(test::degrees_between(forward.vector(), expected), 1e-10);
    EXPECT_FALSE(forward.cancels(1e-6));
    TangentSum nothing = forward;
    for (const CornerContribution& contribution : contributions) {
        const TangentSum scaled = scale.scaled(contribution);
        nothing -= scaled;
    }
    EXPECT_EQ(nothing, TangentSum{});
    EXPECT_TRUE(nothing.cancels(1e-6));
}

TEST(TangentContributions, AMillionOfTheLongestDoNotOverflow) {
    const CornerContribution longest{(1 << 30) - 1, -(1 << 30) + 1, 0, 0, 1, 0};
    const ContributionScale scale(0, 1'000'000);
    TangentSum sum;
    for (int i = 0; i < 1'000'000; ++i)
        sum += scale.scaled(longest);
    EXPECT_EQ(sum.x, -sum.y);
    EXPECT_EQ(sum.x, sum.longest);
    EXPECT_EQ(sum.x % 1'000'000, 0);
    EXPECT_GT(sum.x, std::int64_t(1) << 58) << "the room is used";
}

}  // namespace
}  // namespace relief
