// SPDX-License-Identifier: Apache-2.0
#include "check_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using testing::HasSubstr;

TEST(CheckRules, HaveUniqueIdsOfAGroupAndWords) {
    std::set<std::string_view> ids;
    for (const CheckRule& rule : check_rules()) {
        SCOPED_TRACE(rule.id);
        EXPECT_TRUE(ids.insert(rule.id).second);
        EXPECT_THAT(std::string(rule.id), testing::MatchesRegex("[a-z]+/[a-z-]+"));
        EXPECT_FALSE(rule.title.empty());
        EXPECT_FALSE(rule.cause.empty());
        EXPECT_FALSE(rule.cost.empty());
        EXPECT_NE(rule.severity, CheckSeverity::off);
        EXPECT_EQ(find_check_rule(rule.id), &rule);
    }
    EXPECT_EQ(find_check_rule("mesh/unknown"), nullptr);
}

TEST(CheckRules, CoverEachConditionOnce) {
    const auto count = [](const auto& member) {
        return static_cast<std::size_t>(std::ranges::count_if(check_rules(), member));
    };
    for (const MeshConditionInfo& info : mesh_conditions())
        EXPECT_EQ(count([&](const CheckRule& rule) { return rule.of_mesh == info.condition; }), 1U)
            << info.word;
    for (const MapConditionInfo& info : map_conditions())
        EXPECT_EQ(count([&](const CheckRule& rule) { return rule.of_map == info.condition; }), 1U)
            << info.word;
}

TEST(CheckRules, AreListedByTheTool) {
    const test::Workplace workplace;
    const test::ProgramResult result = workplace.run("relief check --rules");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(std::ranges::count(result.out, '\n'),
              static_cast<std::ptrdiff_t>(check_rules().size()));
    EXPECT_THAT(result.out, HasSubstr("mesh/repeated-triangle           warning  Repeated"));
    EXPECT_THAT(workplace.run("relief check --rules --format json").out,
                HasSubstr("\"remedy\": \"relief-bake convert IN OUT --flip green\""));
    test::expect_refusals(workplace, "relief", "x.glb",
                          {{"check --rules data", 2, "--rules: lists the rules"},
                           {"check --rules --format sarif", 2, "--rules: only as text or JSON"}});
}

}  // namespace
}  // namespace relief::tools
