// SPDX-License-Identifier: Apache-2.0
// Normals, then tangents, for a whole mesh; each step may split vertices, and everything else is
// carried along. Object space. Bad values are counted, by the steps and here; nothing is repaired.
// Tests: tests/mesh/geometry/frames_test.cpp.
#include "relief/mesh/frames.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "relief/mesh/error.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/split.h"
#include "relief/mesh/tangents.h"

namespace relief {
namespace {

// How far the length of a kept normal may be from 1: what 8-bit storage, the coarsest in use,
// leaves (half a step of 1/127 in each of three components), and no more.
constexpr double unit_tolerance = 0.007;

void check_options(const Mesh& mesh, const FrameOptions& options) {
    validate(mesh);
    if (options.if_missing == NormalMode::keep) {
        throw InvalidInput("normals that are missing cannot be kept: if_missing must name a mode");
    }
    if (options.tangents == TangentMode::mikktspace && mesh.texcoords.empty() &&
        !mesh.positions.empty()) {
        throw InvalidInput("tangents need texture coordinates, but the mesh has none");
    }
}

void report_kept(std::span<const glm::vec3> normals, Report& report) {
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const double length = glm::length(glm::dvec3(normals[v]));
        if (!std::isfinite(length)) {
            report.add("non-finite normal", "vertex", v, "kept as it is");
        } else if (std::abs(length - 1.0) > unit_tolerance) {
            report.add("normal not of unit length", "vertex", v, "kept as it is");
        }
    }
}

/// Splits vertices where the values at their corners differ, then stores these by vertex; a vertex
/// without a corner gets what `isolated` says. -0 becomes +0, so that it cannot tell vertices
/// apart.
template <typename T, typename Isolated>
void store_corners(FramedMesh& framed, const std::vector<T>& values,
                   std::vector<T> Mesh::*attribute, const Isolated& isolated) {
    Mesh& mesh = framed.mesh;
    (mesh.*attribute).clear();
    const VertexSplit split =
        split_where_corners_differ(mesh.positions.size(), mesh.triangles, values);
    framed.source_vertex = carried<std::uint32_t>(framed.source_vertex, split);
    mesh = carried(mesh, split);
    std::vector<T>& stored = mesh.*attribute;
    stored.resize(mesh.positions.size(), T(0.0F));
    for (std::size_t corner = 0; corner < values.size(); ++corner)
        stored[vertex_of(static_cast<Corner>(corner), mesh.triangles)] = values[corner] + 0.0F;
    for (std::size_t v = 0; v < stored.size(); ++v) {
        if (stored[v] == T(0.0F)) stored[v] = isolated(v);
    }
}

void make_flat(FramedMesh& framed, Report& report) {
    const std::vector<glm::vec3> flat =
        triangle_normals(framed.mesh.positions, framed.mesh.triangles, report);
    std::vector<glm::vec3> at_corners;
    at_corners.reserve(3 * flat.size());
    for (const glm::vec3& normal : flat)
        at_corners.insert(at_corners.end(), 3, normal);
    store_corners(framed, at_corners, &Mesh::normals, [&](std::size_t vertex) {
        report.add("isolated vertex", "vertex", vertex, "gets the normal (0,0,1)");
        return glm::vec3(0.0F, 0.0F, 1.0F);
    });
}

void make_normals(FramedMesh& framed, NormalMode mode, Report& report) {
    Mesh& mesh = framed.mesh;
    switch (mode) {
        case NormalMode::keep:
            report_kept(mesh.normals, report);
            break;
        case NormalMode::flat:
            make_flat(framed, report);
            break;
        case NormalMode::area:
            mesh.normals =
                vertex_normals(mesh.positions, mesh.triangles, NormalWeight::area, report);
            break;
        case NormalMode::angle:
            mesh.normals =
                vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, report);
            break;
    }
}

void make_tangents(FramedMesh& framed, Report& report) {
    const Mesh& mesh = framed.mesh;
    const std::vector<glm::vec4> tangents =
        mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
    store_corners(framed, tangents, &Mesh::tangents, [&](std::size_t vertex) {
        report.add("tangent of an isolated vertex", "vertex", vertex,
                   "is a fixed one perpendicular to its normal");
        return glm::vec4(perpendicular_to(framed.mesh.normals[vertex]), -1.0F);
    });
}

/// What keeping tangents comes to: they belong to the normals they were made for, so with new
/// normals a mesh that has tangents gets new ones, if its texture coordinates allow.
TangentMode resolved_tangents(const Mesh& mesh, TangentMode tangents, NormalMode normals,
                              Report& report) {
    const bool outdated = tangents == TangentMode::keep && normals != NormalMode::keep;
    if (!outdated || mesh.tangents.empty()) return tangents;
    if (!mesh.texcoords.empty()) return TangentMode::mikktspace;
    report.add("tangents of other normals", "mesh", 0,
               "are removed: without texture coordinates there can be no new ones");
    return TangentMode::none;
}

}  // namespace

FramedMesh with_frames(Mesh mesh, const FrameOptions& options, Report& report) {
    check_options(mesh, options);
    const bool has_normals = !mesh.normals.empty();
    const NormalMode mode =
        options.normals == NormalMode::keep && !has_normals ? options.if_missing : options.normals;

    FramedMesh framed{std::move(mesh), {}};
    framed.source_vertex.resize(framed.mesh.positions.size());
    std::iota(framed.source_vertex.begin(), framed.source_vertex.end(), 0U);

    const TangentMode tangents = resolved_tangents(framed.mesh, options.tangents, mode, report);
    if (tangents != TangentMode::keep) framed.mesh.tangents.clear();
    make_normals(framed, mode, report);
    if (tangents == TangentMode::mikktspace) make_tangents(framed, report);
    return framed;
}

}  // namespace relief
