// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/draw_thread_test.cpp.
#include "window/draw_thread.h"

#include <utility>

namespace relief::tools {

FramePlan forced_plan(const Scene& scene, const FrameSettings& settings,
                      const EffectWishes& effects) {
    return force_effects(scene, settings, plan_effects(scene, settings), effects);
}

/// What lives on the thread, in its context.
class DrawThread::Drawer {
  public:
    Drawer(GlLoader loader, const std::string& name)
        : context_(loader, name), cache_(context_), handover_(context_) {}

    [[nodiscard]] const std::string& renderer_name() const { return context_.renderer_name(); }
    Handover& handover() { return handover_; }

    void relink() {
        cache_.drop_programs();
        has_tried_ = false;
    }

    bool run(const DrawTask& task) { return task(context_, cache_); }

    /// Draws, or throws; what was drawn before stays. What cannot be prepared is tried once, and
    /// what was there before can still be looked at from elsewhere.
    void draw(const DrawWish& wish, DrawnPicture& drawn, const Progress& progress) {
        if (wish.instead) {
            show(*wish.instead, wish, drawn);
            return;
        }
        const bool is_tried = has_tried_ && tried_revision_ == wish.revision &&
                              tried_beside_ == revision_of(wish.beside) &&
                              tried_settings_ == wish.settings;
        if (!is_tried) try_to_prepare(wish, drawn, progress);
        drawn.error = failure_;
        if (!renderer_) return;
        if (!failure_.empty() && is_same_view(drawn.camera, wish.camera)) return;
        draw_prepared(wish, drawn);
    }

  private:
    /// Also of what could not be prepared: a file may be mended.
    struct NotedFiles {
        const Progress& progress;
        DrawnPicture& drawn;
        ~NotedFiles() {
            drawn.files = std::make_shared<const std::map<std::filesystem::path, FileStamp>>(
                progress.files());
        }
    };

    static std::uint64_t revision_of(const std::optional<BesideWish>& beside) {
        return beside ? beside->revision : 0;
    }

    static bool is_same_view(const Camera& a, const Camera& b) {
        return a.world_from_view == b.world_from_view && a.vertical_fov == b.vertical_fov;
    }

    void show(const Image& picture, const DrawWish& wish, DrawnPicture& drawn) {
        handover_.put(picture);
        drawn.error.clear();
        drawn.beside = 0;
        drawn.is_difference = true;
        drawn.camera = wish.camera;
        drawn.settings = wish.settings;
        ++drawn.frames;
    }

    void draw_prepared(const DrawWish& wish, DrawnPicture& drawn) {
        drawn.times = renderer_->draw_only(wish.camera).times;
        const bool has_beside = wish.beside && beside_;
        if (has_beside) drawn.times.draw += beside_->draw_only(wish.beside->camera).times.draw;
        handover_.put(*renderer_, has_beside ? beside_.get() : nullptr);
        drawn.beside = has_beside ? wish.beside->revision : 0;
        drawn.is_difference = false;
        drawn.camera = wish.camera;
        drawn.settings = settings_;
        ++drawn.frames;
    }

    void try_to_prepare(const DrawWish& wish, DrawnPicture& drawn, const Progress& progress) {
        const NotedFiles noted{progress, drawn};
        tried_revision_ = wish.revision;
        tried_beside_ = revision_of(wish.beside);
        tried_settings_ = wish.settings;
        has_tried_ = true;
        failure_.clear();
        try {
            prepare(wish, drawn);
            prepare_beside(wish);
            cache_.drop_unused();
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            failure_ = error.what();
        }
    }

    void prepare(const DrawWish& wish, DrawnPicture& drawn) {
        Report findings;
        renderer_ = prepared(*wish.scene, wish, findings);
        settings_ = wish.settings;
        drawn.revision = wish.revision;
        drawn.plan = std::make_shared<const FramePlan>(renderer_->plan());
        drawn.findings = std::move(findings);
        ++drawn.renderers;
    }

    /// Goes where nothing is to be beside the scene, or what should be cannot.
    void prepare_beside(const DrawWish& wish) {
        Report findings;  // Nearly those of the scene.
        beside_.reset();
        if (wish.beside) beside_ = prepared(*wish.beside->scene, wish, findings);
    }

    std::unique_ptr<Renderer> prepared(const Scene& scene, const DrawWish& wish, Report& findings) {
        return std::make_unique<Renderer>(cache_, context_, scene,
                                          forced_plan(scene, wish.settings, wish.effects),
                                          wish.settings, findings);
    }

    Context context_;
    RenderCache cache_;
    Handover handover_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<Renderer> beside_;
    FrameSettings settings_;  ///< Of the renderer.
    bool has_tried_ = false;  ///< The last wish was prepared, and shaders have not changed since.
    std::uint64_t tried_revision_ = 0;
    std::uint64_t tried_beside_ = 0;
    FrameSettings tried_settings_;
    std::string failure_;  ///< Of that; empty: none.
};

DrawThread::DrawThread(DrawContext context) : context_(std::move(context)) {
    thread_ = std::thread([this] { run(); });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_ready_; });
    if (!failure_) return;
    lock.unlock();
    thread_.join();
    std::rethrow_exception(failure_);
}

DrawThread::~DrawThread() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
        progress_->cancel();
    }
    changed_.notify_all();
    thread_.join();
}

void DrawThread::wish(DrawWish wish) {
    {
        const std::lock_guard lock(mutex_);
        wish_ = std::move(wish);
    }
    changed_.notify_all();
}

void DrawThread::add(DrawTask task) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    changed_.notify_all();
}

void DrawThread::relink() {
    const std::lock_guard lock(mutex_);
    is_relinking_ = true;
}

DrawnPicture DrawThread::drawn() {
    const std::lock_guard lock(mutex_);
    return drawn_;
}

Handover::Shown DrawThread::shown() {
    return handover_->get();
}

bool DrawThread::is_busy() {
    const std::lock_guard lock(mutex_);
    return is_drawing_ || wish_.has_value();
}

Progress::State DrawThread::progress() {
    const std::lock_guard lock(mutex_);
    return is_drawing_ ? progress_->state() : Progress::State{};
}

/// One step of the first task, while others may wish.
void DrawThread::do_step(Drawer& drawer, std::unique_lock<std::mutex>& lock) {
    const DrawTask task = tasks_.front();
    const std::shared_ptr<Progress> progress = progress_ = std::make_shared<Progress>();
    lock.unlock();
    bool has_more = false;
    {
        const ProgressScope scope(*progress);
        has_more = drawer.run(task);
    }
    // Not after each step: the window's frame would always meet what is timed first in the next
    // one.
    if (!has_more) context_.wake();
    lock.lock();
    if (!has_more) tasks_.pop_front();
}

/// Waits for a wish; none: the end.
std::optional<DrawWish> DrawThread::next(Drawer& drawer) {
    std::unique_lock lock(mutex_);
    is_drawing_ = false;
    // After every picture, or a model that turns would let no task through.
    if (!is_ending_ && !tasks_.empty()) do_step(drawer, lock);
    for (;;) {
        changed_.wait(lock, [&] { return is_ending_ || wish_ || !tasks_.empty(); });
        if (is_ending_) return std::nullopt;
        if (wish_) break;
        do_step(drawer, lock);
    }
    is_drawing_ = true;
    progress_ = std::make_shared<Progress>();
    if (std::exchange(is_relinking_, false)) drawer.relink();
    return std::exchange(wish_, std::nullopt);
}

std::shared_ptr<Progress> DrawThread::progress_of_now() {
    const std::lock_guard lock(mutex_);
    return progress_;
}

void DrawThread::run() {
    context_.use();
    try {
        Drawer drawer(context_.loader, "window");
        {
            const std::lock_guard lock(mutex_);
            renderer_name_ = drawer.renderer_name();
            handover_ = &drawer.handover();
            is_ready_ = true;
        }
        changed_.notify_all();
        DrawnPicture picture;
        while (const std::optional<DrawWish> wish = next(drawer)) {
            try {
                const std::shared_ptr<Progress> progress = progress_of_now();
                const ProgressScope scope(*progress);
                drawer.draw(*wish, picture, *progress);
            } catch (const std::exception& error) {
                picture.error = error.what();
            }
            {
                const std::lock_guard lock(mutex_);
                drawn_ = picture;
                is_drawing_ = false;
            }
            context_.wake();
        }
        const std::lock_guard lock(mutex_);
        tasks_.clear();  // They hold what lives in this context.
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
        is_ready_ = true;
    }
    changed_.notify_all();
    context_.release();
}

}  // namespace relief::tools
