// SPDX-License-Identifier: Apache-2.0
// Division of triangles at the middle of their longest edges, until they are near the surface that
// a height map describes [Rivara 1984].
#include "relief/mesh/displace.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/weld.h"
#include "image/bilinear_heights.h"
#include "image/displaced_surface.h"
#include "image/height_holes.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/height_map.h"
#include "topology/topology.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t triangles_per_task = 256;
constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

void check(const Mesh& mesh, const Image& heights, const DisplaceOptions& options) {
    validate(mesh);
    if (mesh.texcoords.empty() && !mesh.triangles.empty())
        throw InvalidInput(
            "the mesh has no texture coordinates, by which heights are looked up (unwrap it with "
            "relief-mesh unwrap)");
    if (heights.channels != 1)
        throw InvalidInput(
            fmt::format("the height map has {} channels, but must have 1", heights.channels));
    if (!std::isfinite(options.height))
        throw InvalidInput(fmt::format("the height is {}, but must be finite", options.height));
    if (!std::isfinite(options.zero))
        throw InvalidInput(fmt::format("the zero height is {}, but must be finite", options.zero));
    if (!(options.max_error > 0.0))
        throw InvalidInput(
            fmt::format("the largest error is {}, but must be above 0", options.max_error));
    if (options.max_triangles < 1)
        throw InvalidInput("the largest number of triangles is 0, but must be at least 1");
}

/// The edges of triangles, each with the corners at which it begins.
class Edges {
  public:
    explicit Edges(const DisplacedSurface& surface) : of_corner_(3 * surface.triangles.size()) {
        const std::vector<EdgeAt> all = sorted_edges(surface);
        corners_.reserve(all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i == 0 || all[i].ends != all[i - 1].ends)
                first_.push_back(static_cast<std::uint32_t>(i));
            corners_.push_back(all[i].corner);
            of_corner_[all[i].corner] = static_cast<std::uint32_t>(first_.size() - 1);
        }
        first_.push_back(static_cast<std::uint32_t>(all.size()));
    }

    [[nodiscard]] std::size_t count() const { return first_.size() - 1; }
    /// Returns the edge from a corner to the next one.
    [[nodiscard]] std::uint32_t at(Corner corner) const { return of_corner_[corner]; }
    [[nodiscard]] std::span<const Corner> corners(std::uint32_t edge) const {
        return std::span(corners_).subspan(first_[edge], first_[edge + 1] - first_[edge]);
    }

  private:
    struct EdgeAt {
        glm::uvec2 ends;  ///< Points, the smaller first.
        Corner corner;
    };

    static glm::uvec2 ends_at(const DisplacedSurface& surface, Corner corner) {
        const glm::uvec3& v = surface.triangles[triangle_of(corner)].vertices;
        const int k = static_cast<int>(corner % 3);
        const std::uint32_t a = surface.vertices[v[k]].point;
        const std::uint32_t b = surface.vertices[v[(k + 1) % 3]].point;
        return {std::min(a, b), std::max(a, b)};
    }

    /// The edges of all corners, by their ends: a counting sort by the first end, because few edges
    /// share one.
    static std::vector<EdgeAt> sorted_edges(const DisplacedSurface& surface) {
        const auto count = static_cast<Corner>(3 * surface.triangles.size());
        std::vector<std::uint32_t> next(surface.points.size() + 1, 0);
        for (Corner corner = 0; corner < count; ++corner) {
            check_cancelled(corner);
            ++next[ends_at(surface, corner).x + 1];
        }
        std::partial_sum(next.begin(), next.end(), next.begin());
        std::vector<EdgeAt> all(count);
        for (Corner corner = 0; corner < count; ++corner) {
            check_cancelled(corner);
            const glm::uvec2 ends = ends_at(surface, corner);
            all[next[ends.x]++] = {ends, corner};
        }
        std::uint32_t begin = 0;  // Now next[p] is the end of the edges from point p.
        for (std::size_t point = 0; point + 1 < next.size(); ++point) {
            std::sort(all.begin() + begin, all.begin() + next[point],
                      [](const EdgeAt& a, const EdgeAt& b) {
                          return a.ends.y == b.ends.y ? a.corner < b.corner : a.ends.y < b.ends.y;
                      });
            begin = next[point];
        }
        return all;
    }

    std::vector<std::uint32_t> of_corner_;
    std::vector<std::uint32_t> first_;
    std::vector<Corner> corners_;
};

/// Returns the squared lengths of the edges from each corner to the next one, on the mesh.
std::array<double, 3> squared_lengths(const DisplacedSurface& surface,
                                      const SurfaceTriangle& triangle) {
    std::array<double, 3> result{};
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 edge = surface.point_of(triangle.vertices[(k + 1) % 3]).base -
                                surface.point_of(triangle.vertices[k]).base;
        result[static_cast<std::size_t>(k)] = glm::dot(edge, edge);
    }
    return result;
}

/// Chooses the edges that are divided: the longest of each triangle that needs it, and of each
/// triangle at a divided edge. Of equally long ones all are.
std::vector<bool> divided_edges(const DisplacedSurface& surface, const Edges& edges,
                                std::span<const std::uint8_t> needs) {
    std::vector<bool> is_divided(edges.count(), false);
    std::vector<std::uint32_t> open;  // Divided edges whose triangles were not looked at.
    const auto divide_longest = [&](std::uint32_t t) {
        const std::array<double, 3> squares = squared_lengths(surface, surface.triangles[t]);
        const double longest = std::max({squares[0], squares[1], squares[2]});
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t edge = edges.at(3 * t + k);
            if (squares[k] < longest || is_divided[edge]) continue;
            is_divided[edge] = true;
            open.push_back(edge);
        }
    };
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        check_cancelled(t);
        if (needs[t] != 0) divide_longest(t);
    }
    while (!open.empty()) {
        const std::uint32_t edge = open.back();
        open.pop_back();
        for (const Corner corner : edges.corners(edge))
            divide_longest(triangle_of(corner));
    }
    return is_divided;
}

/// Appends the parts of a triangle.
///
/// \param middles  the vertex in the middle of the edge from each corner to the next one, or
/// no_vertex
void append_parts(const DisplacedSurface& surface, const SurfaceTriangle& triangle,
                  const std::array<std::uint32_t, 3>& middles,
                  std::vector<SurfaceTriangle>& parts) {
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        parts.push_back({{a, b, c}, triangle.source});
    };
    std::size_t turn = 0;  // So that the first edge is divided and, if two are, the second one.
    const auto count = 3 - std::count(middles.begin(), middles.end(), no_vertex);
    if (count == 0) {
        parts.push_back(triangle);
        return;
    }
    while (middles[turn] == no_vertex || (count == 2 && middles[(turn + 1) % 3] == no_vertex))
        ++turn;
    const auto corner = [&](std::size_t k) {
        return triangle.vertices[static_cast<int>((turn + k) % 3)];
    };
    const std::uint32_t a = middles[turn];
    const std::uint32_t b = middles[(turn + 1) % 3];
    const std::uint32_t c = middles[(turn + 2) % 3];
    if (count == 1) {
        add(corner(0), a, corner(2));
        add(a, corner(1), corner(2));
    } else if (count == 3) {
        add(corner(0), a, c);
        add(a, corner(1), b);
        add(c, b, corner(2));
        add(a, b, c);
    } else {
        // The middle of the longest edge is joined with the opposite corner; of equally long edges,
        // that which ends at the smaller position.
        const std::array<double, 3> squares = squared_lengths(surface, triangle);
        const double first = squares[turn];
        const double second = squares[(turn + 1) % 3];
        const glm::dvec3& at_0 = surface.point_of(corner(0)).base;
        const glm::dvec3& at_2 = surface.point_of(corner(2)).base;
        const bool is_first_chosen = first == second ? comes_before(at_0, at_2) : first > second;
        add(a, corner(1), b);
        if (is_first_chosen) {
            add(corner(0), a, corner(2));
            add(a, b, corner(2));
        } else {
            add(corner(0), a, b);
            add(corner(0), b, corner(2));
        }
    }
}

/// Divides triangles once. \return whether there was room for the result
bool divide(DisplacedSurface& surface, std::span<const std::uint8_t> needs,
            std::size_t max_triangles) {
    const Edges edges(surface);
    const std::vector<bool> is_divided = divided_edges(surface, edges, needs);
    std::size_t count = surface.triangles.size();
    for (std::uint32_t edge = 0; edge < edges.count(); ++edge) {
        if (is_divided[edge]) count += edges.corners(edge).size();
    }
    if (count > max_triangles) return false;

    std::vector<std::uint32_t> middle_at(3 * surface.triangles.size(), no_vertex);
    std::vector<glm::uvec2> sides;
    for (std::uint32_t edge = 0; edge < edges.count(); ++edge) {
        check_cancelled(edge);
        if (!is_divided[edge]) continue;
        sides.clear();
        const auto side_at = [&](Corner corner) {
            const glm::uvec3& v = surface.triangles[triangle_of(corner)].vertices;
            const int k = static_cast<int>(corner % 3);
            return glm::uvec2(std::min(v[k], v[(k + 1) % 3]), std::max(v[k], v[(k + 1) % 3]));
        };
        for (const Corner corner : edges.corners(edge)) {
            if (std::find(sides.begin(), sides.end(), side_at(corner)) == sides.end())
                sides.push_back(side_at(corner));
        }
        const std::uint32_t first = surface.add_middle(sides);
        for (const Corner corner : edges.corners(edge)) {
            const auto side = std::find(sides.begin(), sides.end(), side_at(corner));
            middle_at[corner] = first + static_cast<std::uint32_t>(side - sides.begin());
        }
    }
    std::vector<SurfaceTriangle> parts;
    parts.reserve(count);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        append_parts(surface, surface.triangles[t],
                     {middle_at[3 * t], middle_at[3 * t + 1], middle_at[3 * t + 2]}, parts);
    surface.triangles = std::move(parts);
    return true;
}

/// Divides triangles until all are near the surface or have the least size. \return whether all are
bool refine(DisplacedSurface& surface, const DisplaceOptions& options) {
    const ProgressStage stage("divide");
    while (true) {
        std::vector<std::uint8_t> needs(surface.triangles.size(), 0);
        parallel_for(needs.size(), triangles_per_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                SurfaceTriangle& triangle = surface.triangles[t];
                if (triangle.is_done) continue;
                triangle.is_done =
                    surface.is_smallest(triangle) ||
                    surface.error(triangle, options.max_error).max <= options.max_error;
                needs[t] = triangle.is_done ? 0 : 1;
            }
        });
        if (std::find(needs.begin(), needs.end(), 1) == needs.end()) return true;
        if (!divide(surface, needs, options.max_triangles)) return false;
    }
}

void measure(const DisplacedSurface& surface, double limit, DisplacedMesh& result) {
    const ProgressStage stage("measure");
    std::vector<SampledError> errors(surface.triangles.size());
    parallel_for(errors.size(), triangles_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t)
            errors[t] =
                surface.error(surface.triangles[t], std::numeric_limits<double>::infinity());
    });
    // In the order of values, so that the order of triangles does not count.
    std::sort(errors.begin(), errors.end(),
              [](const SampledError& a, const SampledError& b) { return a.squares < b.squares; });
    double squares = 0.0;
    std::size_t samples = 0;
    for (const SampledError& error : errors) {
        squares += error.squares;
        samples += error.samples;
        result.max_error = std::max(result.max_error, error.max);
        if (error.max > limit) ++result.above_limit;
    }
    if (samples > 0) result.rms_error = std::sqrt(squares / static_cast<double>(samples));
}

/// Builds the result: the parts of each triangle of the mesh, in its order.
class Assembly {
  public:
    Assembly(const Mesh& mesh, const DisplacedSurface& surface)
        : mesh_(mesh),
          surface_(surface),
          normals_(surface.normals()),
          number_(surface.vertices.size(), no_vertex),
          number_of_kept_(mesh.positions.size(), no_vertex) {
        result_.name = mesh.name;
    }

    /// \param set_aside  triangles of the mesh that are kept as they are
    Mesh build(std::span<const std::uint32_t> set_aside, Report& report) {
        std::size_t part = 0;
        std::size_t kept = 0;
        std::size_t range = 0;
        for (std::uint32_t source = 0; source < mesh_.triangles.size(); ++source) {
            const std::size_t before = result_.triangles.size();
            bool is_turned = false;
            for (; part < surface_.triangles.size() && surface_.triangles[part].source == source;
                 ++part)
                is_turned = add(surface_.triangles[part]) || is_turned;
            if (is_turned)
                report.add("triangle turned over in parts", "triangle", source,
                           "is kept: the displacement folds the surface there");
            if (kept < set_aside.size() && set_aside[kept] == source) {
                ++kept;
                const glm::uvec3& t = mesh_.triangles[source];
                result_.triangles.emplace_back(kept_vertex(t.x), kept_vertex(t.y),
                                               kept_vertex(t.z));
            }
            const std::size_t added = result_.triangles.size() - before;
            if (!mesh_.smoothing_groups.empty())
                result_.smoothing_groups.insert(result_.smoothing_groups.end(), added,
                                                mesh_.smoothing_groups[source]);
            if (!mesh_.material_ranges.empty()) add_to_range(range, source, before, added);
        }
        return std::move(result_);
    }

  private:
    void add_to_range(std::size_t& range, std::uint32_t source, std::size_t before,
                      std::size_t added) {
        while (source >= mesh_.material_ranges[range].first_triangle +
                             mesh_.material_ranges[range].triangle_count)
            ++range;
        while (result_.material_ranges.size() <= range) {
            const std::size_t next = result_.material_ranges.size();
            result_.material_ranges.push_back(
                {static_cast<std::uint32_t>(before), 0, mesh_.material_ranges[next].material});
        }
        result_.material_ranges[range].triangle_count += static_cast<std::uint32_t>(added);
    }

    /// Appends a triangle. \return whether the displacement turns it over
    bool add(const SurfaceTriangle& triangle) {
        std::array<SurfacePoint, 3> p;
        glm::dvec3 normal(0.0);
        glm::uvec3 indices(0);
        for (int k = 0; k < 3; ++k) {
            p[static_cast<std::size_t>(k)] = surface_.point_of(triangle.vertices[k]);
            normal += surface_.vertices[triangle.vertices[k]].normal;
            indices[k] = vertex(triangle.vertices[k]);
        }
        result_.triangles.push_back(indices);
        // The side that faces along the normals is the same before and after.
        const glm::dvec3 base = glm::cross(p[1].base - p[0].base, p[2].base - p[0].base);
        const glm::dvec3 moved = glm::cross(p[1].moved - p[0].moved, p[2].moved - p[0].moved);
        return glm::dot(base, normal) * glm::dot(moved, normal) < 0.0;
    }

    std::uint32_t vertex(std::uint32_t index) {
        if (number_[index] != no_vertex) return number_[index];
        const SurfaceVertex& v = surface_.vertices[index];
        number_[index] = append(glm::vec3(surface_.points[v.point].moved), normals_[index],
                                glm::vec2(v.texcoord), v.color, v.texcoord_2);
        return number_[index];
    }

    std::uint32_t kept_vertex(std::uint32_t index) {
        if (number_of_kept_[index] != no_vertex) return number_of_kept_[index];
        number_of_kept_[index] =
            append(mesh_.positions[index], mesh_.normals[index], mesh_.texcoords[index],
                   mesh_.colors.empty() ? glm::vec4(0.0F) : mesh_.colors[index],
                   mesh_.texcoords_2.empty() ? glm::vec2(0.0F) : mesh_.texcoords_2[index]);
        return number_of_kept_[index];
    }

    std::uint32_t append(const glm::vec3& position, const glm::vec3& normal,
                         const glm::vec2& texcoord, const glm::vec4& color,
                         const glm::vec2& texcoord_2) {
        result_.positions.push_back(position);
        result_.normals.push_back(normal);
        result_.texcoords.push_back(texcoord);
        if (!mesh_.colors.empty()) result_.colors.push_back(color);
        if (!mesh_.texcoords_2.empty()) result_.texcoords_2.push_back(texcoord_2);
        return static_cast<std::uint32_t>(result_.positions.size() - 1);
    }

    const Mesh& mesh_;
    const DisplacedSurface& surface_;
    std::vector<glm::vec3> normals_;
    std::vector<std::uint32_t> number_;
    std::vector<std::uint32_t> number_of_kept_;
    Mesh result_;
};

/// Counts the triangles whose texture coordinates give no height.
void report_texcoords(const Mesh& mesh, Report& report) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            if (is_finite(mesh.texcoords[mesh.triangles[t][k]])) continue;
            report.add("non-finite texture coordinate", "triangle", t,
                       "is not displaced at this corner");
            break;
        }
    }
}

}  // namespace

DisplacedMesh displaced(const Mesh& mesh, const Image& heights, const DisplaceOptions& options,
                        Report& report) {
    check(mesh, heights, options);
    DisplacedMesh result;
    if (mesh.triangles.empty()) return result;
    Image field = height_field(heights);
    std::vector<float> filled = filled_holes(field, options.wrap, report);
    const BilinearHeights bilinear(filled.empty() ? field.as<float>() : std::span(filled),
                                   field.width, field.height, options.wrap);
    report_texcoords(mesh, report);
    FrameOptions frames;
    frames.repair = true;
    const Mesh framed = with_frames(mesh, frames, report).mesh;
    const Topology topology = topology_of(framed, weld_positions(framed.positions), report);
    DisplacedSurface surface(framed, topology, bilinear, options);
    result.is_complete = refine(surface, options);
    measure(surface, options.max_error, result);
    result.mesh = Assembly(framed, surface).build(topology.set_aside, report);
    return result;
}

}  // namespace relief
