// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lists of jobs as text.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "common/file_jobs.h"

namespace relief::test {

/// "a.obj -> out/a.obj, ..."
inline std::string jobs_text(const tools::JobList& list) {
    std::string text;
    for (const tools::Job& job : list.jobs) {
        text += (text.empty() ? "" : ", ") + job.input.string() + " -> " + job.output.string();
    }
    return text;
}

/// Writes an empty file.
inline void touch(const std::filesystem::path& file) {
    std::ofstream{file};
}

}  // namespace relief::test
