// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is done to the normals of a map once they are decoded, as a list of steps in their fixed
/// order. A new operation is a new step here and an option in convert_options.
/// Tests: tests/tools/convert_test.cpp.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "convert/convert_options.h"
#include "relief/mesh/normal_map_operations.h"
#include "relief/mesh/report.h"

namespace relief::tools {

/// For maps of the other green.
inline constexpr AxisMapping flip_green = {{{0, false}, {1, true}, {2, false}}};

/// A map between its input's codes and its output's.
struct NormalField {
    Image normals;               ///< Three float channels, unit.
    std::optional<Image> alpha;  ///< One float channel of the same size, if there is one to keep.
    /// Where y points: up or down in the image; absent where nobody knows. It is the output's
    /// already.
    std::optional<Green> green;
    bool is_object_space = false;  ///< Then nothing is green.
    std::string note;              ///< What the last step has to add to its words.
};

struct ConvertStep {
    std::string words;  ///< For the summary: "slopes times 2".
    std::function<void(NormalField& field, Report& report)> apply;
};

/// The steps that a request asks for, in the order in which they are done: from object space, size,
/// slopes, detail, to object space.
std::vector<ConvertStep> steps_of(const ConvertRequest& request);

}  // namespace relief::tools
