// SPDX-License-Identifier: Apache-2.0
/// \file
/// Two finished pictures beside each other in the view, a line between them, and what is where.
/// Dragging the line draws no scene. Tests: tests/tools/window/compare_window_test.cpp.
#pragma once

#include <glm/vec2.hpp>

#include "relief/shade/handover.h"
#include "window/comparison.h"

namespace relief::tools {

/// Where the view is, in the interface's units.
struct ViewPlace {
    glm::vec2 min{0.0F};
    glm::vec2 max{0.0F};
};

/// One picture, all of the view.
void draw_picture(const Handover::Shown& picture, const ViewPlace& place);

/// Two pictures. \return where the line is: its x in the interface's units
float draw_sides(const Handover::Shown& picture, const ViewPlace& place,
                 const Comparison& comparison);

/// The picture of their difference, and what it is.
void draw_difference(const Handover::Shown& picture, const ViewPlace& place,
                     const Comparison& comparison);

}  // namespace relief::tools
