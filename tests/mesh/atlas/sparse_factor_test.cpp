// SPDX-License-Identifier: Apache-2.0
// Systems are built from known solutions, on surfaces whose order of elimination differs: a square,
// a strip of slivers, a wheel with a hub, and points in one place.
#include "atlas/sparse_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "hard_cases/random_meshes.h"

namespace relief::detail {
namespace {

using test::Dice;

double any(Dice& dice) {
    return static_cast<double>(dice.any_digits());
}

/// Weighted edges between points.
struct Network {
    std::string name;
    std::vector<glm::dvec3> points;
    std::vector<SparseFactor::Entry> edges;  ///< With negative values.
};

void connect(Network& network, std::size_t a, std::size_t b, Dice& dice) {
    network.edges.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), -(1.5 + any(dice))});
}

/// Squares with a diagonal. \param step  of the columns; that of the rows is 1
Network grid(const std::string& name, std::size_t columns, std::size_t rows, double step) {
    Network network{name, {}, {}};
    Dice dice(7);
    for (std::size_t y = 0; y < rows; ++y) {
        for (std::size_t x = 0; x < columns; ++x) {
            const std::size_t here = network.points.size();
            network.points.emplace_back(step * static_cast<double>(x), y, 0.1 * any(dice));
            if (x > 0) connect(network, here, here - 1, dice);
            if (y > 0) connect(network, here, here - columns, dice);
            if (x > 0 && y > 0) connect(network, here, here - columns - 1, dice);
        }
    }
    return network;
}

/// A hub with many neighbors, in a ring.
Network wheel(std::size_t spokes) {
    Network network{"wheel", {glm::dvec3(0.0)}, {}};
    Dice dice(8);
    for (std::size_t i = 0; i < spokes; ++i) {
        const double turn =
            2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(spokes);
        network.points.emplace_back(std::cos(turn), std::sin(turn), 0.0);
        connect(network, 0, i + 1, dice);
        connect(network, i + 1, i == 0 ? spokes : i, dice);
    }
    return network;
}

std::vector<Network> networks() {
    std::vector<Network> result{grid("square", 40, 37, 1.0), grid("slivers", 700, 2, 1e-3),
                                grid("one point", 1, 1, 1.0), grid("two points", 2, 1, 1.0),
                                wheel(300)};
    Network together = grid("in one place", 20, 20, 1.0);
    together.points.assign(together.points.size(), glm::dvec3(0.25));
    result.push_back(together);
    Network apart = grid("two parts", 12, 9, 1.0);
    for (const SparseFactor::Entry& each : grid("", 12, 9, 1.0).edges)
        apart.edges.push_back({each.a + 108, each.b + 108, each.value});
    const std::vector<glm::dvec3> points = apart.points;
    for (const glm::dvec3& each : points)
        apart.points.push_back(each + glm::dvec3(0.5, 0.5, 3.0));
    result.push_back(apart);
    return result;
}

/// The rows of a matrix add up to 0, and to 1 where an unknown is held.
std::vector<double> diagonal_of(const Network& network) {
    std::vector<double> diagonal(network.points.size(), 0.0);
    for (const SparseFactor::Entry& each : network.edges) {
        diagonal[each.a] -= each.value;
        diagonal[each.b] -= each.value;
    }
    diagonal.front() += 1.0;
    diagonal.back() += 1.0;
    return diagonal;
}

TEST(SparseFactor, SolvesSystemsWithKnownSolutions) {
    for (const Network& network : networks()) {
        Dice dice(9);
        std::vector<glm::dvec2> solution;
        for (std::size_t i = 0; i < network.points.size(); ++i)
            solution.emplace_back(any(dice), 2.0 + any(dice));
        const std::vector<double> diagonal = diagonal_of(network);
        std::vector<glm::dvec2> values(solution.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = diagonal[i] * solution[i];
        for (const SparseFactor::Entry& each : network.edges) {
            values[each.a] += each.value * solution[each.b];
            values[each.b] += each.value * solution[each.a];
        }
        SparseFactor factor(diagonal, network.edges, network.points);
        ASSERT_TRUE(factor.is_valid()) << network.name;
        factor.solve(values);
        // Rounding grows with the ratio of the largest and the smallest eigenvalue, up to 1e6 here.
        for (std::size_t i = 0; i < values.size(); ++i) {
            EXPECT_NEAR(values[i].x, solution[i].x, 1e-9) << network.name << ' ' << i;
            EXPECT_NEAR(values[i].y, solution[i].y, 1e-9) << network.name << ' ' << i;
        }
    }
}

TEST(SparseFactor, AddsEntriesOfTheSameUnknowns) {
    // [3 -2; -2 3] x = [5 -5; 0 0], the entry as -1.5 and -0.5.
    const std::vector<double> diagonal{3.0, 3.0};
    const std::vector<SparseFactor::Entry> entries{{0, 1, -1.5}, {1, 0, -0.5}};
    const std::vector<glm::dvec3> positions{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
    SparseFactor factor(diagonal, entries, positions);
    std::vector<glm::dvec2> values{{5.0, 0.0}, {-5.0, 0.0}};
    factor.solve(values);
    EXPECT_NEAR(values[0].x, 1.0, 1e-15);
    EXPECT_NEAR(values[1].x, -1.0, 1e-15);
    EXPECT_EQ(values[0].y, 0.0);
}

TEST(SparseFactor, RefusesMatricesWithoutASolution) {
    const std::vector<glm::dvec3> positions{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
    const std::vector<SparseFactor::Entry> entries{{0, 1, -1.0}};
    // Nothing is held: the second pivot is 1 - 1.
    EXPECT_FALSE(SparseFactor(std::vector<double>{1.0, 1.0}, entries, positions).is_valid());
    const double infinite = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(SparseFactor(std::vector<double>{1.0, infinite}, entries, positions).is_valid());
}

TEST(SparseFactor, DoesNotFillBandsOfSlivers) {
    // A strip of 20,000 triangles: with dense halves, this would need 800 MB.
    const Network strip = grid("strip", 10'000, 2, 1e-4);
    SparseFactor factor(diagonal_of(strip), strip.edges, strip.points);
    ASSERT_TRUE(factor.is_valid());
    // Each unknown has two neighbors ahead in a band; nested dissection has a few more.
    EXPECT_LT(factor.value_count(), 12 * strip.points.size());
}

}  // namespace
}  // namespace relief::detail
