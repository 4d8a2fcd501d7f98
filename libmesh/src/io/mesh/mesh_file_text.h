// SPDX-License-Identifier: Apache-2.0
/// \file
/// Words and numbers out of text files, with the line for messages.
///
/// Numbers are rounded once, correctly, whatever the locale; infinities and NaN are numbers too.
/// Bad input throws FileError. Tests: tests/mesh/io/mesh/mesh_file_test.cpp.
#pragma once

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace relief {

/// A whole word as a number, or nothing if it is none.
///
/// Beyond the range of the type it becomes infinity or 0, as strtod has it; "1.#QNAN" and the like
/// are what some compilers' printf once wrote for NaN and infinity.
template <typename Number>
std::optional<Number> number_in(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    Number value = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error == std::errc() && stop == end) return value;
    if constexpr (std::numeric_limits<Number>::has_infinity) {
        if (error == std::errc::result_out_of_range && stop == end) {
            return static_cast<Number>(std::strtod(std::string(word).c_str(), nullptr));
        }
        const auto has = [&](std::string_view part) { return word.find(part) != word.npos; };
        if (has("#QNAN") || has("#IND") || has("#SNAN")) {
            return std::numeric_limits<Number>::quiet_NaN();
        }
        if (has("#INF")) {
            return (word.starts_with('-') ? -1 : 1) * std::numeric_limits<Number>::infinity();
        }
    }
    return std::nullopt;
}

/// Walks over the words of a text, counting lines. LF, CR LF and CR all end a line.
class TextScanner {
  public:
    /// \param comment  what begins a comment that runs to the end of its line; 0 for nothing
    TextScanner(std::string_view text, const std::filesystem::path& file, char comment = '\0')
        : rest_(text), file_(file), comment_(comment) {}

    /// The next word, on whatever line; empty at the end of the text.
    std::string_view word();

    /// The next word on this line; empty at its end.
    std::string_view word_on_line();

    /// Goes behind the end of this line.
    void skip_line();

    /// The next word as a number. \throws FileError if there is none or it is no number
    template <typename Number>
    Number number() {
        const std::string_view text = word();
        const std::optional<Number> value = number_in<Number>(text);
        if (!value) fail_at(text, "a number");
        return *value;
    }

    /// What has not been read yet.
    [[nodiscard]] std::string_view rest() const { return rest_; }

    /// \throws FileError always, naming the line
    [[noreturn]] void fail(const std::string& reason) const;

  private:
    [[noreturn]] void fail_at(std::string_view text, const char* wanted) const;
    void skip_blanks();
    void skip_line_end();

    std::string_view rest_;
    const std::filesystem::path& file_;
    char comment_;
    std::size_t line_ = 1;
};

/// What is between the words of a line.
inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

/// The next three numbers, less the origin, rounded once. \throws FileError as number() does
glm::vec3 position_in(TextScanner& text, const glm::dvec3& origin);

/// A word of a file for a message: at most 40 characters, in quotes, unprintable ones as '?'.
std::string quoted(std::string_view word);

/// The same letters, whatever their case.
bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace relief
