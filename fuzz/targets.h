// SPDX-License-Identifier: Apache-2.0
/// \file
/// Readers and algorithms on arbitrary bytes, for libFuzzer (fuzz.cpp) and for tests.
/// Tests: tests/fuzz/fuzz_targets_test.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace relief {

struct FuzzTarget {
    std::string_view name;
    void (*run)(std::span<const std::uint8_t> bytes);
};

std::span<const FuzzTarget> fuzz_targets();

/// Runs a target with limits of memory and pixels; errors of relief end it quietly.
void run_target(const FuzzTarget& target, std::span<const std::uint8_t> bytes);

}  // namespace relief
