// SPDX-License-Identifier: Apache-2.0
/// \file
/// Runs programs without a shell, so that file names have no meaning.
/// Tests: tests/tools/farm_test.cpp, tests/check/check_fix_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace relief::tools {

/// The result of a program.
struct ProgramOutput {
    /// 127: it cannot be run; 128 + the signal that ended it; timed_out: it had too little time.
    int exit_code = 0;
    static constexpr int timed_out = 124;
    std::string text;  ///< The captured stream, or why it cannot be run.
    double seconds = 0.0;
    std::uint64_t peak_bytes = 0;
};

enum class CapturedStream {
    output,  ///< Errors are those of this process.
    errors,  ///< The output is dropped.
};

/// Runs a program with an empty input, and waits until it has ended.
/// \param words  the program, which is searched in PATH, and its arguments
/// \param limit  in seconds; the program is killed if it writes to the stream or keeps it open for
///               longer
ProgramOutput run_program(const std::vector<std::string>& words,
                          CapturedStream captured = CapturedStream::output,
                          std::optional<double> limit = std::nullopt);

}  // namespace relief::tools
