// SPDX-License-Identifier: Apache-2.0
/// \file
/// Frames of the panels in Dear ImGui without a window: tests set the size, the scale and the
/// input, and read the places and the text of what was drawn.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "tools/workplace.h"
#include "window/comparison.h"
#include "window/controls.h"
#include "window/effects_panel.h"
#include "window/panels.h"
#include "window/scene_accuracy.h"
#include "window/shader_panel.h"

namespace relief::test {

class PanelFrames {
  public:
    PanelFrames();
    ~PanelFrames();
    PanelFrames(const PanelFrames&) = delete;
    PanelFrames& operator=(const PanelFrames&) = delete;

    /// Shows a model or a scene of the workplace.
    void show(const Workplace& workplace, const std::string& model);
    /// Shows a scene as if it had been read.
    void show(shade::Scene scene);

    void set_size(const glm::ivec2& size, float scale = 1.0F);

    /// Draws frames until Dear ImGui has settled. \return the requests of the first one
    tools::PanelRequests draw();
    tools::PanelRequests draw_once();

    /// Scrolls the panels to a tree node and clicks on it. The test fails if it is not there.
    void open_tree(const std::string& name);

    /// The place of an item. The test fails if it is not visible.
    [[nodiscard]] glm::vec2 place(const std::string& name) const;
    [[nodiscard]] bool has(const std::string& name) const;
    /// By how much the content of the panels is wider than their space.
    [[nodiscard]] float excess_width() const;

    // Input.
    tools::PanelRequests click(const glm::vec2& place);
    tools::PanelRequests click(const std::string& name) { return click(place(name)); }
    void type(const std::string& characters);
    /// Presses a key of Dear ImGui (ImGuiKey_).
    void press(int key);

    tools::ViewerState& state() { return state_; }
    tools::WindowLayout& layout() { return layout_; }
    tools::RenderedPicture& drawn() { return drawn_; }
    tools::HelpWindow& help() { return help_; }
    tools::FileDialog& dialog() { return dialog_; }
    [[nodiscard]] const tools::PanelSpace& space() const { return space_; }

    bool are_open = true;  ///< Folded panels.
    bool is_drawing = false;
    const tools::ViewOptions* loading = nullptr;
    Progress::State progress;

  private:
    tools::ViewerState state_{tools::ViewOptions{}};
    tools::WindowLayout layout_;
    tools::RenderedPicture drawn_;
    tools::EffectTimes effect_times_;
    tools::ShaderPanel shaders_;
    tools::Comparison comparison_;
    tools::SceneAccuracy accuracy_;
    tools::CaptureSettings capture_;
    tools::HelpWindow help_;
    tools::FileDialog dialog_;
    tools::ImagePreviews previews_;
    tools::PanelSpace space_;
    int shown_ = 0;
};

}  // namespace relief::test
