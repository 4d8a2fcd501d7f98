// SPDX-License-Identifier: Apache-2.0
// Vectorized loops over tiles give the same bits for every instruction set, and what their
// definitions say.
#include "bump/tile_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bump/height_tile.h"

namespace relief {
using namespace relief::detail;

namespace {

using Row = std::vector<double>;
constexpr std::size_t row_size = 53;  // Not a multiple of any vector.
constexpr std::size_t beyond = 16;

/// A row with elements beyond both ends, and a step.
Row rough_row(std::uint32_t seed) {
    Random random(seed);
    Row row;
    for (std::size_t i = 0; i < row_size + 2 * beyond; ++i)
        row.push_back(random.between(-1.0, 1.0) + (i > 40 ? 30.0 : 0.0));
    return row;
}

/// Calls run(target, result) for each target of this processor, and expects the same bits.
template <typename Run>
Row same_for_all_targets(std::size_t size, const Run& run) {
    Row first(size);
    run(VectorTarget::any, first);
    for (const VectorTarget target : {VectorTarget::wide, VectorTarget::widest}) {
        if (target > best_vector_target()) continue;
        Row result(size);
        run(target, result);
        EXPECT_EQ(result, first) << static_cast<int>(target);
    }
    return first;
}

TEST(TileLoops, FilterAndDifferencesOfARow) {
    const Row row = rough_row(1);
    const double* const line = row.data() + beyond;
    for (const Row& weights :
         {Row{-2.0, 1.0}, Row{0.375, 0.25, 0.0625}, Row{0.4, 0.2, 0.06, 0.03, 0.01}}) {
        const Row result = same_for_all_targets(row_size, [&](VectorTarget target, Row& to) {
            symmetric_filter(target, line, weights, 2, row_size, to.data());
        });
        for (std::size_t i = 0; i < row_size; ++i) {
            double sum = weights[0] * line[i];
            for (std::size_t k = 1; k < weights.size(); ++k)
                sum += weights[k] *
                       ((line + i)[-2 * static_cast<std::ptrdiff_t>(k)] + line[i + 2 * k]);
            ASSERT_EQ(result[i], sum) << i;
        }
    }
    const Row second = same_for_all_targets(row_size, [&](VectorTarget target, Row& to) {
        second_difference(target, line, 3, row_size, to.data());
    });
    EXPECT_EQ(second[7], -2.0 * line[10] + (line[7] + line[13]));
}

TEST(TileLoops, StepEdgesStandAlone) {
    const Row row = rough_row(2);
    std::vector<std::int64_t> edges(row_size);
    for (const VectorTarget target : {VectorTarget::any, best_vector_target()}) {
        EXPECT_TRUE(find_step_edges(target, row.data() + beyond, row_size, 3.0, 4.0, edges.data()));
        // The step lies between elements 40 and 41 of the row.
        for (std::size_t i = 0; i < row_size; ++i)
            EXPECT_EQ(edges[i], i == 40 - beyond ? 1 : 0) << i;
        EXPECT_FALSE(
            find_step_edges(target, row.data() + beyond, row_size, 40.0, 4.0, edges.data()));
    }
    // Two steps that are equally high and close to each other are detail.
    Row pair(row_size + 2 * beyond, 0.0);
    std::fill(pair.begin() + 30, pair.begin() + 32, 5.0);
    EXPECT_FALSE(find_step_edges(best_vector_target(), pair.data() + beyond, row_size, 3.0, 4.0,
                                 edges.data()));
}

TEST(TileLoops, NormalsAndTheirAngles) {
    const Row right = rough_row(3);
    const Row down = rough_row(4);
    Row y(row_size);
    Row z(row_size);
    const Row x = same_for_all_targets(row_size, [&](VectorTarget target, Row& to) {
        unit_normals(target, right.data(), down.data(), row_size, {to.data(), y.data(), z.data()});
    });
    Row up = down;
    for (double& slope : up)
        slope = -slope;
    Row squares(row_size);
    // Equal normals differ by the rounding to float.
    const Row none = same_for_all_targets(row_size, [&](VectorTarget target, Row& to) {
        angles_between(target, right.data(), up.data(), {x.data(), y.data(), z.data()}, row_size,
                       to.data(), squares.data());
    });
    EXPECT_LT(*std::max_element(none.begin(), none.end()), 1e-7);
    // A slope of 1 has an angle of 45 degrees to flat ground.
    const Row flat(row_size, 0.0);
    const Row one(row_size, 1.0);
    Row angles(row_size);
    angles_between(best_vector_target(), one.data(), flat.data(),
                   {flat.data(), flat.data(), one.data()}, row_size, angles.data(), squares.data());
    EXPECT_NEAR(angles[5], std::atan(1.0), 1e-3);
    EXPECT_NEAR(squares[5], angles[5] * angles[5], 1e-12);
}

TEST(TileLoops, RandomNumbersAreGaussian) {
    constexpr std::size_t count = 20000;
    const Row numbers = same_for_all_targets(
        count, [&](VectorTarget target, Row& to) { random_normals(target, 7, count, to.data()); });
    std::array<double, 5> moments{};
    double beside = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 1; k < moments.size(); ++k)
            moments[k] += std::pow(numbers[i], static_cast<double>(k)) / count;
        if (i > 0) beside += numbers[i] * numbers[i - 1] / count;
    }
    // Four standard errors. A sum of 12 uniform numbers has a fourth moment of 2.9.
    EXPECT_NEAR(moments[1], 0.0, 0.03);
    EXPECT_NEAR(moments[2], 1.0, 0.04);
    EXPECT_NEAR(moments[3], 0.0, 0.11);
    EXPECT_NEAR(moments[4], 2.9, 0.27);
    EXPECT_NEAR(beside, 0.0, 0.03);
    Row others(count);
    random_normals(best_vector_target(), 8, count, others.data());
    EXPECT_NE(others, numbers);
}

TEST(TileLoops, RoundingToShiftedSteps) {
    const Row row = rough_row(5);
    const Row rounded = same_for_all_targets(row.size(), [&](VectorTarget target, Row& values) {
        values = row;
        round_to_steps(target, 0.25, 0.1, values.size(), values.data());
    });
    for (std::size_t i = 0; i < row.size(); ++i) {
        EXPECT_LE(std::abs(rounded[i] - row[i]), 0.125 + 1e-12);
        EXPECT_NEAR(std::remainder(rounded[i] + 0.1, 0.25), 0.0, 1e-12);
    }
}

TEST(SmallestOf, EqualsTheSortedElement) {
    Random random(11);
    Row values;
    for (int i = 0; i < 1003; ++i)
        values.push_back(i % 5 == 0 ? 0.0 : std::exp2(random.between(-80.0, 20.0)));
    Row sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (const std::size_t rank : {0U, 100U, 201U, 500U, 777U, 1001U, 1002U})
        EXPECT_EQ(smallest_of(values, rank), sorted[rank]) << rank;
    EXPECT_EQ(smallest_of(Row{0.0, 0.0}, 1), 0.0);
}

}  // namespace
}  // namespace relief
