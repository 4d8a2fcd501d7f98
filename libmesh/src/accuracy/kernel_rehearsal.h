// SPDX-License-Identifier: Apache-2.0
/// \file
/// Kernels tried out on what a height map may have been before it was stored: restored, spoilt
/// again as it had been, and measured. Tests: tests/mesh/accuracy/kernel_choice_test.cpp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "accuracy/height_tile.h"
#include "accuracy/power_spectrum.h"
#include "relief/mesh/height_statistics.h"
#include "relief/mesh/kernel_choice.h"

namespace relief {

/// How heights are rounded when they are stored.
struct HeightCoding {
    HeightDepth depth;
    int mantissa_bits = 24;  ///< Of floats, where there is no step: 11 for half floats.
    /// A mask or a map of a few terraces: its levels are the heights, not rounded ones.
    bool has_exact_levels = false;

    [[nodiscard]] double step() const {
        return depth.bits > 0 && !has_exact_levels ? depth.step : 0.0;
    }
    /// Standard deviation of the rounding of a height.
    [[nodiscard]] double error_of(double height) const;
};

/// Ground truth made of a map's own parts.
class KernelErrorModel {
  public:
    /// \param parts  one channel each, all of one depth
    KernelErrorModel(std::span<const Image> parts, const BumpOptions& options, bool destaircased,
                     Grain grain);

    /// What a kernel does to the spoilt parts.
    [[nodiscard]] KernelPrediction predict(Kernel kernel, int radius) const;

    /// The same where the parts do not show all: noise hides detail or looks like it, and detail
    /// is finer than texels. The greatest error to be expected, not a bound.
    ///
    /// \param shown  by predict()
    [[nodiscard]] KernelPrediction predict_upper(const KernelPrediction& shown) const;

    [[nodiscard]] const HeightCoding& coding() const { return coding_; }
    /// Deviation of the noise beyond rounding.
    [[nodiscard]] double noise() const { return noise_; }
    /// Deviation of the grain, whether it was taken for noise or for detail.
    [[nodiscard]] double grain() const { return grain_; }
    /// Hardly anything in the map is not grain.
    [[nodiscard]] bool is_only_grain() const { return is_only_grain_; }
    /// Share of texels that stick out on their own.
    [[nodiscard]] double spikes() const { return spike_share_; }
    /// Share of texels beside a cliff, where no normal is right and none is judged.
    [[nodiscard]] double walls() const { return walls_; }

  private:
    void remove_spikes();
    void find_grain(Grain grain);
    void restore();
    [[nodiscard]] Image spoilt(const HeightTile& tile, std::uint32_t seed) const;
    void spoil();

    BumpOptions options_;
    bool destaircased_ = false;
    HeightCoding coding_;
    std::vector<HeightTile> tiles_;  ///< As stored, then restored: the truth.
    double grain_ = 0.0;
    double noise_ = 0.0;
    bool is_only_grain_ = false;
    bool is_as_stored_ = false;  ///< Grain is detail: the map is its own truth.
    std::optional<PowerSpectrum> spectrum_;
    std::optional<NoiseSpectrum> colored_;   ///< Of noise and rounding, where it is not white.
    std::optional<NoiseSpectrum> possible_;  ///< The strongest noise that there may be.
    double missed_slope_ = 0.0;              ///< Deviation of true slopes that no texels show.
    HighFrequencies high_;
    double white_ = 0.0;  ///< Deviation of noise and rounding, where it is white.
    double spike_share_ = 0.0;
    std::vector<double> spikes_;  ///< How far they stick out.
    double walls_ = 0.0;
    std::vector<std::vector<glm::dvec3>> normals_;  ///< 0 where none is right.
    std::vector<Image> spoilt_;
};

}  // namespace relief
