// SPDX-License-Identifier: Apache-2.0
// Diagnosis of a mesh: the names of all conditions, and the checks of triangles, positions, texture
// coordinates, normals and tangents. diagnose_edges.cpp and diagnose_near_duplicates.cpp have the
// longer checks.
//
// Edges are computed in double precision, so no scale of float positions overflows or underflows.
// Texture coordinates are checked by the rules of tangents.h, for triangles that have an area.
#include "relief/mesh/diagnose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "geometry/direction.h"
#include "geometry/texture_gradient.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "progress_stage.h"
#include "topology/diagnose_parts.h"

namespace relief {
using namespace relief::detail;

namespace {

using enum Severity;

constexpr std::array all_mesh_conditions = {
    MeshConditionInfo{MeshCondition::triangle_not_finite, "triangle with a non-finite corner",
                      "triangle", problem, "has no area, no normal and no position"},
    MeshConditionInfo{MeshCondition::triangle_collapsed, "collapsed triangle", "triangle", problem,
                      "has two corners at the same position, so no area and no normal"},
    MeshConditionInfo{MeshCondition::triangle_collinear, "collinear triangle", "triangle", problem,
                      "has collinear corners, so no area and no normal"},
    MeshConditionInfo{MeshCondition::triangle_needle, "needle triangle", "triangle", note,
                      "is so narrow that the rounding of its corners changes its normal"},
    MeshConditionInfo{MeshCondition::triangle_repeated, "repeated triangle", "triangle", problem,
                      "is equal to an earlier triangle and counts twice"},
    MeshConditionInfo{MeshCondition::triangle_two_sided, "double-sided triangle", "triangle", note,
                      "is the back face of another triangle: their normals cancel"},
    MeshConditionInfo{MeshCondition::edge_non_manifold, "non-manifold edge", "edge of triangle",
                      problem, "has three or more triangles, so inside and outside are undefined"},
    MeshConditionInfo{MeshCondition::edge_flipped, "flipped neighbors", "edge of triangle", problem,
                      "one of its two triangles is inverted"},
    MeshConditionInfo{MeshCondition::edge_folded, "folded edge", "edge of triangle", note,
                      "its two triangles lie on each other, back to back"},
    MeshConditionInfo{MeshCondition::edge_boundary, "boundary edge", "edge of triangle", note,
                      "has one triangle: the surface is open"},
    MeshConditionInfo{MeshCondition::vertex_not_finite, "non-finite position", "vertex", problem,
                      "has no position"},
    MeshConditionInfo{MeshCondition::vertex_isolated, "isolated vertex", "vertex", problem,
                      "belongs to no triangle, so its normal is undefined"},
    MeshConditionInfo{MeshCondition::vertex_degenerate_fan, "vertex with only degenerate triangles",
                      "vertex", problem, "has only triangles without a normal"},
    MeshConditionInfo{MeshCondition::vertex_bow_tie, "bow-tie vertex", "vertex", note,
                      "joins several surfaces in a point: their normals are averaged"},
    MeshConditionInfo{MeshCondition::vertex_near_duplicate, "near-duplicate vertex", "vertex", note,
                      "is nearly equal to another vertex: their normals are not averaged"},
    MeshConditionInfo{MeshCondition::normal_not_finite, "non-finite normal", "vertex", problem,
                      "is not a direction"},
    MeshConditionInfo{MeshCondition::normal_zero, "zero normal", "vertex", problem,
                      "is not a direction"},
    MeshConditionInfo{MeshCondition::normal_not_unit, "normal not of unit length", "vertex",
                      problem, "shades too bright or too dark"},
    MeshConditionInfo{MeshCondition::normal_opposed, "normal against its triangles", "vertex",
                      problem, "points to the back of all its triangles"},
    MeshConditionInfo{MeshCondition::normal_inconsistent, "normal against one of its triangles",
                      "vertex", note, "points to the back of some of its triangles"},
    MeshConditionInfo{MeshCondition::tangent_not_finite, "non-finite tangent", "vertex", problem,
                      "is not a direction"},
    MeshConditionInfo{MeshCondition::tangent_not_unit, "tangent not of unit length", "vertex",
                      problem, "changes the directions of a normal map"},
    MeshConditionInfo{MeshCondition::tangent_invalid_sign, "tangent without handedness", "vertex",
                      problem, "has a w that is neither 1 nor -1, so there is no bitangent"},
    MeshConditionInfo{MeshCondition::tangent_along_normal, "tangent along its normal", "vertex",
                      problem, "spans no tangent plane with it"},
    MeshConditionInfo{MeshCondition::tangent_not_perpendicular,
                      "tangent not perpendicular to its normal", "vertex", note,
                      "changes the directions of a normal map by the same angle"},
    MeshConditionInfo{MeshCondition::texture_not_finite, "non-finite texture coordinate", "vertex",
                      problem, "has no position in the image"},
    MeshConditionInfo{MeshCondition::texture_degenerate, "triangle without texture gradient",
                      "triangle", problem, "has no area in the image, so it defines no tangents"},
    MeshConditionInfo{MeshCondition::texture_mirrored, "mirrored texture", "triangle", note,
                      "shows the image mirrored"},
    MeshConditionInfo{MeshCondition::texture_overlapping, "overlapping texture", "triangle", note,
                      "shares texels with another triangle: a bake is ambiguous"},
    MeshConditionInfo{MeshCondition::mesh_far_away, "far from the origin", "mesh", note,
                      "float precision at this distance loses details of the shape"},
    MeshConditionInfo{MeshCondition::texture_far_away, "texture far from its origin", "mesh", note,
                      "float precision at this distance distorts the image"},
};

/// Checks that the table is in the order of the enumeration.
constexpr bool are_in_order() {
    for (std::size_t i = 0; i < all_mesh_conditions.size(); ++i) {
        if (all_mesh_conditions[i].condition != static_cast<MeshCondition>(i)) return false;
    }
    return all_mesh_conditions.back().condition == MeshCondition::texture_far_away;
}
static_assert(are_in_order());

}  // namespace

std::span<const MeshConditionInfo> mesh_conditions() {
    return all_mesh_conditions;
}

const MeshConditionInfo& condition_info(MeshCondition condition) {
    return all_mesh_conditions[static_cast<std::size_t>(condition)];
}

namespace {

// Width divided by longest edge. The first is the limit of normals.h. At the second, float rounding
// (6e-8) rotates the normal by 0.03 degrees.
constexpr double collinear_width = 1e-12;
constexpr double needle_width = 1e-4;

TriangleShape shape_of(const glm::uvec3& classes, const glm::vec3 (&corners)[3],
                       glm::vec3& normal) {
    normal = glm::vec3(0.0F);
    for (const glm::vec3& corner : corners) {
        if (!is_finite(corner)) return TriangleShape::not_finite;
    }
    if (classes.x == classes.y || classes.y == classes.z || classes.z == classes.x)
        return TriangleShape::collapsed;
    const glm::dvec3 a = glm::dvec3(corners[1]) - glm::dvec3(corners[0]);
    const glm::dvec3 b = glm::dvec3(corners[2]) - glm::dvec3(corners[0]);
    const glm::dvec3 c = b - a;
    const glm::dvec3 area = glm::cross(a, b);
    const double size = glm::length(area);
    const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
    if (!(size > collinear_width * longest)) return TriangleShape::collinear;
    normal = glm::vec3(area / size);
    return size > needle_width * longest ? TriangleShape::sound : TriangleShape::needle;
}

}  // namespace

DiagnosedMesh::DiagnosedMesh(const Mesh& diagnosed)
    : mesh(diagnosed),
      classes(weld_positions(mesh.positions)),
      triangles(welded_triangles(mesh.triangles, classes)),
      shapes(triangles.size()),
      normals(triangles.size()) {
    parallel_for(triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::uvec3& corners = triangles[t];
            shapes[t] = shape_of(
                corners,
                {mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]},
                normals[t]);
        }
    });
}

void detail::diagnose_triangles(const DiagnosedMesh& diagnosed, Tally& tally) {
    for (std::size_t t = 0; t < diagnosed.shapes.size(); ++t) {
        check_cancelled(t);
        switch (diagnosed.shapes[t]) {
            case TriangleShape::sound:
                break;
            case TriangleShape::needle:
                tally.add(MeshCondition::triangle_needle, t);
                break;
            case TriangleShape::collinear:
                tally.add(MeshCondition::triangle_collinear, t);
                break;
            case TriangleShape::collapsed:
                tally.add(MeshCondition::triangle_collapsed, t);
                break;
            case TriangleShape::not_finite:
                tally.add(MeshCondition::triangle_not_finite, t);
                break;
        }
    }
}

namespace {

/// Best normal that any triangle gives a position class.
enum class Use : std::uint8_t { none, without_area, with_area };

std::vector<Use> uses_of(const DiagnosedMesh& diagnosed) {
    std::vector<Use> uses(diagnosed.classes.size(), Use::none);
    for (std::size_t t = 0; t < diagnosed.triangles.size(); ++t) {
        check_cancelled(t);
        const Use use = has_area(diagnosed.shapes[t]) ? Use::with_area : Use::without_area;
        for (int i = 0; i < 3; ++i) {
            Use& most = uses[diagnosed.triangles[t][i]];
            if (most < use) most = use;
        }
    }
    return uses;
}

}  // namespace

void detail::diagnose_vertices(const DiagnosedMesh& diagnosed, Tally& tally) {
    const std::vector<Use> uses = uses_of(diagnosed);
    for (std::size_t v = 0; v < diagnosed.classes.size(); ++v) {
        check_cancelled(v);
        const Use use = uses[diagnosed.classes[v]];
        if (!is_finite(diagnosed.mesh.positions[v]))
            tally.add(MeshCondition::vertex_not_finite, v);
        else if (use == Use::none)
            tally.add(MeshCondition::vertex_isolated, v);
        else if (use == Use::without_area)
            tally.add(MeshCondition::vertex_degenerate_fan, v);
    }
}

void detail::diagnose_texture(const DiagnosedMesh& diagnosed, Tally& tally) {
    const Mesh& mesh = diagnosed.mesh;
    if (mesh.texcoords.empty()) return;
    for (std::size_t v = 0; v < mesh.texcoords.size(); ++v) {
        check_cancelled(v);
        if (!is_finite(mesh.texcoords[v])) tally.add(MeshCondition::texture_not_finite, v);
    }
    const std::vector<Gradient> gradients =
        gradient_kinds(mesh.positions, mesh.texcoords, mesh.triangles);
    for (std::size_t t = 0; t < gradients.size(); ++t) {
        check_cancelled(t);
        if (!has_area(diagnosed.shapes[t])) continue;
        if (gradients[t] == Gradient::none) tally.add(MeshCondition::texture_degenerate, t);
        if (gradients[t] == Gradient::mirrored) tally.add(MeshCondition::texture_mirrored, t);
    }
}

namespace {

// Cosine below which a normal is perpendicular to a triangle within rounding.
constexpr float sidewise = 1e-3F;

// Cosine between normal and tangent at which the rest of the tangent could be an artifact of 8-bit
// storage.
constexpr double along_normal = 0.999;

bool is_unit(double length) {
    return std::abs(length - 1.0) <= unit_tolerance;
}

/// Orientations of the triangles of a vertex relative to its normal.
struct Facing {
    std::uint8_t before : 1 = 0;  ///< A triangle faces in the direction of the normal.
    std::uint8_t beside : 1 = 0;  ///< A triangle is edge-on.
    std::uint8_t behind : 1 = 0;  ///< A triangle faces away.
};

/// Skips triangles that are too narrow for a reliable normal.
std::vector<Facing> facings_of(const DiagnosedMesh& diagnosed) {
    std::vector<Facing> facings(diagnosed.mesh.positions.size());
    for (std::size_t t = 0; t < diagnosed.shapes.size(); ++t) {
        check_cancelled(t);
        if (diagnosed.shapes[t] != TriangleShape::sound) continue;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t vertex = diagnosed.mesh.triangles[t][i];
            const float cosine = glm::dot(diagnosed.normals[t], diagnosed.mesh.normals[vertex]);
            Facing& facing = facings[vertex];
            if (cosine > sidewise)
                facing.before = 1;
            else if (cosine < -sidewise)
                facing.behind = 1;
            else
                facing.beside = 1;
        }
    }
    return facings;
}

void diagnose_normals(const DiagnosedMesh& diagnosed, Tally& tally) {
    const std::vector<Facing> facings = facings_of(diagnosed);
    for (std::size_t v = 0; v < diagnosed.mesh.normals.size(); ++v) {
        check_cancelled(v);
        const glm::vec3& normal = diagnosed.mesh.normals[v];
        if (!is_finite(normal)) {
            tally.add(MeshCondition::normal_not_finite, v);
            continue;
        }
        if (normal == glm::vec3(0.0F)) {
            tally.add(MeshCondition::normal_zero, v);
            continue;
        }
        if (!is_unit(glm::length(glm::dvec3(normal)))) tally.add(MeshCondition::normal_not_unit, v);
        const Facing facing = facings[v];
        if (facing.behind != 0 && facing.before == 0 && facing.beside == 0)
            tally.add(MeshCondition::normal_opposed, v);
        else if (facing.behind != 0 || facing.beside != 0)
            tally.add(MeshCondition::normal_inconsistent, v);
    }
}

/// Angle between a tangent and the normal of its vertex, if both are valid.
void diagnose_slant(const Mesh& mesh, std::size_t vertex, Tally& tally) {
    if (mesh.normals.empty()) return;
    const glm::dvec3 tangent = direction_or_zero(glm::dvec3(mesh.tangents[vertex]));
    const glm::dvec3 normal = direction_or_zero(glm::dvec3(mesh.normals[vertex]));
    const double cosine = std::abs(glm::dot(tangent, normal));
    if (cosine > along_normal)
        tally.add(MeshCondition::tangent_along_normal, vertex);
    else if (cosine > leaning_tolerance)
        tally.add(MeshCondition::tangent_not_perpendicular, vertex);
}

void diagnose_tangents(const Mesh& mesh, Tally& tally) {
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v) {
        check_cancelled(v);
        const glm::vec4& tangent = mesh.tangents[v];
        if (!is_finite(tangent)) {
            tally.add(MeshCondition::tangent_not_finite, v);
            continue;
        }
        if (!is_unit(glm::length(glm::dvec3(tangent))))
            tally.add(MeshCondition::tangent_not_unit, v);
        if (std::abs(tangent.w) != 1.0F) tally.add(MeshCondition::tangent_invalid_sign, v);
        diagnose_slant(mesh, v, tally);
    }
}

}  // namespace

void detail::diagnose_frames(const DiagnosedMesh& diagnosed, Tally& tally) {
    if (!diagnosed.mesh.normals.empty()) diagnose_normals(diagnosed, tally);
    diagnose_tangents(diagnosed.mesh, tally);
}

namespace {

constexpr std::size_t small_mesh = 2048;

// Relative spacing above which fewer than 16 of a float's 24 bits remain: the steps become visible
// in shading and texture.
constexpr float coarsest = 1.0F / 65536.0F;

/// Bounding box of all finite points, and the spacing of floats there.
template <int N>
struct PointExtent {
    float size = 0.0F;     ///< Longest side.
    float spacing = 0.0F;  ///< Spacing of adjacent floats at the largest coordinate.

    explicit PointExtent(std::span<const glm::vec<N, float>> points) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        glm::vec<N, float> low(infinity);
        glm::vec<N, float> high(-infinity);
        for (const auto& point : points) {
            if (!is_finite(point)) continue;
            low = glm::min(low, point);
            high = glm::max(high, point);
        }
        if (!(low.x <= high.x)) return;
        float farthest = 0.0F;
        for (int i = 0; i < N; ++i) {
            farthest = std::max({farthest, std::abs(low[i]), std::abs(high[i])});
            // The values are halved, because the difference of two large floats can overflow.
            const float side = 0.5F * high[i] - 0.5F * low[i];
            size = std::max(size, std::min(side, 0x1.fffffep126F) * 2.0F);
        }
        spacing = farthest - std::nextafter(farthest, 0.0F);
    }

    [[nodiscard]] bool is_far() const { return size > 0.0F && spacing > coarsest * size; }
};

void diagnose_places(const Mesh& mesh, Diagnosis& diagnosis, Tally& tally) {
    const PointExtent<3> positions(mesh.positions);
    diagnosis.size = positions.size;
    diagnosis.spacing = positions.spacing;
    if (positions.is_far()) tally.add(MeshCondition::mesh_far_away, 0);
    if (PointExtent<2>(mesh.texcoords).is_far()) tally.add(MeshCondition::texture_far_away, 0);
}

/// Triangles that have an area in space. The corners of other triangles become equal, so that they
/// have no area in texture space either.
std::vector<glm::uvec3> drawn_triangles(const DiagnosedMesh& diagnosed) {
    std::vector<glm::uvec3> triangles = diagnosed.mesh.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        check_cancelled(t);
        if (!has_area(diagnosed.shapes[t])) triangles[t] = glm::uvec3(triangles[t].x);
    }
    return triangles;
}

void diagnose_overlap(const DiagnosedMesh& diagnosed, Diagnosis& diagnosis, Tally& tally) {
    const TextureOverlap overlap =
        texture_overlap(diagnosed.mesh.texcoords, drawn_triangles(diagnosed));
    diagnosis.overlap_raster = overlap.raster;
    for (std::size_t t = 0; t < overlap.overlapping.size(); ++t) {
        if (overlap.overlapping[t] != 0) tally.add(MeshCondition::texture_overlapping, t);
    }
}

}  // namespace

Tally::Tally(std::size_t listed) : listed_(listed) {
    for (const MeshConditionInfo& condition : mesh_conditions())
        conditions_.push_back({condition.condition, 0, {}});
}

void Tally::add(MeshCondition condition, std::size_t index) {
    MeshConditionCount& found = conditions_[static_cast<std::size_t>(condition)];
    ++found.count;
    if (found.first.size() < listed_ && (found.first.empty() || found.first.back() != index))
        found.first.push_back(index);
}

void Tally::merge(const Tally& other) {
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
        if (other.conditions_[i].count != 0) conditions_[i] = other.conditions_[i];
    }
}

std::vector<MeshConditionCount> Tally::found() const {
    std::vector<MeshConditionCount> found;
    std::copy_if(conditions_.begin(), conditions_.end(), std::back_inserter(found),
                 [](const MeshConditionCount& condition) { return condition.count != 0; });
    return found;
}

std::size_t Diagnosis::count(MeshCondition condition) const {
    for (const MeshConditionCount& one : conditions) {
        if (one.condition == condition) return one.count;
    }
    return 0;
}

bool Diagnosis::has_problem() const {
    return std::any_of(conditions.begin(), conditions.end(), [](const MeshConditionCount& one) {
        return condition_info(one.condition).severity == Severity::problem;
    });
}

Diagnosis diagnose(const Mesh& mesh, const DiagnoseOptions& options) {
    validate(mesh);
    const DiagnosedMesh diagnosed(mesh);
    Diagnosis diagnosis;
    const std::vector<std::function<void(Tally&)>> parts = {
        [&](Tally& tally) { diagnose_triangles(diagnosed, tally); },
        [&](Tally& tally) {
            if (options.edges) diagnose_edges(diagnosed, tally);
        },
        [&](Tally& tally) { diagnose_vertices(diagnosed, tally); },
        [&](Tally& tally) {
            if (options.near_duplicates) diagnose_near_duplicates(diagnosed, tally);
        },
        [&](Tally& tally) { diagnose_frames(diagnosed, tally); },
        [&](Tally& tally) { diagnose_texture(diagnosed, tally); },
        [&](Tally& tally) {
            if (options.texture_overlap && !mesh.texcoords.empty())
                diagnose_overlap(diagnosed, diagnosis, tally);
        },
        [&](Tally& tally) { diagnose_places(mesh, diagnosis, tally); },
    };
    std::vector<Tally> tallies(parts.size(), Tally(options.listed));
    std::vector<std::function<void()>> tasks;
    for (std::size_t i = 0; i < parts.size(); ++i)
        tasks.emplace_back([&, i] { parts[i](tallies[i]); });
    parallel_tasks(tasks, mesh.triangles.size() < small_mesh);

    Tally all(options.listed);
    for (const Tally& tally : tallies)
        all.merge(tally);
    diagnosis.conditions = all.found();
    return diagnosis;
}

Finding to_finding(const MeshConditionCount& count) {
    const MeshConditionInfo& words = condition_info(count.condition);
    return {std::string(words.word), std::string(words.element), std::string(words.meaning),
            count.count, count.first};
}

Report to_report(const Diagnosis& diagnosis, std::optional<Severity> severity) {
    Report report;
    for (const MeshConditionCount& one : diagnosis.conditions) {
        if (!severity || condition_info(one.condition).severity == *severity)
            report.add(to_finding(one));
    }
    return report;
}

}  // namespace relief
