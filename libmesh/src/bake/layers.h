// SPDX-License-Identifier: Apache-2.0
/// \file
/// The layers of a bake: the list of all layers, ambient occlusion, and the texel means of the
/// layers other than normals and heights. Tests: tests/mesh/bake/bake_layers_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bake/high_surface.h"
#include "relief/mesh/bake.h"

namespace relief::detail {

/// A layer that rows of a bake may hold.
struct BakedLayer {
    std::span<float> BakedRows::*values;
    std::size_t channels;
    bool has_directions;  ///< Values are averaged as unit vectors.
    bool (*is_requested)(const BakeLayers& layers);
};

/// All layers, in the order in which they are stored and padded.
inline constexpr std::array baked_layers = {
    BakedLayer{&BakedRows::normals, 3, true, [](const BakeLayers& l) { return l.normals; }},
    BakedLayer{&BakedRows::heights, 1, false, [](const BakeLayers& l) { return l.heights; }},
    BakedLayer{&BakedRows::occlusion, 1, false,
               [](const BakeLayers& l) { return l.occlusion.has_value(); }},
    BakedLayer{&BakedRows::curvature, 1, false, [](const BakeLayers& l) { return l.curvature; }},
    BakedLayer{&BakedRows::positions, 3, false, [](const BakeLayers& l) { return l.positions; }},
    BakedLayer{&BakedRows::colors, 3, false, [](const BakeLayers& l) { return l.colors; }},
    BakedLayer{&BakedRows::opacity, 1, false, [](const BakeLayers& l) { return l.opacity; }},
    BakedLayer{&BakedRows::surface, 3, false, [](const BakeLayers& l) { return l.surface; }},
    BakedLayer{&BakedRows::emission, 3, false, [](const BakeLayers& l) { return l.emission; }},
};

/// \throws InvalidInput if the number of rays or the distance is out of range
void check(const OcclusionOptions& options);

/// A point for which occlusion is computed.
struct OcclusionPlace {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};    ///< Unit, the axis of the hemisphere.
    glm::dvec3 face{0.0};      ///< The unit face normal on the visible side.
    std::size_t texel = 0;     ///< Index in the map.
    std::uint32_t sample = 0;  ///< Index in the texel.
};

/// Ambient occlusion: the cosine-weighted share of the hemisphere in which rays hit nothing.
///
/// Directions are points of a (0,2)-sequence on the disk below the hemisphere, so the rays of each
/// point and those of all samples of a texel are evenly distributed. The bits of the sequence are
/// scrambled by a hash of the texel index, so that errors of neighbors are independent. Source:
/// [Kollig and Keller 2002].
class Occlusion {
  public:
    /// \param samples  the number of samples that share the rays of a texel
    Occlusion(const OcclusionOptions& options, std::uint32_t samples);

    [[nodiscard]] std::uint32_t rays_of_sample() const { return rays_; }

    /// \param report  counts points whose normal is nearly in or behind the plane of the triangle;
    ///                their rays are distributed around the face normal
    /// \return for each point 0 (hidden) to 1 (open); rays below the triangle's plane do not count
    [[nodiscard]] std::vector<double> open_shares(const RayScene& scene,
                                                  std::span<const OcclusionPlace> points,
                                                  Report& report) const;

  private:
    std::optional<double> distance_;
    std::uint32_t rays_;
};

/// The hit of a sample.
struct LayerHit {
    RayHit hit;
    std::size_t texel = 0;     ///< Index in the LayerBake.
    std::uint32_t sample = 0;  ///< Index in the texel.
};

/// Sums all layers but normals and heights over the samples of some texels.
class LayerBake {
  public:
    /// Returns whether any of these layers is requested.
    static bool is_requested(const BakeLayers& layers) {
        return layers.occlusion || layers.curvature || layers.positions || layers.colors ||
               layers.opacity || layers.surface || layers.emission;
    }

    /// \param first_texel  the map index of the first texel
    /// \param texels       the number of texels
    /// \param min_samples  the minimum number of samples of a texel
    LayerBake(const BakeLayers& layers, std::size_t first_texel, std::size_t texels,
              std::uint32_t min_samples);

    /// Adds hits. \param occluders  what blocks the rays of occlusion
    /// \return the number of occlusion rays
    std::size_t add(const HighSurface& high, const RayScene& occluders,
                    std::span<const LayerHit> hits, Report& report);

    /// Writes the means of a texel to index `at` of the rows.
    void store(std::size_t texel, const BakedRows& rows, std::size_t at) const;

  private:
    std::size_t add_occlusion(const HighSurface& high, const RayScene& occluders,
                              std::span<const LayerHit> hits, Report& report);

    const BakeLayers& layers_;
    std::size_t first_texel_;
    std::optional<Occlusion> occlusion_;
    std::vector<std::uint32_t> hits_;
    std::vector<double> open_, curvature_, opacity_;
    std::vector<glm::dvec3> positions_, colors_, surfaces_, emission_;
};

}  // namespace relief::detail
