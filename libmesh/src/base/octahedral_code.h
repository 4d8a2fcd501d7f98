// SPDX-License-Identifier: Apache-2.0
/// \file
/// Unit vectors as two small integers: places on an octahedron that is unfolded into a square
/// [Cigolle et al. 2014]. Integers are unfolded exactly, so that every decoder agrees about which
/// face a vector is on. Tests: tests/mesh/geometry/encoding/frame_encoding_test.cpp.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <glm/glm.hpp>
#include <limits>

namespace relief {

/// The nearest whole number, halves away from 0. Plain casts: without SSE 4.1, std::round and
/// std::floor are calls.
inline int rounded_to_int(double value) {
    return static_cast<int>(value + (value < 0.0 ? -0.5 : 0.5));
}

/// The largest whole number that is no larger.
inline int floor_to_int(double value) {
    const int whole = static_cast<int>(value);
    return value < whole ? whole - 1 : whole;
}

/// Each from -M to M, where M is the largest code: 127, 511 or 32767.
struct OctahedralCode {
    int x = 0;
    int y = 0;
};

/// What a code stands for; not of unit length, never 0.
inline glm::dvec3 octahedral_direction(OctahedralCode code, int largest) {
    const int z = largest - std::abs(code.x) - std::abs(code.y);
    if (z >= 0) return {code.x, code.y, z};
    const int x = (largest - std::abs(code.y)) * (code.x < 0 ? -1 : 1);
    const int y = (largest - std::abs(code.x)) * (code.y < 0 ? -1 : 1);
    return {x, y, z};
}

/// Where a vector's place in the square is, in codes, before rounding.
inline glm::dvec2 octahedral_place(const glm::dvec3& unit, int largest) {
    const glm::dvec3 size = glm::abs(unit);
    const double scale = largest / (size.x + size.y + size.z);
    if (unit.z >= 0.0) return {unit.x * scale, unit.y * scale};
    return {(largest - size.y * scale) * (unit.x < 0.0 ? -1.0 : 1.0),
            (largest - size.x * scale) * (unit.y < 0.0 ? -1.0 : 1.0)};
}

/// Of the codes around a place (the two nearest of each coordinate; of y, those whose lowest bit is
/// `parity` where that is 0 or 1), the one with the least error(code).
template <typename Error>
OctahedralCode best_code(const glm::dvec2& place, int largest, int parity, Error error) {
    const int left = floor_to_int(place.x);
    const int below = floor_to_int(place.y);
    // Of a parity there is one on each side within two steps.
    const bool any = parity < 0;
    OctahedralCode best{};
    double least = std::numeric_limits<double>::infinity();
    for (int x = left; x <= left + 1; ++x) {
        for (int y = any ? below : below - 1; y <= (any ? below + 1 : below + 2); ++y) {
            const bool fits = std::abs(x) <= largest && std::abs(y) <= largest;
            if (!fits || (!any && (y & 1) != parity)) continue;
            const double found = error(OctahedralCode{x, y});
            if (found < least) {
                least = found;
                best = {x, y};
            }
        }
    }
    return best;
}

/// The code next to a place; y's lowest bit is `parity` where that is 0 or 1.
inline OctahedralCode nearest_code(const glm::dvec2& place, int largest, int parity) {
    OctahedralCode code{rounded_to_int(place.x), rounded_to_int(place.y)};
    if (parity < 0 || (code.y & 1) == parity) return code;
    code.y += place.y < code.y ? -1 : 1;
    // The largest code is odd: what steps over it was to be even.
    if (std::abs(code.y) > largest) code.y += code.y > 0 ? -2 : 2;
    return code;
}

}  // namespace relief
