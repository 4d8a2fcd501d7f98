// SPDX-License-Identifier: Apache-2.0
// Documents against the program. Every command in --help pages, README.md, ARCHITECTURE.md,
// docs/*.md and conformance/*.md runs in a folder that has what a fresh clone has, and nothing
// else: a document makes its own out/. Installed documents need no more than the installed samples.
// Scripts must exist and be executable, but do not run, because they set up whole machines.
// REFERENCES.md lists exactly the sources that the code cites as [Author Year].
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/help_pages.h"
#include "tools/linked_tools.h"

namespace relief::test {
namespace {

struct ShownCommand {
    int line = 0;  ///< Counted from 1.
    std::string text;
};

std::string trimmed(const std::string& line) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos) return "";
    return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

bool is_shell(const std::string& language) {
    return language == "console" || language == "sh" || language == "shell" || language == "bash";
}

bool starts_with_any(const std::string& command, const std::vector<std::string>& starts) {
    return std::any_of(starts.begin(), starts.end(),
                       [&](const std::string& start) { return command.starts_with(start); });
}

/// Returns whether a command prepares the folder for others.
bool is_preparation(const std::string& command) {
    return starts_with_any(command, {"mkdir ", "cp "});
}

/// Returns the command without variables that are set for it alone: "NAME=value relief-view ...".
std::string without_variables(const std::string& command) {
    static const std::regex variables(R"(^([A-Z_]+=[^ ]* +)+)");
    return std::regex_replace(command, variables, "");
}

bool calls_relief(const std::string& line) {
    const std::string command = without_variables(line);
    return starts_with_any(command, {"relief-", "relief make ", "relief check ",
                                     "build/release/bin/relief", "scripts/", "./scripts/"});
}

/// Joins a line that ends in a backslash with the lines that follow.
std::string with_continuations(std::string command, std::istringstream& lines, int& number) {
    std::string next;
    while (command.ends_with('\\') && std::getline(lines, next)) {
        ++number;
        command.pop_back();
        command = trimmed(command) + " " + trimmed(next);
    }
    return command;
}

std::vector<ShownCommand> shown_commands(const std::string& page) {
    std::vector<ShownCommand> commands;
    std::istringstream lines(page);
    bool in_block = false;
    bool in_shell = false;
    bool has_prompts = false;  // Lines without a prompt are then output.
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
        if (!calls_relief(text) && !is_preparation(text)) continue;
        if (!prompted && (!in_shell || has_prompts)) continue;
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

TEST(ShownCommands, FollowAPromptOrAreInAShellBlock) {
    const std::vector<ShownCommand> commands = shown_commands(
        "relief-mesh turns meshes\n"            // prose
        "$ relief-mesh info a.obj\n"            // 2
        "```sh\n"                               //
        "build/release/bin/relief-bake bump\n"  // 4
        "git clone somewhere\n"                 //
        "  $ scripts/demo --fast\n"             // 6
        "```\n"                                 //
        "```sh\n"                               //
        "mkdir -p out\n"                        // 9
        "A_B=c relief-view a.obj\n"             // 10
        "A_B=c git clone somewhere\n"           //
        "```\n"                                 //
        "```cpp\n"                              //
        "relief-mesh in code\n"                 //
        "```\n"                                 //
        "```console\n"                          //
        "$ relief-view a.obj \\\n"              // 17
        "      --output b.png\n"                //
        "relief-view: error: said so\n"         // 19: output that looks like a command
        "```\n");
    ASSERT_EQ(commands.size(), 6U);
    EXPECT_EQ(commands[0].line, 2);
    EXPECT_EQ(commands[0].text, "relief-mesh info a.obj");
    EXPECT_EQ(commands[1].text, "build/release/bin/relief-bake bump");
    EXPECT_EQ(commands[2].text, "scripts/demo --fast");
    EXPECT_EQ(commands[3].text, "mkdir -p out");
    EXPECT_EQ(commands[4].text, "A_B=c relief-view a.obj");
    EXPECT_EQ(commands[5].line, 17);
    EXPECT_EQ(commands[5].text, "relief-view a.obj --output b.png");
}

TEST(ShownCommands, KnowWhichScriptTheyCall) {
    EXPECT_EQ(called_script("scripts/demo --fast"), "scripts/demo");
    EXPECT_EQ(called_script("./scripts/test"), "scripts/test");
    EXPECT_EQ(called_script("relief-mesh info scripts/demo"), "");
}

namespace fs = std::filesystem;

/// Returns the pages relative to the sources, sorted.
std::vector<std::string> documents() {
    std::set<std::string> found;
    for (const char* folder : {".", "conformance", "docs"}) {
        if (!fs::is_directory(source_directory() / folder)) continue;
        for (const auto& entry : fs::directory_iterator(source_directory() / folder)) {
            if (entry.path().extension() == ".md")
                found.insert(fs::relative(entry.path(), source_directory()).string());
        }
    }
    return {found.begin(), found.end()};
}

/// Returns the commands of relief in blocks without a language, which no test would run.
std::vector<std::string> commands_in_plain_blocks(const std::string& page) {
    std::vector<std::string> commands;
    std::istringstream lines(page);
    bool in_block = false;
    bool is_plain = false;
    for (std::string line; std::getline(lines, line);) {
        const std::string text = trimmed(line);
        if (text.starts_with("```")) {
            in_block = !in_block;
            is_plain = in_block && text == "```";
        } else if (is_plain && starts_with_any(text, {"relief ", "relief-"}) &&
                   text.find(' ') != std::string::npos &&
                   text.find(": error:") == std::string::npos) {
            commands.push_back(text);
        }
    }
    return commands;
}

struct Page {
    std::string name;
    std::vector<std::string> commands;
};

std::vector<Page> help_pages(const Workplace& workplace) {
    std::vector<Page> pages;
    for (const std::string& command : commands_with_help(workplace)) {
        const std::string name = command + " --help all";
        pages.push_back({name, examples_of(workplace.run(name).out)});
    }
    return pages;
}

Page document_page(const std::string& name) {
    Page page{name, {}};
    for (const ShownCommand& command : shown_commands(read_bytes(source_directory() / name)))
        page.commands.push_back(command.text);
    return page;
}

/// Maps each command to the first page that shows it: help pages first, then documents.
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

/// Returns whether a later command of the page names a file below out/ that this command names.
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

/// A command of `relief-accuracy run`, split into its output folder and the rest. Both are empty
/// for other commands.
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

/// The command with as few rounds as possible if it measures times and does not state how many
/// rounds: more of them only make times more precise, which no test checks, and take ten seconds.
std::string with_few_rounds(const std::string& command) {
    const auto has = [&](const char* text) { return command.find(text) != std::string::npos; };
    const bool is_run = has("relief-accuracy run ");
    if (!(is_run || has("relief-accuracy own ")) || has("--no-times") || has("--repeats"))
        return command;
    return command + (is_run ? " --repeats 3 --passes 1" : " --repeats 3");
}

TEST(ShownCommands, AreInShellBlocks) {
    EXPECT_EQ(commands_in_plain_blocks("```\nrelief-mesh info a\n```\n```sh\nrelief-mesh b\n```\n"
                                       "```\nrelief-mesh: error: no\n```\nrelief-mesh\n"),
              std::vector<std::string>{"relief-mesh info a"});
    for (const std::string& name : documents()) {
        EXPECT_EQ(commands_in_plain_blocks(read_bytes(source_directory() / name)),
                  std::vector<std::string>{})
            << name;
    }
}

TEST(ShownCommands, MeasureInFewRoundsUnlessTheyStateTheNumber) {
    EXPECT_EQ(with_few_rounds("bin/relief-accuracy run all"),
              "bin/relief-accuracy run all --repeats 3 --passes 1");
    EXPECT_EQ(with_few_rounds("relief-accuracy own a.obj"),
              "relief-accuracy own a.obj --repeats 3");
    for (const char* line : {"relief-accuracy own a.obj --repeats 5", "relief-mesh info a.obj",
                             "relief-accuracy run all --no-times", "relief-accuracy compare a b"})
        EXPECT_EQ(with_few_rounds(line), line);
}

/// The command with levels of detail that switch by the largest distance, if it does not state by
/// what they switch: the pictures that are compared otherwise take seconds for each level, and the
/// tests of `relief-mesh lods` compare them.
std::string without_pictures_of_levels(const std::string& command) {
    const bool is_lods = command.find("relief-mesh lods ") != std::string::npos;
    return is_lods && command.find("--switch") == std::string::npos ? command + " --switch distance"
                                                                    : command;
}

/// The command with a map of 128 texels, if it bakes one of 512 or, by default, 1024. Neither exit
/// codes nor messages depend on the size, except those of a search for the number of samples.
std::string with_small_map(const std::string& command) {
    const auto has = [&](const char* text) { return command.find(text) != std::string::npos; };
    if (!has("relief-bake mesh ") || has("--samples auto") || has("--max-error")) return command;
    if (!has(" --size ")) return command + " --size 128";
    return std::regex_replace(command, std::regex(" --size 512\\b"), " --size 128");
}

TEST(ShownCommands, BakeSmallMapsUnlessTheySearchForSamples) {
    EXPECT_EQ(with_small_map("relief-bake mesh a b c.png"),
              "relief-bake mesh a b c.png --size 128");
    EXPECT_EQ(with_small_map("relief-bake mesh a b c --size 512 --half"),
              "relief-bake mesh a b c --size 128 --half");
    for (const char* line : {"relief-bake mesh a b c --size 64", "relief-bake bump a b",
                             "relief-bake mesh a b c --size 512 --samples auto"})
        EXPECT_EQ(with_small_map(line), line);
}

ProgramResult run_fast(const std::string& command, const Workplace& workplace) {
    return workplace.run(with_small_map(without_pictures_of_levels(with_few_rounds(command))));
}

/// Runs a command. If it repeats a measurement of this process with another output folder, the
/// results are copied instead.
ProgramResult run_or_copy(const std::string& command, const Workplace& workplace) {
    static const TemporaryDirectory results;
    static std::map<std::string, fs::path> folder_of;
    const Measurement measurement = measurement_of(command);
    if (measurement.folder.empty()) return run_fast(command, workplace);
    const auto stored = folder_of.find(measurement.rest);
    if (stored != folder_of.end()) {
        fs::create_directories((workplace / measurement.folder).parent_path());
        fs::copy(stored->second, workplace / measurement.folder, fs::copy_options::recursive);
        return {0, "copied", ""};
    }
    ProgramResult result = run_fast(command, workplace);
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
        if (is_preparation(command)) {
            EXPECT_EQ(workplace.run(command).exit_code, 0);
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

/// A folder in which choices of kernels are fast. Their exit codes and messages do not depend on
/// the size of the map.
class FastWorkplace : public Workplace {
  public:
    FastWorkplace() { shrink_bricks(); }
};

/// A folder with the files of a fresh clone. Tools are in PATH, as after scripts/install.
class FreshClone : public FastWorkplace {
  public:
    FreshClone() {
        fs::remove_all(*this / "build");
        fs::remove(*this / "out");
        fs::create_directory_symlink(source_directory() / "shaders", *this / "shaders");
    }
};

/// A folder with nothing but a copy of the installed samples and shaders, which a fresh clone
/// contains, too.
class CopyOfSamples : public FreshClone {
  public:
    CopyOfSamples() {
        fs::remove(*this / "conformance");
        fs::remove(*this / "scripts");
    }
};

bool is_installed(const std::string& document) {
    return document == "README.md" || document.starts_with("docs/");
}

TEST_P(Document, ShowsCommandsThatRunInAFreshClone) {
    if (is_installed(GetParam()))
        expect_to_run(document_page(GetParam()), CopyOfSamples(), false);
    else
        expect_to_run(document_page(GetParam()), FreshClone(), false);
}

std::string test_name(const testing::TestParamInfo<std::string>& page) {
    std::string name;
    for (const char letter : page.param)
        name += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, Document, testing::ValuesIn(documents()), test_name);

class HelpExamples : public testing::TestWithParam<std::string> {};

TEST_LABELS(slow);
TEST_P(HelpExamples, RunWithoutAMessage) {
    for (const Page& page : help_pages(Workplace())) {
        if (page.name.starts_with(GetParam())) expect_to_run(page, FastWorkplace(), true);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, HelpExamples,
                         testing::Values("relief-accuracy", "relief-bake", "relief-mesh",
                                         "relief-view", "relief make", "relief check",
                                         "relief merge", "relief farm"),
                         test_name);

TEST_LABELS(slow);
TEST(Site, HasNoBrokenLinkAndFitsAPhone) {
    const TemporaryDirectory folder;
    const std::string script = "'" + (source_directory() / "scripts/dev/site").string() + "'";
    const ProgramResult result = run_shell(script + " --check --output site", folder.path());
    constexpr int program_missing = 77;
    if (result.exit_code == program_missing) GTEST_SKIP() << result.error;
    EXPECT_EQ(result.exit_code, 0) << result.out << result.error;
}

TEST(Readme, ShowsCodeThatCompiles) {
    const std::string readme = read_bytes(source_directory() / "README.md");
    static const std::string start = "```cpp\n";
    const TemporaryDirectory folder;
    int blocks = 0;
    for (std::size_t at = readme.find(start); at != std::string::npos;
         at = readme.find(start, at + 1), ++blocks) {
        const std::size_t begin = at + start.size();
        std::ofstream(folder / "shown.cpp")
            << readme.substr(begin, readme.find("```", begin) - begin);
        const ProgramResult result =
            run_shell(RELIEF_COMPILER " -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I '" +
                          (source_directory() / "libmesh/include").string() + "' shown.cpp",
                      folder.path());
        EXPECT_EQ(result.exit_code, 0) << result.error;
    }
    EXPECT_EQ(blocks, 1);
}

/// Collects the citations of a text with the file that contains them.
void collect(const std::string& text, const std::string& place,
             std::map<std::string, std::string>& citations) {
    static const std::regex citation(R"(\[[A-Z][^\[\]\n]* [12][0-9]{3}\])");
    for (std::sregex_iterator match(text.begin(), text.end(), citation), end; match != end;
         ++match) {
        citations.emplace(match->str(), place);
    }
}

std::map<std::string, std::string> cited_by_the_code() {
    std::map<std::string, std::string> citations;
    for (const char* part : {"libmesh", "libshade", "libaccuracy", "shaders", "tools", "data"}) {
        for (const auto& entry : fs::recursive_directory_iterator(source_directory() / part)) {
            const std::string kind = entry.path().extension().string();
            if (kind != ".h" && kind != ".cpp" && kind != ".glsl") continue;
            collect(read_bytes(entry.path()),
                    entry.path().lexically_relative(source_directory()).string(), citations);
        }
    }
    return citations;
}

TEST(References, ListEverythingThatTheCodeCites) {
    std::map<std::string, std::string> listed;
    collect(read_bytes(source_directory() / "REFERENCES.md"), "REFERENCES.md", listed);
    const std::map<std::string, std::string> cited = cited_by_the_code();
    ASSERT_GE(cited.size(), 10U) << "the code cites more than that";
    for (const auto& [citation, file] : cited) {
        EXPECT_TRUE(listed.contains(citation)) << citation << " is cited by " << file;
    }
    for (const auto& [citation, file] : listed) {
        EXPECT_TRUE(cited.contains(citation)) << citation << " is cited nowhere";
    }
}

}  // namespace
}  // namespace relief::test
