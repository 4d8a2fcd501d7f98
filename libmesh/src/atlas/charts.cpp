// SPDX-License-Identifier: Apache-2.0
// The error of mean normals is that of [Cohen-Steiner et al. 2004]; instead of its iterations,
// clusters merge in rounds.
#include "atlas/charts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "atlas/clustering.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

constexpr double pi = std::numbers::pi;
constexpr float infinite = std::numeric_limits<float>::infinity();

double length_of(const glm::dvec3& v) {
    return std::sqrt(glm::dot(v, v));
}

/// The distance of a shape from a disk: 1 for a disk, more for long or jagged ones.
double elongation(double perimeter, double area) {
    return perimeter * perimeter / (4.0 * pi * area);
}

struct FaceRange {
    std::uint32_t begin, end;
};

// Small clusters: about `size` faces with similar normals.

/// The largest increase of the error by a merge, relative to the area of the smaller cluster.
/// Clusters do not extend over creases: 1 permits angles up to 60 degrees between a large and a
/// small cluster, and up to 83 degrees between equal ones.
constexpr double max_small_loss = 1.0;

class SmallClusters {
  public:
    /// \param faces  the range of faces; clusters begin as one face each
    SmallClusters(const AtlasSurface& surface, FaceRange faces, double size) : size_(size) {
        clusters_.reserve(faces.end - faces.begin);
        for (std::uint32_t face = faces.begin; face < faces.end; ++face) {
            double perimeter = 0.0;
            for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner)
                perimeter += surface.edge_length(corner);
            clusters_.push_back({surface.areas[face] * surface.normal(face), surface.areas[face],
                                 surface.areas[face], perimeter, 1.0});
        }
    }

    [[nodiscard]] float cost(const ClusterEdge& edge) const {
        const Cluster& a = clusters_[edge.a];
        const Cluster& b = clusters_[edge.b];
        const double faces = a.faces + b.faces;
        if (faces > 2.0 * size_) return infinite;
        const double area = a.area + b.area;
        const double excess = a.length + b.length - length_of(a.normal + b.normal);
        if (2.0 * excess > max_small_loss * std::min(a.area, b.area)) return infinite;
        const double loss = 2.0 * excess / area;
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

/// The largest cost of a merge: it bounds the length of charts.
constexpr float max_chart_cost = 2.0F;

class ChartClusters {
  public:
    ChartClusters(std::size_t count, const ChartLimits& limits)
        : limits_(limits), clusters_(count) {}

    /// Begins with a small cluster. \param normal unit
    void set(std::uint32_t cluster, const glm::dvec3& normal, double curvature) {
        clusters_[cluster].cone.axis = normal;
        clusters_[cluster].curvature = curvature;
    }
    /// Adds a face to a small cluster.
    void add(std::uint32_t cluster, double area) {
        clusters_[cluster].normal += area * clusters_[cluster].cone.axis;
        clusters_[cluster].area += area;
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
        if (spread > limits_.spread || std::abs(a.curvature + b.curvature) > limits_.curvature)
            return infinite;
        // A closed surface cannot be flattened.
        if (a.border_count + b.border_count == 2 * edge.count) return infinite;
        if (united(a.cone, b.cone).half_angle > limits_.cone) return infinite;
        const double perimeter = std::max(a.perimeter + b.perimeter - 2.0 * edge.length, 0.0);
        const double shared = edge.length / std::max(std::min(a.perimeter, b.perimeter), 1e-300);
        const double shape = elongation(perimeter, area);
        const double cost = std::max(std::max(spread, 0.0) + 0.01 * shape - 0.02 * shared, 0.0);
        // A union that is closer to a disk than both parts may always form, however long it is.
        const bool is_rounder =
            shape < std::min(elongation(a.perimeter, a.area), elongation(b.perimeter, b.area));
        return std::min(static_cast<float>(cost), is_rounder ? max_chart_cost : infinite);
    }
    void merge(const ClusterEdge& edge) {
        Cluster& a = clusters_[edge.a];
        const Cluster& b = clusters_[edge.b];
        a.cone = united(a.cone, b.cone);
        a.normal += b.normal;
        a.area += b.area;
        a.curvature += b.curvature;
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
        double curvature = 0.0;
        std::uint32_t border_count = 0;
    };
    ChartLimits limits_;
    std::vector<Cluster> clusters_;
};

/// Merges first what costs little, in about 40 steps.
constexpr CostLimit chart_costs{0.005F, 1.15F, max_chart_cost};

/// The borders between faces of a range, which are numbered from 0.
std::vector<ClusterEdge> borders_between(const AtlasSurface& surface, FaceRange faces) {
    std::vector<ClusterEdge> edges;
    edges.reserve(3 * std::size_t{faces.end - faces.begin} / 2);
    for (Corner corner = 3 * faces.begin; corner < 3 * faces.end; ++corner) {
        check_cancelled(corner);
        const Corner other = surface.opposite[corner];
        if (other == no_corner || other < corner || surface.is_border[corner]) continue;
        if (other >= 3 * faces.end) continue;
        const auto [a, b] = std::minmax({corner / 3, other / 3});
        if (a != b)
            edges.push_back(
                {a - faces.begin, b - faces.begin, 1, -1.0F, surface.edge_length(corner)});
    }
    combine_edges(edges, faces.end - faces.begin);
    return edges;
}

/// The solid angle of the triangle between three directions, with its sign.
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return 2.0 * portable::atan2(glm::dot(a, glm::cross(b, c)),
                                 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

/// Fills the curvatures of small clusters: that of a vertex is the solid angle between the normals
/// around it, and each of its clusters has an equal share. Noise hardly counts, because it has
/// little effect on mean normals.
void fill_curvatures(const AtlasSurface& surface, Segmentation& segmentation) {
    segmentation.curvatures.assign(segmentation.normals.size(), 0.0);
    std::vector<bool> is_done(surface.positions.size(), false);
    std::vector<std::uint32_t> around;
    for (Corner first = 0; first < surface.opposite.size(); ++first) {
        check_cancelled(first);
        const std::uint32_t vertex =
            surface.faces[first / 3][static_cast<glm::length_t>(first % 3)];
        if (is_done[vertex]) continue;
        is_done[vertex] = true;
        around.clear();
        Corner at = first;
        do {
            const std::uint32_t cluster = segmentation.cluster[at / 3];
            if (around.empty() || around.back() != cluster) around.push_back(cluster);
            at = surface.opposite[previous_in_triangle(at)];
        } while (at != no_corner && at != first);
        if (at == no_corner) continue;
        if (around.size() > 1 && around.back() == around.front()) around.pop_back();
        if (around.size() < 3) continue;
        const auto normal = [&](std::size_t i) {
            return glm::dvec3(segmentation.normals[around[i]]);
        };
        double sum = 0.0;
        for (std::size_t i = 2; i < around.size(); ++i)
            sum += solid_angle(normal(0), normal(i - 1), normal(i));
        for (const std::uint32_t cluster : around)
            segmentation.curvatures[cluster] += sum / static_cast<double>(around.size());
    }
}

std::size_t count_of(std::span<const std::uint32_t> labels) {
    return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + std::size_t{1};
}

/// The number of faces of a small cluster.
double cluster_size(std::size_t face_count) {
    return std::clamp(static_cast<double>(face_count) / 3000.0, 1.0, 32.0);
}

/// Small clusters are found in blocks of faces, which the cache holds. Faces are in spatial order.
constexpr std::uint32_t block_faces = 65536;

/// Fills the small clusters and their normals.
void fill_clusters(const AtlasSurface& surface, Segmentation& segmentation) {
    const auto face_count = static_cast<std::uint32_t>(surface.faces.size());
    const double size = cluster_size(face_count);
    const std::uint32_t block_count = (face_count + block_faces - 1) / block_faces;
    segmentation.cluster.resize(face_count);
    std::vector<std::vector<glm::vec3>> normals(block_count);
    const auto range_of = [&](std::size_t block) {
        const auto first = static_cast<std::uint32_t>(block) * block_faces;
        return FaceRange{first, std::min(first + block_faces, face_count)};
    };
    parallel_for(block_count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            const FaceRange faces = range_of(block);
            std::vector<ClusterEdge> edges = borders_between(surface, faces);
            SmallClusters small(surface, faces, size);
            const std::vector<std::uint32_t> cluster =
                merge_in_rounds(small, faces.end - faces.begin, edges, CostLimit{});
            normals[block].resize(count_of(cluster));
            for (std::uint32_t i = 0; i < cluster.size(); ++i) {
                const glm::dvec3 sum = small.normal(cluster[i]);
                const double length = length_of(sum);
                segmentation.cluster[faces.begin + i] = cluster[i];
                normals[block][cluster[i]] =
                    glm::vec3(length > 0.0 ? sum / length : surface.normal(faces.begin + i));
            }
        }
    });
    for (std::size_t block = 0; block < block_count; ++block) {
        const auto first = static_cast<std::uint32_t>(segmentation.normals.size());
        const FaceRange faces = range_of(block);
        for (std::uint32_t face = faces.begin; face < faces.end; ++face)
            segmentation.cluster[face] += first;
        segmentation.normals.insert(segmentation.normals.end(), normals[block].begin(),
                                    normals[block].end());
    }
}

}  // namespace

std::vector<std::uint32_t> divided_part(const AtlasSurface& surface,
                                        const Segmentation& segmentation,
                                        std::span<const std::uint32_t> faces,
                                        const ChartLimits& limits) {
    // Small clusters of these faces, numbered in the order of their first faces.
    std::vector<std::uint32_t> used;
    std::vector<std::uint32_t> number(segmentation.normals.size(), no_face);
    for (const std::uint32_t face : faces) {
        const std::uint32_t cluster = segmentation.cluster[face];
        if (number[cluster] != no_face) continue;
        number[cluster] = static_cast<std::uint32_t>(used.size());
        used.push_back(cluster);
    }
    const auto number_of = [&](std::uint32_t face) { return number[segmentation.cluster[face]]; };
    ChartClusters charts(used.size(), limits);
    for (std::uint32_t i = 0; i < used.size(); ++i)
        charts.set(i, glm::dvec3(segmentation.normals[used[i]]), segmentation.curvatures[used[i]]);
    std::vector<std::uint32_t> cluster(faces.size());
    std::vector<ClusterEdge> edges;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        check_cancelled(i);
        const std::uint32_t face = faces[i];
        const std::uint32_t own = cluster[i] = number_of(face);
        charts.add(own, surface.areas[face]);
        for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner) {
            const Corner other = surface.opposite[corner];
            const bool is_inside =
                other != no_corner && segmentation.chart[other / 3] == segmentation.chart[face];
            const std::uint32_t across = is_inside ? number_of(other / 3) : own;
            if (is_inside && across == own) continue;
            charts.add_border(own, surface.edge_length(corner));
            if (!is_inside || other < corner || surface.is_border[corner]) continue;
            const auto [a, b] = std::minmax({own, across});
            edges.push_back({a, b, 1, -1.0F, surface.edge_length(corner)});
        }
    }
    combine_edges(edges, used.size());
    const std::vector<std::uint32_t> part =
        merge_in_rounds(charts, used.size(), edges, chart_costs);
    for (std::uint32_t& each : cluster)
        each = part[each];
    return cluster;
}

Segmentation divided(const AtlasSurface& surface, const ChartLimits& limits) {
    const auto face_count = static_cast<std::uint32_t>(surface.faces.size());
    Segmentation result;
    fill_clusters(surface, result);
    fill_curvatures(surface, result);
    result.chart.assign(face_count, 0);
    std::vector<std::uint32_t> all(face_count);
    std::iota(all.begin(), all.end(), 0U);
    result.chart = divided_part(surface, result, all, limits);
    result.count = count_of(result.chart);
    return result;
}

}  // namespace relief::detail
