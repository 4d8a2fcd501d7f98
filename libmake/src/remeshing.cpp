// SPDX-License-Identifier: Apache-2.0
// Measures what remeshing loses, and judges whether it is worth it. Tests:
// tests/make/remeshing_test.cpp.
#include "relief/make/remeshing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>

#include "bake/embree_scene.h"
#include "geometry/value_order.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/topology.h"
#include "remesh_judgment.h"

namespace relief::make::detail {
namespace {

using relief::detail::EmbreeScene;
using relief::detail::EmbreeSpace;
using relief::detail::RayPacket;

constexpr std::size_t sample_count = 4096;
constexpr std::size_t direction_count = 64;

/// A point of a surface with the unit normal of its triangle.
struct SurfacePoint {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};
};

glm::dvec3 area_vector(const Mesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a(mesh.positions[t.x]);
    return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
}

/// Returns the fractional part of a multiple of an irrational number: evenly spread over [0, 1).
double spread(std::size_t index, double step) {
    const double value = static_cast<double>(index) * step;
    return value - std::floor(value);
}

/// Returns the triangles in the order of their positions, each with its smallest corner first, so
/// that samples do not depend on the order of the mesh.
std::vector<glm::uvec3> sorted_triangles(const Mesh& mesh) {
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
        return relief::detail::compare_values(mesh.positions[a], mesh.positions[b]);
    };
    std::vector<glm::uvec3> triangles(mesh.triangles);
    for (glm::uvec3& t : triangles) {
        while (compare(t.y, t.x) < 0 || compare(t.z, t.x) < 0)
            t = {t.y, t.z, t.x};
    }
    std::ranges::sort(triangles, [&](const glm::uvec3& a, const glm::uvec3& b) {
        int order = compare(a.x, b.x);
        if (order == 0) order = compare(a.y, b.y);
        if (order == 0) order = compare(a.z, b.z);
        return order < 0;
    });
    return triangles;
}

/// Returns points in equal distances of the area, with positions in their triangles that are evenly
/// spread.
std::vector<SurfacePoint> points_on(const Mesh& mesh) {
    const std::vector<glm::uvec3> triangles = sorted_triangles(mesh);
    double area = 0.0;
    for (const glm::uvec3& t : triangles)
        area += glm::length(area_vector(mesh, t));
    std::vector<SurfacePoint> points;
    if (!(area > 0.0)) return points;
    double before = 0.0;
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 vector = area_vector(mesh, t);
        const double after = before + glm::length(vector);
        while (points.size() < sample_count &&
               (static_cast<double>(points.size()) + 0.5) * area < after * sample_count) {
            double u = spread(points.size(), 0.7548776662466927);
            double v = spread(points.size(), 0.5698402909980532);
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            const glm::dvec3 a(mesh.positions[t.x]);
            const glm::dvec3 position = a + u * (glm::dvec3(mesh.positions[t.y]) - a) +
                                        v * (glm::dvec3(mesh.positions[t.z]) - a);
            points.push_back({position, vector / glm::length(vector)});
        }
        before = after;
    }
    return points;
}

/// Returns unit directions that are evenly spread over the sphere, without trigonometry: points of
/// a grid on the faces of a cube.
std::vector<glm::dvec3> directions() {
    std::vector<glm::dvec3> result;
    for (std::size_t i = 0; i < direction_count; ++i) {
        const double u = 2.0 * spread(i, 0.7548776662466927) - 1.0;
        const double v = 2.0 * spread(i, 0.5698402909980532) - 1.0;
        const double side = i % 2 == 0 ? 1.0 : -1.0;
        glm::dvec3 direction(u, v, side);
        for (std::size_t turn = 0; turn < i / 2 % 3; ++turn)
            direction = {direction.z, direction.x, direction.y};
        result.push_back(glm::normalize(direction));
    }
    return result;
}

/// Casts rays from points of a surface to the outside.
class Outside {
  public:
    explicit Outside(const Mesh& mesh) : Outside(mesh, bounds_of(mesh)) {}

    /// Returns for each point whether a ray from one of both sides meets nothing.
    [[nodiscard]] std::vector<std::uint8_t> sees(const std::vector<SurfacePoint>& points) const {
        std::vector<std::uint8_t> seen(points.size(), 0);
        relief::detail::parallel_for(points.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                seen[i] = is_seen(points[i]) ? 1 : 0;
        });
        return seen;
    }

  private:
    Outside(const Mesh& mesh, const Bounds& bounds)
        : center_((glm::dvec3(bounds.min) + glm::dvec3(bounds.max)) / 2.0),
          size_(glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min))),
          scene_(EmbreeSpace{center_, size_ > 0.0 ? size_ / 2.0 : 1.0},
                 relief::detail::SceneBuild::fast),
          directions_(directions()) {
        scene_.add(0, std::span<const glm::vec3>(mesh.positions), mesh.triangles);
        scene_.build();
    }

    [[nodiscard]] bool is_seen(const SurfacePoint& point) const {
        RayPacket packet;
        for (std::size_t first = 0; first < directions_.size(); first += RayPacket::size) {
            for (std::size_t lane = 0; lane < RayPacket::size; ++lane) {
                const glm::dvec3& direction = directions_[first + lane];
                const double side = glm::dot(direction, point.normal) < 0.0 ? -1.0 : 1.0;
                // Beyond the rounding of positions.
                const glm::dvec3 origin = point.position + side * 1e-6 * size_ * point.normal;
                scene_.set(packet, lane, {origin, direction, 0.0, 2.0 * size_});
            }
            scene_.find_any(packet, RayPacket::size);
            for (std::size_t lane = 0; lane < RayPacket::size; ++lane) {
                if (!packet.is_blocked(lane)) return true;
            }
        }
        return false;
    }

    glm::dvec3 center_;
    double size_;
    EmbreeScene scene_;
    std::vector<glm::dvec3> directions_;
};

double hidden_share(const std::vector<std::uint8_t>& seen) {
    if (seen.empty()) return 0.0;
    return static_cast<double>(std::ranges::count(seen, 0)) / static_cast<double>(seen.size());
}

/// Returns a mesh of small triangles at points, whose distances are those of the points.
Mesh mesh_at(const std::vector<SurfacePoint>& points, const std::vector<std::uint8_t>& chosen,
             double size) {
    Mesh mesh;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (chosen[i] == 0) continue;
        const glm::dvec3& normal = points[i].normal;
        const glm::dvec3 other =
            std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 along = size * glm::normalize(glm::cross(normal, other));
        const glm::dvec3 across = glm::cross(normal, along);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::dvec3& corner : {along, across - along, -across})
            mesh.positions.emplace_back(points[i].position + corner);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

/// Returns the share of the area that is not seen from outside.
double hidden_area(const Mesh& mesh) {
    return hidden_share(Outside(mesh).sees(points_on(mesh)));
}

/// Measures the distances between a mesh and the closed surface around it. Points of the mesh count
/// as seen if a ray of 64 meets nothing.
RemeshDistance distance_of(const Mesh& mesh, const Mesh& surface) {
    const std::vector<SurfacePoint> points = points_on(mesh);
    const std::vector<std::uint8_t> seen = Outside(mesh).sees(points);
    RemeshDistance result;
    result.hidden = hidden_share(seen);
    const Bounds bounds = bounds_of(mesh);
    const double size = glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
    const Mesh marks = mesh_at(points, seen, 1e-5 * size);
    if (!marks.triangles.empty()) {
        const DistanceStats of_source =
            sampled_distance(marks, surface, marks.triangles.size(), 1).from_a;
        result.rms_of_source = of_source.rms;
        result.max_of_source = of_source.max;
    }
    constexpr std::size_t surface_samples = 20000;
    const DistanceStats of_surface = sampled_distance(surface, mesh, surface_samples, 1).from_a;
    result.rms_of_surface = of_surface.rms;
    result.max_of_surface = of_surface.max;
    return result;
}

/// Returns whether triangles that are joined through vertices at equal positions are several parts.
bool has_parts(const Mesh& mesh) {
    const std::vector<std::uint32_t> classes = relief::detail::weld_positions(mesh.positions);
    relief::detail::DisjointSets parts(classes.size());
    for (const glm::uvec3& t : mesh.triangles) {
        parts.join(classes[t.x], classes[t.y]);
        parts.join(classes[t.x], classes[t.z]);
    }
    return std::ranges::any_of(mesh.triangles, [&](const glm::uvec3& t) {
        return parts.find(classes[t.x]) != parts.find(classes[mesh.triangles.front().x]);
    });
}

}  // namespace

double crowded_edge_share(const Mesh& mesh, const Report* repair) {
    std::size_t count = 0;
    if (repair != nullptr) {
        count =
            repair->count("non-manifold edge") + repair->count("edge of more than 512 triangles");
    } else {
        DiagnoseOptions edges;
        edges.near_duplicates = false;
        edges.texture_overlap = false;
        count = diagnose(mesh, edges).count(MeshCondition::edge_non_manifold);
    }
    return static_cast<double>(count) / (1.5 * static_cast<double>(mesh.triangles.size()));
}

double small_chart_area(const Mesh& mesh, const Unwrapped& unwrapped) {
    constexpr double small_part = 1.0 / 2000.0;
    std::vector<double> areas(unwrapped.stats.charts, 0.0);
    double all = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::optional<std::uint32_t>& chart = unwrapped.chart[t];
        if (!chart || *chart >= areas.size()) continue;
        const double area = glm::length(area_vector(mesh, mesh.triangles[t]));
        areas[*chart] += area;
        all += area;
    }
    double small = 0.0;
    for (const double area : areas) {
        if (area < small_part * all) small += area;
    }
    return all > 0.0 ? small / all : 0.0;
}

std::vector<RemeshCriterion> remesh_criteria(const Mesh& mesh, const RemeshEvidence& evidence) {
    std::vector<RemeshCriterion> criteria = {
        {"edges of three or more triangles", 0.02, evidence.crowded_edges},
        {"triangles beyond the target", 0.1, evidence.excess},
        {"area in charts below 1/2000 of it", 0.05, evidence.small_charts},
        {"area that is not seen from outside", 0.2, std::nullopt}};
    if (has_parts(mesh)) criteria.back().value = hidden_area(mesh);
    return criteria;
}

Mesh closed_surface(const Mesh& mesh, const RemeshOptions& options, RemeshDecision& decision,
                    Report& report) {
    Mesh surface = remeshed(mesh, options, report);
    const Bounds bounds = bounds_of(mesh);
    const glm::dvec3 size = glm::dvec3(bounds.max) - glm::dvec3(bounds.min);
    decision.cell = std::max({size.x, size.y, size.z}) / options.resolution;
    decision.triangles = surface.triangles.size();
    decision.distance = distance_of(mesh, surface);
    return surface;
}

std::optional<Mesh> better_surface(const Mesh& mesh, const RemeshOptions& options,
                                   RemeshDecision& decision, Report& report) {
    std::vector<std::string> exceeded;
    for (const RemeshCriterion& criterion : decision.criteria) {
        if (criterion.is_exceeded()) exceeded.push_back(criterion.name);
    }
    if (exceeded.empty()) {
        decision.reason = "no figure exceeds its limit";
        return {};
    }
    const auto keep = [&](const std::string& reason) {
        decision.reason = reason;
        report.add("triangles that exceed a limit for remeshing", "mesh", 0,
                   fmt::format("are kept: {}", reason));
    };
    Report of_surface;
    std::optional<Mesh> surface;
    try {
        surface = closed_surface(mesh, options, decision, of_surface);
    } catch (const InvalidInput& error) {
        keep(error.what());
        return {};
    }
    const RemeshDistance& distance = *decision.distance;
    const double rms = std::max(distance.rms_of_source, distance.rms_of_surface) / decision.cell;
    const double max = std::max(distance.max_of_source, distance.max_of_surface) / decision.cell;
    const double grown = options.shell ? remesh_shell : 0.0;
    if (rms > max_remesh_rms + grown || max > max_remesh_distance + grown) {
        const bool is_lost = distance.max_of_source > distance.max_of_surface;
        keep(fmt::format(
            "a closed surface would be up to {:.3g} cells away, with a root mean square of {:.3g}, "
            "but at most {:g} and {:g} are permitted{}",
            max, rms, max_remesh_distance + grown, max_remesh_rms + grown,
            is_lost && !options.shell ? "; shells would keep what encloses nothing" : ""));
        return {};
    }
    decision.is_remeshed = true;
    decision.reason = fmt::format("{} {} the limit", fmt::join(exceeded, ", "),
                                  exceeded.size() == 1 ? "exceeds" : "exceed");
    for (const Finding& finding : of_surface.findings())
        report.add(finding);
    return surface;
}

}  // namespace relief::make::detail
