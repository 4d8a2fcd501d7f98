// SPDX-License-Identifier: Apache-2.0
/// \file
/// What relief-view did, in words and as JSON. Tests: tests/tools/relief_view_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "common/findings.h"
#include "effect_options.h"
#include "picture_comparison.h"
#include "picture_reference.h"
#include "scene_options.h"
#include "sequence.h"
#include "view_options.h"

namespace relief::tools {

/// Finished pictures, and with what they were drawn.
struct Drawn {
    Frame frame;  ///< The last.
    SequenceTimes times;
    std::string backend;
    std::string renderer;
    std::optional<ReferenceComparison> comparison;
    std::optional<PictureComparison> sides;  ///< Of --compare.
    FrameMeasures measures;
};

void print_summary(const ViewOptions& options, const ComposedScene& composed, const Drawn& drawn,
                   const Findings& findings, const Stages& stages);

nlohmann::ordered_json summary_json(const ViewOptions& options, const ComposedScene& composed,
                                    const Findings& findings, const Stages& stages);

nlohmann::ordered_json picture_json(const ViewOptions& options, const Drawn& drawn);

}  // namespace relief::tools
