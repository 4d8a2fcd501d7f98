// SPDX-License-Identifier: Apache-2.0
/// \file
/// Makes an asset from a dense mesh: few triangles, texture coordinates, tangents, and maps with
/// the detail of the mesh. Each stage is a call of another component; make_asset() runs them in
/// order. Part of the library relief::make. Tests: tests/make/asset_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/make/remeshing.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/material.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/remesh.h"
#include "relief/mesh/repair.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "relief/mesh/unwrap.h"

namespace RELIEF_API relief {
namespace make {

/// The names of the parts of a mesh. Parts of equal names are one.
struct NamedParts {
    std::vector<std::string> names;
    std::vector<std::uint32_t> part_of;  ///< For each triangle of the mesh, an index of `names`.
};

/// The properties of a material that no map can hold.
struct DrawMode {
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5F;  ///< For AlphaMode::mask.
    bool double_sided = false;

    friend bool operator==(const DrawMode&, const DrawMode&) = default;
};

/// A dense mesh with its materials.
struct AssetSource {
    std::string name;  ///< Of the asset's mesh and material.
    Mesh mesh;         ///< Valid (mesh.h). Without normals, they are computed.
    /// Then edges with a larger angle between their triangles are hard; radians, 0 to pi. Absent:
    /// AssetOptions::crease_angle.
    std::optional<double> crease_angle{};
    glm::dvec3 origin{0.0};  ///< Of the positions (mesh_file.h).
    NamedParts parts{};      ///< Without names, the mesh is one part.
    /// Indexed by the material ranges of the mesh.
    std::vector<HighMaterial> materials;
    /// The material of triangles without a material.
    std::optional<HighMaterial> otherwise;
    /// The names of `materials` for LayerKind::id (names_by_material()); may be shorter.
    std::vector<std::string> material_names;
    /// How `materials` are drawn, one for each; triangles without a material have the default
    /// values. Empty: all are drawn as `shared` says.
    std::vector<DrawMode> draw_modes;
    /// The properties that all materials share, and that the asset gets: the factors that
    /// HighMaterial does not have (clearcoat, index of refraction, ...), and, without `draw_modes`,
    /// the alpha mode and the sides.
    GltfMaterial shared;
};

/// A mesh with which the stages continue, for example the edited result of a stage.
struct AssetStart {
    /// "remesh", "decimate", "unwrap", "frames" or "bake": the first one after "repair".
    std::string stage;
    /// Valid (mesh.h), relative to AssetSource::origin, with the attributes that the stages before
    /// compute.
    Mesh mesh;
    bool is_remeshed = false;  ///< It comes from a closed surface around the source.
    /// For "decimate": the mesh is what "repair" gave, so that its parts and alpha modes are those
    /// of the source.
    bool is_repaired_source = false;
    /// The parts of the mesh, whose names are those of the source. Without names they are not
    /// known.
    NamedParts parts{};
    /// The alpha of each triangle of the mesh; without different ones they are not known.
    std::vector<AlphaMode> alpha_modes{};
};

/// The mesh after a stage.
struct StageMesh {
    const Mesh& mesh;
    NamedParts parts;  ///< Of its triangles; without names they are not known, or all the same.
    /// The alpha of its triangles; empty: they are not known, or all the same.
    std::vector<AlphaMode> alpha_modes;
};

struct AssetOptions {
    /// The steps of the repair; absent: only triangles without area are removed, and those with a
    /// position that is not finite.
    std::optional<RepairOptions> repair = RepairOptions{};
    /// Decides whether a closed surface replaces the triangles before decimation. With
    /// `keep_texcoords`, `automatic` means `never`.
    Remeshing remesh = Remeshing::automatic;
    int resolution = 256;  ///< Of the grid (RemeshOptions::resolution).
    bool shell = false;    ///< Sheets become shells (RemeshOptions::shell).
    /// Decides which side of the triangles is solid (RemeshOptions::sign).
    RemeshSign sign = RemeshSign::flood;
    /// Leaves out the stages before a stage, but "repair". Maps still show the source.
    std::optional<AssetStart> start{};
    std::size_t triangles = 5000;  ///< The target number of triangles, at least 1.
    glm::ivec2 size{2048};         ///< Of the maps in texels, 16 to 16384 each.
    /// The distance of charts in texels; the maps are padded by as many.
    int padding = 8;
    /// Edges with a larger angle between their triangles are hard, and borders of charts where that
    /// is possible; radians, 0 to pi. Absent: all edges are smooth. It also applies to a source
    /// without normals and without AssetSource::crease_angle.
    std::optional<double> crease_angle = 1.0471975511965976;  // 60 degrees
    /// Keeps the texture coordinates of the source instead of computing new ones.
    bool keep_texcoords = false;
    bool occlusion = true;  ///< Bakes an occlusion map of a quarter of the size.
    /// Per texel of the occlusion map, and of bent normals and thickness (0: 32 of these).
    int occlusion_rays = 32;
    int samples = 1;  ///< Per texel (BakeMapOptions::samples).
    /// Which parts of the source the rays of a part of the asset can hit (PartDecision). `name` is
    /// an error, and `automatic` means `all`, if a part of AssetStart has no counterpart.
    PartMatching match = PartMatching::automatic;
    /// Further layers: height, curvature and position of 16 bits, ids of 8; bent normals and
    /// thickness of 16 bits with a quarter of the size, like occlusion.
    std::vector<LayerKind> layers;
    int normal_bits = 8;  ///< Of the normal map: 8 or 16.
    /// Also returns the normals before they are coded (Asset::baked_normals).
    bool keep_baked_normals = false;
    std::size_t levels = 0;  ///< Levels of detail; each has half the triangles of the one before.
    ExecutionOptions execution;
    /// Runs a stage, for measurements and progress; absent: it is only called. Exceptions must
    /// pass.
    std::function<void(std::string_view stage, const std::function<void()>& work)> run_stage;
    /// Receives the mesh after each stage but "bake": after "repair" the dense one, in the space of
    /// AssetSource::origin. Exceptions pass.
    std::function<void(std::string_view stage, const StageMesh& mesh)> take_mesh;
};

/// The names of the stages in their order: "repair", "remesh", "decimate", "unwrap", "frames",
/// "bake". With Remeshing::automatic, "remesh" follows "unwrap", because it judges the result. If
/// triangles are replaced then, "decimate" and "unwrap" run again.
/// \param options  with keep_texcoords there is no "unwrap"; "remesh" is there if it can occur;
///         `start` leaves out stages
std::vector<std::string> stages_of(const AssetOptions& options);

/// The findings of a stage.
struct StageReport {
    std::string stage;
    Report report;
};

/// A level of detail.
struct AssetLevel {
    std::size_t triangles = 0;
    double distance = 0.0;  ///< The largest distance from the finest level, in units of the mesh.
    /// The diameter of the asset on the screen, in pixels, below which the level is used: its
    /// distance is half a pixel then.
    double pixels = 0.0;
    double coverage = 1.0;  ///< The same as a part of a screen of 1920 x 1080.
};

/// A further layer.
struct AssetLayer {
    LayerCoding coding;
    Image image;
};

/// A part of an asset: parts of the source that touch each other are one part.
struct AssetPart {
    std::string name;  ///< "lid", "base + hinge"
    std::size_t source_triangles = 0;
    std::size_t triangles = 0;
};

/// The decision whether the rays of each part of an asset hit only the part of the source with the
/// same name. Rays of occlusion hit all parts.
struct PartDecision {
    bool is_matched = false;
    /// Why parts are not matched; empty if they are, or if the source has one part.
    std::string reason;
    std::vector<AssetPart> parts;  ///< If they are matched.
};

/// An asset in memory.
struct Asset {
    std::string name;
    /// With normals, texture coordinates and tangents (MikkTSpace). Its material ranges are indices
    /// of `draw_modes`; there are none if that is empty.
    Mesh mesh;
    glm::dvec3 origin{0.0};
    std::size_t source_triangles = 0;      ///< After repair.
    std::optional<RemeshDecision> remesh;  ///< If there is a stage "remesh".
    std::optional<AtlasStats> atlas;       ///< Absent with AssetOptions::keep_texcoords.
    PartDecision parts;
    BakeResult bake;
    BakeAgreement agreement;
    // The other maps of the material have 8 bits. A property that is the same everywhere has no
    // map.
    Image normal_map;  ///< Green up; of 8 bits with zero at 127.5, as in glTF, or of 16 bits.
    /// With AssetOptions::keep_baked_normals: the same with 16 bits, whose error is below 0.002
    /// degrees.
    std::optional<Image> baked_normals;
    std::optional<Image> occlusion_map;  ///< Without a `surface_map`.
    std::optional<Image> color_map;      ///< sRGB, with opacity in alpha unless it is opaque.
    /// Occlusion, roughness and metalness in the channels of glTF.
    std::optional<Image> surface_map;
    bool surface_has_occlusion = false;  ///< Otherwise the red of `surface_map` has no meaning.
    std::optional<Image> emission_map;   ///< sRGB; the strength of the material is its unit.
    /// The factors, which maps multiply, the alpha mode and the sides. Its textures and `emission`
    /// are not used.
    GltfMaterial material;
    /// If the asset has several materials: each has the factors and the maps of `material`, but its
    /// own alpha mode and sides. At most one for each alpha mode, in their order.
    std::vector<DrawMode> draw_modes;
    std::vector<AssetLayer> layers;  ///< In the order of AssetOptions::layers.
    std::vector<StageReport> reports;
};

/// Returns how the materials of an asset's file are drawn: Asset::draw_modes, or that of its only
/// material.
std::vector<DrawMode> draw_modes_of(const Asset& asset);

/// A map of an asset, as it is stored.
struct AssetMap {
    std::string name;     ///< In file names: "normal".
    std::string content;  ///< In reports: "normals".
    const Image* image = nullptr;
    std::vector<TextureSlot> slots;               ///< In the material; none for further layers.
    std::map<std::string, std::string> metadata;  ///< The text entries of the file.
};

/// Returns the maps that an asset has: normal, occlusion, color, surface ("orm"), emission, and
/// further layers. They refer to the asset.
std::vector<AssetMap> maps_of(const Asset& asset);

/// The name of AssetMap of a further layer: "height".
std::string layer_name(LayerKind kind);

/// The properties that need a map, because they vary over the surface of a source.
struct VaryingProperties {
    bool color = false;
    bool surface = false;    ///< Roughness or metalness.
    bool occlusion = false;  ///< The occlusion textures of the source.
    bool emission = false;
};

/// Returns the properties that vary by materials, textures or vertex colors. A texture may still
/// turn out to be the same everywhere.
VaryingProperties varying_properties(const Mesh& mesh, const AssetSource& source);

/// Runs the stages from the source to the maps.
///
/// - *repair* merges equal vertices, orients parts outwards and separates non-manifold edges
///   (repair.h), and removes triangles without area. The sides of doubled walls stay together
///   until they are decimated.
/// - *remesh* replaces the triangles by a closed surface (remeshing.h), which is decimated; maps
///   still show the source.
/// - *decimate* reduces the surface to the target number of triangles (topology.h). A source that
///   has no more keeps them, which is reported. Borders between opaque, masked and blended
///   materials stay, and the asset has a material for each (Asset::draw_modes).
/// - *unwrap* divides at hard edges and packs the charts into the map (unwrap.h).
/// - *frames* computes normals, hard at the crease angle, and MikkTSpace tangents (frames.h).
/// - *bake* casts rays onto the source (bake.h). One pass gives normals, colors with opacity,
///   roughness, metalness, emission and further layers; occlusion, bent normals and thickness have
///   a quarter of their size. Bent normals have the rays of occlusion. The rays of a named part hit
///   only this part of the source (PartDecision), and those of opaque, masked and blended triangles
///   only triangles of their kind, unless PartMatching::all is requested.
///   Occlusion textures of the source are combined with it: the darker one counts.
///
/// \return the same bytes for any number of threads
/// \throws InvalidInput if an option is out of range, the mesh is not valid, no usable triangle is
///         left, texture coordinates are to be kept but absent or the mesh is remeshed, nothing is
///         enclosed that can be remeshed, the stages cannot begin with the mesh of `start`, or no
///         ray hits the source; Cancelled
Asset make_asset(const AssetSource& source, const AssetOptions& options);

/// Writes an asset with its maps inside as .glb or .gltf, with levels of detail (MSFT_lod).
///
/// \param report  counts values that glTF forbids and that were repaired
/// \return the levels, from fine to coarse; fewer than requested if the mesh cannot get smaller,
///         which is reported
/// \throws FileError; there is no partial file, and an old one is unchanged. InvalidInput
std::vector<AssetLevel> write_asset(const std::filesystem::path& file, const Asset& asset,
                                    std::size_t levels, Report& report = IgnoredReport());

/// Reads a written asset back and checks it: meshes (model.h, with the requirements of baking),
/// tangents, which must be MikkTSpace's, the texels of each map, and the factors of the material.
///
/// \return problems; empty if the file is what was made
/// \throws FileError if the file cannot be read
Report verify_asset(const std::filesystem::path& file, const Asset& asset);

}  // namespace make
}  // namespace relief
