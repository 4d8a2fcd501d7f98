// SPDX-License-Identifier: Apache-2.0
#include "window/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/window/display.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::eventually;
using test::Workplace;
using testing::HasSubstr;

class Comparing : public testing::Test {
  protected:
    Comparing() {
        workplace_.write_square("square.obj");
        workplace_.write("other.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n");
        state_.set_view({400, 300});
        show("square.obj");
    }

    void show(const std::string& model) {
        Loaded loaded;
        loaded.options.model = workplace_ / model;
        loaded.options.height_map = workplace_ / "data/bricks-height.png";
        if (model == "other.obj") loaded.options.height_map.reset();
        Stages silent(true);
        loaded.composed = compose_scene(loaded.options, silent, loaded.findings);
        state_.take(std::move(loaded));
    }

    /// The wish with its other side, once there is one or an error.
    DrawWish settled() {
        EXPECT_TRUE(eventually([&] {
            comparison_.follow(state_);
            return !comparison_.is_working();
        }));
        DrawWish wish = *state_.wish();
        comparison_.add_to(wish);
        return wish;
    }

    [[nodiscard]] const Workplace& workplace() const { return workplace_; }
    ViewerState& state() { return state_; }
    Comparison& comparison() { return comparison_; }

  private:
    Workplace workplace_;
    ViewerState state_{ViewOptions{}};
    Comparison comparison_{CompareChoices{}, [] {}};
};

TEST_F(Comparing, IsNothingUntilItIsChosen) {
    EXPECT_FALSE(comparison().is_on());
    EXPECT_FALSE(settled().beside);
    EXPECT_EQ(comparison().command_line(), "");
    comparison().toggle();
    EXPECT_TRUE(comparison().is_on());
    EXPECT_TRUE(settled().beside) << "something to begin with";
    comparison().toggle();
    EXPECT_FALSE(settled().beside);
}

TEST_F(Comparing, PutsTheChangedSceneBesideFromTheSameEye) {
    comparison().choose(Variant(Kernel::central5));
    const DrawWish wish = settled();
    ASSERT_TRUE(wish.beside);
    EXPECT_EQ(wish.beside->camera.world_from_view, wish.camera.world_from_view);
    EXPECT_NE(wish.beside->scene, wish.scene);
    EXPECT_EQ(comparison().command_line(), " --compare kernel=central5 --split 0.5");
    EXPECT_EQ(comparison().left_label(), "as it is");
    EXPECT_EQ(comparison().right_label(), "kernel=central5");
    comparison().swap();
    EXPECT_EQ(comparison().left_label(), "kernel=central5");
}

TEST_F(Comparing, EditsOfLightsComeAlongWithoutWorkingItOutAgain) {
    comparison().choose(Variant(Kernel::central5));
    const DrawWish before = settled();
    state().edit([](Scene& scene) { scene.exposure = 4.0F; });
    comparison().follow(state());
    EXPECT_FALSE(comparison().is_working());
    DrawWish after = *state().wish();
    comparison().add_to(after);
    ASSERT_TRUE(after.beside);
    EXPECT_EQ(after.beside->scene->exposure, 4.0F);
    EXPECT_GT(after.beside->revision, before.beside->revision);
    const auto image_of = [](const DrawWish& wish) {
        return &*std::get<Shared<Image>>(wish.beside->scene->images.back().source);
    };
    EXPECT_EQ(image_of(after), image_of(before)) << "the map is shared";
}

TEST_F(Comparing, AnotherModelIsWorkedOutAnewAndSaysWhatItLacks) {
    comparison().choose(Variant(Kernel::central5));
    EXPECT_TRUE(settled().beside);
    show("other.obj");
    EXPECT_FALSE(settled().beside);
    EXPECT_THAT(comparison().error(), HasSubstr("no heights"));
    comparison().choose(Variant(Interpolation::flat));
    EXPECT_EQ(comparison().error(), "");
    EXPECT_TRUE(settled().beside);
}

TEST_F(Comparing, AFileIsSeenFromTheSameEyeWithADepthRangeOfItsOwn) {
    comparison().choose(std::filesystem::path("none.obj"));
    EXPECT_FALSE(settled().beside);
    EXPECT_THAT(comparison().error(), HasSubstr("none.obj"));
    show("other.obj");
    comparison().choose(workplace() / "square.obj");
    const DrawWish wish = settled();
    ASSERT_TRUE(wish.beside) << comparison().error();
    EXPECT_EQ(wish.beside->camera.world_from_view, wish.camera.world_from_view);
    EXPECT_NE(wish.beside->camera.far, wish.camera.far);
    EXPECT_EQ(wish.beside->scene->directional_lights.size(), wish.scene->directional_lights.size());
    EXPECT_EQ(comparison().right_label(), "square.obj");
}

TEST_F(Comparing, NumbersAreBegunWhenTheViewRests) {
    comparison().choose(Variant(Kernel::central5));
    settled();
    comparison().show(SidesShown::flip);
    DrawWish wish = *state().wish();
    EXPECT_TRUE(comparison().add_to(wish)) << "the same view as before";
    EXPECT_FALSE(comparison().add_to(wish)) << "once";
    EXPECT_TRUE(comparison().is_working());
    EXPECT_FALSE(wish.instead);
    EXPECT_EQ(comparison().json()["numbers"], nullptr);
}

}  // namespace
}  // namespace relief::tools
