// SPDX-License-Identifier: Apache-2.0
/// \file
/// Smaller pictures while something moves, where whole ones take too long, and the whole one as
/// soon as it rests. Where pictures are quick, nothing changes.
/// Tests: tests/tools/window/resolution_test.cpp.
#pragma once

#include "relief/shade/frame_settings.h"

namespace relief::tools {

class Resolution {
  public:
    /// Longer than this, and hands see pictures lag behind.
    static constexpr double slow_milliseconds = 60.0;
    /// So long after the last movement it rests.
    static constexpr double resting_seconds = 0.15;

    /// How long a whole picture took: one drawn with the settings given to settings_for().
    void whole_took(double milliseconds) { milliseconds_ = milliseconds; }

    /// Something moved, at this time in seconds.
    void moved(double now) { last_move_ = now; }

    /// What to draw with: one sample a pixel and, where that is not enough, every second to fourth
    /// pixel of each row and column, so that a picture takes about slow_milliseconds.
    [[nodiscard]] FrameSettings settings_for(FrameSettings whole, double now) const;

  private:
    double milliseconds_ = 0.0;
    double last_move_ = -1e9;
};

}  // namespace relief::tools
