// SPDX-License-Identifier: Apache-2.0
#include "window/window_system.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "support/shared_data.h"

namespace relief::tools {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(UiScaleTest, FollowsTheScreenUnlessItIsSet) {
    EXPECT_EQ(ui_scale_for({}, 1.0F, 1.0F), (UiScale{1.0F, 1.0F}));
    EXPECT_EQ(ui_scale_for({}, 1.5F, 1.0F), (UiScale{1.5F, 1.5F}));
    EXPECT_EQ(ui_scale_for(2.0F, 1.5F, 1.0F), (UiScale{2.0F, 2.0F}));
}

TEST(UiScaleTest, HighDensityScreensScaleOnlyGlyphs) {
    EXPECT_EQ(ui_scale_for({}, 2.0F, 2.0F), (UiScale{1.0F, 2.0F}));
    EXPECT_EQ(ui_scale_for(1.0F, 2.0F, 2.0F), (UiScale{0.5F, 1.0F}));
}

TEST(UiScaleTest, IsLimitedAndIgnoresInvalidValues) {
    EXPECT_EQ(ui_scale_for(100.0F, 1.0F, 1.0F).glyphs, 4.0F);
    EXPECT_EQ(ui_scale_for({}, 0.01F, 1.0F).glyphs, 0.5F);
    EXPECT_EQ(ui_scale_for({}, 0.0F, 0.0F), (UiScale{1.0F, 1.0F}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(ui_scale_for({}, nan, nan), (UiScale{1.0F, 1.0F}));
}

TEST(UiScaleTest, ChangesByStepsWithinItsLimits) {
    EXPECT_EQ(next_ui_scale(1.0F, true), 1.25F);
    EXPECT_EQ(next_ui_scale(1.0F, false), 0.75F);
    EXPECT_EQ(next_ui_scale(1.1F, true), 1.25F) << "a screen's own";
    EXPECT_EQ(next_ui_scale(1.1F, false), 1.0F);
    EXPECT_EQ(next_ui_scale(4.0F, true), 4.0F);
    EXPECT_EQ(next_ui_scale(0.5F, false), 0.5F);
}

/// Sets an environment variable and restores it.
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

TEST_F(Layout, IsReadBack) {
    const WindowLayout layout{.size = glm::ivec2(1000, 700),
                              .position = glm::ivec2(-20, 30),
                              .is_maximized = true,
                              .has_panels = false,
                              .open_panels = {{"Lights", true}, {"Scene", false}},
                              .ui_scale = 1.25F,
                              .has_light_theme = true,
                              .has_seen_hint = true,
                              .has_axes = false,
                              .recent_files = {"/b.glb", "/a.obj"},
                              .recent_images = {"/wood.png"}};
    SavedLayout first(file());
    EXPECT_EQ(first.note(), "");
    EXPECT_EQ(first.layout(), WindowLayout());
    EXPECT_EQ(first.save(layout), "");
    const SavedLayout again(file());
    EXPECT_EQ(again.note(), "");
    EXPECT_EQ(again.layout(), layout);
}

TEST_F(Layout, IsWrittenWithoutNamesThatAreNotUtf8) {
    SavedLayout first(file());
    EXPECT_EQ(first.save({.has_panels = false, .recent_files = {"/\xE4.obj", "/\xC3\xA4.obj"}}),
              "");
    const SavedLayout again(file());
    EXPECT_EQ(again.note(), "");
    EXPECT_FALSE(again.layout().has_panels);
    EXPECT_THAT(again.layout().recent_files, ElementsAre("/\xC3\xA4.obj"));
}

TEST(RecentFiles, AreTheLastTenWithoutRepetition) {
    WindowLayout layout;
    for (int i = 0; i < 12; ++i)
        remember_file(layout, "/models/" + std::to_string(i) + ".obj");
    remember_file(layout, "/models/../models/5.obj");
    ASSERT_EQ(layout.recent_files.size(), 10U);
    EXPECT_EQ(layout.recent_files[0], "/models/5.obj");
    EXPECT_EQ(layout.recent_files[1], "/models/11.obj");
    EXPECT_EQ(layout.recent_files[9], "/models/2.obj");
    EXPECT_EQ(std::count(layout.recent_files.begin(), layout.recent_files.end(), "/models/5.obj"),
              1);
}

TEST(RecentFiles, OfImagesAreAListOfTheirOwn) {
    WindowLayout layout;
    remember_image(layout, "/maps/a.png");
    remember_image(layout, "/maps/b.png");
    EXPECT_THAT(layout.recent_images, ElementsAre("/maps/b.png", "/maps/a.png"));
    EXPECT_TRUE(layout.recent_files.empty());
}

TEST_F(Layout, IsWrittenOnlyIfItChanged) {
    SavedLayout nothing(file());
    EXPECT_EQ(nothing.save({}), "");
    EXPECT_FALSE(std::filesystem::exists(file())) << "as usual: there is nothing to remember";
    // A layout that is unchanged must not be written again.
    const std::string untidy = R"({"version":1,    "panels":{"shown":false}})";
    write(untidy);
    SavedLayout read(file());
    EXPECT_FALSE(read.layout().has_panels);
    EXPECT_EQ(read.save(read.layout()), "");
    EXPECT_EQ(text(), untidy);
    EXPECT_EQ(read.save({}), "");
    EXPECT_NE(text(), untidy);
}

TEST_F(Layout, InvalidFileIsReportedAndReplaced) {
    for (const char* broken :
         {"", "{", "[]", R"({"version": "one"})", R"({"version": 1, "scale": "big"})",
          R"({"version": 1, "window": {"size": [1]}})", R"({"version": 1e300})",
          R"({"version": 1, "window": {"size": [1e300, 1]}})", "{\"version\": 1, \"\xE4\": 1}"}) {
        write(broken);
        SavedLayout read(file());
        EXPECT_EQ(read.layout(), WindowLayout()) << broken;
        EXPECT_THAT(read.note(), HasSubstr("view.json: ")) << broken;
        EXPECT_THAT(read.note(), HasSubstr("the default layout is used")) << broken;
        EXPECT_THAT(read.note(), Not(HasSubstr("json.exception"))) << broken;
        EXPECT_EQ(read.save({.has_panels = false}), "");
        EXPECT_FALSE(SavedLayout(file()).layout().has_panels) << broken;
    }
}

TEST_F(Layout, FileOfANewerVersionIsKept) {
    const std::string later = R"({"version": 2, "window": {"size": [1, 1]}})";
    write(later);
    SavedLayout read(file());
    EXPECT_EQ(read.layout(), WindowLayout());
    EXPECT_THAT(read.note(), HasSubstr("of version 2, and this program supports 1"));
    EXPECT_EQ(read.save({.has_panels = false}), "");
    EXPECT_EQ(text(), later);
}

TEST_F(Layout, WriteErrorIsReported) {
    std::filesystem::create_directories(file().parent_path().parent_path());
    std::ofstream(file().parent_path()) << "a file where the folder should be";
    SavedLayout remembered(file());
    EXPECT_EQ(remembered.layout(), WindowLayout());
    EXPECT_THAT(remembered.save({.has_panels = false}), HasSubstr("the layout is not saved"));
}

TEST_F(Layout, WithoutAFileNothingIsWritten) {
    SavedLayout none;
    EXPECT_EQ(none.save({.has_panels = false}), "");
    EXPECT_EQ(none.note(), "");
}

TEST_F(Layout, SizesAndScalesAreLimited) {
    write(R"({"version": 1, "window": {"size": [-5, 99999999]}, "scale": 77})");
    const SavedLayout read(file());
    EXPECT_EQ(read.layout().size, glm::ivec2(320, 16384));
    EXPECT_EQ(read.layout().ui_scale, 4.0F);
}

TEST(LayoutOnScreen, FitsTheScreen) {
    const ScreenArea screen{{100, 50}, {1000, 600}};
    WindowLayout layout{.size = glm::ivec2(1280, 400), .position = glm::ivec2(900, 3000)};
    EXPECT_EQ(fitted_to_screen(layout, screen).size, glm::ivec2(1000, 400));
    EXPECT_EQ(fitted_to_screen(layout, screen).position, glm::ivec2(100, 250));
    layout = {.size = glm::ivec2(500, 300), .position = glm::ivec2(300, 200)};
    EXPECT_EQ(fitted_to_screen(layout, screen), layout) << "it fits";
    layout.position = glm::ivec2(-500, -500);
    EXPECT_EQ(fitted_to_screen(layout, screen).position, glm::ivec2(100, 50));
    EXPECT_EQ(fitted_to_screen(layout, ScreenArea{}), layout) << "no screen says how large it is";
}

TEST(LayoutFile, FollowsTheXdgSpecification) {
    const Variable home("HOME", "/home/somebody");
    {
        const Variable state("XDG_STATE_HOME", "/elsewhere");
        EXPECT_EQ(default_layout_file(), "/elsewhere/relief/relief-view.json");
    }
    for (const char* unset : {static_cast<const char*>(nullptr), "", "relative"}) {
        const Variable state("XDG_STATE_HOME", unset);
        EXPECT_EQ(default_layout_file(), "/home/somebody/.local/state/relief/relief-view.json");
        const Variable homeless("HOME", nullptr);
        EXPECT_EQ(default_layout_file(), std::nullopt);
    }
}

}  // namespace
}  // namespace relief::tools
