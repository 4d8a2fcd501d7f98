// SPDX-License-Identifier: Apache-2.0
// The values of options and their error messages.
#include "common/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "common/view_direction.h"
#include "relief/mesh/limits.h"

namespace relief::tools {
namespace {

using testing::ElementsAre;

/// Returns the message of the thrown UsageError.
template <typename Call>
std::string refusal_by(Call&& call) {
    try {
        call();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(OptionNumbers, AreParsedCompletely) {
    EXPECT_EQ(parse_number("--x", "-1.5e3"), -1500.0);
    EXPECT_EQ(parse_number("--x", "+2"), 2.0);
    EXPECT_EQ(parse_integer("--n", "12", 1, 16), 12);
}

TEST(OptionNumbers, RefuseTextTrailingTextAndNonFiniteValues) {
    for (const char* text : {"abc", "", "12abc", "1,5", "inf", "nan", "1e999", "0x10", " 1"}) {
        EXPECT_EQ(refusal_by([&] { parse_number("--strength X", text); }),
                  "--strength X: not a number")
            << text;
    }
    EXPECT_EQ(refusal_by([] { parse_integer("--threads 1.5", "1.5", 1, 8); }),
              "--threads 1.5: not a whole number");
}

TEST(OptionNumbers, NameTheRangeTheyAreOutsideOf) {
    const Range degrees{1, 170, "degrees"};
    EXPECT_EQ(refusal_by([&] { parse_number("--fov 200", "200", degrees); }),
              "--fov 200: not between 1 and 170 degrees");
    EXPECT_EQ(parse_number("--fov 170", "170", degrees), 170.0);
    EXPECT_EQ(refusal_by([] { parse_number("--ambient -1", "-1", {.min = 0, .unit = ""}); }),
              "--ambient -1: not at least 0");
    EXPECT_EQ(refusal_by([] { parse_integer("--threads 0", "0", 1, 1024); }),
              "--threads 0: not between 1 and 1024");
}

TEST(OptionColors, AreSrgbCodedAndBecomeLinear) {
    const glm::vec3 color = parse_color("--background", "#ff8000");
    EXPECT_EQ(color.r, 1.0F);
    // 0x80 = 128 of 255; ((128/255 + 0.055) / 1.055)^2.4 by hand.
    EXPECT_NEAR(color.g, 0.2158605, 1e-6) << "float rounding of the power";
    EXPECT_EQ(color.b, 0.0F);
    for (const char* text : {"ff8000", "#ff800", "#ff80000", "#gg0000", "red", "#-12345", ""}) {
        EXPECT_EQ(refusal_by([&] { parse_color("--background X", text); }),
                  "--background X: not a color like #ff8000")
            << text;
    }
}

TEST(OptionSizes, AreTwoIntegers) {
    EXPECT_EQ(parse_size("--size", "1920x1080"), glm::ivec2(1920, 1080));
    EXPECT_EQ(refusal_by([] { parse_size("--size 640", "640"); }),
              "--size 640: not a size like 1920x1080");
    EXPECT_EQ(refusal_by([] { parse_size("--size 0x5", "0x5"); }),
              "--size 0x5: not between 1 and 16384");
    EXPECT_EQ(refusal_by([] { parse_size("--size 5x", "5x"); }), "--size 5x: not a whole number");
}

TEST(OptionChoices, ListTheirValues) {
    const Choices<int> choices = {{"one", 1}, {"two", 2}};
    EXPECT_EQ(parse_choice("--n two", "two", choices), 2);
    EXPECT_EQ(refusal_by([&] { parse_choice("--n three", "three", choices); }),
              "--n three: not one of one, two");
    EXPECT_EQ(name_of(2, choices), "two");
}

TEST(OptionText, SplitsAtEverySeparator) {
    EXPECT_THAT(split("a,,b", ','), ElementsAre("a", "", "b"));
    EXPECT_THAT(split("", ','), ElementsAre(""));
}

/// Parses arguments by CLI11 with one option of each kind.
struct Parsed {
    double number = 0;
    std::vector<std::string> list;

    explicit Parsed(std::vector<std::string> words) {
        CLI::App app("test", "test");
        add_number(app, "--number", "N", number, {}, "");
        add_repeatable(app, "--list", "L", "", [this](const std::string&, const std::string& text) {
            list.push_back(text);
        });
        std::reverse(words.begin(), words.end());
        app.parse(words);
    }
};

TEST(OptionValues, MayBeginWithAMinus) {
    EXPECT_EQ(Parsed({"--number", "-5"}).number, -5.0);
    EXPECT_EQ(Parsed({"--number=-5"}).number, -5.0);
}

TEST(OptionValues, AreNeededAndTakenOnce) {
    EXPECT_EQ(refusal_by([] { Parsed({"--number", "--list", "x"}); }), "--number: needs a value");
    EXPECT_EQ(refusal_by([] {
                  Parsed({"--number", "1", "--number", "2"});
              }),
              "--number: given more than once");
    EXPECT_EQ(refusal_by([] { Parsed({"--number", "x"}); }), "--number x: not a number");
}

TEST(OptionValues, OfARepeatedOptionKeepTheirOrder) {
    EXPECT_THAT(Parsed({"--list", "b", "--list", "a", "--number", "1"}).list,
                ElementsAre("b", "a"));
}

TEST(LimitOptions, SetTheLimitsOfTheProcess) {
    const auto given = [](const std::string& name, const std::string& value) {
        CLI::App app;
        add_limit_options(app);
        return refusal_by([&] { app.parse(std::vector<std::string>{value, name}); });
    };
    EXPECT_EQ(given("--max-memory", "1.5G"), "accepted");
    EXPECT_EQ(input_limits().memory, 3ULL << 29);
    EXPECT_EQ(given("--max-memory", "600M"), "accepted");
    EXPECT_EQ(input_limits().memory, 600ULL << 20);
    EXPECT_EQ(given("--max-pixels", "1e6"), "accepted");
    EXPECT_EQ(input_limits().pixels, 1'000'000U);
    EXPECT_EQ(input_limits().memory, 600ULL << 20);
    EXPECT_EQ(given("--max-memory", "600"), "--max-memory 600: not an amount of memory");
    EXPECT_EQ(given("--max-memory", "-1G"), "--max-memory -1G: not between 0 and 1000000");
    EXPECT_EQ(given("--max-memory", "0G"), "--max-memory 0G: less than a byte");
    EXPECT_EQ(given("--max-pixels", "0"), "--max-pixels 0: not between 1 and 1000000000000");
    set_input_limits({});
}

TEST(ViewOption, HasTheDirectionOfTheCamera) {
    const auto expect_near = [](const std::string& text, const glm::vec3& expected) {
        EXPECT_LT(glm::distance(parse_view("--view " + text, text), expected), 1e-6F) << text;
    };
    expect_near("0,0", {0, 0, 1});
    expect_near("90,0", {1, 0, 0});
    expect_near("45,90", {0, 1, 0});
    EXPECT_EQ(parse_view("--view", "90,-90"), glm::vec3(0, -1, 0)) << "right angles are exact";
    for (const char* text : {"30,20", "-120.5,-30", "179,-89", "0,0"})
        EXPECT_EQ(view_text(parse_view("--view", text)), text);
    for (const char* text : {"30", "30,20,1", "30,x", "361,0", "0,91"})
        EXPECT_THROW(parse_view("--view", text), UsageError) << text;
}

}  // namespace
}  // namespace relief::tools
