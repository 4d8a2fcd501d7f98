// SPDX-License-Identifier: Apache-2.0
/// \file
/// The drawing thread: it draws the newest request and hands finished pictures to the window, which
/// never waits. If a scene cannot be drawn, the old picture stays, with an error message. During
/// motion, slow pictures are drawn at a lower resolution.
/// Tests: tests/tools/window/draw_thread_test.cpp.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/renderer.h"

namespace relief::tools {

/// Reduces the resolution during motion if pictures are slow.
class AdaptiveResolution {
  public:
    /// Slower pictures make interaction lag.
    static constexpr double max_milliseconds = 60.0;
    /// Motion ends after this time without a change.
    static constexpr double idle_seconds = 0.15;

    /// Reports the time of a picture at full resolution.
    void set_full_time(double milliseconds) { milliseconds_ = milliseconds; }

    /// Reports motion at this time, in seconds.
    void note_motion(double now) { last_move_ = now; }

    /// The settings for drawing. During motion, slow pictures get one sample per pixel and, if that
    /// is not enough, a half to a quarter of the width and height, so that a picture takes about
    /// max_milliseconds.
    [[nodiscard]] FrameSettings settings_for(FrameSettings full, double now) const;

  private:
    double milliseconds_ = 0.0;
    double last_move_ = -1e9;
};

/// Work for the drawing thread, in its OpenGL context. Each call does one step and returns whether
/// there is more to do. The thread also destroys the function, with the GPU objects that it owns.
using DrawTask = std::function<bool(const Context& context, RenderCache& cache)>;

/// A second scene to draw at the same time, with the same effects and settings.
struct BesideRequest {
    std::shared_ptr<const Scene> scene;
    std::uint64_t revision = 0;
    Camera camera;
};

/// A request for one picture.
struct DrawRequest {
    std::shared_ptr<const Scene> scene;
    std::uint64_t revision = 0;  ///< Changes with everything except the camera.
    EffectRequest effects;
    FrameSettings settings;
    Camera camera;
    std::optional<BesideRequest> beside = std::nullopt;
    /// A finished picture to show instead of the scene.
    std::shared_ptr<const Image> instead = nullptr;
};

/// The plan of a scene with forced effects.
FramePlan forced_plan(const Scene& scene, const FrameSettings& settings,
                      const EffectRequest& effects);

/// The last picture, or the reason why it could not be drawn.
struct RenderedPicture {
    std::uint64_t revision = 0;
    std::uint64_t beside = 0;     ///< The revision of the second scene; 0 if there is none.
    bool is_difference = false;   ///< DrawRequest::instead was shown.
    std::uint64_t frames = 0;     ///< Total number of frames.
    std::uint64_t renderers = 0;  ///< Total number of renderers.
    FrameTimes times;
    std::shared_ptr<const FramePlan> plan;
    Report findings;
    std::string error;  ///< Empty if there was no error.
    FrameSettings settings;
    Camera camera;
    /// The images and shaders that the last renderer read or tried to read. A new object after each
    /// preparation.
    std::shared_ptr<const std::map<std::filesystem::path, FileStamp>> files;
};

/// The OpenGL context of the thread.
struct DrawContext {
    std::function<void()> use;
    std::function<void()> release;
    GlLoader loader = nullptr;
    std::function<void()> wake;  ///< Called when there is news.
};

/// Owns an OpenGL context, a renderer and a render cache on another thread.
class DrawThread {
  public:
    /// Waits until the thread's context is ready.
    /// \throws GpuError if the context cannot be used
    explicit DrawThread(DrawContext context);
    /// Cancels preparations and tasks.
    ~DrawThread();
    DrawThread(const DrawThread&) = delete;
    DrawThread& operator=(const DrawThread&) = delete;

    void request(DrawRequest request);

    /// Links all programs again for the next picture, because shader files have changed.
    void relink();

    /// Runs a task step by step while no picture is requested, and wakes the window after the last
    /// step. Unfinished tasks are dropped at the end.
    void add(DrawTask task);

    [[nodiscard]] RenderedPicture drawn();
    [[nodiscard]] PictureExchange::Shown shown();
    /// Returns whether a request is waiting or being drawn.
    [[nodiscard]] bool is_busy();
    /// Progress of preparing a renderer. Without a preparation, the stage is empty.
    [[nodiscard]] Progress::State progress();
    [[nodiscard]] const std::string& renderer_name() const { return renderer_name_; }

  private:
    class Drawer;

    void run();
    void do_step(Drawer& drawer, std::unique_lock<std::mutex>& lock);
    std::optional<DrawRequest> next(Drawer& drawer);
    std::shared_ptr<Progress> progress_of_now();

    DrawContext context_;
    std::string renderer_name_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<DrawRequest> request_;
    std::deque<DrawTask> tasks_;
    bool is_drawing_ = false;
    bool is_relinking_ = false;
    bool is_ending_ = false;
    bool is_ready_ = false;
    /// Progress of the current work.
    std::shared_ptr<Progress> progress_ = std::make_shared<Progress>();
    std::exception_ptr failure_;
    RenderedPicture drawn_;
    PictureExchange* handover_ = nullptr;
    std::thread thread_;
};

}  // namespace relief::tools
