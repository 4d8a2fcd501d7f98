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

/// Measured ray lengths bridge a gap between the boxes of at most this share of the low box's
/// diagonal: a larger one is taken for a misplaced mesh, not for a ray length.
constexpr double max_automatic_share = 0.5;

BakeDistances distances_of(std::span<const Mesh> high, const HighSurface& surface, const Mesh& low,
                           const BakeOptions& options) {
    const bool all_known = options.cage != nullptr || (options.offset && options.max_distance);
    BakeDistances distances;
    if (!all_known) distances = distances_between(high, surface.scene(), low);
    distances.offset = options.offset.value_or(distances.offset);
    distances.max_distance = options.max_distance.value_or(distances.max_distance);
    return distances;
}

/// The longest distance of rays from the low mesh.
double reach_of(const BakeOptions& options, double cage_reach, double low_diagonal) {
    if (options.cage != nullptr)
        return std::max(cage_reach, options.max_distance.value_or(cage_reach));
    const double automatic = max_automatic_share * low_diagonal;
    return std::max(options.offset.value_or(automatic), options.max_distance.value_or(automatic));
}

/// Checks the boxes before rays are prepared. \return the diagonal of the box around both
double checked_extent(const BakeFit& fit, std::span<const Mesh> high, const BakeOptions& options,
                      double cage_reach, const std::string& name, Report& report) {
    if (fit.low.empty()) return 0.0;
    if (fit.high.empty()) {
        // A part without a high mesh is a choice.
        if (high.empty()) return 0.0;
        throw BakeMismatch(BakeMismatch::Kind::no_surface, fit, 0.0, name);
    }
    const double reach = reach_of(options, cage_reach, diagonal(fit.low));
    if (fit.differs_in_size() && !options.allow_size_mismatch)
        throw BakeMismatch(BakeMismatch::Kind::size, fit, reach, name);
    if (fit.gap > reach) throw BakeMismatch(BakeMismatch::Kind::apart, fit, reach, name);
    if (fit.fits_turned) {
        report.add("high box that fits only with y and z swapped", "part", 0,
                   "baked as it is: one side may be Y up, the other Z up");
    }
    return glm::distance(glm::max(glm::dvec3(fit.high.max), glm::dvec3(fit.low.max)),
                         glm::min(glm::dvec3(fit.high.min), glm::dvec3(fit.low.min)));
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
                         double reach, const std::string& name, Report& report)
    : fit(compare_boxes(meshes, low)),
      extent(checked_extent(fit, meshes, options, reach, name, report)),
      high(meshes, options, report),
      distances(distances_of(meshes, high, low, options)) {}

BakeParts::BakeParts(std::span<const Mesh> high, const LowSurface& low, const BakeOptions& options,
                     Report& report) {
    surfaces_.push_back(
        std::make_unique<SeenSurface>(high, low.mesh(), options, low.cage_reach(), "", report));
}

BakeParts::BakeParts(std::span<const BakePart> parts, const LowSurface& low,
                     const BakeOptions& options, Report& report)
    : part_of_triangle_(parts_of_triangles(parts, low.mesh())) {
    const double reach = low.cage_reach();
    for (const BakePart& part : parts) {
        const Mesh own = part_of(low.mesh(), part.triangles);
        surfaces_.push_back(
            std::make_unique<SeenSurface>(part.high, own, options, reach, part.name, report));
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

BakeFit BakeParts::fit() const {
    const auto grow = [](Bounds& box, const Bounds& other) {
        box.min = glm::min(box.min, other.min);
        box.max = glm::max(box.max, other.max);
    };
    Bounds high;
    Bounds low;
    for (const auto& surface : surfaces_) {
        grow(high, surface->fit.high);
        grow(low, surface->fit.low);
    }
    return compare_boxes(high, low);
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
