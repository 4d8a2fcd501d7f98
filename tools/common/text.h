// SPDX-License-Identifier: Apache-2.0
/// \file
/// Formats numbers, sizes, times and findings, prints the lines of summaries, and adds the options
/// --report and --strict.
/// Tests: tests/tools/text_test.cpp, relief_mesh_test.cpp, relief_bake_bump_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "relief/mesh/report.h"

namespace relief::tools {

using Json = nlohmann::ordered_json;

/// "1 triangle", "4510 triangles". `plural` is for irregular plurals.
std::string counted(std::size_t count, const std::string& thing, const std::string& plural = "");

/// "812 B", "8.6 MB" with decimal units.
std::string byte_size(std::uintmax_t bytes);

/// "0.4 ms", "12 ms", "1.23 s"
std::string duration(double milliseconds);

/// "read 34 ms, write 20 ms, 54 ms in all"
std::string durations(const std::vector<Stage>& stages);

/// "out/vase.glb: 1.2 MB"
std::string file_and_size(const std::filesystem::path& file);

/// Returns the extension in lower case with its dot.
std::string extension_of(const std::filesystem::path& file);

/// Returns a text with the letters A to Z in lower case.
std::string in_lower_case(std::string text);

/// Returns whether the name of a file has the extension of an image.
bool has_image_extension(const std::filesystem::path& file);

/// Returns text without control characters, which could change the terminal or imitate other lines,
/// and without bytes that are not UTF-8: each such byte becomes "\x1b" and the like.
std::string printable(std::string_view text);

/// The same for text of several lines.
std::string printable_lines(std::string_view text);

/// Returns a file name as typed in a shell, with quotes if necessary.
std::string quoted(const std::filesystem::path& file);

/// Prints aligned "label     text" lines. Only the first of several lines has the label.
void print_entry(const std::string& label, const std::string& text);
void print_entry(const std::string& label, const std::vector<std::string>& lines);

/// Returns indented JSON, with invalid UTF-8 in names replaced.
std::string dumped(const nlohmann::ordered_json& json);

/// Prints it.
void print_json(const nlohmann::ordered_json& json);

/// Replaces a file by it, or prints it for standard_stream. \throws FileError
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

// Findings with the part of the input to which they belong.

/// A finding with its place: "mesh 'Body' primitive 0", or an empty text for the whole file.
struct PlacedFinding {
    std::string where;
    Finding finding;
    /// The width of the map whose texels the finding counts; 0: unknown.
    int map_width = 0;
};

/// Formats a finding as one line. Texels of a map of known width are named by column and row.
std::string to_string(const PlacedFinding& placed);

/// "column 12, row 3", counted from 0 at the upper left corner. \param index  row by row
std::string texel_name(std::size_t index, int width);

class Findings {
  public:
    /// \param map_width  of the map whose texels the findings count; 0: unknown
    void add(const std::string& where, const Report& report, int map_width = 0);

    [[nodiscard]] bool empty() const { return findings_.empty(); }
    /// "no findings", "3 findings"
    [[nodiscard]] std::string count_text() const;
    [[nodiscard]] const std::vector<PlacedFinding>& all() const { return findings_; }

    /// Returns at most `limit` lines and the number of further findings.
    [[nodiscard]] std::vector<std::string> lines(std::size_t limit = 12) const;

    /// [{"where", "kind", "element", "count", "first", "outcome"}, ...], for the texels of a map of
    /// known width with "texels" [{"column", "row"}].
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    std::vector<PlacedFinding> findings_;
};

struct ReportOptions {
    std::optional<std::filesystem::path> file;  ///< standard_stream: standard output.
    bool strict = false;
};

/// \param strict  the description of --strict; empty: the default text
void add_report_options(CLI::App& app, ReportOptions& options, const std::string& strict = "");

/// Checks the report file before the work begins.
/// \throws UsageError if the report would overwrite one of the files, or has the extension of a
///         model or an image; FileError if it cannot be written
void check(const ReportOptions& options, const std::vector<std::filesystem::path>& files);

/// Prints a warning if --strict was given and there are findings. \return whether it did
bool found_fault(const CLI::App& app, const ReportOptions& options,
                 const std::filesystem::path& input, const Findings& findings);

/// Writes the report, if requested, and prints a warning if --strict was given and there are
/// findings.
/// \return fell_back after the warning, else done
ExitCode finish(const CLI::App& app, const ReportOptions& options,
                const std::filesystem::path& input, const Findings& findings,
                const nlohmann::ordered_json& report);

}  // namespace relief::tools
