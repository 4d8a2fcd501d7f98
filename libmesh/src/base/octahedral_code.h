// SPDX-License-Identifier: Apache-2.0
/// \file
/// Octahedral encoding: unit vectors as two small integers, the coordinates on an octahedron that
/// is unfolded into a square [Cigolle et al. 2014]. Integers are unfolded exactly, so that all
/// decoders agree about the face of a vector.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <glm/glm.hpp>
#include <limits>

namespace relief::detail {

/// Rounds to the nearest integer, halves away from 0. Casts are faster: without SSE 4.1, std::round
/// and std::floor are calls.
inline int rounded_to_int(double value) {
    return static_cast<int>(value + (value < 0.0 ? -0.5 : 0.5));
}

/// Rounds down.
inline int floor_to_int(double value) {
    const int whole = static_cast<int>(value);
    return value < whole ? whole - 1 : whole;
}

/// Both are within [-M, M]; M, the largest code, is 127, 511 or 32767.
struct OctahedralCode {
    int x = 0;
    int y = 0;
};

/// Returns the direction of a code; not of unit length, but never 0.
inline glm::dvec3 octahedral_direction(OctahedralCode code, int largest) {
    const int z = largest - std::abs(code.x) - std::abs(code.y);
    if (z >= 0) return {code.x, code.y, z};
    const int x = (largest - std::abs(code.y)) * (code.x < 0 ? -1 : 1);
    const int y = (largest - std::abs(code.x)) * (code.y < 0 ? -1 : 1);
    return {x, y, z};
}

/// Returns the coordinates of a unit vector in the square, in codes, before rounding.
inline glm::dvec2 octahedral_place(const glm::dvec3& unit, int largest) {
    const glm::dvec3 size = glm::abs(unit);
    const double scale = largest / (size.x + size.y + size.z);
    if (unit.z >= 0.0) return {unit.x * scale, unit.y * scale};
    return {(largest - size.y * scale) * (unit.x < 0.0 ? -1.0 : 1.0),
            (largest - size.x * scale) * (unit.y < 0.0 ? -1.0 : 1.0)};
}

/// Returns the code with the least error(code) among those around a place: the two nearest values
/// of each coordinate. If `parity` is 0 or 1, the lowest bit of y must equal it.
template <typename Error>
OctahedralCode best_code(const glm::dvec2& place, int largest, int parity, Error error) {
    const int left = floor_to_int(place.x);
    const int below = floor_to_int(place.y);
    // Values of one parity are at most two steps away on each side.
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

/// Returns the nearest code to a place. If `parity` is 0 or 1, the lowest bit of y must equal it.
inline OctahedralCode nearest_code(const glm::dvec2& place, int largest, int parity) {
    OctahedralCode code{rounded_to_int(place.x), rounded_to_int(place.y)};
    if (parity < 0 || (code.y & 1) == parity) return code;
    code.y += place.y < code.y ? -1 : 1;
    // The largest code is odd, so y exceeds it only if it had to be even.
    if (std::abs(code.y) > largest) code.y += code.y > 0 ? -2 : 2;
    return code;
}

}  // namespace relief::detail
