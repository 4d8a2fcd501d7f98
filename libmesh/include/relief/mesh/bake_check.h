// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks before and after a bake: pairs parts of the models by name, finds the likely cause if
/// they do not fit, estimates missed texels, and measures the error of a finished normal map. Part
/// of the library relief::bake.
/// Tests: tests/tools/relief_bake_models_test.cpp, tests/mesh/bake/bake_check_test.cpp,
/// tests/accuracy/asset_maps_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/model.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {

/// The side of a pair of models.
enum class BakeSide { high, low };

/// Returns the name that a part shares with its counterparts, in lower case.
///
/// It is the text before the last separate word "high" (for a high part) or "low" (for a low part).
/// Words are separated by '_', '-', '.' or a space. The text after the word is ignored:
/// "Bolt_high", "bolt_high.001" and "bolt-high-cap" all give "bolt". Absent if there is no such
/// word, or no text before it.
std::optional<std::string> pair_name(const std::string& name, BakeSide side);

/// The names by which a part can be paired.
struct BakePartName {
    std::string object;  ///< The name of its object (glTF: node); may be empty.
    std::string file;    ///< The stem of its file; used if the object's name gives no pair name.
};

/// Returns the name of a part, in lower case: the pair name of its object, else the name of its
/// object, else the pair name of its file, else the name of its file. Empty if it has no name.
std::string part_name(const BakePartName& part, BakeSide side);

/// The parts with one pair name.
struct BakeNameGroup {
    std::string name;                    ///< Empty: parts without a pair name.
    std::vector<std::size_t> high, low;  ///< Indices of parts, ascending.

    /// Returns whether it has a name and parts on both sides.
    [[nodiscard]] bool is_pair() const { return !name.empty() && !high.empty() && !low.empty(); }
};

/// Groups parts by pair name. \return the groups, sorted by name
std::vector<BakeNameGroup> group_by_pair_name(std::span<const BakePartName> high,
                                              std::span<const BakePartName> low);

/// The high parts that each low part sees.
enum class PartMatching {
    automatic,  ///< By name if the low model has several names and all parts have counterparts.
    name,       ///< By name.
    all,        ///< All high parts.
};

template <>
inline constexpr auto enum_names<PartMatching> = std::to_array<EnumName<PartMatching>>(
    {{"auto", PartMatching::automatic}, {"name", PartMatching::name}, {"all", PartMatching::all}});

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
    /// With PartMatching::name, the low parts without a counterpart, which are in no pair.
    std::vector<std::string> unmatched_low;
};

/// Pairs parts by pair_name(). A part is named by its object (glTF: node; OBJ: o, else g) if that
/// has a pair name, else by its file. If no object of the low model has a pair name, parts are
/// paired by equal names of objects, whatever their case, if each part has a counterpart. High
/// parts without a counterpart are counted.
ModelPairs pair_parts(std::span<const NamedModel> high, const NamedModel& low,
                      PartMatching matching);

/// Returns the likely cause of models that do not fit, as a question or a remark: different units,
/// a different up axis, or a missing transform. Empty if the boxes show none.
std::string likely_cause(const BakeFit& fit);

/// The result of a bake at a reduced size.
struct MissedEstimate {
    int width = 0;
    int height = 0;
    BakeResult result;
};

/// The number of texels of the reduced map in estimate_missed().
inline constexpr double estimate_texels = 65536.0;

/// Estimates which texels of a map are missed by their rays. The map is baked with one sample per
/// texel and with at most `estimate_texels` texels.
MissedEstimate estimate_missed(const Baker& baker, const BakeMapOptions& map);

/// The causes of the error of a map, in the order of the steps of a bake.
enum class BakeStage {
    /// Texels without a unique normal: the surface jumps within the texel, so that its mean height
    /// differs from that of the texel's center by more than a quarter of the texel's width; or the
    /// ray of the center hits nothing; or the shown normal faces away from the low mesh.
    projection,
    sampling,      ///< The map has fewer samples than the reference.
    quantization,  ///< Normals are rounded to codes; angles are measured in tangent space.
    /// The effect of rounding in object space, where the low mesh's tangent frame is not
    /// orthonormal.
    basis,
    /// The file holds other codes than this bake produces, because of another tangent basis,
    /// another bake or edits.
    other,
};
inline constexpr std::size_t bake_stage_count = 5;

/// The error of one stage.
struct StageError {
    ErrorStats error;  ///< The angle of this stage alone, in degrees; for `basis` only its RMS.
    /// Its fraction of the mean squared error; the fractions add up to 1. It is the projection of
    /// the stage's error vector onto the total error vector, and negative if the stage compensates
    /// another one.
    double fraction = 0.0;
};

struct WorstTexel {
    int x = 0;
    int y = 0;
    double degrees = 0.0;
    bool is_discontinuous = false;  ///< The texel belongs to BakeStage::projection.
};

/// The difference from this bake above which BakeCheck counts a texel as an outlier, in degrees.
inline constexpr double outlier_degrees = 1.0;

struct BakeCheckOptions {
    BakeMapOptions map;      ///< The options of the bake of the map; the size is that of the image.
    NormalMapFormat format;  ///< The meaning of the codes; the number of bits is that of the image.
    /// Samples per texel of the reference: 4, 16, 64, 256 or 1024. 0 means 16 times those of the
    /// map, at most 256, or 1024 for a map of 256; fewer for large maps that would exceed
    /// TexelRasterizer::largest_side. First a quarter of them is cast, and the others only if two
    /// of those normals differ by more than half a degree.
    int reference_samples = 0;
    /// Searches for another convention if the error of the map is large.
    bool finds_convention = true;
    /// The low mesh as it was read, with its tangents, for maps in object space; null if there is
    /// none.
    const Mesh* given = nullptr;
    /// The transform from the meshes' space to the low mesh's object space.
    glm::dmat3 object_from_mesh{1.0};
};

struct BakeCheck {
    /// The error against the mean normal over the texel's area, which a map should show from afar
    /// or at its own resolution.
    ErrorStats error;
    /// The error against the normal at the texel's center, which a map should show in a close view.
    /// A map of one sample per texel has only rounding errors here; a map of many samples differs
    /// by design.
    ErrorStats center;
    /// The value of `error` for the codes that this bake produces now.
    ErrorStats rebaked;
    std::array<StageError, bake_stage_count> stages{};  ///< Indexed by BakeStage.
    std::size_t missed = 0;         ///< Texels on the mesh without a reference: all rays miss.
    std::size_t frameless = 0;      ///< Texels where the low mesh has no tangent frame.
    std::size_t discontinuous = 0;  ///< Texels of BakeStage::projection.
    std::size_t rays = 0;
    int reference_samples = 0;
    std::vector<WorstTexel> worst;  ///< At most 8, largest error first.
    /// Texels of BakeStage::other that differ from this bake by more than `outlier_degrees`.
    std::size_t outliers = 0;
    /// Those of `outliers` at most two texels from an edge: the border of a chart, or a texel that
    /// is missed or of BakeStage::projection. Other bakers differ there.
    std::size_t outliers_at_edges = 0;
    std::vector<WorstTexel> worst_outliers;  ///< At most 8, by the difference from this bake.
    ConventionFit convention;
};

/// Compares a normal map with the surface.
///
/// \param baker  with the rays and the space that the map was baked with
/// \param map  the finished image, as read from its file
/// \param take  receives the errors in degrees, row by row from the top, NaN without a reference;
///         may be empty
/// \param report  counts the findings of the bake, and texels of the map without a direction
/// \throws InvalidInput if the image has fewer than three channels or another size
///
/// The renderer's frame (map_convention.h) transforms the normals of the map to object space. The
/// reference is the mean of many normals of the high surface over the texel, each in its local
/// tangent space, because that is what a map can store; it is transformed in the same way. Texels
/// outside of all charts, and padded texels, have no reference.
///
/// Computed in double precision; the same for any number of threads. Memory: the image, and about
/// 200 bytes for each texel of a strip of a million texels.
BakeCheck check_bake(const Baker& baker, const Image& map, const BakeCheckOptions& options,
                     const std::function<void(int first_row, std::span<const float> degrees)>& take,
                     Report& report = IgnoredReport());

/// A bake of the texels of a BakeReference, row by row.
struct BakedTexels {
    std::vector<float> normals;  ///< Three per texel.
    std::vector<TexelState> states;
    std::size_t rays = 0;
};

/// The reference for a map or some of its bands, with which any number of bakes can be compared.
///
/// Memory: 34 bytes per texel, and 29 bytes for each bake that the caller compares.
class BakeReference {
  public:
    /// Computes the reference.
    ///
    /// \param map  its samples do not matter. The baker must outlive the reference
    /// \param texels  minimum number of texels to compare, in evenly spaced bands of 64 rows; all
    ///         if the map has fewer
    /// \param samples  per texel of the reference; 0: 256, or the maximum for the size of the map.
    ///         Bakes of 256 samples need a reference of 1024; otherwise they are compared with
    ///         themselves
    BakeReference(const Baker& baker, const BakeMapOptions& map, std::size_t texels,
                  int samples = 0);
    ~BakeReference();
    BakeReference(const BakeReference&) = delete;
    BakeReference& operator=(const BakeReference&) = delete;

    /// Bakes the same texels, with BakeMapOptions::samples and sample_angle.
    [[nodiscard]] BakedTexels bake(int samples, std::optional<double> sample_angle) const;

    /// Encodes and decodes the normals of a bake. \return three values per texel
    [[nodiscard]] std::vector<float> coded(const BakedTexels& bake,
                                           const NormalMapFormat& format) const;

    /// Compares a bake in a format with the reference, as check_bake() does.
    ///
    /// \param coded    of this bake
    /// \param degrees  one per texel; receives the errors, NaN without a reference
    BakeCheck compare(const BakedTexels& bake, std::span<const float> coded,
                      std::span<float> degrees) const;

    [[nodiscard]] int width() const;           ///< Of the map.
    [[nodiscard]] std::size_t texels() const;  ///< Number of texels of the bands, covered or not.
    [[nodiscard]] bool is_whole() const;
    [[nodiscard]] int samples() const;
    [[nodiscard]] std::size_t rays() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
