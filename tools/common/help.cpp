// SPDX-License-Identifier: Apache-2.0
#include "common/help.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/text.h"

namespace relief::tools {
namespace {

constexpr std::size_t page_columns = 100;
constexpr std::size_t text_column = 30;

/// The note on the files that the examples of a page need.
constexpr const char* examples_note =
    "The samples data/ are in share/relief/data of the installation. Make the folder out/ first.";

/// CLI11's name of the group of options without a group.
constexpr const char* general_group = "Options";

/// Returns a name with the text wrapped beside it.
std::string help_entry(const std::string& name, const std::string& text) {
    std::string page = "  " + name;
    std::size_t column = page.size();
    if (column + 2 > text_column) {
        page += '\n';
        column = 0;
    }
    std::istringstream words(text);
    bool line_start = true;
    for (std::string word; words >> word;) {
        if (!line_start && column + 1 + word.size() > page_columns) {
            page += '\n';
            column = 0;
            line_start = true;
        }
        if (line_start) {
            page.append(text_column - column, ' ');
            column = text_column;
        } else {
            page += ' ';
            ++column;
        }
        page += word;
        column += word.size();
        line_start = false;
    }
    return page + '\n';
}

std::string help_usage(const CLI::App& app) {
    std::string text = "\nUsage: " + full_name(app);
    if (!app.get_subcommands({}).empty()) return text + " COMMAND ...\n";
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) text += " " + option->get_name(true, false);
    }
    return text + " [OPTIONS]\n";
}

std::string help_commands(const CLI::App& app) {
    if (app.get_subcommands({}).empty()) return "";
    std::string page = "\nCommands:\n";
    for (const CLI::App* command : app.get_subcommands({}))
        page += help_entry(command->get_name(), command->get_description());
    return page + fmt::format("\n{} COMMAND --help describes a command.\n", app.get_name());
}

std::string help_arguments(const CLI::App& app) {
    std::string page;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional())
            page += help_entry(option->get_name(true, false), option->get_description());
    }
    return page.empty() ? "" : "\nArguments:\n" + page;
}

bool takes_value(const CLI::Option& option) {
    return option.get_expected_max() > 0;
}

/// Returns the first sentence of a description, and the one that states the default.
std::string shortened(const std::string& description) {
    const std::size_t end = description.find(". ");
    if (end == std::string::npos) return description;
    const std::size_t standard = description.rfind(" Default: ");
    return description.substr(0, end + 1) +
           (standard == std::string::npos ? "" : description.substr(standard));
}

/// The layout of help pages, at most 100 columns wide, and what CLI11 does not store of options.
/// A tool and its commands share one.
class HelpPages : public CLI::FormatterBase {
  public:
    std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
        std::string page = app->get_description() + "\n" + help_usage(*app);
        page += help_commands(*app) + help_arguments(*app);
        std::size_t omitted = 0;
        for (const std::string& group : app->get_groups()) {
            if (group != general_group && !group.empty())
                page += help_options(*app, group, group, omitted);
        }
        page += help_options(*app, "General", general_group, omitted);
        if (omitted > 0)
            page +=
                fmt::format("\n{} --help all describes these in full and {} advanced options.\n",
                            full_name(*app), omitted);
        return page + help_examples(*app);
    }

    [[nodiscard]] bool is_advanced(const CLI::App& app, const CLI::Option& option) const {
        const auto found = common.find(&app);
        return found != common.end() && !found->second.contains(&option) &&
               &option != app.get_help_ptr();
    }

    bool show_advanced = false;
    std::map<const CLI::App*, std::set<const CLI::Option*>> common;
    std::map<const CLI::Option*, std::vector<std::string>> words;
    std::map<const CLI::App*, std::vector<std::string>> examples;

  private:
    [[nodiscard]] bool is_short(const CLI::App& app) const {
        return !show_advanced && common.contains(&app);
    }

    [[nodiscard]] std::string help_examples(const CLI::App& app) const {
        const auto found = examples.find(&app);
        if (found == examples.end()) return "";
        std::vector<std::string> lines = found->second;
        constexpr std::size_t short_list = 4;
        if (is_short(app) && lines.size() > short_list) lines.resize(short_list);
        std::string text = fmt::format("\nExamples:\n  {}\n", fmt::join(lines, "\n  "));
        if (!is_short(app)) text += fmt::format("\n{}\n", examples_note);
        return text;
    }

    /// "One of a, b, c. " if the value name does not list the words.
    [[nodiscard]] std::string list_of_words(const CLI::Option& option) const {
        const auto found = words.find(&option);
        if (found == words.end() || option.get_type_name().find('|') != std::string::npos)
            return "";
        return fmt::format("One of {}. ", fmt::join(found->second, ", "));
    }

    /// Returns the options of a group, or an empty text.
    std::string help_options(const CLI::App& app, const std::string& title,
                             const std::string& group, std::size_t& omitted) const {
        std::string page;
        for (const CLI::Option* option : app.get_options()) {
            if (option->get_group() != group || option->get_positional()) continue;
            if (!show_advanced && is_advanced(app, *option)) {
                ++omitted;
                continue;
            }
            const std::string value = takes_value(*option) ? " " + option->get_type_name() : "";
            const std::string& description = option->get_description();
            page += help_entry(
                option->get_name(false, true) + value,
                is_short(app) ? shortened(description) : list_of_words(*option) + description);
        }
        return page.empty() ? "" : fmt::format("\n{}:\n{}", title, page);
    }
};

/// Returns the help pages of a tool, or null for an App that does not belong to one.
HelpPages* pages_of(const CLI::App& app) {
    return dynamic_cast<HelpPages*>(app.get_formatter().get());
}

Json described_options(const CLI::App& app, const HelpPages& pages) {
    Json options = Json::array();
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional() || option->get_group().empty()) continue;  // Or for tests.
        Json one = {{"name", "--" + option->get_lnames().front()}};
        if (!option->get_snames().empty()) one["short"] = "-" + option->get_snames().front();
        one["value"] = takes_value(*option) ? Json(option->get_type_name()) : Json(nullptr);
        if (const auto found = pages.words.find(option); found != pages.words.end())
            one["words"] = found->second;
        const std::string& group = option->get_group();
        one["heading"] = group == general_group ? "General" : group;
        one["description"] = option->get_description();
        one["advanced"] = pages.is_advanced(app, *option);
        options.push_back(one);
    }
    return options;
}

Json described_arguments(const CLI::App& app) {
    Json arguments = Json::array();
    for (const CLI::Option* option : app.get_options()) {
        if (!option->get_positional()) continue;
        arguments.push_back(
            {{"name", option->get_name(true, false)},
             {"description", option->get_description()},
             {"required", option->get_required()},
             {"repeats", option->get_expected_max() > 1 || option->get_allow_extra_args()}});
    }
    return arguments;
}

}  // namespace

std::string full_name(const CLI::App& app) {
    const CLI::App* parent = app.get_parent();
    return parent == nullptr ? app.get_name() : parent->get_name() + " " + app.get_name();
}

void use_help_pages(CLI::App& tool) {
    tool.formatter(std::make_shared<HelpPages>());
}

void show_advanced_options(CLI::App& tool) {
    if (HelpPages* pages = pages_of(tool)) pages->show_advanced = true;
}

void set_examples(CLI::App& app, const std::vector<std::string>& commands) {
    if (HelpPages* pages = pages_of(app)) pages->examples[&app] = commands;
}

void set_common_options(CLI::App& app, const std::vector<std::string>& names) {
    HelpPages* const pages = pages_of(app);
    if (pages == nullptr) return;
    for (const std::string& name : names)
        pages->common[&app].insert(app.get_option(name));
}

void set_words(CLI::App& app, const CLI::Option& option, const std::vector<std::string>& words) {
    if (HelpPages* pages = pages_of(app)) pages->words[&option] = words;
}

Json describe(const CLI::App& app) {
    Json description = {{"name", app.get_name()}, {"description", app.get_description()}};
    if (app.get_parent() == nullptr) description["version"] = version();
    const HelpPages* const pages = pages_of(app);
    for (const CLI::App* command : app.get_subcommands({}))
        description["commands"].push_back(describe(*command));
    description["arguments"] = described_arguments(app);
    description["options"] = described_options(app, *pages);
    description["examples"] = Json::array();
    if (const auto found = pages->examples.find(&app); found != pages->examples.end())
        description["examples"] = found->second;
    return description;
}

}  // namespace relief::tools
