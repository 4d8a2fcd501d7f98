// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sequences of pictures: a turntable, or the frames of the scene's animation, with their options
/// and their drawing. Tests: tests/tools/sequence_test.cpp.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/command.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

void add_sequence_options(CLI::App& app, ViewOptions& options);

/// Poses the scene for picture `index`, counted from 0: rotated, or at the time of the picture.
void pose_for(ComposedScene& composed, const ViewOptions& options, int index);

/// Times of all pictures in milliseconds.
struct SequenceTimes {
    std::vector<double> draw;
    std::vector<double> read_back;
};

/// Draws all pictures and passes them on. The camera moves only if it belongs to the scene.
/// \param prepare  makes the renderer of the current scene; called again for each picture if
///                 materials move
/// \return the last frame
shade::Frame draw_sequence(const std::function<std::unique_ptr<shade::Renderer>()>& prepare,
                           ComposedScene& composed, const ViewOptions& options, Stages& stages,
                           const std::function<void(const shade::Frame&)>& take,
                           SequenceTimes& times);

}  // namespace relief::tools
