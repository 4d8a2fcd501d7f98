// SPDX-License-Identifier: Apache-2.0
// Reports count findings, and errors suggest the nearest known name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "near_names.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Report, IsEmptyUntilSomethingIsAdded) {
    Report report;
    EXPECT_TRUE(report.empty());
    EXPECT_EQ(report.count("isolated vertex"), 0U);
    report.add("isolated vertex", "vertex", 3, "gets the normal (0,0,1)");
    EXPECT_FALSE(report.empty());
    EXPECT_EQ(report.count("isolated vertex"), 1U);
}

TEST(Report, KeepsTheEightSmallestIndicesInAnyOrder) {
    Report descending;
    Report ascending;
    for (std::size_t i = 0; i < 20; ++i) {
        ascending.add("kind", "vertex", i, "outcome");
        descending.add("kind", "vertex", 19 - i, "outcome");
    }
    ASSERT_EQ(ascending.findings().size(), 1U);
    EXPECT_EQ(ascending.findings()[0].count, 20U);
    EXPECT_THAT(ascending.findings()[0].first, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
    EXPECT_EQ(ascending.findings()[0], descending.findings()[0]);
}

TEST(Report, ListsKindsInOrderOfFirstAppearanceAndKeepsTheFirstOutcome) {
    Report report;
    report.add("second by name", "vertex", 1, "first outcome");
    report.add("another", "triangle", 2, "other");
    report.add("second by name", "vertex", 0, "later outcome");
    ASSERT_EQ(report.findings().size(), 2U);
    EXPECT_EQ(report.findings()[0].kind, "second by name");
    EXPECT_EQ(report.findings()[0].outcome, "first outcome");
    EXPECT_EQ(report.findings()[1].element, "triangle");
}

TEST(Report, MergesCountsAndIndices) {
    Report a;
    Report b;
    for (std::size_t i = 0; i < 10; ++i) {
        a.add("kind", "vertex", 2 * i, "outcome");
        b.add("kind", "vertex", 2 * i + 1, "outcome");
    }
    b.add("only in b", "texel", 5, "outcome");
    a.merge(b);
    EXPECT_EQ(a.count("kind"), 20U);
    EXPECT_THAT(a.findings()[0].first, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
    EXPECT_EQ(a.count("only in b"), 1U);
}

TEST(Report, AcceptsExternalCounts) {
    Report report;
    report.add("kind", "vertex", 4, "outcome");
    report.add(Finding{"kind", "vertex", "another outcome", 100, {0, 1, 9}});
    report.add(Finding{"new", "mesh", "outcome", 1, {0}});
    ASSERT_EQ(report.findings().size(), 2U);
    EXPECT_EQ(report.findings()[0], (Finding{"kind", "vertex", "outcome", 101, {0, 1, 4, 9}}));
    EXPECT_EQ(report.count("new"), 1U);
}

TEST(Report, PrintsAFindingInOneLine) {
    Report report;
    report.add("degenerate triangle", "triangle", 17, "does not contribute");
    report.add("degenerate triangle", "triangle", 3, "does not contribute");
    EXPECT_EQ(to_string(report.findings()[0]),
              "2 x degenerate triangle (triangle 3, 17): does not contribute");
    for (std::size_t i = 100; i < 110; ++i)
        report.add("degenerate triangle", "triangle", i, "does not contribute");
    EXPECT_EQ(to_string(report.findings()[0]),
              "12 x degenerate triangle (triangle 3, 17, 100, 101, 102, 103, 104, 105, ...): "
              "does not contribute");
}

const std::vector<std::string> materials = {"black plastic", "bronze",     "cyan plastic",
                                            "emerald",       "gold",       "green plastic",
                                            "polished gold", "red plastic"};

TEST(NearNames, AreThoseOfFewSlips) {
    EXPECT_THAT(near_names("gild", materials), ElementsAre("gold"));
    EXPECT_THAT(near_names("Emereld", materials), ElementsAre("emerald"));
    EXPECT_THAT(near_names("redplastic", materials), ElementsAre("red plastic"));
    EXPECT_THAT(near_names("zzz", materials), IsEmpty());
    EXPECT_THAT(near_names("", materials), IsEmpty());
}

TEST(NearNames, AreThoseThatContainTheWord) {
    EXPECT_THAT(near_names("plastic", materials),
                ElementsAre("red plastic", "cyan plastic", "black plastic"));
    EXPECT_THAT(near_names("gold", materials), ElementsAre("gold", "polished gold"));
}

TEST(DidYouMean, IsAQuestionOrEmpty) {
    const std::vector<std::string> known = {"diffuse", "specular"};
    EXPECT_EQ(did_you_mean("difuse", known), "; did you mean 'diffuse'?");
    EXPECT_EQ(did_you_mean("shine", known), "");
    EXPECT_EQ(did_you_mean("gold", materials), "; did you mean 'gold' or 'polished gold'?");
}

}  // namespace
}  // namespace relief
