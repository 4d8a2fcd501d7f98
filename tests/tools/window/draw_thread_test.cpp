// SPDX-License-Identifier: Apache-2.0
// The drawing thread in a context of its own, without a window.
#include "window/draw_thread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "gl/platform_context.h"
#include "relief/mesh/error.h"
#include "support/gl_environment.h"
#include "support/shapes.h"
#include "tools/window/display.h"

namespace relief::tools {
namespace {

using test::eventually;
using testing::HasSubstr;

/// OSMesa's functions, for who must have a plain pointer to their loader.
gl::Api::Loader loader_of_thread = nullptr;

class Drawing : public testing::Test {
  protected:
    void SetUp() override {
        if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
        loader_of_thread = gl::make_osmesa_context()->loader();
    }

    DrawContext context() {
        return {[this] { platform_ = gl::make_osmesa_context(); }, [this] { platform_.reset(); },
                loader_of_thread, [this] { ++woken_; }};
    }
    [[nodiscard]] int woken() const { return woken_; }

    static DrawWish wish_of(std::uint64_t revision, float distance = 3.0F) {
        auto scene = std::make_shared<Scene>();
        scene->meshes.push_back(test::cube());
        scene->instances.push_back({});
        DrawWish wish;
        wish.scene = scene;
        wish.revision = revision;
        wish.settings = {32, 24, 1};
        wish.camera.world_from_view[3] = {0, 0, distance, 1};
        return wish;
    }

    /// Waits until nothing is to be drawn.
    static DrawnPicture rest(DrawThread& thread) {
        EXPECT_TRUE(eventually([&] { return !thread.is_busy(); }));
        return thread.drawn();
    }

  private:
    std::unique_ptr<gl::PlatformContext> platform_;
    std::atomic<int> woken_ = 0;
};

TEST_F(Drawing, DrawsWhatIsWishedAndWakes) {
    DrawThread thread(context());
    EXPECT_NE(thread.renderer_name(), "");
    EXPECT_EQ(thread.shown().texture, 0U);
    thread.wish(wish_of(7));
    const DrawnPicture drawn = rest(thread);
    EXPECT_EQ(drawn.error, "");
    EXPECT_EQ(drawn.revision, 7U);
    EXPECT_EQ(drawn.frames, 1U);
    EXPECT_NE(thread.shown().texture, 0U);
    EXPECT_EQ(thread.shown().width, 32);
    EXPECT_TRUE(eventually([&] { return woken() == 1; }));
}

TEST_F(Drawing, AnotherCameraMakesNoRenderer) {
    DrawThread thread(context());
    thread.wish(wish_of(1));
    rest(thread);
    thread.wish(wish_of(1, 4.0F));
    DrawnPicture drawn = rest(thread);
    EXPECT_EQ(drawn.frames, 2U);
    EXPECT_EQ(drawn.renderers, 1U);
    thread.wish(wish_of(2, 4.0F));
    drawn = rest(thread);
    EXPECT_EQ(drawn.renderers, 2U);
}

TEST_F(Drawing, OfManyWishesTheLastIsDrawnAndTheOthersCostNothing) {
    DrawThread thread(context());
    for (std::uint64_t i = 1; i <= 200; ++i)
        thread.wish(wish_of(i));
    const DrawnPicture drawn = rest(thread);
    EXPECT_EQ(drawn.revision, 200U);
    EXPECT_LT(drawn.frames, 200U);
}

TEST_F(Drawing, WhatCannotBeDrawnLeavesThePictureAndSaysWhy) {
    DrawThread thread(context());
    thread.wish(wish_of(1));
    rest(thread);
    const unsigned shown = thread.shown().texture;
    DrawWish impossible = wish_of(2);
    impossible.effects.forced.push_back({"no such effect", true});
    thread.wish(impossible);
    DrawnPicture drawn = rest(thread);
    EXPECT_THAT(drawn.error, HasSubstr("no such effect"));
    EXPECT_EQ(drawn.revision, 1U);
    EXPECT_EQ(thread.shown().texture, shown);
    thread.wish(wish_of(3));
    drawn = rest(thread);
    EXPECT_EQ(drawn.error, "");
    EXPECT_EQ(drawn.revision, 3U);
}

TEST_F(Drawing, WhatCannotBeDrawnIsTriedOnceAndTheOldSceneCanBeLookedAt) {
    DrawThread thread(context());
    thread.wish(wish_of(1));
    rest(thread);
    DrawWish impossible = wish_of(2);
    impossible.effects.forced.push_back({"no such effect", true});
    thread.wish(impossible);
    const std::uint64_t frames = rest(thread).frames;
    impossible.camera.world_from_view[3].z = 5.0F;
    thread.wish(impossible);
    const DrawnPicture drawn = rest(thread);
    EXPECT_EQ(drawn.frames, frames + 1);
    EXPECT_EQ(drawn.revision, 1U);
    EXPECT_EQ(drawn.camera.world_from_view[3].z, 5.0F);
    EXPECT_THAT(drawn.error, HasSubstr("no such effect"));
}

TEST_F(Drawing, AContextOfNoUseIsSaidAtOnce) {
    DrawContext none = context();
    none.loader = [](const char*) -> void (*)() { return nullptr; };
    EXPECT_THROW(DrawThread{none}, relief::Error);
}

}  // namespace
}  // namespace relief::tools
