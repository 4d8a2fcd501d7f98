// SPDX-License-Identifier: Apache-2.0
// Planted defects are found, all of them, and sound models raise no alarm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "check/planted_defects.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::planted_kinds;
using test::ProgramResult;
using test::Workplace;

/// The rules with errors and warnings of each file, by the start of its name.
std::map<std::string, std::set<std::string>> alarms_of(const json& report,
                                                       std::size_t name_length) {
    std::map<std::string, std::set<std::string>> alarms;
    for (const json& file : report["files"]) {
        const std::string path = file["file"];
        const std::string name = path.substr(path.rfind('/') + 1).substr(0, name_length);
        for (const json& finding : file["findings"]) {
            if (finding["severity"] != "note") alarms[name].insert(finding["rule"]);
        }
    }
    return alarms;
}

// RELIEF_CHECK_CORPUS names a folder in which the files stay, for other checkers.
TEST(PlantedDefects, AreFoundWithoutOtherAlarms) {
    const Workplace workplace;
    const char* const kept = std::getenv("RELIEF_CHECK_CORPUS");
    const std::filesystem::path corpus = kept != nullptr ? kept : (workplace / "corpus").string();
    std::filesystem::create_directories(corpus);
    test::write_planted_defects(corpus);
    const ProgramResult result =
        workplace.run("relief check '" + corpus.string() + "' --format json");
    EXPECT_EQ(result.exit_code, 1) << result.error;  // Some cannot be read.
    const auto alarms = alarms_of(json::parse(result.out), 4);
    EXPECT_GE(planted_kinds().size(), 21U);
    for (std::size_t kind = 0; kind < planted_kinds().size(); ++kind) {
        const test::PlantedKind& expected = planted_kinds()[kind];
        for (int variant = 0; variant < test::planted_variants; ++variant) {
            const std::string name = test::planted_name(kind, variant);
            SCOPED_TRACE(name + " " + expected.rule);
            const auto found = alarms.find(name);
            std::set<std::string> rules =
                found == alarms.end() ? std::set<std::string>{} : found->second;
            EXPECT_EQ(rules.erase(expected.rule), expected.rule.empty() ? 0U : 1U);
            for (const std::string& rule : expected.also)
                rules.erase(rule);
            EXPECT_THAT(rules, testing::IsEmpty());
        }
    }
}

// Three images of Corset are not in the folder.
TEST_LABELS(not_sanitized);
TEST(RealModels, RaiseNoFalseAlarm) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    const ProgramResult result =
        Workplace().run("relief check '" + models.string() + "' --format json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const json report = json::parse(result.out);
    std::map<std::string, std::size_t> models_by_alarm;
    for (const json& file : report["files"]) {
        for (const json& finding : file["findings"]) {
            if (finding["severity"] == "note") continue;
            const std::string name =
                std::filesystem::path(file["file"].get<std::string>()).filename();
            ++models_by_alarm[name + " " + finding["rule"].get<std::string>()];
        }
    }
    EXPECT_EQ(models_by_alarm,
              (std::map<std::string, std::size_t>{{"Corset.gltf model/missing-image", 3}}));
    EXPECT_GE(report["files"].size(), 85U);
}

}  // namespace
}  // namespace relief::tools
