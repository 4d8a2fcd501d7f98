// SPDX-License-Identifier: Apache-2.0
/// \file
/// The choices and the shader source in the effects panel. Tests:
/// tests/tools/window/effects_panel_test.cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "relief/shade/effects.h"

namespace relief::tools {

/// Adds line numbers: " 1  #version 330 core".
std::string numbered_lines(const std::string& source);

/// The choice for an effect. 0: automatic, 1: forced on, 2: forced off.
int forced_choice(const shade::EffectRequest& requests, const std::string& name);

/// The requests with this choice for one effect.
shade::EffectRequest with_forced_choice(shade::EffectRequest requests, const std::string& name,
                                        int choice);

/// The shader source of each program, assembled once per plan.
class ShaderPanel {
  public:
    void draw(const std::shared_ptr<const shade::FramePlan>& plan);

  private:
    struct Program {
        std::string name;
        shade::ShaderListing listing;
        std::string vertex;  ///< With line numbers.
        std::string fragment;
    };
    void assemble(const shade::FramePlan& plan);
    static void draw_stage(const char* name, const std::string& source, std::string& numbered);

    std::shared_ptr<const shade::FramePlan> plan_;
    std::vector<Program> programs_;
    std::string error_;
};

}  // namespace relief::tools
