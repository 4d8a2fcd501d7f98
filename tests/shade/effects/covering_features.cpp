// SPDX-License-Identifier: Apache-2.0
// A covering set, found greedily over all canonical sets: first those that bring most new pairs.
#include <algorithm>
#include <array>
#include <set>

#include "all_features.h"

namespace relief::test {
namespace {

constexpr std::size_t field_count = 16;

std::array<unsigned, field_count> fields(const Features& f) {
    return {f.diffuse_texture,
            f.vertex_colors,
            f.normal_map,
            f.double_sided,
            f.unlit,
            f.ambient,
            f.directional_lights,
            f.point_lights,
            f.spot_lights,
            f.diffuse,
            static_cast<unsigned>(f.specular),
            f.light_ranges,
            f.lights_in_buffer,
            static_cast<unsigned>(f.emission) + static_cast<unsigned>(f.emission_texture),
            f.reflection,
            static_cast<unsigned>(f.output)};
}

/// Field values are at most 2, so a pair of fields with their values has a number below this.
constexpr std::size_t pair_count = field_count * field_count * 9;

std::vector<std::size_t> pairs(const Features& f) {
    const auto values = fields(f);
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < field_count; ++i) {
        for (std::size_t j = i + 1; j < field_count; ++j) {
            result.push_back((i * field_count + j) * 9 + values[i] * 3 + values[j]);
        }
    }
    return result;
}

}  // namespace

std::vector<Features> covering_features() {
    std::set<Features> canonical_sets;
    for_all_features([&](const Features& f) { canonical_sets.insert(canonical(f)); });
    std::vector<bool> covered(pair_count, false);
    std::vector<Features> chosen;
    // Passes with a falling bar: cheaper than the true greedy choice, and nearly as small.
    for (std::size_t bar = 100; bar > 0; bar = bar > 8 ? bar / 2 : bar - 1) {
        for (const Features& f : canonical_sets) {
            const std::vector<std::size_t> all = pairs(f);
            const auto fresh = static_cast<std::size_t>(std::count_if(
                all.begin(), all.end(), [&](std::size_t pair) { return !covered[pair]; }));
            if (fresh < bar) continue;
            for (const std::size_t pair : all)
                covered[pair] = true;
            chosen.push_back(f);
        }
    }
    return chosen;
}

}  // namespace relief::test
