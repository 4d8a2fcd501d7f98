// SPDX-License-Identifier: Apache-2.0
// See same_names_a_test.cpp.
#include <gtest/gtest.h>

namespace relief::test {
namespace {

struct Value {
    int number = 2;
};

constexpr Value made{};

int number_of(const Value& value) {
    return value.number;
}

TEST(SameNames, BelongToTheirFileInB) {
    EXPECT_EQ(number_of(made), 2);
}

}  // namespace
}  // namespace relief::test
