// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/draw_thread_test.cpp.
#include "window/draw_thread.h"

#include <utility>

namespace relief::tools {

/// What lives on the thread, in its context.
class DrawThread::Drawer {
  public:
    Drawer(GlLoader loader, const std::string& name)
        : context_(loader, name), cache_(context_), handover_(context_) {}

    [[nodiscard]] const std::string& renderer_name() const { return context_.renderer_name(); }
    Handover& handover() { return handover_; }

    void relink() {
        cache_.drop_programs();
        is_stale_ = true;
    }

    bool run(const DrawTask& task) { return task(context_, cache_); }

    /// Draws, or throws; what was drawn before stays.
    void draw(const DrawWish& wish, DrawnPicture& drawn) {
        const bool is_same =
            renderer_ && !is_stale_ && revision_ == wish.revision && settings_ == wish.settings;
        if (!is_same) prepare(wish, drawn);
        drawn.times = renderer_->draw_only(wish.camera).times;
        handover_.put(*renderer_);
        drawn.camera = wish.camera;
        drawn.settings = wish.settings;
        ++drawn.frames;
    }

  private:
    void prepare(const DrawWish& wish, DrawnPicture& drawn) {
        Report findings;
        const FramePlan planned = plan_effects(*wish.scene, wish.settings);
        FramePlan plan = force_effects(*wish.scene, wish.settings, planned, wish.effects);
        auto made = std::make_unique<Renderer>(cache_, context_, *wish.scene, std::move(plan),
                                               wish.settings, findings);
        renderer_ = std::move(made);
        cache_.drop_unused();
        revision_ = wish.revision;
        settings_ = wish.settings;
        is_stale_ = false;
        drawn.revision = wish.revision;
        drawn.plan = std::make_shared<const FramePlan>(renderer_->plan());
        drawn.findings = std::move(findings);
        ++drawn.renderers;
    }

    Context context_;
    RenderCache cache_;
    Handover handover_;
    std::unique_ptr<Renderer> renderer_;
    std::uint64_t revision_ = 0;
    FrameSettings settings_;
    bool is_stale_ = false;
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

/// One step of the first task, while others may wish.
void DrawThread::do_step(Drawer& drawer, std::unique_lock<std::mutex>& lock) {
    const DrawTask task = tasks_.front();
    lock.unlock();
    const bool has_more = drawer.run(task);
    context_.wake();
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
    if (std::exchange(is_relinking_, false)) drawer.relink();
    return std::exchange(wish_, std::nullopt);
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
            picture.error.clear();
            try {
                drawer.draw(*wish, picture);
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
