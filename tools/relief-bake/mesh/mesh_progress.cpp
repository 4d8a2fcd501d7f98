// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/mesh_progress_test.cpp.
#include "mesh/mesh_progress.h"

#include <fmt/format.h>

#include <cmath>

namespace relief::tools {

std::string progress_words(double part, double seconds, std::size_t rays) {
    const double rate = seconds > 0.0 ? static_cast<double>(rays) / seconds / 1e6 : 0.0;
    const std::string words = fmt::format("{:.1f} million rays a second", rate);
    if (seconds < 1.0 || part <= 0.0) return words;
    const double left = std::ceil(seconds / part * (1.0 - part));
    return words + (left < 120.0 ? fmt::format(", {:.0f} s left", left)
                                 : fmt::format(", {:.0f} min left", std::ceil(left / 60.0)));
}

MapProgress::MapProgress(Stages& stages, std::size_t maps) : stages_(stages), maps_(maps) {}

std::function<void(const BakeProgress&)> MapProgress::next_map(int height) {
    rays_before_ += rays_;
    rays_ = 0;
    const std::size_t index = begun_++;
    if (!stages_.shows_progress()) return {};
    return [this, index, height](const BakeProgress& progress) {
        rays_ = progress.rays;
        const double part = (static_cast<double>(index) +
                             static_cast<double>(progress.rows) / static_cast<double>(height)) /
                            static_cast<double>(maps_);
        stages_.show_progress("bake", part,
                              progress_words(part, stopwatch_.seconds(), rays_before_ + rays_));
    };
}

}  // namespace relief::tools
