// SPDX-License-Identifier: Apache-2.0
// Origins are multiples of a power of two near the mesh's size, so that taking them off costs no
// digit and they are short to write. Tests: tests/mesh/io/mesh/far_positions_test.cpp.
#include "io/mesh/far_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

/// By how much to shift the mesh: zero unless it is far from 0 for its size.
glm::dvec3 middle_if_far(const Mesh& mesh) {
    constexpr double near = 16.0;  // Floats then still hold 20 bits of the mesh's size.
    const Bounds bounds = bounds_of(mesh);
    if (bounds.empty()) return glm::dvec3(0.0);
    const glm::dvec3 low(bounds.min);
    const glm::dvec3 high(bounds.max);
    const glm::dvec3 extent = high - low;
    const double size = std::max({extent.x, extent.y, extent.z});
    const glm::dvec3 farthest = glm::max(glm::abs(low), glm::abs(high));
    if (std::max({farthest.x, farthest.y, farthest.z}) <= near * size) return glm::dvec3(0.0);
    if (size == 0.0) return low;  // All in one place, as far as floats can tell.
    const double step = std::exp2(std::ceil(std::log2(size)));
    return glm::round(0.5 * (low + high) / step) * step;
}

/// Whether reading around an origin brought to light what floats had lost.
bool holds_more(const MeshFile& around, const MeshFile& before) {
    const std::vector<glm::vec3>& now = around.mesh.positions;
    const std::vector<glm::vec3>& then = before.mesh.positions;
    if (now.size() != then.size()) return true;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const glm::dvec3 value = glm::dvec3(now[i]) + around.origin;
        const glm::dvec3 old = glm::dvec3(then[i]) + before.origin;
        for (int k = 0; k < 3; ++k) {
            if (value[k] != old[k] && std::isfinite(value[k])) return true;
        }
    }
    return false;
}

}  // namespace

MeshFile read_near(const std::filesystem::path& file, const ReadAround& read, Report& report) {
    Report findings;
    MeshFile best = read(file, glm::dvec3(0.0), findings);
    // What floats put into one place may be far apart for its size once it is seen from near by.
    constexpr int most_looks = 3;
    for (int look = 0; look < most_looks; ++look) {
        const glm::dvec3 shift = middle_if_far(best.mesh);
        if (shift == glm::dvec3(0.0)) break;
        Report again;
        MeshFile around = read(file, best.origin + shift, again);
        around.origin = best.origin + shift;
        if (!holds_more(around, best)) break;
        best = std::move(around);
        findings = std::move(again);
    }
    report.merge(findings);
    if (best.origin != glm::dvec3(0.0)) {
        report.add("far from the origin", "mesh", 0,
                   fmt::format("are kept relative to ({}, {}, {}), where floats hold their digits",
                               best.origin.x, best.origin.y, best.origin.z));
    }
    return best;
}

}  // namespace relief
