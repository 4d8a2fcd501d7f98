// SPDX-License-Identifier: Apache-2.0
/// \file
/// Runs one of the project's programs as a user would, and catches what it says.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace relief::test {

struct ProgramResult {
    int exit_code = 0;  ///< 128 + the signal's number, if one ended it.
    std::string out;
    std::string error;

    /// The first line of stderr, without its end.
    [[nodiscard]] std::string first_error_line() const;
};

/// Runs words[0] with the others as arguments; stdin is empty, neither output is a terminal.
///
/// \param words   words[0] without a slash is looked for among the project's own programs
/// \param folder  the program's working directory
ProgramResult run_program(const std::vector<std::string>& words,
                          const std::filesystem::path& folder);

/// The same, but for a signal that is sent as soon as `is_time` says so; not, where the program
/// ends before.
ProgramResult run_program_until(const std::vector<std::string>& words,
                                const std::filesystem::path& folder,
                                const std::function<bool()>& is_time, int signal);

/// The same as run_program() for a line as typed in a shell; the project's programs are found
/// first.
ProgramResult run_line(const std::string& line, const std::filesystem::path& folder);

}  // namespace relief::test
