// SPDX-License-Identifier: Apache-2.0
// OBJ statements to plain arrays, in one pass over the text.
//
// Object space as written; v is turned to grow downwards here, and nowhere else. Source: the
// Wavefront format as written by modelling tools, with vertex colours after the position.
// A malformed number, an index 0 or an index past the end throws FileError.
// Tests: tests/mesh/io/mesh/obj_test.cpp.
#include "io/mesh/obj_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <unordered_map>
#include <utility>

#include "io/mesh/mesh_file_text.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Reads one statement after the other. A backslash at the end of a line joins the next one to it.
class ObjParser {
  public:
    /// \param is_first  nothing comes before the text: it is known what counts back too far
    ObjParser(std::string_view text, const std::filesystem::path& file, const glm::dvec3& origin,
              bool is_first)
        : at_(text.data()),
          end_(text.data() + text.size()),
          file_(file),
          origin_(origin),
          is_far_(origin != glm::dvec3(0.0)),
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
    std::int32_t index(std::size_t count, const char* what, ObjPiece::Back which);
    void use_material();
    void smoothing_group();

    const char* at_;
    const char* end_;
    const std::filesystem::path& file_;
    glm::dvec3 origin_;
    bool is_far_;
    bool is_first_;
    std::size_t line_ = 1;
    std::int32_t material_ = -1;
    std::uint32_t smoothing_group_ = 0;
    std::uint8_t counting_back_ = 0;  ///< Of the corner being read.
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

/// Whether nothing but a comment follows on this line.
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

/// A name, which may hold blanks and '#'.
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

/// An index from 0; negative ones in the file count back from what has been read so far.
std::int32_t ObjParser::index(std::size_t count, const char* what, ObjPiece::Back which) {
    const std::int64_t written = integer();
    const std::int64_t index =
        written > 0 ? written - 1 : static_cast<std::int64_t>(count) + written;
    if (written == 0) fail(fmt::format("{} 0 is named, but OBJ counts from 1", what));
    using Index = std::numeric_limits<std::int32_t>;
    const bool is_known = written > 0 || is_first_;
    if (index < (is_known ? 0 : Index::min()) || index > Index::max()) {
        fail(fmt::format("{} {} is named, but there are only {} so far", what, written, count));
    }
    if (!is_known) counting_back_ |= which;
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
        if (counting_back_ == 0 && piece_.counting_back.empty()) continue;
        piece_.counting_back.resize(result_.corners.size() - 1, 0);
        piece_.counting_back.push_back(std::exchange(counting_back_, std::uint8_t{0}));
    }
    face.corner_count = static_cast<std::uint32_t>(result_.corners.size() - face.first_corner);
    if (face.corner_count < 3) {
        report_.add("face of fewer than three corners", "line", line_, "left out");
        result_.corners.resize(face.first_corner);
        if (!piece_.counting_back.empty()) piece_.counting_back.resize(face.first_corner);
        return;
    }
    result_.faces.push_back(face);
}

/// x y z, or with a weight w that only curves use, or with a colour r g b [a].
void ObjParser::vertex() {
    std::array<float, 7> values{};
    std::size_t count = 0;
    if (is_far_) {
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
    // In double, so that what write_mesh wrote comes back exactly.
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

/// s off, s 0, s 1, ... and "s on", which some write for 1.
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
        report_.add("smoothing group that is no number", "line", line_, "taken as off");
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

}  // namespace

ObjPiece parse_obj_piece(std::string_view text, const std::filesystem::path& file,
                         const glm::dvec3& origin, bool is_first) {
    return ObjParser(text, file, origin, is_first).parse();
}

}  // namespace relief
