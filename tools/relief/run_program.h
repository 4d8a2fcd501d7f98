// SPDX-License-Identifier: Apache-2.0
/// \file
/// Runs programs without a shell, so that file names have no meaning.
/// Tests: tests/tools/farm_test.cpp, tests/check/check_fix_test.cpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace relief::tools {

/// The result of a program.
struct ProgramOutput {
    int exit_code = 0;  ///< 127: it cannot be run; 128 + the signal that ended it.
    std::string text;   ///< The captured stream, or why it cannot be run.
    double seconds = 0.0;
    std::uint64_t peak_bytes = 0;
};

enum class CapturedStream {
    output,  ///< Errors are those of this process.
    errors,  ///< The output is dropped.
};

/// Runs a program with an empty input, and waits until it has ended.
/// \param words  the program, which is searched in PATH, and its arguments
ProgramOutput run_program(const std::vector<std::string>& words,
                          CapturedStream captured = CapturedStream::output);

}  // namespace relief::tools
