// SPDX-License-Identifier: Apache-2.0
/// \file
/// What baked maps are good for, to look at: where they are off, and the low mesh with its map
/// beside the high one. Tests: tests/accuracy/bake_experiments_test.cpp.
#pragma once

#include <span>

#include "bake/bumpy_bake.h"

namespace relief {

/// One finished map.
struct BakedMap {
    BakeWay way;
    NormalMapFormat format;
};

/// Adds to the experiment where each map errs. \param brightest  degrees that are shown brightest
void add_error_maps(const BumpyBake& bake, std::span<const BakedMap> maps, double brightest,
                    Experiment& experiment);

/// Adds a pair of pictures for each map: the low mesh with it, and the high mesh. Both by the
/// reference shader: no OpenGL is needed.
void add_renderings(const BumpyBake& bake, std::span<const BakedMap> maps, Experiment& experiment);

}  // namespace relief
