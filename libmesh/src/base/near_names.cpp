// SPDX-License-Identifier: Apache-2.0
// Suggestions for mistyped names, by edit distance.
#include "near_names.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace relief::detail {

namespace {

/// Returns the name in lower case, with blanks for all separators.
std::string plain(std::string_view name) {
    std::string result;
    for (const char c : name) {
        const auto letter = static_cast<unsigned char>(c);
        result += std::isalnum(letter) != 0 ? static_cast<char>(std::tolower(letter)) : ' ';
    }
    return result;
}

/// Returns the edit distance: the number of letters to insert, remove or change.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

bool has_word(const std::string& text, const std::string& word) {
    return !word.empty() && (" " + text + " ").find(" " + word + " ") != std::string::npos;
}

}  // namespace

std::vector<std::string> near_names(std::string_view wanted, std::span<const std::string> known) {
    constexpr std::size_t most = 3;
    constexpr std::size_t max_mistypings = 3;
    const std::string name = plain(wanted);
    std::vector<std::pair<std::size_t, std::string>> found;
    std::size_t nearest = max_mistypings;
    for (const std::string& candidate : known) {
        const std::string other = plain(candidate);
        const std::size_t distance = edit_distance(name, other);
        const std::size_t allowed =
            std::min(max_mistypings, std::max(name.size(), other.size()) / 3);
        if (distance > allowed && !has_word(other, name)) continue;
        found.emplace_back(distance, candidate);
        nearest = std::min(nearest, distance);
    }
    // If there are several mistypings, only the smallest one is plausible.
    std::erase_if(found, [&](const auto& entry) {
        return entry.first > nearest && !has_word(plain(entry.second), name);
    });
    std::sort(found.begin(), found.end());
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(most, found.size()); ++i)
        names.push_back(found[i].second);
    return names;
}

std::string did_you_mean(std::string_view wanted, std::span<const std::string> known) {
    const std::vector<std::string> names = near_names(wanted, known);
    if (names.empty()) return "";
    std::string text = "; did you mean ";
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
        text += "'" + names[i] + "'";
    }
    return text + "?";
}

}  // namespace relief::detail
