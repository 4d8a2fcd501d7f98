// SPDX-License-Identifier: Apache-2.0
// Laying out --help pages, at most 100 columns wide.
// Tests: tests/tools/command_test.cpp.
#include "common/help_format.h"

#include <fmt/format.h>

#include <sstream>
#include <vector>

namespace relief::tools {
namespace {

constexpr std::size_t page_columns = 100;
constexpr std::size_t text_column = 30;

/// One entry: the name, and the text wrapped beside it.
std::string entry(const std::string& name, const std::string& text) {
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

std::string usage(const CLI::App& app) {
    std::string text = "\nUsage: ";
    if (app.get_parent() != nullptr) text += app.get_parent()->get_name() + " ";
    text += app.get_name();
    if (!app.get_subcommands({}).empty()) return text + " COMMAND ...\n";
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) text += " " + option->get_name(true, false);
    }
    return text + " [OPTIONS]\n";
}

std::string commands(const CLI::App& app) {
    if (app.get_subcommands({}).empty()) return "";
    std::string page = "\nCommands:\n";
    for (const CLI::App* command : app.get_subcommands({}))
        page += entry(command->get_name(), command->get_description());
    return page + fmt::format("\n{} COMMAND --help says more.\n", app.get_name());
}

std::string arguments(const CLI::App& app) {
    std::string page;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional())
            page += entry(option->get_name(true, false), option->get_description());
    }
    return page.empty() ? "" : "\nArguments:\n" + page;
}

/// The options of one group; "" where it has none.
std::string options(const CLI::App& app, const std::string& title, const std::string& group) {
    std::string page;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group() != group || option->get_positional()) continue;
        const bool takes_value = option->get_expected_max() > 0;
        const std::string value = takes_value ? " " + option->get_type_name() : "";
        page += entry(option->get_name(false, true) + value, option->get_description());
    }
    return page.empty() ? "" : fmt::format("\n{}:\n{}", title, page);
}

}  // namespace

std::string HelpFormat::make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const {
    const std::string general = "Options";  // CLI11's name for options without a group.
    std::string page = app->get_description() + "\n" + usage(*app);
    page += commands(*app) + arguments(*app);
    for (const std::string& group : app->get_groups()) {
        if (group != general) page += options(*app, group, group);
    }
    page += options(*app, "General", general);
    if (!app->get_footer().empty()) page += "\n" + app->get_footer() + "\n";
    return page;
}

}  // namespace relief::tools
