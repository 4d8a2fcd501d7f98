// SPDX-License-Identifier: Apache-2.0
/// \file
/// Functions of <cmath> whose results are the same on every processor and with every C library,
/// for all numbers that end up in files. The C library's own are not: glibc chooses variants with
/// and without fused multiplication by the processor, whose last bits differ.
/// Errors are at most 4 units of the last place, of pow() 60.
#pragma once

#include "relief/export.h"

namespace relief {
namespace RELIEF_API portable {

/// \param x  radians; not finite: NaN. Beyond 1e5 turns count as 2 * std::numbers::pi
double sin(double x);
double cos(double x);

/// \param x  radians, as for sin()
double tan(double x);

/// Range -pi to pi; 0 for (0, 0).
double atan2(double y, double x);

/// \param x  up to 700
double exp(double x);

/// \param x  0: -infinity; negative: NaN
double log(double x);

/// The error function: the probability that a normal variable is within x * sqrt(2) deviations.
double erf(double x);

/// \param x  0 or greater; 0, infinity and NaN are returned
/// \param y  greater than 0, and small enough for the result to be finite
double pow(double x, double y);

}  // namespace portable
}  // namespace relief
