// SPDX-License-Identifier: Apache-2.0
/// \file
/// The layers of a bake beside normals and heights, from what rays have met: sums over the samples
/// of each texel, then means. Exists only where such a layer is wanted.
/// Tests: tests/mesh/bake/bake_layers_test.cpp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bake/high_surface.h"
#include "bake/occlusion.h"
#include "relief/mesh/bake.h"

namespace relief {

/// Where a sample's ray has met the surface.
struct LayerHit {
    RayHit hit;
    std::size_t texel = 0;     ///< Among those of this LayerBake.
    std::uint32_t sample = 0;  ///< Of the texel.
};

class LayerBake {
  public:
    /// Whether there is anything for it to do.
    static bool is_wanted(const BakeLayers& layers) {
        return layers.occlusion || layers.curvature || layers.positions || layers.colors;
    }

    /// \param first_texel    of the map, that these begin with
    /// \param texels         how many there are
    /// \param first_samples  of a texel that are cast at least
    LayerBake(const BakeLayers& layers, std::size_t first_texel, std::size_t texels,
              std::uint32_t first_samples);

    /// \return rays cast
    std::size_t add(const HighSurface& high, std::span<const LayerHit> hits, Report& found);

    /// The means of a texel, at a place of the rows.
    void store(std::size_t texel, const BakedRows& rows, std::size_t at) const;

  private:
    std::size_t add_occlusion(const HighSurface& high, std::span<const LayerHit> hits,
                              Report& found);

    const BakeLayers& layers_;
    std::size_t first_texel_;
    std::optional<Occlusion> occlusion_;
    std::vector<std::uint32_t> hits_;
    std::vector<double> open_, curvature_;
    std::vector<glm::dvec3> positions_, colors_;
};

}  // namespace relief
