// SPDX-License-Identifier: Apache-2.0
/// \file
/// Formats numbers, sizes and times, and prints the lines of summaries.
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

/// "1 triangle", "4510 triangles". `plural` is for irregular plurals.
std::string counted(std::size_t count, const std::string& thing, const std::string& plural = "");

/// "812 B", "8.6 MB" with decimal units.
std::string byte_size(std::uintmax_t bytes);

/// "0.4 ms", "12 ms", "1.23 s"
std::string duration(double milliseconds);

/// "read 34 ms, write 20 ms, 54 ms in all"
std::string durations(const std::vector<Stage>& stages);
nlohmann::ordered_json durations_json(const std::vector<Stage>& stages);

/// "out/vase.glb: 1.2 MB"
std::string file_and_size(const std::filesystem::path& file);

/// Returns the extension in lower case with its dot.
std::string extension_of(const std::filesystem::path& file);

/// Returns a file name as typed in a shell, with quotes if necessary.
std::string quoted(const std::filesystem::path& file);

/// Prints aligned "label     text" lines. Only the first of several lines has the label.
void print_entry(const std::string& label, const std::string& text);
void print_entry(const std::string& label, const std::vector<std::string>& lines);

/// Prints indented JSON, with invalid UTF-8 in names replaced.
void print_json(const nlohmann::ordered_json& json);

/// Replaces a file by indented JSON. \throws FileError
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace relief::tools
