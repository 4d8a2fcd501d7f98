// SPDX-License-Identifier: Apache-2.0
/// \file
/// How true `relief-bake mesh` is to be: samples and bits raised until an error is kept, or all of
/// them beside their times. Tests: tests/tools/relief_bake_accuracy_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "mesh/mesh_options.h"
#include "relief/mesh/bake_trials.h"
#include "relief/mesh/timing.h"

namespace relief::tools {

/// One way to bake, on the part that was looked at.
struct MeasuredBake {
    SampleChoice samples;
    std::optional<double> sample_angle;  ///< Degrees, of `auto`.
    NormalMapFormat format;
    AngleSummary error;
    AngleSummary rounding;  ///< The part of the error that the format alone makes,
    AngleSummary sampling;  ///< and the part that the samples alone make.
    std::size_t rays = 0;
    double seconds = 0.0;  ///< Of the rays; with --compare the median, and the codes among it.
    bool is_efficient =
        false;  ///< With --compare: no other method is both faster and more accurate.
};

struct MeshAccuracy {
    /// --max-error: in the order tried, up to what is kept. --compare: all.
    std::vector<MeasuredBake> measured;
    std::optional<MeasuredBake> kept;  ///< By --max-error.
    std::size_t texels = 0;            ///< Looked at.
    bool is_whole = true;
    int reference_samples = 0;
    std::size_t reference_rays = 0;
};

/// --max-error, --max-error-kind, --compare.
void add_accuracy_options(CLI::App& app, AccuracyChoice& choice);

/// \throws UsageError where options contradict each other, or have no effect
void check_accuracy(const MeshBakeRequest& request);

/// Whether something is to be measured before the map is baked.
bool needs_trials(const MeshBakeRequest& request);

/// Measures, and for --max-error settles samples and bits of the request and the format.
///
/// Samples are raised from 1 to 256, or stay as told; at each count all depths that the file can
/// hold are measured, which costs no rays. The first count at which one is within the limit is
/// taken, with the fewest bits that are. 256 samples are compared with a reference of 1024, on an
/// eighth of the texels; where the map is too large for such a reference, 64 are the most.
/// \throws InvalidInput if none is within the limit: it names the least error of all choices, which
///         part of it is the larger one, and the bits that would do in another file
MeshAccuracy settle_accuracy(const Baker& baker, const BakeMapOptions& map,
                             MeshBakeRequest& request, NormalMapFormat& format);

void print_accuracy(const MeshBakeRequest& request, const MeshAccuracy& accuracy);
void add_accuracy(const MeshAccuracy& accuracy, nlohmann::ordered_json& report);

}  // namespace relief::tools
