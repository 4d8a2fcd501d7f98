// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bakes maps for a low-poly mesh from high-poly meshes: normals, and optionally heights,
/// occlusion, bent normals, thickness, curvature, positions, ids, colors, surfaces and emission.
/// Part of the library relief::bake.
/// Tests: tests/mesh/bake/bake_layers_test.cpp, bent_normals_test.cpp, bake_ids_test.cpp,
/// tests/mesh/bake/high_materials_test.cpp, tests/mesh/bake/bake_test.cpp, baker_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bake_ids.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/texel_coverage.h"

namespace RELIEF_API relief {

struct BakeShard;  // bake_shards.h

// Options of the layers that a bake computes from the same rays: normals, heights, occlusion, bent
// normals, thickness, curvature, positions, ids, colors, surfaces and emission. A layer that is not
// requested costs no time and no memory, and layers do not affect each other.

/// Options of ambient occlusion: the fraction of rays from a point that hit nothing. Rays are
/// cosine-distributed about the normal, like light from a uniform sky.
struct OcclusionOptions {
    /// Rays per texel, 1 to 65536, divided evenly among its samples. The error decreases by a
    /// factor of about 2^-0.75 for each doubling.
    int rays = 64;
    /// The length of the rays in the unit of the meshes. If absent, half of the longest side of the
    /// high meshes' bounding box.
    std::optional<double> distance{};

    friend bool operator==(const OcclusionOptions&, const OcclusionOptions&) = default;
};

/// Options of thickness: the mean distance to the surface behind a point. Rays are
/// cosine-distributed about the reversed normal.
struct ThicknessOptions {
    /// Rays per texel, 1 to 65536, divided evenly among its samples.
    int rays = 64;
    /// The length of the rays in the unit of the meshes, which is also the thickness of a ray that
    /// hits nothing. If absent, the longest side of the high meshes' bounding box.
    std::optional<double> distance{};
};

/// Computes ambient occlusion at the vertices of meshes that share a space.
///
/// \param receivers  the meshes with the vertices; of those without normals, vertex_normals() are
///                   used. Rays are distributed about the normal of the vertex, from a point
///                   slightly above it
/// \param occluders  what rays hit, front or back; usually the same meshes
/// \param options    rays of a vertex instead of a texel
/// \return for each receiver and vertex, from 0 (hidden) to 1 (open); 1 for vertices without a
///         direction or with a position that is not finite. The same bits for any number of threads
/// \throws InvalidInput if a mesh is not valid, or the options are not; Cancelled
std::vector<std::vector<float>> vertex_occlusion(std::span<const Mesh> receivers,
                                                 std::span<const Mesh> occluders,
                                                 const OcclusionOptions& options,
                                                 const ExecutionOptions& execution = {});

/// The layers to bake. Each value is the mean over those samples of a texel that hit; all layers
/// are padded in the same way.
struct BakeLayers {
    bool normals = true;
    /// The height of the high surface above the low mesh along the ray, in the unit of the meshes.
    bool heights = false;
    /// Ambient occlusion from 0 to 1, by the high meshes alone. Rays are distributed about the
    /// interpolated normal; those below the plane of their triangle are ignored. Back faces occlude
    /// too.
    std::optional<OcclusionOptions> occlusion{};
    /// Mean curvature in one over the unit of the meshes; convex is positive (curvature.h).
    bool curvature = false;
    /// Positions, transformed by `position_from_mesh`.
    bool positions = false;
    /// Linear RGB: vertex colors times the material's color and texture.
    bool colors = false;
    /// HighMaterial::opacity times the alpha of the color texture and the vertex colors; 1 for
    /// opaque materials.
    bool opacity = false;
    /// Occlusion, roughness and metalness of the materials, in the order of glTF's channels. This
    /// occlusion is that of the materials' textures alone.
    bool surface = false;
    bool emission = false;               ///< Linear RGB: the material's emission times its texture.
    glm::dmat4 position_from_mesh{1.0};  ///< For `positions`.
    /// The mean direction of the occlusion rays that hit nothing, in BakeOptions::space. The mean
    /// over all rays is taken as the normal, so that an open surface has exactly its interpolated
    /// normal. Where no ray is open it is that normal, which is reported. If `occlusion` is also
    /// requested, both have the same options and share their rays.
    std::optional<OcclusionOptions> bent_normals{};
    /// The distance to the nearest high surface behind, front or back. Rays that hit nothing count
    /// with their length, as on an open surface; texels with no other rays are reported.
    std::optional<ThicknessOptions> thickness{};
    /// The index in Baker::ids() that most samples of a texel have; of equally frequent ones, the
    /// first. Ids are never averaged, nor in the padding.
    bool ids = false;
};

/// Upper bounds of the absolute values of layers, for integer storage.
struct LayerBounds {
    double height = 0.0;         ///< The length of the rays.
    double curvature = 0.0;      ///< Over all vertices of the high meshes.
    double curvature_p99 = 0.0;  ///< Over 99% of their area.
    double position = 0.0;       ///< Over all coordinates, transformed by `position_from_mesh`.
    double emission = 0.0;       ///< Over all materials and the texels of their textures.
    double thickness = 0.0;      ///< The length of its rays.
};

/// An image on a mesh. It is sampled at full resolution, bilinearly or nearest, as `filter` says; a
/// map that is coarser than the image needs several samples per texel.
struct SurfaceTexture {
    std::shared_ptr<const Image> image;  ///< One to four channels.
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    GltfTextureTransform transform{};
};

/// A normal map and its conventions.
struct SurfaceNormalMap {
    SurfaceTexture texture;  ///< Three or four channels.
    float scale = 1.0F;      ///< Multiplies x and y.
    Green green = Green::up;
    FlatCode flat = FlatCode::half;  ///< The formula of glTF.
    /// The codes of x and y that are decoded as exactly flat, see flat_texel_codes(). Only for
    /// FlatCode::half.
    std::optional<std::array<std::uint16_t, 2>> flat_codes{};
};

struct HighMaterial {
    glm::vec3 color{1.0F};  ///< Linear; multiplied by the texture and the vertex colors.
    /// Gray or RGB, with or without alpha; sRGB or linear, as the image says.
    std::optional<SurfaceTexture> color_texture;
    std::optional<SurfaceNormalMap> normal_map;
    /// Multiplied by the alpha of the texture and the vertex colors. Absent: the material is
    /// opaque, whatever these are.
    std::optional<float> opacity{};
    /// For materials with an opacity: an opacity of at least this one becomes 1, any other 0.
    std::optional<float> alpha_cutoff{};
    float roughness = 1.0F;  ///< Multiplied by the green of `surface_texture`.
    float metallic = 0.0F;   ///< Multiplied by the blue of `surface_texture`.
    std::optional<SurfaceTexture> surface_texture{};
    std::optional<SurfaceTexture> occlusion_texture{};  ///< Red is the occlusion; absent: 1.
    /// The share of the occlusion texture, 0 to 1: 0 is no occlusion.
    float occlusion_strength = 1.0F;
    glm::vec3 emission{0.0F};  ///< Linear, at least 0; multiplied by the texture.
    std::optional<SurfaceTexture> emission_texture{};
};

/// The materials of a high mesh.
struct HighMaterials {
    const Mesh* mesh = nullptr;           ///< A high mesh of the bake, identified by its address.
    std::vector<HighMaterial> materials;  ///< Indexed by the mesh's material ranges.
    /// The texture coordinates of all textures but normal maps, by vertex. If empty, those of the
    /// mesh. Normal maps always use those of the mesh, with its tangents or MikkTSpace's.
    std::vector<glm::vec2> color_texcoords;
    std::optional<HighMaterial> otherwise{};  ///< The material of triangles without a material.
};

/// The ray direction, before BakeOptions::hardness is applied.
enum class RayDirections {
    averaged,  ///< Smoothed normals: hard edges are ignored, so they leave no gaps.
    shading,   ///< The vertex normals of the low mesh; rays diverge at hard edges.
    face,      ///< The face normal of each triangle.
};

template <>
inline constexpr auto enum_names<RayDirections> =
    std::to_array<EnumName<RayDirections>>({{"averaged", RayDirections::averaged},
                                            {"shading", RayDirections::shading},
                                            {"face", RayDirections::face}});

/// The sides of the high meshes' triangles that rays can hit.
enum class BackFaces {
    skip,  ///< Only front faces (counter-clockwise).
    take,  ///< Both sides; normals are flipped to face the ray's origin.
};

/// The rows [first, last) of a map.
struct BakeRowRange {
    int first = 0;  ///< A multiple of 64.
    int last = 0;   ///< A multiple of 64, or the height of the map.
};

/// The progress of a map.
struct BakeProgress {
    int rows = 0;  ///< Number of finished rows.
    std::size_t rays = 0;
};

/// The options of one map. A Baker can bake many maps of the same meshes with different options.
struct BakeMapOptions {
    int width = 0;  ///< In texels.
    int height = 0;
    MapRegion placement{};  ///< The part of texture space that the map shows.
    /// The triangles of the low mesh that the map shows, ascending: those of a material or a tile.
    /// If absent, all.
    std::optional<std::vector<std::uint32_t>> triangles{};
    /// Bakes only these rows, so that several maps can be computed in parallel. There is no padding
    /// then. Findings about triangles are reported only with row 0.
    std::optional<BakeRowRange> rows;
    /// Samples per texel: 1, 4, 16, 64 or 256, at the centers of a regular grid within the texel; a
    /// texel is their mean. 1024 samples are the reference for maps of 256 samples, and limited to
    /// maps of at most 2048 texels. Each sample has its own triangle (texel_coverage.h); samples
    /// outside of all charts are ignored.
    int samples = 1;
    /// Adaptive sampling, with several samples: first a quarter of the samples is cast (of 4 the
    /// upper left and the lower right one), and the others only if two of these normals differ by
    /// more than this angle in radians.
    std::optional<double> sample_angle{};
    /// If given, the whole map is filled, at any distance from charts. Rows are delivered when all
    /// are baked; until then they are stored in a temporary file in this folder, with 4 bytes per
    /// texel for each channel of each layer, plus 3.
    std::optional<std::filesystem::path> border_folder{};
    /// If given, it is called with the progress of the map, from any thread, one call at a time.
    std::function<void(const BakeProgress& progress)> progress{};
    /// The width of the padding around charts, 0 to 1024 texels: texels without a result are filled
    /// from the nearest baked texel, or from the mean of several at the same distance.
    int padding = 0;
    /// Measures the ray length that missed texels need: the `clipped` fields of BakeResult. This
    /// casts two more rays for each missed texel.
    bool measures_missed = false;
    /// The layers of this map. They must be a subset of those that the Baker was created with.
    BakeLayers layers{};
};

/// The options that all maps of a Baker share.
struct BakeOptions {
    /// The options of the map of bake_normals(). A Baker, whose bake() has its own, uses only
    /// `layers` (those that maps can have), `sample_angle` (whether maps sample adaptively) and the
    /// numbers of texels and samples, to estimate how much preparation is worthwhile.
    BakeMapOptions map{};
    VectorSpace space = VectorSpace::tangent;            ///< Of normals; see `output_from_mesh`.
    RayDirections directions = RayDirections::averaged;  ///< Before `hardness` is applied.
    /// For RayDirections::averaged: the interpolation weight from the smoothed normals (0) to the
    /// vertex normals (1). It matters only at hard edges.
    double hardness = 0.0;
    /// A cage: the low mesh, moved outwards, with the same triangles. Rays then run from the cage
    /// to the low mesh, and `directions`, `hardness` and `offset` are ignored.
    std::shared_ptr<const Mesh> cage;
    /// The distance from the low mesh at which rays begin outside, and end inside, in the unit of
    /// the meshes. If absent, automatic_distances() decides; with a cage, the inner distance equals
    /// that of the cage.
    std::optional<double> offset;
    std::optional<double> max_distance;
    BackFaces back_faces = BackFaces::skip;  ///< Of the high meshes.
    /// Accepts high and low meshes whose bounding boxes differ in size by more than max_size_ratio;
    /// see BakeMismatch.
    bool allow_size_mismatch = false;
    /// For parts that do not see each other: whether the high meshes of all parts block the rays of
    /// occlusion. Otherwise only those of the part do.
    bool parts_occlude = false;
    /// The expected number of maps. For many maps, the baker spends more time on preparation. The
    /// results do not depend on it.
    std::size_t map_count = 1;
    /// Except in tangent space: the transform from the space of the meshes to that of the map.
    /// Results are normalized.
    glm::dmat3 output_from_mesh{1.0};
    /// The materials of high meshes, for those that have them.
    std::vector<HighMaterials> materials;
    /// The names of triangles for BakeLayers::ids. High meshes that are not in it have those of
    /// names_by_material() without names, with Mesh::name for triangles without a material.
    std::vector<HighIds> ids{};
};

/// The origin of a texel's value.
enum class TexelState : std::uint8_t {
    empty,   ///< No chart overlaps the texel.
    missed,  ///< No ray hit a surface, and the texel was not padded.
    baked,
    padded,  ///< Filled from the nearest baked texels. The texel may have been missed.
};

/// The rows of a map. Spans of layers that were not requested are empty. Spans are
/// valid during the call that receives them.
struct BakedRows {
    int first_row = 0;
    int row_count = 0;
    /// Three per texel, unit; (0, 0, 1) in texels that are neither baked nor padded.
    std::span<float> normals;
    /// 0 in such texels, as in all other layers except occlusion, which is 1.
    std::span<float> heights;
    std::span<TexelState> states;
    std::span<float> occlusion{};
    std::span<float> curvature{};
    std::span<float> positions{};  ///< Three per texel.
    std::span<float> colors{};     ///< Three per texel.
    std::span<float> opacity{};
    /// Three per texel. Roughness is 0 in texels that are neither baked nor padded.
    std::span<float> surface{};
    std::span<float> emission{};  ///< Three per texel.
    /// Three per texel, unit; (0, 0, 1) in texels that are neither baked nor padded.
    std::span<float> bent_normals{};
    std::span<float> thickness{};  ///< In the unit of the meshes.
    std::span<float> ids{};        ///< Indices in Baker::ids(); -1 in such texels.
};

enum class LayerKind {
    height,
    occlusion,
    curvature,
    position,
    color,
    surface,
    emission,
    bent_normal,
    thickness,
    id
};

/// The "relief:content" of files.
template <>
inline constexpr auto enum_names<LayerKind> =
    std::to_array<EnumName<LayerKind>>({{"height map", LayerKind::height},
                                        {"ambient occlusion", LayerKind::occlusion},
                                        {"curvature", LayerKind::curvature},
                                        {"positions", LayerKind::position},
                                        {"colors", LayerKind::color},
                                        {"surface", LayerKind::surface},
                                        {"emission", LayerKind::emission},
                                        {"bent normals", LayerKind::bent_normal},
                                        {"thickness", LayerKind::thickness},
                                        {"ids", LayerKind::id}});

/// The values of a layer.
std::span<const float> layer_values(LayerKind kind, const BakedRows& rows);

/// The encoding of a layer. Floats store values as they are, colors linearly. With 8 and 16 bits,
/// occlusion and surfaces are code / 255 or code / 65535, colors are sRGB, and emission is range
/// times sRGB; thickness is range * code / 255 or range * code / 65535; signed layers are range *
/// (code - 128) / 127 or range * (code - 32768) / 32767, so that 0 is exact. Bent normals are coded
/// as normal maps, also in floats. Ids are stored as their colors, which are data; texels without
/// an id are black.
struct LayerCoding {
    LayerKind kind = LayerKind::height;
    int bits = 16;
    double range = 1.0;  ///< Of signed layers, thickness and emission in 8 and 16 bits.
    NormalMapFormat normal_format{};           ///< Of bent normals; its bits are ignored.
    VectorSpace space = VectorSpace::tangent;  ///< Of bent normals.
    std::vector<SurfaceId> ids{};              ///< Of ids: Baker::ids().

    [[nodiscard]] bool is_signed() const {
        return kind == LayerKind::height || kind == LayerKind::curvature ||
               kind == LayerKind::position;
    }
    /// Returns whether values are multiplied by `range` in 8 and 16 bits.
    [[nodiscard]] bool has_range() const {
        return is_signed() || kind == LayerKind::emission || kind == LayerKind::thickness;
    }
    /// The channels of the image.
    [[nodiscard]] std::size_t channels() const {
        return kind == LayerKind::height || kind == LayerKind::occlusion ||
                       kind == LayerKind::curvature || kind == LayerKind::thickness
                   ? 1
                   : 3;
    }
    /// The number of values per texel.
    [[nodiscard]] std::size_t values() const { return kind == LayerKind::id ? 1 : channels(); }
    [[nodiscard]] ColorSpace color_space() const;

    /// The code of zero in signed layers: 128 or 32768.
    [[nodiscard]] int zero_code() const { return bits == 8 ? 128 : 32768; }

    /// The parameters of a displacement (value - midlevel) * strength, for values from 0 to 1.
    [[nodiscard]] double strength() const;
    [[nodiscard]] double midlevel() const;
};

/// Encodes rows of a layer.
/// \param has_alpha    appends an alpha channel, which is 1 for baked and padded texels
/// \param first_texel  the index of the first texel in the map
/// \param report       counts values outside the range, which are clamped
/// \param opacity      one per texel, for the alpha channel instead of 1; empty: 1
std::vector<std::byte> encode_layer(std::span<const float> values,
                                    std::span<const TexelState> states, const LayerCoding& coding,
                                    bool has_alpha, std::size_t first_texel,
                                    Report& report = IgnoredReport(),
                                    std::span<const float> opacity = {});

/// Returns the text entries of a layer's file: those of write_description() (map_description.h),
/// and for signed layers in 8 and 16 bits "relief:range" and "relief:zero"; for emission and
/// thickness "relief:range"; for ids "relief:ids", with a line "#a0b1c2 name" for each. \param
/// alpha  the content of the alpha channel; absent: there is none
std::map<std::string, std::string> layer_metadata(const LayerCoding& coding,
                                                  std::optional<AlphaContent> alpha = {});

struct BakeDistances {
    double offset = 0.0;        ///< Outside of the low mesh.
    double max_distance = 0.0;  ///< Inside of the low mesh.
};

/// A texel whose rays hit nothing.
struct MissedTexel {
    int x = 0;
    int y = 0;
    glm::dvec3 position{0.0};  ///< The point of its first sample on the low mesh.
};

/// Missed texels that longer rays would hit, on one side of the low mesh.
struct ClippedRays {
    std::size_t texels = 0;
    double shortest = 0.0;  ///< The ray length from the low mesh that hits at least one of them.
    double half = 0.0;  ///< The length that hits at least half of them, rounded up by at most 1/8.
    double longest = 0.0;  ///< The length that hits all of them.
};

struct BakeResult {
    Coverage coverage;  ///< Counts samples if there are several per texel.
    std::size_t texels_baked = 0;
    std::size_t texels_missed = 0;
    std::size_t samples = 0;  ///< Number of points for which rays were cast.
    std::size_t rays = 0;
    std::size_t occlusion_rays = 0;       ///< Also of bent normals. Not included in `rays`.
    std::size_t thickness_rays = 0;       ///< Not included in `rays`.
    std::size_t open_thickness_rays = 0;  ///< Those of `thickness_rays` that hit nothing.
    BakeDistances distances;              ///< Baker::distances().
    /// Minimum and maximum height of the high surface above the low mesh, over all samples that
    /// hit; 0 if none did.
    double min_height = 0.0;
    double max_height = 0.0;
    std::vector<MissedTexel> first_missed;  ///< In order of row and column, at most 8.
    /// With BakeMapOptions::measures_missed: results for the line through the first sample of each
    /// missed texel. Each texel is counted at most once; the triangle nearest to it decides.
    std::size_t missed_from_behind = 0;  ///< The line hits only back faces within its length.
    ClippedRays clipped_outside;         ///< A longer BakeOptions::offset would hit.
    ClippedRays clipped_inside;          ///< A longer BakeOptions::max_distance would hit.
    std::size_t measuring_rays = 0;      ///< Not included in `rays`.
};

/// A comparison of the bounding boxes of the high and low meshes. A box contains all triangles with
/// finite corners.
struct BakeFit {
    Bounds high, low;
    double gap = 0.0;  ///< The distance between the boxes; 0 if they touch or overlap.
    /// The diagonal of the high box divided by that of the low box; 1 if one is 0.
    double size_ratio = 1.0;
    /// True if the up axes seem to differ (Y up and Z up): after a rotation of the high meshes by
    /// 90 degrees about x, the faces of the boxes agree within 3% of the low box's diagonal;
    /// without the rotation, they differ by more than 10%.
    bool fits_rotated = false;

    /// Returns true if the diagonals differ by more than a factor of max_size_ratio.
    [[nodiscard]] bool differs_in_size() const;
};
BakeFit compare_boxes(std::span<const Mesh> high, const Mesh& low);

/// A scale and a shift of the high meshes that explain why they do not agree with the low mesh.
struct BakeCorrection {
    double scale = 1.0;            ///< The size of the high meshes divided by that of the low mesh.
    glm::dvec3 shift{0.0};         ///< From the center of the low mesh to that of the high meshes.
    double median_distance = 0.0;  ///< As in BakeAgreement, if the high meshes are corrected.
    double mean_angle = 0.0;
};

/// The agreement of the high and low surfaces, measured by the rays of 1024 points that are spread
/// over the area of the low mesh. It depends slightly on the order of the low triangles.
struct BakeAgreement {
    std::size_t samples = 0;  ///< The number of rays; 0 if the low mesh has no area.
    std::size_t missed = 0;   ///< The number of rays without a result.
    /// The number of rays that hit only back faces, or a back face with BackFaces::take.
    std::size_t from_behind = 0;
    /// The distance of the high surface from the low mesh along the ray. A missed ray counts with
    /// its length.
    double median_distance = 0.0;
    /// The mean angle between the triangles of both, in radians, over the rays with a result. Back
    /// faces and larger angles count as 90 degrees.
    double mean_angle = 0.0;
    double half_diagonal = 0.0;  ///< Of the low mesh's box, to compare distances with.
    /// Present if the surfaces differ by more than 8 degrees and 1% of `half_diagonal`, and the
    /// correction leaves at most a quarter of the distance and 3/4 of the angle.
    std::optional<BakeCorrection> correction;
};

/// The maximum ratio of the diagonals of two boxes; beyond it, the meshes probably have different
/// units.
inline constexpr double max_size_ratio = 10.0;

/// Thrown if the high and low meshes do not match.
class BakeMismatch : public InvalidInput {
  public:
    enum class Kind {
        no_surface,  ///< No high triangle has finite corners.
        size,        ///< The diagonals differ by more than a factor of max_size_ratio.
        apart,       ///< The gap between the boxes exceeds the length of the rays.
    };
    BakeMismatch(Kind kind, const BakeFit& fit, double reach, std::string part);

    [[nodiscard]] Kind kind() const { return kind_; }
    [[nodiscard]] const BakeFit& fit() const { return fit_; }
    /// The maximum ray length from the low mesh. For automatic distances it is at most half of the
    /// low box's diagonal.
    [[nodiscard]] double reach() const { return reach_; }
    [[nodiscard]] const std::string& part() const { return part_; }  ///< BakePart::name.

  private:
    Kind kind_;
    BakeFit fit_;
    double reach_;
    std::string part_;
};

/// Computes ray distances for two surfaces that are close to each other.
///
/// d is the maximum distance of 16384 points on the low mesh to the high meshes. If vertices of the
/// high meshes (as many) are farther from the low mesh, d is their maximum distance, but at most 4
/// times the former value, because the high meshes may have parts that the low mesh lacks. Both
/// distances are 1.5 d plus 1% of half of the longest side of the low mesh's box. The points depend
/// on the order of the low triangles and their first corners. Collapsed triangles have none.
BakeDistances automatic_distances(std::span<const Mesh> high, const Mesh& low);

/// High meshes that only some triangles of the low mesh see. The rays of all other triangles ignore
/// them, so that adjacent objects do not occlude each other.
struct BakePart {
    std::span<const Mesh> high;
    std::vector<std::uint32_t> triangles;  ///< Of the low mesh.
    std::string name{};                    ///< For messages.
};

/// Prepares the meshes of a bake for any number of maps: an acceleration structure for the high
/// meshes, ray directions over the whole low mesh (so that they are continuous across materials and
/// tiles), and ray distances.
///
/// *Surface selection.* A ray runs from outside to inside through the point of a texel on the low
/// mesh. Its first hit counts unless a surface between the hit and the point faces the low mesh. So
/// the outer one of two stacked sheets is baked, because it is the visible one. The inner side of a
/// fold and the far side of a thin wall are not baked: on the way outwards from the point, the line
/// leaves the solid, and a surface behind the next solid belongs to another part. If the point lies
/// inside of several intersecting solids, their outermost surface counts. See ray_scene.h.
///
/// Hits of Embree are refined in double precision. The result is the same bits for any number of
/// threads, and for any order of triangles and vertices and any first corners of the high meshes.
/// First corners change only a normal map on high meshes whose MikkTSpace tangents are computed, as
/// far as these change (tangents.h). Collapsed and repeated high triangles have no influence,
/// except that the latter have no curvature. The order of the low triangles changes the result in
/// two cases: of identical triangles in the texture the first one wins, and automatic_distances()
/// depend on it. Their first corners change it by rounding, because tangents of MikkTSpace do, and
/// so do sums over corners: normals turn by less than 0.001 degrees, except where a ray that meets
/// an edge hits its other triangle.
///
/// Memory: about 110 bytes per triangle of the high meshes, and for each map the memory of
/// cover_texels() and about 64 MB, or 64 rows and twice the padding; never the whole map.
class Baker {
  public:
    /// Prepares the meshes.
    ///
    /// \param high  in the same space as `low`; missing normals are averaged (frames.h)
    /// \param low  with texture coordinates; missing normals are averaged and missing tangents are
    ///         computed by MikkTSpace, as renderers do
    /// \param options  see BakeOptions::map for the options of a map
    /// \param report  counts problems of the meshes
    /// \throws InvalidInput if an option is out of range, a mesh is not valid, `low` has no texture
    ///         coordinates, or the triangles of the cage differ from those of `low`; BakeMismatch
    ///         if the boxes of high and low meshes do not match. This is checked before the
    ///         acceleration structure is built, unless the low mesh has no finite triangle
    ///
    /// The high meshes must outlive the Baker.
    Baker(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
          Report& report = IgnoredReport());

    /// Prepares parts that do not see each other, each with its own distances. A part may have no
    /// high mesh; its texels are missed. BakeMismatch describes a single part.
    /// \throws InvalidInput also if a triangle of `low` is not in exactly one part
    Baker(std::span<const BakePart> parts, const Mesh& low, const BakeOptions& options,
          Report& report = IgnoredReport());

    ~Baker();
    Baker(Baker&&) noexcept;
    Baker& operator=(Baker&&) noexcept;

    /// The low mesh with the frames for which its maps are baked.
    [[nodiscard]] const Mesh& low() const;

    [[nodiscard]] const BakeOptions& options() const;

    /// The distances that are used: the maximum of all parts. With a cage, the inner distance, or 0
    /// if it varies.
    [[nodiscard]] BakeDistances distances() const;

    /// The comparison of the bounding boxes; with parts, of the boxes of all parts together.
    [[nodiscard]] BakeFit fit() const;

    /// The agreement of the surfaces. If they do not agree, the report of the constructor has one
    /// of the findings "high model of another size" (unless BakeOptions::allow_size_mismatch is
    /// set), "high model at another position" and "surfaces that do not agree" (35 degrees and 5%
    /// of the half diagonal).
    [[nodiscard]] const BakeAgreement& agreement() const;

    /// The ids of all high meshes, sorted by name; empty without BakeLayers::ids.
    [[nodiscard]] const std::vector<SurfaceId>& ids() const;

    /// Upper bounds of the values of the requested layers; 0 for the others.
    [[nodiscard]] LayerBounds bounds(const BakeLayers& layers) const;

    /// Bakes a map.
    ///
    /// \param take  receives bands of rows from the top, on the calling thread, and may change
    ///         them. Row counts are multiples of 64, except for the last band
    /// \param report  counts a whole map without a covered texel; texels that are missed, have no
    ///         frame, face away from the baked surface, or are covered by several triangles;
    ///         triangles that cover no texel; rays without a direction, which use the face normal;
    ///         high vertices without a normal, which use the face normal; texels without an open
    ///         ray, or with a bent normal behind the low surface; and texels without a surface
    ///         behind them
    /// \param execution  threads, progress and cancellation; the map does not depend on it
    /// \throws InvalidInput if a size or an option is out of range, or a triangle does not exist;
    ///         Cancelled
    BakeResult bake(const BakeMapOptions& map,
                    const std::function<void(const BakedRows& rows)>& take,
                    Report& report = IgnoredReport(), const ExecutionOptions& execution = {}) const;

    /// Bakes only some rows of a map, for merge_shards() (bake_shards.h).
    ///
    /// \param map   as for bake(). The padding is left to merge_shards(); `rows` must be absent
    /// \param rows  multiples of 4, or the height of the map
    /// \param take  receives these rows from the top, without padding
    /// \throws InvalidInput as bake(); Cancelled
    [[nodiscard]] BakeShard bake_shard(const BakeMapOptions& map, const BakeRowRange& rows,
                                       const std::function<void(const BakedRows& rows)>& take,
                                       const ExecutionOptions& execution = {}) const;

  private:
    struct Implementation;
    BakeShard bake_range(const BakeMapOptions& map, const BakeRowRange& rows,
                         const std::function<void(const BakedRows& rows)>& take) const;
    std::unique_ptr<Implementation> implementation_;
};

/// Bakes one normal map: creates a Baker and calls its bake().
BakeResult bake_normals(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
                        const std::function<void(const BakedRows& rows)>& take,
                        Report& report = IgnoredReport(), const ExecutionOptions& execution = {});

}  // namespace relief
