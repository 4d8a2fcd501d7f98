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

class Resolution : public testing::Test {
  protected:
    /// Notes the time of a picture at full resolution that is not the first one.
    void measure(double milliseconds) {
        resolution_.note_picture(whole, whole, milliseconds, false);
    }
    FrameSettings next(double now, const FrameSettings& last = whole, bool is_idle = true) {
        return resolution_.next_settings(whole, last, is_idle, now);
    }
    void expect(const FrameSettings& settings, int width, int height, int samples) {
        EXPECT_EQ(settings.width, width);
        EXPECT_EQ(settings.height, height);
        EXPECT_EQ(settings.samples, samples);
    }
    AdaptiveResolution& resolution() { return resolution_; }

  private:
    AdaptiveResolution resolution_;
};

TEST_F(Resolution, FastPicturesKeepIt) {
    resolution().note_motion(5.0);
    expect(next(5.0), 1200, 800, 4);
    measure(60.0);
    expect(next(5.0), 1200, 800, 4);
}

TEST_F(Resolution, SlowPicturesAreHalfAsLargeWhileMoving) {
    resolution().note_motion(5.0);
    measure(100.0);  // 56 ms for three quarters.
    expect(next(5.0), 900, 600, 4);
    measure(150.0);  // 38 ms for a half.
    expect(next(5.0), 600, 400, 4);
    measure(400.0);
    expect(next(5.0), 600, 400, 4);
    measure(900.0);  // 94 ms for a half with one sample.
    expect(next(5.0), 600, 400, 1);
    measure(1e6);
    expect(next(5.0), 400, 266, 1);
    const FrameSettings tiny = resolution().next_settings({2, 1, 1}, {2, 1, 1}, true, 5.0);
    EXPECT_EQ(tiny.height, 1);
}

TEST_F(Resolution, FirstPictureOfASceneDoesNotCount) {
    // The driver compiles for it.
    resolution().note_motion(5.0);
    resolution().note_picture(whole, whole, 230.0, true);
    expect(next(5.0), 1200, 800, 4);
    resolution().note_picture(whole, whole, 800.0, true);
    expect(next(5.0), 600, 400, 4);
    measure(40.0);
    expect(next(5.0), 1200, 800, 4);
    resolution().note_picture(whole, whole, 800.0, true);
    expect(next(5.0), 1200, 800, 4);
    FrameSettings half = whole;
    half.width = 600;
    resolution().note_picture(half, whole, 500.0, false);
    expect(next(5.0), 1200, 800, 4);
}

TEST_F(Resolution, FullPictureIsThereAFifthOfASecondAfterMotion) {
    for (const double milliseconds : {70.0, 100.0, 145.0}) {
        measure(milliseconds);
        resolution().note_motion(5.0);
        const double rest = resolution().seconds_until_rest(5.0);
        EXPECT_LE(rest + 1e-3 * milliseconds, AdaptiveResolution::seconds_to_full + 1e-9);
        EXPECT_GE(rest, 0.05) << "steps of a wheel are one motion";
        EXPECT_LT(next(5.0 + 0.9 * rest).width, 1200);
        expect(next(5.0 + 1.01 * rest), 1200, 800, 4);
    }
}

TEST_F(Resolution, ReleaseEndsMotionAtOnce) {
    measure(150.0);
    resolution().note_motion(5.0);
    EXPECT_EQ(next(5.0).width, 600);
    resolution().end_motion();
    EXPECT_EQ(resolution().seconds_until_rest(5.0), 0.0);
    expect(next(5.0), 1200, 800, 4);
}

TEST_F(Resolution, VerySlowPicturesComeFirstWithOneSample) {
    measure(400.0);
    resolution().note_motion(5.0);
    const FrameSettings moving = next(5.0);
    resolution().end_motion();
    const FrameSettings first = next(5.0, moving);
    expect(first, 1200, 800, 1);
    expect(next(5.1, first, false), 1200, 800, 1);
    expect(next(5.2, first, true), 1200, 800, 4);
    expect(next(5.3, whole, true), 1200, 800, 4);
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
