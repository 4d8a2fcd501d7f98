// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which frequencies square height fields hold, and what is left of a field once noise is
/// taken out of them. Heights in any unit. Tests: tests/mesh/accuracy/power_spectrum_test.cpp.
#pragma once

#include <complex>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "accuracy/height_tile.h"

namespace relief {

/// Discrete Fourier transform of a square, in place, rows of `side` numbers.
///
/// \param side  a power of two
/// \param back  the inverse, but for the factor 1 / side^2
void transform_square(std::vector<std::complex<double>>& square, int side, bool back);

/// The power of noise that has no direction, by the length of the frequency.
struct NoiseSpectrum {
    int side = 1;                       ///< Of the squares whose rings these are.
    std::vector<double> rings = {0.0};  ///< Power by ring; the last one also beyond.
    /// From here on there is nothing but noise, in all directions. Radians a texel.
    double lowest_of_noise_alone = std::numeric_limits<double>::infinity();

    static NoiseSpectrum white(double deviation) {
        NoiseSpectrum noise;
        noise.rings = {deviation * deviation};
        return noise;
    }
    /// \param x, y  frequency in radians a texel, -pi to pi
    [[nodiscard]] double at(double x, double y) const;
    /// Standard deviation of the noise.
    [[nodiscard]] double deviation() const;
    /// The deviation that high_frequencies() finds by its narrower mask in such noise, where it is
    /// Gaussian and the same everywhere. White noise has its own deviation.
    [[nodiscard]] double high_deviation() const;
};

/// Noise of this spectrum on a square of `side` texels, which it tiles.
std::vector<double> noise_field(const NoiseSpectrum& spectrum, int side, std::uint32_t seed);

/// The power of several squares by the length and direction of the frequency: the mean square of
/// the heights' Fourier coefficients, scaled so that white noise of deviation 1 has 1 everywhere.
class PowerSpectrum {
  public:
    /// \param tiles  squares of one side, a power of two of at least 8
    explicit PowerSpectrum(std::span<const HeightTile> tiles);

    /// What linear filter of phase 0 makes the spectrum that of the fields without noise: for each
    /// bin the square root of the share of power that is not noise; 0 where the power is what noise
    /// may have by chance.
    [[nodiscard]] std::vector<double> gains(const NoiseSpectrum& noise) const;
    /// The bin of a frequency in radians a texel, -pi to pi.
    [[nodiscard]] std::size_t bin_at(double x, double y) const;

    /// Mean power beyond what the noise may have by chance, over the mean power of the noise.
    [[nodiscard]] double excess_over(const NoiseSpectrum& noise) const;

    /// The part of the spectrum that no continuous surface has: the power of a fractal surface
    /// falls at least as the inverse square of the frequency [Mandelbrot 1982], that of grain does
    /// not.
    ///
    /// \return nothing where the power falls like that of a surface at all frequencies. Below the
    ///         frequencies at which grain outweighs the rest, its spectrum is extrapolated
    [[nodiscard]] std::optional<NoiseSpectrum> grain() const;

    /// The most detail that the noise may hide: a part of it where no detail is seen, and from the
    /// highest frequency with visible detail on at most what continues its fall.
    [[nodiscard]] NoiseSpectrum hidden_detail(const NoiseSpectrum& noise) const;

    /// Root mean square of the slope along x, or along y, that true_slopes() misses of the detail:
    /// what it does not see near the Nyquist frequency, and as much for detail beyond that
    /// frequency.
    [[nodiscard]] double missed_slope(const NoiseSpectrum& noise) const;

    /// Standard deviation of white noise with as much power as half of the highest frequencies
    /// have: where rounding makes patterns, which fill a few of them, next to nothing.
    [[nodiscard]] double white_floor() const;

  private:
    struct Bin {
        double power = 0.0;
        double count = 0.0;
    };
    /// Half an octave of frequencies, and the median power in it: waves fill few of its bins.
    struct Band {
        double frequency = 0.0;  ///< Periods a side.
        double power = 0.0;
    };
    [[nodiscard]] std::vector<Band> bands() const;

    int side_;
    std::vector<Bin> bins_;
};

/// The tile without noise, going by the spectrum of all; mirrored at its borders, where the
/// result is rough over some texels.
HeightTile without_noise(const HeightTile& tile, const PowerSpectrum& spectrum,
                         const NoiseSpectrum& noise);

}  // namespace relief
