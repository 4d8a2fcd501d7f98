// SPDX-License-Identifier: Apache-2.0
// Words and numbers in text files. A missing or malformed number is a FileError with its line.
#include "io/mesh/mesh_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "relief/mesh/report.h"

namespace relief {
namespace {

bool ends_line(char c) {
    return c == '\n' || c == '\r';
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

}  // namespace

void TextScanner::skip_blanks() {
    std::size_t i = 0;
    while (i < rest_.size() && is_blank(rest_[i]))
        ++i;
    if (comment_ != '\0' && i < rest_.size() && rest_[i] == comment_) {
        while (i < rest_.size() && !ends_line(rest_[i]))
            ++i;
    }
    rest_.remove_prefix(i);
}

void TextScanner::skip_line_end() {
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
    ++line_;
}

std::string_view TextScanner::word_on_line() {
    skip_blanks();
    std::size_t length = 0;
    while (length < rest_.size() && !is_blank(rest_[length]) && !ends_line(rest_[length]))
        ++length;
    const std::string_view word = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return word;
}

std::string_view TextScanner::word() {
    std::string_view word = word_on_line();
    while (word.empty() && !rest_.empty()) {
        skip_line_end();
        word = word_on_line();
    }
    return word;
}

void TextScanner::skip_line() {
    rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size()));
    if (!rest_.empty()) skip_line_end();
}

void TextScanner::fail(const std::string& reason) const {
    throw FileError(file_, fmt::format("line {}: {}", line_, reason));
}

void TextScanner::fail_at(std::string_view text, const char* wanted) const {
    fail(text.empty() ? fmt::format("the file ends where {} should be", wanted)
                      : fmt::format("{} stands where {} should be", quoted(text), wanted));
}

glm::vec3 position_in(TextScanner& text, const glm::dvec3& origin) {
    if (origin == glm::dvec3(0.0)) {
        const auto x = text.number<float>();
        const auto y = text.number<float>();
        return {x, y, text.number<float>()};
    }
    const auto x = text.number<double>();
    const auto y = text.number<double>();
    return glm::vec3(glm::dvec3(x, y, text.number<double>()) - origin);
}

std::string quoted(std::string_view word) {
    std::string result = "'";
    for (const char c : word.substr(0, 40))
        result += c >= ' ' && c != '\x7F' ? c : '?';
    return result + (word.size() > 40 ? "...'" : "'");
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace relief
