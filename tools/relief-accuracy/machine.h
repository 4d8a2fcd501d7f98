// SPDX-License-Identifier: Apache-2.0
/// \file
/// What times depend on: the machine and the build, without names of hosts or folders.
/// Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace relief::tools {

struct Machine {
    std::string processor;           ///< "AMD EPYC 7763 64-Core Processor"; empty: not told.
    unsigned cores = 0;              ///< That this process may use.
    std::uint64_t memory_bytes = 0;  ///< 0: not told.
    std::string system;              ///< "Debian GNU/Linux 12 (bookworm), Linux 6.1.0 x86_64"
    std::string compiler;            ///< "GCC 12.2.0"
    std::string build;               ///< "Release"
    /// "llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6"; absent: nothing was
    /// drawn, or nothing could be.
    std::optional<std::string> opengl;

    friend bool operator==(const Machine&, const Machine&) = default;
};

/// \param draws  whether OpenGL was used, and is to be asked for its name
Machine this_machine(bool draws);

/// What differs between two, in words that name both: "processor: A, then B"; empty if nothing.
std::string difference_of(const Machine& old_one, const Machine& new_one);

/// Whether times on one say something about times on the other as they are: all but the compiler
/// and the build is the same, for those belong to what is compared.
bool may_compare_times(const Machine& old_one, const Machine& new_one);

}  // namespace relief::tools
