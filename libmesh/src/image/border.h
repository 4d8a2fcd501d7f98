// SPDX-License-Identifier: Apache-2.0
/// \file
/// Places beyond the border of an image, along one axis. Tests:
/// tests/mesh/image/bump/bump_test.cpp.
#pragma once

#include <algorithm>

#include "relief/mesh/bump.h"

namespace relief {

/// The place within [0, count) that is read for any place: clamped to the edge for Wrap::clamp.
inline int place_within(int place, int count, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(place, 0, count - 1);
    const int period = wrap == Wrap::mirror ? 2 * count : count;
    const int rest = (place % period + period) % period;
    return rest < count ? rest : period - 1 - rest;
}

/// What a clamped quantity goes on as beyond its border: point-reflected at the border value, so
/// that a plane goes on as a plane. `at(place)` gives values within; a single one goes on as is.
template <typename At>
auto reflected(int place, int count, const At& at) -> decltype(at(0)) {
    if (place >= 0 && place < count) return at(place);
    if (count == 1) return at(0);
    const int edge = place < 0 ? 0 : count - 1;
    return 2 * at(edge) - reflected(2 * edge - place, count, at);
}

}  // namespace relief
