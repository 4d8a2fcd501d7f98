// SPDX-License-Identifier: Apache-2.0
/// \file
/// Exercises: a scene, a part of a shader with a hole, and its solution (--exercise).
/// docs/exercises.md describes the format. Tests: tests/tools/exercise_test.cpp.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/summary.h"
#include "picture_comparison.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/shader_texts.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

/// An exercise as its file describes it.
struct Exercise {
    std::filesystem::path file;
    std::string title;
    std::string task;
    std::vector<std::string> hints;
    std::filesystem::path scene;
    std::string part;   ///< The address of the part to complete: "phong.glsl#phong".
    std::string start;  ///< Its text with the hole.
    /// Its completed text; the part that is built in if it is absent.
    std::optional<std::string> solution;
    std::optional<std::filesystem::path> reference;  ///< The picture of the solution, instead.
    double max_flip = 0.001;                         ///< A solution has at most this FLIP.
};

/// \throws FileError if a file is missing or invalid; problems of the exercise are named by their
///         JSON pointer
Exercise read_exercise(const std::filesystem::path& file);

/// The text with which a picture of the exercise is drawn.
struct Attempt {
    /// Null: the parts of $RELIEF_SHADER_DIR, which holds the part of the exercise.
    std::shared_ptr<const shade::ShaderTexts> texts;
    [[nodiscard]] bool is_start() const { return texts != nullptr; }
};

/// Returns the part in $RELIEF_SHADER_DIR, or else the start.
/// \throws GpuError if a file there is malformed
Attempt attempt_at(const Exercise& exercise);

/// Returns the texts of the solution, which $RELIEF_SHADER_DIR does not change.
shade::ShaderTexts solution_of(const Exercise& exercise);

void add_exercise_options(CLI::App& app, ViewOptions& options);

/// Reads the exercise of the options, and makes its scene the model.
/// \throws FileError, UsageError
void settle_exercise(ViewOptions& options);

/// The difference from the solution.
struct ExerciseResult : PictureComparison {
    double allowed = 0;  ///< Exercise::max_flip

    [[nodiscard]] bool is_solved() const { return flip.mean <= allowed; }
};

/// Draws the solution, or reads its picture, and compares.
///
/// \param settings, plan, scene, camera  those of the picture
/// \throws FileError if the reference cannot be read or has another size, or if no program of the
///         plan has the part of the exercise
ExerciseResult compare_with_solution(const Exercise& exercise, const shade::FrameSettings& settings,
                                     const shade::FramePlan& plan, const shade::Scene& scene,
                                     const shade::Camera& camera, const shade::Context& context,
                                     const Image& picture);

/// Adds a finding if the exercise is not solved.
void report_result(const ExerciseResult& result, Report& report);

/// For example "FLIP 0.0213 (largest 0.61): not solved, a solution has at most 0.001".
std::string result_text(const ExerciseResult& result);

/// Adds the member "exercise": {"file", "title", "part", "from", "solved", "allowed"} and the
/// members of numbers_json().
void add_exercise(Summary& summary, const Exercise& exercise, const ExerciseResult& result);

}  // namespace relief::tools
