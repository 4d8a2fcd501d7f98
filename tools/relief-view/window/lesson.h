// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lessons in the window: the steps of the picture, and the result of an exercise. This part uses
/// no window. Tests: tests/tools/window/lesson_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exercise.h"
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
