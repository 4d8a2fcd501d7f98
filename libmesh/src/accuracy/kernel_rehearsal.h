// SPDX-License-Identifier: Apache-2.0
/// \file
/// Kernels tried out on what a height map may have been before it was stored: restored, spoilt
/// again as it had been, and measured. Tests: tests/mesh/accuracy/kernel_choice_test.cpp.
#pragma once

#include <span>
#include <vector>

#include "accuracy/height_tile.h"
#include "relief/mesh/height_statistics.h"
#include "relief/mesh/kernel_choice.h"

namespace relief {

/// How heights are rounded when they are stored.
struct HeightCoding {
    HeightDepth depth;
    int mantissa_bits = 24;  ///< Of floats, where there is no step: 11 for half floats.

    [[nodiscard]] double step() const { return depth.bits > 0 ? depth.step : 0.0; }
    /// Standard deviation of the rounding of a height.
    [[nodiscard]] double error_of(double height) const;
};

/// Ground truth made of a map's own parts.
class KernelRehearsal {
  public:
    /// \param parts  one channel each, all of one depth
    KernelRehearsal(std::span<const Image> parts, const BumpOptions& options, bool destaircased);

    /// What a kernel does to the spoilt parts.
    [[nodiscard]] KernelPrediction predict(Kernel kernel, int radius) const;

    [[nodiscard]] const HeightCoding& coding() const { return coding_; }
    /// Deviation of the noise beyond rounding.
    [[nodiscard]] double noise() const { return noise_; }
    /// Share of texels beside a cliff, where no normal is right and none is judged.
    [[nodiscard]] double walls() const { return walls_; }

  private:
    void restore(std::vector<HeightTile>& tiles);
    void spoil(const std::vector<HeightTile>& tiles, bool destaircased);

    BumpOptions options_;
    HeightCoding coding_;
    double noise_ = 0.0;
    double walls_ = 0.0;
    std::vector<std::vector<glm::dvec3>> normals_;  ///< 0 where none is right.
    std::vector<Image> spoilt_;
};

}  // namespace relief
