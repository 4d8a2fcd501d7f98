// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the draws of a frame look up of the environment: for the plan, which says so, and for the
/// renderer, which makes it, also where draws were changed by hand.
/// Tests: tests/shade/effects/plan_test.cpp.
#pragma once

#include "relief/shade/effects.h"

namespace relief {

struct EnvironmentNeeds {
    bool sharp = false;       ///< Mirrored as it is, or seen through a surface.
    bool blurred = false;     ///< By rough surfaces.
    bool irradiance = false;  ///< Scattered.
    bool brdf = false;        ///< GGX's directional albedo, for metallic-roughness.

    [[nodiscard]] bool any() const { return sharp || blurred || irradiance; }
};

EnvironmentNeeds environment_needs(const FramePlan& plan);

}  // namespace relief
