// SPDX-License-Identifier: Apache-2.0
/// \file
/// A small height field in double, and filters over it: what the choice of a kernel works on.
/// Heights in any unit. Tests: tests/mesh/accuracy/kernel_choice_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/bump.h"

namespace relief {

struct HeightTile {
    int width = 0;
    int height = 0;
    Wraps wrap;
    std::vector<double> values;
};

/// Symmetric weights, the middle one first, over both axes, `spacing` texels apart.
HeightTile filtered(const HeightTile& tile, std::span<const double> weights, int spacing = 1);

/// Slopes per texel, x to the right and y down, by differences of up to 12th order that never reach
/// across a cliff: beside one they are one-sided.
///
/// \param min_cliff  a change between neighbours of at least this is a cliff where it also is
///                     several times as large as any near it
struct TileSlopes {
    std::vector<glm::dvec2> slopes;
    std::vector<unsigned char> beside_cliff;  ///< 1 where a neighbour is across one.
};
/// \param has_exact_levels  every change of at least `min_cliff` is one
TileSlopes true_slopes(const HeightTile& tile, double min_cliff, bool has_exact_levels = false);

/// The slope by true_slopes() of a wave whose slope is `frequency`, in radians a texel.
double true_slope_response(double frequency);

/// Takes texels away that stick out on their own from all around them, as hot pixels do: each gets
/// the middle of its neighbors.
///
/// \param least  what sticks out by less stays
/// \return how far each one stuck out
std::vector<double> remove_spikes(HeightTile& tile, double least);

/// What is left of tiles in the highest frequencies, where it is least.
struct HighFrequencies {
    double deviation = 0.0;  ///< Of white noise that would leave as much: an upper bound for it.
    bool is_white = true;    ///< False where it grows towards the highest of all: a pattern.
};
HighFrequencies high_frequencies(std::span<const HeightTile> tiles);

/// Octaves of quiet_deviations(), and the middle frequency of each in radians a texel.
inline constexpr std::array quiet_frequencies = {2.61, 1.05, 0.49, 0.24};

using QuietDeviations = std::array<double, quiet_frequencies.size()>;

/// What the quietest fifth of the texels has in each octave, the highest first: the deviation of
/// white noise that would leave as much. Noise is in all texels, edges are in few.
QuietDeviations quiet_deviations(std::span<const HeightTile> tiles);

}  // namespace relief
