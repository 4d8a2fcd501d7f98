// SPDX-License-Identifier: Apache-2.0
/// \file
/// The bakes that a check of some rows takes: the truth, of many samples; one through each texel's
/// centre; and the map's own. Tests: tests/mesh/bake/bake_check_test.cpp, bake_trials_test.cpp.
#pragma once

#include <optional>

#include "bake/bake_check_rows.h"

namespace relief {

/// How the truth of a map is baked. \param samples  0: as BakeCheckOptions says
BakeMapOptions reference_of(const BakeMapOptions& map, int samples);

struct BakeCasts {
    CastRows reference, centre;
    std::optional<CastRows> several;  ///< The map's own samples, where they are not one.

    /// \param report  gets what is said of the map's own
    BakeCasts(const Baker& baker, const BakeMapOptions& map, int reference_samples, int first,
              int last, Report& report);

    [[nodiscard]] const CastRows& made() const { return several ? *several : centre; }
    [[nodiscard]] std::size_t rays() const {
        return reference.rays + centre.rays + (several ? several->rays : 0);
    }
};

/// \param made     the map's own bake, which may be one of `casts`
/// \param remade   that, through codes
/// \param shown    the map, decoded; empty: `remade`
/// \param step, degrees  as for check_rows()
CheckSums check_strip(const Baker& baker, const BakeMapOptions& map, const BakeCasts& casts,
                      const CastRows& made, std::span<const float> remade,
                      std::span<const float> shown, int first, int step, std::span<float> degrees);

}  // namespace relief
