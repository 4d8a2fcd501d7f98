// SPDX-License-Identifier: Apache-2.0
// What one piece needs of those before it is summed up first; then all are mended at once, and laid
// end to end. Tests: tests/mesh/io/mesh/obj_pieces_test.cpp.
#include "io/mesh/obj_pieces.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <unordered_map>

#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"

namespace relief {
namespace {

/// What comes before a piece.
struct Before {
    std::size_t positions = 0, texcoords = 0, normals = 0, corners = 0, lines = 0;
    std::int32_t material = -1;
    std::uint32_t smoothing_group = 0;
    std::vector<std::int32_t> materials;  ///< The file's number for each of the piece's own.
};

/// The file's materials, numbered in order of first use.
class MaterialNames {
  public:
    std::int32_t number_of(const std::string& name) {
        const auto [entry, is_new] =
            numbers_.try_emplace(name, static_cast<std::int32_t>(names_.size()));
        if (is_new) names_.push_back(name);
        return entry->second;
    }
    [[nodiscard]] std::vector<std::string> take() { return std::move(names_); }

  private:
    std::vector<std::string> names_;
    std::unordered_map<std::string, std::int32_t> numbers_;
};

std::vector<Before> what_comes_before(const std::vector<ObjPiece>& pieces, MaterialNames& names) {
    std::vector<Before> all;
    Before before;
    for (const ObjPiece& piece : pieces) {
        const ObjStatements& own = piece.statements;
        before.materials.clear();
        for (const std::string& name : own.materials)
            before.materials.push_back(names.number_of(name));
        all.push_back(before);
        before.positions += own.positions.size();
        before.texcoords += own.texcoords.size();
        before.normals += own.normals.size();
        before.corners += own.corners.size();
        before.lines += piece.line_ends;
        if (!own.materials.empty())
            before.material = all.back().materials[static_cast<std::size_t>(piece.last_material)];
        if (own.has_smoothing_groups) before.smoothing_group = piece.last_smoothing_group;
    }
    return all;
}

/// \return whether all indices that count back lie within the file
bool mend_corners(ObjPiece& piece, const Before& before) {
    bool are_there = true;
    const auto mend = [&](std::int32_t& index, std::size_t count) {
        const std::int64_t counted = index + static_cast<std::int64_t>(count);
        are_there =
            are_there && counted >= 0 && counted <= std::numeric_limits<std::int32_t>::max();
        index = static_cast<std::int32_t>(counted);
    };
    for (std::size_t i = 0; i < piece.counting_back.size(); ++i) {
        const std::uint8_t back = piece.counting_back[i];
        ObjCorner& corner = piece.statements.corners[i];
        if ((back & ObjPiece::position) != 0) mend(corner.position, before.positions);
        if ((back & ObjPiece::texcoord) != 0) mend(corner.texcoord, before.texcoords);
        if ((back & ObjPiece::normal) != 0) mend(corner.normal, before.normals);
    }
    return are_there;
}

void mend_faces(ObjPiece& piece, const Before& before) {
    std::vector<ObjFace>& faces = piece.statements.faces;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        faces[i].first_corner += before.corners;
        faces[i].material = i < piece.faces_before_material
                                ? before.material
                                : before.materials[static_cast<std::size_t>(faces[i].material)];
        if (i < piece.faces_before_smoothing) faces[i].smoothing_group = before.smoothing_group;
    }
}

/// One array of all pieces, end to end; theirs are given back.
template <typename Value>
void append_all(std::vector<ObjPiece>& pieces, std::vector<Value> ObjStatements::*values,
                std::vector<Value>& all) {
    std::size_t count = 0;
    for (const ObjPiece& piece : pieces)
        count += (piece.statements.*values).size();
    reserve_to_fill(all, count);
    for (ObjPiece& piece : pieces) {
        check_cancelled();
        std::vector<Value>& own = piece.statements.*values;
        all.insert(all.end(), own.begin(), own.end());
        own = {};
    }
}

/// White where a piece has none and another has.
void complete_colors(std::vector<ObjPiece>& pieces) {
    const bool have_colors = std::any_of(pieces.begin(), pieces.end(), [](const ObjPiece& piece) {
        return !piece.statements.colors.empty();
    });
    if (!have_colors) return;
    for (ObjPiece& piece : pieces)
        piece.statements.colors.resize(piece.statements.positions.size(), glm::vec4(1.0F));
}

void add_findings(const std::vector<ObjPiece>& pieces, const std::vector<Before>& before,
                  Report& report) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        for (Finding finding : pieces[i].report.findings()) {
            for (std::size_t& line : finding.first)
                line += before[i].lines;
            report.add(finding);
        }
    }
}

/// Runs of a piece, counted from the file's first face.
void append_runs(std::vector<ObjRun>& runs, std::size_t faces_before, std::vector<ObjRun>& all) {
    for (ObjRun& run : runs)
        all.push_back({run.first_face + faces_before, std::move(run.name)});
}

/// The name of the one object, and what has no order but that of the file.
void join_words(std::vector<ObjPiece>& pieces, ObjStatements& all) {
    std::size_t objects = 0, faces = 0;
    for (ObjPiece& piece : pieces) {
        append_runs(piece.statements.objects, faces, all.objects);
        append_runs(piece.statements.groups, faces, all.groups);
        faces += piece.statements.faces.size();
        if (piece.object_count > 0) all.name = piece.statements.name;
        objects += piece.object_count;
        all.has_smoothing_groups |= piece.statements.has_smoothing_groups;
        std::vector<std::string>& libraries = piece.statements.material_libraries;
        std::move(libraries.begin(), libraries.end(), std::back_inserter(all.material_libraries));
    }
    if (objects != 1) all.name.clear();
}

}  // namespace

std::vector<std::size_t> obj_piece_ends(std::string_view text, std::size_t piece_size) {
    std::vector<std::size_t> ends;
    std::size_t at = piece_size;
    while (at < text.size()) {
        at = text.find('\n', at);
        if (at >= text.size()) break;
        // A backslash before it joins the next line to this one.
        std::size_t last = at;
        if (last > 0 && text[last - 1] == '\r') --last;
        ++at;
        if (last > 0 && text[last - 1] == '\\') continue;
        ends.push_back(at);
        at += piece_size;
    }
    if (ends.empty() || ends.back() < text.size()) ends.push_back(text.size());
    return ends;
}

std::optional<ObjStatements> joined(std::vector<ObjPiece> pieces, Report& report) {
    if (pieces.size() == 1) {
        report.merge(pieces[0].report);
        if (pieces[0].object_count != 1) pieces[0].statements.name.clear();
        return std::move(pieces[0].statements);
    }
    MaterialNames names;
    const std::vector<Before> before = what_comes_before(pieces, names);
    std::atomic<bool> are_there = true;
    parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!mend_corners(pieces[i], before[i])) are_there = false;
            mend_faces(pieces[i], before[i]);
        }
    });
    if (!are_there) return std::nullopt;
    add_findings(pieces, before, report);
    complete_colors(pieces);
    ObjStatements all;
    join_words(pieces, all);
    all.materials = names.take();
    const auto append = [&](auto values) {
        return [&pieces, &all, values] { append_all(pieces, values, all.*values); };
    };
    parallel_tasks({append(&ObjStatements::corners), append(&ObjStatements::faces),
                    append(&ObjStatements::positions), append(&ObjStatements::colors),
                    append(&ObjStatements::texcoords), append(&ObjStatements::normals)},
                   pieces.size() == 1);
    return all;
}

}  // namespace relief
