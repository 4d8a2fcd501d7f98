// SPDX-License-Identifier: Apache-2.0
/// Words and numbers in text files, with line numbers for messages.
///
/// Numbers are rounded once, correctly, in any locale; infinities and NaN are accepted. Bad input
/// throws FileError.
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

/// Parses a whole word as a number; nullopt if it is none.
///
/// Numbers beyond the range of the type become infinity or 0, as with strtod. "1.#QNAN" and the
/// like, which old printf implementations wrote for NaN and infinity, are accepted.
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

/// Scans the words of a text and counts lines. LF, CR LF and CR end a line.
class TextScanner {
  public:
    /// \param comment  the character that begins a comment, which ends with the line; 0 for none
    TextScanner(std::string_view text, const std::filesystem::path& file, char comment = '\0')
        : rest_(text), file_(file), comment_(comment) {}

    /// The next word on any line; empty at the end of the text.
    std::string_view word();

    /// The next word on this line; empty at its end.
    std::string_view word_on_line();

    /// Skips the rest of this line.
    void skip_line();

    /// The next word as a number. \throws FileError if there is none or it is no number
    template <typename Number>
    Number number() {
        const std::string_view text = word();
        const std::optional<Number> value = number_in<Number>(text);
        if (!value) fail_at(text, "a number");
        return *value;
    }

    /// The text that has not been read yet.
    [[nodiscard]] std::string_view rest() const { return rest_; }

    /// \throws FileError always, with the line
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

/// Returns true for characters that separate the words of a line.
inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

/// The next three numbers minus the origin, rounded once. \throws FileError as number() does
glm::vec3 position_in(TextScanner& text, const glm::dvec3& origin);

/// Quotes a word of a file for a message: at most 40 characters, unprintable ones as '?'.
std::string quoted(std::string_view word);

/// Compares ASCII letters without case.
bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace relief
