// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options whose errors say what is wrong and what is allowed: "--strength abc: not a number",
/// "--kernel foo: not one of central3, sobel3", "--fov 200: not between 1 and 170 degrees".
///
/// A bad value, a missing one and one given twice throw UsageError. Tests:
/// tests/tools/options_test.cpp.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/command.h"

namespace relief::tools {

/// Which numbers an option takes.
struct Range {
    double min = -std::numeric_limits<double>::max();
    double max = std::numeric_limits<double>::max();
    std::string unit;  ///< For the message: "degrees".
};

/// The words that an option takes, and what each means.
template <typename Enum>
using Choices = std::vector<std::pair<std::string_view, Enum>>;

/// A finite number within a range. `subject` is what the error names: "--light point:1,x: x".
double parse_number(const std::string& subject, std::string_view text, const Range& range = {});

/// A whole number within a range.
int parse_integer(const std::string& subject, std::string_view text, int min, int max);

/// "#ff8000", sRGB-coded as everywhere on screens, as linear colour.
glm::vec3 parse_color(const std::string& subject, std::string_view text);

/// "1920x1080", each side from 1 to 16384.
glm::ivec2 parse_size(const std::string& subject, std::string_view text);

/// The parts between the separators; empty parts are kept.
std::vector<std::string> split(std::string_view text, char separator);

/// The pieces between commas as numbers.
std::vector<double> parse_numbers(const std::string& subject, std::string_view text);

/// The choice of that name.
template <typename Enum>
Enum parse_choice(const std::string& subject, std::string_view text, const Choices<Enum>& choices) {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : choices) {
        if (name == text) return value;
        names.push_back(name);
    }
    throw UsageError(fmt::format("{}: not one of {}", subject, fmt::join(names, ", ")));
}

/// The name of a choice; the opposite of parse_choice.
template <typename Enum>
std::string name_of(Enum wanted, const Choices<Enum>& choices) {
    for (const auto& [name, value] : choices) {
        if (value == wanted) return std::string(name);
    }
    return "";
}

/// An option that was added, to say more of it.
class AddedOption {
  public:
    explicit AddedOption(CLI::Option& option) : option_(&option) {}

    /// The heading under which --help lists it.
    AddedOption group(const std::string& heading) const;
    AddedOption required() const;
    /// How many values may follow it.
    AddedOption takes(int fewest, int most) const;

  private:
    CLI::Option* option_;
};

/// An option with one value, given at most once. `take` gets "--name VALUE" for messages, and the
/// value.
AddedOption add_value(
    CLI::App& app, const std::string& name, const std::string& value_name,
    const std::string& description,
    const std::function<void(const std::string& subject, const std::string& text)>& take);

/// The same for an option that may be given many times.
AddedOption add_repeatable(
    CLI::App& app, const std::string& name, const std::string& value_name,
    const std::string& description,
    const std::function<void(const std::string& subject, const std::string& text)>& take);

/// A flag without a value.
AddedOption add_switch(CLI::App& app, const std::string& name, bool& target,
                       const std::string& description);

/// A required file argument.
AddedOption add_file(CLI::App& app, const std::string& name, std::filesystem::path& target,
                     const std::string& description);

/// File arguments, any number of them; how many there must be is for the caller to say.
AddedOption add_files(CLI::App& app, const std::string& name,
                      std::vector<std::filesystem::path>& target, const std::string& description);

/// An option that takes a file. Target: std::filesystem::path or an optional of it.
template <typename Target>
AddedOption add_path(CLI::App& app, const std::string& name, Target& target,
                     const std::string& description) {
    return add_value(app, name, "FILE", description,
                     [&target](const std::string&, const std::string& text) {
                         target = std::filesystem::path(text);
                     });
}

/// An option that takes a number. Target: double, float, or an optional of one.
template <typename Target>
AddedOption add_number(CLI::App& app, const std::string& name, const std::string& value_name,
                       Target& target, const Range& range, const std::string& description) {
    return add_value(app, name, value_name, description,
                     [&target, range](const std::string& subject, const std::string& text) {
                         const double number = parse_number(subject, text, range);
                         if constexpr (std::is_same_v<Target, std::optional<float>> ||
                                       std::is_same_v<Target, float>) {
                             target = static_cast<float>(number);
                         } else {
                             target = number;
                         }
                     });
}

/// An option that takes one of several words. Target: the enumeration or an optional of it.
template <typename Enum, typename Target>
AddedOption add_choice(CLI::App& app, const std::string& name, Target& target,
                       const Choices<Enum>& choices, const std::string& description) {
    std::vector<std::string_view> names;
    for (const auto& choice : choices)
        names.push_back(choice.first);
    // Many words would run out of the screen: those are told in the description.
    constexpr std::size_t longest_list = 48;
    std::string value_name = fmt::format("{}", fmt::join(names, "|"));
    std::string details = description;
    if (value_name.size() > longest_list) {
        details = fmt::format("One of {}. {}", fmt::join(names, ", "), description);
        value_name = "WORD";
    }
    return add_value(app, name, value_name, details,
                     [&target, choices](const std::string& subject, const std::string& text) {
                         target = parse_choice(subject, text, choices);
                     });
}

/// --threads and --quiet, which most commands have.
struct GeneralOptions {
    bool quiet = false;
    unsigned threads = 0;  ///< 0: as many as the machine has.
};

void add_general_options(CLI::App& app, GeneralOptions& options);

}  // namespace relief::tools
