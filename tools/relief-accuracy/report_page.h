// SPDX-License-Identifier: Apache-2.0
/// \file
/// A report as one HTML page with all numbers, plots, pictures, style and script, which loads
/// nothing; and the table of an experiment's methods, which is the same on the page, in documents
/// and on a terminal. The script (page/page.js) only adds filters and sorting.
/// Tests: tests/tools/accuracy_page/report_page_test.cpp, and report_page_test.py in a browser.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relief::tools {

/// Returns a number with three digits, "0.0123", "45.6", "12300"; as a whole number, "8192"; or
/// with an exponent, "1.23e-05", below 0.001 and from a million. Missing and non-finite values are
/// "–".
std::string number_text(std::optional<double> value);

/// Returns a range of times with a common unit if possible: "11.9–12.8 ms", "990 µs–1.02 ms".
std::string range_text(double from, double to);

/// Returns byte_size(), "812 kB", "8.6 MB"; bytes below 1000 without rounding, "1.25 B"; "–" for a
/// missing value.
std::string bytes_text(std::optional<double> bytes);

/// Returns the number of code points of UTF-8.
std::size_t code_points_in(std::string_view text);

/// A value of a method: "2.00 ms", and for times the range from the 10th to the 90th percentile.
struct MethodCell {
    std::string text{};
    std::string range{};
    std::optional<double> value{};
};

/// The table of an experiment's methods. Columns without values are omitted.
struct MethodTable {
    std::vector<std::string> columns{};
    std::vector<std::vector<MethodCell>> rows{};  ///< One for each measurement.
};
MethodTable method_table(const nlohmann::ordered_json& experiment);

/// Returns the page of a report, given as the JSON of accuracy.json. Pictures without file (null)
/// become a note.
/// \param folder  the folder of the picture files
/// \throws FileError for a missing picture, InvalidInput for a picture outside that folder
std::string report_html(const nlohmann::ordered_json& report, const std::filesystem::path& folder);

/// A file of the folder page/.
struct ReportPart {
    std::string_view name;
    std::string_view text;
};
/// All files of page/, sorted by name. cmake/embed_files.cmake generates this function.
const std::vector<ReportPart>& report_parts();

/// Returns the text of a file of page/: "plot.css".
std::string_view report_part(std::string_view name);

}  // namespace relief::tools
