// SPDX-License-Identifier: Apache-2.0
/// \file
/// The choices in the effects panel. Tests:
/// tests/tools/window/effects_panel_test.cpp.
#pragma once

#include <string>

#include "relief/shade/effects.h"

namespace relief::tools {

/// The choice for an effect. 0: automatic, 1: forced on, 2: forced off.
int forced_choice(const shade::EffectRequest& requests, const std::string& name);

/// The requests with this choice for one effect.
shade::EffectRequest with_forced_choice(shade::EffectRequest requests, const std::string& name,
                                        int choice);

}  // namespace relief::tools
