// SPDX-License-Identifier: Apache-2.0
// This file and same_names_b_test.cpp are files of one target whose unnamed namespaces have the
// same names. Such files must compile in every build, also in those that compile in batches.
#include <gtest/gtest.h>

namespace relief::test {
namespace {

struct Value {
    int number = 1;
};

constexpr Value made{};

int number_of(const Value& value) {
    return value.number;
}

TEST(SameNames, BelongToTheirFileInA) {
    EXPECT_EQ(number_of(made), 1);
}

}  // namespace
}  // namespace relief::test
