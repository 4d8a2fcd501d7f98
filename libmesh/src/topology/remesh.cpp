// SPDX-License-Identifier: Apache-2.0
// Remeshing: the steps, and the result with its material ranges.
// Tests: tests/mesh/topology/remesh_test.cpp.
#include "relief/mesh/remesh.h"

#include <fmt/format.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "progress_stage.h"
#include "topology/remesh_grid.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Returns the triangles in the order of their material ranges.
Mesh with_ranges(const Mesh& input, ContouredSurface surface) {
    Mesh result;
    result.name = input.name;
    result.positions = std::move(surface.positions);
    if (input.material_ranges.empty()) {
        result.triangles = std::move(surface.triangles);
        return result;
    }
    result.material_ranges = input.material_ranges;
    for (MaterialRange& range : result.material_ranges)
        range.triangle_count = 0;
    for (const std::uint32_t range : surface.ranges)
        ++result.material_ranges[range].triangle_count;
    std::vector<std::uint32_t> next;
    std::uint32_t first = 0;
    for (MaterialRange& range : result.material_ranges) {
        range.first_triangle = first;
        next.push_back(first);
        first += range.triangle_count;
    }
    result.triangles.resize(surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        result.triangles[next[surface.ranges[t]]++] = surface.triangles[t];
    return result;
}

}  // namespace

Mesh remeshed(const Mesh& mesh, const RemeshOptions& options, Report& report) {
    validate(mesh);
    constexpr int min_resolution = 8;
    constexpr int max_resolution = 1024;
    if (options.resolution < min_resolution || options.resolution > max_resolution)
        throw InvalidInput(fmt::format("the resolution is {}, but must be from {} to {}",
                                       options.resolution, min_resolution, max_resolution));
    const ExecutionScope execution(options.execution);
    const ProgressStage stage("remeshing");
    RemeshGrid grid(mesh, options.resolution, report);
    find_hits(grid, options.shell);
    if (options.sign == RemeshSign::winding)
        find_outside_by_winding(grid, options.shell);
    else
        find_outside(grid, options.shell);
    ContouredSurface surface = contoured(grid, options.shell);
    if (surface.triangles.empty())
        throw InvalidInput(fmt::format(
            "the triangles enclose nothing that is as thick as a cell at resolution {}: raise the "
            "resolution, or make shells of sheets",
            options.resolution));
    if (!mesh.normals.empty() || !mesh.texcoords.empty() || !mesh.tangents.empty() ||
        !mesh.colors.empty() || !mesh.texcoords_2.empty() || !mesh.smoothing_groups.empty())
        report.add("attributes of other triangles", "mesh", 0, "are not kept");
    return with_ranges(mesh, std::move(surface));
}

}  // namespace relief
