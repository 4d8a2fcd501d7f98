// SPDX-License-Identifier: Apache-2.0
/// \file
/// The statements of an OBJ file as plain arrays: every number is rounded once, and every index is
/// checked.
///
/// relief uses tinyobjloader 2.0 only for MTL files. For OBJ it stores a face's corner count in 8
/// bits (a 300-gon corrupts all later faces), reads words that are no numbers (nan and inf too) as
/// 0, rounds decimals twice, and does not distinguish an index out of range from an absent one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "relief/mesh/report.h"

namespace relief::detail {

/// One corner of a face: indices from 0, or -1 if absent.
struct ObjCorner {
    std::int32_t position = -1;
    std::int32_t texcoord = -1;
    std::int32_t normal = -1;
};

/// A polygon: a range of corners.
struct ObjFace {
    std::size_t first_corner = 0;
    std::uint32_t corner_count = 0;
    std::int32_t material = -1;  ///< Index into ObjStatements::materials; -1 before any usemtl.
    std::uint32_t smoothing_group = 0;  ///< 0 if off, and before any s.
};

/// The faces from `first_face` up to the next run belong to one object or group.
struct ObjRun {
    std::size_t first_face = 0;
    std::string name;  ///< The rest of the line after o or g.
};

struct ObjStatements {
    std::string name;  ///< Name of the object, if there is exactly one.
    std::vector<glm::vec3> positions;
    std::vector<glm::vec4>
        colors;  ///< Empty, or one per position; white for positions without a color.
    std::vector<glm::vec2> texcoords;  ///< Upper left origin, v downwards: 1 - v as written.
    std::vector<glm::vec3> normals;
    std::vector<ObjCorner> corners;
    std::vector<ObjFace> faces;
    bool has_smoothing_groups = false;            ///< There is an s statement.
    std::vector<ObjRun> objects, groups;          ///< In the file's order.
    std::vector<std::string> materials;           ///< Names in order of first use.
    std::vector<std::string> material_libraries;  ///< As written after mtllib.
};

/// Parses the text of an OBJ file: UTF-8 or Latin, any line ending, continued lines.
///
/// \param file    for messages
/// \param origin  subtracted from the positions before they are rounded to float
/// \param report  counts points, lines, faces of fewer than three corners, free-form geometry and
///         unknown statements, which are left out; smoothing groups that are no number, which count
///         as off; and texture coordinates and normals that do not exist, which are treated as
///         absent
/// \param piece_size  bytes that one thread parses at a time; it does not change the result
/// \throws FileError with the line of a malformed statement or of a relative index before the first
///         element, or with the face that names a missing vertex
ObjStatements parse_obj(std::string_view text, const std::filesystem::path& file,
                        const glm::dvec3& origin, Report& report, std::size_t piece_size = 1 << 21);

/// Cuts a text into pieces of about this size, after line ends that end a statement.
/// \return the ends of the pieces; the last one is the size of the text
std::vector<std::size_t> obj_piece_ends(std::string_view text, std::size_t piece_size);

}  // namespace relief::detail
