// SPDX-License-Identifier: Apache-2.0
/// \file
/// Questions about a set of effects that planning, shader assembly and drawing share. Pure.
/// Tests: tests/shade/effects/effects_test.cpp.
#pragma once

#include "relief/shade/effects.h"

namespace relief {

/// The number of directional, point and spot lights.
inline std::uint32_t light_count(const Features& f) {
    return f.directional_lights + f.point_lights + f.spot_lights;
}

/// True if the view is a term that reflections only dim: no mirror image is looked up.
inline bool has_black_mirror(const Features& f) {
    return is_term(f.view) && f.view != DebugView::reflection;
}

/// True if the view is a term that refraction only dims.
inline bool has_black_transmission(const Features& f) {
    return is_term(f.view) && f.view != DebugView::refraction;
}

/// True if the view shows a vector of the tangent frame.
inline bool shows_frame(const Features& f) {
    return f.view == DebugView::tangent || f.view == DebugView::bitangent ||
           f.view == DebugView::handedness;
}

/// True if the view shows a normal.
inline bool shows_normal(const Features& f) {
    return f.view == DebugView::geometric_normal || f.view == DebugView::shading_normal;
}

/// The forms of the environment that a frame's draws look up. The plan reports them; the renderer
/// prepares them, also for draws that were changed by hand.
struct EnvironmentNeeds {
    bool sharp = false;       ///< Mirrored without blur, or seen through a surface.
    bool blurred = false;     ///< Mirrored by rough surfaces.
    bool irradiance = false;  ///< Scattered.
    bool brdf = false;        ///< GGX's directional albedo, for metallic-roughness.

    [[nodiscard]] bool any() const { return sharp || blurred || irradiance; }
};

EnvironmentNeeds environment_needs(const FramePlan& plan);

}  // namespace relief
