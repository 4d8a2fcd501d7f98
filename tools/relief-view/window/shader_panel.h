// SPDX-License-Identifier: Apache-2.0
/// \file
/// The shaders of the picture in the effects panel: the steps and mistakes of the picture, the
/// parts, which can be edited in place, the exercise, and the assembled programs. Tests:
/// tests/tools/window/effects_panel_test.cpp, shader_window_test.cpp.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "relief/shade/effects.h"
#include "window/lesson.h"
#include "window/shader_edits.h"

namespace relief::tools {

struct PanelInput;

/// Adds line numbers: " 1  #version 330 core".
std::string numbered_lines(const std::string& source);

/// Edits parts, and shows the programs, which are assembled once per plan.
class ShaderPanel {
  public:
    /// Starts the exercise of the options, if it is another one, and applies edits if typing has
    /// paused.
    /// \param now  in seconds
    void follow(const std::shared_ptr<const Exercise>& exercise, double now);

    void draw(const PanelInput& input);

    /// The edits, which the window applies to its pictures.
    [[nodiscard]] const ShaderEdits& edits() const { return edits_; }
    /// The step that the pictures show.
    [[nodiscard]] const StepChoice& steps() const { return steps_; }
    ExerciseCheck& exercise_check() { return check_; }
    /// The mistake that the pictures have.
    MistakeChoice& mistakes() { return mistakes_; }

    /// {"part", "messages", "saved", "steps", "mistake", "exercise", and the members of
    /// ShaderEdits::json()}
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    struct Program {
        std::string name;
        shade::ShaderListing listing;
        std::string vertex;  ///< With line numbers.
        std::string fragment;
    };
    void assemble(const shade::FramePlan& plan);
    static void draw_stage(const char* name, const std::string& source, std::string& numbered);
    void draw_programs();

    void draw_exercise();
    void draw_steps(const PanelInput& input);
    void draw_mistakes(const PanelInput& input);
    void select(const std::string& part);
    void draw_choice();
    void draw_editor(const std::string& error);
    void draw_code(const std::vector<LineMessage>& messages);
    void draw_files();

    ShaderEdits edits_;
    StepChoice steps_;
    MistakeChoice mistakes_;
    ExerciseCheck check_;
    std::shared_ptr<const Exercise> exercise_;
    double now_ = 0.0;

    std::vector<std::string> parts_;  ///< Of all programs; sorted.
    std::string part_;                ///< The one in the editor; empty: none.
    std::string text_;                ///< As it is in the editor.
    int cursor_line_ = 0;
    std::vector<LineMessage> messages_;
    bool shows_difference_ = false;
    std::string folder_ = ShaderEdits::default_folder().string();
    std::string saved_;  ///< A message about saved files.

    std::shared_ptr<const shade::FramePlan> plan_;
    std::shared_ptr<const shade::ShaderTexts> assembled_texts_;
    std::vector<Program> programs_;
    std::string error_;
};

}  // namespace relief::tools
