// SPDX-License-Identifier: Apache-2.0
// Tangents of usual vertices from slices of triangles. A vertex belongs to the slice of its first
// triangle. If it also has triangles of later slices, their contributions are computed once more.
// Tests: tests/mesh/geometry/frames_test.cpp.
#include "geometry/vertex_tangents.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include "geometry/tangent_fans.h"
#include "large_memory.h"
#include "parallel.h"
#include "relaxed_store.h"

namespace relief::detail {
namespace {

/// Returns the number of triangles in a slice. A grid of triangles in rows has vertices of several
/// slices along one row only, so the part of these vertices is the same for all sizes.
std::size_t slice_size(std::size_t triangle_count) {
    constexpr std::size_t smallest = 4096;
    constexpr double rows = 32.0;
    return std::max(
        smallest, static_cast<std::size_t>(rows * std::sqrt(static_cast<double>(triangle_count))));
}

/// Computes the tangents of one slice after another. Reuses its memory.
class SliceAverager {
  public:
    SliceAverager(const TangentInput& mesh, const CornersByVertex& corners, std::size_t size,
                  UsualTangents& found)
        : mesh_(mesh), corners_(corners), found_(found), contributions_(3 * size), kinds_(size) {}

    /// Computes the contributions of a slice; vertices of triangles without one are not usual.
    void prepare(std::size_t begin, std::size_t end) {
        first_ = static_cast<Corner>(3 * begin);
        end_ = static_cast<Corner>(3 * end);
        without_.clear();
        TangentInput part = mesh_;
        part.triangles = mesh_.triangles.subspan(begin, end - begin);
        compute_contributions(part, contributions_, kinds_, without_);
        for (const std::uint32_t triangle : without_) {
            for (int i = 0; i < 3; ++i)
                leave(part.triangles[triangle][i]);
        }
        across_.clear();
    }

    /// Computes the tangents of vertices with all triangles in the slice, and collects the others.
    RELIEF_INLINE void average_inside() {
        const TriangleSpan part =
            mesh_.triangles.subspan(first_ / 3, static_cast<std::size_t>(end_ - first_) / 3);
        FanAverager fans(contributions_, part);
        std::array<Corner, max_single_fan> local;
        for (Corner corner = first_; corner < end_; ++corner) {
            const std::uint32_t vertex = vertex_of(corner, mesh_.triangles);
            const std::span<const Corner> around = corners_.at(vertex);
            if (around[0] != corner) continue;
            if (around.size() > max_single_fan) {
                leave(vertex);
                continue;
            }
            if (around.back() >= end_) {
                across_.push_back(vertex);
                continue;
            }
            for (std::size_t i = 0; i < around.size(); ++i)
                local[i] = around[i] - first_;
            average(fans, vertex, {local.data(), around.size()});
        }
    }

    /// Computes the contributions around the vertices that have triangles of several slices.
    void prepare_across() {
        triangles_.clear();
        for (const std::uint32_t vertex : across_) {
            for (const Corner corner : corners_.at(vertex))
                triangles_.push_back(triangle_of(corner));
        }
        std::sort(triangles_.begin(), triangles_.end());
        triangles_.erase(std::unique(triangles_.begin(), triangles_.end()), triangles_.end());
        indices_.clear();
        for (const std::uint32_t triangle : triangles_)
            indices_.push_back(mesh_.triangles[triangle]);
        if (contributions_.size() < 3 * indices_.size()) {
            contributions_ = WorkArray<glm::vec4>(3 * indices_.size());
            kinds_ = WorkArray<Gradient>(indices_.size());
        }
        TangentInput part = mesh_;
        part.triangles = indices_;
        without_.clear();  // Each is found in its own slice, too.
        compute_contributions(part, contributions_, kinds_, without_);
    }

    RELIEF_INLINE void average_across() {
        FanAverager fans(contributions_, indices_);
        std::array<Corner, max_single_fan> local;
        for (const std::uint32_t vertex : across_) {
            const std::span<const Corner> around = corners_.at(vertex);
            for (std::size_t i = 0; i < around.size(); ++i) {
                const auto place =
                    std::lower_bound(triangles_.begin(), triangles_.end(), triangle_of(around[i])) -
                    triangles_.begin();
                local[i] = static_cast<Corner>(3 * place) + around[i] % 3;
            }
            average(fans, vertex, {local.data(), around.size()});
        }
    }

    [[nodiscard]] bool any_left() const { return any_left_; }

  private:
    RELIEF_INLINE void average(FanAverager& fans, std::uint32_t vertex,
                               std::span<const Corner> local) {
        const TangentPlane plane(mesh_.normals[vertex]);
        glm::vec4 tangent;
        if (fans.average(local, plane, tangent))
            found_.by_vertex[vertex] = tangent;
        else
            leave(vertex);
    }

    void leave(std::uint32_t vertex) {
        // Other slices may write the same value.
        relaxed_store(found_.is_unusual[vertex], 1);
        any_left_ = true;
    }

    const TangentInput& mesh_;
    const CornersByVertex& corners_;
    UsualTangents& found_;
    Corner first_ = 0;
    Corner end_ = 0;
    bool any_left_ = false;
    WorkArray<glm::vec4> contributions_;
    WorkArray<Gradient> kinds_;
    std::vector<std::uint32_t> without_;
    std::vector<std::uint32_t> across_;     ///< Vertices with triangles of several slices.
    std::vector<std::uint32_t> triangles_;  ///< The triangles around them, ascending,
    std::vector<glm::uvec3> indices_;       ///< and their vertices.
};

// The same loops with and without three-operand instructions.
RELIEF_TARGET_256 [[gnu::flatten]] void average_inside_256(SliceAverager& averager) {
    averager.average_inside();
}
[[gnu::noinline]] void average_inside_any(SliceAverager& averager) {
    averager.average_inside();
}
RELIEF_TARGET_256 [[gnu::flatten]] void average_across_256(SliceAverager& averager) {
    averager.average_across();
}
[[gnu::noinline]] void average_across_any(SliceAverager& averager) {
    averager.average_across();
}

void average_slice(SliceAverager& averager, std::size_t begin, std::size_t end) {
    const bool is_any = best_vector_target() == VectorTarget::any;
    averager.prepare(begin, end);
    is_any ? average_inside_any(averager) : average_inside_256(averager);
    averager.prepare_across();
    is_any ? average_across_any(averager) : average_across_256(averager);
}

}  // namespace

bool has_local_triangles(const CornersByVertex& corners, std::size_t triangle_count) {
    // Up to here, the contributions that are computed twice take less time than those of all
    // triangles in memory.
    constexpr std::size_t max_part = 4;
    const std::size_t size = 3 * slice_size(triangle_count);
    std::atomic<std::size_t> across = 0;
    parallel_for(corners.vertex_count(), 65536, [&](std::size_t begin, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t v = begin; v < end; ++v) {
            const std::span<const Corner> around = corners.at(v);
            if (!around.empty() && around[0] / size != around.back() / size) ++count;
        }
        across += count;
    });
    return across <= corners.vertex_count() / max_part;
}

UsualTangents usual_tangents(const TangentInput& mesh, const CornersByVertex& corners) {
    const std::size_t count = mesh.triangles.size();
    const std::size_t size = slice_size(count);
    UsualTangents found;
    reserve_to_fill(found.by_vertex, mesh.positions.size());
    found.by_vertex.resize(mesh.positions.size(), glm::vec4(0.0F));
    found.is_unusual.resize(mesh.positions.size(), 0);
    // Memory of slices that are done serves the next ones, which would be given new pages.
    std::vector<std::unique_ptr<SliceAverager>> idle;
    std::mutex guard;
    const auto take = [&] {
        const std::scoped_lock lock(guard);
        if (idle.empty())
            return std::make_unique<SliceAverager>(mesh, corners, std::min(size, count), found);
        std::unique_ptr<SliceAverager> last = std::move(idle.back());
        idle.pop_back();
        return last;
    };
    parallel_for((count + size - 1) / size, 1, [&](std::size_t first, std::size_t last) {
        std::unique_ptr<SliceAverager> averager = take();
        for (std::size_t slice = first; slice < last; ++slice)
            average_slice(*averager, slice * size, std::min(count, (slice + 1) * size));
        const std::scoped_lock lock(guard);
        found.any_unusual |= averager->any_left();
        idle.push_back(std::move(averager));
    });
    return found;
}

}  // namespace relief::detail
