// SPDX-License-Identifier: Apache-2.0
// Padding against every texel tried, in strips of any size.
#include "bake/edge_padding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace relief {
namespace {

struct Map {
    int width, height;
    std::vector<float> normals, heights;
    std::vector<TexelState> states;
};

/// A few baked texels with directions of their own.
Map sparse(int width, int height, unsigned one_in) {
    Map map{width, height, {}, {}, {}};
    std::mt19937 random(3);
    for (int i = 0; i < width * height; ++i) {
        const bool is_baked = random() % one_in == 0;
        const double angle = static_cast<double>(random() % 1000) / 1000.0;
        map.states.push_back(is_baked ? TexelState::baked : TexelState::empty);
        map.normals.push_back(is_baked ? static_cast<float>(std::sin(angle)) : 0.0F);
        map.normals.push_back(0.0F);
        map.normals.push_back(is_baked ? static_cast<float>(std::cos(angle)) : 1.0F);
        map.heights.push_back(is_baked ? static_cast<float>(angle) : 0.0F);
    }
    return map;
}

Map dilated(Map map, int texels, int rows_at_once) {
    Map result{map.width, map.height, {}, {}, {}};
    Dilation dilation(map.width, map.height, texels, [&](const BakedRows& rows) {
        EXPECT_EQ(rows.first_row * map.width, static_cast<int>(result.states.size()));
        EXPECT_TRUE(rows.row_count % 64 == 0 || rows.first_row + rows.row_count == map.height);
        result.normals.insert(result.normals.end(), rows.normals.begin(), rows.normals.end());
        result.heights.insert(result.heights.end(), rows.heights.begin(), rows.heights.end());
        result.states.insert(result.states.end(), rows.states.begin(), rows.states.end());
    });
    for (int row = 0; row < map.height; row += rows_at_once) {
        const int count = std::min(rows_at_once, map.height - row);
        const auto first = static_cast<std::size_t>(row * map.width);
        const auto texel_count = static_cast<std::size_t>(count * map.width);
        dilation.push({row, count, std::span(map.normals).subspan(3 * first, 3 * texel_count),
                       std::span(map.heights).subspan(first, texel_count),
                       std::span(map.states).subspan(first, texel_count)});
    }
    return result;
}

TEST(Dilation, FillsWithTheMeanOfAllThatAreNearest) {
    const Map map = sparse(61, 150, 60);
    const int texels = 6;
    const Map filled = dilated(map, texels, 64);
    ASSERT_EQ(filled.states.size(), map.states.size());
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            int nearest = std::numeric_limits<int>::max();
            double sum_x = 0.0, sum_z = 0.0;
            for (int v = 0; v < map.height; ++v) {
                for (int u = 0; u < map.width; ++u) {
                    const auto other = static_cast<std::size_t>(v * map.width + u);
                    if (map.states[other] != TexelState::baked) continue;
                    const int squared = (u - x) * (u - x) + (v - y) * (v - y);
                    if (squared > nearest) continue;
                    if (squared < nearest) sum_x = sum_z = 0.0;
                    nearest = squared;
                    sum_x += map.normals[3 * other];
                    sum_z += map.normals[3 * other + 2];
                }
            }
            const auto texel = static_cast<std::size_t>(y * map.width + x);
            if (nearest > texels * texels) {
                EXPECT_EQ(filled.states[texel], TexelState::empty);
                continue;
            }
            EXPECT_EQ(filled.states[texel], nearest == 0 ? TexelState::baked : TexelState::padded);
            const double length = std::hypot(sum_x, sum_z);
            ASSERT_NEAR(filled.normals[3 * texel], sum_x / length, 1e-6) << x << " " << y;
            ASSERT_NEAR(filled.normals[3 * texel + 2], sum_z / length, 1e-6);
        }
    }
}

TEST(Dilation, IsTheSameInStripsOfAnySize) {
    const Map map = sparse(40, 500, 200);
    for (const int texels : {0, 1, 30, 100, 700}) {
        const Map whole = dilated(map, texels, 500);
        EXPECT_EQ(dilated(map, texels, 64).normals, whole.normals) << texels;
        EXPECT_EQ(dilated(map, texels, 192).heights, whole.heights) << texels;
    }
    EXPECT_EQ(dilated(map, 0, 64).normals, map.normals);
}

/// A layer that nobody asked for is not made, and the others are as with it.
TEST(Dilation, FillsTheLayersThatThereAre) {
    Map map = sparse(50, 130, 80);
    const Map all = dilated(map, 9, 64);
    std::vector<float> heights;
    Dilation dilation(map.width, map.height, 9, [&](const BakedRows& rows) {
        EXPECT_TRUE(rows.normals.empty());
        heights.insert(heights.end(), rows.heights.begin(), rows.heights.end());
    });
    dilation.push({0, map.height, {}, map.heights, map.states});
    EXPECT_EQ(heights, all.heights);
}

/// Rows may be changed by whoever takes them; those that follow are filled from what was baked.
TEST(Dilation, DoesNotReadWhatItHandedOn) {
    const Map map = sparse(40, 400, 300);
    std::vector<float> heights;
    Dilation dilation(map.width, map.height, 50, [&](const BakedRows& rows) {
        heights.insert(heights.end(), rows.heights.begin(), rows.heights.end());
        std::fill(rows.heights.begin(), rows.heights.end(), -1.0F);
        std::fill(rows.states.begin(), rows.states.end(), TexelState::empty);
    });
    Map pushed = map;
    for (int row = 0; row < map.height; row += 64) {
        const int count = std::min(64, map.height - row);
        const auto first = static_cast<std::size_t>(row * map.width);
        const auto texels = static_cast<std::size_t>(count * map.width);
        dilation.push({row,
                       count,
                       {},
                       std::span(pushed.heights).subspan(first, texels),
                       std::span(pushed.states).subspan(first, texels)});
    }
    EXPECT_EQ(heights, dilated(map, 50, 400).heights);
}

}  // namespace
}  // namespace relief
