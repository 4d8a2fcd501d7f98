// SPDX-License-Identifier: Apache-2.0
/// \file
/// How true `relief-bake bump` is to be: the kernel by choice or by the map, bounds of the error,
/// errors beside times. Tests: tests/tools/bump_accuracy_test.cpp.
#pragma once

#include <optional>

#include "common/options.h"
#include "relief/mesh/bump_experiment.h"
#include "relief/mesh/bump_file.h"

namespace relief::tools {

/// What the command line says; absent: by what the map itself shows.
struct AccuracyRequest {
    std::optional<Kernel> kernel;
    std::optional<Arithmetic> precision;
    bool destaircase = false;
    Grain grain = Grain::automatic;
    std::optional<double> max_error;        ///< Of the map and the conversion together.
    std::optional<double> max_added_error;  ///< Of the conversion alone.
    std::optional<ErrorKind> max_error_kind;
    bool compare = false;
};

/// What came of it.
struct AccuracyFound {
    std::optional<KernelChoice> choice;        ///< Where the map was looked at for the kernel.
    std::optional<BumpExperiment> experiment;  ///< For --compare and --max-error.
    std::optional<BumpMeasurement> kept;       ///< What keeps within --max-error.
    double step = 0.0;                         ///< Of steps that were smoothed away; 0: none.
};

/// --kernel, --grain, --precision, --destaircase, --max-error, --max-added-error,
/// --max-error-kind, --compare.
void add_accuracy_options(CLI::App& app, AccuracyRequest& request);

/// \throws UsageError where options contradict each other or have no effect
/// \param half  the result is stored as half floats, of which errors are not measured
void check(const AccuracyRequest& request, bool slope_moments, bool half);

/// Whether parts of the map must be looked at, and which, from top to bottom.
std::vector<ImagePart> parts_wanted(const AccuracyRequest& request, const ImageInfo& map);

/// Settles kernel, arithmetic and depth of a conversion by the map's own parts.
///
/// \param parts   parts_wanted()
/// \param depths  that the file may have: of these, --max-error chooses
/// \param report  gets a finding where the kernel depends on what the grain of the map is
/// \throws InvalidInput where nothing keeps within --max-error, saying what comes closest
AccuracyFound settle_accuracy(const AccuracyRequest& request, const ImageInfo& map,
                              const std::vector<Image>& parts, const std::vector<int>& depths,
                              BumpOptions& bump, NormalMapFormat& format, Report& report);

/// Smooths the steps of a map away, where that is asked for and there are any.
/// \throws InvalidInput if the map is too large to be in memory
void destaircase_map(const AccuracyRequest& request, const Wraps& wrap, HeightMapFile& map,
                     AccuracyFound& found);

}  // namespace relief::tools
