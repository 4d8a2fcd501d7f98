// SPDX-License-Identifier: Apache-2.0
/// \file
/// The thread that draws: it takes the newest wish, however many came meanwhile, and leaves
/// finished pictures for the window, which never waits for one. A scene that cannot be drawn leaves
/// the picture as it was, with an error. Tests: tests/tools/window/draw_thread_test.cpp.
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

#include "relief/mesh/progress.h"
#include "relief/mesh/report.h"
#include "relief/shade/effect_forcing.h"
#include "relief/shade/handover.h"
#include "relief/shade/renderer.h"
#include "window/capture.h"

namespace relief::tools {

/// What is drawn beside it at the same time, with the same effects and settings.
struct BesideWish {
    std::shared_ptr<const Scene> scene;
    std::uint64_t revision = 0;
    Camera camera;
};

/// What is to be drawn.
struct DrawWish {
    std::shared_ptr<const Scene> scene;
    std::uint64_t revision = 0;  ///< Another one where anything but the camera is different.
    EffectWishes effects;
    FrameSettings settings;
    Camera camera;
    std::optional<BesideWish> beside = std::nullopt;
    std::shared_ptr<const Image> instead = nullptr;  ///< A finished picture; nothing is drawn.
};

/// The plan of a scene with the effects that were forced.
FramePlan forced_plan(const Scene& scene, const FrameSettings& settings,
                      const EffectWishes& effects);

/// What was drawn last, or why it could not be.
struct DrawnPicture {
    std::uint64_t revision = 0;
    std::uint64_t beside = 0;     ///< The revision of what is beside it; 0: nothing is.
    bool is_difference = false;   ///< DrawWish::instead.
    std::uint64_t frames = 0;     ///< Drawn so far, all in all.
    std::uint64_t renderers = 0;  ///< Made so far.
    FrameTimes times;
    std::shared_ptr<const FramePlan> plan;
    Report findings;
    std::string error;  ///< Empty: none.
    FrameSettings settings;
    Camera camera;
    /// What the last renderer read, or would have: images and shaders. Another value each time.
    std::shared_ptr<const std::map<std::filesystem::path, FileStamp>> files;
};

/// A context for the thread: made current there, and given back.
struct DrawContext {
    std::function<void()> use;
    std::function<void()> release;
    GlLoader loader = nullptr;
    std::function<void()> wake;  ///< Called when there is something new.
};

class DrawThread {
  public:
    /// Waits until the thread's context is ready. \throws GpuError if it is of no use
    explicit DrawThread(DrawContext context);
    /// What is being prepared or done ends.
    ~DrawThread();
    DrawThread(const DrawThread&) = delete;
    DrawThread& operator=(const DrawThread&) = delete;

    void wish(DrawWish wish);

    /// Shader files were edited: programs are linked anew for the picture that is wished next.
    void relink();

    /// Done a step at a time, where no picture is wished; wakes after the last one. What is left at
    /// the end is not done.
    void add(DrawTask task);

    [[nodiscard]] DrawnPicture drawn();
    [[nodiscard]] Handover::Shown shown();
    /// Whether a wish is waiting or being drawn.
    [[nodiscard]] bool is_busy();
    /// How far a renderer is prepared; no stage: none is.
    [[nodiscard]] Progress::State progress();
    [[nodiscard]] const std::string& renderer_name() const { return renderer_name_; }

  private:
    class Drawer;

    void run();
    void do_step(Drawer& drawer, std::unique_lock<std::mutex>& lock);
    std::optional<DrawWish> next(Drawer& drawer);
    std::shared_ptr<Progress> progress_of_now();

    DrawContext context_;
    std::string renderer_name_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<DrawWish> wish_;
    std::deque<DrawTask> tasks_;
    bool is_drawing_ = false;
    bool is_relinking_ = false;
    bool is_ending_ = false;
    bool is_ready_ = false;
    std::shared_ptr<Progress> progress_ = std::make_shared<Progress>();  ///< Of what goes on.
    std::exception_ptr failure_;
    DrawnPicture drawn_;
    Handover* handover_ = nullptr;
    std::thread thread_;
};

}  // namespace relief::tools
