// SPDX-License-Identifier: Apache-2.0
/// \file
/// A small height field in double precision, with filters and noise estimators for the choice of a
/// kernel; power spectral densities of squares, noise spectra, and noise removal by spectral
/// subtraction. Heights have any unit. Tests: tests/mesh/bump/kernel_choice_test.cpp.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "relief/mesh/bump.h"

namespace relief::detail {

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
    std::vector<double> right;               ///< Per texel.
    std::vector<double> down;                ///< Per texel.
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

/// Applies the high-pass mask (1 -2 1) `times` (2 or 3) times along both axes.
///
/// \return the absolute values row by row, without `times` texels along the border; the gain for
///         white noise is 1
std::vector<double> high_pass(const HeightTile& tile, int times);

/// Returns the element of this rank, from 0 in ascending order. \param magnitudes  not negative
double smallest_of(std::span<const double> magnitudes, std::size_t rank);

/// Estimates the standard deviation of Gaussian noise from the 20% quantile of its absolute values.
/// Detail in up to 80% of the texels hardly changes the result.
double deviation_from_quantile(std::span<const double> magnitudes);

/// The standard deviations of independent offsets of whole rows and whole columns, as line scanners
/// have. 0 if there are none.
struct LineNoise {
    double rows = 0.0;
    double columns = 0.0;
};

/// Estimates offsets of rows and columns: they are far stronger in the means of the lines than in
/// waves of a few periods along the lines, and their power does not decrease with frequency.
///
/// \param rounding  standard deviation of the rounding of a height
LineNoise line_noise(std::span<const HeightTile> tiles, double rounding);

/// Removes offsets of rows and columns, except for those that change slowly.
void remove_line_noise(HeightTile& tile, const LineNoise& noise);

/// The standard deviation of noise that depends on the height.
struct NoiseByHeight {
    std::vector<double> heights;     ///< In ascending order.
    std::vector<double> deviations;  ///< At these heights, piecewise linear between them.

    [[nodiscard]] double at(double height) const;
};

/// Estimates white noise that grows with the height, or with the depth, by at least one half.
/// Returns nullopt if the noise does not depend on the height, or if detail is stronger.
std::optional<NoiseByHeight> noise_by_height(std::span<const HeightTile> tiles);

/// The quantization of JPEG.
struct BlockQuantization {
    /// The steps of the coefficients of 8 x 8 texels, in the unit of heights. Coefficients that are
    /// always 0 have the largest possible step, and unquantized ones have 0.
    std::array<double, 64> steps{};
};

/// Detects the blocks of JPEG and estimates their quantization. Returns nullopt if the heights have
/// no such blocks.
///
/// \param tiles  the first texel of each is the first texel of a block
/// \param code  the difference of adjacent codes of the file, in the unit of heights
std::optional<BlockQuantization> block_quantization(std::span<const HeightTile> tiles, double code);

/// Smooths a tile as far as the same quantization gives the same coefficients.
void remove_blocks(HeightTile& tile, const BlockQuantization& quantization);

/// Quantizes a tile in blocks of 8 x 8 texels, except for texels along the border.
void quantize_blocks(HeightTile& tile, const BlockQuantization& quantization, double code);

/// Adds random detail that the quantization can have removed.
void add_lost_detail(HeightTile& tile, const BlockQuantization& quantization, std::uint32_t seed);

/// Computes the two-dimensional discrete Fourier transform of a square in place.
///
/// \param square  `side` rows of `side` numbers
/// \param side  a power of two
/// \param inverse  computes the inverse transform, without the factor 1 / side^2
void transform_square(std::vector<std::complex<double>>& square, int side, bool inverse);

/// The power spectral density of isotropic noise.
struct NoiseSpectrum {
    int side = 1;                       ///< Side of the squares, in texels.
    std::vector<double> rings = {0.0};  ///< Power at frequencies of 0, 1, ... periods per side.
    /// From this frequency on, in radians per texel, the field contains only noise.
    double min_noise_only_frequency = std::numeric_limits<double>::infinity();

    /// Returns the spectrum of white noise with this standard deviation.
    static NoiseSpectrum white(double deviation) {
        NoiseSpectrum noise;
        noise.rings = {deviation * deviation};
        return noise;
    }
    /// Returns the power at a frequency in radians per texel, from -pi to pi. Beyond the last ring
    /// it is constant.
    [[nodiscard]] double at(double x, double y) const;
    /// Returns the standard deviation of the noise.
    [[nodiscard]] double deviation() const;
    /// Returns what octave_deviations() measures in such noise, if the noise is Gaussian and
    /// stationary.
    [[nodiscard]] OctaveDeviations octave_deviations() const;
};

/// Returns true if the noise is in all parts of the map. Edges can have the same power spectrum,
/// but most of the map is smoother than noise of that spectrum, which a quantile of the texels
/// shows.
///
/// \param octaves  octave_deviations() of the map
bool is_stationary(const NoiseSpectrum& noise, const OctaveDeviations& octaves, double rounding);

/// Detects detail with the spectrum of noise that was blurred over about 2.5 to 5 texels. Smooth
/// detail can have the same spectrum: such noise cannot be distinguished from it.
///
/// \param tiles  squares of equal size, whose side is a power of two of at least 16
/// \param rounding  standard deviation of the rounding
std::optional<NoiseSpectrum> widely_blurred_noise(std::span<const HeightTile> tiles,
                                                  double rounding);

/// Returns the variance of each of the two slopes that a kernel computes for isotropic noise
/// without power near the corners of the spectrum, in squared heights per texel.
double slope_variance(const GradientKernel& kernel, const NoiseSpectrum& noise);

/// Generates periodic Gaussian noise with this spectrum on a square of `side` texels.
std::vector<double> noise_field(const NoiseSpectrum& spectrum, int side, std::uint32_t seed);

/// The bands of half an octave that must have the spectrum of blurred noise.
struct BlurEvidence {
    std::size_t min_bands = 4;
    /// The decrease of the logarithm of the power up to the first one; below 1, the bands include
    /// the plateau of low frequencies.
    double max_first_exponent = 1.0;
    double min_last_exponent = 1.5;  ///< The decrease up to the last one.
};

/// The power spectral density of several square tiles, in bins of frequency and direction. The
/// scale is such that white noise of deviation 1 has the power 1 at all frequencies.
class PowerSpectrum {
  public:
    /// \param tiles  squares of equal size, whose side is a power of two of at least 8
    explicit PowerSpectrum(std::span<const HeightTile> tiles);

    /// Returns the gains of the zero-phase filter for spectral subtraction. The gain of a bin is
    /// the square root of the share of its power above the noise, or 0 if the power does not exceed
    /// the noise significantly.
    [[nodiscard]] std::vector<double> gains(const NoiseSpectrum& noise) const;
    /// Returns the bin of a frequency in radians per texel, from -pi to pi.
    [[nodiscard]] std::size_t bin_at(double x, double y) const;
    /// Returns gains() for each Fourier coefficient of the extended squares of remove_noise().
    [[nodiscard]] std::vector<double> gains_of_extension(std::span<const double> gains) const;

    /// Returns the ratio of the mean power significantly above the noise to the mean power of the
    /// noise.
    [[nodiscard]] double excess_over(const NoiseSpectrum& noise) const;

    /// Detects grain, which is noise or fine detail that no continuous surface has. The power of a
    /// fractal surface decreases at least with the inverse square of the frequency
    /// [Mandelbrot 1982], and the power of grain decreases more slowly.
    ///
    /// \return the spectrum of the grain, extrapolated to the low frequencies where other detail is
    ///         stronger; nullopt if the power decreases like that of a surface at all frequencies
    [[nodiscard]] std::optional<NoiseSpectrum> grain() const;

    /// Detects white noise after a blur of up to about two texels. The logarithm of its power
    /// decreases linearly with the squared frequency, while that of a surface decreases at least
    /// like -2 log(frequency) in addition.
    ///
    /// \param rounding  standard deviation of the rounding
    /// \return the spectrum of the noise and the rounding; nullopt if there is no such noise
    [[nodiscard]] std::optional<NoiseSpectrum> blurred_noise(
        double rounding, const BlurEvidence& evidence = {}) const;

    /// Returns the spectrum of the strongest noise, after a blur of up to four texels, that the map
    /// can contain. Its power does not exceed the median power at any frequency.
    ///
    /// \param octaves  octave_deviations(), which the noise does not exceed either
    [[nodiscard]] NoiseSpectrum max_blurred_noise(const OctaveDeviations& octaves) const;

    /// Estimates the maximum power of detail that the noise can hide. It is a share of the noise at
    /// frequencies without visible detail. Above the highest frequency with visible detail, it also
    /// does not exceed the extrapolated decrease of that detail.
    [[nodiscard]] NoiseSpectrum hidden_detail(const NoiseSpectrum& noise) const;

    /// Returns the RMS slope of the detail along x or along y that reference_slopes() does not
    /// resolve: the loss of its differences near the Nyquist frequency, and 2.5 times that amount
    /// for detail above that frequency.
    [[nodiscard]] double unresolved_slope(const NoiseSpectrum& noise) const;

    /// Returns the standard deviation of white noise with the median power of the highest
    /// frequencies. Regular patterns from rounding fill few bins and do not change the median.
    [[nodiscard]] double white_floor() const;

    /// Returns true if the power hardly decreases between the highest frequencies, as that of white
    /// noise. The power of detail decreases further.
    [[nodiscard]] bool ends_flat() const;

  private:
    /// The mean power of a range of frequencies and directions.
    struct Bin {
        double power = 0.0;
        double count = 0.0;
    };
    /// The median power of half an octave. Periodic detail fills few bins and does not change it.
    struct Band {
        double frequency = 0.0;  ///< Periods per side.
        double power = 0.0;
    };
    [[nodiscard]] std::vector<Band> bands() const;
    /// Returns the bins of the Fourier coefficients of a square.
    [[nodiscard]] std::vector<std::uint32_t> bins_of(int side) const;

    int side_;
    std::vector<Bin> bins_;
    std::vector<std::uint32_t> bins_of_coefficients_;  ///< Of a square of `side_`.
};

/// Removes noise from one or two tiles by spectral subtraction. The result is inaccurate in some
/// texels along the borders, where the tiles are extended by reflection.
///
/// \param gains  PowerSpectrum::gains_of_extension() for all tiles of the map and the noise
void remove_noise(std::span<HeightTile> tiles, std::span<const double> gains);

}  // namespace relief::detail
