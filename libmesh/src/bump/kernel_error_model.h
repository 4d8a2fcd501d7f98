// SPDX-License-Identifier: Apache-2.0
/// \file
/// Predicts the errors of derivative kernels on a height map. The model restores the map as it may
/// have been before storage, adds the same kinds of degradation again, and measures the kernels.
/// Tests: tests/mesh/bump/kernel_choice_test.cpp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bump/height_tile.h"
#include "bump/power_spectrum.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/kernel_choice.h"

namespace relief {

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
    [[nodiscard]] double rounding_deviation(double height) const;
};

/// A reference surface and its degraded version, both from parts of a map.
class KernelErrorModel {
  public:
    /// \param parts  one channel each, all with the same number of bits
    KernelErrorModel(std::span<const Image> parts, const BumpOptions& options, bool destaircased,
                     Grain grain);

    /// Measures the errors of a kernel on the degraded parts.
    [[nodiscard]] KernelPrediction predict(Kernel kernel, int radius) const;

    /// Estimates the maximum error for properties that the map does not reveal: noise that hides or
    /// resembles detail, and detail smaller than texels. The result is an estimate, not a bound.
    ///
    /// \param prediction  the result of predict()
    [[nodiscard]] KernelPrediction predict_upper(const KernelPrediction& prediction) const;

    [[nodiscard]] const HeightCoding& coding() const { return coding_; }
    /// Returns the standard deviation of the noise without rounding.
    [[nodiscard]] double noise() const { return noise_; }
    /// Returns the standard deviation of the grain, whether it counts as noise or as detail.
    [[nodiscard]] double grain() const { return grain_; }
    /// Returns true if the map contains almost nothing but grain.
    [[nodiscard]] bool is_only_grain() const { return is_only_grain_; }
    /// Returns the share of isolated outliers.
    [[nodiscard]] double outlier_share() const { return outlier_share_; }
    /// Returns the share of texels beside a step edge. They have no reference normal.
    [[nodiscard]] double edge_share() const { return edge_share_; }

  private:
    void remove_outliers();
    void detect_grain(Grain grain);
    void restore();
    [[nodiscard]] Image degraded(const HeightTile& tile, std::uint32_t seed) const;
    void degrade();

    BumpOptions options_;
    bool destaircased_ = false;
    HeightCoding coding_;
    std::vector<HeightTile> tiles_;  ///< The parts, which restore() turns into the reference.
    double grain_ = 0.0;
    double noise_ = 0.0;
    bool is_only_grain_ = false;
    bool stored_is_reference_ = false;  ///< True if grain counts as detail.
    std::optional<PowerSpectrum> spectrum_;
    std::optional<NoiseSpectrum> colored_noise_;  ///< Noise and rounding, if they are not white.
    std::optional<NoiseSpectrum> max_noise_;      ///< The strongest noise that the map allows.
    double unresolved_slope_ = 0.0;               ///< RMS slope that texels do not resolve.
    HighPassNoise high_pass_;
    double white_deviation_ = 0.0;  ///< Standard deviation of white noise and rounding.
    double outlier_share_ = 0.0;
    std::vector<double> outliers_;  ///< The heights of the outliers.
    double edge_share_ = 0.0;
    std::vector<std::vector<glm::dvec3>> reference_normals_;  ///< 0 beside step edges.
    std::vector<Image> degraded_;
};

}  // namespace relief
