// SPDX-License-Identifier: Apache-2.0
/// \file
/// The words for how height and normal maps are made and read, the same in every tool.
#pragma once

#include "common/options.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

inline Choices<Kernel> kernel_choices() {
    return {{"central3", Kernel::central3}, {"sobel3", Kernel::sobel3}};
}

inline Choices<Wrap> wrap_choices() {
    return {{"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}};
}

inline Choices<Green> green_choices() {
    return {{"up", Green::up}, {"down", Green::down}};
}

inline Choices<FlatCode> flat_choices() {
    return {{"middle", FlatCode::middle}, {"half", FlatCode::half}};
}

}  // namespace relief::tools
