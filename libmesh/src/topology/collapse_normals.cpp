// SPDX-License-Identifier: Apache-2.0
// The normals of the input at vertices: their mean, and all of them where they differ. Tests:
// tests/mesh/topology/decimate_test.cpp.
#include "topology/collapse_normals.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "parallel.h"
#include "relaxed_store.h"

namespace relief::detail {
namespace {

/// A vertex is sharp if the normal of one of its triangles differs by more than this angle, 60
/// degrees, from their mean.
constexpr double min_smooth_cosine = 0.5;

}  // namespace

glm::dvec3 cross_of(const CollapseInput& input, const CollapseSurface& surface,
                    std::size_t triangle) {
    const std::size_t first = 3 * triangle;
    const glm::dvec3 a = input.point(surface[first].vertex);
    return glm::cross(input.point(surface[first + 1].vertex) - a,
                      input.point(surface[first + 2].vertex) - a);
}

CollapseNormals::CollapseNormals(const CollapseInput& input, const CollapseSurface& surface)
    : input_(input), surface_(surface), mean_normals_(input.positions.size(), glm::vec3(0.0F)) {}

void CollapseNormals::add_triangle(std::size_t triangle, const glm::dvec3& normal) {
    for (std::size_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner)
        mean_normals_[surface_[corner].vertex] += glm::vec3(normal);
}

void CollapseNormals::finish() {
    constexpr std::size_t grain = 16384;
    std::vector<std::uint8_t> is_sharp(mean_normals_.size(), 0);
    std::atomic<bool> has_sharp = false;
    parallel_for(surface_.corners().size() / 3, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::dvec3 normal = input_normal(t);
            if (normal == glm::dvec3(0.0)) continue;
            for (std::size_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
                const std::uint32_t vertex = surface_[corner].vertex;
                const glm::dvec3 mean(mean_normals_[vertex]);
                if (glm::dot(normal, mean) > min_smooth_cosine * glm::length(mean)) continue;
                // Other threads may write the same value.
                relaxed_store(is_sharp[vertex], 1);
                has_sharp = true;
            }
        }
    });
    if (has_sharp || input_.min_normal_cosine) list_normals(is_sharp);
}

/// Returns the unit normal of a triangle before any collapse; 0 without area.
glm::dvec3 CollapseNormals::input_normal(std::size_t triangle) const {
    const glm::dvec3 cross = cross_of(input_, surface_, triangle);
    const double length = glm::length(cross);
    return length > 0.0 ? cross / length : glm::dvec3(0.0);
}

void CollapseNormals::list_normals(const std::vector<std::uint8_t>& is_sharp) {
    const auto is_listed = [&](std::uint32_t vertex) {
        return input_.min_normal_cosine || is_sharp[vertex] != 0;
    };
    normal_begin_.assign(input_.positions.size() + 1, 0);
    for (const CornerData& corner : surface_.corners()) {
        if (is_listed(corner.vertex)) ++normal_begin_[corner.vertex + 1];
    }
    std::partial_sum(normal_begin_.begin(), normal_begin_.end(), normal_begin_.begin());
    normals_at_.resize(normal_begin_.back());
    std::vector<std::uint32_t> end(normal_begin_.begin(), normal_begin_.end() - 1);
    for (std::size_t corner = 0; corner < surface_.corners().size(); ++corner) {
        const std::uint32_t vertex = surface_[corner].vertex;
        if (is_listed(vertex)) normals_at_[end[vertex]++] = glm::vec3(input_normal(corner / 3));
    }
}

/// Returns whether a triangle of the input at a vertex has a normal within the maximum angle, or
/// 90 degrees, of a cross product. At a vertex with more than max_valence triangles, a part of them
/// is compared.
///
/// A cross product within 90 degrees of the sum of the normals is within 90 degrees of one of them.
/// At vertices that are not sharp, only those are accepted.
bool CollapseNormals::has_normal_near(std::uint32_t vertex, const glm::dvec3& cross) const {
    const glm::dvec3 mean(mean_normals_[vertex]);
    if (!input_.min_normal_cosine && glm::dot(mean, cross) > 0.0) return true;
    bool has_normal = mean != glm::dvec3(0.0);
    const std::uint32_t begin = normal_begin_.empty() ? 0 : normal_begin_[vertex];
    const std::uint32_t end = normal_begin_.empty() ? 0 : normal_begin_[vertex + 1];
    const std::uint32_t step = 1 + (end - begin) / static_cast<std::uint32_t>(max_valence);
    const double cosine = std::max(input_.min_normal_cosine.value_or(0.0), 0.0);
    const double least = cosine * glm::length(cross);
    for (std::uint32_t i = begin; i < end; i += step) {
        const glm::dvec3 normal(normals_at_[i]);
        if (normal == glm::dvec3(0.0)) continue;
        if (glm::dot(normal, cross) >= least) return true;
        has_normal = true;
    }
    return !has_normal;
}

}  // namespace relief::detail
