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

/// What the examples of a page need.
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

// Manual pages and shell completions.

namespace {

std::string text_of(const Json& object, const char* key) {
    return object.at(key).get<std::string>();
}

std::string replaced(std::string text, char letter, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(letter, at)) != std::string::npos; at += by.size())
        text.replace(at, 1, by);
    return text;
}

/// The part of a description up to the end of its first sentence, without the period.
std::string first_sentence(const std::string& description) {
    const std::string text = description.substr(0, description.find(". "));
    return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
}

/// The words of an option; empty where the option has no list of words.
std::vector<std::string> accepted_words(const Json& option) {
    return option.value("words", std::vector<std::string>());
}

bool takes_value(const Json& option) {
    return !option.at("value").is_null();
}

bool takes_file(const Json& option) {
    return takes_value(option) && text_of(option, "value").find("FILE") != std::string::npos;
}

/// "relief_mesh", which is valid as a part of a name in each shell.
std::string identifier(const std::string& name) {
    return replaced(name, '-', "_");
}

/// The commands of a tool with their names, or the tool itself with an empty name.
std::vector<std::pair<std::string, Json>> commands_of(const Json& tool) {
    if (!tool.contains("commands")) return {{"", tool}};
    std::vector<std::pair<std::string, Json>> commands;
    for (const Json& command : tool.at("commands"))
        commands.emplace_back(text_of(command, "name"), command);
    return commands;
}

// Manual pages.

/// Escapes what groff would take for a request, a font or a typographic minus.
std::string roff(const std::string& text) {
    std::string escaped = replaced(replaced(text, '\\', "\\e"), '-', "\\-");
    escaped = replaced(replaced(escaped, '~', "\\(ti"), '^', "\\(ha");
    return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string manual_usage(const std::string& name, const Json& command) {
    std::string text = fmt::format(".SH SYNOPSIS\n.B {}\n", roff(name));
    if (command.contains("commands")) return text + ".I COMMAND\n.RI [ OPTIONS ]\n";
    for (const Json& argument : command.at("arguments"))
        text += fmt::format(".I {}\n", roff(text_of(argument, "name")));
    return text + ".RI [ OPTIONS ]\n";
}

std::string manual_entry(const std::string& heading, const std::string& text) {
    return fmt::format(".TP\n{}\n{}\n", heading, roff(text));
}

std::string manual_options(const Json& command) {
    std::string page = ".SH OPTIONS\n";
    std::string heading;
    for (const Json& option : command.at("options")) {
        if (text_of(option, "heading") != heading) {
            heading = text_of(option, "heading");
            page += fmt::format(".SS {}\n", roff(heading));
        }
        std::string names = option.contains("short") ? text_of(option, "short") + ", " : "";
        names += text_of(option, "name");
        const std::string value =
            takes_value(option) ? fmt::format(" \\fI{}\\fR", roff(text_of(option, "value"))) : "";
        const std::vector<std::string> words = accepted_words(option);
        const bool has_list = !words.empty() && text_of(option, "value") == "WORD";
        page += manual_entry(fmt::format("\\fB{}\\fR{}", roff(names), value),
                             (has_list ? fmt::format("One of {}. ", fmt::join(words, ", ")) : "") +
                                 text_of(option, "description"));
    }
    return page;
}

/// \param command  the tool or one of its commands
/// \param name  "relief-mesh process"
std::string manual_page(const Json& tool, const Json& command, const std::string& name) {
    const std::string page_name = replaced(name, ' ', "-");
    const std::string tool_name = text_of(tool, "name");
    std::string upper;
    for (const char letter : page_name)
        upper += static_cast<char>(letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter);
    std::string page = fmt::format(".TH \"{}\" 1 \"\" \"relief {}\" \"relief manual\"\n",
                                   roff(upper), text_of(tool, "version"));
    page += fmt::format(".SH NAME\n{} \\- {}\n", roff(page_name),
                        roff(first_sentence(text_of(command, "description"))));
    page += manual_usage(name, command);
    page += fmt::format(".SH DESCRIPTION\n{}\n", roff(text_of(command, "description")));
    for (const Json& argument : command.at("arguments")) {
        page += manual_entry(fmt::format("\\fI{}\\fR", roff(text_of(argument, "name"))),
                             text_of(argument, "description"));
    }
    if (command.contains("commands")) {
        page += ".SH COMMANDS\n";
        for (const Json& one : command.at("commands")) {
            page += manual_entry(
                fmt::format("\\fB{}\\-{}\\fR(1)", roff(tool_name), roff(text_of(one, "name"))),
                text_of(one, "description"));
        }
    }
    page += manual_options(command);
    page +=
        ".SH EXIT STATUS\n"
        ".TP\n0\nThe command succeeded.\n"
        ".TP\n1\nA file or its content is invalid, or the command failed.\n"
        ".TP\n2\nThe command line is invalid.\n"
        ".TP\n3\nThe command succeeded with findings, and an option such as \\-\\-strict asks to "
        "report them.\n";
    if (!command.at("examples").empty()) {
        page += ".SH EXAMPLES\n.nf\n";
        for (const Json& example : command.at("examples"))
            page += roff(example.get<std::string>()) + "\n";
        page += fmt::format(".fi\n.PP\n{}\n", roff(examples_note));
    }
    if (&tool != &command) page += fmt::format(".SH SEE ALSO\n\\fB{}\\fR(1)\n", roff(tool_name));
    return page;
}

// Completions. Each shell offers the commands, the options of the command, the words of an option,
// and files elsewhere.

std::vector<std::string> option_names(const Json& command) {
    std::vector<std::string> names;
    for (const Json& option : command.at("options"))
        names.push_back(text_of(option, "name"));
    return names;
}

std::string bash_completion(const Json& tool) {
    const std::string name = text_of(tool, "name");
    const std::string function = "_" + identifier(name);
    const bool has_commands = tool.contains("commands");
    std::string text = fmt::format("# Completions of {} for bash.\n{}() {{\n", name, function);
    text +=
        "    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
        "    local command words\n"
        "    COMPREPLY=()\n";
    if (has_commands) {
        std::vector<std::string> first = option_names(tool);
        for (const auto& [command, description] : commands_of(tool))
            first.push_back(command);
        text += fmt::format(
            "    command=${{COMP_WORDS[1]}}\n"
            "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
            "        COMPREPLY=($(compgen -W \"{}\" -- \"$word\"))\n"
            "        return\n"
            "    fi\n",
            fmt::join(first, " "));
    }
    text += "    case \"$command $previous\" in\n";
    for (const auto& [command, description] : commands_of(tool)) {
        for (const Json& option : description.at("options")) {
            if (!takes_value(option)) continue;
            const std::vector<std::string> words = accepted_words(option);
            text += fmt::format("        \"{} {}\")", command, text_of(option, "name"));
            text += words.empty()
                        ? " return ;;\n"
                        : fmt::format("\n            words=\"{}\" ;;\n", fmt::join(words, " "));
        }
    }
    text += "    esac\n    if [ -z \"$words\" ] && [[ $word == -* ]]; then\n";
    text += "        case $command in\n";
    for (const auto& [command, description] : commands_of(tool)) {
        text += fmt::format("            {})\n                words=\"{}\" ;;\n",
                            command.empty() ? "''" : command,
                            fmt::join(option_names(description), " "));
    }
    text +=
        "        esac\n"
        "    fi\n"
        "    if [ -n \"$words\" ]; then COMPREPLY=($(compgen -W \"$words\" -- \"$word\")); fi\n"
        "}\n";
    return text + fmt::format("complete -o default -F {} {}\n", function, name);
}

/// A text within single quotes, for zsh and fish.
std::string single_quoted(const std::string& text, const std::string& quote) {
    return "'" + replaced(text, '\'', quote) + "'";
}

/// The options and arguments of a command in the form of zsh's _arguments.
std::string zsh_arguments(const Json& command, const std::string& indent) {
    const auto plain = [](const std::string& text) {
        std::string escaped = replaced(text, '\\', "\\\\");
        for (const char letter : {'[', ']', ':'})
            escaped = replaced(escaped, letter, std::string("\\") + letter);
        return escaped;
    };
    std::string text = "_arguments";
    for (const Json& option : command.at("options")) {
        std::string entry = fmt::format("{}[{}]", text_of(option, "name"),
                                        plain(first_sentence(text_of(option, "description"))));
        if (takes_value(option)) {
            const std::vector<std::string> words = accepted_words(option);
            entry += fmt::format(":{}:", plain(text_of(option, "value")));
            if (takes_file(option))
                entry += "_files";
            else if (!words.empty())
                entry += fmt::format("({})", fmt::join(words, " "));
        }
        text += fmt::format(" \\\n{}    {}", indent, single_quoted(entry, "'\\''"));
    }
    return text + fmt::format(" \\\n{}    '*:file:_files'\n", indent);
}

std::string zsh_completion(const Json& tool) {
    const std::string name = text_of(tool, "name");
    std::string text = fmt::format("#compdef {}\n# Completions of {} for zsh.\n", name, name);
    if (!tool.contains("commands")) return text + zsh_arguments(tool, "");
    text += "local -a commands=(\n";
    for (const auto& [command, description] : commands_of(tool)) {
        const std::string sentence = first_sentence(text_of(description, "description"));
        text += fmt::format("    {}\n", single_quoted(command + ":" + sentence, "'\\''"));
    }
    text +=
        ")\n"
        "if (( CURRENT == 2 )); then\n"
        "    _describe command commands\n"
        "    return\n"
        "fi\n"
        "local command=$words[2]\n"
        "shift words\n"
        "(( CURRENT-- ))\n"
        "case $command in\n";
    for (const auto& [command, description] : commands_of(tool))
        text += fmt::format("    {})\n        {}        ;;\n", command,
                            zsh_arguments(description, "        "));
    return text + "esac\n";
}

std::string fish_completion(const Json& tool) {
    const std::string name = text_of(tool, "name");
    const auto quote = [](const std::string& text) {
        return single_quoted(replaced(text, '\\', "\\\\"), "\\'");
    };
    std::string text = fmt::format("# Completions of {} for fish.\n", name);
    for (const auto& [command, description] : commands_of(tool)) {
        std::string condition;
        if (!command.empty()) {
            text +=
                fmt::format("complete -c {} -n __fish_use_subcommand -f -a {} -d {}\n", name,
                            command, quote(first_sentence(text_of(description, "description"))));
            condition = fmt::format(" -n '__fish_seen_subcommand_from {}'", command);
        }
        for (const Json& option : description.at("options")) {
            const std::vector<std::string> words = accepted_words(option);
            std::string value;
            if (takes_file(option))
                value = " -r -F";
            else if (!words.empty())
                value = fmt::format(" -x -a {}", quote(fmt::format("{}", fmt::join(words, " "))));
            else if (takes_value(option))
                value = " -x";
            text += fmt::format("complete -c {}{} -l {}{} -d {}\n", name, condition,
                                text_of(option, "name").substr(2), value,
                                quote(first_sentence(text_of(option, "description"))));
        }
    }
    return text;
}

}  // namespace

std::vector<ManualFile> manual_files(const Json& tool) {
    const std::string name = text_of(tool, "name");
    const auto page_file = [](const std::string& page) { return "man/man1/" + page + ".1"; };
    std::vector<ManualFile> files = {{page_file(name), manual_page(tool, tool, name)}};
    if (tool.contains("commands")) {
        for (const Json& command : tool.at("commands")) {
            const std::string command_name = text_of(command, "name");
            files.push_back({page_file(name + "-" + command_name),
                             manual_page(tool, command, name + " " + command_name)});
        }
    }
    files.push_back({"bash-completion/completions/" + name, bash_completion(tool)});
    files.push_back({"zsh/vendor-completions/_" + name, zsh_completion(tool)});
    files.push_back({"fish/vendor_completions.d/" + name + ".fish", fish_completion(tool)});
    return files;
}

}  // namespace relief::tools
