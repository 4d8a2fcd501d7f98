// SPDX-License-Identifier: Apache-2.0
/// \file
/// Maps of detailed meshes for a simple one: what rays from its surface meet, normals unless told
/// otherwise. In the library relief::bake. Tests: tests/mesh/bake/bake_test.cpp, baker_test.cpp,
/// bake_layers_test.cpp, bake_sphere_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/bake_layers.h"
#include "relief/mesh/error.h"
#include "relief/mesh/high_detail.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_space.h"
#include "relief/mesh/report.h"
#include "relief/mesh/texel_coverage.h"

namespace relief {

/// What the normals of a map are relative to.
enum class BakeSpace {
    tangent,  ///< The low mesh's normals and tangents, as the shader interpolates them.
    object,   ///< The space that all meshes are given in.
};

/// Along what rays are cast, before any blending.
enum class RayDirections {
    averaged,  ///< Normals averaged over everything that meets at a position: no gaps at hard
               ///< edges.
    shading,   ///< The low mesh's own normals: rays part at hard edges.
    face,      ///< Of each triangle.
};

/// Which side of a high mesh's triangles counts.
enum class BackFaces {
    skip,  ///< The outer one (counter-clockwise) alone.
    take,  ///< Either; normals are turned to where the ray comes from.
};

/// Rows [first, last) of a map.
struct BakeRowRange {
    int first = 0;  ///< A multiple of 64.
    int last = 0;   ///< Likewise, or the map's height.
};

/// How far a map is.
struct BakeProgress {
    int rows = 0;  ///< Done, of the map's height.
    std::size_t rays = 0;
};

/// One map of a bake. There may be many on the same meshes, each with options of its own.
struct BakeMapOptions {
    int width = 0;  ///< In texels.
    int height = 0;
    MapPlacement placement{};
    /// Those triangles of the low mesh that the map is for, ascending: a material's, a tile's.
    /// Absent: all. The span must outlive the call.
    std::optional<std::span<const std::uint32_t>> triangles{};
    /// Only these rows, for those who want several maps side by side; there is no padding then.
    /// What is said of triangles is said with row 0.
    std::optional<BakeRowRange> rows;
    /// A texel's mean of 1, 4, 16, 64 or 256 samples, the centres of as many equal squares of it;
    /// 1024 serve as the reference that 256 are compared with, for maps of at most 2048 texels.
    /// Each has an owner of its own (texel_coverage.h); those that no chart reaches have no say.
    int samples = 1;
    /// With several samples: a quarter of them is cast first (of 4: the upper left and the lower
    /// right one), and the others only where two of those are further apart than this, radians.
    std::optional<double> sample_angle{};
    /// Fills all of the map instead, however far from any chart. Rows are handed on when all are
    /// baked, and kept until then in a file without a name in this folder: 4 bytes a texel for each
    /// channel of each layer, and 3.
    std::optional<std::filesystem::path> border_folder{};
    /// Told how far a map is, one call at a time, from any thread.
    std::function<void(const BakeProgress& progress)> progress{};
    /// How far around charts, in texels, what is not baked is filled from the nearest texels that
    /// are: the mean of them, where several are equally near. 0 to 1024.
    int padding = 0;
    /// Measures how long rays would have to be for the texels that are missed: the `clipped` fields
    /// of BakeResult. Costs two more rays for each missed texel.
    bool measures_missed = false;
    /// A baker is made for those of its own options, of which each map may leave some out.
    BakeLayers layers{};
};

/// What is alike for all maps, and one map's options.
struct BakeOptions : BakeMapOptions {
    BakeSpace space = BakeSpace::tangent;
    RayDirections directions = RayDirections::averaged;
    /// Of averaged directions: 0 to 1, how far they are drawn to the shading normals, vertex by
    /// vertex; which makes a difference at hard edges only.
    double hardness = 0.0;
    /// The low mesh moved outwards: the same triangles, vertex by vertex. Rays run from it to the
    /// low mesh, and `directions`, `hardness` and `offset` have no say.
    const Mesh* cage = nullptr;
    /// How far outside of the low mesh rays begin, and how far inside of it they end, in the unit
    /// of the meshes. Absent: what automatic_distances() says; inside, with a cage: as far again as
    /// it is outside.
    std::optional<double> offset;
    std::optional<double> max_distance;
    BackFaces back_faces = BackFaces::skip;
    /// Accepts boxes of the high and the low meshes that differ in size by more than max_size_ratio
    /// times; see BakeMismatch.
    bool allow_size_mismatch = false;
    /// How many maps like this one will be baked: many are worth more time to make ready. It
    /// changes nothing else.
    std::size_t map_count = 1;
    /// Turns normals of object space into the axes that they are wanted in, from those of the
    /// meshes; made unit afterwards.
    glm::dmat3 output_from_mesh{1.0};
    /// Of those high meshes that have some. The span must outlive the bake.
    std::span<const HighDetail> details;
};

/// What became of a texel.
enum class TexelState : std::uint8_t {
    empty,   ///< No chart has a part in it.
    missed,  ///< No ray of it met anything, and nothing baked is near.
    baked,
    padded,  ///< Filled from the nearest texels that are baked; it may have been missed.
};

/// Rows of a map: the layers that were asked for (bake_layers.h), others are empty. Spans live as
/// long as the call that they are given to.
struct BakedRows {
    int first_row = 0;
    int row_count = 0;
    std::span<float> normals;  ///< Three a texel, unit; (0, 0, 1) where neither baked nor padded.
    std::span<float> heights;  ///< 0 there, as are the others but for occlusion, which is 1.
    std::span<TexelState> states;
    std::span<float> occlusion{};
    std::span<float> curvature{};
    std::span<float> positions{};  ///< Three a texel.
    std::span<float> colors{};     ///< Three a texel.
};

struct BakeDistances {
    double offset = 0.0;        ///< Outside.
    double max_distance = 0.0;  ///< Inside.
};

/// A texel whose rays hit nothing.
struct MissedTexel {
    int x = 0;
    int y = 0;
    glm::dvec3 position{0.0};  ///< On the low mesh, of its first sample.
};

/// Missed texels that longer rays would hit, on one side of the low mesh.
struct ClippedRays {
    std::size_t texels = 0;
    double shortest = 0.0;  ///< The ray length, from the low mesh, that hits one of them;
    double half = 0.0;      ///< at least half of them, rounded up by at most 1/8;
    double longest = 0.0;   ///< all of them.
};

struct BakeResult {
    Coverage coverage;  ///< Of samples, where there are several to a texel.
    std::size_t texels_baked = 0;
    std::size_t texels_missed = 0;
    std::size_t samples = 0;  ///< Places that rays were cast for.
    std::size_t rays = 0;
    std::size_t occlusion_rays = 0;  ///< Not among those.
    BakeDistances distances;         ///< Baker::distances().
    /// Of the surface outside of the low mesh, over all samples that hit; 0 where none did.
    double least_height = 0.0;
    double greatest_height = 0.0;
    std::vector<MissedTexel> first_missed;  ///< By row and column, at most 8.
    /// With BakeMapOptions::measures_missed, by the line through a missed texel's first sample.
    /// Each texel is counted at most once: the triangle nearest to it decides.
    std::size_t missed_from_behind = 0;  ///< The line meets only back faces within its length.
    ClippedRays clipped_outside;         ///< A longer BakeOptions::offset hits.
    ClippedRays clipped_inside;          ///< A longer BakeOptions::max_distance hits.
    std::size_t measuring_rays = 0;      ///< Not among `rays`.
};

/// How the boxes of high and low meshes compare. A box holds all triangles with finite corners.
struct BakeFit {
    Bounds high, low;
    double gap = 0.0;         ///< The distance between the boxes; 0 where they meet.
    double size_ratio = 1.0;  ///< The high box's diagonal over the low one's; 1 where one is 0.
    /// The faces of the boxes lie within 3 % of the low box's diagonal of each other if the high
    /// meshes are turned by 90 degrees about x, but more than 10 % apart as they are: one side is Y
    /// up, the other Z up.
    bool fits_turned = false;

    /// The diagonals differ by more than max_size_ratio times.
    [[nodiscard]] bool differs_in_size() const;
};
BakeFit compare_boxes(std::span<const Mesh> high, const Mesh& low);

/// Boxes whose diagonals differ by more than this are taken for meshes of different units.
inline constexpr double max_size_ratio = 10.0;

/// Thrown for high and low meshes that do not belong together as they are.
class BakeMismatch : public InvalidInput {
  public:
    enum class Kind {
        no_surface,  ///< No high triangle has finite corners.
        size,        ///< The diagonals differ by more than max_size_ratio times.
        apart,       ///< The gap between the boxes is larger than rays are long.
    };
    BakeMismatch(Kind kind, const BakeFit& fit, double reach, std::string part);

    [[nodiscard]] Kind kind() const { return kind_; }
    [[nodiscard]] const BakeFit& fit() const { return fit_; }
    /// The longest ray from the low mesh; where it is measured (automatic_distances()), at most
    /// half of the low box's diagonal.
    [[nodiscard]] double reach() const { return reach_; }
    [[nodiscard]] const std::string& part() const { return part_; }  ///< BakePart::name.

  private:
    Kind kind_;
    BakeFit fit_;
    double reach_;
    std::string part_;
};

/// How far rays must reach for two surfaces that lie close to each other.
///
/// d is the largest distance of 16384 points all over the low mesh from the high ones, or of as
/// many of their vertices from the low one, if that is more, but of this at most 4 times the
/// former: the high ones may have parts that the low one lacks. Both distances are 1.5 d and 1% of
/// half of the longest side of the low mesh's box.
BakeDistances automatic_distances(std::span<const Mesh> high, const Mesh& low);

/// High meshes that only some of the low mesh's triangles see: the rays of others pass through
/// them. So neighbours do not catch each other's rays.
struct BakePart {
    std::span<const Mesh> high;
    std::vector<std::uint32_t> triangles;  ///< Of the low mesh.
    std::string name{};                    ///< For messages.
};

/// The meshes of a bake made ready for any number of maps: the high ones for rays; directions over
/// the whole low one, so that rays do not part where materials or tiles do; distances.
///
/// *Which surface.* Each ray runs from outside, through a texel's point on the low mesh, to inside,
/// and what it meets first counts, if nothing lies between the two that faces the low mesh. So of
/// two sheets one above the other the outer one is baked, as it is the one to be seen; but the
/// inner side of a fold or the far side of a thin wall is not: walking outwards from the point, the
/// line leaves the solid, and what lies behind the next solid that it enters belongs to somewhere
/// else. Where the point lies inside of several solids that pass through each other, their
/// outermost side counts. See projection.h.
///
/// Computed in double, from the triangles that Embree finds. The same bits for any number of
/// threads. Memory: the high meshes' rays (some 100 bytes a triangle), and while a map is baked
/// what cover_texels() takes, some 64 MB or 64 rows, and twice the padding; never the map.
class Baker {
  public:
    /// \param high    in the same space as `low`; those without normals get averaged ones
    ///                (frames.h)
    /// \param low     with texture coordinates; without normals it gets averaged ones, without
    ///                tangents those of MikkTSpace, which is what a renderer would do
    /// \param options  all but those of a map
    /// \param report  counts what is wrong with the meshes
    /// \throws InvalidInput if an option is out of range, a mesh is not valid, `low` has no
    /// texture
    ///         coordinates, or the cage has other triangles; BakeMismatch if the boxes of high and
    ///         low meshes do not fit. That is checked before rays are prepared, and not for a low
    ///         mesh without finite triangles
    ///
    /// High meshes and the cage must outlive this.
    Baker(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options, Report& report);

    /// The same for parts that do not see each other, each with distances of its own. A part may
    /// have no high mesh: its texels are missed. BakeMismatch is about a single part.
    /// \throws InvalidInput also if a triangle of `low` is not in exactly one part
    Baker(std::span<const BakePart> parts, const Mesh& low, const BakeOptions& options,
          Report& report);

    ~Baker();
    Baker(Baker&&) noexcept;
    Baker& operator=(Baker&&) noexcept;

    /// The low mesh with the frames that its maps will be seen with.
    [[nodiscard]] const Mesh& low() const;

    [[nodiscard]] const BakeOptions& options() const;

    /// As used; the largest of all parts. With a cage, the inner one, or 0 where that varies.
    [[nodiscard]] BakeDistances distances() const;

    /// How the boxes of the meshes compare; with parts, the boxes around all of them.
    [[nodiscard]] BakeFit fit() const;

    /// What the layers that are asked for cannot exceed; 0 for the others.
    [[nodiscard]] LayerBounds bounds(const BakeLayers& layers) const;

    /// Bakes a map.
    ///
    /// \param take    gets the map from the top, some rows at a time, on the calling thread; it may
    ///                change them. Row counts are multiples of 64, but for the last
    /// \param report  counts texels that are missed, have no frame, face away from the surface
    ///                baked, or have several owners; triangles that own no texel; rays without a
    ///                direction, which run along the triangle's normal; normals without one, which
    ///                are the triangle's
    /// \throws InvalidInput if a size or an option is out of range, or a triangle is not
    /// there
    BakeResult bake(const BakeMapOptions& map,
                    const std::function<void(const BakedRows& rows)>& take, Report& report) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Bakes the normals of the high meshes into one map for the low one: a Baker and its bake().
BakeResult bake_normals(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
                        const std::function<void(const BakedRows& rows)>& take, Report& report);

}  // namespace relief
