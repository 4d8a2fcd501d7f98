// SPDX-License-Identifier: Apache-2.0
/// \file
/// Many pictures in one go: --turntable, --frames, --seconds, --fps, and one at another time,
/// --time. Tests: tests/tools/sequence_test.cpp.
#pragma once

#include "view_options.h"

namespace relief::tools {

void add_sequence_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if they contradict each other, or what is drawn cannot hold many pictures
void check_sequence(const ViewOptions& options);

/// How many pictures are asked for; 1 unless it is a sequence.
int picture_count(const ViewOptions& options);

/// The file of picture `index` of a sequence of numbered files: the number stands for the run of #
/// in the name, or else follows it: "spin-0001.png". Counts from 1.
std::filesystem::path numbered_file(const std::filesystem::path& output, int index);

}  // namespace relief::tools
