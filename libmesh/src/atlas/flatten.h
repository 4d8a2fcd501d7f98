// SPDX-License-Identifier: Apache-2.0
/// \file
/// Flattens a chart: coordinates in the plane for its vertices, in the unit of the surface.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "atlas/surface.h"
#include "relief/mesh/unwrap.h"

namespace relief::detail {

/// The faces of a chart with vertices of their own. A vertex where two fans of the chart meet is
/// two vertices.
struct ChartMesh {
    std::vector<std::uint32_t> faces;      ///< Ascending.
    std::vector<glm::uvec3> vertices;      ///< For each of `faces`, its vertices in the chart.
    std::vector<std::uint32_t> positions;  ///< For each vertex, the surface's.
    /// For each edge (3 * index in `faces` + i), that of its neighbor in the chart; or no_corner.
    std::vector<Corner> opposite;
};

/// Numbers the parts of charts, so that a chart can ask which faces belong to it. Threads may use
/// it for different charts at the same time.
class ChartMembers {
  public:
    explicit ChartMembers(std::vector<std::uint32_t> chart)
        : chart_(std::move(chart)), index_(chart_.size()), part_(chart_.size(), 0) {
        for (const std::uint32_t each : chart_)
            next_chart_ = std::max(next_chart_, each + 1);
    }

    /// Makes `faces`, which belong to one chart, a part of it.
    void assign(std::span<const std::uint32_t> faces) {
        const std::uint32_t part = ++last_part_;
        for (std::uint32_t i = 0; i < faces.size(); ++i) {
            index_[faces[i]] = i;
            part_[faces[i]] = part;
        }
    }
    /// Makes faces a chart of their own. assign() is due next; no other thread may work.
    void join(std::span<const std::uint32_t> faces) {
        const std::uint32_t chart = next_chart_++;
        for (const std::uint32_t face : faces)
            chart_[face] = chart;
    }
    [[nodiscard]] bool are_together(std::uint32_t a, std::uint32_t b) const {
        return chart_[a] == chart_[b] && part_[a] == part_[b];
    }
    /// Returns the index in the part that was assigned last.
    [[nodiscard]] std::uint32_t index(std::uint32_t face) const { return index_[face]; }

  private:
    std::vector<std::uint32_t> chart_;
    std::vector<std::uint32_t> index_;
    std::vector<std::uint32_t> part_;
    std::uint32_t next_chart_ = 0;
    std::atomic<std::uint32_t> last_part_{0};  ///< Only whether numbers are equal matters.
};

/// \param faces  ascending, a part of `members`
ChartMesh chart_mesh(const AtlasSurface& surface, const ChartMembers& members,
                     std::vector<std::uint32_t> faces);

/// True if a chart is two triangles with one common edge.
inline bool is_pair(const ChartMesh& chart) {
    return chart.faces.size() == 2 && chart.positions.size() == 4;
}

/// Unfolds such a chart without any stretch.
std::vector<glm::dvec2> unfolded(const AtlasSurface& surface, const ChartMesh& chart);

/// Projects a chart along the mean of its normals.
std::vector<glm::dvec2> projected(const AtlasSurface& surface, const ChartMesh& chart);

/// The options of flattening a chart. Triangles from this area on should not exceed the stretch
/// limit.
struct FlatteningTask {
    Flattening method = Flattening::arap;
    double max_stretch = 4.0;
    double min_area = 0.0;
};

/// Flattens a connected chart. \param start from projected()
///
/// Each iteration finds the rotations of the triangles, then the coordinates that fit them best;
/// one factorization serves all [Liu et al. 2008]. A conformal map fits triangles that are scaled
/// first, by the factor that makes the surface flat and changes areas least: 1 at the longest
/// border, which [Springborn et al. 2008] prove, and the solution of a Poisson equation elsewhere
/// [Sawhney and Crane 2017].
/// \return has inverted or flat triangles if there is no solution
std::vector<glm::dvec2> flattened(const AtlasSurface& surface, const ChartMesh& chart,
                                  std::vector<glm::dvec2> start, const FlatteningTask& task);

/// The stretch of a triangle by its coordinates.
struct Stretch {
    double largest = 0.0;   ///< Larger singular value of the map from the surface to the plane.
    double smallest = 0.0;  ///< Smaller one; negative if the triangle is inverted.
};
Stretch stretch_of(const AtlasSurface& surface, std::uint32_t face,
                   const std::array<glm::dvec2, 3>& coordinates);

}  // namespace relief::detail
