// SPDX-License-Identifier: Apache-2.0
// Values are never clamped, and trailing characters are errors.
#include "common/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "common/help.h"
#include "files.h"
#include "relief/mesh/image.h"
#include "relief/mesh/limits.h"

namespace relief::tools {
using namespace relief::detail;

namespace {

/// Parses the whole text as a number.
template <typename Number>
std::optional<Number> whole(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || stopped != end || text.empty()) return std::nullopt;
    return number;
}

/// "between 1 and 170 degrees", "at least 0"
std::string limits(const Range& range) {
    constexpr double unlimited = std::numeric_limits<double>::max();
    const std::string unit = range.unit.empty() ? "" : " " + range.unit;
    if (range.max == unlimited) return fmt::format("at least {}{}", range.min, unit);
    if (range.min == -unlimited) return fmt::format("at most {}{}", range.max, unit);
    return fmt::format("between {} and {}{}", range.min, range.max, unit);
}

using Take = std::function<void(const std::string& subject, const std::string& text)>;

AddedOption add(CLI::App& app, const std::string& name, const std::string& value_name,
                const std::string& description, const Take& take, bool repeatable) {
    const auto callback = [name, take, repeatable](const CLI::results_t& values) {
        if (!repeatable && values.size() > 1) throw UsageError(name + ": given more than once");
        for (const std::string& value : values) {
            // If a value is missing, the next option is in its place.
            if (value.empty() || value.starts_with("--"))
                throw UsageError(name + ": needs a value");
            take(name + " " + value, value);
        }
        return true;
    };
    CLI::Option* option = app.add_option(name, callback, description);
    option->type_name(value_name);
    option->expected(1);
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return {app, *option};
}

}  // namespace

double parse_number(const std::string& subject, std::string_view text, const Range& range) {
    const std::optional<double> number = whole<double>(text);
    if (!number || !std::isfinite(*number)) throw UsageError(subject + ": not a number");
    if (*number < range.min || *number > range.max)
        throw UsageError(fmt::format("{}: not {}", subject, limits(range)));
    return *number;
}

int parse_integer(const std::string& subject, std::string_view text, int min, int max) {
    const std::optional<int> number = whole<int>(text);
    if (!number) throw UsageError(subject + ": not a whole number");
    if (*number < min || *number > max)
        throw UsageError(fmt::format("{}: not between {} and {}", subject, min, max));
    return *number;
}

glm::vec3 parse_color(const std::string& subject, std::string_view text) {
    unsigned code = 0;
    const char* const end = text.data() + text.size();
    const bool has_form = text.size() == 7 && text.front() == '#';
    const auto result = has_form ? std::from_chars(text.data() + 1, end, code, 16)
                                 : std::from_chars_result{text.data(), std::errc::invalid_argument};
    if (result.ec != std::errc{} || result.ptr != end)
        throw UsageError(subject + ": not a color like #ff8000");
    const auto channel = [code](unsigned shift) {
        return linear_from_srgb(static_cast<float>((code >> shift) & 0xFFU) / 255.0F);
    };
    return {channel(16), channel(8), channel(0)};
}

glm::ivec2 parse_size(const std::string& subject, std::string_view text) {
    constexpr int max_side = 16384;
    const std::vector<std::string> sides = split(text, 'x');
    if (sides.size() != 2) throw UsageError(subject + ": not a size like 1920x1080");
    return {parse_integer(subject, sides[0], 1, max_side),
            parse_integer(subject, sides[1], 1, max_side)};
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t start = 0;;) {
        const std::size_t end = text.find(separator, start);
        parts.emplace_back(text.substr(start, end - start));
        if (end == std::string_view::npos) return parts;
        start = end + 1;
    }
}

std::vector<double> parse_numbers(const std::string& subject, std::string_view text) {
    std::vector<double> numbers;
    for (const std::string& part : split(text, ','))
        numbers.push_back(parse_number(subject + ": '" + part + "'", part));
    return numbers;
}

AddedOption AddedOption::group(const std::string& heading) const {
    option_->group(heading);
    return *this;
}

AddedOption AddedOption::required() const {
    option_->required();
    return *this;
}

AddedOption AddedOption::takes(int min, int max) const {
    option_->expected(min, max);
    return *this;
}

AddedOption AddedOption::words(const std::vector<std::string>& words) const {
    set_words(*app_, *option_, words);
    return *this;
}

AddedOption add_value(CLI::App& app, const std::string& name, const std::string& value_name,
                      const std::string& description, const Take& take) {
    return add(app, name, value_name, description, take, false);
}

AddedOption add_repeatable(CLI::App& app, const std::string& name, const std::string& value_name,
                           const std::string& description, const Take& take) {
    return add(app, name, value_name, description, take, true);
}

AddedOption add_switch(CLI::App& app, const std::string& name, bool& target,
                       const std::string& description) {
    return add_switch(app, name, description, [&target] { target = true; });
}

AddedOption add_switch(CLI::App& app, const std::string& name, const std::string& description,
                       const std::function<void()>& take) {
    return {app, *app.add_flag(
                     name, [take](std::int64_t) { take(); }, description)};
}

std::vector<GivenOption> given_options(const CLI::App& app,
                                       std::span<const std::string_view> left_out) {
    std::vector<GivenOption> given;
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || !name.starts_with("--") ||
            std::ranges::find(left_out, name) != left_out.end())
            continue;
        const bool is_flag = option->get_expected_max() == 0;
        given.push_back({name, is_flag ? std::vector<std::string>() : option->results()});
    }
    return given;
}

AddedOption add_file(CLI::App& app, const std::string& name, std::filesystem::path& target,
                     const std::string& description) {
    return add_path(app, name, target, description).required();
}

namespace {

std::string text_of_standard_input() {
    std::string text;
    std::array<char, 1 << 14> part{};
    for (std::size_t size = 0; (size = std::fread(part.data(), 1, part.size(), stdin)) > 0;)
        text.append(part.data(), size);
    if (std::ferror(stdin) != 0) throw FileError("standard input", "cannot be read");
    return text;
}

/// Adds the names of a list: one a line, or ended by NUL as `find -print0` prints them. Folders,
/// which `find` lists too, are left out with a warning.
void add_names(const CLI::App& app, const std::string& list, std::string_view text,
               std::vector<std::filesystem::path>& names) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw UsageError(list + ": is a list in UTF-16", "save it as UTF-8");
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    const char end = text.find('\0') == std::string_view::npos ? '\n' : '\0';
    const std::size_t before = names.size();
    for (std::string name : split(text, end)) {
        if (end == '\n' && name.ends_with('\r')) name.pop_back();
        if (name.empty()) continue;
        std::error_code ignored;
        if (std::filesystem::is_directory(name, ignored))
            warn(app, fmt::format("{}: {} is a folder and is left out", list, name));
        else
            names.emplace_back(std::move(name));
    }
    if (names.size() == before) throw UsageError(list + ": lists no file");
}

}  // namespace

AddedOption add_files(CLI::App& app, const std::string& name,
                      std::vector<std::filesystem::path>& target, const std::string& description) {
    const auto callback = [&app, &target](const CLI::results_t& values) {
        target.clear();
        for (const std::string& value : values) {
            if (value == standard_stream) {
                add_names(app, value, text_of_standard_input(), target);
            } else if (value.starts_with('@') && value.size() > 1) {
                add_names(app, value, read_file(value.substr(1)), target);
            } else if (value.empty()) {
                throw UsageError("'': not a file name");
            } else {
                target.emplace_back(value);
            }
        }
        return true;
    };
    CLI::Option* option = app.add_option(
        name, callback,
        description + " @LIST reads names from a file, one per line, and - from standard input.");
    option->expected(-1);
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return {app, *option};
}

namespace {

/// Parses "600M": bytes with the unit K, M, G or T, which are powers of 1024.
std::uint64_t parse_bytes(const std::string& subject, const std::string& text) {
    constexpr std::string_view units = "KMGT";
    const std::size_t unit = text.empty() ? units.npos : units.find(text.back());
    if (unit == units.npos) {
        throw UsageError(subject + ": not an amount of memory",
                         "give a number with the unit K, M, G or T: 600M");
    }
    const double bytes =
        parse_number(subject, std::string_view(text).substr(0, text.size() - 1), {0.0, 1e6, ""}) *
        std::pow(1024.0, static_cast<double>(unit + 1));
    if (bytes < 1.0) throw UsageError(subject + ": less than a byte");
    return static_cast<std::uint64_t>(bytes);
}

}  // namespace

void add_limit_options(CLI::App& app) {
    add_value(app, "--max-memory", "SIZE",
              "Use at most this much memory: 600M, 4G. Larger images and models are refused before "
              "they are read. Default: 3/4 of the machine's memory for one image or array, and for "
              "all contents of a file 256 MiB or 256 times its bytes.",
              [](const std::string& subject, const std::string& text) {
                  InputLimits limits = input_limits();
                  limits.memory = parse_bytes(subject, text);
                  set_input_limits(limits);
                  limit_process_memory(limits.memory);
              });
    add_value(app, "--max-pixels", "N",
              "Refuse images of more than N texels. Default: as many as fit into the memory; no "
              "limit for images that are read by rows.",
              [](const std::string& subject, const std::string& text) {
                  InputLimits limits = input_limits();
                  limits.pixels =
                      static_cast<std::uint64_t>(parse_number(subject, text, {1.0, 1e12, ""}));
                  set_input_limits(limits);
              });
    app.add_flag(
        "--allow-outside",
        [](std::int64_t) {
            InputLimits limits = input_limits();
            limits.outside_files = true;
            set_input_limits(limits);
        },
        "Read buffers, materials and images that a model names outside of its folder, too.");
}

void add_general_options(CLI::App& app, GeneralOptions& options) {
    constexpr int max_threads = 1024;
    add_value(app, "--threads", "N",
              "Use at most N threads. The output does not depend on N. Default: all processors.",
              [&options](const std::string& subject, const std::string& text) {
                  options.threads =
                      static_cast<unsigned>(parse_integer(subject, text, 1, max_threads));
              });
    add_limit_options(app);
    add_switch(app, "--quiet", options.quiet, "Print only warnings and errors.");
}

Choices<std::optional<Wrap>> wrap_or_auto_choices() {
    Choices<std::optional<Wrap>> choices;
    for (const EnumName<Wrap>& entry : enum_names<Wrap>)
        choices.emplace_back(entry.name, entry.value);
    choices.emplace_back("auto", std::nullopt);
    return choices;
}

namespace {

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

AddedOption add_wrap(CLI::App& app, Wraps& target, const std::string& description) {
    return add_value(app, "--wrap", "WORD[,WORD]", description,
                     [&target](const std::string& subject, const std::string& text) {
                         const auto [x, y] = parse_axes(subject, text, enum_choices<Wrap>());
                         target = {x, y};
                     });
}

}  // namespace relief::tools
