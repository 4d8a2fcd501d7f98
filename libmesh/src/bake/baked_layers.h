// SPDX-License-Identifier: Apache-2.0
/// \file
/// The layers that rows of a bake may hold: the one list of them, by which they are stored, padded
/// and handed on. Tests: tests/mesh/bake/bake_layers_test.cpp.
#pragma once

#include <array>

#include "relief/mesh/bake.h"

namespace relief {

struct BakedLayer {
    std::span<float> BakedRows::*values;
    std::size_t channels;
    bool has_directions;  ///< Averaged as such, and unit.
    bool (*is_wanted)(const BakeLayers& layers);
};

inline constexpr std::array baked_layers = {
    BakedLayer{&BakedRows::normals, 3, true, [](const BakeLayers& l) { return l.normals; }},
    BakedLayer{&BakedRows::heights, 1, false, [](const BakeLayers& l) { return l.heights; }},
    BakedLayer{&BakedRows::occlusion, 1, false,
               [](const BakeLayers& l) { return l.occlusion.has_value(); }},
    BakedLayer{&BakedRows::curvature, 1, false, [](const BakeLayers& l) { return l.curvature; }},
    BakedLayer{&BakedRows::positions, 3, false, [](const BakeLayers& l) { return l.positions; }},
    BakedLayer{&BakedRows::colors, 3, false, [](const BakeLayers& l) { return l.colors; }},
};

}  // namespace relief
