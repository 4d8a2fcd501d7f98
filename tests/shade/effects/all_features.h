// SPDX-License-Identifier: Apache-2.0
/// \file
/// Every set of effects, sensible or not, with up to two lights of each kind.
#pragma once

#include <functional>
#include <vector>

#include "relief/shade/effects.h"

namespace relief::test {

/// Calls visit with each: 2^12 switches, 3^3 light counts, 3 highlights, 3 codings.
inline void for_all_features(const std::function<void(const Features&)>& visit) {
    constexpr unsigned switches = 1U << 11U;
    for (unsigned bits = 0; bits < switches; ++bits) {
        const auto bit = [&](unsigned i) { return ((bits >> i) & 1U) != 0; };
        Features f;
        f.diffuse_texture = bit(0);
        f.vertex_colors = bit(1);
        f.normal_map = bit(2);
        f.double_sided = bit(3);
        f.unlit = bit(4);
        f.ambient = bit(5);
        f.diffuse = bit(6);
        f.light_ranges = bit(7);
        f.emission = bit(8);
        f.emission_texture = bit(9);
        f.reflection = bit(10);
        for (unsigned lights = 0; lights < 54; ++lights) {
            f.directional_lights = lights % 3;
            f.point_lights = lights / 3 % 3;
            f.spot_lights = lights / 9 % 3;
            f.lights_in_buffer = lights >= 27;
            for (unsigned rest = 0; rest < 9; ++rest) {
                f.specular = static_cast<SpecularTerm>(rest % 3);
                f.output = static_cast<OutputCoding>(rest / 3);
                visit(f);
            }
        }
    }
}

/// A small set of canonical features in which every value of every field meets every value of every
/// other field that it can meet; greedy, in a fixed order.
std::vector<Features> covering_features();

}  // namespace relief::test
