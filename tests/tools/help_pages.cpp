// SPDX-License-Identifier: Apache-2.0
#include "tools/help_pages.h"

#include <cctype>
#include <sstream>

namespace relief::test {
namespace {

/// The lines of a section of a page, up to the next empty line; none if it has no such section.
std::vector<std::string> section_of(const std::string& page, const std::string& heading) {
    std::istringstream stream(page);
    std::vector<std::string> lines;
    std::string line;
    while (std::getline(stream, line) && line != heading) {
    }
    while (std::getline(stream, line) && !line.empty())
        lines.push_back(line);
    return lines;
}

}  // namespace

std::vector<std::string> commands_with_help(const Workplace& workplace) {
    // The other commands of relief are these tools.
    std::vector<std::string> commands = {"relief", "relief make", "relief check", "relief merge",
                                         "relief farm"};
    for (const std::string tool :
         {"relief-accuracy", "relief-bake", "relief-mesh", "relief-view"}) {
        commands.push_back(tool);
        const std::string page = workplace.run(tool + " --help all").out;
        for (const std::string& line : section_of(page, "Commands:")) {
            if (line.size() > 2 && std::isalpha(static_cast<unsigned char>(line[2])) != 0)
                commands.push_back(tool + " " + line.substr(2, line.find(' ', 2) - 2));
        }
    }
    return commands;
}

std::vector<std::string> examples_of(const std::string& page) {
    std::vector<std::string> examples;
    for (const std::string& line : section_of(page, "Examples:")) {
        if (line.starts_with("  relief")) examples.push_back(line.substr(2));
    }
    return examples;
}

}  // namespace relief::test
