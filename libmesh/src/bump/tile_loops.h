// SPDX-License-Identifier: Apache-2.0
/// \file
/// Vectorized loops over the heights of small tiles. Every processor gives the same bits, because
/// each element is the same operations in the same order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "portable_math.h"

namespace relief::detail {

/// Applies a symmetric filter of 2, 3 or 5 weights, the center weight first. The taps are `offset`
/// elements apart; `from` is valid as far beyond both ends as they reach.
void symmetric_filter(VectorTarget target, const double* from, std::span<const double> weights,
                      std::ptrdiff_t offset, std::size_t count, double* to);

/// Computes from[i] - 2 from[i + offset] + from[i + 2 offset].
void second_difference(VectorTarget target, const double* from, std::ptrdiff_t offset,
                       std::size_t count, double* to);

/// Stores 1 for each step edge between line[i] and line[i + 1], and 0 for the others. The
/// difference of a step edge is at least `min_height`, and more than `times` times as large as all
/// differences within 4 texels.
///
/// \param line  valid from -4 to count + 4
/// \return whether there are any
bool find_step_edges(VectorTarget target, const double* line, std::size_t count, double min_height,
                     double times, std::int64_t* edges);

/// The radius of central_slopes(), half its order.
inline constexpr int max_slope_radius = 6;

/// Computes central differences of 12th order.
///
/// \param weights  of line[i + k] - line[i - k] for k = 1 to max_slope_radius, at index k
/// \param line  valid max_slope_radius elements beyond both ends
void central_slopes(VectorTarget target, const double* line, const double* weights,
                    std::size_t count, double* slopes);

/// Computes the median heights of texels above the lines between opposite neighbors.
///
/// \param above, here, below  rows of a tile; valid one element beyond both ends
void heights_above_neighbors(VectorTarget target, const double* above, const double* here,
                             const double* below, std::size_t count, double* heights);

/// Coordinates of normals.
template <typename Real>
struct NormalRows {
    Real *x, *y, *z;
};

/// Normalizes (-right, down, 1).
void unit_normals(VectorTarget target, const double* right, const double* down, std::size_t count,
                  const NormalRows<double>& normals);

/// Computes the angles in radians between normalize(-right, -up, 1), rounded to float, and unit
/// vectors. A series of the chord length approximates the angle; it is exact for small angles and
/// 1% too small at 90 degrees.
///
/// \param squares  gets the squared angles
void angles_between(VectorTarget target, const double* right, const double* up,
                    const NormalRows<const double>& exact, std::size_t count, double* angles,
                    double* squares);

/// Generates independent, nearly Gaussian numbers with mean 0 and standard deviation 1 in [-6, 6]:
/// sums of 12 uniform numbers of 16 bits.
void random_normals(VectorTarget target, std::uint32_t seed, std::size_t count, double* numbers);

/// Rounds to multiples of a step, shifted by -`shift`.
void round_to_steps(VectorTarget target, double step, double shift, std::size_t count,
                    double* values);

}  // namespace relief::detail
