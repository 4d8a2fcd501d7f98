// SPDX-License-Identifier: Apache-2.0
#include "atlas/flatten.h"

// Without vector instructions of its own, so that results do not depend on the instruction set.
#define EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_PARALLELIZE
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/direction.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

constexpr int iterations = 8;
constexpr double min_weight = 0.02;
constexpr double max_weight = 20.0;

/// The corners of a triangle in its own plane: the first one at the origin, the second one on the
/// x axis.
struct FlatTriangle {
    double x1, x2, y2;

    [[nodiscard]] std::array<glm::dvec2, 3> corners() const {
        return {glm::dvec2(0.0), glm::dvec2(x1, 0.0), glm::dvec2(x2, y2)};
    }
};

FlatTriangle flat(const AtlasSurface& surface, std::uint32_t face) {
    const glm::dvec3 a = surface.position(3 * face);
    const glm::dvec3 e1 = surface.position(3 * face + 1) - a;
    const glm::dvec3 e2 = surface.position(3 * face + 2) - a;
    const double length = std::sqrt(glm::dot(e1, e1));
    return {length, glm::dot(e1, e2) / length, 2.0 * surface.areas[face] / length};
}

/// Returns, for each edge of a triangle, the cotangent of the angle that it faces, within limits.
std::array<double, 3> weights_of(const FlatTriangle& triangle) {
    const std::array<glm::dvec2, 3> p = triangle.corners();
    const double twice_area = triangle.x1 * triangle.y2;
    std::array<double, 3> weights{};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2& apex = p[(i + 2) % 3];
        const double cotangent = glm::dot(p[i] - apex, p[(i + 1) % 3] - apex) / twice_area;
        weights[i] = std::clamp(cotangent, min_weight, max_weight);
    }
    return weights;
}

/// The two axes of a plane, counter-clockwise seen against the normal.
std::array<glm::dvec3, 2> axes_of(const glm::dvec3& normal) {
    const glm::dvec3 x =
        direction_or_zero(in_plane(glm::dvec3(perpendicular_to(glm::vec3(normal))), normal));
    return {x, glm::cross(normal, x)};
}

/// Solves L D L^T x = b for both coordinates. \param lower L below its diagonal of ones
void solve(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& diagonal,
           std::span<glm::dvec2> x) {
    using Entry = Eigen::SparseMatrix<double>::InnerIterator;
    const Eigen::Index count = lower.cols();
    for (Eigen::Index column = 0; column < count; ++column) {
        const glm::dvec2 value = x[static_cast<std::size_t>(column)];
        for (Entry entry(lower, column); entry; ++entry)
            x[static_cast<std::size_t>(entry.row())] -= entry.value() * value;
    }
    for (Eigen::Index column = count - 1; column >= 0; --column) {
        glm::dvec2 value = x[static_cast<std::size_t>(column)] / diagonal(column);
        for (Entry entry(lower, column); entry; ++entry)
            value -= entry.value() * x[static_cast<std::size_t>(entry.row())];
        x[static_cast<std::size_t>(column)] = value;
    }
}

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

std::vector<glm::dvec2> projected(const AtlasSurface& surface, const ChartMesh& chart) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t face : chart.faces)
        sum += surface.areas[face] * surface.normals[face];
    const glm::dvec3 normal = direction_or_zero(sum);
    const auto axes = axes_of(normal == glm::dvec3(0.0) ? surface.normals[chart.faces[0]] : normal);
    std::vector<glm::dvec2> result(chart.positions.size());
    for (std::size_t v = 0; v < result.size(); ++v) {
        const glm::dvec3& position = surface.positions[chart.positions[v]];
        result[v] = {glm::dot(axes[0], position), glm::dot(axes[1], position)};
    }
    return result;
}

std::vector<glm::dvec2> flattened(const AtlasSurface& surface, const ChartMesh& chart,
                                  std::vector<glm::dvec2> start) {
    using Matrix = Eigen::SparseMatrix<double>;
    const std::size_t face_count = chart.faces.size();
    const auto vertex_count = static_cast<Eigen::Index>(chart.positions.size());
    std::vector<FlatTriangle> triangles(face_count);
    std::vector<std::array<double, 3>> weights(face_count);
    std::vector<double> diagonal(chart.positions.size(), 0.0);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(3 * face_count + chart.positions.size());
    for (std::size_t i = 0; i < face_count; ++i) {
        triangles[i] = flat(surface, chart.faces[i]);
        weights[i] = weights_of(triangles[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = chart.vertices[i][static_cast<glm::length_t>(k)];
            const std::uint32_t b = chart.vertices[i][static_cast<glm::length_t>((k + 1) % 3)];
            entries.emplace_back(static_cast<int>(std::max(a, b)), static_cast<int>(std::min(a, b)),
                                 -weights[i][k]);
            diagonal[a] += weights[i][k];
            diagonal[b] += weights[i][k];
        }
    }
    diagonal[0] += 1.0;  // Attracts one vertex to the origin, which fixes the translation.
    for (int v = 0; v < vertex_count; ++v)
        entries.emplace_back(v, v, diagonal[static_cast<std::size_t>(v)]);
    Matrix matrix(vertex_count, vertex_count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    entries = {};
    check_cancelled();
    const Eigen::SimplicialLDLT<Matrix> solver(matrix);
    if (solver.info() != Eigen::Success) return start;
    const Matrix& factor = solver.matrixL().nestedExpression();
    const auto& order = solver.permutationP().indices();
    const Eigen::VectorXd diagonal_factor = solver.vectorD();
    std::vector<glm::dvec2> right(chart.positions.size());
    std::vector<glm::dvec2> permuted(chart.positions.size());
    std::vector<glm::dvec2> result = std::move(start);
    for (int round = 0; round < iterations; ++round) {
        check_cancelled();
        std::fill(right.begin(), right.end(), glm::dvec2(0.0));
        for (std::size_t i = 0; i < face_count; ++i) {
            const std::array<glm::dvec2, 3> x = triangles[i].corners();
            double cosine = 0.0;
            double sine = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& v = chart.vertices[i];
                const glm::dvec2 u = result[v[static_cast<glm::length_t>(k)]] -
                                     result[v[static_cast<glm::length_t>((k + 1) % 3)]];
                const glm::dvec2 e = x[k] - x[(k + 1) % 3];
                cosine += weights[i][k] * (u.x * e.x + u.y * e.y);
                sine += weights[i][k] * (u.y * e.x - u.x * e.y);
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
                const auto& v = chart.vertices[i];
                const glm::dvec2 e = weights[i][k] * (x[k] - x[(k + 1) % 3]);
                const glm::dvec2 turned(cosine * e.x - sine * e.y, sine * e.x + cosine * e.y);
                right[v[static_cast<glm::length_t>(k)]] += turned;
                right[v[static_cast<glm::length_t>((k + 1) % 3)]] -= turned;
            }
        }
        // Both coordinates at once: reading the factor costs most.
        for (Eigen::Index v = 0; v < vertex_count; ++v)
            permuted[static_cast<std::size_t>(order(v))] = right[static_cast<std::size_t>(v)];
        solve(factor, diagonal_factor, permuted);
        for (Eigen::Index v = 0; v < vertex_count; ++v)
            result[static_cast<std::size_t>(v)] = permuted[static_cast<std::size_t>(order(v))];
    }
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
