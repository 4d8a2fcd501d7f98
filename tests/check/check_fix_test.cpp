// SPDX-License-Identifier: Apache-2.0
// --fix runs the remedies that the findings name.
#include "check_fix.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "check/planted_defects.h"
#include "tools/linked_tools.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ProgramResult;
using test::Workplace;

/// Copies of all files of a folder, by name.
std::map<std::string, std::string> contents_of(const fs::path& folder) {
    std::map<std::string, std::string> contents;
    for (const auto& entry : fs::directory_iterator(folder))
        contents[entry.path().filename()] = test::read_bytes(entry);
    return contents;
}

class Fix : public testing::Test {
  protected:
    void SetUp() override { fs::create_directory(workplace / "in"); }

    /// Plants a model for each rule with a command as remedy. \return their number
    int plant_fixable() const {
        int count = 0;
        for (std::size_t kind = 1; kind < test::planted_kinds().size(); ++kind) {
            const CheckRule* const rule = find_check_rule(test::planted_kinds()[kind].rule);
            if (!rule->is_fixable()) continue;
            test::write_planted_model(workplace / "in", test::planted_name(kind, 3), kind, 3);
            ++count;
        }
        return count;
    }

    // The tools run as processes beside this one.
    [[nodiscard]] ProgramResult run(const std::string& line) const {
        return test::run_shell("relief check " + line, workplace.operator/("."));
    }

    Workplace workplace;
};

TEST_F(Fix, RemediesAllThatItNames) {
    const int count = plant_fixable();
    EXPECT_GE(count, 14);
    const auto before = contents_of(workplace / "in");
    const ProgramResult result = run("in --fix -o out --format json");
    EXPECT_EQ(result.exit_code, 0) << result.error << result.out;
    const json report = json::parse(result.out);
    EXPECT_EQ(report["fixes"].size(), count);
    for (const json& fix : report["fixes"])
        EXPECT_EQ(fix["error"], "") << fix.dump();
    EXPECT_EQ(contents_of(workplace / "in"), before);
    EXPECT_TRUE(fs::exists(workplace / "out/in"));
    const ProgramResult in_place = run("in --fix --in-place --quiet");
    EXPECT_EQ(in_place.exit_code, 0) << in_place.error;
    const ProgramResult after = run("in --strict");
    EXPECT_EQ(after.exit_code, 0) << after.out;
}

TEST_F(Fix, LeavesAFileThatCannotBeFixed) {
    fs::create_directory(workplace / "maps");
    test::write_planted_model(workplace / "in", "a", 1, 0);
    fs::create_directory(workplace / "out/in");
    fs::create_directory(workplace / "out/in/a.gltf");
    const ProgramResult result = run("in --fix -o out --format json");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(json::parse(result.out)["fixes"][0]["error"], "");
}

TEST_F(Fix, PassesNamesToNoShell) {
    const std::string name = "-x $(touch pwned) 'a' \"b\"\nc";
    test::write_planted_model(workplace / "in", name, 1, 0);
    const ProgramResult result =
        test::run_shell("relief check . --fix --in-place --format json", workplace / "in");
    EXPECT_EQ(result.exit_code, 0) << result.error << result.out;
    EXPECT_EQ(json::parse(result.out)["fixes"].size(), 1U);
    EXPECT_FALSE(fs::exists(workplace / "in/pwned"));
    EXPECT_EQ(json::parse(workplace.run("relief check in --format json").out)["warnings"], 0);
}

}  // namespace
}  // namespace relief::tools
