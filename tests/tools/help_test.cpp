// SPDX-License-Identifier: Apache-2.0
// Short and full help pages, their JSON, manual pages and completions.
#include "common/help.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "relief-accuracy/commands.h"
#include "relief-bake/commands.h"
#include "relief-mesh/commands.h"
#include "relief-view/view_command.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

std::vector<Json> all_tools() {
    return {describe(relief_accuracy()), describe(relief_bake()), describe(relief_mesh()),
            describe(relief_view())};
}

const Json& named(const Json& list, const std::string& name) {
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const Json& one) { return one.at("name") == name; });
    if (found == list.end()) throw std::runtime_error(name + " is missing");
    return *found;
}

/// The option names at the start of lines of a help page.
std::set<std::string> options_of_page(const std::string& page) {
    std::set<std::string> names;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t at = line.find("--");
        if (line.starts_with("  -") && at < 6)
            names.insert(line.substr(at, line.find_first_of(" ", at) - at));
    }
    return names;
}

void expect_pages_match(const Workplace& workplace, const std::string& command,
                        const Json& description) {
    SCOPED_TRACE(command);
    std::set<std::string> common, all;
    for (const Json& option : description.at("options")) {
        const auto name = option.at("name").get<std::string>();
        all.insert(name);
        if (!option.at("advanced")) common.insert(name);
    }
    const std::string page = workplace.run(command + " --help").out;
    EXPECT_EQ(options_of_page(page), common);
    EXPECT_EQ(options_of_page(workplace.run(command + " --help all").out), all);
    const std::string omitted = " and " + std::to_string(all.size() - common.size()) + " advanced";
    EXPECT_EQ(page.find(omitted) != std::string::npos, all.size() > common.size());
}

TEST(Help, TheShortPageListsCommonOptionsAndTheFullPageAll) {
    const Workplace workplace;
    for (const Json& tool : all_tools()) {
        const auto name = tool.at("name").get<std::string>();
        expect_pages_match(workplace, name, tool);
        if (!tool.contains("commands")) continue;
        for (const Json& command : tool.at("commands"))
            expect_pages_match(workplace, name + " " + command.at("name").get<std::string>(),
                               command);
    }
}

TEST(Help, TheShortPageOfTheViewerFitsOneScreen) {
    const std::string page = Workplace().run("relief-view --help").out;
    EXPECT_LE(std::count(page.begin(), page.end(), '\n'), 60);
}

TEST(Help, JsonDescribesCommandsOptionsAndWords) {
    const Workplace workplace;
    const ProgramResult result = workplace.run("relief-bake --help-json");
    EXPECT_EQ(result.exit_code, 0);
    const Json tool = Json::parse(result.out);
    EXPECT_EQ(tool, describe(relief_bake()));
    EXPECT_EQ(tool.at("name"), "relief-bake");
    const Json& bump = named(tool.at("commands"), "bump");
    const Json& kernel = named(bump.at("options"), "--kernel");
    EXPECT_EQ(kernel.at("words").size(), 11U);
    EXPECT_THAT(kernel.at("words"), Contains("scharr5"));
    EXPECT_EQ(kernel.at("heading"), "Accuracy");
    EXPECT_EQ(kernel.at("advanced"), false);
    EXPECT_EQ(named(bump.at("options"), "--invert").at("value"), nullptr);
    EXPECT_EQ(named(bump.at("options"), "--output").at("short"), "-o");
    EXPECT_EQ(named(bump.at("options"), "--strength").at("value"), "S");
    EXPECT_EQ(named(bump.at("arguments"), "FILE...").at("repeats"), true);
    EXPECT_EQ(bump.at("examples").size(), 9U);
}

TEST(Help, JsonExcludesAllOtherArguments) {
    const ProgramResult result = Workplace().run("relief-view --help-json --quiet");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("--help-json: excludes all other arguments"));
}

/// Writes all files of the manual to the folder "share".
void write_manual(const Workplace& workplace) {
    std::string command = "scripts/dev/make-manuals share";
    for (const Json& tool : all_tools()) {
        const std::string file = tool.at("name").get<std::string>() + ".json";
        workplace.write(file, tool.dump());
        command += " " + file;
    }
    const ProgramResult result = workplace.run(command);
    ASSERT_EQ(result.exit_code, 0) << result.error;
}

bool is_found(const Workplace& workplace, const std::string& program) {
    return workplace.run("command -v " + program).exit_code == 0;
}

TEST(Manual, HasAPageForEachToolAndCommandWithAllOptions) {
    const Workplace workplace;
    write_manual(workplace);
    std::size_t pages = 0;
    for (const Json& tool : all_tools())
        pages += 1 + (tool.contains("commands") ? tool.at("commands").size() : 0);
    EXPECT_EQ(workplace.run("ls share/man/man1 | wc -l").out, std::to_string(pages) + "\n");
    const std::string mesh = workplace.read("share/man/man1/relief-bake-mesh.1");
    EXPECT_THAT(mesh, HasSubstr(".SH NAME\nrelief\\-bake\\-mesh \\- Bakes the normals"));
    EXPECT_THAT(mesh, HasSubstr("\n\\fB\\-\\-occlusion\\-rays\\fR \\fIN\\fR\n"));
    EXPECT_THAT(mesh, HasSubstr(".SH EXIT STATUS\n"));
}

TEST(Manual, GroffReadsEveryPageWithoutAWarning) {
    const Workplace workplace;
    if (!is_found(workplace, "groff")) GTEST_SKIP() << "groff is not installed";
    write_manual(workplace);
    const ProgramResult result =
        workplace.run("groff -man -ww -z -Tutf8 -rLL=100n share/man/man1/*.1");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    const std::string page =
        workplace.run("groff -man -Tascii -P-cbou share/man/man1/relief-bake-bump.1").out;
    EXPECT_THAT(page, HasSubstr("--height H"));
    EXPECT_THAT(page, HasSubstr("relief-bake bump data/*-height.png -o out/maps/"));
}

/// Returns the completions that bash offers for the last word of a line.
std::string bash_offers(const Workplace& workplace, const std::string& words) {
    workplace.write("offer.sh",
                    "source share/bash-completion/completions/$1\n"
                    "COMP_WORDS=(\"$@\")\n"
                    "COMP_CWORD=$(($# - 1))\n"
                    "_${1//-/_}\n"
                    "echo \"${COMPREPLY[@]}\"\n");
    const ProgramResult result = workplace.run("bash offer.sh " + words);
    EXPECT_EQ(result.error, "");
    return result.out;
}

TEST(Completions, BashOffersCommandsOptionsAndWords) {
    const Workplace workplace;
    write_manual(workplace);
    EXPECT_EQ(bash_offers(workplace, "relief-bake h"), "heights\n");
    EXPECT_EQ(bash_offers(workplace, "relief-bake bump --kernel sob"), "sobel3 sobel5\n");
    EXPECT_EQ(bash_offers(workplace, "relief-bake bump --destair"), "--destaircase\n");
    EXPECT_EQ(bash_offers(workplace, "relief-bake heights --destair"), "\n");
    EXPECT_EQ(bash_offers(workplace, "relief-view --tone-mapping ''"),
              "none reinhard aces khronos_neutral aces_hill aces_hill_boost\n");
    EXPECT_EQ(bash_offers(workplace, "relief-view --wiref"), "--wireframe\n");
    EXPECT_EQ(bash_offers(workplace, "relief-view --output --w"), "\n");
    EXPECT_EQ(bash_offers(workplace, "relief-view model"), "\n");
}

TEST(Completions, OtherShellsReadThem) {
    const Workplace workplace;
    write_manual(workplace);
    bool is_tested = false;
    for (const auto& [shell, files] : {std::pair("zsh", "share/zsh/vendor-completions/_*"),
                                       std::pair("fish", "share/fish/vendor_completions.d/*")}) {
        if (!is_found(workplace, shell)) continue;
        is_tested = true;
        const ProgramResult result = workplace.run(std::string("for file in ") + files + "; do " +
                                                   shell + " -n $file || exit 1; done");
        EXPECT_EQ(result.exit_code, 0) << shell;
        EXPECT_EQ(result.error, "") << shell;
    }
    if (!is_tested) GTEST_SKIP() << "zsh and fish are not installed";
}

TEST(Completions, FishOffersWords) {
    const Workplace workplace;
    if (!is_found(workplace, "fish")) GTEST_SKIP() << "fish is not installed";
    write_manual(workplace);
    const ProgramResult result = workplace.run(
        "HOME=$PWD fish -c 'source share/fish/vendor_completions.d/relief-bake.fish; "
        "complete -C \"relief-bake bump --kernel sob\"'");
    EXPECT_THAT(result.out, HasSubstr("sobel3"));
    EXPECT_THAT(result.out, HasSubstr("sobel5"));
    EXPECT_THAT(result.out, Not(HasSubstr("scharr")));
}

}  // namespace
}  // namespace relief::tools
