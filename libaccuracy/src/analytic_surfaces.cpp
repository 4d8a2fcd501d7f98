// SPDX-License-Identifier: Apache-2.0
// Maps parameters (s, t) in [0,1]^2 to a point, its normal and its derivatives. The random numbers
// are relief's own, because the distributions of standard libraries differ. Tests:
// tests/accuracy/ground_truth_test.cpp.
#include "relief/accuracy/ground_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numbers>
#include <utility>

#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief::accuracy {
using namespace relief::detail;

namespace {

struct PlacedPoint {
    glm::dvec3 position;
    glm::dvec3 normal;
    glm::dvec3 along_s;  ///< The position's derivatives.
    glm::dvec3 along_t;
};

/// A function that is zero on a surface and positive on the side of its normals.
struct Implicit {
    double value = 0.0;
    glm::dvec3 gradient{};
};

/// A surface by its parameters, and as an implicit function. It may be closed along each parameter.
struct Surface {
    std::function<PlacedPoint(double s, double t)> at;
    std::function<Implicit(const glm::dvec3&)> off;
    bool s_closes = false;
    bool t_closes = false;
};

constexpr glm::dvec3 ellipsoid_axes(1.0, 0.7, 0.4);

PlacedPoint on_ellipsoid(const glm::dvec3& axes, double s, double t) {
    // The poles are omitted, because triangles there do not keep their shape when they shrink.
    constexpr double from_pole = 0.15 * std::numbers::pi;
    constexpr double pole_to_pole = std::numbers::pi - 2.0 * from_pole;
    const double polar = from_pole + t * pole_to_pole;
    const double around = 2.0 * std::numbers::pi * s;
    const glm::dvec3 direction(portable::sin(polar) * portable::cos(around),
                               portable::sin(polar) * portable::sin(around), portable::cos(polar));
    const glm::dvec3 east(-portable::sin(around), portable::cos(around), 0.0);
    const glm::dvec3 down(portable::cos(polar) * portable::cos(around),
                          portable::cos(polar) * portable::sin(around), -portable::sin(polar));
    return {axes * direction, glm::normalize(direction / axes),
            axes * east * (2.0 * std::numbers::pi * portable::sin(polar)),
            axes * down * pole_to_pole};
}

constexpr double torus_minor = 0.4;

PlacedPoint on_torus(double s, double t) {
    const double around = 2.0 * std::numbers::pi * s;
    const double across = 2.0 * std::numbers::pi * t;
    const glm::dvec3 out(portable::cos(around), portable::sin(around), 0.0);
    const glm::dvec3 normal =
        portable::cos(across) * out + portable::sin(across) * glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 on(-portable::sin(around), portable::cos(around), 0.0);
    return {out + torus_minor * normal, normal,
            on * 2.0 * std::numbers::pi * (1.0 + torus_minor * portable::cos(across)),
            2.0 * std::numbers::pi * torus_minor *
                (portable::cos(across) * glm::dvec3(0.0, 0.0, 1.0) - portable::sin(across) * out)};
}

/// The surface z = sum of c[i][j] x^i y^j.
struct Cubic {
    std::array<std::array<double, 4>, 4> c{};

    [[nodiscard]] PlacedPoint at(double x, double y) const {
        double z = 0.0;
        double along_x = 0.0;
        double along_y = 0.0;
        const std::array powers_of_x = {1.0, x, x * x, x * x * x};
        const std::array powers_of_y = {1.0, y, y * y, y * y * y};
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; i + j < 4; ++j) {
                const double factor = c[i][j];
                z += factor * powers_of_x[i] * powers_of_y[j];
                if (i > 0)
                    along_x +=
                        factor * static_cast<double>(i) * powers_of_x[i - 1] * powers_of_y[j];
                if (j > 0)
                    along_y +=
                        factor * static_cast<double>(j) * powers_of_x[i] * powers_of_y[j - 1];
            }
        }
        return {{x, y, z},
                glm::normalize(glm::dvec3(-along_x, -along_y, 1.0)),
                {1.0, 0.0, along_x},
                {0.0, 1.0, along_y}};
    }
};

Implicit off_ellipsoid(const glm::dvec3& axes, const glm::dvec3& p) {
    const glm::dvec3 scaled = p / axes;
    return {glm::dot(scaled, scaled) - 1.0, 2.0 * scaled / axes};
}

Implicit off_torus(const glm::dvec3& p) {
    const glm::dvec3 center = glm::normalize(glm::dvec3(p.x, p.y, 0.0));
    const double distance = glm::length(p - center);
    return {distance - torus_minor, (p - center) / distance};
}

Implicit off_cubic(const Cubic& cubic, const glm::dvec3& p) {
    const PlacedPoint below = cubic.at(p.x, p.y);
    return {p.z - below.position.z, {-below.along_s.z, -below.along_t.z, 1.0}};
}

/// Finds the nearest point by moving tangentially below the given one and back to the surface. The
/// error falls by the factor distance * curvature in each step.
ExactPoint nearest_zero(const std::function<Implicit(const glm::dvec3&)>& off,
                        const glm::dvec3& position) {
    constexpr int max_steps = 60;
    constexpr double negligible = 1e-13;
    glm::dvec3 p = position;
    for (int step = 0; step < max_steps; ++step) {
        const Implicit here = off(p);
        const glm::dvec3 normal = glm::normalize(here.gradient);
        const glm::dvec3 below = position - normal * glm::dot(position - p, normal);
        const Implicit there = off(below);
        const glm::dvec3 next =
            below - there.gradient * (there.value / glm::dot(there.gradient, there.gradient));
        const double moved = glm::length(next - p);
        p = next;
        if (moved < negligible) break;
    }
    return {p, glm::normalize(off(p).gradient)};
}

/// \param lowest  the lowest degree of a term: with 2 the surface is level at the origin
Cubic random_cubic(Random& random, int lowest, double size) {
    Cubic cubic;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; i + j < 4; ++j) {
            if (i + j < lowest) continue;
            cubic.c[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
                random.between(-size, size);
        }
    }
    return cubic;
}

Cubic saddle() {
    Cubic saddle;
    saddle.c[2][0] = 0.5;
    saddle.c[0][2] = -0.5;
    return saddle;
}

constexpr double cubic_size = 0.5;

Surface ellipsoid(const glm::dvec3& axes) {
    return {[axes](double s, double t) { return on_ellipsoid(axes, s, t); },
            [axes](const glm::dvec3& p) { return off_ellipsoid(axes, p); }, true};
}

/// The graph of a cubic over [-1,1]^2.
Surface graph(const Cubic& cubic) {
    return {[cubic](double s, double t) {
                PlacedPoint point = cubic.at(2.0 * s - 1.0, 2.0 * t - 1.0);
                point.along_s *= 2.0;
                point.along_t *= 2.0;
                return point;
            },
            [cubic](const glm::dvec3& p) { return off_cubic(cubic, p); }};
}

Surface surface_of(AnalyticSurface surface, Random& random) {
    switch (surface) {
        case AnalyticSurface::sphere:
            return ellipsoid(glm::dvec3(1.0));
        case AnalyticSurface::torus:
            return {on_torus, off_torus, true, true};
        case AnalyticSurface::ellipsoid:
            return ellipsoid(ellipsoid_axes);
        case AnalyticSurface::saddle:
            return graph(saddle());
        case AnalyticSurface::cubic:
            break;
    }
    return graph(random_cubic(random, 1, cubic_size));
}

/// Parameters of the sphere and the ellipsoid run clockwise seen from outside.
bool runs_clockwise(AnalyticSurface surface) {
    return surface == AnalyticSurface::sphere || surface == AnalyticSurface::ellipsoid;
}

/// The maximum offset of points, in cells.
double jitter_of(Triangulation triangulation) {
    switch (triangulation) {
        case Triangulation::regular:
            return 0.0;
        case Triangulation::jittered:
        case Triangulation::anisotropic:
            return 0.24;  // With larger offsets, cells would not stay convex.
        case Triangulation::folded:
            break;
    }
    return 0.6;
}

/// The numbers of cells and vertices along both parameters. A closed direction has as many vertices
/// as cells, an open one has one more.
struct Grid {
    int columns;
    int rows;
    int across;
    int down;
};

Grid grid_of(Triangulation triangulation, int cells) {
    if (cells < 4)
        throw InvalidInput(fmt::format("the number of cells is {}, but must be at least 4", cells));
    const bool stretched = triangulation == Triangulation::anisotropic;
    const int columns = stretched ? 4 * cells : cells;
    const int rows = stretched ? std::max(cells / 4, 1) : cells;
    return {columns, rows, columns + 1, rows + 1};
}

struct GridVertex {
    int column;
    int row;
    bool is_inner;
    glm::dvec2 place;  ///< The parameters.
};

/// Inner vertices are displaced at random, except along s in a column that stays.
std::vector<GridVertex> vertices_of(const Grid& grid, double jitter, Random& random,
                                    int fixed_column = -1) {
    std::vector<GridVertex> vertices;
    for (int r = 0; r < grid.down; ++r) {
        for (int c = 0; c < grid.across; ++c) {
            const bool is_inner = (grid.across == grid.columns || (c > 0 && c < grid.columns)) &&
                                  (grid.down == grid.rows || (r > 0 && r < grid.rows));
            const bool moves_along_s = is_inner && c != fixed_column;
            const double move_s = moves_along_s ? random.between(-jitter, jitter) : 0.0;
            const double move_t = is_inner ? random.between(-jitter, jitter) : 0.0;
            vertices.push_back(
                {c, r, is_inner, {(c + move_s) / grid.columns, (r + move_t) / grid.rows}});
        }
    }
    return vertices;
}

/// Adds two triangles per cell; with a generator, their diagonal is random.
void add_cells(Mesh& mesh, const Grid& grid, Random* random) {
    for (int r = 0; r < grid.rows; ++r) {
        for (int c = 0; c < grid.columns; ++c) {
            const auto vertex = [&](int column, int row) {
                return static_cast<std::uint32_t>(row % grid.down * grid.across +
                                                  column % grid.across);
            };
            const std::uint32_t a = vertex(c, r), b = vertex(c + 1, r), d = vertex(c, r + 1),
                                e = vertex(c + 1, r + 1);
            const bool other = random != nullptr && random->between(0.0, 1.0) < 0.5;
            mesh.triangles.push_back(other ? glm::uvec3(a, b, d) : glm::uvec3(a, b, e));
            mesh.triangles.push_back(other ? glm::uvec3(b, e, d) : glm::uvec3(a, e, d));
        }
    }
}

void turn_over(Mesh& mesh) {
    for (glm::uvec3& triangle : mesh.triangles)
        std::swap(triangle.y, triangle.z);
}

glm::dvec2 texcoord_at(TextureLayout layout, const glm::dvec2& parameters) {
    const double s = parameters.x;
    const double t = parameters.y;
    switch (layout) {
        case TextureLayout::upright:
            break;
        case TextureLayout::sheared:
            return {s, 1.0 - t + 0.5 * s};
        case TextureLayout::mirrored:
            return {s < 0.5 ? 2.0 * s : 2.0 - 2.0 * s, 1.0 - t};
    }
    return {s, 1.0 - t};
}

/// Computes the frame from the derivatives by s and t and the equations of the texture layouts.
SurfaceFrame frame_of(const PlacedPoint& point, TextureLayout layout, double s) {
    glm::dvec3 along_u = point.along_s;
    const glm::dvec3 up = point.along_t;
    if (layout == TextureLayout::sheared) along_u += 0.5 * point.along_t;
    if (layout == TextureLayout::mirrored && s >= 0.5) along_u = -along_u;
    SurfaceFrame frame{point.normal, glm::normalize(along_u), 1.0};
    if (glm::dot(glm::cross(frame.normal, frame.tangent), up) < 0.0) frame.handedness = -1.0;
    return frame;
}

}  // namespace

AnalyticMesh analytic_mesh(AnalyticSurface surface, Triangulation triangulation, int cells,
                           std::uint32_t seed) {
    Grid grid = grid_of(triangulation, cells);
    Random random(seed);
    const Surface where = surface_of(surface, random);
    if (where.s_closes) grid.across = grid.columns;
    if (where.t_closes) grid.down = grid.rows;
    AnalyticMesh result;
    const double jitter = jitter_of(triangulation);
    for (const GridVertex& vertex : vertices_of(grid, jitter, random)) {
        const PlacedPoint point = where.at(vertex.place.x, vertex.place.y);
        result.mesh.positions.emplace_back(point.position);
        result.normals.push_back(point.normal);
        result.inner.push_back(vertex.is_inner ? 1 : 0);
    }
    add_cells(result.mesh, grid, jitter > 0.0 ? &random : nullptr);
    if (runs_clockwise(surface)) turn_over(result.mesh);
    return result;
}

TexturedMesh textured_mesh(AnalyticSurface surface, Triangulation triangulation,
                           TextureLayout layout, int cells, std::uint32_t seed) {
    const Grid grid = grid_of(triangulation, cells);
    if (layout == TextureLayout::mirrored && grid.columns % 2 != 0)
        throw InvalidInput(fmt::format(
            "the number of columns of a mirrored texture is {}, but must be even", grid.columns));
    Random random(seed);
    const Surface where = surface_of(surface, random);
    TexturedMesh result;
    const double jitter = jitter_of(triangulation);
    // The image is mirrored along edges.
    const int fixed_column = layout == TextureLayout::mirrored ? grid.columns / 2 : -1;
    for (const GridVertex& vertex : vertices_of(grid, jitter, random, fixed_column)) {
        const glm::dvec2& place = vertex.place;
        // Both sides of a seam have the same position.
        const bool is_s_end = where.s_closes && vertex.column == grid.columns;
        const bool is_t_end = where.t_closes && vertex.row == grid.rows;
        const PlacedPoint point = where.at(is_s_end ? 0.0 : place.x, is_t_end ? 0.0 : place.y);
        result.mesh.positions.emplace_back(point.position);
        result.mesh.normals.emplace_back(point.normal);
        result.mesh.texcoords.emplace_back(texcoord_at(layout, place));
        result.parameters.push_back(place);
        result.inner.push_back(vertex.is_inner ? 1 : 0);
    }
    add_cells(result.mesh, grid, jitter > 0.0 ? &random : nullptr);
    if (runs_clockwise(surface)) turn_over(result.mesh);
    result.frame_at = [where, layout](const glm::dvec2& parameters) {
        return frame_of(where.at(parameters.x, parameters.y), layout, parameters.x);
    };
    return result;
}

std::function<ExactPoint(const glm::dvec3& position)> nearest_on_surface(AnalyticSurface surface,
                                                                         std::uint32_t seed) {
    Random random(seed);
    return [off = surface_of(surface, random).off](const glm::dvec3& position) {
        return nearest_zero(off, position);
    };
}

TexturedMesh beveled_plate(double width) {
    if (!(width > 0.0))
        throw InvalidInput(
            fmt::format("the width of the bevels is {}, but must be above 0", width));
    TexturedMesh result;
    const auto add = [&](const glm::dvec3& position, const glm::dvec3& normal,
                         const glm::dvec2& place_in_image, bool inner) {
        result.mesh.positions.emplace_back(position);
        result.mesh.normals.emplace_back(glm::normalize(normal));
        result.mesh.texcoords.emplace_back(0.5 + 0.5 * place_in_image.x,
                                           0.5 - 0.5 * place_in_image.y);
        result.parameters.emplace_back(position);
        result.inner.push_back(inner ? 1 : 0);
    };
    const std::array<glm::dvec2, 4> corners = {glm::dvec2(-1.0, -1.0), glm::dvec2(1.0, -1.0),
                                               glm::dvec2(1.0, 1.0), glm::dvec2(-1.0, 1.0)};
    for (const glm::dvec2& corner : corners)
        add({corner, 0.0}, {0.0, 0.0, 1.0}, corner, true);
    for (const glm::dvec2& corner : corners) {
        const glm::dvec2 outside = corner * (1.0 + width);
        // A quarter turn of the way there: along each edge by as much as the bevel is wide.
        const glm::dvec2 along = width * glm::dvec2(-corner.y, corner.x);
        add({outside, -width}, {corner, 0.0}, outside + along, false);
    }
    result.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t next = (i + 1) % 4;
        result.mesh.triangles.emplace_back(i, i + 4, next + 4);
        result.mesh.triangles.emplace_back(i, next + 4, next);
    }
    result.frame_at = [](const glm::dvec2&) {
        return SurfaceFrame{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, 1.0};
    };
    return result;
}

Mesh cubic_fan(int valence, std::uint32_t seed) {
    if (valence < 3)
        throw InvalidInput(
            fmt::format("the number of neighbors is {}, but must be at least 3", valence));
    Random random(seed);
    const Cubic cubic = random_cubic(random, 2, 1.0);
    std::vector<double> angles;
    // Directions are drawn again until no gap reaches 180 degrees, so that neighbors surround the
    // vertex.
    for (bool closed = false; !closed;) {
        angles.clear();
        for (int i = 0; i < valence; ++i)
            angles.push_back(random.between(0.0, 2.0 * std::numbers::pi));
        std::sort(angles.begin(), angles.end());
        closed = angles.front() + 2.0 * std::numbers::pi - angles.back() < std::numbers::pi;
        for (std::size_t i = 1; i < angles.size(); ++i)
            closed = closed && angles[i] - angles[i - 1] < std::numbers::pi;
    }
    Mesh mesh;
    mesh.positions.emplace_back(0.0F);
    for (std::uint32_t i = 0; i < angles.size(); ++i) {
        const double distance = random.between(0.05, 0.2);
        mesh.positions.emplace_back(
            cubic.at(distance * portable::cos(angles[i]), distance * portable::sin(angles[i]))
                .position);
        mesh.triangles.emplace_back(0, i + 1, (i + 1) % angles.size() + 1);
    }
    return mesh;
}

}  // namespace relief::accuracy
