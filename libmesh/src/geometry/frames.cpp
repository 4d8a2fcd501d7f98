// SPDX-License-Identifier: Apache-2.0
// Computes normals, then tangents, for a whole mesh. Each step may split vertices, and all other
// attributes follow. Object space. Invalid values are counted by the steps and here; they are
// repaired only on request.
//
// Vertices are split by the values at their corners. The different values at a vertex are sorted:
// the smallest stays with the vertex, and each other one gets a copy. So the number and the order
// of copies do not depend on the order of triangles. The time is linear except for sorting.
#include "relief/mesh/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/check_triangles.h"
#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/smooth_fans.h"
#include "geometry/triangle_stacks.h"
#include "geometry/value_order.h"
#include "geometry/vertex_tangents.h"
#include "geometry/weld.h"
#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relaxed_store.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"
#include "work_array.h"

namespace relief {
using namespace relief::detail;

namespace {

/// One corner of each vertex, and the vertices with corners that have another value.
struct CornerSurvey {
    std::vector<Corner> any_corner;          ///< no_corner for isolated vertices.
    std::vector<std::uint8_t> is_differing;  ///< By vertex, 1 if values differ.
    bool any_differing = false;
};

/// \param values  three per triangle
template <typename T>
CornerSurvey survey_corners(std::size_t vertex_count, std::span<const glm::uvec3> triangles,
                            std::span<const T> values) {
    constexpr std::size_t grain = 16384;
    CornerSurvey survey;
    reserve_to_fill(survey.any_corner, vertex_count);
    survey.any_corner.resize(vertex_count, no_corner);
    survey.is_differing.resize(vertex_count, 0);
    // Which corner is the last one depends on the order of threads, but not what follows from it.
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            for (int i = 0; i < 3; ++i) {
                relaxed_store(survey.any_corner[triangles[t][i]],
                              static_cast<Corner>(3 * t) + static_cast<Corner>(i));
            }
        }
    });
    std::atomic<bool> any_differing = false;
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        bool differs = false;
        for (std::size_t t = begin; t < end; ++t) {
            for (int i = 0; i < 3; ++i) {
                const std::uint32_t vertex = triangles[t][i];
                const std::size_t corner = 3 * t + static_cast<std::size_t>(i);
                if (compare_values(values[corner], values[survey.any_corner[vertex]]) == 0)
                    continue;
                relaxed_store(survey.is_differing[vertex], 1);
                differs = true;
            }
        }
        if (differs) any_differing = true;
    });
    survey.any_differing = any_differing;
    return survey;
}

/// Splits the vertices whose corners differ, and sets the vertices of triangles.
/// \return the old vertex of each copy, which follow the old vertices
template <typename T>
std::vector<std::uint32_t> split_differing(const CornerSurvey& survey, std::span<const T> values,
                                           std::vector<glm::uvec3>& triangles) {
    std::vector<std::uint32_t> copied;
    if (!survey.any_differing) return copied;
    const std::size_t vertex_count = survey.is_differing.size();
    const CornersByVertex corners(vertex_count, triangles, [&](std::size_t t) {
        const glm::uvec3& triangle = triangles[t];
        return (survey.is_differing[triangle.x] | survey.is_differing[triangle.y] |
                survey.is_differing[triangle.z]) != 0;
    });
    std::vector<Corner> around;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        check_cancelled(v);
        if (survey.is_differing[v] == 0) continue;
        around.assign(corners.at(v).begin(), corners.at(v).end());
        std::sort(around.begin(), around.end(),
                  [&](Corner a, Corner b) { return compare_values(values[a], values[b]) < 0; });
        auto vertex = static_cast<std::uint32_t>(v);
        for (std::size_t i = 1; i < around.size(); ++i) {
            if (compare_values(values[around[i - 1]], values[around[i]]) != 0) {
                vertex = static_cast<std::uint32_t>(vertex_count + copied.size());
                copied.push_back(static_cast<std::uint32_t>(v));
            }
            const Corner corner = around[i];
            triangles[triangle_of(corner)][static_cast<int>(corner % 3)] = vertex;
        }
    }
    return copied;
}

template <int N>
VertexSplit split(std::size_t vertex_count, std::span<const glm::uvec3> triangles,
                  std::span<const glm::vec<N, float>> values) {
    check_triangles(triangles, vertex_count);
    if (values.size() != 3 * triangles.size()) {
        throw InvalidInput(fmt::format("there are {} corner values, but {} corners", values.size(),
                                       3 * triangles.size()));
    }
    VertexSplit result{std::vector<std::uint32_t>(vertex_count),
                       {triangles.begin(), triangles.end()}};
    std::iota(result.source_vertex.begin(), result.source_vertex.end(), 0U);
    const auto copied =
        split_differing(survey_corners(vertex_count, triangles, values), values, result.triangles);
    result.source_vertex.insert(result.source_vertex.end(), copied.begin(), copied.end());
    return result;
}

}  // namespace

VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec4> corner_values) {
    return split<4>(vertex_count, triangles, corner_values);
}

VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec3> corner_values) {
    return split<3>(vertex_count, triangles, corner_values);
}

Mesh carried(const Mesh& mesh, const VertexSplit& split) {
    check_cancelled();
    Mesh result;
    result.name = mesh.name;
    result.positions = carried<glm::vec3>(mesh.positions, split);
    result.normals = carried<glm::vec3>(mesh.normals, split);
    result.texcoords = carried<glm::vec2>(mesh.texcoords, split);
    result.texcoords_2 = carried<glm::vec2>(mesh.texcoords_2, split);
    result.tangents = carried<glm::vec4>(mesh.tangents, split);
    result.colors = carried<glm::vec4>(mesh.colors, split);
    result.triangles = split.triangles;
    result.material_ranges = mesh.material_ranges;
    result.smoothing_groups = mesh.smoothing_groups;
    return result;
}

namespace {

void check_options(const Mesh& mesh, const FrameOptions& options) {
    validate(mesh);
    if (options.if_missing == NormalMode::keep) {
        throw InvalidInput("normals that are missing cannot be kept: if_missing must name a mode");
    }
    if (options.tangents == TangentMethod::triangle)
        throw InvalidInput("tangents of single triangles can be identified, but not computed");
    if (computes_tangents(options.tangents) && mesh.texcoords.empty() && !mesh.positions.empty()) {
        throw InvalidInput("tangents need texture coordinates, but the mesh has none");
    }
}

/// Appends copies of values by vertex; an absent (empty) attribute stays absent.
template <typename T>
void append_copies(std::vector<T>& values, std::span<const std::uint32_t> copied) {
    if (values.empty() || copied.empty()) return;
    std::vector<T> extended;
    reserve_to_fill(extended, values.size() + copied.size());
    extended.insert(extended.end(), values.begin(), values.end());
    for (const std::uint32_t vertex : copied)
        extended.push_back(values[vertex]);
    values = std::move(extended);
}

/// Appends copies of vertices, with all their attributes.
void append_vertices(FramedMesh& framed, std::span<const std::uint32_t> copied) {
    Mesh& mesh = framed.mesh;
    append_copies(framed.source_vertex, copied);
    append_copies(mesh.positions, copied);
    append_copies(mesh.normals, copied);
    append_copies(mesh.texcoords, copied);
    append_copies(mesh.texcoords_2, copied);
    append_copies(mesh.tangents, copied);
    append_copies(mesh.colors, copied);
}

/// Splits vertices whose corners have different values, then stores the values by vertex. A vertex
/// without a corner gets the value of `isolated`. -0 becomes +0, so that it does not distinguish
/// vertices. Most meshes need few copies, so that arrays are not copied as a whole.
template <typename T, typename Isolated>
void store_corners(FramedMesh& framed, std::span<const T> values, std::vector<T> Mesh::*attribute,
                   const Isolated& isolated) {
    Mesh& mesh = framed.mesh;
    (mesh.*attribute).clear();
    const CornerSurvey survey = survey_corners<T>(mesh.positions.size(), mesh.triangles, values);
    append_vertices(framed, split_differing(survey, values, mesh.triangles));
    std::vector<T> stored;
    reserve_to_fill(stored, mesh.positions.size());
    for (const Corner corner : survey.any_corner)
        stored.push_back(corner == no_corner ? T(0.0F) : values[corner] + 0.0F);
    stored.resize(mesh.positions.size(), T(0.0F));
    // The corners of split vertices have other values.
    for (std::size_t corner = 0; survey.any_differing && corner < values.size(); ++corner) {
        check_cancelled(corner);
        stored[vertex_of(static_cast<Corner>(corner), mesh.triangles)] = values[corner] + 0.0F;
    }
    for (std::size_t v = 0; v < stored.size(); ++v) {
        if (stored[v] == T(0.0F)) stored[v] = isolated(v);
    }
    mesh.*attribute = std::move(stored);
}

/// Stores corner normals as vertex normals and splits vertices as needed.
void store_corner_normals(FramedMesh& framed, const std::vector<glm::vec3>& at_corners,
                          Report& report) {
    store_corners<glm::vec3>(framed, at_corners, &Mesh::normals, [&](std::size_t vertex) {
        report.add("isolated vertex", "vertex", vertex, "gets the normal (0,0,1)");
        return glm::vec3(0.0F, 0.0F, 1.0F);
    });
}

void make_flat(FramedMesh& framed, Report& report) {
    const std::vector<glm::vec3> flat =
        triangle_normals(framed.mesh.positions, framed.mesh.triangles, report);
    std::vector<glm::vec3> at_corners;
    at_corners.reserve(3 * flat.size());
    for (const glm::vec3& normal : flat)
        at_corners.insert(at_corners.end(), 3, normal);
    store_corner_normals(framed, at_corners, report);
}

/// Returns whether triangles of opposite winding are at the same positions.
bool has_doubled_triangles(const Mesh& mesh) {
    const std::vector<std::uint32_t> classes = weld_positions(mesh.positions);
    const std::vector<std::uint32_t> stacks = triangle_stacks(mesh.triangles, classes);
    const auto welded = [&](std::size_t t) {
        const glm::uvec3& triangle = mesh.triangles[t];
        return glm::uvec3(classes[triangle.x], classes[triangle.y], classes[triangle.z]);
    };
    for (std::size_t t = 0; t < stacks.size(); ++t) {
        if (stacks[t] != t && are_opposite(welded(t), welded(stacks[t]))) return true;
    }
    return false;
}

void make_averaged(FramedMesh& framed, NormalMode mode, const FrameOptions& options,
                   Report& report) {
    Mesh& mesh = framed.mesh;
    const std::optional<NormalWeight> weight = mode.weight();
    NormalOptions how;
    how.weld_tolerance = options.weld_tolerance;
    const bool has_groups = options.smoothing_groups &&
                            std::any_of(mesh.smoothing_groups.begin(), mesh.smoothing_groups.end(),
                                        [](std::uint32_t group) { return group != 0; });
    framed.within_smoothing_groups = has_groups;
    if (options.crease_angle || has_groups) {
        HardEdges hard_edges{options.crease_angle, {}};
        if (has_groups) hard_edges.smoothing_groups = mesh.smoothing_groups;
        const CornerNormals corners =
            corner_normals(mesh.positions, mesh.triangles, weight, how, hard_edges, report);
        framed.normals_by_area = corners.by_area;
        store_corner_normals(framed, corners.normals, report);
    } else if (options.weld_tolerance == 0.0 && has_doubled_triangles(mesh)) {
        const CornerNormals corners =
            side_normals(mesh.positions, mesh.triangles, weight, how, report);
        framed.normals_by_area = corners.by_area;
        store_corner_normals(framed, corners.normals, report);
    } else if (weight) {
        how.weight = *weight;
        mesh.normals = vertex_normals(mesh.positions, mesh.triangles, how, report);
    } else {
        ChosenNormals chosen = chosen_normals(mesh.positions, mesh.triangles, how, report);
        framed.normals_by_area = chosen.by_area;
        mesh.normals = std::move(chosen.normals);
    }
}

enum class KeptNormal { sound, not_unit, zero, non_finite };

KeptNormal judge(const glm::vec3& normal) {
    const double length = glm::length(glm::dvec3(normal));
    if (!std::isfinite(length)) return KeptNormal::non_finite;
    if (length == 0.0) return KeptNormal::zero;
    return std::abs(length - 1.0) > unit_tolerance ? KeptNormal::not_unit : KeptNormal::sound;
}

void report_kept(std::span<const glm::vec3> normals, bool repaired, Report& report) {
    for (std::size_t v = 0; v < normals.size(); ++v) {
        check_cancelled(v);
        switch (judge(normals[v])) {
            case KeptNormal::sound:
                break;
            case KeptNormal::not_unit:
                report.add("normal not of unit length", "vertex", v,
                           repaired ? "scaled" : "kept as it is");
                break;
            case KeptNormal::zero:
                report.add("zero normal", "vertex", v,
                           repaired ? "averaged again" : "kept as it is");
                break;
            case KeptNormal::non_finite:
                report.add("non-finite normal", "vertex", v,
                           repaired ? "averaged again" : "kept as it is");
                break;
        }
    }
}

/// Repairs only invalid normals. Other vertices keep their bits.
void repair_kept(Mesh& mesh, const FrameOptions& options, Report& report) {
    std::vector<glm::vec3> averaged;
    Report rest;
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        glm::vec3& normal = mesh.normals[v];
        const KeptNormal kind = judge(normal);
        if (kind == KeptNormal::sound) continue;
        if (kind == KeptNormal::not_unit) {
            normal = rounded(direction_or_zero(glm::dvec3(normal)));
            continue;
        }
        if (averaged.empty()) {
            NormalOptions how;
            how.weight = options.if_missing.weight().value_or(NormalWeight::angle);
            how.weld_tolerance = options.weld_tolerance;
            averaged = vertex_normals(mesh.positions, mesh.triangles, how, rest);
        }
        normal = averaged[v];
    }
    report.merge(rest);
}

void make_normals(FramedMesh& framed, NormalMode mode, const FrameOptions& options,
                  Report& report) {
    if (mode == NormalMode::keep) {
        report_kept(framed.mesh.normals, options.repair, report);
        if (options.repair) repair_kept(framed.mesh, options, report);
    } else if (mode == NormalMode::flat) {
        make_flat(framed, report);
    } else {
        make_averaged(framed, mode, options, report);
    }
}

/// Returns the tangent of a vertex without a triangle.
glm::vec4 isolated_tangent(const Mesh& mesh, std::size_t vertex, Report& report) {
    report.add("tangent of an isolated vertex", "vertex", vertex,
               "is a fixed direction perpendicular to its normal");
    return {perpendicular_to(mesh.normals[vertex]), -1.0F};
}

void store_corner_tangents(FramedMesh& framed, std::span<const glm::vec4> at_corners,
                           Report& report) {
    store_corners<glm::vec4>(framed, at_corners, &Mesh::tangents, [&](std::size_t vertex) {
        return isolated_tangent(framed.mesh, vertex, report);
    });
}

/// Does the same for tangents by vertex, with some triangles whose corners may differ.
void store_vertex_tangents(FramedMesh& framed, VertexTangents tangents, Report& report) {
    Mesh& mesh = framed.mesh;
    std::vector<glm::uvec3> triangles;
    triangles.reserve(tangents.triangles.size());
    for (const std::uint32_t t : tangents.triangles)
        triangles.push_back(mesh.triangles[t]);
    if (!triangles.empty()) {
        const std::span<const glm::vec4> values = tangents.at_corners;
        const CornerSurvey survey = survey_corners(mesh.positions.size(), triangles, values);
        append_vertices(framed, split_differing(survey, values, triangles));
        tangents.by_vertex.resize(mesh.positions.size());
        for (Corner corner = 0; corner < values.size(); ++corner)
            tangents.by_vertex[vertex_of(corner, triangles)] = values[corner];
        for (std::size_t i = 0; i < triangles.size(); ++i)
            mesh.triangles[tangents.triangles[i]] = triangles[i];
    }
    for (std::size_t v = 0; v < tangents.by_vertex.size(); ++v) {
        glm::vec4& tangent = tangents.by_vertex[v];
        tangent = tangent == glm::vec4(0.0F) ? isolated_tangent(mesh, v, report) : tangent + 0.0F;
    }
    mesh.tangents = std::move(tangents.by_vertex);
}

void make_tangents(FramedMesh& framed, TangentMethod mode, Report& report) {
    Mesh& mesh = framed.mesh;
    const auto store_by = [&](const auto& method) {
        const std::vector<glm::vec4> tangents =
            method(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
        store_corner_tangents(framed, tangents, report);
    };
    if (mode == TangentMethod::area_weighted) return store_by(area_weighted_tangents);
    if (mode == TangentMethod::lengyel) return store_by(lengyel_tangents);
    VertexTangents tangents =
        tangents_by_vertex({mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles}, report);
    if (!tangents.by_vertex.empty())
        store_vertex_tangents(framed, std::move(tangents), report);
    else
        store_corner_tangents(framed, tangents.at_corners, report);
}

/// Resolves `keep` for tangents. Tangents belong to the normals from which they were computed, so a
/// mesh with new normals gets new tangents if it has texture coordinates.
TangentMethod resolved_tangents(const Mesh& mesh, TangentMethod tangents, NormalMode normals,
                                Report& report) {
    const bool outdated = tangents == TangentMethod::keep && normals != NormalMode::keep;
    if (!outdated || mesh.tangents.empty()) return tangents;
    if (!mesh.texcoords.empty()) return TangentMethod::mikktspace;
    report.add("tangents of other normals", "mesh", 0,
               "are removed: without texture coordinates there can be no new ones");
    return TangentMethod::none;
}

}  // namespace

FramedMesh with_frames(Mesh mesh, const FrameOptions& options, Report& report) {
    check_options(mesh, options);
    const bool has_normals = !mesh.normals.empty();
    const NormalMode mode =
        options.normals == NormalMode::keep && !has_normals ? options.if_missing : options.normals;

    FramedMesh framed;
    framed.mesh = std::move(mesh);
    framed.source_vertex.resize(framed.mesh.positions.size());
    std::iota(framed.source_vertex.begin(), framed.source_vertex.end(), 0U);

    const TangentMethod tangents = resolved_tangents(framed.mesh, options.tangents, mode, report);
    if (tangents != TangentMethod::keep) framed.mesh.tangents.clear();
    {
        const ProgressStage stage("normals");
        make_normals(framed, mode, options, report);
    }
    if (computes_tangents(tangents)) make_tangents(framed, tangents, report);
    return framed;
}

}  // namespace relief
