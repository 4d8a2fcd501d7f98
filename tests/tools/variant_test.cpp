// SPDX-License-Identifier: Apache-2.0
#include "variant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "common/command.h"

namespace relief::tools {
namespace {

std::string refusal_of(const std::string& text) {
    try {
        parse_variant("--compare " + text, text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(Variant, EachHasATextOfItsOwnThatBringsItBack) {
    std::set<std::string> texts;
    for (const VariantTopic& topic : variant_topics()) {
        for (const auto& [word, variant] : topic.choices) {
            EXPECT_EQ(to_text(variant), topic.name + "=" + word);
            EXPECT_EQ(parse_variant("", to_text(variant)), variant);
            EXPECT_TRUE(texts.insert(to_text(variant)).second);
        }
    }
    EXPECT_GE(texts.size(), 32U);
}

TEST(Variant, TopicsAreInTheOrderOfTheirTypes) {
    for (std::size_t i = 0; i < variant_topics().size(); ++i)
        EXPECT_EQ(variant_topics()[i].choices.front().second.index(), i);
}

TEST(Variant, WhatIsNoneIsRefusedWithWhatThereIs) {
    using testing::HasSubstr;
    EXPECT_THAT(refusal_of("kernel=box"), HasSubstr("kernel: not one of forward, central3"));
    EXPECT_THAT(refusal_of("colour=red"), HasSubstr("not one of interpolation=, map=, kernel="));
    EXPECT_THAT(refusal_of("kernel"), HasSubstr("not one of"));
    EXPECT_THAT(refusal_of(""), HasSubstr("not one of"));
}

}  // namespace
}  // namespace relief::tools
