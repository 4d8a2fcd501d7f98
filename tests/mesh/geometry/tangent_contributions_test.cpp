// SPDX-License-Identifier: Apache-2.0
// The steps of tangent computation: texture gradients of triangles, neighbors across edges, and
// weighted contributions to sums.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>

#include "geometry/tangent_contributions.h"
#include "geometry/tangent_groups.h"
#include "geometry/tangent_signs.h"
#include "geometry/texture_gradient.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/shapes.h"
#include "support/vector_bits.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::degrees_between;
using testing::ElementsAre;

/// A triangle in the xy plane: u grows by 1 per 2 units along x, and v up by 1 per 3 units along y.
struct Sample {
    std::vector<glm::vec3> positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    std::vector<glm::vec2> texcoords = {{0, 0}, {1, 0}, {0, -1}};

    [[nodiscard]] TriangleGradient gradient(const glm::uvec3& triangle = {0, 1, 2}) const {
        return triangle_gradient(positions, texcoords, triangle);
    }
};

TEST(TextureGradient, HasDirectionAndStretchOfUAndV) {
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
    // u grows by 1 and v by 1e-30 over the same edge: the axis along u has a length of 1e-30.
    Sample sample;
    sample.texcoords = {{0, 0}, {1, -1e-30F}, {1, -2e-30F}};
    const TriangleGradient found = sample.gradient();
    ASSERT_TRUE(has_gradient(found.kind));
    EXPECT_NEAR(glm::length(found.along_u), 1.0F, 1e-6F);
    // Position = 2 * first * (1,0,0) + ...: u = (2 d1 - d2), v = d2 - d1 up to their lengths.
    EXPECT_LE(degrees_between(found.along_u, {4, -3, 0}), 1e-4);
    EXPECT_LE(degrees_between(found.along_v, {-2, 3, 0}), 1e-4);
}

TEST(TextureGradient, StatesWhyItIsMissing) {
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

constexpr Gradient upright = Gradient::upright;
constexpr Gradient mirrored = Gradient::mirrored;
constexpr Gradient no_gradient = Gradient::none;

/// Vertices in ascending order of their values.
struct OrderedVertices {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> texcoords;

    explicit OrderedVertices(std::size_t count) : texcoords(count) {
        for (std::size_t i = 0; i < count; ++i)
            positions.emplace_back(i, 0, 0);
    }
    [[nodiscard]] TangentInput with(const std::vector<glm::uvec3>& triangles) const {
        return {positions, positions, texcoords, triangles};
    }
};

/// The links of all vertices, as corners and triangles of the whole mesh.
struct Links {
    std::vector<Corner> across;
    std::vector<Corner> across_previous;
    std::vector<std::uint32_t> twin;
};

Links links_of(const std::vector<glm::uvec3>& triangles, const std::vector<Gradient>& kinds) {
    constexpr std::size_t vertex_count = 10;
    const CornersByVertex corners(vertex_count, triangles);
    const std::vector<Corner> nobody(3 * triangles.size(), no_corner);
    Links links{nobody, nobody, std::vector<std::uint32_t>(triangles.size())};
    const OrderedVertices vertices(vertex_count);
    const TangentInput mesh = vertices.with(triangles);
    CornerLinker linker(mesh, kinds);
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
        const std::span<const Corner> around = corners.at(vertex);
        linker.link(around);
        const auto corner_at = [&](CornerLinker::Place place) {
            return place == CornerLinker::nowhere ? no_corner : around[place];
        };
        for (CornerLinker::Place i = 0; i < around.size(); ++i) {
            links.across[around[i]] = corner_at(linker.across(i));
            links.across_previous[around[i]] = corner_at(linker.across_previous(i));
            links.twin[triangle_of(around[i])] = triangle_of(corner_at(linker.twin(i)));
        }
    }
    return links;
}

/// Returns the neighbor of triangle `t` across its edge `i` (from corner i to the next one), or -1.
/// Both ends of the edge must agree.
int neighbor(const Links& links, std::uint32_t t, std::uint32_t i) {
    const Corner corner = links.across[3 * t + i];
    const Corner other_end = links.across_previous[3 * t + (i + 1) % 3];
    const int found = corner == no_corner ? -1 : static_cast<int>(triangle_of(corner));
    EXPECT_EQ(found, other_end == no_corner ? -1 : static_cast<int>(triangle_of(other_end)));
    return found;
}

TEST(CornerLinks, TwoTrianglesOfAQuadMeetAtTheDiagonal) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 3}};
    const Links links = links_of(triangles, {upright, upright});
    // Triangle 0 leaves vertex 2 towards 0. Triangle 1 has its corner 1 at vertex 2.
    EXPECT_THAT(links.across, ElementsAre(no_corner, no_corner, 4, 0, no_corner, no_corner));
    EXPECT_THAT(links.across_previous,
                ElementsAre(3, no_corner, no_corner, no_corner, 2, no_corner));
}

TEST(CornerLinks, TrianglesWithTheSameEdgeDirectionAreNotNeighbors) {
    const Links links = links_of({{0, 1, 2}, {0, 1, 3}}, {upright, upright});
    for (const Corner corner : links.across)
        EXPECT_EQ(corner, no_corner);
}

TEST(CornerLinks, AtACrowdedEdgeTrianglesOfOneHandednessPairFirst) {
    // Edge 0-1: two triangles leave vertex 0 (up, down), and two arrive (down, up).
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 0, 5}};
    const Links links = links_of(triangles, {upright, mirrored, mirrored, upright});
    EXPECT_EQ(neighbor(links, 0, 0), 3);
    EXPECT_EQ(neighbor(links, 1, 0), 2);
    EXPECT_EQ(neighbor(links, 2, 0), 1);
    EXPECT_EQ(neighbor(links, 3, 0), 0);
}

TEST(CornerLinks, TiesPairTheSmallestThirdVerticesInAnyOrder) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 3}, {0, 1, 2}, {1, 0, 5}, {1, 0, 4}};
    const Links links = links_of(triangles, {upright, upright, upright, upright});
    EXPECT_EQ(neighbor(links, 1, 0), 3);
    EXPECT_EQ(neighbor(links, 0, 0), 2);
}

TEST(CornerLinks, TriangleWithoutGradientPairsLast) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}, {0, 1, 5}};
    const Links links = links_of(triangles, {upright, upright, no_gradient, mirrored});
    EXPECT_EQ(neighbor(links, 0, 0), 1);
    EXPECT_EQ(neighbor(links, 2, 0), 3);
}

TEST(CornerLinks, TheThirdTriangleOnAnEdgeIsLeftAlone) {
    const Links links = links_of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, {upright, upright, upright});
    EXPECT_EQ(neighbor(links, 0, 0), 1);
    EXPECT_EQ(neighbor(links, 2, 0), -1);
}

TEST(CornerLinks, ARepeatedTriangleIsKnownByItsTwinInAnyRotation) {
    const std::vector<glm::uvec3> triangles = {
        {1, 2, 0}, {0, 1, 2}, {2, 0, 1}, {1, 0, 3}, {2, 1, 0}};
    const Links links = links_of(triangles, {upright, upright, upright, upright, mirrored});
    // The triangle that starts at its smallest vertex counts, in any order.
    EXPECT_THAT(links.twin, ElementsAre(1, 1, 1, 3, 4));
    EXPECT_EQ(neighbor(links, 1, 0), 3);
    EXPECT_EQ(neighbor(links, 3, 0), 1);
    EXPECT_EQ(neighbor(links, 0, 2), -1);
}

TEST(CornerLinks, BothEndsOfCrowdedEdgesAgree) {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        std::vector<glm::uvec3> triangles;
        std::vector<Gradient> kinds;
        while (triangles.size() < 30) {
            const glm::uvec3 triangle(random() % 6, random() % 6, random() % 6);
            if (triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x)
                continue;
            triangles.push_back(triangle);
            // Repeated triangles have the same kind.
            kinds.push_back(std::array{upright, mirrored,
                                       no_gradient}[(triangle.x + triangle.y + triangle.z) % 3]);
        }
        const Links links = links_of(triangles, kinds);
        int neighbors = 0;
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            for (std::uint32_t i = 0; i < 3; ++i)
                neighbors += neighbor(links, t, i) >= 0 ? 1 : 0;
        }
        EXPECT_GT(neighbors, 0);
    }
}

/// Returns whether the corners of triangles around a vertex form one fan: a walk from the first
/// corner without predecessor, or from any corner, reaches all.
bool is_walked_whole(const std::vector<std::uint32_t>& next,
                     const std::vector<std::uint32_t>& previous) {
    std::vector<glm::uvec3> triangles;
    std::vector<Corner> around;
    for (std::size_t i = 0; i < next.size(); ++i) {
        around.push_back(static_cast<Corner>(3 * i));
        triangles.emplace_back(100, next[i], previous[i]);
    }
    const std::vector<Gradient> kinds(next.size(), upright);
    const OrderedVertices vertices(101);
    const TangentInput mesh = vertices.with(triangles);
    CornerLinker linker(mesh, kinds);
    linker.link(around);
    for (CornerLinker::Place i = 0; i < next.size(); ++i) {
        if (linker.twin(i) != i) return false;
        for (CornerLinker::Place k = 0; k < i; ++k) {
            // A third triangle.
            if (next[i] == next[k] || previous[i] == previous[k]) return false;
        }
    }
    CornerLinker::Place first = 0;
    for (std::size_t steps = 0; steps < next.size(); ++steps) {
        if (linker.across_previous(first) == CornerLinker::nowhere) break;
        first = linker.across_previous(first);
    }
    std::size_t reached = 1;
    for (CornerLinker::Place i = linker.across(first); i != CornerLinker::nowhere && i != first;
         i = linker.across(i))
        ++reached;
    return reached == next.size();
}

bool is_one_fan(const std::vector<std::uint32_t>& next,
                const std::vector<std::uint32_t>& previous) {
    // The rest of the arrays may hold vertices of an earlier fan.
    FanVertices all_next, all_previous;
    for (std::uint32_t i = 0; i < max_single_fan; ++i) {
        all_next[i] = i < next.size() ? next[i] : i;
        all_previous[i] = i < next.size() ? previous[i] : i % 3;
    }
    return is_single_fan(all_next, all_previous, static_cast<std::uint32_t>(next.size()));
}

TEST(CornerLinks, SingleFansAreRecognized) {
    EXPECT_TRUE(is_one_fan({1U}, {2U}));
    EXPECT_TRUE(is_one_fan({1U, 2U, 3U}, {3U, 1U, 2U})) << "a ring";
    EXPECT_TRUE(is_one_fan({2U, 1U}, {3U, 2U})) << "a chain";
    EXPECT_FALSE(is_one_fan({1U, 3U}, {2U, 4U})) << "two apart";
    EXPECT_FALSE(is_one_fan({1U, 1U}, {2U, 2U})) << "a triangle twice";
    EXPECT_FALSE(is_one_fan({1U, 2U, 3U, 4U}, {2U, 1U, 4U, 3U})) << "two rings";
    EXPECT_FALSE(is_one_fan({1U, 1U, 5U}, {2U, 3U, 1U})) << "a third";

    for (const std::uint32_t count : {3U, 8U, 9U, 16U}) {
        std::vector<std::uint32_t> next, previous;
        for (std::uint32_t i = 0; i < count; ++i) {
            next.push_back((7 * i + 7) % (7 * count));
            previous.push_back(7 * i);
        }
        EXPECT_TRUE(is_one_fan(next, previous)) << "a ring of " << count;
        next.back() = 1;
        EXPECT_TRUE(is_one_fan(next, previous)) << "a chain of " << count;
        previous[count / 2] = 2;
        EXPECT_FALSE(is_one_fan(next, previous)) << "two chains";
        next.back() = next.front();
        EXPECT_FALSE(is_one_fan(next, previous)) << "a third triangle";
    }

    std::mt19937 random(3);
    int fans = 0;
    for (int round = 0; round < 20000; ++round) {
        const std::size_t count = 1 + random() % 5;
        std::vector<std::uint32_t> next, previous;
        for (std::size_t i = 0; i < count; ++i) {
            next.push_back(static_cast<std::uint32_t>(random() % 5));
            previous.push_back(static_cast<std::uint32_t>((next.back() + 1 + random() % 4) % 5));
        }
        const bool expected = is_walked_whole(next, previous);
        ASSERT_EQ(is_one_fan(next, previous), expected) << "round " << round;
        fans += expected ? 1 : 0;
    }
    EXPECT_GT(fans, 500);
    EXPECT_LT(fans, 15000);
}

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

/// A triangle in the xy plane with a right angle at its first corner. u runs along x, and one unit
/// of u has a length of 2.
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
    // In the direction (0.6, 0, 0.8), the projection of (2,0,0) is shorter but not rotated: the
    // angle stays 90 degrees.
    const CornerContribution contribution =
        contribution_at(contributions_of(mesh, TangentWeight::angle).corners, 0);
    const glm::dvec3 expected = std::numbers::pi / 2.0 * glm::dvec3(0.8, 0.0, -0.6);
    EXPECT_LE(glm::length(vector_of(contribution) - expected), 4e-9);
    // The projection shortens Lengyel's gradient: 2 times 0.8.
    const CornerContribution stretched =
        contribution_at(contributions_of(mesh, TangentWeight::stretch).corners, 0);
    EXPECT_NEAR(glm::length(vector_of(stretched)), 1.6, 4e-9);
}

TEST(TangentContributions, ASkewedTextureIsKnownAsSuch) {
    for (const double degrees : {20.0, 45.0, 50.0, 90.0, 130.0, 135.0, 160.0}) {
        SCOPED_TRACE(degrees);
        Mesh mesh = right_angle();
        // v grows along a direction at this angle to x.
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
                    // Directions are rounded to float one by one, 6e-8 per number. For a normal
                    // that is almost parallel to them, the error grows.
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
            const test::VectorBits width(bits);
            const AllContributions narrow = contributions_of(sphere, weight);
            EXPECT_TRUE(test::same_bits(narrow.corners, widest.corners)) << bits;
        }
    }
}

TEST(TangentContributions, SumsAreExactInAnyOrder) {
    // Contributions of very different length: a sum of doubles would depend on the order.
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

TEST(TangentGroups, LeaveOutTermsThatAreExactlyOpposite) {
    // b is opposite to a in u and v; c is at a right angle to both.
    const TangentSum a{1, 0, 0, 1};
    const TangentSum b{-10, 0, 0, 10};
    const TangentSum c{0, 100, 0, 100};
    for (const std::int64_t copies : {1, 60}) {  // Pair by pair, and by steps of directions.
        SCOPED_TRACE(copies);
        std::vector<SidedTerm> members;
        for (std::int64_t i = 0; i < copies; ++i) {
            members.push_back({a, {1, 0, 0}, {0, 1, 0}});
            members.push_back({b, {-1, 0, 0}, {0, -1, 0}});
            members.push_back({c, {0, 1, 0}, {-1, 0, 0}});
        }
        const std::vector<TangentSum> sums = sums_without_opposites(members, {0, 0, 1});
        const auto sum_of = [&](std::int64_t x, std::int64_t y, std::int64_t longest) {
            return TangentSum{copies * x, copies * y, 0, copies * longest};
        };
        EXPECT_EQ(sums[0], sum_of(1, 100, 101));
        EXPECT_EQ(sums[1], sum_of(-10, 100, 110));
        EXPECT_EQ(sums[2], sum_of(-9, 100, 111));
    }
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

TEST(TextureGradient, OfANeedleNearTheOriginDependsOnTheFirstCorner) {
    // The pole of a sphere at sin(pi): seen from the far corner, the near ones have equal edges.
    const std::vector<glm::vec3> positions = {
        {0.097F, -1.001F, -0.019F}, {1.22e-16F, -1.0F, -1.2e-17F}, {1.20e-16F, -1.0F, -2.4e-17F}};
    const std::vector<glm::vec2> texcoords = {{0.0F, 0.96875F}, {0.015625F, 1.0F}, {0.0F, 1.0F}};
    EXPECT_EQ(triangle_gradient(positions, texcoords, {0, 1, 2}).kind, Gradient::none);
    EXPECT_NE(triangle_gradient(positions, texcoords, {1, 2, 0}).kind, Gradient::none);
    EXPECT_NE(triangle_gradient(positions, texcoords, {2, 0, 1}).kind, Gradient::none);
}

}  // namespace
}  // namespace relief
