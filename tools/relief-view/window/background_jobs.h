// SPDX-License-Identifier: Apache-2.0
/// \file
/// Work of the window on other threads: reading scenes, searching for mesh problems, drawing, and
/// measuring the times of effects.
/// Tests: tests/tools/window/background_jobs_test.cpp, draw_thread_test.cpp,
/// effects_panel_test.cpp.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/effect_costs.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

// Reading and checking: only the newest result counts.

/// Runs work on another thread. Only the work that was started last has a result; starting new work
/// cancels the previous work without waiting for it.
template <typename Result>
class NewestJob {
  public:
    /// Runs inside a ProgressScope of its argument. It may throw only Cancelled; other errors are
    /// part of the result.
    using Work = std::function<Result(const Progress& progress)>;

    /// \param wake  called from another thread when there is a result
    explicit NewestJob(std::function<void()> wake) : wake_(std::move(wake)) {}

    /// Cancels the work and waits for its end.
    ~NewestJob() {
        for (Job& job : jobs_)
            job.progress.cancel();
        for (Job& job : jobs_)
            job.thread.join();
    }
    NewestJob(const NewestJob&) = delete;
    NewestJob& operator=(const NewestJob&) = delete;

    void start(Work work) {
        join_ended();
        const std::lock_guard lock(mutex_);
        discard();
        since_begun_ = {};
        newest_ = &jobs_.emplace_back();
        newest_->thread =
            std::thread([this, job = newest_, task = std::move(work)] { run(*job, task); });
    }

    void cancel() {
        const std::lock_guard lock(mutex_);
        discard();
    }

    /// The result of the last start(), if it is ready. Each result is returned once.
    std::optional<Result> take() {
        const std::lock_guard lock(mutex_);
        if (result_) newest_ = nullptr;
        return std::exchange(result_, std::nullopt);
    }

    /// True from start() until take() returns the result, or cancel().
    [[nodiscard]] bool is_running() const {
        const std::lock_guard lock(mutex_);
        return newest_ != nullptr;
    }
    [[nodiscard]] double seconds_so_far() const {
        const std::lock_guard lock(mutex_);
        return newest_ ? since_begun_.seconds() : 0.0;
    }
    [[nodiscard]] Progress::State progress() const {
        const std::lock_guard lock(mutex_);
        return newest_ ? newest_->progress.state() : Progress::State{};
    }

  private:
    struct Job {
        Progress progress;
        std::thread thread;
        bool has_ended = false;
    };

    void discard() {
        if (newest_) newest_->progress.cancel();
        newest_ = nullptr;
        result_.reset();
    }

    void run(Job& job, const Work& work) {
        std::optional<Result> result;
        try {
            const ProgressScope scope(job.progress);
            result.emplace(work(job.progress));
        } catch (const Cancelled&) {
            result.reset();
        }
        {
            const std::lock_guard lock(mutex_);
            job.has_ended = true;
            if (newest_ != &job || job.progress.is_cancelled()) return;
            result_ = std::move(result);
        }
        wake_();
    }

    void join_ended() {
        std::list<Job> ended;
        {
            const std::lock_guard lock(mutex_);
            for (auto job = jobs_.begin(); job != jobs_.end();) {
                const auto next = std::next(job);
                if (job->has_ended && &*job != newest_) ended.splice(ended.end(), jobs_, job);
                job = next;
            }
        }
        for (Job& job : ended)
            job.thread.join();
    }

    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::list<Job> jobs_;    ///< Running, or not joined yet.
    Job* newest_ = nullptr;  ///< Null if no result is wanted.
    Stopwatch since_begun_;
    std::optional<Result> result_;
};

/// The result of reading a file: a scene or an error.
struct Loaded {
    ViewOptions options;
    std::optional<ComposedScene> composed;
    Report findings;
    std::string error;
    /// If the error is a map of the wrong kind: the kind that the options may assume.
    std::optional<MapKind> refused = std::nullopt;
    std::map<std::filesystem::path, FileStamp> files;  ///< Files that were read or not found.
    double seconds = 0.0;
};

/// Reads and composes scenes.
class Loader {
  public:
    /// \param wake  called from another thread when there is a result
    explicit Loader(std::function<void()> wake) : job_(std::move(wake)) {}

    /// Reads the model of these options. An earlier call is cancelled.
    void start(const ViewOptions& options);

    /// Cancels reading.
    void cancel() { job_.cancel(); }

    /// The result of the last start(), if it is ready. Each result is returned once.
    std::optional<Loaded> take() { return job_.take(); }

    /// True from start() until take() returns the result, or cancel().
    [[nodiscard]] bool is_loading() const { return job_.is_running(); }
    [[nodiscard]] double seconds_so_far() const { return job_.seconds_so_far(); }
    [[nodiscard]] Progress::State progress() const { return job_.progress(); }

  private:
    NewestJob<Loaded> job_;
};

/// A scene to check.
struct HealthRequest {
    std::shared_ptr<const shade::Scene> scene;
    std::optional<HealthChoice> choice;  ///< If absent, the search is cancelled.
};

/// The marked problems, or an error.
struct HealthResult {
    shade::HealthMarkers markers;
    std::string error;
};

/// Searches for mesh problems, which takes seconds for millions of triangles.
class HealthSearch {
  public:
    /// \param wake  called from another thread when there is a result
    explicit HealthSearch(std::function<void()> wake) : job_(std::move(wake)) {}

    void start(HealthRequest request);
    std::optional<HealthResult> take() { return job_.take(); }
    [[nodiscard]] bool is_running() const { return job_.is_running(); }

  private:
    NewestJob<HealthResult> job_;
};

// The drawing thread draws the newest request and hands finished pictures to the window, which
// never waits. If a scene cannot be drawn, the old picture stays, with an error message. During
// motion, slow pictures are drawn at a lower resolution.

/// Small pictures of the images of a scene, in one picture of square cells.
class Thumbnails {
  public:
    static constexpr int cell = 96;                ///< Pixels.
    static constexpr int columns = 16;             ///< Cells in a row, the first row on top.
    static constexpr std::size_t max_count = 512;  ///< Further images have no thumbnail.

    /// \param wake  called from another thread when there is a result
    explicit Thumbnails(std::function<void()> wake) : job_(std::move(wake)) {}

    /// Notes that a panel shows the images.
    void want() { is_wanted_ = true; }

    /// Starts decoding if the images are wanted and differ from those of the last start.
    void update(const shade::Scene& scene);

    /// The picture of the last start, if it is ready: sRGB of 8 bits. Each is returned once. The
    /// cell of an image that cannot be decoded is transparent.
    std::optional<Image> take();

    [[nodiscard]] bool is_running() const { return job_.is_running(); }

    /// The place of an image in the picture.
    struct Place {
        glm::ivec2 min{0};  ///< The upper left corner in pixels.
        glm::ivec2 size{0};
        glm::ivec2 image_size{0};
    };
    /// Returns nothing if there is no picture yet, or the image cannot be decoded.
    [[nodiscard]] std::optional<Place> place_of(std::size_t image) const;

    struct Result {
        Image picture;
        std::vector<Place> places;  ///< Without a size for images that cannot be decoded.
    };
    /// Makes the picture of some images, at most max_count.
    static Result reduced(const std::vector<shade::ImageSource>& images);

  private:
    NewestJob<Result> job_;
    bool is_wanted_ = false;
    std::vector<std::pair<std::string, FileStamp>> started_;  ///< Names of images, and their files.
    std::vector<Place> places_;
};

/// Reduces the resolution during motion if pictures are slow, and restores it soon after.
class AdaptiveResolution {
  public:
    /// Slower pictures make interaction lag.
    static constexpr double max_milliseconds = 60.0;
    /// A picture at half the width and height may take this long before it gets coarser.
    static constexpr double max_coarse_milliseconds = 100.0;
    /// The picture at full resolution is to be there this long after motion.
    static constexpr double seconds_to_full = 0.2;

    /// Reports the time of a picture.
    /// \param full  the settings of the picture at full resolution
    /// \param is_first  it is the first one of its scene. The driver may have compiled for it,
    /// which
    ///         later pictures do without.
    void note_picture(const shade::FrameSettings& drawn, const shade::FrameSettings& full,
                      double milliseconds, bool is_first);

    /// Reports motion at this time, in seconds.
    void note_motion(double now) { last_move_ = now; }
    /// Motion has ended, because the user has released what moved.
    void end_motion() { last_move_ = -1e9; }
    /// The time from now until motion without a change counts as ended; 0 if it has ended.
    [[nodiscard]] double seconds_until_rest(double now) const;

    /// The settings for the next picture. During motion, slow pictures get three quarters or half
    /// of the width and height, so that a picture takes about max_milliseconds; then one sample per
    /// pixel; then a third of the size. After it, a picture that is too slow for seconds_to_full
    /// comes in two steps, at first with one sample per pixel.
    /// \param last  the settings of the last picture that was requested
    /// \param is_idle  that picture has been drawn
    [[nodiscard]] shade::FrameSettings next_settings(const shade::FrameSettings& full,
                                                     const shade::FrameSettings& last, bool is_idle,
                                                     double now) const;

  private:
    [[nodiscard]] double idle_seconds() const;
    [[nodiscard]] shade::FrameSettings moving_settings(shade::FrameSettings full) const;

    double milliseconds_ = 0.0;  ///< Of a picture at full resolution; 0: not known.
    bool is_measured_ = false;   ///< Otherwise it is estimated.
    double last_move_ = -1e9;
};

/// Work for the drawing thread, in its OpenGL context. Each call does one step and returns whether
/// there is more to do. The thread also destroys the function, with the GPU objects that it owns.
using DrawTask = std::function<bool(const shade::Context& context, shade::RenderCache& cache)>;

/// A second scene to draw at the same time, with the same effects and settings.
struct BesideRequest {
    std::shared_ptr<const shade::Scene> scene;
    std::uint64_t revision = 0;
    shade::Camera camera;
};

/// A request for one picture.
struct DrawRequest {
    std::shared_ptr<const shade::Scene> scene;
    std::uint64_t revision = 0;  ///< Changes with everything except the camera and the pose.
    std::uint64_t pose = 0;      ///< Changes if only instances and lights have moved.
    shade::EffectRequest effects;
    shade::FrameSettings settings;
    shade::Camera camera;
    std::optional<BesideRequest> beside = std::nullopt;
    /// A finished picture to show instead of the scene.
    std::shared_ptr<const Image> instead = nullptr;
};

/// The plan of a scene with forced effects.
shade::FramePlan forced_plan(const shade::Scene& scene, const shade::FrameSettings& settings,
                             const shade::EffectRequest& effects);

/// The last picture, or the reason why it could not be drawn.
struct RenderedPicture {
    std::uint64_t revision = 0;
    std::uint64_t beside = 0;     ///< The revision of the second scene; 0 if there is none.
    bool is_difference = false;   ///< DrawRequest::instead was shown.
    std::uint64_t frames = 0;     ///< Total number of frames.
    std::uint64_t renderers = 0;  ///< Total number of renderers.
    shade::FrameTimes times;
    std::shared_ptr<const shade::FramePlan> plan;
    Report findings;
    std::string error;          ///< Empty if there was no error.
    bool is_cancelled = false;  ///< The preparation of the picture was cancelled.
    shade::FrameSettings settings;
    shade::Camera camera;
    /// The images and shaders that the last renderer read or tried to read. A new object after each
    /// preparation.
    std::shared_ptr<const std::map<std::filesystem::path, FileStamp>> files;
};

/// The OpenGL context of the thread.
struct DrawContext {
    std::function<void()> use;
    std::function<void()> release;
    shade::GlLoader loader = nullptr;
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

    /// Cancels the preparation of a picture. The old picture stays; the scene is prepared again
    /// with the next revision.
    void cancel();

    /// Links all programs again for the next picture, because shader files have changed.
    void relink();

    /// Runs a task step by step while no picture is requested, and wakes the window after the last
    /// step. Unfinished tasks are dropped at the end.
    void add(DrawTask task);

    [[nodiscard]] RenderedPicture drawn();
    [[nodiscard]] shade::PictureExchange::Shown shown();

    /// Makes a texture of a picture, which replaces that of the last call.
    void put_thumbnails(Image picture);
    [[nodiscard]] shade::PictureExchange::Shown thumbnails();
    /// The same for another picture, that of the images of a folder.
    void put_previews(Image picture);
    [[nodiscard]] shade::PictureExchange::Shown previews();

    /// Returns whether a request is waiting or being drawn.
    [[nodiscard]] bool is_busy();
    /// Progress of preparing a renderer. Without a preparation, the stage is empty.
    [[nodiscard]] Progress::State progress();
    [[nodiscard]] const std::string& renderer_name() const { return renderer_name_; }

  private:
    class Drawer;

    void run();
    void put(Image picture, shade::PictureExchange* exchange);
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
    shade::PictureExchange* handover_ = nullptr;
    shade::PictureExchange* thumbnails_ = nullptr;
    shade::PictureExchange* previews_ = nullptr;
    std::thread thread_;
};

// The times of effects.

/// Measures the time of each effect on the drawing thread. Results are valid for one plan and size.
class EffectTimes {
  public:
    struct State {
        bool is_running = false;
        std::size_t count = 0;     ///< Number of effects; 0 if it is not yet known.
        shade::EffectCosts costs;  ///< Costs of the effects that have been measured.
        std::string error;
        int width = 0;  ///< Width of the measured frames in pixels; 0 without a measurement.
        int height = 0;
        int samples = 0;
    };
    [[nodiscard]] State state() const;

    /// Starts a measurement. \return the work for the drawing thread
    DrawTask start(const DrawRequest& request);

    /// Cancels and discards the measurement.
    void cancel();

    /// Discards the measurement if it does not match the picture.
    ///
    /// \param plan  the plan of the current picture
    /// \param request  the request at full resolution
    void discard_unless_valid_for(const shade::FramePlan& plan, const DrawRequest& request);

    /// "1.25 ms"; "noise" for a time below the noise, and empty if the effect was not measured.
    [[nodiscard]] std::string text(const std::string& effect) const;

  private:
    /// A measurement, shared by both threads.
    struct Measurement {
        std::atomic<bool> is_wanted = true;
        std::mutex mutex;
        State state;
        shade::FramePlan plan;  ///< Empty until the measurement has started.
    };
    class MeasurementTask;

    std::shared_ptr<Measurement> current_;
};

/// {"going_on", "done", "count", "frame": milliseconds, "size", "samples", "effects": {name:
/// milliseconds}, "error"}, or null without a measurement.
nlohmann::ordered_json json_of(const EffectTimes::State& state);

}  // namespace relief::tools
