// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lessons in the window: the steps of the picture, the mistakes that it can have, and the result
/// of an exercise. This part uses no window. Tests: tests/tools/window/shader_edits_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exercise.h"
#include "mistake_pictures.h"
#include "relief/shade/picture_steps.h"
#include "window/background_jobs.h"

namespace relief::tools {

/// The steps of the picture, one of which can be shown.
class StepChoice {
  public:
    /// Finds the steps of a scene, unless they are known. The last one is shown then.
    void follow(const std::shared_ptr<const shade::Scene>& scene,
                const shade::FrameSettings& settings);

    [[nodiscard]] const std::vector<shade::PictureStep>& steps() const { return steps_; }
    /// The index of the step that is shown.
    [[nodiscard]] std::size_t shown() const { return shown_; }
    void show(std::size_t step) { shown_ = step; }

    /// Returns the step that is shown; null for the last one, which is the whole picture.
    [[nodiscard]] const shade::PictureStep* chosen() const;

    /// {"names", "shown"}
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    std::shared_ptr<const shade::Scene> scene_;
    std::vector<shade::PictureStep> steps_;
    std::size_t shown_ = 0;
};

/// The mistake that the picture has, if any, and what it costs as the camera sees it.
class MistakeChoice {
  public:
    /// The mistake that was chosen; null: none.
    [[nodiscard]] const shade::Mistake* chosen() const { return chosen_; }
    void choose(const shade::Mistake* mistake) { chosen_ = mistake; }

    /// Returns the texts and the scene with the mistake; the same ones without a mistake. The last
    /// result is kept. The texts of a mistake are always another object, so that the picture is
    /// drawn again.
    std::shared_ptr<const shade::ShaderTexts> texts(
        const std::shared_ptr<const shade::ShaderTexts>& right);
    std::shared_ptr<const shade::Scene> scene(const std::shared_ptr<const shade::Scene>& right);

    /// Returns the work for the drawing thread if there is a new cost to measure, the picture is at
    /// rest, and no other cost is being measured.
    ///
    /// \param right  the request of the picture without the mistake
    /// \param now    in seconds
    std::optional<DrawTask> begin(const DrawRequest& right, double now);

    /// The last cost; none before the first, and while it is not that of the chosen mistake.
    [[nodiscard]] std::optional<DrawnMistake> cost() const;
    /// Returns whether a cost is being measured, or will be when the picture is at rest.
    [[nodiscard]] bool is_pending() const;

    /// {"chosen", "cost"}: a name and cost_text(), or null.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    struct State {
        mutable std::mutex mutex;
        bool is_working = false;
        std::optional<DrawnMistake> cost;
    };
    [[nodiscard]] bool is_working() const;
    /// The values that a cost depends on.
    struct Subject {
        const shade::Mistake* mistake = nullptr;
        std::uint64_t revision = 0;
        std::uint64_t pose = 0;
        shade::Camera camera;
        int width = 0;
        int height = 0;

        bool operator==(const Subject&) const = default;
    };

    const shade::Mistake* chosen_ = nullptr;
    std::shared_ptr<State> state_ = std::make_shared<State>();
    std::optional<Subject> measured_;
    std::optional<Subject> last_;
    double changed_ = 0.0;  ///< The time of the last change of the subject.

    const shade::Mistake* of_texts_ = nullptr;
    std::shared_ptr<const shade::ShaderTexts> right_texts_;
    std::shared_ptr<const shade::ShaderTexts> wrong_texts_;
    const shade::Mistake* of_scene_ = nullptr;
    std::shared_ptr<const shade::Scene> right_scene_;
    std::shared_ptr<const shade::Scene> wrong_scene_;
};

/// Compares the picture of an exercise with that of its solution, as the command line does: in the
/// size and with the camera of the exercise's scene.
class ExerciseCheck {
  public:
    /// Returns the work for the drawing thread if there is something new to compare, and no other
    /// comparison is under way.
    ///
    /// \param request  for the scene, the texts of the shaders and the camera of a scene without
    ///                 one
    /// \param size     of the picture in pixels
    std::optional<DrawTask> begin(const std::shared_ptr<const Exercise>& exercise,
                                  const DrawRequest& request, const glm::ivec2& size);

    /// The last result; none before the first, or if the last attempt could not be drawn.
    [[nodiscard]] std::optional<ExerciseResult> result() const;
    [[nodiscard]] bool is_working() const;

    /// The numbers, or null.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    struct State {
        mutable std::mutex mutex;
        bool is_working = false;
        std::optional<ExerciseResult> result;
    };
    std::shared_ptr<State> state_ = std::make_shared<State>();
    std::optional<std::uint64_t> checked_;  ///< The revision of the last comparison.
};

}  // namespace relief::tools
