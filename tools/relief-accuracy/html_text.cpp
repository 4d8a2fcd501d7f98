// SPDX-License-Identifier: Apache-2.0
// The base64 encoding is that of [RFC 4648]. Tests: tests/tools/accuracy_page/report_html_test.cpp.
#include "html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/text.h"
#include "relief/accuracy/duration.h"

namespace relief::tools {
namespace {

constexpr std::string_view none = "–";

std::string base64(std::string_view bytes) {
    constexpr std::string_view letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < given ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= given ? letters[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// Returns three digits without exponent, for values from 0.001 to a million.
std::string plain(double value) {
    const int before_point = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    if (before_point < 3) return fmt::format("{:.{}f}", value, 3 - before_point);
    const double unit = std::pow(10.0, before_point - 3);
    return fmt::format("{:.0f}", std::round(value / unit) * unit);
}

}  // namespace

std::string html_escaped(std::string_view text) {
    std::string escaped;
    escaped.reserve(text.size());
    for (const char letter : text) {
        switch (letter) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += letter;
        }
    }
    return escaped;
}

std::string script_escaped(std::string_view json) {
    std::string escaped;
    escaped.reserve(json.size());
    for (const char letter : json) {
        if (letter == '<')
            escaped += "\\u003c";
        else
            escaped += letter;
    }
    return escaped;
}

std::string data_uri(std::string_view bytes, std::string_view type) {
    return fmt::format("data:{};base64,{}", type, base64(bytes));
}

std::string number_text(std::optional<double> value) {
    if (!value || !std::isfinite(*value)) return std::string(none);
    const double size = std::abs(*value);
    if (size == 0.0) return "0";
    if (size < 0.9995e-3 || size >= 0.9995e6) return fmt::format("{:.2e}", *value);
    if (*value == std::round(*value)) return fmt::format("{:.0f}", *value);
    // Rounding first: 9.996 becomes 10.0.
    return plain(std::stod(fmt::format("{:.2e}", *value)));
}

std::string seconds_text(std::optional<double> seconds) {
    return seconds && std::isfinite(*seconds) ? format_seconds(*seconds) : std::string(none);
}

std::string range_text(double from, double to) {
    std::string begin = format_seconds(from);
    const std::string end = format_seconds(to);
    const std::string unit = end.substr(end.rfind(' '));
    if (begin.ends_with(unit)) begin.resize(begin.size() - unit.size());
    return begin + "–" + end;
}

std::string bytes_text(std::optional<double> bytes) {
    if (!bytes || !std::isfinite(*bytes)) return std::string(none);
    if (*bytes < 1000.0) return number_text(bytes) + " B";
    return byte_size(static_cast<std::uintmax_t>(std::llround(*bytes)));
}

}  // namespace relief::tools
