// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which frequencies square height fields hold, and what is left of a field once white noise is
/// taken out of them. Heights in any unit. Tests: tests/mesh/accuracy/power_spectrum_test.cpp.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "accuracy/height_tile.h"

namespace relief {

/// Discrete Fourier transform of a square, in place, rows of `side` numbers.
///
/// \param side  a power of two
/// \param back  the inverse, but for the factor 1 / side^2
void transform_square(std::vector<std::complex<double>>& square, int side, bool back);

/// The power of several squares by the length and direction of the frequency: the mean square of
/// the heights' Fourier coefficients, scaled so that white noise of deviation 1 has 1 everywhere.
class PowerSpectrum {
  public:
    /// \param tiles  squares of one side, a power of two of at least 8
    explicit PowerSpectrum(std::span<const HeightTile> tiles);

    /// What linear filter of phase 0 makes the spectrum that of the fields without white noise.
    ///
    /// \param x, y  frequency in radians a texel, -pi to pi
    /// \return the square root of the share of power that is not noise; 0 where the power is what
    ///         noise may have by chance
    [[nodiscard]] double without_noise(double x, double y, double deviation) const;

    /// Standard deviation of white noise with as much power as half of the highest frequencies
    /// have: where rounding makes patterns, which fill a few of them, next to nothing.
    [[nodiscard]] double white_floor() const;

  private:
    struct Bin {
        double power = 0.0;
        double count = 0.0;
    };
    [[nodiscard]] std::size_t bin_at(double x, double y) const;

    int side_;
    std::vector<Bin> bins_;
};

/// The tile without white noise, going by the spectrum of all; mirrored at its borders, where the
/// result is rough over some texels.
HeightTile without_noise(const HeightTile& tile, const PowerSpectrum& spectrum, double deviation);

}  // namespace relief
