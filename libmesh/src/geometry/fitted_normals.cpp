// SPDX-License-Identifier: Apache-2.0
// Fits heights over the tangent plane by weighted least squares, rotates the plane to the fitted
// normal, and fits again. Object space, lengths in units of the neighborhood. Source: [Cazals and
// Pouget 2005]; unlike there, the polynomial passes through the vertex itself, and near vertices
// have larger weights. Tests: tests/mesh/geometry/fitted_normals_test.cpp.
#include "relief/mesh/fitted_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/corners.h"
#include "geometry/normal_sums.h"
#include "geometry/smooth_fans.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "relief/mesh/statistics.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr int fine_degree = 4;
constexpr int crude_degree = 3;
/// Returns the number of terms x^i y^j of a polynomial through the origin.
constexpr std::size_t terms_of(int degree) {
    return static_cast<std::size_t>((degree + 1) * (degree + 2) / 2 - 1);
}
constexpr std::size_t max_terms = terms_of(fine_degree);
/// The hubs of huge fans are not fitted: the triangles around them are not a neighborhood.
constexpr std::size_t max_triangles_around = 1024;

/// A symmetric system of equations, solved by Cholesky's decomposition.
class NormalEquations {
  public:
    explicit NormalEquations(std::size_t size) : size_(size) {}

    void add(const std::array<double, max_terms>& terms, double value, double weight) {
        for (std::size_t row = 0; row < size_; ++row) {
            for (std::size_t column = 0; column <= row; ++column)
                matrix_[row][column] += weight * terms[row] * terms[column];
            right_[row] += weight * terms[row] * value;
        }
    }

    /// \return none if the points do not determine the polynomial
    std::optional<std::array<double, max_terms>> solution() {
        for (std::size_t row = 0; row < size_; ++row) {
            const double diagonal = matrix_[row][row];
            for (std::size_t column = 0; column <= row; ++column) {
                double sum = matrix_[row][column];
                for (std::size_t k = 0; k < column; ++k)
                    sum -= matrix_[row][k] * matrix_[column][k];
                if (column < row) {
                    matrix_[row][column] = sum / matrix_[column][column];
                } else {
                    if (!(sum > 1e-11 * diagonal)) return std::nullopt;
                    matrix_[row][row] = std::sqrt(sum);
                }
            }
        }
        std::array<double, max_terms> result{};
        for (std::size_t row = 0; row < size_; ++row) {
            result[row] = right_[row];
            for (std::size_t k = 0; k < row; ++k)
                result[row] -= matrix_[row][k] * result[k];
            result[row] /= matrix_[row][row];
        }
        for (std::size_t row = size_; row-- > 0;) {
            for (std::size_t k = row + 1; k < size_; ++k)
                result[row] -= matrix_[k][row] * result[k];
            result[row] /= matrix_[row][row];
        }
        return result;
    }

  private:
    std::size_t size_;
    std::array<std::array<double, max_terms>, max_terms> matrix_{};
    std::array<double, max_terms> right_{};
};

/// Returns the terms of a polynomial, x and y first, so that their coefficients are the slopes.
std::array<double, max_terms> terms_at(double x, double y, int degree) {
    std::array<double, max_terms> terms{x, y};
    std::size_t next = 2;
    for (int order = 2; order <= degree; ++order) {
        const std::size_t lower = next - static_cast<std::size_t>(order);
        for (std::size_t j = 0; j < static_cast<std::size_t>(order); ++j)
            terms[next++] = x * terms[lower + j];
        terms[next++] = y * terms[lower + static_cast<std::size_t>(order) - 1];
    }
    return terms;
}

/// Returns axes with z along a unit vector.
glm::dmat3 axes_around(const glm::dvec3& z) {
    const glm::dvec3 away =
        std::abs(z.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 x = glm::normalize(glm::cross(away, z));
    return {x, glm::cross(z, x), z};
}

/// Returns the normal at the origin of the polynomial through points around it.
std::optional<glm::dvec3> fitted_normal(const std::vector<glm::dvec3>& points, glm::dvec3 normal,
                                        int degree) {
    const std::size_t terms = terms_of(degree);
    if (points.size() < terms + terms / 2) return std::nullopt;
    double reach = 0.0;
    for (const glm::dvec3& point : points)
        reach = std::max(reach, glm::length(point));
    if (!(reach > 0.0) || !std::isfinite(reach)) return std::nullopt;
    constexpr int rounds = 3;  // The last rotation is smaller than the error of the fit.
    for (int round = 0; round < rounds; ++round) {
        const glm::dmat3 axes = axes_around(normal);
        NormalEquations equations(terms);
        for (const glm::dvec3& point : points) {
            const glm::dvec3 local = (point / reach) * axes;
            equations.add(terms_at(local.x, local.y, degree), local.z,
                          1.0 / std::max(glm::dot(local, local), 1e-12));
        }
        const auto found = equations.solution();
        if (!found) return std::nullopt;
        normal = glm::normalize(axes * glm::dvec3(-(*found)[0], -(*found)[1], 1.0));
    }
    return normal;
}

/// A mesh in which corners that are joined by smooth edges form fans.
class FanMesh {
  public:
    FanMesh(const Mesh& mesh, const HardEdges& hard_edges)
        : mesh_(mesh), welded_(welded_triangles(mesh.triangles, weld_positions(mesh.positions))) {
        normals_ = normals_or_zero(mesh.positions, mesh.triangles);
        const SmoothFans fans =
            smooth_fans({mesh.positions, mesh.triangles, welded_, normals_}, hard_edges);
        fans_.resize(mesh.triangles.size());
        for (std::size_t corner = 0; corner < fans.fan_of_corner.size(); ++corner)
            fans_[corner / 3][static_cast<int>(corner % 3)] = fans.fan_of_corner[corner];
        corners_.emplace(fans.count, fans_);
    }

    [[nodiscard]] std::size_t fan_count() const { return corners_->vertex_count(); }
    [[nodiscard]] std::span<const Corner> corners_of(std::size_t fan) const {
        return corners_->at(fan);
    }

    /// Returns the normalized sum of the unit normals of a fan's triangles; none if they cancel.
    [[nodiscard]] std::optional<glm::dvec3> mean_normal(std::size_t fan) const {
        glm::dvec3 sum(0.0);
        for (const Corner corner : corners_of(fan))
            sum += glm::dvec3(normals_[triangle_of(corner)]);
        const double length = glm::length(sum);
        if (!(length > 1e-3)) return std::nullopt;
        return sum / length;
    }

    /// Returns the largest angle of a triangle of the fan to a normal, in degrees.
    [[nodiscard]] double bend_from(const glm::dvec3& normal, std::size_t fan) const {
        double most = 0.0;
        for (const Corner corner : corners_of(fan)) {
            // Triangles without an area give NaN, which does not count.
            const double bend = degrees_between(glm::dvec3(normals_[triangle_of(corner)]), normal);
            if (bend > most) most = bend;
        }
        return most;
    }

    /// Adds the triangles of all fans of these triangles. The result is ascending.
    void grow(std::vector<std::uint32_t>& triangles) const {
        const std::vector<std::uint32_t> inner = triangles;
        for (const std::uint32_t triangle : inner) {
            for (int i = 0; i < 3; ++i) {
                for (const Corner corner : corners_of(fans_[triangle][i]))
                    triangles.push_back(triangle_of(corner));
            }
            if (triangles.size() > 16 * max_triangles_around) break;
        }
        make_unique(triangles);
    }

    /// Returns the vertices of triangles relative to the vertex of a corner, each once and without
    /// that vertex.
    [[nodiscard]] std::vector<glm::dvec3> points_of(const std::vector<std::uint32_t>& triangles,
                                                    Corner middle) const {
        std::vector<std::uint32_t> vertices;
        for (const std::uint32_t triangle : triangles) {
            for (int i = 0; i < 3; ++i)
                vertices.push_back(welded_[triangle][i]);
        }
        make_unique(vertices);
        const std::uint32_t own = vertex_of(middle, welded_);
        std::vector<glm::dvec3> points;
        for (const std::uint32_t vertex : vertices) {
            if (vertex == own) continue;
            points.push_back(glm::dvec3(mesh_.positions[vertex]) -
                             glm::dvec3(mesh_.positions[own]));
        }
        return points;
    }

    static void make_unique(std::vector<std::uint32_t>& values) {
        std::sort(values.begin(), values.end());
        values.erase(std::unique(values.begin(), values.end()), values.end());
    }

  private:
    const Mesh& mesh_;
    std::vector<glm::uvec3> welded_;  ///< The triangles with the indices of welded vertices.
    std::vector<glm::vec3> normals_;  ///< By triangle.
    std::vector<glm::uvec3> fans_;    ///< The triangles with the indices of fans.
    std::optional<CornersByVertex> corners_;
};

struct Fit {
    glm::dvec3 normal{};
    double doubt = 0.0;  ///< Degrees between the two fits.
    double bend = 0.0;   ///< The largest angle to a triangle, in degrees.
};

std::optional<Fit> fit_at(const FanMesh& mesh, std::size_t fan) {
    const std::span<const Corner> corners = mesh.corners_of(fan);
    if (corners.empty() || corners.size() > max_triangles_around) return std::nullopt;
    const std::optional<glm::dvec3> start = mesh.mean_normal(fan);
    if (!start) return std::nullopt;
    std::vector<std::uint32_t> triangles;
    for (const Corner corner : corners)
        triangles.push_back(triangle_of(corner));
    FanMesh::make_unique(triangles);
    mesh.grow(triangles);
    const auto crude =
        fitted_normal(mesh.points_of(triangles, corners.front()), *start, crude_degree);
    if (!crude || triangles.size() > max_triangles_around) return std::nullopt;
    mesh.grow(triangles);
    if (triangles.size() > max_triangles_around) return std::nullopt;
    const auto fine =
        fitted_normal(mesh.points_of(triangles, corners.front()), *crude, fine_degree);
    if (!fine) return std::nullopt;
    return Fit{*fine, degrees_between(*crude, *fine), mesh.bend_from(*fine, fan)};
}

}  // namespace

FittedNormals fitted_normals(const Mesh& mesh, const FitOptions& options) {
    validate(mesh);
    const FanMesh fans(mesh, options.hard_edges);
    FittedNormals result;
    result.fans = fans.fan_count();
    result.examined_fans = std::min(result.fans, options.max_fans);
    std::vector<std::optional<Fit>> fits(result.examined_fans);
    const auto fan_of = [&](std::size_t place) {
        return place * result.fans / result.examined_fans;
    };
    parallel_for(result.examined_fans, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t place = begin; place < end; ++place)
            fits[place] = fit_at(fans, fan_of(place));
    });
    std::vector<std::pair<Corner, glm::dvec3>> found;
    double squares = 0.0;
    for (std::size_t place = 0; place < result.examined_fans; ++place) {
        if (!fits[place] || !(fits[place]->doubt <= options.max_fit_difference) ||
            fits[place]->bend > options.max_fit_angle)
            continue;
        found.emplace_back(fans.corners_of(fan_of(place)).front(), fits[place]->normal);
        squares += fits[place]->doubt * fits[place]->doubt;
    }
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [corner, normal] : found) {
        result.corners.push_back(corner);
        result.normals.push_back(normal);
    }
    if (!found.empty())
        result.reference_degrees = std::sqrt(squares / static_cast<double>(found.size()));
    return result;
}

}  // namespace relief
