// SPDX-License-Identifier: Apache-2.0
/// \file
/// What panels are made of: lists to choose from and sliders, which mark their places (places.h).
/// Tests: tests/tools/window/panels_test.cpp.
#pragma once

#include <initializer_list>

namespace relief::tools {

/// A list of which one is chosen. Its entries are places while it is open: "Kind: Spot".
/// \return whether another one was chosen
bool choose_index(const char* label, int& index, std::initializer_list<const char*> names);

/// The same for an enumeration whose values are in the names' order.
template <typename Choice>
bool choose(const char* label, Choice& choice, std::initializer_list<const char*> names) {
    int index = static_cast<int>(choice);
    const bool changed = choose_index(label, index, names);
    choice = static_cast<Choice>(index);
    return changed;
}

/// Typed numbers stay within the limits, too.
struct Slider {
    float least = 0.0F;
    float most = 1.0F;
    const char* format = "%.3f";  ///< As printf's, with the unit.
    bool is_logarithmic = false;
};

/// \return whether the value changed
bool slide(const char* label, float& value, const Slider& slider = {});

/// For what has no upper limit worth a slider: dragged, by `step` a pixel; never below 0.
bool drag_up(const char* label, float& value, float step = 0.01F);

}  // namespace relief::tools
