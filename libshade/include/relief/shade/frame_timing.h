// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures frame times: renderers draw interleaved, the first frames are dropped, and the wall
/// clock is read around finished work, because the timer queries of software drivers are wrong.
#pragma once

#include <span>
#include <vector>

#include "relief/mesh/timing.h"
#include "relief/shade/renderer.h"

namespace relief {

/// Milliseconds of each counted frame of one renderer, in the order in which they were drawn.
struct FrameSeries {
    std::vector<double> draw;
    std::vector<double> read_back;
    std::vector<double> frame;  ///< Their sum.
};

/// Measures one series for each renderer, interleaved and without warm-up frames.
/// \throws as Renderer::draw() does
std::vector<FrameSeries> time_frames(std::span<Renderer* const> renderers, const Camera& camera,
                                     const Repeats& repeats);

}  // namespace relief
