// SPDX-License-Identifier: Apache-2.0
// Reads scenes, searches for mesh problems, draws pictures and measures effects on other threads.
// Tests: tests/tools/window/background_jobs_test.cpp, draw_thread_test.cpp, effects_panel_test.cpp.
#include "window/background_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "effect_options.h"
#include "progress_stage.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {
using namespace relief::detail;
using namespace relief::shade;

// Reading and checking.

namespace {

Loaded load(ViewOptions options, const Progress& progress) {
    const Stopwatch stopwatch;
    Loaded loaded;
    try {
        Stages silent(true);
        loaded.composed = compose_scene(options, silent, loaded.findings);
    } catch (const Cancelled&) {
        throw;
    } catch (const RefusedMap& error) {
        loaded.error = error.what();
        loaded.refused = error.wanted();
    } catch (const std::exception& error) {
        loaded.error = error.what();
    }
    loaded.options = std::move(options);
    loaded.files = progress.files();
    loaded.seconds = stopwatch.seconds();
    return loaded;
}

}  // namespace

void Loader::start(const ViewOptions& options) {
    job_.start([options](const Progress& progress) { return load(options, progress); });
}

namespace {

HealthResult find(const HealthRequest& request) {
    DebugChoices choices;
    choices.health_markers = request.choice;
    try {
        return {chosen_markers(choices, *request.scene), ""};
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        return {{}, error.what()};
    }
}

}  // namespace

void HealthSearch::start(HealthRequest request) {
    if (!request.choice || !request.scene) return job_.cancel();
    job_.start([checked = std::move(request)](const Progress&) { return find(checked); });
}

// Thumbnails.

namespace {

/// Returns the name of an image and the stamp of its file, by which changes are noticed.
std::pair<std::string, FileStamp> identity_of(const ImageSource& image) {
    const auto* file = std::get_if<std::filesystem::path>(&image.source);
    return {image.name + '\n' + image.origin, file == nullptr ? FileStamp{} : stamp_of(*file)};
}

/// Returns a sample as a code from 0 to 255; sRGB for linear floats.
double code_of(std::uint8_t sample) {
    return sample;
}
double code_of(std::uint16_t sample) {
    return sample / 257.0;
}
double code_of(float sample) {
    const float shown = sample > 0.0F ? std::min(sample, 1.0F) : 0.0F;  // NaN counts as 0.
    return 255.0 * static_cast<double>(srgb_from_linear(shown));
}

/// Writes an image into a part of a picture, each pixel the mean of the codes of a rectangle.
void reduce(const Image& image, Image& picture, const glm::ivec2& min, const glm::ivec2& size) {
    const std::span<std::uint8_t> to = picture.as<std::uint8_t>();
    const auto first_of = [](int i, int count, int texels) {
        return static_cast<int>(static_cast<std::int64_t>(i) * texels / count);
    };
    const auto write = [&](const auto& samples, int x, int y) {
        const int left = first_of(x, size.x, image.width);
        const int top = first_of(y, size.y, image.height);
        const int right = std::max(first_of(x + 1, size.x, image.width), left + 1);
        const int bottom = std::max(first_of(y + 1, size.y, image.height), top + 1);
        std::array<double, 4> sum{};
        for (int row = top; row < bottom; ++row) {
            for (int column = left; column < right; ++column) {
                const auto texel =
                    static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                    static_cast<std::size_t>(column);
                for (std::size_t i = 0; i < 3; ++i) {
                    const auto channels = static_cast<std::size_t>(image.channels);
                    sum[i] += code_of(samples[texel * channels + (channels < 3 ? 0 : i)]);
                }
            }
        }
        const double count = static_cast<double>(right - left) * (bottom - top);
        const auto pixel =
            4 * (static_cast<std::size_t>(min.y + y) * static_cast<std::size_t>(picture.width) +
                 static_cast<std::size_t>(min.x + x));
        for (std::size_t i = 0; i < 3; ++i)
            to[pixel + i] = static_cast<std::uint8_t>(std::lround(sum[i] / count));
        to[pixel + 3] = 255;
    };
    std::visit(
        [&](const auto& samples) {
            for (int y = 0; y < size.y; ++y) {
                for (int x = 0; x < size.x; ++x)
                    write(samples, x, y);
            }
        },
        image.samples);
}

}  // namespace

Thumbnails::Result Thumbnails::reduced(const std::vector<ImageSource>& images) {
    const std::size_t count = std::min(images.size(), max_count);
    const auto rows = static_cast<int>((count + columns - 1) / columns);
    Result result{make_image(columns * cell, rows * cell, 4, 8, ColorSpace::srgb), {}};
    for (std::size_t i = 0; i < count; ++i) {
        check_cancelled();
        Place& place = result.places.emplace_back();
        try {
            const Image image = decode(images[i], ImageUse::color);
            const int longest = std::max(image.width, image.height);
            if (image.empty()) continue;
            const auto fitted = [&](int side) {
                return std::max(static_cast<int>(static_cast<std::int64_t>(side) * cell / longest),
                                1);
            };
            const auto index = static_cast<int>(i);
            place = {cell * glm::ivec2(index % columns, index / columns),
                     {fitted(image.width), fitted(image.height)},
                     {image.width, image.height}};
            reduce(image, result.picture, place.min, place.size);
        } catch (const Cancelled&) {
            throw;
        } catch (const Error&) {  // The renderer reports the error.
            place = {};
        }
    }
    return result;
}

void Thumbnails::update(const Scene& scene) {
    if (!std::exchange(is_wanted_, false) || scene.images.empty()) return;
    std::vector<std::pair<std::string, FileStamp>> images;
    for (const ImageSource& image : scene.images)
        images.push_back(identity_of(image));
    if (images == started_) return;
    started_ = std::move(images);
    places_.clear();
    job_.start([sources = scene.images](const Progress&) { return reduced(sources); });
}

std::optional<Image> Thumbnails::take() {
    std::optional<Result> result = job_.take();
    if (!result) return std::nullopt;
    places_ = std::move(result->places);
    return std::move(result->picture);
}

std::optional<Thumbnails::Place> Thumbnails::place_of(std::size_t image) const {
    if (image >= places_.size() || places_[image].size.x == 0) return std::nullopt;
    return places_[image];
}

// Drawing.

namespace {

constexpr double cost_of_samples = 2.4;  // Measured ratio of 4 samples to 1 in software.
/// The estimated time of the second picture of a scene, as a share of that of the first, for which
/// the driver has compiled.
constexpr double share_of_drawing = 0.25;

bool have_same_size(const FrameSettings& a, const FrameSettings& b) {
    return a.width == b.width && a.height == b.height;
}

FrameSettings scaled(FrameSettings settings, int numerator, int denominator) {
    settings.width = std::max(settings.width * numerator / denominator, 1);
    settings.height = std::max(settings.height * numerator / denominator, 1);
    return settings;
}

}  // namespace

void AdaptiveResolution::note_picture(const FrameSettings& drawn, const FrameSettings& full,
                                      double milliseconds, bool is_first) {
    const bool is_full = have_same_size(drawn, full) && drawn.samples == full.samples;
    if (is_full && !is_first) {
        milliseconds_ = milliseconds;
        is_measured_ = true;
    } else if (is_full && !is_measured_) {
        milliseconds_ = share_of_drawing * milliseconds;
    }
}

double AdaptiveResolution::idle_seconds() const {
    constexpr double shortest = 0.05;  // Two steps of a wheel are not much farther apart.
    constexpr double longest = 0.15;
    return std::clamp(seconds_to_full - 1e-3 * milliseconds_, shortest, longest);
}

double AdaptiveResolution::seconds_until_rest(double now) const {
    return std::max(last_move_ + idle_seconds() - now, 0.0);
}

FrameSettings AdaptiveResolution::moving_settings(FrameSettings full) const {
    if (milliseconds_ <= max_milliseconds) return full;
    if (9.0 / 16.0 * milliseconds_ <= max_milliseconds) return scaled(full, 3, 4);
    if (milliseconds_ / 4.0 <= max_coarse_milliseconds) return scaled(full, 1, 2);
    const double of_one_sample = full.samples > 1 ? milliseconds_ / cost_of_samples : milliseconds_;
    full.samples = 1;
    return of_one_sample / 4.0 <= max_coarse_milliseconds ? scaled(full, 1, 2) : scaled(full, 1, 3);
}

FrameSettings AdaptiveResolution::next_settings(const FrameSettings& full,
                                                const FrameSettings& last, bool is_idle,
                                                double now) const {
    if (seconds_until_rest(now) > 0.0) return moving_settings(full);
    constexpr double latency = 0.05;
    if (1e-3 * milliseconds_ <= seconds_to_full - latency || full.samples <= 1) return full;
    FrameSettings first = full;
    first.samples = 1;
    if (last.width < full.width) return first;
    const bool is_waiting = have_same_size(last, first) && last.samples == 1 && !is_idle;
    return is_waiting ? first : full;
}

FramePlan forced_plan(const Scene& scene, const FrameSettings& settings,
                      const EffectRequest& effects) {
    return force_effects(scene, settings, plan_effects(scene, settings), effects);
}

/// The objects that live in the thread's context.
class DrawThread::Drawer {
  public:
    Drawer(GlLoader loader, const std::string& name)
        : context_(loader, name),
          cache_(context_),
          handover_(context_),
          thumbnails_(context_),
          previews_(context_) {}

    [[nodiscard]] const std::string& renderer_name() const { return context_.renderer_name(); }
    PictureExchange& handover() { return handover_; }
    PictureExchange& thumbnails() { return thumbnails_; }
    PictureExchange& previews() { return previews_; }

    void relink() {
        cache_.drop_programs();
        has_tried_ = false;
    }

    bool run(const DrawTask& task) { return task(context_, cache_); }

    /// Draws a request, or throws and keeps the old picture. A scene that cannot be prepared is
    /// tried once; after that, the old scene still follows the camera.
    void draw(const DrawRequest& request, RenderedPicture& drawn, const Progress& progress) {
        if (request.instead) {
            show(*request.instead, request, drawn);
            return;
        }
        const bool is_tried = has_tried_ && tried_revision_ == request.revision &&
                              tried_beside_ == revision_of(request.beside) &&
                              tried_settings_ == request.settings;
        if (!is_tried) {
            try_to_prepare(request, drawn, progress);
        } else if (renderer_ && failure_.empty() && pose_ != request.pose) {
            renderer_->move(*request.scene);
        }
        pose_ = request.pose;
        drawn.error = failure_;
        if (!renderer_) return;
        if (!failure_.empty() && drawn.camera == request.camera) return;
        draw_prepared(request, drawn);
    }

  private:
    /// Stores the files that were read, even after an error, because the user may repair a file.
    struct NotedFiles {
        const Progress& progress;
        RenderedPicture& drawn;
        ~NotedFiles() {
            drawn.files = std::make_shared<const std::map<std::filesystem::path, FileStamp>>(
                progress.files());
        }
    };

    static std::uint64_t revision_of(const std::optional<BesideRequest>& beside) {
        return beside ? beside->revision : 0;
    }

    void show(const Image& picture, const DrawRequest& request, RenderedPicture& drawn) {
        handover_.put(picture);
        drawn.error.clear();
        drawn.beside = 0;
        drawn.is_difference = true;
        drawn.camera = request.camera;
        drawn.settings = request.settings;
        ++drawn.frames;
    }

    void draw_prepared(const DrawRequest& request, RenderedPicture& drawn) {
        drawn.times = renderer_->draw_only(request.camera).times;
        const bool has_beside = request.beside && beside_;
        if (has_beside) drawn.times.draw += beside_->draw_only(request.beside->camera).times.draw;
        handover_.put(*renderer_, has_beside ? beside_.get() : nullptr);
        drawn.beside = has_beside ? request.beside->revision : 0;
        drawn.is_difference = false;
        drawn.camera = request.camera;
        drawn.settings = settings_;
        ++drawn.frames;
    }

    void try_to_prepare(const DrawRequest& request, RenderedPicture& drawn,
                        const Progress& progress) {
        const NotedFiles noted{progress, drawn};
        tried_revision_ = request.revision;
        tried_beside_ = revision_of(request.beside);
        tried_settings_ = request.settings;
        has_tried_ = true;
        drawn.is_cancelled = false;
        failure_.clear();
        try {
            prepare(request, drawn);
            prepare_beside(request);
            cache_.drop_unused();
        } catch (const Cancelled&) {
            failure_ = "the picture was cancelled before it was complete";
            drawn.is_cancelled = true;
        } catch (const std::exception& error) {
            failure_ = error.what();
        }
    }

    void prepare(const DrawRequest& request, RenderedPicture& drawn) {
        Report findings;
        renderer_ = prepared(*request.scene, request, findings);
        settings_ = request.settings;
        drawn.revision = request.revision;
        drawn.plan = std::make_shared<const FramePlan>(renderer_->plan());
        drawn.findings = std::move(findings);
        ++drawn.renderers;
    }

    /// Prepares the second scene, or removes it.
    void prepare_beside(const DrawRequest& request) {
        Report findings;  // Mostly the same as those of the first scene.
        beside_.reset();
        if (request.beside) beside_ = prepared(*request.beside->scene, request, findings);
    }

    std::unique_ptr<Renderer> prepared(const Scene& scene, const DrawRequest& request,
                                       Report& findings) {
        return std::make_unique<Renderer>(cache_, context_, scene,
                                          forced_plan(scene, request.settings, request.effects),
                                          request.settings, findings);
    }

    Context context_;
    RenderCache cache_;
    PictureExchange handover_;
    PictureExchange thumbnails_;
    PictureExchange previews_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<Renderer> beside_;
    FrameSettings settings_;  ///< Settings of the renderer.
    bool has_tried_ =
        false;  ///< The last request was prepared, and shaders have not changed since.
    std::uint64_t tried_revision_ = 0;
    std::uint64_t pose_ = 0;
    std::uint64_t tried_beside_ = 0;
    FrameSettings tried_settings_;
    std::string failure_;  ///< Error of the last preparation; empty if there was none.
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

void DrawThread::request(DrawRequest request) {
    {
        const std::lock_guard lock(mutex_);
        request_ = std::move(request);
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

void DrawThread::cancel() {
    const std::lock_guard lock(mutex_);
    if (is_drawing_) progress_->cancel();
}

void DrawThread::relink() {
    const std::lock_guard lock(mutex_);
    is_relinking_ = true;
}

RenderedPicture DrawThread::drawn() {
    const std::lock_guard lock(mutex_);
    return drawn_;
}

PictureExchange::Shown DrawThread::shown() {
    return handover_->get();
}

void DrawThread::put(Image picture, PictureExchange* exchange) {
    auto shared = std::make_shared<const Image>(std::move(picture));
    add([exchange, shared](const Context&, RenderCache&) {
        exchange->put(*shared);
        return false;
    });
}

void DrawThread::put_thumbnails(Image picture) {
    put(std::move(picture), thumbnails_);
}

void DrawThread::put_previews(Image picture) {
    put(std::move(picture), previews_);
}

PictureExchange::Shown DrawThread::previews() {
    return previews_->get();
}

PictureExchange::Shown DrawThread::thumbnails() {
    return thumbnails_->get();
}

bool DrawThread::is_busy() {
    const std::lock_guard lock(mutex_);
    return is_drawing_ || request_.has_value();
}

Progress::State DrawThread::progress() {
    const std::lock_guard lock(mutex_);
    return is_drawing_ ? progress_->state() : Progress::State{};
}

/// Runs one step of the first task without the lock.
void DrawThread::do_step(Drawer& drawer, std::unique_lock<std::mutex>& lock) {
    const DrawTask task = tasks_.front();
    const std::shared_ptr<Progress> progress = progress_ = std::make_shared<Progress>();
    lock.unlock();
    bool has_more = false;
    {
        const ProgressScope scope(*progress);
        has_more = drawer.run(task);
    }
    // Waking after each step would let the window's frame disturb the first measurement of the next
    // step.
    if (!has_more) context_.wake();
    lock.lock();
    if (!has_more) tasks_.pop_front();
}

/// Waits for a request. Returns nothing at the end.
std::optional<DrawRequest> DrawThread::next(Drawer& drawer) {
    std::unique_lock lock(mutex_);
    is_drawing_ = false;
    // One step after each picture. Otherwise a turntable would block all tasks.
    if (!is_ending_ && !tasks_.empty()) do_step(drawer, lock);
    for (;;) {
        changed_.wait(lock, [&] { return is_ending_ || request_ || !tasks_.empty(); });
        if (is_ending_) return std::nullopt;
        if (request_) break;
        do_step(drawer, lock);
    }
    is_drawing_ = true;
    progress_ = std::make_shared<Progress>();
    if (std::exchange(is_relinking_, false)) drawer.relink();
    return std::exchange(request_, std::nullopt);
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
            thumbnails_ = &drawer.thumbnails();
            previews_ = &drawer.previews();
            is_ready_ = true;
        }
        changed_.notify_all();
        RenderedPicture picture;
        while (const std::optional<DrawRequest> request = next(drawer)) {
            try {
                const std::shared_ptr<Progress> progress = progress_of_now();
                const ProgressScope scope(*progress);
                drawer.draw(*request, picture, *progress);
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
        tasks_.clear();  // Tasks own objects of this context.
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
        is_ready_ = true;
    }
    changed_.notify_all();
    context_.release();
}

// The times of effects.

namespace {

/// The drawing thread checks for requests after this time, and the window updates the progress.
constexpr std::chrono::milliseconds step_time(100);

bool have_same_effects(const FramePlan& a, const FramePlan& b) {
    const auto same_features = [](const DrawPlan& one, const DrawPlan& other) {
        return one.features == other.features;
    };
    return effects_in(a) == effects_in(b) &&
           std::equal(a.draws.begin(), a.draws.end(), b.draws.begin(), b.draws.end(),
                      same_features);
}

}  // namespace

/// The part of a measurement that the drawing thread owns.
class EffectTimes::MeasurementTask {
  public:
    MeasurementTask(DrawRequest request, std::shared_ptr<Measurement> measurement)
        : request_(std::move(request)), measurement_(std::move(measurement)) {}

    /// Runs steps for at most step_time. \return whether there is more to do
    bool work(const Context& context, RenderCache& cache) {
        if (!measurement_->is_wanted) return false;
        bool has_more = false;
        std::string error;
        try {
            const auto end = std::chrono::steady_clock::now() + step_time;
            if (!pricing_) prepare(context, cache);
            do {
                has_more = pricing_->step();
            } while (has_more && measurement_->is_wanted && std::chrono::steady_clock::now() < end);
        } catch (const std::exception& failure) {
            has_more = false;
            error = failure.what();
        }
        const std::lock_guard lock(measurement_->mutex);
        State& state = measurement_->state;
        if (pricing_) state.costs = pricing_->costs();
        state.error = error;
        state.is_running = has_more;
        return has_more;
    }

  private:
    void prepare(const Context& context, RenderCache& cache) {
        FramePlan plan =
            force_effects(*request_.scene, request_.settings,
                          plan_effects(*request_.scene, request_.settings), request_.effects);
        const MeasuredFrame frame{.context = context,
                                  .scene = *request_.scene,
                                  .settings = request_.settings,
                                  .camera = request_.camera,
                                  .cache = &cache};
        pricing_ = std::make_unique<EffectCostMeasurement>(frame, plan);
        const std::lock_guard lock(measurement_->mutex);
        measurement_->plan = std::move(plan);
        measurement_->state.count = pricing_->count();
    }

    DrawRequest request_;
    std::shared_ptr<Measurement> measurement_;
    std::unique_ptr<EffectCostMeasurement> pricing_;
};

EffectTimes::State EffectTimes::state() const {
    if (!current_) return {};
    const std::lock_guard lock(current_->mutex);
    return current_->state;
}

DrawTask EffectTimes::start(const DrawRequest& request) {
    cancel();
    current_ = std::make_shared<Measurement>();
    State& state = current_->state;
    state.is_running = true;
    state.width = request.settings.width;
    state.height = request.settings.height;
    state.samples = request.settings.samples;
    DrawRequest picture = request;
    picture.settings.overlays = {};
    const auto measuring = std::make_shared<MeasurementTask>(std::move(picture), current_);
    return [measuring](const Context& context, RenderCache& cache) {
        return measuring->work(context, cache);
    };
}

void EffectTimes::cancel() {
    if (current_) current_->is_wanted = false;
    current_.reset();
}

void EffectTimes::discard_unless_valid_for(const FramePlan& plan, const DrawRequest& request) {
    if (!current_) return;
    bool holds = false;
    {
        const std::lock_guard lock(current_->mutex);
        const State& state = current_->state;
        const bool is_known = state.count > 0;
        holds = state.width == request.settings.width && state.height == request.settings.height &&
                state.samples == request.settings.samples &&
                (!is_known || have_same_effects(current_->plan, plan));
    }
    if (!holds) cancel();
}

std::string EffectTimes::text(const std::string& effect) const {
    const State now = state();
    const auto found = std::find_if(now.costs.effects.begin(), now.costs.effects.end(),
                                    [&](const EffectCost& cost) { return cost.effect == effect; });
    if (found == now.costs.effects.end()) return "";
    return exceeds_noise(*found, now.costs) ? fmt::format("{:.2f} ms", found->milliseconds)
                                            : "noise";
}

nlohmann::ordered_json json_of(const EffectTimes::State& state) {
    if (state.width == 0) return nullptr;
    nlohmann::ordered_json effects = nlohmann::ordered_json::object();
    for (const EffectCost& cost : state.costs.effects)
        effects[cost.effect] = cost.milliseconds;
    return {{"going_on", state.is_running},
            {"done", state.costs.effects.size()},
            {"count", state.count},
            {"frame", state.costs.frame.median},
            {"size", {state.width, state.height}},
            {"samples", state.samples},
            {"effects", effects},
            {"error", state.error}};
}

}  // namespace relief::tools
