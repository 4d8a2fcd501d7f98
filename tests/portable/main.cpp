// SPDX-License-Identifier: Apache-2.0
// The main function of portable_tests. test_main.cpp, which also checks that each case restores the
// state of its process, needs POSIX.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

int main(int argc, char** argv) {
    testing::InitGoogleMock(&argc, argv);
    return RUN_ALL_TESTS();
}
