// SPDX-License-Identifier: Apache-2.0
#include "image/displaced_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

using Sides = std::vector<std::pair<glm::dvec3, double>>;

/// Sums vectors in the order of their values, each value once, so that neither the order nor
/// repeated vertices count.
glm::dvec3 sum_of_distinct(std::vector<glm::dvec3>& values) {
    std::sort(values.begin(), values.end(), comes_before);
    values.erase(std::unique(values.begin(), values.end()), values.end());
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& value : values)
        sum += value;
    return sum;
}

SurfaceVertex middle(const SurfaceVertex& a, const SurfaceVertex& b) {
    SurfaceVertex result;
    result.texcoord = (a.texcoord + b.texcoord) * 0.5;
    result.normal = (a.normal + b.normal) * 0.5;
    result.along_u = (a.along_u + b.along_u) * 0.5;
    result.along_v = (a.along_v + b.along_v) * 0.5;
    result.color = (a.color + b.color) * 0.5F;
    result.texcoord_2 = (a.texcoord_2 + b.texcoord_2) * 0.5F;
    return result;
}

/// The length in texels, along an axis of the map, of edges that are not divided: half, so that
/// vertices can stand at the centers of texels as well as between them.
constexpr double smallest_texels = 0.5;

/// The most samples of a triangle along an axis of the map; a triangle that repeats the map often
/// has samples at every second texel, and so on.
constexpr double max_samples_along = 4096.0;

/// Calls with(weights) for the centers of texels within a triangle of the map, until it returns
/// false.
template <typename With>
void for_each_texel_center(const std::array<glm::dvec2, 3>& corners, const With& with) {
    const glm::dvec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
    const glm::dvec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
    const glm::dvec2 first = glm::ceil(low - 0.5);
    const glm::dvec2 step = glm::max(glm::ceil((high - low) / max_samples_along), glm::dvec2(1.0));
    const glm::dvec2 b = corners[1] - corners[0];
    const glm::dvec2 c = corners[2] - corners[0];
    const double area = b.x * c.y - b.y * c.x;
    if (area == 0.0) return;
    for (double y = first.y; y + 0.5 <= high.y; y += step.y) {
        for (double x = first.x; x + 0.5 <= high.x; x += step.x) {
            const glm::dvec2 p = glm::dvec2(x + 0.5, y + 0.5) - corners[0];
            const double of_b = (p.x * c.y - p.y * c.x) / area;
            const double of_c = (b.x * p.y - b.y * p.x) / area;
            if (of_b < 0.0 || of_c < 0.0 || of_b + of_c > 1.0) continue;
            if (!with(glm::dvec3(1.0 - of_b - of_c, of_b, of_c))) return;
        }
    }
}

}  // namespace

DisplacedSurface::DisplacedSurface(const Mesh& mesh, const Topology& topology,
                                   const BilinearHeights& heights, const DisplaceOptions& options)
    : heights_(heights), height_(options.height), zero_(options.zero) {
    points.resize(topology.position_vertex.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i].base = glm::dvec3(mesh.positions[topology.position_vertex[i]]);

    // A vertex of the mesh stands at several points where the surface is cut.
    std::unordered_map<std::uint64_t, std::uint32_t> number;
    for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
        const std::uint32_t source = topology.source_triangle[t];
        SurfaceTriangle triangle{{}, source};
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t point = topology.triangles[t][k];
            const std::uint32_t vertex = mesh.triangles[source][k];
            const auto [known, is_new] = number.try_emplace(
                std::uint64_t{point} << 32U | vertex, static_cast<std::uint32_t>(vertices.size()));
            triangle.vertices[k] = known->second;
            if (!is_new) continue;
            SurfaceVertex added;
            added.point = point;
            added.texcoord = glm::dvec2(mesh.texcoords[vertex]);
            added.normal = glm::dvec3(mesh.normals[vertex]);
            if (!mesh.colors.empty()) added.color = mesh.colors[vertex];
            if (!mesh.texcoords_2.empty()) added.texcoord_2 = mesh.texcoords_2[vertex];
            vertices.push_back(added);
        }
        triangles.push_back(triangle);
    }
    set_gradients();

    std::vector<std::vector<SurfaceVertex>> sides(points.size());
    for (const SurfaceVertex& vertex : vertices)
        sides[vertex.point].push_back(vertex);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i].moved = moved(points[i].base, sides[i]);
}

void DisplacedSurface::set_gradients() {
    std::vector<glm::uvec3> indices;
    indices.reserve(triangles.size());
    for (const SurfaceTriangle& triangle : triangles)
        indices.push_back(triangle.vertices);
    std::vector<std::array<glm::dvec3, 2>> of_triangle(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const glm::uvec3& v = indices[t];
        const glm::dvec3 b = point_of(v.y).base - point_of(v.x).base;
        const glm::dvec3 c = point_of(v.z).base - point_of(v.x).base;
        const glm::dvec2 along_b = vertices[v.y].texcoord - vertices[v.x].texcoord;
        const glm::dvec2 along_c = vertices[v.z].texcoord - vertices[v.x].texcoord;
        const glm::dvec3 normal = glm::cross(b, c);
        const double square = glm::dot(normal, normal);
        if (!(square > 0.0) || !is_finite(along_b) || !is_finite(along_c)) continue;
        // The vectors in the plane whose products with b and c are the differences of u, and of v.
        const glm::dvec3 dual_b = glm::cross(c, normal) / square;
        const glm::dvec3 dual_c = glm::cross(normal, b) / square;
        of_triangle[t] = {dual_b * along_b.x + dual_c * along_c.x,
                          dual_b * along_b.y + dual_c * along_c.y};
    }
    const CornersByVertex corners(vertices.size(), indices);
    std::vector<std::array<glm::dvec3, 2>> around;
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        around.clear();
        for (const Corner corner : corners.at(v))
            around.push_back(of_triangle[triangle_of(corner)]);
        std::sort(around.begin(), around.end(), [](const auto& a, const auto& b) {
            return a[0] == b[0] ? comes_before(a[1], b[1]) : comes_before(a[0], b[0]);
        });
        const double share = 1.0 / static_cast<double>(around.size());
        for (const auto& [u_of_one, v_of_one] : around) {
            vertices[v].along_u += u_of_one * share;
            vertices[v].along_v += v_of_one * share;
        }
    }
}

double DisplacedSurface::height_at(const glm::dvec2& texcoord) const {
    return height_ * (heights_.at(texcoord) - zero_);
}

glm::dvec3 DisplacedSurface::moved(const glm::dvec3& base,
                                   std::span<const SurfaceVertex> sides) const {
    if (sides.size() == 1) {
        const SurfaceVertex& only = sides.front();
        if (!is_finite(only.texcoord)) return base;
        return base + direction_or_zero(only.normal) * height_at(only.texcoord);
    }
    std::vector<glm::dvec3> normals;
    Sides distinct;  // Normals and heights.
    for (const SurfaceVertex& side : sides) {
        if (!is_finite(side.texcoord)) continue;
        normals.push_back(direction_or_zero(side.normal));
        distinct.emplace_back(normals.back(), height_at(side.texcoord));
    }
    if (distinct.empty()) return base;
    std::sort(distinct.begin(), distinct.end(), [](const auto& a, const auto& b) {
        return a.first == b.first ? a.second < b.second : comes_before(a.first, b.first);
    });
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    double height = 0.0;
    for (const auto& [normal, of_side] : distinct)
        height += of_side;
    height /= static_cast<double>(distinct.size());
    return base + direction_or_zero(sum_of_distinct(normals)) * height;
}

double DisplacedSurface::error_at(const SurfaceTriangle& triangle,
                                  const glm::dvec3& weights) const {
    glm::dvec3 base(0.0);
    glm::dvec3 flat(0.0);
    glm::dvec3 normal(0.0);
    glm::dvec2 texcoord(0.0);
    for (int k = 0; k < 3; ++k) {
        const SurfaceVertex& vertex = vertices[triangle.vertices[k]];
        const SurfacePoint& point = points[vertex.point];
        base += point.base * weights[k];
        flat += point.moved * weights[k];
        normal += vertex.normal * weights[k];
        texcoord += vertex.texcoord * weights[k];
    }
    const glm::dvec3 away = base + direction_or_zero(normal) * height_at(texcoord) - flat;
    return std::sqrt(glm::dot(away, away));
}

SampledError DisplacedSurface::error(const SurfaceTriangle& triangle, double enough) const {
    SampledError result;
    std::array<glm::dvec2, 3> corners;
    for (int k = 0; k < 3; ++k) {
        corners[static_cast<std::size_t>(k)] =
            vertices[triangle.vertices[k]].texcoord * heights_.size();
        if (!is_finite(corners[static_cast<std::size_t>(k)])) return {};
    }
    const auto sample = [&](const glm::dvec3& weights) {
        const double here = error_at(triangle, weights);
        result.max = std::max(result.max, here);
        result.squares += here * here;
        ++result.samples;
        return here <= enough;
    };
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 weights(0.5);
        weights[k] = 0.0;
        if (!sample(weights)) return result;
    }
    for_each_texel_center(corners, sample);
    return result;
}

bool DisplacedSurface::is_smallest(const SurfaceTriangle& triangle) const {
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 along = vertices[triangle.vertices[(k + 1) % 3]].texcoord -
                                 vertices[triangle.vertices[k]].texcoord;
        if (!is_finite(along)) return true;
        const glm::dvec2 texels = glm::abs(along) * heights_.size();
        if (std::max(texels.x, texels.y) > smallest_texels) return false;
    }
    return true;
}

std::uint32_t DisplacedSurface::add_middle(std::span<const glm::uvec2> sides) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const glm::dvec3 base = (point_of(sides.front().x).base + point_of(sides.front().y).base) * 0.5;
    for (const glm::uvec2& ends : sides) {
        vertices.push_back(middle(vertices[ends.x], vertices[ends.y]));
        vertices.back().point = static_cast<std::uint32_t>(points.size());
    }
    points.push_back({base, moved(base, std::span(vertices).subspan(first))});
    return first;
}

std::vector<glm::vec3> DisplacedSurface::normals() const {
    std::vector<glm::dvec3> own(vertices.size());
    // The vertices of each point: those of point p are from first[p] to first[p + 1].
    std::vector<std::uint32_t> first(points.size() + 1, 0);
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        const SurfaceVertex& vertex = vertices[v];
        const glm::dvec3 normal = direction_or_zero(vertex.normal);
        own[v] = normal;
        ++first[vertex.point + 1];
        if (!is_finite(vertex.texcoord)) continue;
        const glm::dvec2 slope = heights_.slope(vertex.texcoord) * height_;
        const glm::dvec3 rise = vertex.along_u * slope.x + vertex.along_v * slope.y;
        own[v] = direction_or_zero(normal - in_plane(rise, normal));
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    std::vector<std::uint32_t> members(vertices.size());
    for (std::uint32_t v = 0; v < vertices.size(); ++v)
        members[next[vertices[v].point]++] = v;

    std::vector<glm::vec3> result(vertices.size());
    std::vector<glm::dvec3> same;
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        const std::uint32_t point = vertices[v].point;
        same.clear();
        for (std::uint32_t i = first[point]; i < first[point + 1]; ++i) {
            if (vertices[members[i]].normal == vertices[v].normal) same.push_back(own[members[i]]);
        }
        result[v] =
            rounded(same.size() == 1 ? same.front() : direction_or_zero(sum_of_distinct(same)));
    }
    return result;
}

}  // namespace relief::detail
