// SPDX-License-Identifier: Apache-2.0
/// \file
/// The bumpy sphere, baked for a coarse one in several ways, errors and seconds.
/// Tests: tests/accuracy/bake_experiments_test.cpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/bumpy_sphere.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/bake_trials.h"

namespace relief {

std::string words_of(const BakeWay& way);  ///< "16 rays", "up to 64 rays beyond 2°"

/// What became of one way.
struct BakeWayFound {
    BakeTrial trial;  ///< Its errors by format.
    /// By format, rays and codes together; empty where nothing was timed.
    std::vector<Timing> one_thread{};
    std::vector<Timing> all_threads{};
};

/// High and low mesh, ready for rays, and the truth for their map.
class BumpyBake {
  public:
    static constexpr int low_slices = 46;
    static constexpr int low_stacks = 23;

    /// \param side  of the map, in texels
    BumpyBake(int high_stacks, int side);

    [[nodiscard]] const Baker& baker() const { return baker_; }
    [[nodiscard]] const BakeMapOptions& map() const { return map_; }
    [[nodiscard]] const BakeTrials& trials() const { return trials_; }
    [[nodiscard]] std::string words() const;  ///< Of the input.
    [[nodiscard]] double texels() const;

    /// 8 and 16 bits and float.
    static const std::vector<NormalMapFormat>& formats();

    /// All ways in turns. Seconds are of rays, their means and codes, not of making meshes ready.
    [[nodiscard]] std::vector<BakeWayFound> measured(std::span<const BakeWay> ways,
                                                     const RunOptions& options) const;

    /// The finished map, and the surface that it was baked from. \param way  as for measured()
    [[nodiscard]] Image map_by(const BakeWay& way, const NormalMapFormat& format) const;
    [[nodiscard]] const BumpySphere& high() const { return high_; }

  private:
    BumpySphere high_;
    Report report_;
    Baker baker_;
    BakeMapOptions map_;
    BakeTrials trials_;
};

}  // namespace relief
