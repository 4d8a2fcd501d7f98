// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the command line says about effects: --effects, --benchmark, --budget, --print-shaders.
/// Tests: tests/tools/effect_options_test.cpp.
#pragma once

#include <optional>

#include "relief/shade/effect_forcing.h"

namespace relief::tools {

struct EffectChoices {
    EffectWishes wishes;           ///< --effects
    std::optional<int> benchmark;  ///< Frames to time.
    std::optional<double> budget;  ///< Milliseconds that a frame may take.
    bool print_shaders = false;

    /// Frames are drawn even if no picture is written.
    [[nodiscard]] bool measures() const { return benchmark || budget; }
};

}  // namespace relief::tools
