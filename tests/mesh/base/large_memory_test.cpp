// SPDX-License-Identifier: Apache-2.0
// Advice about memory: it changes no byte and minds no size.
#include "large_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

namespace relief {
namespace {

TEST(LargeMemory, AdviceLeavesWhatIsThere) {
    std::vector<std::uint8_t> bytes(std::size_t{9} << 20);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(i % 251);
    expect_filling(bytes.data() + 1, bytes.size() - 2);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        ASSERT_EQ(bytes[i], i % 251);
}

TEST(LargeMemory, AnySizeMayBeReserved) {
    for (const std::size_t count : {std::size_t{0}, std::size_t{7}, std::size_t{3} << 20}) {
        std::vector<int> values;
        reserve_to_fill(values, count);
        EXPECT_GE(values.capacity(), count);
        EXPECT_TRUE(values.empty());
    }
    expect_filling(nullptr, 0);
}

}  // namespace
}  // namespace relief
