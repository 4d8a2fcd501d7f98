// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the error and cost of methods on a user's mesh, height map, normal map or pair of
/// meshes (the asset report), and recommends a method. No exact result is known: each experiment
/// states its reference and the limits of that reference. Large inputs are measured in part, and
/// the experiment says so. A ProgressScope receives progress and can cancel
/// (relief/mesh/execution.h).
/// Tests: tests/accuracy/asset_mesh_test.cpp, asset_maps_test.cpp, asset_report_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/accuracy/measure.h"
#include "relief/accuracy/measure_bump.h"
#include "relief/export.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"

namespace RELIEF_API relief {

class Baker;

/// The cost to minimize: time (Measurement::cost, on one thread if that was measured), or the
/// stored bytes of each item.
enum class CostKind { time, bytes };

/// The limits of a request. Without limits, the knee is recommended, see recommended().
struct MethodRequest {
    /// In the unit of the experiment, for the statistic `figure`.
    std::optional<double> max_error;
    std::optional<double> max_seconds;  ///< Maximum time in seconds; ignored for CostKind::bytes.
    double ErrorStats::*figure = &ErrorStats::rms;  ///< The statistic that `max_error` limits.
};

struct RecommendationRule {
    MethodRequest request;
    CostKind cost = CostKind::time;
    /// An invisible error. The search for the knee adds its square to that of each error.
    double negligible_error = 0.0;
    /// For each measurement, whether it may be recommended; empty: all.
    std::span<const unsigned char> choosable;
    /// For each measurement, a cost that does not depend on measured time (such as operations per
    /// texel). It decides between methods of equal size if nothing was timed. Empty: unknown.
    std::span<const double> nominal_costs;
    /// The name of the source of Experiment::reference_error, such as "the map itself".
    std::string reference = "the reference itself";
};

struct Recommendation {
    /// Index of the measurement; absent if none is within the limits.
    std::optional<std::size_t> method;
    /// The next more accurate method that is Pareto-optimal among those that may be recommended.
    std::optional<std::size_t> next;
    /// "scharr3, float32, 16 bit: 0.05 degrees RMS at 41.0 ms; the next more accurate (...) takes 3
    /// times as long for 0.01 degrees less". Or the method closest to the request.
    std::string words;
};

/// Recommends a method. Its error is the root of the sum of squares of Experiment::reference_error
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
    /// Programs that draw at the same time must disable one_thread, because it applies to the whole
    /// process.
    CostChoice costs;
    std::string file;  ///< The name of the input in titles.
    /// The input as an argument of commands, or both files of a pair: "'old vase.obj'".
    std::string arguments;
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
AssetExperiment measure_asset_heights(const BumpSample& sample, glm::ivec2 size,
                                      const BumpOptions& bump, const AssetOptions& options);
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

}  // namespace relief
