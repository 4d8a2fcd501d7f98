// SPDX-License-Identifier: Apache-2.0
// Filters chosen by trial: the one that is best is known for rows made for it.
#include "io/png/png_filter_choice.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace relief {
namespace {

constexpr std::size_t size = 3000;  // 500 texels of three 16-bit samples.
constexpr std::size_t filter_step = 6;

/// 30 rows and the one above, from `value(row, byte)`.
template <typename Value>
std::vector<std::uint8_t> rows_of(Value value) {
    std::vector<std::uint8_t> rows;
    for (std::size_t y = 0; y < 31; ++y) {
        for (std::size_t i = 0; i < size; ++i)
            rows.push_back(static_cast<std::uint8_t>(value(y, i)));
    }
    return rows;
}

TEST(FilterChoice, NoiseIsLeftAloneAndNotSearched) {
    std::mt19937 random(1);
    const auto rows = rows_of([&](std::size_t, std::size_t) { return random(); });
    for (const WriteEffort effort : {WriteEffort::fast, WriteEffort::normal, WriteEffort::small})
        EXPECT_EQ(choose_filter(rows, size, filter_step, effort).repetitions, Repetitions::ignored);
}

TEST(FilterChoice, WhatChangesBySmallNoiseFromAboveIsPredictedFromAbove) {
    std::mt19937 random(2);
    std::vector<std::size_t> above(size);
    for (std::size_t& value : above)
        value = random();
    const auto rows = rows_of([&](std::size_t, std::size_t i) { return above[i] += random() % 8; });
    const FilterChoice choice = choose_filter(rows, size, filter_step, WriteEffort::normal);
    EXPECT_EQ(choice.filter, 2);
}

TEST(FilterChoice, WhatChangesBySmallNoiseFromTheLeftIsPredictedFromTheLeft) {
    std::mt19937 random(3);
    std::vector<std::size_t> last(filter_step);
    const auto rows = rows_of([&](std::size_t, std::size_t i) {
        if (i < filter_step) last[i] = random();
        return last[i % filter_step] += random() % 8;
    });
    const FilterChoice choice = choose_filter(rows, size, filter_step, WriteEffort::normal);
    EXPECT_EQ(choice.filter, 1);
}

TEST(FilterChoice, FewTexelsInAnyOrderStayAsTheyAre) {
    // Every texel is one of 16 of six random bytes: repetitions, which differences would break up.
    std::mt19937 random(4);
    std::vector<std::size_t> texels(16 * filter_step);
    for (std::size_t& value : texels)
        value = random();
    std::size_t texel = 0;
    const auto rows = rows_of([&](std::size_t, std::size_t i) {
        if (i % filter_step == 0) texel = random() % 16;
        return texels[texel * filter_step + i % filter_step];
    });
    const FilterChoice choice = choose_filter(rows, size, filter_step, WriteEffort::normal);
    EXPECT_EQ(choice.filter, 0);
    EXPECT_EQ(choice.repetitions, Repetitions::sought);
}

}  // namespace
}  // namespace relief
