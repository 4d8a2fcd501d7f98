// SPDX-License-Identifier: Apache-2.0
#include "window/lesson.h"

#include <utility>

#include "picture_comparison.h"
#include "relief/mesh/image.h"

namespace relief::tools {
using namespace relief::shade;

void StepChoice::follow(const std::shared_ptr<const Scene>& scene, const FrameSettings& settings) {
    if (scene == scene_) return;
    const bool shows_all = chosen() == nullptr;
    scene_ = scene;
    steps_.clear();
    if (scene) {
        try {
            steps_ = picture_steps(*scene, settings);
        } catch (const Error&) {  // A shader that is being edited may be incomplete.
            steps_.clear();
        }
    }
    if (shows_all || shown_ >= steps_.size()) shown_ = steps_.empty() ? 0 : steps_.size() - 1;
}

const PictureStep* StepChoice::chosen() const {
    return shown_ + 1 < steps_.size() ? &steps_[shown_] : nullptr;
}

nlohmann::ordered_json StepChoice::json() const {
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const PictureStep& step : steps_)
        names.push_back(step.name);
    return {{"names", names}, {"shown", shown_}};
}

std::optional<DrawTask> ExerciseCheck::begin(const std::shared_ptr<const Exercise>& exercise,
                                             const DrawRequest& request, const glm::ivec2& size) {
    if (!exercise || checked_ == request.revision || is_working()) return std::nullopt;
    checked_ = request.revision;
    {
        const std::lock_guard lock(state_->mutex);
        state_->is_working = true;
    }
    FrameSettings settings;
    settings.width = size.x;
    settings.height = size.y;
    settings.samples = request.settings.samples;
    settings.shaders = request.settings.shaders;
    return [exercise, settings, scene = request.scene, given = request.camera, state = state_](
               const Context& context, RenderCache& cache) {
        std::optional<ExerciseResult> result;
        try {
            const Camera camera = scene->camera.value_or(given);
            const FramePlan plan = plan_effects(*scene, settings);
            Report same;  // The window shows the findings of its own picture.
            Image picture =
                Renderer(cache, context, *scene, plan, settings, same).draw(camera).image;
            if (scene->background.a == 1.0F) drop_alpha(picture);
            result =
                compare_with_solution(*exercise, settings, plan, *scene, camera, context, picture);
        } catch (const Error&) {  // The status line has the error of the window's picture.
            result.reset();
        }
        const std::lock_guard lock(state->mutex);
        state->result = std::move(result);
        state->is_working = false;
        return false;
    };
}

std::optional<ExerciseResult> ExerciseCheck::result() const {
    const std::lock_guard lock(state_->mutex);
    return state_->result;
}

bool ExerciseCheck::is_working() const {
    const std::lock_guard lock(state_->mutex);
    return state_->is_working;
}

nlohmann::ordered_json ExerciseCheck::json() const {
    const std::optional<ExerciseResult> now = result();
    if (!now) return nullptr;
    nlohmann::ordered_json json = numbers_json(*now);
    json["solved"] = now->is_solved();
    return json;
}

}  // namespace relief::tools
