// SPDX-License-Identifier: Apache-2.0
// The pieces of an OBJ file read at once and joined, and their indices checked.
// Tests: tests/mesh/io/mesh/obj_test.cpp, obj_pieces_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "io/mesh/obj_parser.h"
#include "io/mesh/obj_pieces.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Whether the text is UTF-16, by its byte order mark or by zeros in every other byte.
bool looks_like_utf16(std::string_view text) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
    const std::string_view head = text.substr(0, 64);
    return static_cast<std::size_t>(std::count(head.begin(), head.end(), '\0')) * 3 > head.size();
}

bool is_beyond(std::int32_t index, std::size_t count) {
    return index >= 0 && static_cast<std::size_t>(index) >= count;
}

bool has_index_beyond(const ObjStatements& statements) {
    std::atomic<bool> has = false;
    parallel_for(statements.corners.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        bool found = false;
        for (std::size_t i = begin; i < end; ++i) {
            const ObjCorner& corner = statements.corners[i];
            found |= is_beyond(corner.position, statements.positions.size()) ||
                     is_beyond(corner.texcoord, statements.texcoords.size()) ||
                     is_beyond(corner.normal, statements.normals.size());
        }
        if (found) has = true;
    });
    return has;
}

/// Positive indices may look ahead, so they are checked when all vertices are known. A vertex must
/// exist; files that name texture coordinates or normals which they lack are common.
void check_indices(ObjStatements& result, const std::filesystem::path& file, Report& report) {
    if (!has_index_beyond(result)) return;
    for (std::size_t i = 0; i < result.faces.size(); ++i) {
        const ObjFace& face = result.faces[i];
        for (std::uint32_t k = 0; k < face.corner_count; ++k) {
            ObjCorner& corner = result.corners[face.first_corner + k];
            if (is_beyond(corner.position, result.positions.size())) {
                throw FileError(
                    file, fmt::format("face {} names vertex {}, but there are only {}", i + 1,
                                      corner.position + std::int64_t{1}, result.positions.size()));
            }
            if (is_beyond(corner.texcoord, result.texcoords.size())) {
                report.add("texture coordinate that does not exist", "corner",
                           face.first_corner + k, "taken as none");
                corner.texcoord = -1;
            }
            if (is_beyond(corner.normal, result.normals.size())) {
                report.add("normal that does not exist", "corner", face.first_corner + k,
                           "taken as none");
                corner.normal = -1;
            }
        }
    }
}

/// In pieces at once; nothing if one of them is malformed, or counts back too far.
std::optional<ObjStatements> parse_pieces(std::string_view text,
                                          const std::vector<std::size_t>& ends,
                                          const std::filesystem::path& file,
                                          const glm::dvec3& origin, Report& report) {
    std::vector<ObjPiece> pieces(ends.size());
    ProgressStage stage("parsing", text.size());
    try {
        parallel_for(ends.size(), 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const std::size_t begin = i == 0 ? 0 : ends[i - 1];
                const std::string_view part = text.substr(begin, ends[i] - begin);
                pieces[i] = parse_obj_piece(part, file, origin, i == 0);
                stage.advance(part.size());
            }
        });
    } catch (const FileError&) {
        return std::nullopt;
    }
    return joined(std::move(pieces), report);
}

}  // namespace

ObjStatements parse_obj(std::string_view text, const std::filesystem::path& file,
                        const glm::dvec3& origin, Report& report, std::size_t piece_size) {
    if (looks_like_utf16(text)) {
        throw FileError(file, "is UTF-16 text; save it as UTF-8");
    }
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::optional<ObjStatements> result;
    const std::vector<std::size_t> ends = obj_piece_ends(text, piece_size);
    if (ends.size() > 1) result = parse_pieces(text, ends, file, origin, report);
    if (!result) {
        // In one piece it shows which line comes first of those that are wrong.
        std::vector<ObjPiece> whole(1);
        whole[0] = parse_obj_piece(text, file, origin, true);
        result = joined(std::move(whole), report);
    }
    check_indices(*result, file, report);
    return std::move(*result);
}

}  // namespace relief
