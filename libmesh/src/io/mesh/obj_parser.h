// SPDX-License-Identifier: Apache-2.0
/// \file
/// The statements of an OBJ file as plain arrays, every number exact and every index checked.
///
/// Why not tinyobjloader, which reads the MTL files here: version 2.0 keeps a face's corner count
/// in 8 bits (a 300-gon garbles all later faces), reads what is no number, nan and inf among it, as
/// 0, rounds decimals twice, and cannot tell an index out of range from an absent one.
/// Bad input throws FileError with the line. Tests: tests/mesh/io/mesh/obj_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "relief/mesh/report.h"

namespace relief {

/// One corner of a face: indices from 0, -1 where there is none.
struct ObjCorner {
    std::int32_t position = -1;
    std::int32_t texcoord = -1;
    std::int32_t normal = -1;
};

/// A polygon: a run of corners.
struct ObjFace {
    std::size_t first_corner = 0;
    std::uint32_t corner_count = 0;
    std::int32_t material = -1;  ///< Index into ObjStatements::materials, -1 before any usemtl.
    std::uint32_t smoothing_group = 0;  ///< 0: off, also before any s.
};

/// Faces from one on that belong to an object or a group, until the next run begins.
struct ObjRun {
    std::size_t first_face = 0;
    std::string name;  ///< As written after o or g, all of the line.
};

struct ObjStatements {
    std::string name;  ///< Of the object, where there is exactly one.
    std::vector<glm::vec3> positions;
    std::vector<glm::vec4> colors;     ///< Empty, or one per position; white where there is none.
    std::vector<glm::vec2> texcoords;  ///< Upper left origin, v down: 1 - v as written.
    std::vector<glm::vec3> normals;
    std::vector<ObjCorner> corners;
    std::vector<ObjFace> faces;
    bool has_smoothing_groups = false;            ///< Some s says what they are.
    std::vector<ObjRun> objects, groups;          ///< In the file's order.
    std::vector<std::string> materials;           ///< Names in order of first use.
    std::vector<std::string> material_libraries;  ///< As written after mtllib.
};

/// Reads the text of an OBJ file: UTF-8 or Latin, any line ending, continued lines.
///
/// \param file    for messages
/// \param origin  taken off the positions before they are rounded to float
/// \param report  counts points, lines, faces of fewer than three corners, free-form geometry and
///                unknown statements, all left out; smoothing groups that are no number,
///                taken as off; and texture coordinates and normals that are
///                named but do not exist, taken as none
/// \param piece_size  bytes that one thread reads at a time; the result is the same for any
/// \throws FileError naming the line of a malformed statement or of an index that counts back too
///         far, and the face that names a vertex which does not exist
ObjStatements parse_obj(std::string_view text, const std::filesystem::path& file,
                        const glm::dvec3& origin, Report& report, std::size_t piece_size = 1 << 21);

}  // namespace relief
