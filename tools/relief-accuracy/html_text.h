// SPDX-License-Identifier: Apache-2.0
/// \file
/// Text of HTML pages: escapes, data URIs, numbers with three digits, times and sizes with units.
/// Tests: tests/tools/accuracy_page/report_html_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relief::tools {

/// Returns text for elements and quoted attributes, with entities for & < > " '.
std::string html_escaped(std::string_view text);

/// Returns JSON for a <script> element, with \u003c for <, so that it contains no tags.
std::string script_escaped(std::string_view json);

/// "data:image/png;base64,..."
std::string data_uri(std::string_view bytes, std::string_view type);

/// Returns a number with three digits, "0.0123", "45.6", "12300"; as a whole number, "8192"; or
/// with an exponent, "1.23e-05", below 0.001 and from a million. Missing and non-finite values are
/// "–".
std::string number_text(std::optional<double> value);

/// Returns format_seconds(), "850 ns", "12.3 µs", or "–" for a missing value.
std::string seconds_text(std::optional<double> seconds);

/// Returns a range of times with a common unit if possible: "11.9–12.8 ms", "990 µs–1.02 ms".
std::string range_text(double from, double to);

/// Returns byte_size(), "812 kB", "8.6 MB"; bytes below 1000 without rounding, "1.25 B"; "–" for a
/// missing value.
std::string bytes_text(std::optional<double> bytes);

}  // namespace relief::tools
