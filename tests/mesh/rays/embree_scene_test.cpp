// SPDX-License-Identifier: Apache-2.0
// Ray casting: the exact ray-triangle test, clusters of triangles, and the queries that Embree
// answers.
#include "bake/embree_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <list>
#include <random>
#include <set>
#include <string>

#include "bake/triangle_clusters.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

using Corners = std::array<glm::dvec3, 3>;
using testing::UnorderedElementsAre;

/// Returns a number from -1 to 1.
double number(std::mt19937& random) {
    return static_cast<double>(random()) / 2147483648.0 - 1.0;
}

TEST(ExactHit, LocatesTheIntersection) {
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
    // The hit is behind the origin: the function tests the line, not the ray.
    ASSERT_TRUE(intersect(frame_of({1, 2, -1}, {0, 0, -1}), corners, hit));
    EXPECT_EQ(hit.distance, -4.0);
    EXPECT_FALSE(intersect(frame_of({3, 2, 9}, {0, 0, -1}), corners, hit));
    EXPECT_FALSE(intersect(frame_of({-0x1p-40, 2, 9}, {0, 0, -1}), corners, hit));
    EXPECT_TRUE(intersect(frame_of({0, 2, 9}, {0, 0, -1}), corners, hit)) << "on an edge";
    EXPECT_EQ(hit.weights.y, 0.0);
    EXPECT_TRUE(intersect(frame_of({0, 4, 9}, {0, 0, -1}), corners, hit)) << "on a vertex";
    EXPECT_EQ(hit.weights, glm::dvec3(0, 0, 1));
}

TEST(ExactHit, MissesEdgeOnDegenerateAndNonFiniteTriangles) {
    ExactHit hit;
    const Corners upright = {glm::dvec3(0, 0, 0), {1, 0, 0}, {0, 0, 1}};
    EXPECT_FALSE(intersect(frame_of({0.25, 0, 9}, {0, 0, -1}), upright, hit));
    EXPECT_FALSE(intersect(frame_of({0, 0, 9}, {0, 0, -1}), upright, hit));
    const Corners line = {glm::dvec3(0, 0, 0), {1, 1, 0}, {3, 3, 0}};
    EXPECT_FALSE(intersect(frame_of({1, 1, 9}, {0, 0, -1}), line, hit));
    const Corners broken = {glm::dvec3(0, 0, 0), {1, 0, 0}, {0, std::nan(""), 0}};
    EXPECT_FALSE(intersect(frame_of({0.1, 0.1, 9}, {0, 0, -1}), broken, hit));
}

/// Returns the sign by 128-bit integers.
int sign_of(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by) {
    const __int128 cross = static_cast<__int128>(ax) * by - static_cast<__int128>(ay) * bx;
    return cross > 0 ? 1 : (cross < 0 ? -1 : 0);
}

TEST(ExactHit, TheSignOfACrossProductIsExact) {
    std::mt19937_64 random(1);
    std::size_t equal_when_rounded = 0;
    for (int i = 0; i < 20000; ++i) {
        // The values have 52 bits and are almost parallel: b is a / 8, rounded, or one of its
        // neighbors.
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
    // A fan around the origin, translated so that every coordinate is rounded. Rays go through its
    // center and through points of its spokes.
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

using Cluster = TriangleCluster<float>;

struct Soup {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;

    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.emplace_back(first, first + 1, first + 2);
    }
    [[nodiscard]] TriangleClusters<float> clusters(const EmbreeSpace& around = {}) const {
        return make_clusters(std::span(positions), std::span(triangles), around);
    }
};

/// Squares of two triangles each, `side` along each side of the square from -1 to 1.
Soup grid(int side) {
    Soup soup;
    const auto at = [&](int i) {
        return 2.0F * static_cast<float>(i) / static_cast<float>(side) - 1.0F;
    };
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::vec3 a(at(x), at(y), 0), b(at(x + 1), at(y), 0), c(at(x + 1), at(y + 1), 0),
                d(at(x), at(y + 1), 0);
            soup.add(a, b, c);
            soup.add(a, c, d);
        }
    }
    return soup;
}

std::vector<std::uint32_t> triangles_of(const Cluster& cluster) {
    const auto end = std::find(cluster.triangles.begin(), cluster.triangles.end(), Cluster::none);
    return {cluster.triangles.begin(), end};
}

TEST(TriangleClusters, HoldEachTriangleThatCanBeMetOnce) {
    Soup soup = grid(40);
    const auto usable = static_cast<std::uint32_t>(soup.triangles.size());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    soup.add({0, 0, 0}, {0.5F, 0, nan}, {0, 0.5F, 0});
    soup.add({0, 0, 0}, {0.5F, 0.5F, 0}, {1, 1, 0});
    soup.add({0.5F, 0, 0}, {0.5F, 0, 0}, {0, 1, 0});
    soup.add({0, 0, 0}, {std::numeric_limits<float>::infinity(), 0, 0}, {0, 1, 0});
    const EmbreeSpace shifted{{0.25, 0.0, 0.0}, 1.25};
    const TriangleClusters<float> all = soup.clusters(shifted);
    ASSERT_EQ(all.boxes.size(), all.clusters.size());
    std::vector<int> count(soup.triangles.size(), 0);
    for (std::size_t i = 0; i < all.clusters.size(); ++i) {
        const std::vector<std::uint32_t> triangles = triangles_of(all.clusters[i]);
        EXPECT_FALSE(triangles.empty());
        for (std::size_t place = 0; place < triangles.size(); ++place) {
            ++count[triangles[place]];
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const glm::uvec3& vertices = soup.triangles[triangles[place]];
                const glm::dvec3 position(soup.positions[vertices[static_cast<int>(corner)]]);
                EXPECT_EQ(all.clusters[i].corners_of(place)[corner], position);
                // Rounded to float, a box is larger by the margin except for 6e-8.
                const glm::dvec3 in_space = (position - shifted.center) / shifted.half_size;
                const double least = embree_margin - 1e-7;
                const glm::dvec3 below = in_space - glm::dvec3(all.boxes[i].lower);
                const glm::dvec3 above = glm::dvec3(all.boxes[i].upper) - in_space;
                EXPECT_GE(std::min({below.x, below.y, below.z}), least);
                EXPECT_GE(std::min({above.x, above.y, above.z}), least);
            }
        }
    }
    for (std::uint32_t i = 0; i < soup.triangles.size(); ++i)
        EXPECT_EQ(count[i], i < usable ? 1 : 0) << i;
}

TEST(TriangleClusters, AreTheSameInAnyOrderOfTriangles) {
    const auto sets_of = [](const Soup& soup) {
        std::set<std::set<std::array<float, 3>>> sets;
        for (const Cluster& cluster : soup.clusters().clusters) {
            std::set<std::array<float, 3>> set;
            for (const std::uint32_t triangle : triangles_of(cluster)) {
                const glm::uvec3& corners = soup.triangles[triangle];
                const glm::vec3 sum = soup.positions[corners.x] + soup.positions[corners.y] +
                                      soup.positions[corners.z];
                set.insert({sum.x, sum.y, sum.z});
            }
            sets.insert(set);
        }
        return sets;
    };
    Soup soup = grid(64);
    const auto expected = sets_of(soup);
    // A cluster holds at least two squares of two triangles, and at most four.
    EXPECT_LE(expected.size(), soup.triangles.size() / 4);
    std::mt19937 random(3);
    for (std::size_t i = soup.triangles.size(); i > 1; --i)
        std::swap(soup.triangles[i - 1], soup.triangles[random() % i]);
    EXPECT_EQ(sets_of(soup), expected);
}

TEST(TriangleClusters, KeepTrianglesApartThatAreFarFromEachOther) {
    Soup soup;
    for (const float x : {-1.0F, -0.5F, 0.5F, 1.0F})
        soup.add({x, 0, 0}, {x + 0.01F, 0, 0}, {x, 0.01F, 0});
    EXPECT_EQ(soup.clusters().clusters.size(), 4U);
    Soup nothing;
    EXPECT_TRUE(nothing.clusters().clusters.empty());
}

TEST(TriangleClusters, MayContainCoincidentTriangles) {
    Soup soup;
    for (int i = 0; i < 100; ++i)
        soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    std::size_t count = 0;
    for (const Cluster& cluster : soup.clusters().clusters)
        count += triangles_of(cluster).size();
    EXPECT_EQ(count, 100U);
}

/// Returns a number from -1 to 1. Every second one is a multiple of 1/4, for rays that meet edges
/// and vertices.
double coordinate(std::mt19937& random) {
    if (random() % 2 == 0) return static_cast<double>(random() % 9) / 4.0 - 1.0;
    return static_cast<double>(random()) / 2147483648.0 - 1.0;
}

glm::dvec3 point(std::mt19937& random) {
    const double x = coordinate(random);
    const double y = coordinate(random);
    return {x, y, coordinate(random)};
}

std::uint32_t offers(const Cluster& cluster, const RayFrame& frame) {
    RayLines<16> lines{};
    lines.set(3, frame);
    return candidates(cluster, lines, 3);
}

TEST(TriangleClusters, EveryTriangleThatARayMeetsIsACandidate) {
    std::mt19937 random(4);
    std::size_t met = 0;
    std::size_t offered = 0;
    std::size_t all = 0;
    for (int round = 0; round < 500; ++round) {
        Soup soup;
        for (int i = 0; i < 40; ++i)
            soup.add(point(random), point(random), point(random));
        const TriangleClusters<float> clusters = soup.clusters();
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 direction = point(random);
            if (glm::length(direction) == 0.0) continue;
            const RayFrame frame = frame_of(2.0 * point(random), direction);
            for (const Cluster& cluster : clusters.clusters) {
                const std::uint64_t bits = offers(cluster, frame);
                for (std::size_t place = 0; place < Cluster::size; ++place) {
                    const bool is_used = cluster.triangles[place] != Cluster::none;
                    const bool is_offered = (bits >> place & 1U) != 0;
                    ExactHit hit;
                    const bool is_met = is_used && intersect(frame, cluster.corners_of(place), hit);
                    ASSERT_TRUE(is_offered || !is_met) << round;
                    ASSERT_TRUE(is_used || !is_offered) << round;
                    all += is_used ? 1 : 0;
                    offered += is_offered ? 1 : 0;
                    met += is_met ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GT(met, all / 50) << "rays meet triangles";
    EXPECT_LT(offered, met + all / 50) << "and most others are no candidates";
}

TEST(TriangleClusters, LinesHaveTheSameCandidatesTogetherAndOneByOne) {
    std::mt19937 random(5);
    Soup soup;
    for (int i = 0; i < 400; ++i)
        soup.add(point(random), point(random), point(random));
    const TriangleClusters<float> clusters = soup.clusters();
    int offered = 0;
    for (const int axis : {0, 1, 2}) {
        RayLines<16> lines{};
        for (std::size_t i = 0; i < 16; ++i) {
            glm::dvec3 direction = 0.5 * point(random);
            direction[axis] = i % 2 == 0 ? 1.5 : -1.5;
            lines.set(i, frame_of(2.0 * point(random), direction));
        }
        for (const Cluster& cluster : clusters.clusters) {
            for (const std::size_t count : {4U, 8U, 16U}) {
                const std::size_t begin = 16 - count;
                std::array<std::uint64_t, 16> together{};
                candidates(cluster, lines, begin, count, together);
                for (std::size_t i = 0; i < count; ++i) {
                    const std::uint32_t alone = candidates(cluster, lines, begin + i);
                    EXPECT_EQ(together[i], alone) << count << " " << i;
                    offered += alone != 0 ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GT(offered, 100);
}

/// A right triangle in the plane of this z, from (0, 0) to (1, 0) and (0, 1).
void add_triangle(EmbreeScene& scene, std::uint32_t name, float z) {
    static std::list<std::array<glm::vec3, 3>> corners;  // Scenes keep no copy.
    static const std::array<glm::uvec3, 1> triangles = {glm::uvec3(0, 1, 2)};
    corners.push_back({glm::vec3(0, 0, z), {1, 0, z}, {0, 1, z}});
    scene.add(name, std::span<const glm::vec3>(corners.back()), triangles);
}

/// A ray downwards from z = 1 to z = -far.
Ray down(double x, double y, double far) {
    return {{x, y, 1.0}, {0.0, 0.0, -1.0}, 0.0, 1.0 + far};
}

const EmbreeSpace space{glm::dvec3(0.0), 2.0};

TEST(EmbreeScene, FindsTheNearestTriangleOfEachActiveRay) {
    EmbreeScene scene(space, SceneBuild::thorough);
    add_triangle(scene, 7, 0.0F);
    add_triangle(scene, 3, -0.5F);
    scene.build();
    RayPacket packet;
    scene.set(packet, 0, down(0.25, 0.25, 1.0));
    scene.set(packet, 1, down(0.75, 0.75, 1.0));
    scene.set(packet, 2, {{0.25, 0.25, -0.25}, {0, 0, -1}, 0.0, 1.0});  // Between both triangles.
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

TEST(EmbreeScene, AConfigurationThatEmbreeRefusesIsAnError) {
    const char* const given = std::getenv("RELIEF_EMBREE");
    const std::string before = given == nullptr ? "" : given;
    ::setenv("RELIEF_EMBREE", "threads=many", 1);
    EXPECT_THROW(EmbreeScene(space, SceneBuild::fast), Error);
    if (given == nullptr)
        ::unsetenv("RELIEF_EMBREE");
    else
        ::setenv("RELIEF_EMBREE", before.c_str(), 1);
}

TEST(EmbreeScene, EndsOfRaysAreExact) {
    // The test uses double, because floats would not distinguish the two rays.
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

TEST(EmbreeScene, IgnoresInactiveLanes) {
    // The unused rays hold arbitrary stack contents. Embree must not end the program.
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
        // Queries of these rays find nothing.
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
    // The direction has length 2, so 0.75 is z = -0.5.
    scene.find_all({{0.25, 0.25, 1.0}, {0, 0, -2}, 0.0, 1.25}, found);
    EXPECT_THAT(found,
                UnorderedElementsAre(MetTriangle{9, 9}, MetTriangle{0, 0}, MetTriangle{1, 0}));
    scene.find_all({{0.25, 0.25, 1.0}, {0, 0, 1}, 0.0, 9.0}, found);
    EXPECT_EQ(found.size(), 3U);
}

TEST(EmbreeScene, HitsTheFirstOfCoincidentTriangles) {
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
    // No surface is within this limit; in the second call one is, and any distance within it is
    // correct.
    EXPECT_EQ(scene.distance_from({0.25, 0.25, 0.75}, 0.7), 0.75);
    EXPECT_LE(scene.distance_from({0.25, 0.25, 0.75}, 3.0), 3.0);
}

TEST(EmbreeScene, IgnoresNonFiniteTrianglesAndMayBeEmpty) {
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
