// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the error of a finished normal map, texel by texel, against the surface that it was
/// baked from, and the errors and times of bakes with other sample counts and formats. Part of the
/// library relief::bake.
/// Tests: tests/mesh/bake/bake_check_test.cpp, tests/accuracy/asset_maps_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/error_stats.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/timing.h"

namespace RELIEF_API relief {

// Measures the error of a finished normal map, texel by texel, against the surface that it was
// baked from, as a renderer shows it, and splits the error by cause. Part of the library
// relief::bake.

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
    double rms = 0.0;  ///< The RMS angle of this stage alone, in degrees.
    /// Its share of the mean squared error; the shares add up to 1. It is the projection of the
    /// stage's error vector onto the total error vector, and negative if the stage compensates
    /// another one.
    double share = 0.0;
};

struct WorstTexel {
    int x = 0;
    int y = 0;
    double degrees = 0.0;
    bool is_discontinuous = false;  ///< The texel belongs to BakeStage::projection.
};

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
                     Report& report);

// Measures the errors and times of bakes with several sample counts and formats, without writing
// maps. Part of the library relief::bake.

/// The number of samples per texel.
struct BakeSampling {
    int samples = 1;
    /// Adaptive sampling: BakeMapOptions::sample_angle in degrees.
    std::optional<double> sample_degrees{};
};

/// The errors and times of one bake in several formats.
struct BakeMeasurement {
    std::vector<ErrorStats> errors;  ///< By format, against the mean normal over the texel.
    /// By format, the error of rounding to codes alone, which more samples do not reduce.
    std::vector<ErrorStats> quantization;
    ErrorStats sampling;             ///< The error of sampling alone, which no format reduces.
    std::vector<ErrorStats> center;  ///< By format, against the normal at the texel's center.
    std::size_t rays = 0;
    double cast_seconds = 0.0;         ///< The time of the bake without encoding.
    std::vector<double> code_seconds;  ///< The time of encoding, by format.
};

/// The reference for a map or some of its bands, with which any number of bakes can be compared.
///
/// Memory: 17 bytes per measured texel, and four times that during a measurement.
class BakeBenchmark {
  public:
    /// Computes the reference.
    ///
    /// \param texels  minimum number of texels to measure, in evenly spaced bands of 64 rows; all
    ///         if the map has fewer
    /// \param reference_samples  per texel of the reference; 0: 256, or the maximum for the size of
    ///         the map. Bakes of 256 samples need a reference of 1024; otherwise they are compared
    ///         with themselves
    BakeBenchmark(const Baker& baker, const BakeMapOptions& map, std::size_t texels,
                  int reference_samples = 0);
    ~BakeBenchmark();
    BakeBenchmark(const BakeBenchmark&) = delete;
    BakeBenchmark& operator=(const BakeBenchmark&) = delete;

    /// Bakes and encodes in memory, and compares the result as check_bake() does.
    [[nodiscard]] BakeMeasurement measure(const BakeSampling& way,
                                          std::span<const NormalMapFormat> formats) const;

    /// Computes BakeMeasurement::errors for each texel: one float channel in degrees, NaN without a
    /// reference. If only bands were measured, they are stacked.
    [[nodiscard]] Image error_map(const BakeSampling& way, const NormalMapFormat& format) const;

    [[nodiscard]] std::size_t texels() const;  ///< Number of measured texels, covered or not.
    [[nodiscard]] bool is_whole() const;
    [[nodiscard]] int reference_samples() const;
    [[nodiscard]] std::size_t reference_rays() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Returns 1, 4, 16 and 64 samples, and 16 adaptive samples with thresholds of 8, 2 and 0.5
/// degrees.
std::span<const BakeSampling> default_bake_samplings();

/// Returns variants of `format`: 8 bits, 8 bits with blue-noise dithering, 16 bits, and float.
std::vector<NormalMapFormat> default_map_formats(const NormalMapFormat& format);

struct TimedBakeMeasurement {
    BakeMeasurement trial;
    /// By format and round: the time of the bake and its encoding.
    std::vector<std::vector<double>> seconds;
};

/// Measures all ways, interleaved. \throws Cancelled between bakes if cancellation was requested
std::vector<TimedBakeMeasurement> measure_interleaved(const BakeBenchmark& trials,
                                                      std::span<const BakeSampling> ways,
                                                      std::span<const NormalMapFormat> formats,
                                                      const Repeats& repeats);

}  // namespace relief
