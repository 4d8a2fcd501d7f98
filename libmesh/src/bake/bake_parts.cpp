// SPDX-License-Identifier: Apache-2.0
// A scene for each part, so that what a part does not see costs its rays nothing.
// Tests: tests/mesh/bake/baker_test.cpp.
#include "bake/bake_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "bake/bake_distances.h"
#include "relief/mesh/error.h"
#include "relief/mesh/mesh_part.h"

namespace relief {
namespace {

BakeDistances distances_of(std::span<const Mesh> high, const HighSurface& surface, const Mesh& low,
                           const BakeOptions& options) {
    const bool all_known = options.cage != nullptr || (options.offset && options.max_distance);
    BakeDistances distances;
    if (!all_known) distances = distances_between(high, surface.scene(), low);
    distances.offset = options.offset.value_or(distances.offset);
    distances.max_distance = options.max_distance.value_or(distances.max_distance);
    return distances;
}

std::vector<std::uint32_t> parts_of_triangles(std::span<const BakePart> parts, const Mesh& low) {
    constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> result(low.triangles.size(), none);
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (const std::uint32_t triangle : parts[part].triangles) {
            if (triangle >= result.size() || result[triangle] != none) {
                throw InvalidInput(
                    fmt::format("triangle {} of the low mesh is {}", triangle,
                                triangle < result.size() ? "in two parts" : "not there"));
            }
            result[triangle] = static_cast<std::uint32_t>(part);
        }
    }
    const auto lost = std::find(result.begin(), result.end(), none);
    if (lost != result.end()) {
        throw InvalidInput(
            fmt::format("triangle {} of the low mesh is in no part", lost - result.begin()));
    }
    return result;
}

}  // namespace

SeenSurface::SeenSurface(std::span<const Mesh> meshes, const Mesh& low, const BakeOptions& options,
                         Report& report)
    : high(meshes, options, report), distances(distances_of(meshes, high, low, options)) {}

BakeParts::BakeParts(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
                     Report& report) {
    surfaces_.push_back(std::make_unique<SeenSurface>(high, low, options, report));
}

BakeParts::BakeParts(std::span<const BakePart> parts, const Mesh& low, const BakeOptions& options,
                     Report& report)
    : part_of_triangle_(parts_of_triangles(parts, low)) {
    for (const BakePart& part : parts) {
        const Mesh own = part_of(low, part.triangles);
        surfaces_.push_back(std::make_unique<SeenSurface>(part.high, own, options, report));
    }
}

LayerBounds BakeParts::bounds(const BakeLayers& layers) const {
    LayerBounds bounds;
    for (const auto& surface : surfaces_) {
        if (layers.curvature) {
            const HighSurface::CurvatureRange range = surface->high.curvature_range();
            bounds.curvature = std::max(bounds.curvature, range.greatest);
            bounds.usual_curvature = std::max(bounds.usual_curvature, range.usual);
        }
        if (layers.positions) {
            bounds.position = std::max(bounds.position,
                                       surface->high.largest_coordinate(layers.position_from_mesh));
        }
    }
    return bounds;
}

BakeDistances BakeParts::largest_distances() const {
    BakeDistances largest;
    for (const auto& surface : surfaces_) {
        largest.offset = std::max(largest.offset, surface->distances.offset);
        largest.max_distance = std::max(largest.max_distance, surface->distances.max_distance);
    }
    return largest;
}

}  // namespace relief
