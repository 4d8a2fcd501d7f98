// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far a bake is, on a terminal: part of all maps, rays a second, time that is left.
/// Tests: tests/tools/mesh_progress_test.cpp.
#pragma once

#include <functional>
#include <string>

#include "common/command.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/timing.h"

namespace relief::tools {

/// "2.5 million rays a second, 12 s left"; without the latter before a second has passed, as it
/// would say too little.
/// \param part  of all, 0 to 1
std::string progress_words(double part, double seconds, std::size_t rays);

class MapProgress {
  public:
    MapProgress(Stages& stages, std::size_t maps);

    /// What tells the next map's progress; nothing where there is no terminal.
    [[nodiscard]] std::function<void(const BakeProgress&)> next_map(int height);

  private:
    Stages& stages_;
    std::size_t maps_;
    std::size_t begun_ = 0;
    std::size_t rays_before_ = 0;  ///< Of the maps that are done.
    std::size_t rays_ = 0;         ///< Of the one being baked.
    Stopwatch stopwatch_;
};

}  // namespace relief::tools
