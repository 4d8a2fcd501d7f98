// SPDX-License-Identifier: Apache-2.0
#include "common/text.h"

#include <gtest/gtest.h>

namespace relief::tools {
namespace {

TEST(SummaryText, CountsThings) {
    EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
    EXPECT_EQ(counted(0, "vertex", "vertices"), "0 vertices");
    EXPECT_EQ(counted(3, "light"), "3 lights");
}

TEST(SummaryText, RoundsSizesToWhatMatters) {
    EXPECT_EQ(byte_size(999), "999 B");
    EXPECT_EQ(byte_size(1000), "1.0 kB");
    EXPECT_EQ(byte_size(12345), "12 kB");
    EXPECT_EQ(byte_size(999499), "999 kB");
    EXPECT_EQ(byte_size(999500), "1.0 MB");
    EXPECT_EQ(byte_size(8638012), "8.6 MB");
    EXPECT_EQ(byte_size(5000000000), "5.0 GB");
}

TEST(SummaryText, RoundsTimesToWhatMatters) {
    EXPECT_EQ(duration(0.04), "0.0 ms");
    EXPECT_EQ(duration(9.94), "9.9 ms");
    EXPECT_EQ(duration(9.96), "10 ms");
    EXPECT_EQ(duration(1234), "1.23 s");
    EXPECT_EQ(durations({{"read", 12}, {"write", 30}}), "read 12 ms, write 30 ms, 42 ms in all");
}

TEST(SummaryText, ExtensionsAreLowerCase) {
    EXPECT_EQ(extension_of("a/b.STL"), ".stl");
    EXPECT_EQ(extension_of("a.b/c"), "");
}

}  // namespace
}  // namespace relief::tools
