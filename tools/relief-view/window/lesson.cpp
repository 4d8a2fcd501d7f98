// SPDX-License-Identifier: Apache-2.0
#include "window/lesson.h"

#include <algorithm>
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

std::shared_ptr<const ShaderTexts> MistakeChoice::texts(
    const std::shared_ptr<const ShaderTexts>& right) {
    if (chosen_ == nullptr) return right;
    if (of_texts_ == chosen_ && right_texts_ == right) return wrong_texts_;
    of_texts_ = chosen_;
    right_texts_ = right;
    try {
        wrong_texts_ = with_mistake(*chosen_, right);
    } catch (const Error&) {  // Somebody edits the code that the mistake changes.
        wrong_texts_ = right;
    }
    if (wrong_texts_ == right)
        wrong_texts_ = std::make_shared<const ShaderTexts>(right ? *right : ShaderTexts{});
    return wrong_texts_;
}

std::shared_ptr<const Scene> MistakeChoice::scene(const std::shared_ptr<const Scene>& right) {
    if (!right || chosen_ == nullptr || !chosen_->code.empty()) return right;
    if (of_scene_ == chosen_ && right_scene_ == right) return wrong_scene_;
    of_scene_ = chosen_;
    right_scene_ = right;
    wrong_scene_ = std::make_shared<const Scene>(with_mistake(*chosen_, *right));
    return wrong_scene_;
}

std::optional<DrawTask> MistakeChoice::begin(const DrawRequest& right, double now) {
    constexpr double rest = 0.3;       // Seconds without a change.
    constexpr int largest_side = 640;  // Of the pictures that are compared.
    if (chosen_ == nullptr || !right.scene || is_working()) return std::nullopt;
    const Subject subject{chosen_,      right.revision,       right.pose,
                          right.camera, right.settings.width, right.settings.height};
    if (last_ != subject) {
        last_ = subject;
        changed_ = now;
    }
    if (measured_ == subject || now - changed_ < rest) return std::nullopt;
    measured_ = subject;
    {
        const std::lock_guard lock(state_->mutex);
        state_->is_working = true;
    }
    const int larger = std::max(subject.width, subject.height);
    const double scale = std::min(1.0, static_cast<double>(largest_side) / larger);
    FrameSettings settings;
    settings.width = std::max(1, static_cast<int>(subject.width * scale));
    settings.height = std::max(1, static_cast<int>(subject.height * scale));
    settings.samples = right.settings.samples;
    settings.shaders = right.settings.shaders;
    return [mistake = chosen_, settings, scene = right.scene, camera = right.camera,
            state = state_](const Context& context, RenderCache& cache) {
        std::optional<DrawnMistake> cost;
        try {
            cost = measured_mistake(*mistake, *scene, camera, settings, context, cache);
        } catch (const Error&) {  // The status line has the error of the window's picture.
            cost.reset();
        }
        const std::lock_guard lock(state->mutex);
        state->cost = std::move(cost);
        state->is_working = false;
        return false;
    };
}

std::optional<DrawnMistake> MistakeChoice::cost() const {
    const std::lock_guard lock(state_->mutex);
    const bool is_chosen = state_->cost && state_->cost->mistake == chosen_;
    return is_chosen ? state_->cost : std::nullopt;
}

bool MistakeChoice::is_pending() const {
    return chosen_ != nullptr && (measured_ != last_ || is_working());
}

bool MistakeChoice::is_working() const {
    const std::lock_guard lock(state_->mutex);
    return state_->is_working;
}

nlohmann::ordered_json MistakeChoice::json() const {
    const std::optional<DrawnMistake> now = cost();
    nlohmann::ordered_json json = {{"chosen", nullptr}, {"cost", nullptr}};
    if (chosen_ != nullptr) json["chosen"] = chosen_->name;
    if (now) json["cost"] = cost_text(*now);
    return json;
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
