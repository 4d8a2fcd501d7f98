// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of a bake from files to files: models, planned maps, measured errors, written files,
/// verification and summary. Tests: tests/tools/relief_bake_*_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/findings.h"
#include "common/map_models.h"
#include "common/normal_map_input.h"
#include "mesh_request.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {

// Models (mesh_models.cpp).

/// A file and its parts.
struct NamedModel {
    std::filesystem::path file;
    const MapModel* model = nullptr;
};

/// Triangles of one part of a high model.
struct HighPiece {
    std::size_t model = 0;
    std::size_t part = 0;
    std::vector<std::uint32_t> triangles;
};

/// The high and low triangles with one name.
struct ModelPair {
    std::string name;
    std::vector<HighPiece> high;
    std::vector<std::uint32_t> low;  ///< Triangles of the joined low model, ascending.
};

struct ModelPairs {
    std::vector<ModelPair> pairs;  ///< Sorted by name; empty: every low part sees all high parts.
    Report report;                 ///< High parts that no low part sees.
    /// The names without a counterpart that prevent automatic pairs.
    std::vector<std::string> unpaired;
};

/// Pairs parts by name (pair_name() in bake_matching.h). A part is named by its object (glTF: node;
/// OBJ: o, else g) if that has a pair name, else by its file.
///
/// automatic: pairs parts if the low model has several names and every part on both sides has a
/// counterpart. name: every low part must have a counterpart; high parts without one are counted.
/// \throws FileError naming low parts without a counterpart
ModelPairs pair_models(std::span<const NamedModel> high, const NamedModel& low, MatchChoice choice);

/// The textures of the high models, decoded.
class HighTextures {
  public:
    /// Adds the textures of a mesh. The mesh must keep its address.
    /// \param report  counts color textures with other texture coordinates, which are left out
    /// \throws FileError if an image cannot be read
    void add(const std::filesystem::path& file, const Mesh& mesh, const MapLooks& looks,
             const HighTextureOptions& options, bool with_colors, Report& report);

    [[nodiscard]] std::span<const HighMaterials> details() const { return details_; }

    /// "1 normal map added to their normals, 2 color textures"; empty if there are none.
    [[nodiscard]] std::string description() const;

  private:
    const Image* image(const std::filesystem::path& model, const MapLooks& looks, std::size_t index,
                       ImageUse use);
    const Image* image(const std::filesystem::path& file, ImageUse use);
    SurfaceTexture texture(const std::filesystem::path& model, const MapLooks& looks,
                           const GltfTexture& texture, ImageUse use);
    [[nodiscard]] SurfaceNormalMap normal_map(const SurfaceTexture& texture, float scale) const;

    std::vector<HighMaterials> details_;
    std::map<std::string, Image> images_;  ///< By file, index and use.
    std::map<const Image*, std::map<std::string, std::string>> metadata_;
    std::size_t normal_maps_ = 0;
    std::size_t color_textures_ = 0;
};

/// The high meshes of a pair, which are adjacent in BakeModels::high.
struct BakePair {
    std::string name;
    std::size_t first_high = 0;
    std::size_t high_count = 0;
    std::size_t high_triangles = 0;
    std::vector<std::uint32_t> low;  ///< Triangles.
};

/// The models of a bake, with the same axes and origin.
struct BakeModels {
    std::vector<Mesh> high;  ///< One per file, or with pairs one per part.
    Mesh low;
    std::vector<std::string> materials;  ///< Of the low mesh.
    std::optional<glm::dmat3> world_from_low;
    glm::dvec3 origin{0.0};  ///< The world position of the origin.
    std::optional<Mesh> cage;
    HighTextures textures;
    std::vector<BakePair> pairs;  ///< Empty: every low part sees all high parts.
    std::vector<std::string> unpaired;
};

/// \throws FileError if a model cannot be read, or the low one has no texture coordinates
BakeModels read_bake_models(const MeshBakeRequest& request, Findings& findings);

/// The transform of normals from the axes of the models to those of --space.
/// \throws FileError if the low model has no axes of its own, and --space object needs them
glm::dmat3 output_axes(const MeshBakeRequest& request,
                       const std::optional<glm::dmat3>& world_from_low);

// Checks whether the models fit (mesh_fit.cpp).

/// Missed texels in percent of those that the low model covers; 0 if it covers none.
double missed_percent(std::size_t missed, std::size_t baked);

/// Makes the baker, which refers to the models.
/// \throws FileError if the models do not fit, with their boxes and the likely cause
Baker make_baker(const MeshBakeRequest& request, const BakeModels& models,
                 const BakeOptions& options, Report& report);

/// Describes the boxes of the models and the likely cause of a misfit.
std::string describe_fit(const MeshBakeRequest& request, const BakeModels& models);

/// \param map  its name if there are several maps, else empty
/// \throws FileError if no ray hits, or too many texels are missed
void check_missed(const MeshBakeRequest& request, const BakeModels& models, const std::string& map,
                  const BakeResult& result);

/// Estimates on a reduced map, before the bake, whether too many texels are missed.
/// \throws FileError like check_missed(), if the estimate is 5 percent points above the limit
void check_missed_early(const MeshBakeRequest& request, const BakeModels& models,
                        const Baker& baker, const BakeMapOptions& map, const std::string& name);

/// Lists missed texels, their positions, and the ray lengths that would hit.
std::vector<std::string> missed_lines(const MeshBakeRequest& request, const BakeResult& result,
                                      const glm::dvec3& origin);

/// A warning if the low model has many more triangles than the high one; else empty.
std::string swapped_models_warning(const MeshBakeRequest& request, std::size_t high_triangles,
                                   std::size_t low_triangles);

// The maps of a bake (mesh_plans.cpp): one, one per material (<material> in OUT), one per tile
// (<UDIM>), or both.

struct MapPlan {
    std::filesystem::path output;
    std::optional<std::string> material;  ///< Absent: the map is not for a single material.
    std::string material_in_files;        ///< The same in file names.
    std::optional<int> udim;
    glm::ivec2 tile{0, 0};
    std::optional<std::vector<std::uint32_t>> triangles;  ///< Absent: all.

    /// "material 'Skin', tile 1001"; empty for a single map.
    [[nodiscard]] std::string name() const;
    /// Another output file of this map, with <material> and <UDIM> replaced as in OUT.
    [[nodiscard]] std::filesystem::path named(const std::filesystem::path& file) const;
};

/// The options for a map. The plan must outlive them.
BakeMapOptions map_options(const BakeOptions& options, const MapPlan& plan);

struct MapPlans {
    std::vector<MapPlan> maps;
    Report report;              ///< Triangles outside of all maps.
    std::size_t materials = 0;  ///< Of the low mesh.
};

/// \throws UsageError if OUT has a word twice or in a folder's name, or if it contradicts an option
void check_map_names(const MeshBakeRequest& request);

/// Plans the maps for a low mesh.
///
/// File names keep letters, digits, '-', '_', '.' and non-ASCII characters of material names; other
/// characters, and a leading '.', become '_'. Triangles without a material are "no-material"; a
/// material without a name is "material-N", counted from 0.
/// \param materials  names, by the indices in the ranges of `low`
/// \throws FileError if two maps would be the same file, one would replace a model, or no texture
///         coordinates are in a tile
MapPlans plan_maps(const MeshBakeRequest& request, const Mesh& low,
                   const std::vector<std::string>& materials);

// The record of a bake in the map's file (mesh_record.cpp).

/// The options of a bake and their values: {"--samples", "4"}.
using BakeRecord = std::map<std::string, std::string>;

/// The metadata of a map: "relief:bake" = "--samples 4 --space tangent"; "relief:material" and
/// "relief:udim" if the map is one of several. A cage is recorded as "--cage given".
std::map<std::string, std::string> bake_metadata(const MeshBakeRequest& request,
                                                 const MapPlan& plan);

/// Reads the record of a file; empty if it has none.
/// \throws FileError if the record has unknown options
BakeRecord read_record(const std::filesystem::path& file,
                       const std::map<std::string, std::string>& metadata);

/// The recordable options of a command line.
BakeRecord record_of(const CLI::App& app);

/// Completes the options of the command line with those of the file. With --cage, the file's
/// --rays, --hardness and --offset are dropped.
BakeRecord merged(const BakeRecord& command_line, const BakeRecord& of_file);

/// Sets the options of a record. \throws UsageError like the options themselves
void apply_record(const BakeRecord& record, MeshBakeRequest& request);

/// "--samples 4 --space tangent"
std::string to_string(const BakeRecord& record);

// Samples and bits by measured errors (mesh_accuracy.cpp).

/// The measured error of one method, on a part of the map.
struct MeasuredBake {
    SampleChoice samples;
    std::optional<double> sample_angle;  ///< In degrees, with `auto`.
    NormalMapFormat format;
    AngleSummary error;
    AngleSummary rounding;  ///< The error of the format alone.
    AngleSummary sampling;  ///< The error of the samples alone.
    std::size_t rays = 0;
    double seconds = 0.0;  ///< Of the rays; with --compare the median, including the encoding.
    bool is_pareto_optimal =
        false;  ///< With --compare: no other method is faster and more accurate.
};

/// "4 samples, 16 bit", "auto samples at 2 degrees, 8 bit, dithered"
std::string to_string(const MeasuredBake& bake);

struct MeshAccuracy {
    /// --max-error: in the order tried, up to the selected one. --compare: all.
    std::vector<MeasuredBake> measured;
    std::optional<MeasuredBake> selected;  ///< With --max-error.
    std::size_t texels = 0;                ///< Of the measured part.
    bool is_whole = true;
    int reference_samples = 0;
    std::size_t reference_rays = 0;
};

/// \throws UsageError if options contradict each other, or have no effect
void check_accuracy(const MeshBakeRequest& request);

/// Measures errors; with --max-error also sets the samples of the request and the format.
///
/// Samples increase from 1 to 256, unless they are given. For each count, all bit depths of the
/// file format are measured, which costs no rays. The first count with a depth within the limit is
/// selected, with the smallest such depth. 256 samples are compared with a reference of 1024, on an
/// eighth of the texels; if the map is too large for that, the maximum is 64.
/// \throws InvalidInput if no method is within the limit, with the smallest error, its larger part,
///         and the depth that another file format would need
MeshAccuracy select_accuracy(const Baker& baker, const BakeMapOptions& map,
                             MeshBakeRequest& request, NormalMapFormat& format);

// Written files (mesh_writer.cpp).

/// The encoding of a layer. Floats store values as they are, colors linearly. With 8 and 16 bits,
/// occlusion is code / 255 or code / 65535, and colors are sRGB; signed layers are
/// range * (code - 128) / 127 or range * (code - 32768) / 32767, so that 0 is exact.
struct LayerCoding {
    LayerKind kind = LayerKind::height;
    int bits = 16;
    double range = 1.0;  ///< Of signed layers in 8 and 16 bits.

    [[nodiscard]] bool is_signed() const {
        return kind != LayerKind::occlusion && kind != LayerKind::color;
    }
    [[nodiscard]] std::size_t channels() const {
        return kind == LayerKind::position || kind == LayerKind::color ? 3 : 1;
    }
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
std::vector<std::byte> encode_layer(std::span<const float> values,
                                    std::span<const TexelState> states, const LayerCoding& coding,
                                    bool has_alpha, std::size_t first_texel, Report& report);

struct WrittenLayer {
    std::filesystem::path file;
    LayerCoding coding;
};

/// The layers of a map. Ranges are those of the options, else the largest values that the bake can
/// give; for curvature in 8 bits, the value that 99% of the area does not exceed.
std::vector<WrittenLayer> planned_layers(const MeshBakeRequest& request, const MapPlan& plan,
                                         const Baker& baker, const BakeLayers& layers);

/// Writes the files of one map, row by row: normals and layers.
class MapWriter {
  public:
    /// \throws FileError
    MapWriter(const MeshBakeRequest& request, const MapPlan& plan, const NormalMapFormat& format,
              const std::vector<WrittenLayer>& layers, Report& report);
    ~MapWriter();
    MapWriter(const MapWriter&) = delete;
    MapWriter& operator=(const MapWriter&) = delete;

    /// Row counts must be multiples of 64, except for the last rows.
    void write(const BakedRows& rows);

    /// Closes the files; finish() renames them. \throws FileError
    void complete();

    /// \throws FileError that lists the complete files
    void finish();

  private:
    struct Files;
    std::unique_ptr<Files> files_;
};

// Verification (mesh_verify.cpp): a finished map is compared with its models.

struct VerifyRequest {
    std::filesystem::path map;
    MapInputOptions input{};
    ErrorBound bound{};
    std::optional<std::filesystem::path> error_map;
};

struct VerifiedMap {
    BakeCheck check;
    VerifyRequest request;
    double brightest = 0.0;  ///< The error of the brightest color of the error map, in degrees.
    std::vector<std::string> problems;
    std::vector<std::string> remedies;  ///< Commands.
    double milliseconds = 0.0;
};

/// \param models  with the low mesh as it was read
/// \param map     the options of the map; the size is that of the file
/// \throws FileError if the map cannot be read, or the error map cannot be written
VerifiedMap verify_map(const Baker& baker, const BakeModels& models, const MeshBakeRequest& bake,
                       BakeMapOptions map, const VerifyRequest& request, Report& report);

/// "RMS 0.131 degrees, mean 0.12, 99 of 100 within 0.3, 2.1 at most"
std::string to_string(const AngleSummary& summary);

void print_verified(const VerifiedMap& map);
nlohmann::ordered_json verified_json(const VerifiedMap& map);

// The bake (mesh_job.cpp) and its summary (mesh_summary.cpp).

/// "2.5 million rays per second, 12 s left". The remaining time is shown after a second.
/// \param part  the finished part of all maps, 0 to 1
std::string progress_text(double part, double seconds, std::size_t rays);

struct BakedMap {
    MapPlan plan;
    BakeResult result;
    std::optional<VerifiedMap> verified;
    std::vector<WrittenLayer> layers;
};

struct MeshBake {
    std::size_t high_triangles = 0;
    std::size_t low_triangles = 0;
    bool has_file_tangents = false;
    std::size_t materials = 0;    ///< Of the low mesh.
    std::vector<BakePair> pairs;  ///< As in BakeModels.
    std::vector<std::string> unpaired;
    NormalMapFormat format;
    std::string textures;     ///< HighTextures::description()
    double texel_size = 0.0;  ///< The mean side of a texel in the unit of the mesh; 0: unknown.
    std::vector<BakedMap> maps;
    BakeResult all;                        ///< Sums and extremes over all maps.
    BakeFit fit;                           ///< Baker::fit()
    glm::dvec3 origin{0.0};                ///< As in BakeModels.
    std::optional<MeshAccuracy> accuracy;  ///< If errors were measured before the bake.
    Findings findings;
};

/// Reads models, bakes and writes. The stages are "read", "bake" (which also writes) and "verify".
/// No file is written before all maps are baked and none misses too many texels.
/// \throws FileError, UsageError
MeshBake bake_maps(const MeshBakeRequest& request, Stages& stages);

void print_summary(const MeshBakeRequest& request, const MeshBake& bake, const Stages& stages);

/// A warning if several materials share texels of one map; else empty.
std::string shared_texels_warning(const MeshBakeRequest& request, const MeshBake& bake);

nlohmann::ordered_json results_json(const MeshBakeRequest& request, const MeshBake& bake,
                                    const Stages& stages);

}  // namespace relief::tools
