// SPDX-License-Identifier: Apache-2.0
// Products stay below 2^52 for rows of up to 65536 texels.
// Tests: tests/mesh/bake/nearest_columns_test.cpp.
#include "bake/nearest_columns.h"

namespace relief {

void NearestColumns::add(int column, int distance) {
    const Parabola added{column, std::int64_t{distance} * distance};
    while (parabolas_.size() >= 2) {
        const Parabola& last = parabolas_.back();
        const Crossing begins = crossing(parabolas_[parabolas_.size() - 2], last);
        const Crossing ends = crossing(last, added);
        // One that is lowest in a single point stays: it is as near there as its neighbours.
        if (ends.numerator * begins.denominator >= begins.numerator * ends.denominator) break;
        parabolas_.pop_back();
    }
    parabolas_.push_back(added);
}

std::int64_t NearestColumns::squared_distance(int column) {
    while (current_ + 1 < parabolas_.size()) {
        const Crossing end = crossing(parabolas_[current_], parabolas_[current_ + 1]);
        if (end.numerator >= column * end.denominator) break;
        ++current_;
    }
    const Parabola& lowest = parabolas_[current_];
    return (column - lowest.column) * (column - lowest.column) + lowest.squared;
}

}  // namespace relief
