// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options whose errors give the problem and the valid values: "--strength abc: not a number",
/// "--kernel foo: not one of central3, sobel3", "--fov 200: not between 1 and 170 degrees".
///
/// Invalid, missing and repeated values throw UsageError.
/// Tests: tests/tools/options_test.cpp, relief_bake_bump_test.cpp, relief_bake_convert_test.cpp.
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
#include "relief/mesh/bump.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

/// The valid numbers of an option.
struct Range {
    double min = -std::numeric_limits<double>::max();
    double max = std::numeric_limits<double>::max();
    std::string unit;  ///< The unit in messages: "degrees".
};

/// The words of an option with their values.
template <typename Enum>
using Choices = std::vector<std::pair<std::string_view, Enum>>;

/// The words of an enumeration that has names.
template <typename Enum>
Choices<Enum> enum_choices() {
    Choices<Enum> choices;
    for (const EnumName<Enum>& entry : enum_names<Enum>)
        choices.emplace_back(entry.name, entry.value);
    return choices;
}

/// Parses a finite number within a range. Errors begin with `subject`: "--light point:1,x: x".
double parse_number(const std::string& subject, std::string_view text, const Range& range = {});

/// Parses a whole number within a range.
int parse_integer(const std::string& subject, std::string_view text, int min, int max);

/// Parses an sRGB color, "#ff8000", and returns it as linear color.
glm::vec3 parse_color(const std::string& subject, std::string_view text);

/// Parses "1920x1080", with sides from 1 to 16384.
glm::ivec2 parse_size(const std::string& subject, std::string_view text);

/// Returns the parts between separators, including empty ones.
std::vector<std::string> split(std::string_view text, char separator);

/// Parses numbers between commas.
std::vector<double> parse_numbers(const std::string& subject, std::string_view text);

/// Returns the choice with a name.
template <typename Enum>
Enum parse_choice(const std::string& subject, std::string_view text, const Choices<Enum>& choices) {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : choices) {
        if (name == text) return value;
        names.push_back(name);
    }
    throw UsageError(fmt::format("{}: not one of {}", subject, fmt::join(names, ", ")));
}

/// Returns the name of a choice, the inverse of parse_choice().
template <typename Enum>
std::string name_of(Enum wanted, const Choices<Enum>& choices) {
    for (const auto& [name, value] : choices) {
        if (value == wanted) return std::string(name);
    }
    return "";
}

/// An added option, for further settings.
class AddedOption {
  public:
    AddedOption(CLI::App& app, CLI::Option& option) : app_(&app), option_(&option) {}

    /// Sets the heading in the help page.
    AddedOption group(const std::string& heading) const;
    AddedOption required() const;
    /// Sets the number of values.
    AddedOption takes(int min, int max) const;
    /// Sets the words that the option accepts, for completions.
    AddedOption words(const std::vector<std::string>& words) const;

  private:
    CLI::App* app_;
    CLI::Option* option_;
};

/// Adds an option with one value, given at most once. `take` receives "--name VALUE" for messages,
/// and the value.
AddedOption add_value(
    CLI::App& app, const std::string& name, const std::string& value_name,
    const std::string& description,
    const std::function<void(const std::string& subject, const std::string& text)>& take);

/// The same for an option that may be repeated.
AddedOption add_repeatable(
    CLI::App& app, const std::string& name, const std::string& value_name,
    const std::string& description,
    const std::function<void(const std::string& subject, const std::string& text)>& take);

/// Adds a flag without a value.
AddedOption add_switch(CLI::App& app, const std::string& name, bool& target,
                       const std::string& description);
AddedOption add_switch(CLI::App& app, const std::string& name, const std::string& description,
                       const std::function<void()>& take);

/// An option with its values; a flag has none.
struct GivenOption {
    std::string name;  ///< "--size"
    std::vector<std::string> values;
};

/// Returns the options that a command line has, in the order of the help page.
/// \param left_out  names of options that are not returned
std::vector<GivenOption> given_options(const CLI::App& app,
                                       std::span<const std::string_view> left_out);

/// Adds a required file argument.
AddedOption add_file(CLI::App& app, const std::string& name, std::filesystem::path& target,
                     const std::string& description);

/// Adds any number of file arguments. Callers check the number. "@LIST" stands for the names in a
/// file, and "-" for those on standard input: one per line, or ended by NUL.
AddedOption add_files(CLI::App& app, const std::string& name,
                      std::vector<std::filesystem::path>& target, const std::string& description);

/// Adds an option with a file. Target: std::filesystem::path or an optional of it.
template <typename Target>
AddedOption add_path(CLI::App& app, const std::string& name, Target& target,
                     const std::string& description) {
    return add_value(app, name, "FILE", description,
                     [&target](const std::string&, const std::string& text) {
                         target = std::filesystem::path(text);
                     });
}

/// Adds an option with a number. Target: double, float, or an optional of one.
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

/// Adds an option with one of several words. `take` receives the value.
template <typename Enum>
AddedOption add_choice(CLI::App& app, const std::string& name, const Choices<Enum>& choices,
                       const std::string& description, const std::function<void(Enum)>& take) {
    std::vector<std::string_view> names;
    for (const auto& choice : choices)
        names.push_back(choice.first);
    // Help pages state a long list of words beside the description instead of in the value name.
    constexpr std::size_t max_list_length = 48;
    const std::string list = fmt::format("{}", fmt::join(names, "|"));
    const std::string value_name = list.size() > max_list_length ? "WORD" : list;
    return add_value(app, name, value_name, description,
                     [choices, take](const std::string& subject, const std::string& text) {
                         take(parse_choice(subject, text, choices));
                     })
        .words({names.begin(), names.end()});
}

/// Adds an option with one of several words. Target: the enumeration or an optional of it.
template <typename Enum, typename Target>
AddedOption add_choice(CLI::App& app, const std::string& name, Target& target,
                       const Choices<Enum>& choices, const std::string& description) {
    return add_choice<Enum>(app, name, choices, description,
                            [&target](Enum value) { target = value; });
}

/// Adds --max-memory, --max-pixels and --allow-outside, which set the limits of this process at
/// once.
void add_limit_options(CLI::App& app);

/// --threads, the limits of add_limit_options(), and --quiet.
struct GeneralOptions {
    bool quiet = false;
    unsigned threads = 0;  ///< 0: all of the machine.
};

void add_general_options(CLI::App& app, GeneralOptions& options);

// The option words of normals, tangents, height maps and normal maps, which all tools share.

/// All methods except those that with_frames() does not compute.
inline Choices<TangentMethod> tangent_choices() {
    Choices<TangentMethod> choices = enum_choices<TangentMethod>();
    std::erase_if(choices, [](const auto& one) { return one.second == TangentMethod::triangle; });
    return choices;
}

/// "auto" is an absent kernel, which is chosen by the map.
inline Choices<std::optional<Kernel>> kernel_or_auto_choices() {
    Choices<std::optional<Kernel>> choices = {{"auto", std::nullopt}};
    for (const EnumName<Kernel>& entry : enum_names<Kernel>)
        choices.emplace_back(entry.name, entry.value);
    return choices;
}

/// "auto" is an absent value, which is detected from the map.
Choices<std::optional<Wrap>> wrap_or_auto_choices();

/// The continuation beyond the border along each axis. An absent value is detected from the map.
struct WrapsOrAuto {
    std::optional<Wrap> x, y;

    [[nodiscard]] bool is_settled() const { return x && y; }
    [[nodiscard]] Wraps value_or(const Wraps& detected) const {
        return {x.value_or(detected.x), y.value_or(detected.y)};
    }
};

/// Adds --wrap WORD[,WORD] with the additional word "auto".
AddedOption add_wrap(CLI::App& app, WrapsOrAuto& target, const std::string& description);

/// Adds --wrap WORD[,WORD] without "auto".
AddedOption add_wrap(CLI::App& app, Wraps& target, const std::string& description);

}  // namespace relief::tools
