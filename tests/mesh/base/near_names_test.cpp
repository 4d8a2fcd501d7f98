// SPDX-License-Identifier: Apache-2.0
// Slips of the finger find the word that was meant; other words find nothing.
#include "near_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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

TEST(DidYouMean, IsAQuestionOrNothing) {
    const std::vector<std::string> known = {"diffuse", "specular"};
    EXPECT_EQ(did_you_mean("difuse", known), "; did you mean 'diffuse'?");
    EXPECT_EQ(did_you_mean("shine", known), "");
    EXPECT_EQ(did_you_mean("gold", materials), "; did you mean 'gold' or 'polished gold'?");
}

}  // namespace
}  // namespace relief
