// SPDX-License-Identifier: Apache-2.0
/// \file
/// One normal map to another, from file to file, with the levels below it.
/// Tests: tests/tools/convert_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/file_jobs.h"
#include "common/findings.h"
#include "convert/convert_options.h"

namespace relief::tools {

/// One image that was written beside the map itself, or below it.
struct WrittenLevel {
    std::filesystem::path file;
    int width = 0;
    int height = 0;
    double mean_length = 1.0;  ///< Of the mean vectors: 1 where all normals agree.
    double least_length = 1.0;
    std::optional<std::filesystem::path> roughness_file;
    std::optional<double> mean_roughness;
};

/// What was made of which map.
struct Converted {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits_read = 0;
    std::string input_words;              ///< The input's conventions.
    std::vector<std::string> steps;       ///< What was done, in order.
    std::optional<LengthSpread> lengths;  ///< Of the input's vectors, if they were looked at.
    NormalMapFormat format;
    std::optional<Green> green;          ///< Absent where nobody knows.
    std::optional<std::string> content;  ///< Of "relief:content", where that is another now.
    std::vector<WrittenLevel> levels;    ///< The map itself first; others only with --mips.
    Findings findings;
};

/// Reads, converts and writes; the stages are "read", "convert" and "write".
/// \throws FileError, UsageError
Converted convert_map(const Job& job, const ConvertRequest& request, Stages& stages);

/// "out/wall-mip02.png", "out/wall-roughness-mip02.png"; level 0 has no number.
std::filesystem::path level_file(const std::filesystem::path& output, std::size_t level,
                                 bool is_roughness);

/// All files that a map may be written to: of levels, as many as the largest has.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& output,
                                            const MipChoice& mips);

}  // namespace relief::tools
