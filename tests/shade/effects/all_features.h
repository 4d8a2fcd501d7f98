// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sets of effects, sensible or not: each field of Features with its values, random sets, and a
/// small set of sets in which every pair of values meets.
#pragma once

#include <functional>
#include <random>
#include <vector>

#include "relief/shade/effects.h"

namespace relief::test {

/// One field of Features as a number below `count`; light counts have 0, 1 and 2.
struct FeatureField {
    const char* name;
    unsigned count;
    unsigned (*get)(const Features& f);
    void (*set)(Features& f, unsigned value);
};

const std::vector<FeatureField>& feature_fields();

/// Every field with a value of its own chance; unlit, which drops nearly all others, is rare.
Features random_features(std::mt19937& random);

/// Calls visit with that many random sets, always the same.
void for_random_features(std::size_t count, const std::function<void(const Features&)>& visit);

/// A small set of canonical features in which every value of every field meets every value of every
/// other field that it can meet (as far as 40,000 random sets tell); greedy, in a fixed order.
const std::vector<Features>& covering_features();

}  // namespace relief::test
