// SPDX-License-Identifier: Apache-2.0
/// \file
/// Draws the pictures of a sequence, one after the other with one renderer, and writes them.
/// Tests: tests/tools/sequence_test.cpp.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/command.h"
#include "relief/mesh/image.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

/// Where the pictures of a run go: one file, numbered files, or an animation.
class PictureSink {
  public:
    virtual ~PictureSink() = default;
    virtual void take(const Image& picture) = 0;
    /// After the last. \throws FileError
    virtual void finish() {}
};
std::unique_ptr<PictureSink> make_sink(const ViewOptions& options);

/// Puts the scene as it is to be in picture `index`, from 0: turned, or posed at its time.
void pose_for(ComposedScene& composed, const ViewOptions& options, int index);

/// Times of all pictures in milliseconds: what a steady frame takes.
struct SequenceTimes {
    std::vector<double> draw;
    std::vector<double> read_back;
};

/// Draws every picture and hands it on; the camera stays unless the scene's own moves.
/// \return the last frame
Frame draw_sequence(Renderer& renderer, ComposedScene& composed, const ViewOptions& options,
                    Stages& stages, const std::function<void(const Frame&)>& take,
                    SequenceTimes& times);

}  // namespace relief::tools
