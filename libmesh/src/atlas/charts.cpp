// SPDX-License-Identifier: Apache-2.0
// The error of mean normals is that of [Cohen-Steiner et al. 2004]; instead of its iterations,
// clusters merge in rounds.
#include "atlas/charts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "atlas/clustering.h"
#include "portable_math.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

constexpr double pi = std::numbers::pi;
constexpr float infinite = std::numeric_limits<float>::infinity();

double length_of(const glm::dvec3& v) {
    return std::sqrt(glm::dot(v, v));
}

/// How far a shape is from a disk: 1 for a disk, more for long or jagged ones.
double elongation(double perimeter, double area) {
    return perimeter * perimeter / (4.0 * pi * area);
}

// Small clusters: about `size` faces with similar normals.

class SmallClusters {
  public:
    SmallClusters(const AtlasSurface& surface, double size) : size_(size) {
        const std::size_t count = surface.faces.size();
        clusters_.resize(count);
        for (std::uint32_t face = 0; face < count; ++face) {
            double perimeter = 0.0;
            for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner)
                perimeter += surface.edge_length(corner);
            clusters_[face] = {surface.areas[face] * surface.normals[face], surface.areas[face],
                               surface.areas[face], perimeter, 1.0};
        }
    }

    [[nodiscard]] float cost(const ClusterEdge& edge) const {
        const Cluster& a = clusters_[edge.a];
        const Cluster& b = clusters_[edge.b];
        const double faces = a.faces + b.faces;
        if (faces > 2.0 * size_) return infinite;
        const double area = a.area + b.area;
        const double loss = 2.0 * (a.length + b.length - length_of(a.normal + b.normal)) / area;
        const double perimeter = std::max(a.perimeter + b.perimeter - 2.0 * edge.length, 0.0);
        return static_cast<float>(std::max(loss, 0.0) + 0.003 * elongation(perimeter, area) +
                                  0.25 * faces / size_);
    }
    void merge(const ClusterEdge& edge) {
        Cluster& a = clusters_[edge.a];
        const Cluster& b = clusters_[edge.b];
        a.normal += b.normal;
        a.length = length_of(a.normal);
        a.area += b.area;
        a.perimeter = std::max(a.perimeter + b.perimeter - 2.0 * edge.length, 0.0);
        a.faces += b.faces;
    }
    void move(std::uint32_t from, std::uint32_t to) { clusters_[to] = clusters_[from]; }

    /// The sum of the normals, weighted by area.
    [[nodiscard]] const glm::dvec3& normal(std::uint32_t cluster) const {
        return clusters_[cluster].normal;
    }

  private:
    struct Cluster {
        glm::dvec3 normal;
        double length;  ///< Of the normal.
        double area;
        double perimeter;
        double faces;
    };
    double size_;
    std::vector<Cluster> clusters_;
};

// Charts: clusters whose normals lie in a cone.

struct Cone {
    glm::dvec3 axis{0.0, 0.0, 1.0};
    double half_angle = 0.0;
};

/// Returns the smallest cone that contains both.
Cone united(const Cone& a, const Cone& b) {
    const double angle =
        portable::atan2(length_of(glm::cross(a.axis, b.axis)), glm::dot(a.axis, b.axis));
    if (angle + b.half_angle <= a.half_angle) return a;
    if (angle + a.half_angle <= b.half_angle) return b;
    const double half = 0.5 * (angle + a.half_angle + b.half_angle);
    if (half >= pi) return {a.axis, pi};
    // Turns the axis of a towards b.
    const glm::dvec3 across = b.axis - a.axis * glm::dot(a.axis, b.axis);
    const double length = length_of(across);
    if (!(length > 0.0)) return {a.axis, half};
    const double turn = half - a.half_angle;
    return {portable::cos(turn) * a.axis + (portable::sin(turn) / length) * across, half};
}

class ChartClusters {
  public:
    ChartClusters(std::size_t count, const ChartLimits& limits)
        : limits_(limits), clusters_(count) {}

    /// Adds a face. \param normal of its small cluster, unit
    void add(std::uint32_t cluster, double area, const glm::dvec3& normal) {
        Cluster& each = clusters_[cluster];
        each.normal += area * normal;
        each.area += area;
        each.cone.axis = normal;
    }
    void add_border(std::uint32_t cluster, double length) {
        clusters_[cluster].perimeter += length;
        ++clusters_[cluster].border_count;
    }

    [[nodiscard]] float cost(const ClusterEdge& edge) const {
        const Cluster& a = clusters_[edge.a];
        const Cluster& b = clusters_[edge.b];
        const double area = a.area + b.area;
        const double spread = 2.0 * (1.0 - length_of(a.normal + b.normal) / area);
        if (spread > limits_.spread) return infinite;
        // A closed surface cannot be flattened.
        if (a.border_count + b.border_count == 2 * edge.count) return infinite;
        if (united(a.cone, b.cone).half_angle > limits_.cone) return infinite;
        const double perimeter = std::max(a.perimeter + b.perimeter - 2.0 * edge.length, 0.0);
        const double shared = edge.length / std::max(std::min(a.perimeter, b.perimeter), 1e-300);
        return static_cast<float>(std::max(
            std::max(spread, 0.0) + 0.01 * elongation(perimeter, area) - 0.02 * shared, 0.0));
    }
    void merge(const ClusterEdge& edge) {
        Cluster& a = clusters_[edge.a];
        const Cluster& b = clusters_[edge.b];
        a.cone = united(a.cone, b.cone);
        a.normal += b.normal;
        a.area += b.area;
        a.perimeter = std::max(a.perimeter + b.perimeter - 2.0 * edge.length, 0.0);
        a.border_count += b.border_count - 2 * edge.count;
    }
    void move(std::uint32_t from, std::uint32_t to) { clusters_[to] = clusters_[from]; }

  private:
    struct Cluster {
        glm::dvec3 normal{0.0};
        Cone cone;
        double area = 0.0;
        double perimeter = 0.0;
        std::uint32_t border_count = 0;
    };
    ChartLimits limits_;
    std::vector<Cluster> clusters_;
};

/// Merges first what costs little, in about 40 steps.
constexpr CostLimit chart_costs{0.005F, 1.15F, 2.0F};

/// The borders between clusters of faces. \param cluster for each face
std::vector<ClusterEdge> borders_of(const AtlasSurface& surface,
                                    std::span<const std::uint32_t> cluster, std::size_t count) {
    std::vector<ClusterEdge> edges;
    for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
        check_cancelled(corner);
        const Corner other = surface.opposite[corner];
        if (other == no_corner || other < corner || surface.is_border[corner]) continue;
        const auto [a, b] = std::minmax(cluster[corner / 3], cluster[other / 3]);
        if (a != b) edges.push_back({a, b, 1, -1.0F, surface.edge_length(corner)});
    }
    check_cancelled();
    combine_edges(edges, count);
    check_cancelled();
    return edges;
}

/// The number of faces of a small cluster.
double cluster_size(std::size_t face_count) {
    return std::clamp(static_cast<double>(face_count) / 3000.0, 1.0, 32.0);
}

std::size_t count_of(std::span<const std::uint32_t> labels) {
    return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + std::size_t{1};
}

}  // namespace

Segmentation divided(const AtlasSurface& surface, const ChartLimits& limits) {
    const std::size_t face_count = surface.faces.size();
    Segmentation result;
    std::vector<std::uint32_t> cluster(face_count);
    std::iota(cluster.begin(), cluster.end(), 0U);
    {
        std::vector<ClusterEdge> edges = borders_of(surface, cluster, face_count);
        result.cluster_size = cluster_size(face_count);
        SmallClusters small(surface, result.cluster_size);
        cluster = merge_in_rounds(small, face_count, edges, CostLimit{});
        result.smooth_normals.resize(face_count);
        for (std::uint32_t face = 0; face < face_count; ++face) {
            const glm::dvec3 sum = small.normal(cluster[face]);
            const double length = length_of(sum);
            result.smooth_normals[face] =
                glm::vec3(length > 0.0 ? sum / length : surface.normals[face]);
        }
    }
    const std::size_t small_count = count_of(cluster);
    ChartClusters charts(small_count, limits);
    for (std::uint32_t face = 0; face < face_count; ++face)
        charts.add(cluster[face], surface.areas[face], glm::dvec3(result.smooth_normals[face]));
    for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
        check_cancelled(corner);
        const Corner other = surface.opposite[corner];
        if (other == no_corner || cluster[corner / 3] != cluster[other / 3])
            charts.add_border(cluster[corner / 3], surface.edge_length(corner));
    }
    std::vector<ClusterEdge> edges = borders_of(surface, cluster, small_count);
    const std::vector<std::uint32_t> chart =
        merge_in_rounds(charts, small_count, edges, chart_costs);
    result.chart.resize(face_count);
    for (std::uint32_t face = 0; face < face_count; ++face)
        result.chart[face] = chart[cluster[face]];
    result.count = count_of(chart);
    return result;
}

}  // namespace relief::detail
