// SPDX-License-Identifier: Apache-2.0
// Runs every command that --help pages, README.md, ARCHITECTURE.md, docs/*.md and conformance/*.md
// show, page by page, in a folder laid out like a built checkout; out/ there is its own. Scripts
// must exist and be executable, but are not run: they set up whole machines.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "docs/shown_commands.h"
#include "support/shared_data.h"
#include "tools/help_pages.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

/// Pages relative to the sources, sorted.
std::vector<std::string> documents() {
    std::set<std::string> found;
    for (const char* folder : {".", "conformance", "docs"}) {
        if (!fs::is_directory(source_directory() / folder)) continue;
        for (const auto& entry : fs::directory_iterator(source_directory() / folder)) {
            if (entry.path().extension() == ".md")
                found.insert(entry.path().lexically_relative(source_directory()).string());
        }
    }
    return {found.begin(), found.end()};
}

struct Page {
    std::string name;
    std::vector<std::string> commands;
};

std::vector<Page> help_pages(const Workplace& workplace) {
    std::vector<Page> pages;
    for (const std::string& command : commands_with_help(workplace)) {
        const std::string name = command + " --help";
        pages.push_back({name, examples_of(workplace.run(name).out)});
    }
    return pages;
}

Page document_page(const std::string& name) {
    Page page{name, {}};
    for (const ShownCommand& command : shown_commands(contents_of(source_directory() / name)))
        page.commands.push_back(command.text);
    return page;
}

/// The first page that shows each command: help pages, then documents.
const std::map<std::string, std::string>& first_pages() {
    static const auto first = [] {
        std::map<std::string, std::string> pages;
        const Workplace workplace;
        const auto add = [&](const Page& page) {
            for (const std::string& command : page.commands)
                pages.emplace(command, page.name);
        };
        for (const Page& page : help_pages(workplace))
            add(page);
        for (const std::string& name : documents())
            add(document_page(name));
        return pages;
    }();
    return first;
}

/// Whether a later command of the page names a file below out/ that this one names.
bool is_needed_later(const Page& page, std::size_t index) {
    std::istringstream words(page.commands[index]);
    for (std::string word; words >> word;) {
        if (word.find("out/") == std::string::npos) continue;
        std::string stem = word.substr(0, word.rfind('.'));
        if (stem.ends_with('/')) stem.pop_back();
        const auto names_it = [&](const std::string& later) {
            return later.find(stem) != std::string::npos;
        };
        if (std::any_of(page.commands.begin() + static_cast<std::ptrdiff_t>(index) + 1,
                        page.commands.end(), names_it))
            return true;
    }
    return false;
}

/// A command of `relief-accuracy run` split into its output folder and the rest; empty for others.
struct Measurement {
    std::string folder;
    std::string rest;
};

Measurement measurement_of(const std::string& command) {
    static const std::string tool = "relief-accuracy run ";
    static const std::string option = " --output ";
    const std::size_t begin = command.find(tool);
    const std::size_t output = command.find(option);
    if (begin == std::string::npos || output == std::string::npos) return {};
    const std::size_t folder = output + option.size();
    const std::size_t end = std::min(command.find(' ', folder), command.size());
    return {command.substr(folder, end - folder),
            command.substr(begin, output - begin) + command.substr(end)};
}

/// Runs a command. If it repeats a measurement of this process with another output folder, the
/// results are copied instead, because measuring takes ten seconds.
ProgramResult run_or_copy(const std::string& command, const Workplace& workplace) {
    static const TemporaryDirectory results;
    static std::map<std::string, fs::path> folder_of;
    const Measurement measurement = measurement_of(command);
    if (measurement.folder.empty()) return workplace.run(command);
    const auto stored = folder_of.find(measurement.rest);
    if (stored != folder_of.end()) {
        fs::create_directories((workplace / measurement.folder).parent_path());
        fs::copy(stored->second, workplace / measurement.folder, fs::copy_options::recursive);
        return {0, "copied", ""};
    }
    ProgramResult result = workplace.run(command);
    if (result.exit_code == 0) {
        const fs::path folder = results / std::to_string(folder_of.size());
        fs::copy(workplace / measurement.folder, folder, fs::copy_options::recursive);
        folder_of.emplace(measurement.rest, folder);
    }
    return result;
}

/// Runs the commands of a page except those that another page runs and that no later command needs.
void expect_to_run(const Page& page, const Workplace& workplace, bool is_silent) {
    for (std::size_t i = 0; i < page.commands.size(); ++i) {
        const std::string& command = page.commands[i];
        SCOPED_TRACE(page.name + ": " + command);
        const std::string script = called_script(command);
        if (!script.empty()) {
            EXPECT_EQ(access((source_directory() / script).c_str(), X_OK), 0)
                << script << " is missing or not executable";
            continue;
        }
        if (first_pages().at(command) != page.name && !is_needed_later(page, i)) continue;
        const ProgramResult result = run_or_copy(command, workplace);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        if (!is_silent) continue;
        EXPECT_EQ(result.error, "");
        EXPECT_NE(result.out, "");
    }
}

class Document : public testing::TestWithParam<std::string> {};

TEST_P(Document, ShowsCommandsThatRun) {
    expect_to_run(document_page(GetParam()), Workplace(), false);
}

std::string test_name(const testing::TestParamInfo<std::string>& page) {
    std::string name;
    for (const char letter : page.param)
        name += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, Document, testing::ValuesIn(documents()), test_name);

class HelpExamples : public testing::TestWithParam<std::string> {};

TEST_P(HelpExamples, RunWithoutAMessage) {
    for (const Page& page : help_pages(Workplace())) {
        if (page.name.starts_with(GetParam())) expect_to_run(page, Workplace(), true);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, HelpExamples,
                         testing::Values("relief-accuracy", "relief-bake", "relief-mesh",
                                         "relief-view"),
                         test_name);

}  // namespace
}  // namespace relief::test
