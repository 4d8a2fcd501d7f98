// SPDX-License-Identifier: Apache-2.0
/// \file
/// A small height field in double precision, with filters and noise estimators for the choice of a
/// kernel. Heights have any unit. Tests: tests/mesh/bump/kernel_choice_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/bump.h"

namespace relief {

/// A height field, stored row by row.
struct HeightTile {
    int width = 0;
    int height = 0;
    Wraps wrap;
    std::vector<double> values;
};

/// Applies a separable symmetric filter along both axes.
///
/// \param weights  the center weight first
/// \param spacing  distance of the filter taps in texels
HeightTile filtered(const HeightTile& tile, std::span<const double> weights, int spacing = 1);

/// The derivatives of a tile.
struct TileSlopes {
    std::vector<glm::dvec2> slopes;          ///< Per texel, x to the right and y down.
    std::vector<unsigned char> beside_edge;  ///< 1 if a step edge separates a neighbor.
};

/// Computes slopes by central differences of up to 12th order that do not cross step edges. The
/// differences are one-sided beside an edge.
///
/// \param min_edge  minimum height of a step edge between two texels. A step edge is also several
///         times as high as all differences near it
/// \param has_exact_levels  treats every difference of at least `min_edge` as a step edge
TileSlopes reference_slopes(const HeightTile& tile, double min_edge, bool has_exact_levels = false);

/// Returns the frequency response of reference_slopes(). An exact derivative returns `frequency`,
/// which is in radians per texel.
double reference_slope_response(double frequency);

/// Replaces isolated outliers such as hot pixels by a median of the lines through their neighbors.
///
/// \param min_height  minimum height of an outlier above or below its neighborhood
/// \return the height of each removed outlier, with its sign
std::vector<double> remove_outliers(HeightTile& tile, double min_height);

/// An estimate of white noise from the highest frequencies, where detail has the least power.
struct HighPassNoise {
    double deviation = 0.0;  ///< Upper bound of the standard deviation of the white noise.
    bool is_white = true;    ///< False if the power increases towards the Nyquist frequency.
};

/// Estimates white noise with high-pass masks [Immerkaer 1996].
HighPassNoise high_pass_noise(std::span<const HeightTile> tiles);

/// The center frequencies of the octave bands of octave_deviations(), in radians per texel.
inline constexpr std::array octave_frequencies = {2.61, 1.05, 0.49, 0.24};

using OctaveDeviations = std::array<double, octave_frequencies.size()>;

/// Estimates the standard deviation of the noise in each octave band, the highest band first. Each
/// result is the deviation of white noise with the same 20% quantile in that band. The quantile
/// ignores edges, because noise is in all texels and edges are in few.
OctaveDeviations octave_deviations(std::span<const HeightTile> tiles);

}  // namespace relief
