// SPDX-License-Identifier: Apache-2.0
#include "window/window_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "support/shared_data.h"

namespace relief::tools {
namespace {

using testing::HasSubstr;

/// An environment variable that is as it was afterwards.
class Variable {
  public:
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        if (value != nullptr) {
            ::setenv(name, value, 1);
        } else {
            ::unsetenv(name);
        }
    }
    ~Variable() {
        if (old_) {
            ::setenv(name_, old_->c_str(), 1);
        } else {
            ::unsetenv(name_);
        }
    }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

  private:
    const char* name_;
    std::optional<std::string> old_;
};

class Layout : public testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path file() const { return folder_ / "state/relief/view.json"; }

    void write(const std::string& text) const {
        std::filesystem::create_directories(file().parent_path());
        std::ofstream(file()) << text;
    }
    [[nodiscard]] std::string text() const {
        std::ifstream stream(file());
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }

  private:
    test::TemporaryDirectory folder_;
};

TEST_F(Layout, IsReadAsItWasWritten) {
    const WindowLayout layout{.size = glm::ivec2(1000, 700),
                              .position = glm::ivec2(-20, 30),
                              .is_maximized = true,
                              .has_panels = false,
                              .open_panels = {{"Lights", true}, {"Scene", false}},
                              .ui_scale = 1.25F};
    RememberedLayout first(file());
    EXPECT_EQ(first.note(), "");
    EXPECT_EQ(first.layout(), WindowLayout());
    EXPECT_EQ(first.remember(layout), "");
    const RememberedLayout again(file());
    EXPECT_EQ(again.note(), "");
    EXPECT_EQ(again.layout(), layout);
}

TEST_F(Layout, IsWrittenOnlyIfItBecameAnotherOne) {
    RememberedLayout nothing(file());
    EXPECT_EQ(nothing.remember({}), "");
    EXPECT_FALSE(std::filesystem::exists(file())) << "as usual: there is nothing to remember";
    // Read, so that writing it again would tidy it.
    const std::string untidy = R"({"version":1,    "panels":{"shown":false}})";
    write(untidy);
    RememberedLayout read(file());
    EXPECT_FALSE(read.layout().has_panels);
    EXPECT_EQ(read.remember(read.layout()), "");
    EXPECT_EQ(text(), untidy);
    EXPECT_EQ(read.remember({}), "");
    EXPECT_NE(text(), untidy);
}

TEST_F(Layout, ABrokenFileIsSaidAndReplaced) {
    for (const char* broken :
         {"", "{", "[]", R"({"version": "one"})", R"({"version": 1, "scale": "big"})",
          R"({"version": 1, "window": {"size": [1]}})"}) {
        write(broken);
        RememberedLayout read(file());
        EXPECT_EQ(read.layout(), WindowLayout()) << broken;
        EXPECT_THAT(read.note(), HasSubstr("view.json: ")) << broken;
        EXPECT_THAT(read.note(), HasSubstr("the window is as usual")) << broken;
        EXPECT_EQ(read.remember({.has_panels = false}), "");
        EXPECT_FALSE(RememberedLayout(file()).layout().has_panels) << broken;
    }
}

TEST_F(Layout, AFileOfALaterVersionIsLeftAlone) {
    const std::string later = R"({"version": 2, "window": {"size": [1, 1]}})";
    write(later);
    RememberedLayout read(file());
    EXPECT_EQ(read.layout(), WindowLayout());
    EXPECT_THAT(read.note(), HasSubstr("of version 2, later than this program's 1"));
    EXPECT_EQ(read.remember({.has_panels = false}), "");
    EXPECT_EQ(text(), later);
}

TEST_F(Layout, WhatCannotBeWrittenIsSaid) {
    std::filesystem::create_directories(file().parent_path().parent_path());
    std::ofstream(file().parent_path()) << "a file where the folder should be";
    RememberedLayout remembered(file());
    EXPECT_EQ(remembered.layout(), WindowLayout());
    EXPECT_THAT(remembered.remember({.has_panels = false}),
                HasSubstr("the window is not remembered"));
}

TEST_F(Layout, WithoutAFileNothingIsWritten) {
    RememberedLayout none;
    EXPECT_EQ(none.remember({.has_panels = false}), "");
    EXPECT_EQ(none.note(), "");
}

TEST_F(Layout, SizesAndScalesThatCannotBeAreBroughtWithinTheirLimits) {
    write(R"({"version": 1, "window": {"size": [-5, 99999999]}, "scale": 77})");
    const RememberedLayout read(file());
    EXPECT_EQ(read.layout().size, glm::ivec2(320, 16384));
    EXPECT_EQ(read.layout().ui_scale, 4.0F);
}

TEST(LayoutOnScreen, IsNoLargerThanTheScreenAndOnIt) {
    const ScreenArea screen{{100, 50}, {1000, 600}};
    WindowLayout layout{.size = glm::ivec2(1280, 400), .position = glm::ivec2(900, 3000)};
    EXPECT_EQ(within(layout, screen).size, glm::ivec2(1000, 400));
    EXPECT_EQ(within(layout, screen).position, glm::ivec2(100, 250));
    layout = {.size = glm::ivec2(500, 300), .position = glm::ivec2(300, 200)};
    EXPECT_EQ(within(layout, screen), layout) << "it fits";
    layout.position = glm::ivec2(-500, -500);
    EXPECT_EQ(within(layout, screen).position, glm::ivec2(100, 50));
    EXPECT_EQ(within(layout, ScreenArea{}), layout) << "no screen says how large it is";
}

TEST(LayoutFile, StandsWhereXdgPutsState) {
    const Variable home("HOME", "/home/somebody");
    {
        const Variable state("XDG_STATE_HOME", "/elsewhere");
        EXPECT_EQ(usual_layout_file(), "/elsewhere/relief/relief-view.json");
    }
    for (const char* unset : {static_cast<const char*>(nullptr), "", "relative"}) {
        const Variable state("XDG_STATE_HOME", unset);
        EXPECT_EQ(usual_layout_file(), "/home/somebody/.local/state/relief/relief-view.json");
        const Variable homeless("HOME", nullptr);
        EXPECT_EQ(usual_layout_file(), std::nullopt);
    }
}

}  // namespace
}  // namespace relief::tools
