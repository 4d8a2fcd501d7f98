// SPDX-License-Identifier: Apache-2.0
/// \file
/// The words for modes of normals and tangents, as options take them and reports print them.
#pragma once

#include "common/options.h"
#include "relief/mesh/frames.h"

namespace relief::tools {

inline Choices<NormalMode> normal_choices() {
    return {{"keep", NormalMode::keep},
            {"flat", NormalMode::flat},
            {"auto", NormalMode::automatic},
            {"uniform", NormalMode::uniform},
            {"area", NormalMode::area},
            {"angle", NormalMode::angle},
            {"sine", NormalMode::sine},
            {"max", NormalMode::max},
            {"angle-edges", NormalMode::angle_edges},
            {"area-angle", NormalMode::area_angle}};
}

inline Choices<TangentMode> tangent_choices() {
    return {{"keep", TangentMode::keep},
            {"none", TangentMode::none},
            {"mikktspace", TangentMode::mikktspace},
            {"area-weighted", TangentMode::area_weighted},
            {"lengyel", TangentMode::lengyel}};
}

}  // namespace relief::tools
