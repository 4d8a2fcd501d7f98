// SPDX-License-Identifier: Apache-2.0
/// \file
/// The shaders that draw the picture, to read: both stages of each program, with line numbers.
/// Tests: tests/tools/window/shader_panel_test.cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/shader_listing.h"

namespace relief::tools {

/// Each line with its number before it: " 1  #version 330 core".
std::string numbered_lines(const std::string& source);

/// Sources are put together once for each plan.
class ShaderPanel {
  public:
    void draw(const std::shared_ptr<const FramePlan>& plan);

  private:
    struct Program {
        std::string name;
        ShaderListing listing;
        std::string vertex;  ///< With numbers.
        std::string fragment;
    };
    void assemble(const FramePlan& plan);
    static void draw_stage(const char* name, const std::string& source, std::string& numbered);

    std::shared_ptr<const FramePlan> plan_;
    std::vector<Program> programs_;
    std::string error_;
};

}  // namespace relief::tools
