// SPDX-License-Identifier: Apache-2.0
/// \file
/// The picture beside that of the scene with one change, or of another file.
///
///     --compare WHAT=VALUE | --compare-to FILE [--split 0.5] [--difference-map FILE]
///
/// Tests: tests/tools/compare_options_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "picture_comparison.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"

namespace relief::tools {

void add_compare_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if they contradict each other or others, or say nothing
void check_compare_options(const ViewOptions& options);

/// What is on the other side, from the same eye.
struct OtherSide {
    Scene scene;
    Camera camera;
};

/// \param composed  the scene of these options
/// \throws UsageError where the change could show nothing, FileError where a file cannot be read
OtherSide other_side(const ViewOptions& options, const ComposedScene& composed, Stages& stages,
                     Report& report);

/// Another file's scene, composed as these options say, in this scene's light unless it is a scene
/// file, which has its own. \param options  that file is their model
OtherSide side_of_file(const Scene& scene, const Camera& camera, const ViewOptions& options,
                       Scene other);

/// "kernel=central3", or the file's name.
std::string side_in_words(const CompareChoices& choices);

/// {"with", "split", and the numbers}
nlohmann::ordered_json sides_json(const CompareChoices& choices,
                                  const PictureComparison& comparison);

/// The options that ask for the same, each with a space before it; "" where nothing is compared.
std::string command_line_of(const CompareChoices& choices);

}  // namespace relief::tools
