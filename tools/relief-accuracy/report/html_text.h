// SPDX-License-Identifier: Apache-2.0
/// \file
/// Text as HTML pages and people need it: escaped, files as data URIs, numbers with three digits,
/// times and sizes with units. Tests: tests/tools/accuracy_page/html_text_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relief::tools {

/// For text between tags and in quoted attributes: & < > " ' as entities.
std::string html_escaped(std::string_view text);

/// JSON text that may stand in a <script>: each < as \u003c, so that nothing in it ends the script
/// or begins a comment.
std::string script_escaped(std::string_view json);

/// "data:image/png;base64,..."
std::string data_uri(std::string_view bytes, std::string_view type);

/// Three digits: "0.0123", "45.6", "12300"; whole numbers whole, "8192"; "1.23e-05" below a
/// thousandth and from a million. Nothing, or what is not finite, is "–".
std::string number_text(std::optional<double> value);

/// As seconds_in_words(): "850 ns", "12.3 µs"; nothing is "–".
std::string seconds_text(std::optional<double> seconds);

/// A range of times, the unit once where it is the same: "11.9–12.8 ms", "990 µs–1.02 ms".
std::string range_text(double from, double to);

/// As byte_size(): "812 kB", "8.6 MB"; below a thousand not rounded, "1.25 B"; nothing is "–".
std::string bytes_text(std::optional<double> bytes);

}  // namespace relief::tools
