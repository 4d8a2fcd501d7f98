// SPDX-License-Identifier: Apache-2.0
#include "atlas/flatten.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "atlas/sparse_factor.h"
#include "geometry/direction.h"
#include "portable_math.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The number of iterations. Angles gain by more of them, lengths do not.
constexpr int rigid_iterations = 8;
constexpr int conformal_iterations = 16;
constexpr double min_weight = 0.02;
constexpr double max_weight = 20.0;
/// The largest logarithm of the scale of a conformal map; the stretch limit is far below it.
constexpr double max_log_scale = 20.0;

/// The corners of a triangle in its own plane: the first one at the origin, the second one on the
/// x axis.
struct FlatTriangle {
    double x1, x2, y2;

    [[nodiscard]] std::array<glm::dvec2, 3> corners() const {
        return {glm::dvec2(0.0), glm::dvec2(x1, 0.0), glm::dvec2(x2, y2)};
    }
    [[nodiscard]] FlatTriangle scaled(double factor) const {
        return {factor * x1, factor * x2, factor * y2};
    }
};

FlatTriangle flat(const AtlasSurface& surface, std::uint32_t face) {
    const glm::dvec3 a = surface.position(3 * face);
    const glm::dvec3 e1 = surface.position(3 * face + 1) - a;
    const glm::dvec3 e2 = surface.position(3 * face + 2) - a;
    const double length = std::sqrt(glm::dot(e1, e1));
    return {length, glm::dot(e1, e2) / length, 2.0 * surface.areas[face] / length};
}

using Cotangents = std::array<double, 3>;

/// Returns, for each edge of a triangle, the cotangent of the angle that it faces.
Cotangents cotangents_of(const FlatTriangle& triangle) {
    const std::array<glm::dvec2, 3> p = triangle.corners();
    const double twice_area = triangle.x1 * triangle.y2;
    Cotangents cotangents{};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2& apex = p[(i + 2) % 3];
        cotangents[i] = glm::dot(p[i] - apex, p[(i + 1) % 3] - apex) / twice_area;
    }
    return cotangents;
}

/// Positive weights: they stay within limits.
Cotangents limited(Cotangents cotangents) {
    for (double& each : cotangents)
        each = std::clamp(each, min_weight, max_weight);
    return cotangents;
}

/// The two axes of a plane, counter-clockwise seen against the normal.
std::array<glm::dvec3, 2> axes_of(const glm::dvec3& normal) {
    const glm::dvec3 x =
        direction_or_zero(in_plane(glm::dvec3(perpendicular_to(glm::vec3(normal))), normal));
    return {x, glm::cross(normal, x)};
}

/// Builds the matrix of sum w (x_a - x_b)^2 over the edges of triangles.
class EdgeMatrix {
  public:
    EdgeMatrix(std::size_t size, std::size_t edges) : diagonal_(size, 0.0) {
        entries_.reserve(edges);
    }
    void add_edge(std::uint32_t a, std::uint32_t b, double weight) {
        entries_.push_back({a, b, -weight});
        add(a, weight);
        add(b, weight);
    }
    void add(std::uint32_t i, double weight) { diagonal_[i] += weight; }

    /// \param positions  of the unknowns
    [[nodiscard]] SparseFactor factored(std::span<const glm::dvec3> positions) const {
        return {diagonal_, entries_, positions};
    }

  private:
    std::vector<SparseFactor::Entry> entries_;
    std::vector<double> diagonal_;
};

// The scale of a conformal map.

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t fixed = std::numeric_limits<std::uint32_t>::max();

/// The unknowns of the scale: one for each inner vertex, and one for all vertices of a border loop,
/// except for the longest loop, where the scale is fixed.
struct ScaleUnknowns {
    std::vector<std::uint32_t> of_vertex;  ///< Or `fixed`.
    /// The curvature of each unknown, if all angles at its vertices were 0.
    std::vector<double> full_curvature;
    std::vector<bool> is_border;  ///< Of each vertex.
};

ScaleUnknowns scale_unknowns(const AtlasSurface& surface, const ChartMesh& chart) {
    struct Loop {
        std::vector<std::uint32_t> vertices;
        double length = 0.0;
    };
    // Each vertex begins one edge of the border at most.
    std::vector<Corner> border_edge(chart.positions.size(), no_corner);
    const auto vertex_at = [&](Corner corner) {
        return chart.vertices[corner / 3][static_cast<glm::length_t>(corner % 3)];
    };
    for (Corner corner = 0; corner < chart.opposite.size(); ++corner)
        if (chart.opposite[corner] == no_corner) border_edge[vertex_at(corner)] = corner;
    ScaleUnknowns unknowns;
    unknowns.is_border.assign(chart.positions.size(), false);
    std::vector<Loop> loops;
    for (std::uint32_t first = 0; first < border_edge.size(); ++first) {
        if (border_edge[first] == no_corner || unknowns.is_border[first]) continue;
        Loop& loop = loops.emplace_back();
        for (std::uint32_t v = first; !unknowns.is_border[v];) {
            unknowns.is_border[v] = true;
            loop.vertices.push_back(v);
            const Corner edge = border_edge[v];
            loop.length += surface.edge_length(3 * chart.faces[edge / 3] + edge % 3);
            v = vertex_at(next_in_triangle(edge));
        }
    }
    unknowns.of_vertex.assign(chart.positions.size(), fixed);
    for (std::size_t v = 0; v < chart.positions.size(); ++v) {
        if (unknowns.is_border[v]) continue;
        unknowns.of_vertex[v] = static_cast<std::uint32_t>(unknowns.full_curvature.size());
        unknowns.full_curvature.push_back(2.0 * pi);
    }
    const auto longest =
        std::max_element(loops.begin(), loops.end(),
                         [](const Loop& a, const Loop& b) { return a.length < b.length; });
    for (auto loop = loops.begin(); loop != loops.end(); ++loop) {
        if (loop == longest) continue;
        for (const std::uint32_t v : loop->vertices)
            unknowns.of_vertex[v] = static_cast<std::uint32_t>(unknowns.full_curvature.size());
        // As if a plane polygon closed the hole.
        unknowns.full_curvature.push_back((2.0 + static_cast<double>(loop->vertices.size())) * pi);
    }
    return unknowns;
}

/// Returns the factor by which a conformal map scales each triangle: the one that is 1 at the
/// longest border loop and constant at all others, which changes areas least.
///
/// \return none if rounding makes it infinite
std::optional<std::vector<double>> conformal_scales(const AtlasSurface& surface,
                                                    const ChartMesh& chart,
                                                    std::span<const FlatTriangle> triangles) {
    const ScaleUnknowns unknowns = scale_unknowns(surface, chart);
    const std::size_t count = unknowns.full_curvature.size();
    std::vector<double> scales(triangles.size(), 1.0);
    if (count == 0 || std::find(unknowns.is_border.begin(), unknowns.is_border.end(), true) ==
                          unknowns.is_border.end())
        return scales;
    // L u = -K: u is the logarithm of the scale, K the integral of curvature [Sawhney and Crane
    // 2017, equation 4].
    EdgeMatrix matrix(count, 3 * triangles.size());
    std::vector<glm::dvec2> logarithm(count, glm::dvec2(0.0));
    for (std::size_t i = 0; i < count; ++i)
        logarithm[i].x = -unknowns.full_curvature[i];
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::uvec3& v = chart.vertices[i];
        const Cotangents cotangents = cotangents_of(triangles[i]);
        // Needles would dominate the matrix.
        const bool is_needle = std::any_of(cotangents.begin(), cotangents.end(),
                                           [](double each) { return std::abs(each) > max_weight; });
        const Cotangents weights = is_needle ? limited(cotangents) : cotangents;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto unknown = [&](std::size_t corner) {
                return unknowns.of_vertex[v[static_cast<glm::length_t>(corner % 3)]];
            };
            const std::uint32_t a = unknown(k);
            const std::uint32_t b = unknown(k + 1);
            if (a != b && a != fixed && b != fixed)
                matrix.add_edge(a, b, 0.5 * weights[k]);
            else if (a != b)
                matrix.add(std::min(a, b), 0.5 * weights[k]);
            // The angle at the corner that the edge faces.
            const std::uint32_t apex = unknown(k + 2);
            if (apex != fixed) logarithm[apex].x += portable::atan2(1.0, cotangents[k]);
        }
    }
    // The unknown of a hole is at one of its vertices.
    std::vector<glm::dvec3> positions(count);
    for (std::size_t v = 0; v < chart.positions.size(); ++v)
        if (unknowns.of_vertex[v] != fixed)
            positions[unknowns.of_vertex[v]] = surface.positions[chart.positions[v]];
    SparseFactor factored = matrix.factored(positions);
    if (!factored.is_valid()) return std::nullopt;
    factored.solve(logarithm);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto of = [&](std::uint32_t vertex) {
            const std::uint32_t unknown = unknowns.of_vertex[vertex];
            return unknown == fixed ? 0.0 : logarithm[unknown].x;
        };
        const glm::uvec3& v = chart.vertices[i];
        const double mean = (of(v.x) + of(v.y) + of(v.z)) / 3.0;
        if (!(std::abs(mean) < max_log_scale)) return std::nullopt;
        scales[i] = portable::exp(mean);
    }
    return scales;
}

/// Scales coordinates, so that the chart has the area of its faces.
void restore_area(const AtlasSurface& surface, const ChartMesh& chart,
                  std::span<glm::dvec2> coordinates) {
    double wanted = 0.0;
    double area = 0.0;
    for (std::size_t i = 0; i < chart.faces.size(); ++i) {
        const glm::uvec3& v = chart.vertices[i];
        const glm::dvec2 first = coordinates[v.y] - coordinates[v.x];
        const glm::dvec2 second = coordinates[v.z] - coordinates[v.x];
        wanted += surface.areas[chart.faces[i]];
        area += 0.5 * (first.x * second.y - first.y * second.x);
    }
    if (!(area > 0.0)) return;  // Triangles are inverted, which the tests of charts find.
    const double scale = std::sqrt(wanted / area);
    for (glm::dvec2& each : coordinates)
        each *= scale;
}

// As rigid as possible.

/// The triangles of a chart, which keep their shape and size as far as possible.
class RigidTriangles {
  public:
    RigidTriangles(const ChartMesh& chart, std::vector<FlatTriangle> triangles)
        : chart_(chart), weights_(triangles.size()), edges_(triangles.size()) {
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            weights_[i] = limited(cotangents_of(triangles[i]));
            const std::array<glm::dvec2, 3> x = triangles[i].corners();
            for (std::size_t k = 0; k < 3; ++k)
                edges_[i][k] = weights_[i][k] * (x[k] - x[(k + 1) % 3]);
        }
    }

    /// \param positions  of the vertices
    [[nodiscard]] SparseFactor factored(std::span<const glm::dvec3> positions) const {
        EdgeMatrix matrix(chart_.positions.size(), 2 * weights_.size());
        for (std::uint32_t i = 0; i < weights_.size(); ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const Corner other = chart_.opposite[3 * i + k];
                if (other == no_corner)
                    matrix.add_edge(vertex(i, k), vertex(i, k + 1), weights_[i][k]);
                else if (3 * i + k < other)
                    matrix.add_edge(vertex(i, k), vertex(i, k + 1),
                                    weights_[i][k] + weights_[other / 3][other % 3]);
            }
        }
        matrix.add(0, 1.0);  // Attracts one vertex to the origin, which fixes the translation.
        return matrix.factored(positions);
    }

    /// Rotates a triangle to its present coordinates, and calls visit(a, b, weight, edge) for its
    /// edges: `edge` is where a should be, seen from b.
    template <typename Visit>
    void fit(std::size_t i, std::span<const glm::dvec2> coordinates, const Visit& visit) const {
        double cosine = 0.0;
        double sine = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2 u = coordinates[vertex(i, k)] - coordinates[vertex(i, k + 1)];
            const glm::dvec2& e = edges_[i][k];
            cosine += u.x * e.x + u.y * e.y;
            sine += u.y * e.x - u.x * e.y;
        }
        const double length = std::sqrt(cosine * cosine + sine * sine);
        if (!(length > 0.0)) {
            cosine = 1.0;
            sine = 0.0;
        } else {
            cosine /= length;
            sine /= length;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2& e = edges_[i][k];
            visit(vertex(i, k), vertex(i, k + 1), weights_[i][k],
                  glm::dvec2(cosine * e.x - sine * e.y, sine * e.x + cosine * e.y));
        }
    }
    [[nodiscard]] std::uint32_t vertex(std::size_t triangle, std::size_t corner) const {
        return chart_.vertices[triangle][static_cast<glm::length_t>(corner % 3)];
    }
    [[nodiscard]] std::size_t count() const { return weights_.size(); }

  private:
    const ChartMesh& chart_;
    std::vector<Cotangents> weights_;               ///< Of the edges.
    std::vector<std::array<glm::dvec2, 3>> edges_;  ///< With these weights, at rest.
};

/// Moves the vertices near triangles that exceed the stretch limit, which gain weight until they
/// are within it.
class StretchRepair {
  public:
    StretchRepair(const AtlasSurface& surface, const ChartMesh& chart,
                  const RigidTriangles& triangles, double max_stretch, double min_area)
        : surface_(surface),
          chart_(chart),
          triangles_(triangles),
          max_stretch_(max_stretch),
          min_area_(min_area) {}

    /// Each sweep moves vertices to the mean of the places where their triangles fit best. Without
    /// success, nothing changes.
    void repair(std::vector<glm::dvec2>& coordinates) {
        std::vector<std::size_t> bad;
        for (std::size_t i = 0; i < triangles_.count(); ++i)
            if (exceeds(i, coordinates, max_stretch_)) bad.push_back(i);
        if (bad.empty() || bad.size() > max_repaired + triangles_.count() / faces_per_repaired)
            return;
        find_region(bad);
        std::vector<glm::dvec2> before;
        for (const std::uint32_t v : free_)
            before.push_back(coordinates[v]);
        std::vector<double> factor(region_.size(), 1.0);
        std::vector<glm::dvec2> sum(coordinates.size());
        std::vector<double> weight(coordinates.size());
        for (int sweep = 0; sweep < repair_sweeps; ++sweep) {
            bool is_within = true;
            for (std::size_t r = 0; r < region_.size(); ++r) {
                if (!exceeds(region_[r], coordinates, repaired_share * max_stretch_)) continue;
                factor[r] *= repair_factor;
                is_within = false;
            }
            if (is_within) return;
            for (const std::uint32_t v : free_) {
                sum[v] = glm::dvec2(0.0);
                weight[v] = 0.0;
            }
            for (std::size_t r = 0; r < region_.size(); ++r) {
                triangles_.fit(region_[r], coordinates,
                               [&](std::uint32_t a, std::uint32_t b, double w, glm::dvec2 edge) {
                                   sum[a] += factor[r] * (w * coordinates[b] + edge);
                                   sum[b] += factor[r] * (w * coordinates[a] - edge);
                                   weight[a] += factor[r] * w;
                                   weight[b] += factor[r] * w;
                               });
            }
            for (const std::uint32_t v : free_)
                coordinates[v] = sum[v] / weight[v];
        }
        for (std::size_t i = 0; i < free_.size(); ++i)
            coordinates[free_[i]] = before[i];
    }

  private:
    /// So many triangles are repaired, and one of this number.
    static constexpr std::size_t max_repaired = 3;
    static constexpr std::size_t faces_per_repaired = 1000;
    static constexpr int repair_sweeps = 60;
    /// The growth of the weight in each sweep above this share of the limit.
    static constexpr double repair_factor = 1.3;
    static constexpr double repaired_share = 0.97;
    /// Vertices that move: so many rings around the triangles.
    static constexpr int free_rings = 2;

    [[nodiscard]] bool exceeds(std::size_t i, std::span<const glm::dvec2> coordinates,
                               double limit) const {
        const std::uint32_t face = chart_.faces[i];
        const Stretch stretch =
            stretch_of(surface_, face,
                       {coordinates[triangles_.vertex(i, 0)], coordinates[triangles_.vertex(i, 1)],
                        coordinates[triangles_.vertex(i, 2)]});
        if (!(stretch.smallest > 0.0)) return true;
        const double area = stretch.largest * stretch.smallest;
        return surface_.areas[face] >= min_area_ &&
               std::max({stretch.largest / stretch.smallest, area, 1.0 / area}) > limit;
    }

    /// Frees the vertices near some triangles; the region is the triangles that have any of them.
    void find_region(std::span<const std::size_t> bad) {
        is_free_.assign(chart_.positions.size(), false);
        for (const std::size_t i : bad)
            for (std::size_t k = 0; k < 3; ++k)
                is_free_[triangles_.vertex(i, k)] = true;
        const auto touches = [&](std::size_t i) {
            return is_free_[triangles_.vertex(i, 0)] || is_free_[triangles_.vertex(i, 1)] ||
                   is_free_[triangles_.vertex(i, 2)];
        };
        for (int ring = 0; ring < free_rings; ++ring) {
            std::vector<std::size_t> touched;
            for (std::size_t i = 0; i < triangles_.count(); ++i)
                if (touches(i)) touched.push_back(i);
            for (const std::size_t i : touched)
                for (std::size_t k = 0; k < 3; ++k)
                    is_free_[triangles_.vertex(i, k)] = true;
        }
        for (std::size_t i = 0; i < triangles_.count(); ++i)
            if (touches(i)) region_.push_back(i);
        for (std::uint32_t v = 0; v < is_free_.size(); ++v)
            if (is_free_[v]) free_.push_back(v);
    }

    const AtlasSurface& surface_;
    const ChartMesh& chart_;
    const RigidTriangles& triangles_;
    double max_stretch_;
    double min_area_;
    std::vector<bool> is_free_;        ///< Of each vertex.
    std::vector<std::uint32_t> free_;  ///< Ascending.
    std::vector<std::size_t> region_;  ///< Triangles with free vertices, ascending.
};

}  // namespace

ChartMesh chart_mesh(const AtlasSurface& surface, const ChartMembers& members,
                     std::vector<std::uint32_t> faces) {
    ChartMesh chart;
    chart.faces = std::move(faces);
    const std::size_t edge_count = 3 * chart.faces.size();
    chart.opposite.assign(edge_count, no_corner);
    for (std::uint32_t i = 0; i < chart.faces.size(); ++i) {
        const std::uint32_t face = chart.faces[i];
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Corner other = surface.opposite[3 * face + k];
            if (other != no_corner && members.are_together(face, other / 3))
                chart.opposite[3 * i + k] = 3 * members.index(other / 3) + other % 3;
        }
    }
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> vertex(edge_count, none);
    chart.positions.reserve(std::min(edge_count, chart.faces.size() / 2 + 16));
    for (Corner corner = 0; corner < edge_count; ++corner) {
        if (vertex[corner] != none) continue;
        const auto number = static_cast<std::uint32_t>(chart.positions.size());
        chart.positions.push_back(
            surface.faces[chart.faces[corner / 3]][static_cast<glm::length_t>(corner % 3)]);
        // Around the vertex in both directions.
        Corner at = corner;
        do {
            vertex[at] = number;
            at = chart.opposite[previous_in_triangle(at)];
        } while (at != no_corner && at != corner);
        if (at == corner) continue;
        for (at = chart.opposite[corner]; at != no_corner; at = chart.opposite[at]) {
            at = next_in_triangle(at);
            vertex[at] = number;
        }
    }
    chart.vertices.resize(chart.faces.size());
    for (std::size_t i = 0; i < chart.faces.size(); ++i)
        chart.vertices[i] = {vertex[3 * i], vertex[3 * i + 1], vertex[3 * i + 2]};
    return chart;
}

std::vector<glm::dvec2> unfolded(const AtlasSurface& surface, const ChartMesh& chart) {
    std::uint32_t edge = 0;
    while (chart.opposite[edge] == no_corner)
        ++edge;
    std::vector<glm::dvec2> result(4);
    const auto place = [&](std::uint32_t corner, const glm::dvec2& point) {
        result[chart.vertices[corner / 3][static_cast<glm::length_t>(corner % 3)]] = point;
    };
    // Each triangle with its third corner, seen from the common edge on the x axis.
    const auto third = [&](std::uint32_t corner) {
        const Corner first = 3 * chart.faces[corner / 3] + corner % 3;
        const glm::dvec3 from = surface.position(first);
        const glm::dvec3 along = surface.position(next_in_triangle(first)) - from;
        const glm::dvec3 side = surface.position(previous_in_triangle(first)) - from;
        const double length = std::sqrt(glm::dot(along, along));
        return glm::dvec2(glm::dot(along, side), 2.0 * surface.areas[chart.faces[corner / 3]]) /
               length;
    };
    const double length = surface.edge_length(3 * chart.faces[edge / 3] + edge % 3);
    place(edge, {0.0, 0.0});
    place(next_in_triangle(edge), {length, 0.0});
    place(previous_in_triangle(edge), third(edge));
    const std::uint32_t other = chart.opposite[edge];
    place(previous_in_triangle(other), glm::dvec2(length, 0.0) - third(other));
    return result;
}

std::vector<glm::dvec2> projected(const AtlasSurface& surface, const ChartMesh& chart) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t face : chart.faces)
        sum += surface.areas[face] * surface.normal(face);
    const glm::dvec3 normal = direction_or_zero(sum);
    const auto axes = axes_of(normal == glm::dvec3(0.0) ? surface.normal(chart.faces[0]) : normal);
    std::vector<glm::dvec2> result(chart.positions.size());
    for (std::size_t v = 0; v < result.size(); ++v) {
        const glm::dvec3& position = surface.positions[chart.positions[v]];
        result[v] = {glm::dot(axes[0], position), glm::dot(axes[1], position)};
    }
    return result;
}

std::vector<glm::dvec2> flattened(const AtlasSurface& surface, const ChartMesh& chart,
                                  std::vector<glm::dvec2> start, const FlatteningTask& task) {
    const std::size_t face_count = chart.faces.size();
    std::vector<FlatTriangle> shapes(face_count);
    for (std::size_t i = 0; i < face_count; ++i)
        shapes[i] = flat(surface, chart.faces[i]);
    if (task.method == Flattening::conformal) {
        const auto scales = conformal_scales(surface, chart, shapes);
        if (!scales) return std::vector<glm::dvec2>(start.size(), glm::dvec2(0.0));
        for (std::size_t i = 0; i < face_count; ++i)
            shapes[i] = shapes[i].scaled((*scales)[i]);
    }
    const RigidTriangles triangles(chart, std::move(shapes));
    std::vector<glm::dvec3> positions(chart.positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v)
        positions[v] = surface.positions[chart.positions[v]];
    SparseFactor factored = triangles.factored(positions);
    if (!factored.is_valid()) return start;
    std::vector<glm::dvec2> right(chart.positions.size());
    std::vector<glm::dvec2> result = std::move(start);
    const int iterations =
        task.method == Flattening::conformal ? conformal_iterations : rigid_iterations;
    for (int round = 0; round < iterations; ++round) {
        check_cancelled();
        std::fill(right.begin(), right.end(), glm::dvec2(0.0));
        for (std::size_t i = 0; i < face_count; ++i)
            triangles.fit(i, result,
                          [&](std::uint32_t a, std::uint32_t b, double, const glm::dvec2& edge) {
                              right[a] += edge;
                              right[b] -= edge;
                          });
        factored.solve(right);
        result.swap(right);
    }
    if (task.method == Flattening::conformal) restore_area(surface, chart, result);
    StretchRepair(surface, chart, triangles, task.max_stretch, task.min_area).repair(result);
    return result;
}

Stretch stretch_of(const AtlasSurface& surface, std::uint32_t face,
                   const std::array<glm::dvec2, 3>& coordinates) {
    const FlatTriangle triangle = flat(surface, face);
    // The columns of the map: the images of the unit vectors.
    const glm::dvec2 x = (coordinates[1] - coordinates[0]) / triangle.x1;
    const glm::dvec2 y = (coordinates[2] - coordinates[0] - x * triangle.x2) / triangle.y2;
    // Singular values by the parts that keep and that reverse the orientation.
    const double keeps = std::sqrt((x.x + y.y) * (x.x + y.y) + (x.y - y.x) * (x.y - y.x));
    const double reverses = std::sqrt((x.x - y.y) * (x.x - y.y) + (x.y + y.x) * (x.y + y.x));
    return {0.5 * (keeps + reverses), 0.5 * (keeps - reverses)};
}

}  // namespace relief::detail
