// SPDX-License-Identifier: Apache-2.0
// OBJ to a mesh: parse, complete the corners, unify vertices, cut polygons, group by material.
//
// Object space as written, v turned downwards. A corner without what others have gets a stated
// value, counted in the report. Tests: tests/mesh/io/mesh/obj_test.cpp.
#include "io/mesh/obj_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "file_bytes.h"
#include "io/mesh/obj_materials.h"
#include "io/mesh/obj_objects.h"
#include "io/mesh/obj_parser.h"
#include "io/mesh/obj_vertices.h"
#include "io/mesh/polygon_mesh.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Unit normal of a polygon by the vector area of its fan; (0,0,1) where it has none.
glm::vec3 face_normal(const ObjStatements& statements, const ObjFace& face) {
    const auto position = [&](std::uint32_t k) {
        const ObjCorner& corner = statements.corners[face.first_corner + k];
        return glm::dvec3(statements.positions[static_cast<std::size_t>(corner.position)]);
    };
    glm::dvec3 area(0.0);
    for (std::uint32_t k = 1; k + 1 < face.corner_count; ++k) {
        area += glm::cross(position(k) - position(0), position(k + 1) - position(0));
    }
    const double length = glm::length(area);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(area / length) : glm::vec3(0, 0, 1);
}

/// Gives every corner a texture coordinate if any has one, and a normal if any has one.
void complete_corners(ObjStatements& statements, Report& report) {
    const auto have = [&](std::int32_t ObjCorner::*index) {
        return std::count_if(statements.corners.begin(), statements.corners.end(),
                             [index](const ObjCorner& corner) { return corner.*index >= 0; });
    };
    const auto count = static_cast<std::ptrdiff_t>(statements.corners.size());
    const std::ptrdiff_t with_texcoord = have(&ObjCorner::texcoord);
    const std::ptrdiff_t with_normal = have(&ObjCorner::normal);
    const bool any_texcoord = with_texcoord > 0;
    const bool any_normal = with_normal > 0;
    if (count == 0 || (with_texcoord % count == 0 && with_normal % count == 0)) return;
    for (std::size_t i = 0; i < statements.faces.size(); ++i) {
        check_cancelled(i);
        const ObjFace& face = statements.faces[i];
        std::int32_t own_normal = -1;
        for (std::uint32_t k = 0; k < face.corner_count; ++k) {
            ObjCorner& corner = statements.corners[face.first_corner + k];
            if (any_texcoord && corner.texcoord < 0) {
                report.add("corner without texture coordinates", "corner", face.first_corner + k,
                           "has (0, 0)");
                corner.texcoord = static_cast<std::int32_t>(statements.texcoords.size());
                statements.texcoords.emplace_back(0.0F);
            }
            if (any_normal && corner.normal < 0) {
                report.add("corner without a normal", "corner", face.first_corner + k,
                           "has that of its face");
                if (own_normal < 0) {
                    own_normal = static_cast<std::int32_t>(statements.normals.size());
                    statements.normals.push_back(face_normal(statements, face));
                }
                corner.normal = own_normal;
            }
        }
    }
}

/// Triangles grouped by material, groups in order of first use, order kept within each. A file that
/// names no material gets no ranges.
void group_by_material(CutPolygons cut, const ObjStatements& statements, MeshFile& file) {
    Mesh& mesh = file.mesh;
    ObjObjects objects = objects_of(statements);
    file.objects = std::move(objects.names);
    if (!objects.of_face.empty()) file.object_of.resize(cut.triangles.size());
    const auto face_of = [&](std::size_t triangle) -> const ObjFace& {
        return statements.faces[cut.polygons[triangle]];
    };
    if (statements.materials.empty() && !statements.has_smoothing_groups &&
        objects.of_face.empty()) {
        mesh.triangles = std::move(cut.triangles);
        return;
    }
    if (statements.has_smoothing_groups) mesh.smoothing_groups.resize(cut.triangles.size());
    const auto place = [&](std::size_t triangle, std::size_t at) {
        check_cancelled(triangle);
        mesh.triangles[at] = cut.triangles[triangle];
        if (!objects.of_face.empty()) file.object_of[at] = objects.of_face[cut.polygons[triangle]];
        if (statements.has_smoothing_groups)
            mesh.smoothing_groups[at] = face_of(triangle).smoothing_group;
    };
    mesh.triangles.resize(cut.triangles.size());
    if (statements.materials.empty()) {
        for (std::size_t i = 0; i < cut.triangles.size(); ++i)
            place(i, i);
        return;
    }
    // Slot 0 is for triangles before any usemtl, which come first in the file, if at all.
    const std::size_t slot_count = statements.materials.size() + 1;
    const auto slot_of = [&](std::size_t triangle) {
        return static_cast<std::size_t>(face_of(triangle).material + 1);
    };
    std::vector<std::uint32_t> starts(slot_count + 1, 0);
    for (std::size_t i = 0; i < cut.triangles.size(); ++i)
        ++starts[slot_of(i) + 1];
    for (std::size_t slot = 0; slot < slot_count; ++slot) {
        const std::uint32_t count = starts[slot + 1];
        starts[slot + 1] += starts[slot];
        if (count == 0) continue;
        const auto material =
            slot == 0 ? std::nullopt : std::optional(static_cast<std::uint32_t>(slot - 1));
        mesh.material_ranges.push_back({starts[slot], count, material});
    }
    for (std::size_t i = 0; i < cut.triangles.size(); ++i)
        place(i, starts[slot_of(i)]++);
}

}  // namespace

MeshFile read_obj(const std::filesystem::path& file, const glm::dvec3& origin, Report& report) {
    ObjStatements statements = parse_obj(FileContents(file).text(), file, origin, report);
    if (statements.corners.size() > std::numeric_limits<std::int32_t>::max()) {
        throw FileError(file, fmt::format("has {} face corners, more than 2147483647",
                                          statements.corners.size()));
    }
    complete_corners(statements, report);
    MeshFile result;
    result.mesh.name = statements.name.empty() ? file.stem().string() : statements.name;
    Polygons polygons;
    polygons.corners = unify_vertices(statements, result.mesh);
    polygons.corner_counts.reserve(statements.faces.size());
    for (const ObjFace& face : statements.faces)
        polygons.corner_counts.push_back(face.corner_count);
    CutPolygons cut = cut_polygons(result.mesh, polygons, report);
    if (cut.triangles.empty()) throw FileError(file, "has no triangle");
    group_by_material(std::move(cut), statements, result);
    result.materials =
        read_materials(file, statements.materials, statements.material_libraries, report);
    return result;
}

}  // namespace relief
