// SPDX-License-Identifier: Apache-2.0
#include "common/choices.h"

#include <utility>
#include <vector>

namespace relief::tools {
namespace {

Choices<std::optional<Wrap>> wrap_or_auto_choices() {
    Choices<std::optional<Wrap>> choices;
    for (const auto& [name, wrap] : wrap_choices())
        choices.emplace_back(name, wrap);
    choices.emplace_back("auto", std::nullopt);
    return choices;
}

/// Returns the choices along x and y. A single word applies to both axes.
template <typename Choice>
std::pair<Choice, Choice> parse_axes(const std::string& subject, const std::string& text,
                                     const Choices<Choice>& choices) {
    const std::vector<std::string> words = split(text, ',');
    if (words.size() > 2) throw UsageError(subject + ": names more than two axes");
    return {parse_choice(subject, words.front(), choices),
            parse_choice(subject, words.back(), choices)};
}

}  // namespace

AddedOption add_wrap(CLI::App& app, WrapsOrAuto& target, const std::string& description) {
    return add_value(app, "--wrap", "WORD[,WORD]", description,
                     [&target](const std::string& subject, const std::string& text) {
                         const auto [x, y] = parse_axes(subject, text, wrap_or_auto_choices());
                         target = {x, y};
                     });
}

AddedOption add_wrap(CLI::App& app, std::optional<Wraps>& target, const std::string& description) {
    return add_value(app, "--wrap", "WORD[,WORD]", description,
                     [&target](const std::string& subject, const std::string& text) {
                         const auto [x, y] = parse_axes(subject, text, wrap_choices());
                         target = Wraps{x, y};
                     });
}

std::string wrap_text(const Wraps& wraps) {
    const std::string x = name_of(wraps.x, wrap_choices());
    return wraps.x == wraps.y ? x : x + "," + name_of(wraps.y, wrap_choices());
}

}  // namespace relief::tools
