// SPDX-License-Identifier: Apache-2.0
#include "docs/shown_commands.h"

#include <sstream>

namespace relief::test {
namespace {

std::string trimmed(const std::string& line) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos) return "";
    return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

bool is_shell(const std::string& language) {
    return language == "console" || language == "sh" || language == "shell" || language == "bash";
}

bool calls_relief(const std::string& command) {
    for (const char* start : {"relief-", "build/release/bin/relief-", "scripts/", "./scripts/"}) {
        if (command.starts_with(start)) return true;
    }
    return false;
}

/// The line, and as many of those that follow as a backslash at its end asks for.
std::string with_continuations(std::string command, std::istringstream& lines, int& number) {
    std::string next;
    while (command.ends_with('\\') && std::getline(lines, next)) {
        ++number;
        command.pop_back();
        command = trimmed(command) + " " + trimmed(next);
    }
    return command;
}

}  // namespace

std::vector<ShownCommand> shown_commands(const std::string& page) {
    std::vector<ShownCommand> commands;
    std::istringstream lines(page);
    bool in_block = false;
    bool in_shell = false;
    bool has_prompts = false;  // Then what stands without one in the block is output.
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::string text = trimmed(line);
        if (text.starts_with("```")) {
            in_block = !in_block;
            in_shell = in_block && is_shell(trimmed(text.substr(3)));
            has_prompts = false;
            continue;
        }
        const bool prompted = text.starts_with("$ ");
        has_prompts = has_prompts || prompted;
        if (prompted) text = trimmed(text.substr(2));
        if (!calls_relief(text) || !(prompted || (in_shell && !has_prompts))) continue;
        const int first = number;
        commands.push_back({first, with_continuations(text, lines, number)});
    }
    return commands;
}

std::string called_script(const std::string& command) {
    const std::string word = command.substr(0, command.find(' '));
    const std::string path = word.starts_with("./") ? word.substr(2) : word;
    return path.starts_with("scripts/") ? path : "";
}

}  // namespace relief::test
