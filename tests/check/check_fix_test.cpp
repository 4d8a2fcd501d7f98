// SPDX-License-Identifier: Apache-2.0
// --fix runs the remedies that the findings name.
#include "check_fix.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

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

/// Returns the number of a planted kind.
std::size_t planted_kind(const std::string& rule) {
    std::size_t kind = 0;
    while (test::planted_kinds().at(kind).rule != rule)
        ++kind;
    return kind;
}

TEST_F(Fix, RemediesImagesInsideOfModels) {
    test::write_planted_model(workplace / "in", "a", planted_kind("texture/green-down"), 1);
    ASSERT_EQ(test::run_shell("relief-mesh process in/a.gltf b.glb", workplace / "").exit_code, 0);
    const std::string before = test::read_bytes(workplace / "b.glb");
    EXPECT_THAT(test::run_shell("relief check b.glb", workplace / "").out,
                testing::HasSubstr("[texture/green-down]\n    -> relief check b.glb --fix -o "
                                   "fixed\n"));
    const ProgramResult result = run("b.glb --fix -o out --format json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const json fixes = json::parse(result.out)["fixes"];
    ASSERT_EQ(fixes.size(), 1U);
    EXPECT_EQ(fixes[0]["error"], "");
    EXPECT_THAT(fixes[0]["command"].get<std::string>(),
                testing::HasSubstr("relief-bake convert IN OUT --flip green (image "));
    ASSERT_EQ(fixes[0]["findings"].size(), 1U);
    EXPECT_EQ(fixes[0]["findings"][0]["rule"], "texture/green-down");
    EXPECT_EQ(fixes[0]["findings"][0]["remaining"], 0);
    EXPECT_EQ(test::read_bytes(workplace / "b.glb"), before);
    EXPECT_EQ(run("out/b.glb --strict").exit_code, 0);
    // Only this image differs, and it is the one that convert writes.
    const GltfDocument fixed = test::read_document(workplace / "out/b.glb");
    const GltfDocument old = test::read_document(workplace / "b.glb");
    const auto bytes_of = [](const GltfImage& image) {
        return std::get<std::vector<std::byte>>(image.source);
    };
    std::size_t changed = 0;
    for (const GltfImage& image : fixed.view().images) {
        const auto old_images = old.view().images;
        changed += std::ranges::none_of(
            old_images, [&](const GltfImage& other) { return bytes_of(other) == bytes_of(image); });
    }
    EXPECT_EQ(changed, 1U);
    EXPECT_EQ(fixed.view().images.size(), old.view().images.size());
}

// A program that says that it has done its work, and has not.
TEST_F(Fix, ReportsFindingsThatRemain) {
    test::write_planted_model(workplace / "in", "a", planted_kind("mesh/repeated-triangle"), 1);
    fs::create_directory(workplace / "tools");
    fs::copy_file(workplace / "build/release/bin/relief", workplace / "tools/relief");
    workplace.write("tools/relief-mesh", "#!/bin/sh\nexit 0\n");
    fs::permissions(workplace / "tools/relief-mesh", fs::perms::owner_all);
    const std::string line = "tools/relief check in --fix --in-place";
    const ProgramResult result = test::run_shell(line + " --format json", workplace / "");
    EXPECT_EQ(result.exit_code, 1);
    const json fixes = json::parse(result.out)["fixes"];
    ASSERT_EQ(fixes.size(), 1U);
    EXPECT_EQ(fixes[0]["error"], "mesh/repeated-triangle remains after the remedy");
    EXPECT_EQ(fixes[0]["findings"][0]["count"], 1);
    EXPECT_EQ(fixes[0]["findings"][0]["remaining"], 1);
    EXPECT_THAT(test::run_shell(line, workplace / "").out,
                testing::HasSubstr("not fixed in/a.gltf: mesh/repeated-triangle remains after the "
                                   "remedy\n"));
    EXPECT_EQ(test::run_shell(line + " --quiet", workplace / "").error,
              "relief: error: not fixed in/a.gltf: mesh/repeated-triangle remains after the "
              "remedy\n");
}

TEST_F(Fix, NeverReplacesACheckedFileOrAnotherCopy) {
    test::write_planted_model(workplace / "in", "a", planted_kind("mesh/repeated-triangle"), 1);
    fs::create_directories(workplace / "here/in");
    test::write_planted_model(workplace / "here/in", "a", planted_kind("mesh/repeated-triangle"),
                              2);
    const auto before = contents_of(workplace / "in");
    const ProgramResult itself = run("in --fix -o .");
    EXPECT_EQ(itself.exit_code, 1);
    EXPECT_THAT(itself.out, testing::HasSubstr("not fixed in/a.gltf: its copy would replace "
                                               "in/a.gltf (give another folder)\n"));
    EXPECT_EQ(contents_of(workplace / "in"), before);
    const ProgramResult twice =
        test::run_shell("relief check in ../in --fix -o fixed", workplace / "here");
    EXPECT_EQ(twice.exit_code, 1);
    EXPECT_THAT(twice.out, testing::HasSubstr("not fixed ../in/a.gltf: its copy would replace "
                                              "in/a.gltf (give another folder)\n"));
    EXPECT_THAT(twice.out, testing::HasSubstr("fixed fixed/in/a.gltf: "));
    // Copies of the first run are not checked in the second one.
    for (int i = 0; i < 2; ++i) {
        const ProgramResult again =
            test::run_shell("relief check . --fix -o fixed", workplace / "in");
        EXPECT_EQ(again.exit_code, 0) << again.out;
        EXPECT_FALSE(fs::exists(workplace / "in/fixed/fixed"));
    }
}

}  // namespace
}  // namespace relief::tools
