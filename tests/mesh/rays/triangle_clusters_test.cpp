// SPDX-License-Identifier: Apache-2.0
// Clusters of triangles: each triangle is in one, boxes hold their triangles, no candidate is left
// out.
#include "bake/triangle_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

namespace relief {
namespace {

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

/// Squares of two triangles each, `side` to a side of the square from -1 to 1.
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
                // Rounded to float, a box is larger by the margin but for 6e-8.
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
    // A cluster holds two squares of two triangles at least, and four at most.
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

TEST(TriangleClusters, MayHoldManyTrianglesAtOnePlace) {
    Soup soup;
    for (int i = 0; i < 100; ++i)
        soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    std::size_t count = 0;
    for (const Cluster& cluster : soup.clusters().clusters)
        count += triangles_of(cluster).size();
    EXPECT_EQ(count, 100U);
}

/// Within -1 to 1; every second one a multiple of 1/4, for rays that meet edges and vertices.
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

}  // namespace
}  // namespace relief
