// SPDX-License-Identifier: Apache-2.0
// A test program with cases of every outcome, for the test of scripts/dev/run-tests.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/labels.h"

namespace {

int set_ups = 0;

class SharedFixture : public testing::Test {
  protected:
    static void SetUpTestSuite() { ++set_ups; }
};

TEST_LABELS(alone);
TEST_F(SharedFixture, First) {
    EXPECT_EQ(set_ups, 1);
}

TEST_F(SharedFixture, Second) {
    EXPECT_EQ(set_ups, 1);
}

TEST(Sample, Passes) {}

TEST(Sample, Fails) {
    EXPECT_EQ(1, 2) << "the reason";
}

TEST(Sample, IsSkipped) {
    GTEST_SKIP() << "something is missing";
}

TEST_LABELS(gl);
TEST(Crash, Before) {}

TEST_LABELS(gl);
TEST(Crash, Crashes) {
    std::abort();
}

TEST_LABELS(gl);
TEST(Crash, After) {}

TEST(Exit, LeavesTheProgram) {
    ::_exit(0);
}

TEST(Exit, After) {}

TEST(Endless, DoesNotEnd) {
    for (;;)
        ::pause();
}

TEST(Endless, After) {}

/// Fails in the first process that runs it.
TEST(Flaky, FailsOnce) {
    const char* mark = std::getenv("RUN_TESTS_SAMPLE_MARK");
    ASSERT_NE(mark, nullptr);
    const bool is_first = !std::filesystem::exists(mark);
    std::ofstream(mark) << "was here";
    EXPECT_FALSE(is_first);
}

TEST(Environment, IsChanged) {
    ::setenv("RUN_TESTS_SAMPLE_LEFT_BEHIND", "1", 1);
}

TEST_LABELS(slow);
TEST(SlowOnes, Slow) {}

TEST_LABELS(not_sanitized);
TEST(Measured, Memory) {}

class Parameter : public testing::TestWithParam<int> {};

TEST_LABELS_OF("Large/*", slow);
TEST_P(Parameter, IsNotNegative) {
    EXPECT_GE(GetParam(), 0);
}

INSTANTIATE_TEST_SUITE_P(Small, Parameter, testing::Values(1));
INSTANTIATE_TEST_SUITE_P(Large, Parameter, testing::Values(1000));

class Sweep : public testing::TestWithParam<int> {};

TEST_LABELS(slow, sweep);
TEST_P(Sweep, IsNotNegative) {
    EXPECT_GE(GetParam(), 0);
}

INSTANTIATE_TEST_SUITE_P(Of, Sweep, testing::Range(0, 5));

}  // namespace
