// SPDX-License-Identifier: Apache-2.0
// The drawing thread with its own context, without a window.
#include "window/background_jobs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "gl/api.h"
#include "relief/mesh/report.h"
#include "support/gl_environment.h"
#include "support/shapes.h"
#include "tools/window/display.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::eventually;
using testing::HasSubstr;

const FrameSettings whole{1200, 800, 4};

TEST(AdaptiveResolution, FastPicturesKeepTheirResolution) {
    AdaptiveResolution resolution;
    resolution.note_motion(5.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 1200) << "nothing is known yet";
    resolution.set_full_time(60.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 1200);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).samples, 4);
}

TEST(AdaptiveResolution, SlowPicturesReduceSamplesThenPixels) {
    AdaptiveResolution resolution;
    resolution.note_motion(5.0);
    resolution.set_full_time(100.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).samples, 1);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 1200);
    // This is 167 ms with one sample, and a quarter of that is below 60 ms.
    resolution.set_full_time(400.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 600);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).height, 400);
    resolution.set_full_time(1e6);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 300) << "never coarser than that";
    EXPECT_EQ(resolution.settings_for({2, 1, 1}, 5.0).height, 1);
}

TEST(AdaptiveResolution, FullResolutionReturnsAfterMotion) {
    AdaptiveResolution resolution;
    resolution.set_full_time(400.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 1200) << "nothing has moved yet";
    resolution.note_motion(5.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.1).width, 600);
    EXPECT_EQ(resolution.settings_for(whole, 5.2).width, 1200);
}

/// The loader must be a plain function pointer.
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

    static DrawRequest request_of(std::uint64_t revision, float distance = 3.0F) {
        auto scene = std::make_shared<Scene>();
        scene->meshes.push_back(test::cube());
        scene->instances.push_back({});
        DrawRequest request;
        request.scene = scene;
        request.revision = revision;
        request.settings = {32, 24, 1};
        request.camera.world_from_view[3] = {0, 0, distance, 1};
        return request;
    }

    /// Waits until the thread is idle.
    static RenderedPicture rest(DrawThread& thread) {
        EXPECT_TRUE(eventually([&] { return !thread.is_busy(); }));
        return thread.drawn();
    }

  private:
    std::unique_ptr<gl::PlatformContext> platform_;
    std::atomic<int> woken_ = 0;
};

TEST_F(Drawing, DrawsTheRequestAndWakes) {
    DrawThread thread(context());
    EXPECT_NE(thread.renderer_name(), "");
    EXPECT_EQ(thread.shown().texture, 0U);
    thread.request(request_of(7));
    const RenderedPicture drawn = rest(thread);
    EXPECT_EQ(drawn.error, "");
    EXPECT_EQ(drawn.revision, 7U);
    EXPECT_EQ(drawn.frames, 1U);
    EXPECT_NE(thread.shown().texture, 0U);
    EXPECT_EQ(thread.shown().width, 32);
    EXPECT_TRUE(eventually([&] { return woken() == 1; }));
}

TEST_F(Drawing, AnotherCameraNeedsNoRenderer) {
    DrawThread thread(context());
    thread.request(request_of(1));
    rest(thread);
    thread.request(request_of(1, 4.0F));
    RenderedPicture drawn = rest(thread);
    EXPECT_EQ(drawn.frames, 2U);
    EXPECT_EQ(drawn.renderers, 1U);
    thread.request(request_of(2, 4.0F));
    drawn = rest(thread);
    EXPECT_EQ(drawn.renderers, 2U);
}

TEST_F(Drawing, AnotherPoseNeedsNoRenderer) {
    DrawThread thread(context());
    thread.request(request_of(1));
    rest(thread);
    DrawRequest moved = request_of(1);
    auto scene = std::make_shared<Scene>(*moved.scene);
    scene->instances[0].world_from_object[3] = {100.0F, 0.0F, 0.0F, 1.0F};
    moved.scene = scene;
    moved.pose = 1;
    thread.request(moved);
    const RenderedPicture drawn = rest(thread);
    EXPECT_EQ(drawn.error, "");
    EXPECT_EQ(drawn.frames, 2U);
    EXPECT_EQ(drawn.renderers, 1U);
    scene = std::make_shared<Scene>(*scene);
    scene->instances.push_back({});
    moved.scene = scene;
    moved.pose = 2;
    thread.request(moved);
    EXPECT_THAT(rest(thread).error, HasSubstr("same numbers of instances"))
        << "the scene is the one that was moved";
}

TEST_F(Drawing, OnlyTheLastOfManyRequestsMustBeDrawn) {
    DrawThread thread(context());
    for (std::uint64_t i = 1; i <= 200; ++i)
        thread.request(request_of(i));
    const RenderedPicture drawn = rest(thread);
    EXPECT_EQ(drawn.revision, 200U);
    EXPECT_LT(drawn.frames, 200U);
}

TEST_F(Drawing, DrawingErrorKeepsThePicture) {
    DrawThread thread(context());
    thread.request(request_of(1));
    rest(thread);
    const unsigned shown = thread.shown().texture;
    DrawRequest impossible = request_of(2);
    impossible.effects.forced.push_back({"no such effect", true});
    thread.request(impossible);
    RenderedPicture drawn = rest(thread);
    EXPECT_THAT(drawn.error, HasSubstr("no such effect"));
    EXPECT_EQ(drawn.revision, 1U);
    EXPECT_EQ(thread.shown().texture, shown);
    thread.request(request_of(3));
    drawn = rest(thread);
    EXPECT_EQ(drawn.error, "");
    EXPECT_EQ(drawn.revision, 3U);
}

TEST_F(Drawing, DrawingErrorIsTriedOnceAndTheOldSceneFollowsTheCamera) {
    DrawThread thread(context());
    thread.request(request_of(1));
    rest(thread);
    DrawRequest impossible = request_of(2);
    impossible.effects.forced.push_back({"no such effect", true});
    thread.request(impossible);
    const std::uint64_t frames = rest(thread).frames;
    impossible.camera.world_from_view[3].z = 5.0F;
    thread.request(impossible);
    const RenderedPicture drawn = rest(thread);
    EXPECT_EQ(drawn.frames, frames + 1);
    EXPECT_EQ(drawn.revision, 1U);
    EXPECT_EQ(drawn.camera.world_from_view[3].z, 5.0F);
    EXPECT_THAT(drawn.error, HasSubstr("no such effect"));
}

TEST_F(Drawing, UnusableContextThrows) {
    DrawContext none = context();
    none.loader = [](const char*) -> void (*)() { return nullptr; };
    EXPECT_THROW(DrawThread{none}, relief::Error);
}

}  // namespace
}  // namespace relief::tools
