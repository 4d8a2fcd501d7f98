// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/capture_test.cpp.
#include "window/capture.h"

#include <fmt/format.h>

#include <optional>

#include "relief/mesh/image_channels.h"
#include "relief/mesh/image_file.h"
#include "sequence.h"
#include "sequence_options.h"
#include "window/draw_thread.h"

namespace relief::tools {
namespace {

/// A renderer and the scene that it turns.
class Capturing {
  public:
    explicit Capturing(CaptureWish wish) : wish_(std::move(wish)) {
        composed_.graph.scene = *wish_.scene;
        Scene& scene = composed_.scene();
        if (wish_.transparent) {
            scene.background = glm::vec4(0.0F);
            if (scene.environment) scene.environment->skybox = false;
        }
        composed_.middle = wish_.middle;
        for (const Instance& instance : scene.instances)
            composed_.at_rest.push_back(instance.world_from_object);
        if (wish_.turntable > 0) options_.turntable = wish_.turntable;
    }

    [[nodiscard]] int count() const { return std::max(wish_.turntable, 1); }

    /// Draws and writes picture `index`, from 0. \return its file
    std::filesystem::path save(int index, const Context& context, RenderCache& cache) {
        if (!renderer_) prepare(context, cache);
        if (index > 0) {
            pose_for(composed_, options_, index);
            renderer_->move(composed_.scene());
        }
        Image picture = renderer_->draw(wish_.camera).image;
        if (composed_.scene().background.a == 1.0F) drop_alpha(picture);
        const std::filesystem::path file =
            wish_.turntable > 0 ? numbered_file(wish_.file, index + 1) : wish_.file;
        write_image(file, picture);
        return file;
    }

  private:
    void prepare(const Context& context, RenderCache& cache) {
        Report known;  // The window has shown these findings.
        const Scene& scene = composed_.scene();
        renderer_.emplace(cache, context, scene, forced_plan(scene, wish_.settings, wish_.effects),
                          wish_.settings, known);
    }

    CaptureWish wish_;
    ComposedScene composed_;
    ViewOptions options_;
    std::optional<Renderer> renderer_;
};

}  // namespace

CaptureProgress::State CaptureProgress::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

void CaptureProgress::set(const State& state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
}

nlohmann::ordered_json json_of(const CaptureProgress::State& state) {
    return {
        {"done", state.done}, {"count", state.count}, {"file", state.file}, {"error", state.error}};
}

std::string text_of(const CaptureProgress::State& state) {
    if (!state.error.empty()) return "Not saved: " + state.error;
    if (state.done < state.count)
        return fmt::format("Saving picture {} of {}", state.done + 1, state.count);
    if (state.count > 1) return fmt::format("Saved {} pictures, to {}", state.count, state.file);
    return state.file.empty() ? "" : "Saved " + state.file;
}

DrawTask capture_task(CaptureWish wish, std::shared_ptr<CaptureProgress> progress) {
    const auto capturing = std::make_shared<Capturing>(std::move(wish));
    CaptureProgress::State begun;
    begun.count = capturing->count();
    progress->set(begun);
    return [capturing, progress](const Context& context, RenderCache& cache) {
        CaptureProgress::State state = progress->state();
        try {
            state.file = capturing->save(state.done, context, cache).string();
            ++state.done;
        } catch (const std::exception& error) {
            state.error = error.what();
        }
        progress->set(state);
        return state.is_going_on();
    };
}

namespace {

/// A link into nowhere is something too.
bool is_there(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::symlink_status(file, error).type() !=
           std::filesystem::file_type::not_found;
}

bool is_free(const std::filesystem::path& file, int turntable) {
    if (turntable == 0) return !is_there(file);
    for (int i = 1; i <= turntable; ++i) {
        if (is_there(numbered_file(file, i))) return false;
    }
    return true;
}

}  // namespace

std::filesystem::path free_file(const std::filesystem::path& model, int turntable) {
    for (int number = 1;; ++number) {
        const std::filesystem::path file =
            model.parent_path() /
            fmt::format("{}-{}{}.png", model.stem().string(), turntable > 0 ? "turn-" : "", number);
        if (is_free(file, turntable)) return file;
    }
}

std::filesystem::path free_beside(const std::filesystem::path& model, const std::string& middle,
                                  const std::string& extension) {
    for (int number = 1;; ++number) {
        const std::filesystem::path file =
            model.parent_path() /
            fmt::format("{}{}{}{}", model.stem().string(), middle, number, extension);
        if (!is_there(file)) return file;
    }
}

}  // namespace relief::tools
