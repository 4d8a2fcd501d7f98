// SPDX-License-Identifier: Apache-2.0
/// \file
/// What flat may be stored as.
#pragma once

#include "relief/mesh/normal_map.h"

namespace relief::test {

inline constexpr FlatCode both_codes[] = {FlatCode::middle, FlatCode::half};

}  // namespace relief::test
