// SPDX-License-Identifier: Apache-2.0
/// \file
/// The error model of kernels. It restores the map as it may have been before storage, adds the
/// same kinds of degradation again, and measures the kernels on the result. Blocks of JPEG and
/// offsets of rows or columns are removed first. It then restores the reference in one of three
/// ways. Noise, and quantization that behaves like white noise, is removed by spectral subtraction.
/// Quantization steps wider than texels are removed by destaircase(). Floats without noise remain
/// unchanged. Heights are in the unit of the map, where 1.0 is white, and angles are in degrees.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bump/height_tile.h"
#include "portable_math.h"
#include "relief/mesh/height_map.h"

namespace relief::detail {

/// The rounding of stored heights.
struct HeightCoding {
    HeightDepth depth;
    int mantissa_bits = 24;  ///< Precision of floats without a step, 11 for half floats.
    /// True for masks and maps of a few terraces, whose levels are exact heights.
    bool has_exact_levels = false;

    /// Returns the quantization step, or 0 if there is none.
    [[nodiscard]] double step() const {
        return depth.bits > 0 && !has_exact_levels ? depth.step : 0.0;
    }
    /// Returns the standard deviation of the rounding error of a height.
    [[nodiscard]] double rounding_deviation(double height) const {
        constexpr double of_rounding = 0.28867513459481287;  // The square root of 1/12.
        if (has_exact_levels) return 0.0;
        if (depth.bits > 0) return of_rounding * depth.step;
        // The power of two below the height, and that of the lowest bit of the mantissa above 1.
        constexpr std::uint64_t exponent_bits = 0x7ff0000000000000ULL;
        constexpr int bias = 1023;
        const auto height_bits = std::bit_cast<std::uint64_t>(height);
        const auto unit_bits = static_cast<std::uint64_t>(bias + 1 - mantissa_bits) << 52;
        return std::bit_cast<double>(height_bits & exponent_bits) *
               (of_rounding * std::bit_cast<double>(unit_bits));
    }
};

/// The properties of a map, without its texels.
struct KernelProperties {
    BumpOptions options;
    bool destaircased = false;
    HeightCoding coding;
    double rounding = 0.0;                    ///< RMS of the rounding_deviation() of the map.
    std::optional<BlockQuantization> blocks;  ///< Of maps that were stored as JPEG.
    LineNoise lines;
    double grain = 0.0;  ///< Without offsets of lines.
    double noise = 0.0;  ///< Like `grain`; 0 if grain counts as detail.
    std::optional<NoiseByHeight> noise_by_height;
    bool is_noise_blurred = false;
    bool is_only_grain = false;
    bool stored_is_reference = false;  ///< True if grain counts as detail.
    std::optional<PowerSpectrum> spectrum;
    std::optional<NoiseSpectrum> colored_noise;  ///< Noise and rounding, if they are not white.
    std::optional<NoiseSpectrum> max_noise;      ///< The strongest noise that the map allows.
    double unresolved_slope = 0.0;               ///< RMS slope that texels do not resolve.
    HighPassNoise high_pass;
    double white_deviation = 0.0;  ///< Standard deviation of white noise and rounding.
    double outlier_share = 0.0;
    std::vector<double> outliers;  ///< The heights of the outliers.
    double edge_share = 0.0;
};

/// Unit normals of a part of a map; 0 beside step edges.
struct ReferenceNormals {
    std::vector<double> x, y, z;
};

/// A reference surface and its degraded version, both from parts of a map.
class KernelErrorModel {
  public:
    /// \param parts  one channel each
    KernelErrorModel(std::span<const Image> parts, const HeightCoding& coding,
                     const BumpOptions& options, bool destaircased, Grain grain);

    /// Returns the model of the same map for another interpretation of its grain, from a sample of
    /// the parts.
    [[nodiscard]] KernelErrorModel interpreted(Grain grain) const;

    /// Returns true if there are enough parts for a sample of them.
    [[nodiscard]] bool has_sample() const { return degraded_.size() >= 4; }
    /// Measures the errors of a kernel on the degraded parts.
    ///
    /// \param of_sample  only on some of the parts
    [[nodiscard]] KernelPrediction predict(Kernel kernel, int radius, bool of_sample = false) const;

    /// Estimates the maximum error for properties that the map does not reveal: noise that hides or
    /// resembles detail, and detail smaller than texels. The result is an estimate, not a bound.
    ///
    /// \param prediction  the result of predict()
    [[nodiscard]] KernelPrediction predict_upper(const KernelPrediction& prediction) const;

    /// Returns the angle in degrees by which noise changes the normals of a kernel, as an RMS.
    [[nodiscard]] double degrees_of_noise(Kernel kernel, int radius,
                                          const NoiseSpectrum& noise) const;

    [[nodiscard]] const HeightCoding& coding() const { return map_.coding; }
    /// Returns true if there is more noise than rounding can cause.
    [[nodiscard]] bool is_noisy() const { return grain() > 4.0 * map_.rounding; }
    /// Returns true if the noise was blurred: detail can have the same spectrum.
    [[nodiscard]] bool is_noise_blurred() const { return map_.is_noise_blurred; }
    /// Returns true if the map was stored as JPEG.
    [[nodiscard]] bool has_blocks() const { return map_.blocks.has_value(); }
    /// Returns the standard deviation of the noise without rounding.
    [[nodiscard]] double noise() const { return map_.stored_is_reference ? 0.0 : grain(); }
    /// Returns the standard deviation of the grain, whether it counts as noise or as detail.
    [[nodiscard]] double grain() const {
        return std::sqrt(map_.grain * map_.grain + map_.lines.rows * map_.lines.rows +
                         map_.lines.columns * map_.lines.columns);
    }
    /// Returns true if the map contains almost nothing but grain.
    [[nodiscard]] bool is_only_grain() const { return map_.is_only_grain; }
    /// Returns the share of isolated outliers.
    [[nodiscard]] double outlier_share() const { return map_.outlier_share; }
    /// Returns the share of texels beside a step edge. They have no reference normal.
    [[nodiscard]] double edge_share() const { return map_.edge_share; }

  private:
    explicit KernelErrorModel(const KernelProperties& map) : map_(map) {}
    void remove_blocks();
    void remove_outliers();
    void detect_grain();
    void interpret(Grain grain);
    /// Returns the white noise and rounding that the spectrum contains.
    [[nodiscard]] NoiseSpectrum white_noise(double rounding) const;
    void restore();
    void add_line_noise(HeightTile& tile, Random& random) const;
    [[nodiscard]] std::vector<double> new_noise(const HeightTile& tile, std::uint32_t seed) const;
    void add_outliers(HeightTile& tile, std::uint32_t seed) const;
    [[nodiscard]] Image degraded(const HeightTile& tile, std::uint32_t seed) const;
    void set_reference(std::size_t part, const TileSlopes& reference);
    void degrade();

    KernelProperties map_;
    std::vector<HeightTile> tiles_;        ///< The parts, which restore() turns into the reference.
    std::vector<HeightTile> noisy_tiles_;  ///< Before restore(), without offsets of lines.
    std::vector<HeightTile> tiles_with_lines_;  ///< With these offsets; empty if there are none.
    std::vector<ReferenceNormals> reference_normals_;
    std::vector<Image> degraded_;
};

/// Returns the kernel of choose_kernel() without the range of its error and its other readings,
/// which take a third of the time.
KernelPrediction best_kernel(const ImageView& height, const BumpOptions& options);

/// Determines the rounding of the heights. \param parts  of one map
HeightCoding coding_of(std::span<const Image> parts);

/// Returns the widely_blurred_noise() of a map, if it has any. Of many parts, some suffice.
std::optional<NoiseSpectrum> blurred_noise_of(std::span<const Image> parts,
                                              const HeightCoding& coding);

}  // namespace relief::detail
