// SPDX-License-Identifier: Apache-2.0
/// \file
/// How summaries say numbers, sizes and times, and print their lines.
/// Tests: tests/tools/text_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/findings.h"

namespace relief::tools {

/// "1 triangle", "4510 triangles"; `plural` is for words that do not just add an s.
std::string counted(std::size_t count, const std::string& thing, const std::string& plural = "");

/// "812 B", "8.6 MB" (of 1000).
std::string byte_size(std::uintmax_t bytes);

/// "0.4 ms", "12 ms", "1.23 s"
std::string duration(double milliseconds);

/// "read 34 ms, write 20 ms, 54 ms in all"
std::string durations(const std::vector<Stage>& stages);
nlohmann::ordered_json durations_json(const std::vector<Stage>& stages);

/// "out/vase.glb: 1.2 MB"
std::string file_and_size(const std::filesystem::path& file);

/// Lower-case extension with its dot.
std::string extension_of(const std::filesystem::path& file);

/// Prints "label     text" lines on stdout, the text aligned; a label is not repeated for the lines
/// that follow the first.
void print_entry(const std::string& label, const std::string& text);
void print_entry(const std::string& label, const std::vector<std::string>& lines);

/// Prints JSON on stdout, indented, invalid UTF-8 in names replaced.
void print_json(const nlohmann::ordered_json& json);

/// Replaces a file by indented JSON. \throws FileError
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace relief::tools
