// SPDX-License-Identifier: Apache-2.0
#include "atlas/surface.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "geometry/direction.h"
#include "geometry/edge_pairs.h"
#include "geometry/value_order.h"
#include "geometry/weld.h"
#include "portable_math.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

/// Spreads the lowest 21 bits to every third bit.
std::uint64_t spread(std::uint64_t x) {
    x &= 0x1FFFFF;
    x = (x | (x << 32)) & 0x1F00000000FFFFULL;
    x = (x | (x << 16)) & 0x1F0000FF0000FFULL;
    x = (x | (x << 8)) & 0x100F00F00F00F00FULL;
    x = (x | (x << 4)) & 0x10C30C30C30C30C3ULL;
    x = (x | (x << 2)) & 0x1249249249249249ULL;
    return x;
}

struct Placed {
    std::uint64_t code;
    std::uint32_t vertex;
};

/// Numbers the positions that finite triangles use along a Morton curve.
/// \return for each vertex of the mesh, its number; no_vertex if no such triangle uses it
std::vector<std::uint32_t> ordered_positions(const Mesh& mesh,
                                             std::span<const std::uint32_t> classes,
                                             std::span<const bool> is_used, AtlasSurface& surface) {
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (std::size_t v = 0; v < classes.size(); ++v) {
        if (!is_used[v]) continue;
        low = glm::min(low, glm::dvec3(mesh.positions[v]));
        high = glm::max(high, glm::dvec3(mesh.positions[v]));
    }
    const glm::dvec3 size = high - low;
    surface.unit = std::max({size.x, size.y, size.z});
    const glm::dvec3 middle = 0.5 * (low + high);
    std::vector<Placed> placed;
    for (std::size_t v = 0; v < classes.size(); ++v) {
        check_cancelled(v);
        if (!is_used[v]) continue;
        const glm::dvec3 at = (glm::dvec3(mesh.positions[v]) - middle) / surface.unit + 0.5;
        const auto cell = [](double x) {
            return static_cast<std::uint64_t>(std::clamp(x * 0x200000, 0.0, 2097151.0));
        };
        placed.push_back({spread(cell(at.x)) | spread(cell(at.y)) << 1 | spread(cell(at.z)) << 2,
                          static_cast<std::uint32_t>(v)});
    }
    std::sort(placed.begin(), placed.end(), [&](const Placed& a, const Placed& b) {
        if (a.code != b.code) return a.code < b.code;
        const int order = compare_values(mesh.positions[a.vertex], mesh.positions[b.vertex]);
        return order != 0 ? order < 0 : a.vertex < b.vertex;  // Equal ones are of different parts.
    });
    check_cancelled();
    std::vector<std::uint32_t> number(classes.size(), no_vertex);
    surface.positions.reserve(placed.size());
    for (const Placed& each : placed) {
        number[each.vertex] = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.push_back((glm::dvec3(mesh.positions[each.vertex]) - middle) /
                                    surface.unit);
    }
    for (std::size_t v = 0; v < classes.size(); ++v) {
        number[v] = number[classes[v]];
    }
    return number;
}

struct OrderedFace {
    glm::uvec3 vertices;
    std::uint32_t triangle;
};

bool precedes(const glm::uvec3& a, const glm::uvec3& b) {
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// Sorts by the first vertex, then by the others.
void sort_faces(std::vector<OrderedFace>& faces, std::size_t vertex_count) {
    std::vector<std::uint32_t> begin(vertex_count + 1, 0);
    for (const OrderedFace& face : faces)
        ++begin[face.vertices.x + 1];
    for (std::size_t v = 0; v < vertex_count; ++v)
        begin[v + 1] += begin[v];
    std::vector<OrderedFace> sorted(faces.size());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (const OrderedFace& face : faces)
        sorted[next[face.vertices.x]++] = face;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        check_cancelled(v);
        std::sort(sorted.begin() + begin[v], sorted.begin() + begin[v + 1],
                  [](const OrderedFace& a, const OrderedFace& b) {
                      if (a.vertices != b.vertices) return precedes(a.vertices, b.vertices);
                      return a.triangle < b.triangle;
                  });
    }
    faces = std::move(sorted);
}

/// Fills the faces and their areas.
/// \return for each face, its first triangle
std::vector<std::uint32_t> fill_faces(const Mesh& mesh, std::span<const bool> is_sound,
                                      std::span<const std::uint32_t> number, AtlasSurface& surface,
                                      Report& report) {
    std::vector<OrderedFace> ordered;
    ordered.reserve(mesh.triangles.size());
    surface.first_corner.assign(mesh.triangles.size(), 0);
    surface.face_of_triangle.assign(mesh.triangles.size(), no_face);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        check_cancelled(t);
        if (!is_sound[t]) continue;
        const glm::uvec3 triangle = mesh.triangles[t];
        const std::array<std::uint32_t, 3> v{number[triangle.x], number[triangle.y],
                                             number[triangle.z]};
        const std::size_t first = v[0] < v[1] ? (v[0] < v[2] ? 0 : 2) : (v[1] < v[2] ? 1 : 2);
        surface.first_corner[t] = static_cast<std::uint8_t>(first);
        ordered.push_back({{v[first], v[(first + 1) % 3], v[(first + 2) % 3]}, t});
    }
    sort_faces(ordered, surface.positions.size());
    std::vector<std::uint32_t> source;
    source.reserve(ordered.size());
    surface.faces.reserve(ordered.size());
    for (const OrderedFace& each : ordered) {
        check_cancelled(source.size());
        if (!surface.faces.empty() && surface.faces.back() == each.vertices) {
            report.add("repeated triangle", "triangle", each.triangle,
                       "has the texture coordinates of the first one");
        } else {
            const glm::dvec3 across = surface.doubled_area(each.vertices);
            const double length = std::sqrt(glm::dot(across, across));
            if (!(length > 0.0)) {
                report.add("triangle without area", "triangle", each.triangle,
                           "has the texture coordinates (0, 0) at its corners");
                continue;
            }
            surface.faces.push_back(each.vertices);
            surface.areas.push_back(0.5 * length);
            source.push_back(each.triangle);
        }
        surface.face_of_triangle[each.triangle] =
            static_cast<std::uint32_t>(surface.faces.size() - 1);
    }
    return source;
}

/// Joins the edges of one pair of vertices.
class EdgeJoiner {
  public:
    EdgeJoiner(AtlasSurface& surface, Report& report) : surface_(surface), report_(report) {}

    /// \param corners  the edges between two vertices, in both directions
    void join(std::span<const Corner> corners) {
        if (corners.size() == 2 && ascends(corners[0]) != ascends(corners[1])) {
            connect(corners[0], corners[1]);
            return;
        }
        if (corners.size() == 1) return;
        report_.add("edge of more than two triangles, or of two in one direction", "face",
                    triangle_of(corners[0]), "joins the flattest pairs; the others are cut");
        triangles_.clear();
        for (const Corner corner : corners) {
            const glm::dvec3 edge =
                surface_.position(next_in_triangle(corner)) - surface_.position(corner);
            triangles_.push_back({corner, ascends(corner),
                                  outward_from(surface_.normal(triangle_of(corner)), edge),
                                  corner});
        }
        for (const auto& [a, b] : pairs_.join(triangles_))
            connect(a, b);
    }

  private:
    [[nodiscard]] bool ascends(Corner corner) const {
        return vertex_of(corner, surface_.faces) <
               vertex_of(next_in_triangle(corner), surface_.faces);
    }
    void connect(Corner a, Corner b) {
        surface_.opposite[a] = b;
        surface_.opposite[b] = a;
    }

    AtlasSurface& surface_;
    Report& report_;
    std::vector<TriangleAtEdge> triangles_;
    EdgePairs pairs_;
};

void join_faces(AtlasSurface& surface, Report& report) {
    const std::size_t edge_count = 3 * surface.faces.size();
    const auto ends = [&](Corner corner) {
        const glm::uvec3& face = surface.faces[corner / 3];
        const std::uint32_t a = face[static_cast<glm::length_t>(corner % 3)];
        const std::uint32_t b = face[static_cast<glm::length_t>((corner + 1) % 3)];
        return std::pair(std::min(a, b), std::max(a, b));
    };
    std::vector<std::uint32_t> begin(surface.positions.size() + 1, 0);
    for (Corner corner = 0; corner < edge_count; ++corner) {
        check_cancelled(corner);
        ++begin[ends(corner).first + 1];
    }
    for (std::size_t v = 0; v < surface.positions.size(); ++v)
        begin[v + 1] += begin[v];
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    // The larger end and the corner, so that they are sorted as one number.
    std::vector<std::uint64_t> edges(edge_count);
    for (Corner corner = 0; corner < edge_count; ++corner) {
        check_cancelled(corner);
        const auto [low, high] = ends(corner);
        edges[next[low]++] = static_cast<std::uint64_t>(high) << 32 | corner;
    }
    surface.opposite.assign(edge_count, no_corner);
    EdgeJoiner joiner(surface, report);
    std::vector<Corner> group;
    for (std::size_t v = 0; v < surface.positions.size(); ++v) {
        check_cancelled(v);
        const auto first = edges.begin() + begin[v];
        const auto last = edges.begin() + begin[v + 1];
        std::sort(first, last);
        for (auto from = first; from != last;) {
            group.clear();
            const std::uint64_t end = *from >> 32;
            for (; from != last && *from >> 32 == end; ++from)
                group.push_back(static_cast<Corner>(*from));
            joiner.join(group);
        }
    }
}

std::vector<std::uint32_t> ranges_of_triangles(const Mesh& mesh) {
    std::vector<std::uint32_t> result(mesh.triangles.size(), 0);
    for (std::size_t i = 0; i < mesh.material_ranges.size(); ++i) {
        const MaterialRange& range = mesh.material_ranges[i];
        const std::uint32_t material = range.material ? *range.material + 1 : 0;
        std::fill_n(result.begin() + range.first_triangle, range.triangle_count, material);
    }
    return result;
}

void mark_borders(const Mesh& mesh, const AtlasConstraints& constraints,
                  std::span<const std::uint32_t> source, AtlasSurface& surface) {
    surface.is_border.assign(surface.opposite.size(), false);
    const std::vector<std::uint32_t> materials =
        constraints.at_materials ? ranges_of_triangles(mesh) : std::vector<std::uint32_t>{};
    const bool has_seams = constraints.at_seams && !mesh.texcoords.empty();
    const bool has_densities = !constraints.densities.empty();
    const double min_cosine = constraints.hard_angle
                                  ? portable::cos(std::max(*constraints.hard_angle, flat_angle))
                                  : -2.0;
    const auto texcoord = [&](Corner corner) {
        const std::uint32_t triangle = source[corner / 3];
        const auto i = (corner % 3 + surface.first_corner[triangle]) % 3;
        return mesh.texcoords[mesh.triangles[triangle][static_cast<glm::length_t>(i)]];
    };
    for (Corner a = 0; a < surface.opposite.size(); ++a) {
        const Corner b = surface.opposite[a];
        if (b == no_corner) continue;
        // A seam may end inside of a chart, which is cut there.
        if (has_seams && (texcoord(a) != texcoord(next_in_triangle(b)) ||
                          texcoord(b) != texcoord(next_in_triangle(a)))) {
            surface.opposite[a] = surface.opposite[b] = no_corner;
            continue;
        }
        const auto [low, high] = has_densities ? std::minmax({constraints.densities[source[a / 3]],
                                                              constraints.densities[source[b / 3]]})
                                               : std::pair(1.0F, 1.0F);
        surface.is_border[a] =
            (constraints.at_materials && materials[source[a / 3]] != materials[source[b / 3]]) ||
            high > 2.0F * low ||
            glm::dot(surface.normal(a / 3), surface.normal(b / 3)) < min_cosine;
    }
}

/// For each vertex, the first one of its part with the same position.
std::vector<std::uint32_t> position_classes(const Mesh& mesh,
                                            std::span<const std::uint32_t> first_vertices) {
    if (first_vertices.size() <= 1) return weld_positions(std::span(mesh.positions));
    std::vector<std::uint32_t> classes;
    classes.reserve(mesh.positions.size());
    for (std::size_t part = 0; part < first_vertices.size(); ++part) {
        const std::size_t first = first_vertices[part];
        const std::size_t end =
            part + 1 < first_vertices.size() ? first_vertices[part + 1] : mesh.positions.size();
        for (const std::uint32_t vertex :
             weld_positions(std::span(mesh.positions).subspan(first, end - first)))
            classes.push_back(static_cast<std::uint32_t>(first) + vertex);
    }
    return classes;
}

}  // namespace

AtlasSurface atlas_surface(const Mesh& mesh, const AtlasConstraints& constraints, Report& report) {
    AtlasSurface surface;
    const std::vector<std::uint32_t> classes = position_classes(mesh, constraints.first_vertices);
    // Not std::vector<bool>, whose elements have no address.
    const auto is_used = std::make_unique<bool[]>(mesh.positions.size());
    const auto is_sound = std::make_unique<bool[]>(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3 v = mesh.triangles[t];
        const bool is_finite_triangle = is_finite(mesh.positions[v.x]) &&
                                        is_finite(mesh.positions[v.y]) &&
                                        is_finite(mesh.positions[v.z]);
        const bool has_three_corners = classes[v.x] != classes[v.y] &&
                                       classes[v.y] != classes[v.z] && classes[v.z] != classes[v.x];
        if (!is_finite_triangle)
            report.add("triangle with a non-finite corner", "triangle", t,
                       "has the texture coordinates (0, 0) at its corners");
        else if (!has_three_corners)
            report.add("triangle without area", "triangle", t,
                       "has the texture coordinates (0, 0) at its corners");
        is_sound[t] = is_finite_triangle && has_three_corners;
        if (!is_sound[t]) continue;
        is_used[classes[v.x]] = is_used[classes[v.y]] = is_used[classes[v.z]] = true;
    }
    const std::vector<std::uint32_t> number = ordered_positions(
        mesh, classes, std::span<const bool>(is_used.get(), mesh.positions.size()), surface);
    const std::vector<std::uint32_t> source =
        fill_faces(mesh, std::span<const bool>(is_sound.get(), mesh.triangles.size()), number,
                   surface, report);
    join_faces(surface, report);
    mark_borders(mesh, constraints, source, surface);
    return surface;
}

void check_parts(const Mesh& mesh, std::span<const std::uint32_t> first_vertices) {
    if (first_vertices.empty()) return;
    if (first_vertices.front() != 0 || first_vertices.back() > mesh.positions.size() ||
        !std::is_sorted(first_vertices.begin(), first_vertices.end()))
        throw InvalidInput("the first vertices of the parts must ascend from 0");
}

}  // namespace relief::detail
