// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the error and cost of methods on a user's mesh, height map, normal map or pair of
/// meshes (the asset report), and recommends a method. No exact result is known: each experiment
/// states its reference and the limits of that reference. Large inputs are measured in part, and
/// the experiment says so. A ProgressScope receives progress and can cancel
/// (relief/mesh/execution.h).
/// Tests: tests/accuracy/measure_bump_test.cpp, tests/accuracy/asset_mesh_test.cpp,
/// tests/accuracy/asset_maps_test.cpp, tests/accuracy/asset_report_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/export.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {
namespace accuracy {

/// A method of conversion.
struct BumpMethod {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;  ///< The radius of Kernel::gaussian.
    Arithmetic arithmetic = Arithmetic::float32;
    int bits = 16;  ///< Bits per channel of the stored map.
    /// The heights are smoothed by destaircase() first (height_map.h).
    bool destaircased = false;

    bool operator==(const BumpMethod&) const = default;
};

/// A cost that does not depend on measured time. It is ordered by the bits of the result, then by
/// de-staircasing, then by the number of operations per texel, which counts twice in float64.
double nominal_cost(const BumpMethod& method);

/// The measured error and time of a method.
struct BumpMeasurement {
    BumpMethod method;
    /// The angles between the stored normals and the reference, in degrees.
    ErrorStats error;
    /// The time of a conversion in memory, including smoothing (BumpExperiment::smoothing); zeros
    /// if it was not timed.
    TimeStatistics seconds;
    double megapixels_per_second = 0.0;
    /// No other method has both a smaller RMS error and a shorter time.
    bool is_pareto_optimal = false;
};

/// The reference of the errors.
struct BumpReference {
    /// The method of the reference, in float64 and not rounded to codes; absent if the exact
    /// normals are known.
    std::optional<BumpMethod> method;
    /// The expected error of the reference against the surface from which the map was made, in
    /// degrees: rms, mean, p99 and max. Measured errors do not include it. Zeros if the exact
    /// normals are known.
    ErrorStats error;
    /// The upper end of that error, if the map does not show whether detail is real
    /// (KernelChoice::upper_rms_degrees). Not less than `error`.
    ErrorStats upper_error;
    std::string description;  ///< A description for people.
};

struct BumpExperiment {
    BumpReference reference;
    std::vector<BumpMeasurement> measurements;  ///< In the order of the methods.
    /// The time of destaircase() in seconds. It runs once per round and is added to all methods
    /// that need it. Zeros if no method needs it or nothing was timed.
    TimeStatistics smoothing;
    KernelChoice choice;      ///< For the map without smoothing.
    std::int64_t texels = 0;  ///< Number of measured texels.
    bool is_whole = true;     ///< False if only parts of a large map were measured.
};

struct BumpExperimentOptions {
    BumpOptions bump;        ///< Strength, texel and wrap.
    NormalMapFormat format;  ///< The format of the stored maps, except for their bits.
    Grain grain = Grain::automatic;
    Repeats repeats{5, 1};  ///< With `counted` = 0, nothing is timed.
};

/// The samples of a map, which may be too large for memory.
struct BumpSample {
    std::vector<Image> analyzed;  ///< The parts of parts_to_analyze(), for the choice of a kernel.
    std::vector<Image> measured;  ///< The parts of parts_to_measure().
    bool is_whole = true;         ///< The only measured part is the whole map.
};

/// Selects the parts of a map on which methods are measured: the whole map, or, if it has more
/// texels than the limit, nine parts with that many texels together, from top to bottom.
inline constexpr std::int64_t texels_to_measure = std::int64_t{1} << 20;
std::vector<ImagePart> parts_to_measure(int width, int height,
                                        std::int64_t max_texels = texels_to_measure);

/// The parts of a sample.
struct BumpSampleParts {
    std::vector<ImagePart> analyzed;
    std::vector<ImagePart> measured;

    /// All parts once, from top to bottom, as a file is read.
    [[nodiscard]] std::vector<ImagePart> in_order() const;
    /// Creates the sample. \param images  the images of in_order()
    [[nodiscard]] BumpSample sample(const std::vector<Image>& images) const;
};

/// Creates the sample of a map in memory.
BumpSample sample_of(const Image& height, std::int64_t max_texels = texels_to_measure);

/// Returns all combinations of kernels (the Gaussian with the given radius), precisions, bit depths
/// and de-staircasing.
std::vector<BumpMethod> bump_methods(int gaussian_radius, std::span<const int> depths,
                                     std::span<const Arithmetic> arithmetics,
                                     std::span<const bool> destaircased);

/// Measures the error and time of all methods on a map, interleaved.
///
/// \param sample  of one channel, as for normals_from_height(); the outermost 16 texels of parts
///         are not compared
/// \return errors against the most accurate normals that are known for this map: those of the
///         chosen kernel in float64, with or without de-staircasing, whichever has the smaller
///         error according to choose_kernel(). No reference can include the detail that was lost
///         when the map was quantized
/// \throws InvalidInput as normals_from_height() does
BumpExperiment measure_bump(const BumpSample& sample, std::span<const BumpMethod> methods,
                            const BumpExperimentOptions& options);

/// The same for a height field whose exact normals are known.
BumpExperiment measure_bump(const BumpField& field, std::span<const BumpMethod> methods,
                            BumpExperimentOptions options);

/// Returns the expected error of a measured method against the surface from which the map was made.
///
/// \param kind  of both parts. Except for ErrorKind::rms, the root of the sum of squares is an
///         estimate, because large errors of both parts seldom occur in the same texel
ExpectedError expected_error(const BumpReference& reference, const BumpMeasurement& measurement,
                             ErrorKind kind = ErrorKind::rms);

/// Returns the upper end of the same error.
ExpectedError expected_error_upper(const BumpReference& reference,
                                   const BumpMeasurement& measurement,
                                   ErrorKind kind = ErrorKind::rms);

/// Limits for expected_error() in degrees. An absent limit is not checked.
struct ErrorLimits {
    std::optional<double> total;
    std::optional<double> added;
    ErrorKind kind = default_error_kind;

    /// Returns true if the error is within the limits, and false if it is unknown.
    [[nodiscard]] bool hold(const ExpectedError& error) const {
        return (!total || error.total() <= *total) && (!added || error.added <= *added);
    }
};

/// Returns the measurement with the smallest nominal_cost() within the limits; null if there is
/// none.
const BumpMeasurement* cheapest_within(const BumpExperiment& experiment, const ErrorLimits& limits);

/// Returns the measurement with the smallest error; null if there is none.
const BumpMeasurement* most_accurate(const BumpExperiment& experiment, ErrorKind kind);

}  // namespace accuracy

class Baker;

namespace accuracy {

/// The cost to minimize: time (Measurement::cost, on one thread if that was measured), or the
/// stored bytes of each item.
enum class CostKind { time, bytes };

/// The limits of a request. Without limits, the knee is recommended, see recommended().
struct MethodRequest {
    std::optional<double> max_error;      ///< In the unit of the experiment.
    std::optional<double> max_seconds;    ///< Maximum time in seconds; ignored for CostKind::bytes.
    ErrorKind kind = default_error_kind;  ///< The statistic that `max_error` limits.
};

/// The input of recommended(). The spans must be valid until it returns.
struct RecommendationRule {
    MethodRequest request{};
    CostKind cost = CostKind::time;
    /// An invisible error. The search for the knee adds its square to that of each error.
    double negligible_error = 0.0;
    /// For each measurement, whether it may be recommended; empty: all.
    std::span<const unsigned char> choosable{};
    /// For each measurement, a cost that does not depend on measured time (such as operations per
    /// texel). It decides between methods of equal size if nothing was timed. Empty: unknown.
    std::span<const double> nominal_costs{};
    /// The name of the source of Experiment::reference_error, such as "the map itself".
    std::string reference = "the reference itself";
    /// The reference has an error of unknown size, so that no limit of the error is kept.
    bool is_reference_unknown = false;
    /// The error of the reference in the statistic that the request limits. Absent:
    /// Experiment::reference_error.
    std::optional<double> limited_reference{};
};

struct Recommendation {
    /// Index of the measurement; absent if none is within the limits.
    std::optional<std::size_t> method;
    /// The next more accurate method that is Pareto-optimal among those that may be recommended.
    std::optional<std::size_t> next;
    /// "scharr3, float32, 16 bit: 0.05 degrees RMS at 41.0 ms; the next more accurate (...) takes 3
    /// times as long for 0.01 degrees less". Or the method closest to the request.
    std::string description;
};

/// Recommends a method. Its error is the root of the sum of squares of the error of the reference
/// and the error that the method adds.
///
/// - With `max_error`: the cheapest method whose error is within it (and whose time is within
///   max_seconds, if given). If nothing was timed, the one with the fewest stored bytes, then the
///   one with the smallest natural cost.
/// - With `max_seconds` alone: the most accurate method within it.
/// - Without both, the knee: the Pareto-optimal method with the smallest error^3 x cost, so that
///   half the error is worth eight times the cost. Among the methods within a tenth of this
///   minimum, because times are not more accurate, the one with the fewest stored bytes. If nothing
///   was timed, the most accurate one.
///
/// Measurements with undefined results are never recommended. Ties: the first method wins.
Recommendation recommended(const Experiment& experiment, const RecommendationRule& rule);

/// The options for all kinds of input.
struct AssetOptions {
    RunOptions run;
    /// Programs that draw at the same time should disable `memory`, which is that of the process.
    CostChoice costs;
    std::string file;  ///< The name of the input in titles.
    /// The input as an argument of commands, or both files of a pair: "'old vase.obj'".
    std::string arguments;
    /// The lossy compression of an image file, such as "JPEG"; empty: none. Its error is unknown.
    std::string lossy_compression{};
    /// Further arguments of commands on height maps, such as " --channel alpha".
    std::string height_arguments;
    std::string command;  ///< The command that repeats the report: "relief-accuracy own vase.obj".
    MethodRequest request;
    /// For normal maps from heights: their bits, and whether the steps of quantized heights are
    /// also smoothed (in 16 bits).
    std::vector<int> map_bits = {8, 16, 32};
    bool smooths_steps = true;
};

/// An experiment and its recommendation.
struct AssetExperiment {
    Experiment experiment;
    /// For each measurement, the command or call that performs it; empty if no tool does: such
    /// methods are measured, but not recommended.
    std::vector<std::string> commands;
    Recommendation recommendation;
    /// Returns the command of the recommended method; empty if there is none.
    [[nodiscard]] std::string command() const {
        return recommendation.method ? commands[*recommendation.method] : std::string();
    }
};

/// The reference for averaged normals.
enum class NormalReference {
    surface,  ///< A smooth surface that is fitted to the vertices: normals.h.
    file,     ///< The stored normals of the mesh.
};

struct AssetMeshOptions {
    NormalReference ground_truth = NormalReference::surface;
    /// The crease angle in radians: sharper edges are hard. If absent, the smoothing groups of the
    /// mesh apply, else the crease angle that is inferred from its normals (normals.h),
    /// else no edge is hard.
    std::optional<double> crease_angle;
    /// For larger meshes, eight ranges of triangles are measured.
    std::size_t max_triangles = std::size_t{1} << 20;
};

/// Measures all weightings of normals, in double precision as in relief-mesh. With texture
/// coordinates also tangents, against the gradient of the texture on each triangle and against
/// MikkTSpace; and the compact encodings of both.
/// \throws InvalidInput if the mesh is not valid or has no triangle, or if its stored normals are
///         the reference and it has none
std::vector<AssetExperiment> measure_asset_mesh(const Mesh& mesh,
                                                const AssetMeshOptions& mesh_options,
                                                const AssetOptions& options);

/// Measures kernels, precisions and bit depths against the most accurate normals that are known for
/// this map (measure_bump()).
/// \param size  of the whole map
/// \param bump  strength, texel and wrap
/// \param report  gets a finding if fine detail may be blurred noise
AssetExperiment measure_asset_heights(const BumpSample& sample, glm::ivec2 size,
                                      const BumpOptions& bump, const AssetOptions& options,
                                      Report& report = IgnoredReport());
/// The same for a map in memory: one channel, as for normals_from_height().
AssetExperiment measure_asset_heights(const Image& height, const BumpOptions& bump,
                                      const AssetOptions& options,
                                      std::int64_t max_texels = texels_to_measure);

/// The storage format of a normal map.
struct NormalMapStorage {
    int bits = 8;  ///< Bits per channel.
    int channels = 3;
    /// The extension of a file format that can store the same codes.
    std::string extension = ".png";
};

/// Compares the methods of relief mapping on a height map by their errors in texels, for views of a
/// plane.
///
/// \param wraps  beyond the border
/// \param depth  of black in texels, above 0
/// \param degrees  the smallest and the largest angle between the view and the normal, within 0 to
///         89
/// \return the recommendation and its command for relief-view, by times alone:
///         MethodRequest::max_error is ignored. Maps of more than 2^20 texels have no cone map
/// \throws InvalidInput as HeightField does
AssetExperiment measure_asset_relief(const Image& heights, const Wraps& wraps, double depth,
                                     const glm::dvec2& degrees, const AssetOptions& options);

/// Measures storage formats for a normal map against the normals in its file; keeping the file is
/// one of them.
/// \param normals  three float channels, as from decode_normal_map()
AssetExperiment measure_asset_normals(const Image& normals, const NormalMapStorage& file,
                                      const AssetOptions& options,
                                      std::int64_t max_texels = texels_to_measure);

/// Measures sample counts and formats of a map that is baked from one mesh for another, against the
/// mean of many samples.
/// \param baker  of the meshes; all its options apply to the maps
/// \param size  texels along each side of the map
AssetExperiment measure_asset_bake(const Baker& baker, int size, const AssetOptions& options);

}  // namespace accuracy
}  // namespace relief
