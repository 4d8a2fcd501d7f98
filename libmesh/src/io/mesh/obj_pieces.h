// SPDX-License-Identifier: Apache-2.0
/// \file
/// An OBJ file in pieces of whole statements, read at once: what each says without knowing what
/// comes before it, and all of it joined. Same statements, findings and errors as in one piece.
/// Tests: tests/mesh/io/mesh/obj_pieces_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "io/mesh/obj_parser.h"
#include "relief/mesh/report.h"

namespace relief {

/// What a piece of a file says.
struct ObjPiece {
    /// Which of a corner's indices count back from it.
    enum Back : std::uint8_t { position = 1, texcoord = 2, normal = 4 };

    ObjStatements statements;  ///< Its own material names, and the name of its first object.
    /// By corner; empty where none counts back. Those that do are counted from the piece's start,
    /// and may lie before it.
    std::vector<std::uint8_t> counting_back;
    std::size_t object_count = 0;
    std::size_t faces_before_material = 0;   ///< They have that of the piece before.
    std::size_t faces_before_smoothing = 0;  ///< Likewise.
    std::int32_t last_material = -1;
    std::uint32_t last_smoothing_group = 0;
    std::size_t line_ends = 0;
    Report report;  ///< By line of the piece.
};

/// Reads one piece.
///
/// \param file, origin  as for parse_obj()
/// \param is_first      nothing comes before it, so that it is known what counts back too far
/// \throws FileError for a malformed statement, naming its line if the piece is the first
ObjPiece parse_obj_piece(std::string_view text, const std::filesystem::path& file,
                         const glm::dvec3& origin, bool is_first);

/// Where to cut a text into pieces of about that size: after line ends that end a statement. The
/// last one is the text's size.
std::vector<std::size_t> obj_piece_ends(std::string_view text, std::size_t piece_size);

/// Joins the pieces of a whole file, which are used up; nothing if an index counts back too far.
std::optional<ObjStatements> joined(std::vector<ObjPiece> pieces, Report& report);

}  // namespace relief
