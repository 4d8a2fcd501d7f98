// SPDX-License-Identifier: Apache-2.0
/// \file
/// The catalogue of hard cases: inputs that break naive code, each with the outcome that relief
/// promises, step by step. Tests: hard_cases_test.cpp runs every row; the page docs/hard-cases.md
/// is written from the same table (page.h).
///
/// A row is plain data. To add one, or an expectation to one, see mesh_cases.cpp: an expectation is
/// a step's name, the outcome in words, and a function that says what is wrong, or nothing.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace relief::test {

/// What one step makes of a hard input.
struct Expectation {
    std::string step;                      ///< "check", "normals", ...
    std::string outcome;                   ///< For the page: "each unit; 1 x isolated vertex".
    std::function<std::string()> problem;  ///< What is not as promised; empty if all is.
};

struct HardCase {
    std::string name;    ///< Fixed words: "needle triangle".
    std::string what;    ///< The input, in a sentence for the page.
    std::string source;  ///< Where it is known from.
    std::vector<Expectation> expectations;
};

/// All rows. Meshes and their normals first.
const std::vector<HardCase>& hard_cases();

}  // namespace relief::test
