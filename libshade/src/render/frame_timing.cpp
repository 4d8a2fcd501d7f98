// SPDX-License-Identifier: Apache-2.0
// Renderers timed in turns, in milliseconds of wall clock; what drawing throws passes.
// Tests: tests/shade/render/effect_costs_test.cpp.
#include "relief/shade/frame_timing.h"

namespace relief {

std::vector<FrameSeries> time_frames(std::span<Renderer* const> renderers, const Camera& camera,
                                     const Repeats& repeats) {
    std::vector<FrameSeries> series(renderers.size());
    interleave(renderers.size(), repeats, [&](std::size_t i, bool counted) {
        const FrameTimes times = renderers[i]->draw(camera).times;
        if (!counted) return;
        series[i].draw.push_back(times.draw);
        series[i].read_back.push_back(times.read_back);
        series[i].frame.push_back(times.draw + times.read_back);
    });
    return series;
}

}  // namespace relief
