// SPDX-License-Identifier: Apache-2.0
/// \file
/// The labels of test cases. scripts/dev/run-tests reads them from the sources, at the lines of the
/// cases that GoogleTest lists. A label other than those below does not compile.
///
/// | label          | meaning                                                                   |
/// |----------------|---------------------------------------------------------------------------|
/// | unit ... docs  | the case has this label instead of its program's (tests/CMakeLists.txt)   |
/// | slow           | it runs only with `scripts/test --all`                                    |
/// | sweep          | it is one of many similar cases: CI runs a part of them each time, all of |
/// |                | them in turn (`--sweeps` of run-tests)                                    |
/// | alone          | it has a process to itself: it measures memory, or replaces operator new  |
/// | not_sanitized  | it does not run under sanitizers: it measures errors, memory or whole     |
/// |                | programs, or tries thousands of sets or large files, and other cases run  |
/// |                | the same code on smaller inputs                                           |
///
///     TEST_LABELS(slow, not_sanitized);
///     TEST(Decimation, KeepsEveryRealModelWithinMaxError) {
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace relief::test {

constexpr std::array<std::string_view, 9> labels_of_cases = {
    "unit", "gl", "cli", "window", "docs", "slow", "sweep", "alone", "not_sanitized"};

/// Returns true if a text is a list of labels, separated by ", ".
constexpr bool are_labels(std::string_view text) {
    const std::size_t end = text.find(", ");
    const std::string_view first = text.substr(0, end);
    return std::find(labels_of_cases.begin(), labels_of_cases.end(), first) !=
               labels_of_cases.end() &&
           (end == std::string_view::npos || are_labels(text.substr(end + 2)));
}

}  // namespace relief::test

/// The labels of the next case.
#define TEST_LABELS(...) static_assert(relief::test::are_labels(#__VA_ARGS__))
/// Labels of only those cases of the next TEST_P whose whole names fit a pattern with * and ?.
#define TEST_LABELS_OF(pattern, ...) static_assert(relief::test::are_labels(#__VA_ARGS__))
/// Labels of all cases of the file.
#define FILE_LABELS(...) static_assert(relief::test::are_labels(#__VA_ARGS__))
