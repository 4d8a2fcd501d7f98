// SPDX-License-Identifier: Apache-2.0
// Runs what action.yml and .pre-commit-hooks.yaml say, as GitHub and pre-commit do: the scripts of
// the action with its inputs as environment, and the entries of the hooks on the files that they
// match, in a folder of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "check/planted_defects.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// A line of a YAML file: its indentation, key and value without quotes; "-" counts as indentation.
struct YamlLine {
    std::size_t indent = 0;
    bool begins_item = false;
    std::string key;
    std::string value;
};

/// Reads the part of YAML that both files use: a key and a value on each line.
std::vector<YamlLine> yaml_lines(const std::string& text) {
    std::vector<YamlLine> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        YamlLine read;
        read.indent = line.find_first_not_of(' ');
        if (read.indent == std::string::npos || line[read.indent] == '#') continue;
        if (line.compare(read.indent, 2, "- ") == 0) {
            read.begins_item = true;
            read.indent += 2;
        }
        const std::size_t colon = line.find(':', read.indent);
        EXPECT_NE(colon, std::string::npos) << line;
        read.key = line.substr(read.indent, colon - read.indent);
        read.value = colon + 2 < line.size() ? line.substr(colon + 2) : "";
        const char quote = read.value.empty() ? ' ' : read.value.front();
        if ((quote == '"' || quote == '\'') && read.value.back() == quote)
            read.value = read.value.substr(1, read.value.size() - 2);
        lines.push_back(read);
    }
    return lines;
}

/// The action: inputs with their defaults, and steps.
struct Action {
    struct Step {
        std::string shell, run;
        std::map<std::string, std::string> environment;
    };
    std::map<std::string, std::string> inputs;
    std::vector<Step> steps;
};

Action read_action(const std::string& text) {
    Action action;
    std::string section, input;
    for (const YamlLine& line : yaml_lines(text)) {
        if (line.indent == 0) section = line.key;
        if (section == "inputs" && line.indent == 2) {
            input = line.key;
            action.inputs[input];
        }
        if (section == "inputs" && line.key == "default") action.inputs[input] = line.value;
        if (section != "runs") continue;
        if (line.begins_item) action.steps.emplace_back();
        if (action.steps.empty()) continue;
        Action::Step& step = action.steps.back();
        if (line.key == "shell")
            step.shell = line.value;
        else if (line.key == "run")
            step.run = line.value;
        else if (line.key != "env")
            step.environment[line.key] = line.value;
    }
    return action;
}

/// Replaces "${{ inputs.paths }}" and the like. An unknown expression is an error.
std::string evaluated(std::string text, const std::map<std::string, std::string>& values) {
    static const std::regex expression(R"(\$\{\{ *([a-z_.0-9]+) *\}\})");
    std::smatch match;
    while (std::regex_search(text, match, expression)) {
        EXPECT_TRUE(values.contains(match[1])) << match[1];
        const auto value = values.find(match[1]);
        text = match.prefix().str() + (value == values.end() ? "" : value->second) +
               match.suffix().str();
    }
    return text;
}

class ActionFile : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directory(workplace / "repository");
        for (const char* name : {"action.yml", ".pre-commit-hooks.yaml"})
            fs::copy_file(fs::path(RELIEF_SOURCE_DIRECTORY) / name, workplace / name);
        // An archive of the tools, as scripts/package makes one.
        fs::create_directories(workplace / "relief-1/bin");
        for (const std::string tool : {"relief", "relief-mesh", "relief-bake"}) {
            const fs::path program = fs::canonical(workplace / ("build/release/bin/" + tool));
            workplace.write("relief-1/bin/" + tool,
                            "#!/bin/sh\nexec '" + program.string() + "' \"$@\"\n");
        }
        EXPECT_EQ(workplace.run("chmod +x relief-1/bin/* && tar -cf relief.tar relief-1").exit_code,
                  0);
    }

    /// Runs the steps of the action in the folder of a repository. Unknown inputs are an error.
    [[nodiscard]] ProgramResult run_action(std::map<std::string, std::string> given) const {
        const Action action = read_action(workplace.read("action.yml"));
        EXPECT_EQ(action.steps.size(), 1U);
        given.emplace("package", (workplace / "relief.tar").string());
        std::map<std::string, std::string> values = {
            {"github.action_path", (workplace / "").string()},
            {"github.server_url", "https://github.com"},
            {"github.action_repository", "relief/relief"},
            {"github.action_ref", "v1.1.0"}};
        for (const auto& [name, standard] : action.inputs)
            values["inputs." + name] = standard;
        for (const auto& [name, value] : given) {
            EXPECT_TRUE(action.inputs.contains(name)) << name;
            values["inputs." + name] = value;
        }
        ProgramResult result;
        for (const Action::Step& step : action.steps) {
            EXPECT_EQ(step.shell, "bash");
            std::vector<std::string> words = {"/usr/bin/env", "-i", "PATH=/usr/bin:/bin",
                                              "GITHUB_ACTIONS=true"};
            for (const auto& [name, value] : step.environment)
                words.push_back(name + "=" + evaluated(value, values));
            std::ofstream(workplace / "step.sh") << evaluated(step.run, values) << "\n";
            // As GitHub runs the steps of bash.
            words.insert(words.end(), {"bash", "--noprofile", "--norc", "-eo", "pipefail",
                                       (workplace / "step.sh").string()});
            result = test::run_program(words, workplace / "repository");
            if (result.exit_code != 0) break;
        }
        return result;
    }

    /// \param rule  "" for a sound model
    void plant(const std::string& name, const std::string& rule) const {
        std::size_t kind = 0;
        while (test::planted_kinds().at(kind).rule != rule)
            ++kind;
        test::write_planted_model(workplace / "repository", name, kind, 1);
    }

    Workplace workplace;
};

TEST_F(ActionFile, AnnotatesTheFilesOfARepository) {
    plant("sound", "");
    const ProgramResult sound = run_action({{"paths", "."}});
    EXPECT_EQ(sound.exit_code, 0) << sound.error << sound.out;
    EXPECT_EQ(sound.out, "");
    plant("b", "mesh/repeated-triangle");
    plant("two words", "texture/green-down");
    const ProgramResult result = run_action({{"paths", "."}});
    EXPECT_EQ(result.exit_code, 3) << result.error;
    EXPECT_THAT(result.out, HasSubstr("::warning file=b.gltf,title=mesh/repeated-triangle::"));
    EXPECT_THAT(result.out,
                HasSubstr("::error file=two words_normal.png,title=texture/green-down::"));
    EXPECT_EQ(run_action({{"paths", "."}, {"options", ""}}).exit_code, 0);
}

TEST_F(ActionFile, ChecksModelsAndMapsByPatterns) {
    plant("b", "mesh/repeated-triangle");
    plant("c", "map/no-directions");
    const ProgramResult result = run_action({{"models", "*.gltf"}, {"maps", "*_normal.png"}});
    EXPECT_EQ(result.exit_code, 3) << result.error;
    EXPECT_THAT(result.out, HasSubstr("b.gltf"));
    EXPECT_THAT(result.out, HasSubstr("c_normal.png"));
    EXPECT_THAT(run_action({{"models", "*.none"}}).error, HasSubstr("*.none: no such file"));
    // The action has no folder to check.
    EXPECT_EQ(run_action({}).exit_code, 0);
}

// Names that a pattern finds are files, whatever they begin with, and have no meaning in a shell.
TEST_F(ActionFile, TakesNamesOfAnyKind) {
    for (const char* name : {"-x", "--in-place", "@list", "$(touch pwned)", "a;b 'c' \"d\""})
        plant(name, "mesh/repeated-triangle");
    const ProgramResult result = run_action({{"paths", "*.gltf"}});
    EXPECT_EQ(result.exit_code, 3) << result.error;
    for (const char* name : {"-x", "--in-place", "@list", "$(touch pwned)", "a;b 'c' \"d\""})
        EXPECT_THAT(result.out, HasSubstr(" file=" + std::string(name) + ".gltf,title=")) << name;
    EXPECT_FALSE(fs::exists(workplace / "repository/pwned"));
}

TEST_F(ActionFile, RefusesAnotherArchive) {
    plant("b", "mesh/repeated-triangle");
    EXPECT_THAT(run_action({{"paths", "."}, {"sha256", std::string(64, '0')}}).error,
                HasSubstr("its SHA-256 is not 000"));
    const std::string sum = workplace.run("sha256sum relief.tar").out.substr(0, 64);
    EXPECT_EQ(run_action({{"paths", "."}, {"sha256", sum}}).exit_code, 3);
    EXPECT_THAT(run_action({{"paths", "."}, {"package", "none.tar"}}).error,
                HasSubstr("none.tar: no such file"));
}

/// A hook of pre-commit.
struct Hook {
    std::string id, entry, files, arguments;
};

TEST_F(ActionFile, HooksCheckTheFilesThatTheyMatch) {
    std::vector<Hook> hooks;
    for (const YamlLine& line : yaml_lines(workplace.read(".pre-commit-hooks.yaml"))) {
        if (line.begins_item) hooks.emplace_back();
        Hook& hook = hooks.back();
        if (line.key == "id") hook.id = line.value;
        if (line.key == "entry") hook.entry = line.value;
        if (line.key == "files") hook.files = line.value;
        if (line.key == "args") hook.arguments = line.value;
    }
    ASSERT_EQ(hooks.size(), 3U);
    plant("-a", "mesh/repeated-triangle");
    plant("two words", "map/no-directions");
    workplace.write("repository/notes.txt", "no model");
    const std::map<std::string, std::string> findings = {
        {"relief-mesh-check", "repeated triangle"},
        {"relief-bake-check", "two words_normal.png"},
        {"relief-check", "[mesh/repeated-triangle]"}};
    for (const Hook& hook : hooks) {
        SCOPED_TRACE(hook.id);
        EXPECT_EQ(hook.arguments, "[--]");
        ASSERT_TRUE(hook.files.starts_with("(?i)"));
        const std::regex pattern(hook.files.substr(4), std::regex::ECMAScript | std::regex::icase);
        std::vector<std::string> words = {"/usr/bin/env", "bash", "-c",
                                          "PATH=" + (workplace / "relief-1/bin").string() +
                                              ":$PATH\nexec " + hook.entry + " -- \"$@\"",
                                          "hook"};
        for (const auto& file : fs::directory_iterator(workplace / "repository")) {
            const std::string name = file.path().filename();
            if (std::regex_search(name, pattern)) words.push_back(name);
        }
        const ProgramResult result = test::run_program(words, workplace / "repository");
        EXPECT_EQ(result.exit_code, 3) << result.error;
        EXPECT_THAT(result.out, HasSubstr(findings.at(hook.id)));
    }
}

}  // namespace
}  // namespace relief::tools
