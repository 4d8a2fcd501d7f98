// SPDX-License-Identifier: Apache-2.0
// The statements of an OBJ file as plain arrays, in object space. This is the only place where v is
// flipped.
//
// The text is cut into pieces of whole statements, which are parsed in parallel without knowledge
// of the pieces before them. Sums over the preceding pieces then complete each piece, and all
// pieces are concatenated. The statements, findings and errors do not depend on the piece size.
// Source: the Wavefront format as written by modeling tools, with vertex colors after the position.
// Malformed numbers and wrong indices throw FileError.
#include "io/mesh/obj_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/mesh/mesh_formats.h"
#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// The statements of one piece of a file.
struct ObjPiece {
    /// Flags for the indices of a corner that were written relative to it.
    enum Relative : std::uint8_t { position = 1, texcoord = 2, normal = 4 };

    ObjStatements statements;  ///< With its own material numbers and the name of its first object.
    /// One entry per corner; empty if no index is relative. A relative index is counted from the
    /// piece's start and may lie before it.
    std::vector<std::uint8_t> relative;
    std::size_t object_count = 0;
    std::size_t faces_before_material = 0;   ///< They have the last material before the piece.
    std::size_t faces_before_smoothing = 0;  ///< They have the last group before the piece.
    std::int32_t last_material = -1;
    std::uint32_t last_smoothing_group = 0;
    std::size_t line_ends = 0;
    Report report;  ///< Line numbers are relative to the piece.
};

/// Parses statement by statement. A backslash at the end of a line continues it on the next one.
class ObjParser {
  public:
    /// \param is_first  nothing precedes the text, so that the range of relative indices is known
    ObjParser(std::string_view text, const std::filesystem::path& file, const glm::dvec3& origin,
              bool is_first)
        : at_(text.data()),
          end_(text.data() + text.size()),
          file_(file),
          origin_(origin),
          has_origin_(origin != glm::dvec3(0.0)),
          is_first_(is_first) {}

    ObjPiece parse();

  private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw FileError(file_, fmt::format("line {}: {}", line_, reason));
    }

    void skip_blanks();
    bool at_line_end();
    void skip_line();
    std::string_view word();
    std::string_view rest_of_line();
    template <typename Number>
    Number number();
    std::int64_t integer();

    void statement(std::string_view keyword);
    void vertex();
    void texcoord();
    void normal();
    void face();
    ObjCorner corner();
    std::int32_t index(std::size_t count, const char* what, ObjPiece::Relative which);
    void use_material();
    void smoothing_group();

    const char* at_;
    const char* end_;
    const std::filesystem::path& file_;
    glm::dvec3 origin_;
    bool has_origin_;
    bool is_first_;
    std::size_t line_ = 1;
    std::int32_t material_ = -1;
    std::uint32_t smoothing_group_ = 0;
    std::uint8_t relative_ = 0;  ///< Flags of the corner that is being read.
    std::unordered_map<std::string, std::int32_t> material_numbers_;
    ObjPiece piece_;
    ObjStatements& result_ = piece_.statements;
    Report& report_ = piece_.report;
};

void ObjParser::skip_blanks() {
    while (at_ < end_) {
        if (is_blank(*at_)) {
            ++at_;
        } else if (*at_ == '\\' && at_ + 1 < end_ && (at_[1] == '\n' || at_[1] == '\r')) {
            at_ += at_[1] == '\r' && at_ + 2 < end_ && at_[2] == '\n' ? 3 : 2;
            ++line_;
        } else {
            return;
        }
    }
}

/// Returns true at the end of a line, or if only a comment follows.
bool ObjParser::at_line_end() {
    skip_blanks();
    return at_ == end_ || *at_ == '\n' || *at_ == '\r' || *at_ == '#';
}

void ObjParser::skip_line() {
    bool is_comment = false;
    while (at_ < end_ && *at_ != '\n' && *at_ != '\r') {
        is_comment = is_comment || *at_ == '#';
        const char* before = at_;
        if (!is_comment) skip_blanks();
        if (at_ == before) ++at_;
    }
    if (at_ == end_) return;
    at_ += *at_ == '\r' && at_ + 1 < end_ && at_[1] == '\n' ? 2 : 1;
    ++line_;
}

std::string_view ObjParser::word() {
    skip_blanks();
    const char* begin = at_;
    while (at_ < end_ && !is_blank(*at_) && *at_ != '\n' && *at_ != '\r')
        ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
}

/// A name, which may contain blanks and '#'.
std::string_view ObjParser::rest_of_line() {
    skip_blanks();
    const char* begin = at_;
    while (at_ < end_ && *at_ != '\n' && *at_ != '\r')
        ++at_;
    const char* last = at_;
    while (last > begin && is_blank(last[-1]))
        --last;
    return {begin, static_cast<std::size_t>(last - begin)};
}

template <typename Number>
Number ObjParser::number() {
    skip_blanks();
    const char* begin = at_;
    if (begin < end_ && *begin == '+') ++begin;
    Number value = 0;
    const auto [stop, error] = std::from_chars(begin, end_, value);
    const bool is_whole =
        stop == end_ || is_blank(*stop) || *stop == '\n' || *stop == '\r' || *stop == '\\';
    if (error == std::errc() && is_whole) {
        at_ = stop;
        return value;
    }
    const std::string_view text = word();
    const std::optional<Number> unusual = number_in<Number>(text);
    if (!unusual) fail(fmt::format("{} is not a number", quoted(text)));
    return *unusual;
}

std::int64_t ObjParser::integer() {
    const char* begin = at_;
    if (begin < end_ && *begin == '+') ++begin;
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(begin, end_, value);
    if (error != std::errc()) fail(fmt::format("{} is not an index", quoted(word())));
    at_ = stop;
    return value;
}

/// An index from 0. Negative ones in the file are relative to the elements read so far.
std::int32_t ObjParser::index(std::size_t count, const char* what, ObjPiece::Relative which) {
    const std::int64_t written = integer();
    const std::int64_t index =
        written > 0 ? written - 1 : static_cast<std::int64_t>(count) + written;
    if (written == 0) fail(fmt::format("{} 0 is named, but OBJ counts from 1", what));
    using Index = std::numeric_limits<std::int32_t>;
    const bool is_known = written > 0 || is_first_;
    if (index < (is_known ? 0 : Index::min()) || index > Index::max()) {
        fail(fmt::format("{} {} is named, but there are only {} so far", what, written, count));
    }
    if (!is_known) relative_ |= which;
    return static_cast<std::int32_t>(index);
}

ObjCorner ObjParser::corner() {
    ObjCorner corner;
    corner.position = index(result_.positions.size(), "vertex", ObjPiece::position);
    const auto at_slash = [&] { return at_ < end_ && *at_ == '/'; };
    const auto at_value = [&] {
        return at_ < end_ && (*at_ == '-' || *at_ == '+' || (*at_ >= '0' && *at_ <= '9'));
    };
    if (at_slash()) {
        ++at_;
        if (at_value()) {
            corner.texcoord =
                index(result_.texcoords.size(), "texture coordinate", ObjPiece::texcoord);
        }
        if (at_slash()) {
            ++at_;
            if (at_value())
                corner.normal = index(result_.normals.size(), "normal", ObjPiece::normal);
        }
    }
    if (at_ < end_ && !is_blank(*at_) && *at_ != '\n' && *at_ != '\r' && *at_ != '\\') {
        fail(fmt::format("a corner ends in {}", quoted(word())));
    }
    return corner;
}

void ObjParser::face() {
    ObjFace face;
    face.first_corner = result_.corners.size();
    face.material = material_;
    face.smoothing_group = smoothing_group_;
    while (!at_line_end()) {
        result_.corners.push_back(corner());
        if (relative_ == 0 && piece_.relative.empty()) continue;
        piece_.relative.resize(result_.corners.size() - 1, 0);
        piece_.relative.push_back(std::exchange(relative_, std::uint8_t{0}));
    }
    face.corner_count = static_cast<std::uint32_t>(result_.corners.size() - face.first_corner);
    if (face.corner_count < 3) {
        report_.add("face of fewer than three corners", "line", line_, "left out");
        result_.corners.resize(face.first_corner);
        if (!piece_.relative.empty()) piece_.relative.resize(face.first_corner);
        return;
    }
    result_.faces.push_back(face);
}

/// x y z, optionally with a weight w (only for curves) or a color r g b [a].
void ObjParser::vertex() {
    std::array<float, 7> values{};
    std::size_t count = 0;
    if (has_origin_) {
        for (; count < 3 && !at_line_end(); ++count)
            values[count] = static_cast<float>(number<double>() - origin_[static_cast<int>(count)]);
    }
    while (count < values.size() && !at_line_end())
        values[count++] = number<float>();
    if (count < 3) fail(fmt::format("a vertex has {} coordinates instead of 3", count));
    const bool has_color = count >= 6;
    if (has_color && result_.colors.empty()) {
        result_.colors.assign(result_.positions.size(), glm::vec4(1.0F));
    }
    result_.positions.emplace_back(values[0], values[1], values[2]);
    if (!result_.colors.empty() || has_color) {
        result_.colors.push_back(
            has_color ? glm::vec4(values[3], values[4], values[5], count == 7 ? values[6] : 1.0F)
                      : glm::vec4(1.0F));
    }
}

void ObjParser::texcoord() {
    const auto u = number<float>();
    // In double, so that values from write_mesh() are restored exactly.
    const double v = at_line_end() ? 0.0 : number<double>();
    result_.texcoords.emplace_back(u, static_cast<float>(1.0 - v));
}

void ObjParser::normal() {
    const auto x = number<float>();
    const auto y = number<float>();
    result_.normals.emplace_back(x, y, number<float>());
}

void ObjParser::use_material() {
    const std::string name(rest_of_line());
    const auto [entry, is_new] =
        material_numbers_.try_emplace(name, static_cast<std::int32_t>(result_.materials.size()));
    if (is_new) result_.materials.push_back(name);
    if (material_ < 0) piece_.faces_before_material = result_.faces.size();
    material_ = entry->second;
}

/// s off, s 0, s 1, ... and "s on", which some tools write for 1.
void ObjParser::smoothing_group() {
    const std::string_view text = at_line_end() ? std::string_view() : word();
    if (!result_.has_smoothing_groups) piece_.faces_before_smoothing = result_.faces.size();
    result_.has_smoothing_groups = true;
    smoothing_group_ = 0;
    if (text == "off") return;
    if (text == "on") {
        smoothing_group_ = 1;
        return;
    }
    const auto [stop, error] =
        std::from_chars(text.data(), text.data() + text.size(), smoothing_group_);
    if (error != std::errc() || stop != text.data() + text.size() || text.empty()) {
        report_.add("smoothing group that is not a number", "line", line_, "taken as off");
        smoothing_group_ = 0;
    }
}

void ObjParser::statement(std::string_view keyword) {
    static constexpr std::array without_shape = {"vp",       "mg",  "bevel",      "c_interp",
                                                 "d_interp", "lod", "shadow_obj", "trace_obj"};
    static constexpr std::array free_form = {"cstype", "deg",  "bmat",  "step", "curv", "curv2",
                                             "surf",   "parm", "trim",  "hole", "scrv", "sp",
                                             "end",    "con",  "ctech", "stech"};
    const auto is_one_of = [&](const auto& words) {
        return std::find(words.begin(), words.end(), keyword) != words.end();
    };
    if (keyword == "usemtl") {
        use_material();
    } else if (keyword == "s") {
        smoothing_group();
    } else if (keyword == "mtllib") {
        result_.material_libraries.emplace_back(rest_of_line());
    } else if (keyword == "o") {
        result_.objects.push_back({result_.faces.size(), std::string(rest_of_line())});
        if (piece_.object_count++ == 0) result_.name = result_.objects.back().name;
    } else if (keyword == "g") {
        result_.groups.push_back({result_.faces.size(), std::string(rest_of_line())});
    } else if (keyword == "p") {
        report_.add("point", "line", line_, "left out");
    } else if (keyword == "l") {
        report_.add("line", "line", line_, "left out");
    } else if (is_one_of(free_form)) {
        report_.add("free-form geometry", "line", line_, "left out");
    } else if (!is_one_of(without_shape)) {
        report_.add("unknown statement", "line", line_, "left out");
    }
}

ObjPiece ObjParser::parse() {
    while (at_ < end_) {
        if (!at_line_end()) {
            const std::string_view keyword = word();
            if (keyword == "v") {
                vertex();
            } else if (keyword == "vt") {
                texcoord();
            } else if (keyword == "vn") {
                normal();
            } else if (keyword == "f" || keyword == "fo") {
                face();
            } else {
                statement(keyword);
            }
        }
        skip_line();
        check_cancelled(line_);
    }
    if (material_ < 0) piece_.faces_before_material = result_.faces.size();
    if (!result_.has_smoothing_groups) piece_.faces_before_smoothing = result_.faces.size();
    piece_.last_material = material_;
    piece_.last_smoothing_group = smoothing_group_;
    piece_.line_ends = line_ - 1;
    return std::move(piece_);
}

/// Parses one piece.
///
/// \param file, origin  as for parse_obj()
/// \param is_first      nothing precedes the piece, so that the range of relative indices is known
/// \throws FileError for a malformed statement, with its line if the piece is the first
ObjPiece parse_obj_piece(std::string_view text, const std::filesystem::path& file,
                         const glm::dvec3& origin, bool is_first) {
    return ObjParser(text, file, origin, is_first).parse();
}

/// Sums over the pieces before one piece.
struct Before {
    std::size_t positions = 0, texcoords = 0, normals = 0, corners = 0, lines = 0;
    std::int32_t material = -1;
    std::uint32_t smoothing_group = 0;
    std::vector<std::int32_t> materials;  ///< The file's number of each material of the piece.
};

/// The file's materials, numbered in order of first use.
class MaterialNumbers {
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

std::vector<Before> sums_before(const std::vector<ObjPiece>& pieces, MaterialNumbers& names) {
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

/// \return true if all relative indices are in range
bool resolve_corners(ObjPiece& piece, const Before& before) {
    bool are_valid = true;
    const auto resolve = [&](std::int32_t& index, std::size_t count) {
        const std::int64_t counted = index + static_cast<std::int64_t>(count);
        are_valid =
            are_valid && counted >= 0 && counted <= std::numeric_limits<std::int32_t>::max();
        index = static_cast<std::int32_t>(counted);
    };
    for (std::size_t i = 0; i < piece.relative.size(); ++i) {
        const std::uint8_t back = piece.relative[i];
        ObjCorner& corner = piece.statements.corners[i];
        if ((back & ObjPiece::position) != 0) resolve(corner.position, before.positions);
        if ((back & ObjPiece::texcoord) != 0) resolve(corner.texcoord, before.texcoords);
        if ((back & ObjPiece::normal) != 0) resolve(corner.normal, before.normals);
    }
    return are_valid;
}

void resolve_faces(ObjPiece& piece, const Before& before) {
    std::vector<ObjFace>& faces = piece.statements.faces;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        faces[i].first_corner += before.corners;
        faces[i].material = i < piece.faces_before_material
                                ? before.material
                                : before.materials[static_cast<std::size_t>(faces[i].material)];
        if (i < piece.faces_before_smoothing) faces[i].smoothing_group = before.smoothing_group;
    }
}

/// Concatenates one array of all pieces and frees their memory.
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

/// Adds white to pieces without colors if another piece has colors.
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

/// Appends the runs of a piece, renumbered from the file's first face.
void append_runs(std::vector<ObjRun>& runs, std::size_t faces_before, std::vector<ObjRun>& all) {
    for (ObjRun& run : runs)
        all.push_back({run.first_face + faces_before, std::move(run.name)});
}

/// Joins the object name, runs, and other data whose order is that of the file.
void join_names(std::vector<ObjPiece>& pieces, ObjStatements& all) {
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

/// Joins the pieces of a file, which are consumed; nullopt if a relative index is out of range.
std::optional<ObjStatements> joined(std::vector<ObjPiece> pieces, Report& report) {
    if (pieces.size() == 1) {
        report.merge(pieces[0].report);
        if (pieces[0].object_count != 1) pieces[0].statements.name.clear();
        return std::move(pieces[0].statements);
    }
    MaterialNumbers names;
    const std::vector<Before> before = sums_before(pieces, names);
    std::atomic<bool> are_valid = true;
    parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!resolve_corners(pieces[i], before[i])) are_valid = false;
            resolve_faces(pieces[i], before[i]);
        }
    });
    if (!are_valid) return std::nullopt;
    add_findings(pieces, before, report);
    complete_colors(pieces);
    ObjStatements all;
    join_names(pieces, all);
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

/// Returns true for UTF-16, detected by its byte order mark or by zeros in every other byte.
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

/// Positive indices may refer to later elements, so they are checked at the end. A missing vertex
/// is an error; references to missing texture coordinates or normals are common in files.
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
                           face.first_corner + k, "read as none");
                corner.texcoord = -1;
            }
            if (is_beyond(corner.normal, result.normals.size())) {
                report.add("normal that does not exist", "corner", face.first_corner + k,
                           "read as none");
                corner.normal = -1;
            }
        }
    }
}

/// Parses the pieces in parallel; nullopt if one is malformed or has a relative index out of range.
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

std::vector<std::size_t> obj_piece_ends(std::string_view text, std::size_t piece_size) {
    std::vector<std::size_t> ends;
    std::size_t at = piece_size;
    while (at < text.size()) {
        at = text.find('\n', at);
        if (at >= text.size()) break;
        // A backslash before the line end continues the line.
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
        // Parsing the whole text finds the first of several errors.
        std::vector<ObjPiece> whole(1);
        whole[0] = parse_obj_piece(text, file, origin, true);
        result = joined(std::move(whole), report);
    }
    check_indices(*result, file, report);
    return std::move(*result);
}

}  // namespace relief::detail
