// SPDX-License-Identifier: Apache-2.0
/// \file
/// The layers of a bake: the list of all layers, the rays of occlusion and thickness, and the texel
/// means of the layers other than normals and heights.
/// Tests: tests/mesh/bake/bake_layers_test.cpp, bent_normals_test.cpp, bake_ids_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/high_surface.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_shards.h"

namespace relief::detail {

struct BakeWork;

/// The mean of the values of several texels.
enum class TexelMean {
    number,     ///< Of each channel.
    direction,  ///< Of unit vectors.
    majority,   ///< The most frequent value; of equally frequent ones, the smallest.
};

/// A layer with the mean that its texels have.
struct BakedLayer : RowLayer {
    TexelMean mean;
};

/// All layers, in the order in which they are stored and padded.
inline constexpr std::array baked_layers = {
    BakedLayer{{&BakedRows::normals, 3, [](const BakeLayers& l) { return l.normals; }},
               TexelMean::direction},
    BakedLayer{{&BakedRows::heights, 1, [](const BakeLayers& l) { return l.heights; }},
               TexelMean::number},
    BakedLayer{
        {&BakedRows::occlusion, 1, [](const BakeLayers& l) { return l.occlusion.has_value(); }},
        TexelMean::number},
    BakedLayer{{&BakedRows::curvature, 1, [](const BakeLayers& l) { return l.curvature; }},
               TexelMean::number},
    BakedLayer{{&BakedRows::positions, 3, [](const BakeLayers& l) { return l.positions; }},
               TexelMean::number},
    BakedLayer{{&BakedRows::colors, 3, [](const BakeLayers& l) { return l.colors; }},
               TexelMean::number},
    BakedLayer{{&BakedRows::opacity, 1, [](const BakeLayers& l) { return l.opacity; }},
               TexelMean::number},
    BakedLayer{{&BakedRows::surface, 3, [](const BakeLayers& l) { return l.surface; }},
               TexelMean::number},
    BakedLayer{{&BakedRows::emission, 3, [](const BakeLayers& l) { return l.emission; }},
               TexelMean::number},
    BakedLayer{{&BakedRows::bent_normals, 3,
                [](const BakeLayers& l) { return l.bent_normals.has_value(); }},
               TexelMean::direction},
    BakedLayer{
        {&BakedRows::thickness, 1, [](const BakeLayers& l) { return l.thickness.has_value(); }},
        TexelMean::number},
    BakedLayer{{&BakedRows::ids, 1, [](const BakeLayers& l) { return l.ids; }},
               TexelMean::majority},
};

/// \throws InvalidInput if the number of rays or the distance of a layer is out of range, or if
///         occlusion and bent normals differ in them
void check(const BakeLayers& layers);

/// A point from which rays of occlusion or thickness are cast.
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
    /// \param bent    empty, or gets for each point the mean over all rays of the directions of
    ///                those that hit nothing (0: all hit), relative to a mean of all rays along the
    ///                normal: exactly along the normal if no ray hits
    /// \return for each point 0 (hidden) to 1 (open); rays below the triangle's plane do not count
    [[nodiscard]] std::vector<double> open_shares(const RayScene& scene,
                                                  std::span<const OcclusionPlace> points,
                                                  Report& report,
                                                  std::span<glm::dvec3> bent = {}) const;

  private:
    std::optional<double> distance_;
    std::uint32_t rays_;
};

/// The rays of a point behind the surface.
struct PointThickness {
    double distance = 0.0;   ///< The sum over the rays; a ray that hits nothing has its length.
    std::uint32_t rays = 0;  ///< Without those above the plane of the triangle.
    std::uint32_t hits = 0;
};

/// Thickness: the distances of rays into the surface, distributed as those of Occlusion about the
/// reversed normal.
class Thickness {
  public:
    Thickness(const ThicknessOptions& options, std::uint32_t samples);

    [[nodiscard]] std::uint32_t rays_of_sample() const { return rays_; }

    /// Returns the length of the rays.
    static double limit(const RayScene& scene, const ThicknessOptions& options);

    /// \param report  as Occlusion::open_shares()
    [[nodiscard]] std::vector<PointThickness> measure(const RayScene& scene,
                                                      std::span<const OcclusionPlace> points,
                                                      Report& report) const;

  private:
    std::optional<double> distance_;
    std::uint32_t rays_;
};

/// The ids of the samples of some texels.
class TexelIds {
  public:
    explicit TexelIds(std::size_t texels) : first_(texels) {}

    void add(std::size_t texel, std::uint32_t id);

    /// Returns the id that most samples have; of equally frequent ones, the smallest. None if the
    /// texel has no sample.
    [[nodiscard]] std::optional<std::uint32_t> most_frequent(std::size_t texel) const;

  private:
    struct Votes {
        std::uint32_t id = 0;
        std::uint32_t count = 0;
    };
    std::vector<Votes> first_;  ///< The id of the first sample, by texel.
    /// The numbers of samples with other ids, by texel and id. Few texels have any.
    std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> others_;
};

/// The hit of a sample.
struct LayerHit {
    RayHit hit;
    CoveredTexel owner;        ///< The point of the low mesh.
    std::size_t texel = 0;     ///< Index in the LayerBake.
    std::uint32_t sample = 0;  ///< Index in the texel.
};

/// Numbers of rays.
struct LayerRays {
    std::size_t occlusion = 0;
    std::size_t thickness = 0;
    std::size_t open_thickness = 0;  ///< Those that hit nothing.
};

/// Sums all layers but normals and heights over the samples of some texels.
class LayerBake {
  public:
    /// Returns whether any of these layers is requested.
    static bool is_requested(const BakeLayers& layers) {
        return layers.occlusion || layers.curvature || layers.positions || layers.colors ||
               layers.opacity || layers.surface || layers.emission || layers.bent_normals ||
               layers.thickness || layers.ids;
    }

    /// \param first_texel  the map index of the first texel
    /// \param texels       the number of texels
    /// \param min_samples  the minimum number of samples of a texel
    LayerBake(const BakeWork& work, std::size_t first_texel, std::size_t texels,
              std::uint32_t min_samples);

    /// Adds hits. \param occluders  what blocks the rays of occlusion and bent normals
    /// \return the numbers of rays
    LayerRays add(const HighSurface& high, const RayScene& occluders,
                  std::span<const LayerHit> hits, Report& report);

    /// Writes the means of a texel to index `at` of the rows.
    void store(std::size_t texel, const BakedRows& rows, std::size_t at, Report& report) const;

  private:
    /// The sums of a texel's bent normal, in the space of the map.
    struct BentSum {
        glm::dvec3 direction{0.0};
        glm::dvec3 normal{0.0};
        bool lacks_frame = false;  ///< True if it holds for any sample.
    };

    std::vector<OcclusionPlace> points_of(const HighSurface& high, std::span<const LayerHit> hits,
                                          Report& report) const;
    std::size_t add_occlusion(const RayScene& scene, std::span<const LayerHit> hits,
                              std::span<const OcclusionPlace> points, Report& report);
    void add_bent(const LayerHit& here, const glm::dvec3& normal, const glm::dvec3& direction);
    std::size_t add_thickness(const RayScene& scene, std::span<const LayerHit> hits,
                              std::span<const OcclusionPlace> points, Report& report);
    void store_bent(std::size_t texel, const BakedRows& rows, std::size_t at, Report& report) const;

    const BakeWork& work_;
    const BakeLayers& layers_;
    std::size_t first_texel_;
    std::optional<Occlusion> occlusion_;
    std::optional<Thickness> thickness_;
    std::optional<TexelIds> ids_;
    std::vector<std::uint32_t> hits_;
    std::vector<double> open_, curvature_, opacity_, distances_;
    float max_thickness_ =
        0.0F;  ///< The largest float that does not exceed LayerBounds::thickness.
    std::vector<bool> has_surface_behind_;
    std::vector<BentSum> bent_;
    std::vector<glm::dvec3> positions_, colors_, surfaces_, emission_;
};

}  // namespace relief::detail
