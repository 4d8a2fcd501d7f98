// SPDX-License-Identifier: Apache-2.0
// OBJ statements to plain arrays, in one pass over the text.
//
// Object space as written; v is turned to grow downwards here, and nowhere else. Source: the
// Wavefront format as written by modelling tools, with vertex colours after the position.
// A malformed number, an index 0 or an index past the end throws FileError.
// Tests: tests/mesh/io/mesh/obj_test.cpp.
#include "io/mesh/obj_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <unordered_map>

#include "io/mesh/mesh_file_text.h"

#include "relief/mesh/error.h"

namespace relief {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

/// Whether the text is UTF-16, by its byte order mark or by zeros in every other byte.
bool looks_like_utf16(std::string_view text) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
    const std::string_view head = text.substr(0, 64);
    return static_cast<std::size_t>(std::count(head.begin(), head.end(), '\0')) * 3 > head.size();
}

/// Reads one statement after the other. A backslash at the end of a line joins the next one to it.
class ObjParser {
  public:
    ObjParser(std::string_view text, const std::filesystem::path& file, const glm::dvec3& origin,
              Report& report)
        : at_(text.data()),
          end_(text.data() + text.size()),
          file_(file),
          origin_(origin),
          is_far_(origin != glm::dvec3(0.0)),
          report_(report) {}

    ObjStatements parse();

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
    std::int32_t index(std::size_t count, const char* what);
    void use_material();
    void smoothing_group();
    void check_indices();

    const char* at_;
    const char* end_;
    const std::filesystem::path& file_;
    glm::dvec3 origin_;
    bool is_far_;
    Report& report_;
    std::size_t line_ = 1;
    std::size_t object_count_ = 0;
    std::int32_t material_ = -1;
    std::uint32_t smoothing_group_ = 0;
    std::unordered_map<std::string, std::int32_t> material_numbers_;
    ObjStatements result_;
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
std::int32_t ObjParser::index(std::size_t count, const char* what) {
    const std::int64_t written = integer();
    const std::int64_t index =
        written > 0 ? written - 1 : static_cast<std::int64_t>(count) + written;
    if (written == 0) fail(fmt::format("{} 0 is named, but OBJ counts from 1", what));
    if (index < 0 || index > std::numeric_limits<std::int32_t>::max()) {
        fail(fmt::format("{} {} is named, but there are only {} so far", what, written, count));
    }
    return static_cast<std::int32_t>(index);
}

ObjCorner ObjParser::corner() {
    ObjCorner corner;
    corner.position = index(result_.positions.size(), "vertex");
    const auto at_slash = [&] { return at_ < end_ && *at_ == '/'; };
    const auto at_value = [&] {
        return at_ < end_ && (*at_ == '-' || *at_ == '+' || (*at_ >= '0' && *at_ <= '9'));
    };
    if (at_slash()) {
        ++at_;
        if (at_value()) corner.texcoord = index(result_.texcoords.size(), "texture coordinate");
        if (at_slash()) {
            ++at_;
            if (at_value()) corner.normal = index(result_.normals.size(), "normal");
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
    while (!at_line_end())
        result_.corners.push_back(corner());
    face.corner_count = static_cast<std::uint32_t>(result_.corners.size() - face.first_corner);
    if (face.corner_count < 3) {
        report_.add("face of fewer than three corners", "line", line_, "left out");
        result_.corners.resize(face.first_corner);
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
    material_ = entry->second;
}

/// s off, s 0, s 1, ... and "s on", which some write for 1.
void ObjParser::smoothing_group() {
    const std::string_view text = at_line_end() ? std::string_view() : word();
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
    static constexpr std::array without_shape = {
        "g", "vp", "mg", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj"};
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
        result_.name = object_count_++ == 0 ? std::string(rest_of_line()) : std::string();
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

/// Positive indices may look ahead, so they are checked when all vertices are known. A vertex must
/// exist; files that name texture coordinates or normals which they lack are common.
void ObjParser::check_indices() {
    const auto is_beyond = [](std::int32_t index, std::size_t count) {
        return index >= 0 && static_cast<std::size_t>(index) >= count;
    };
    for (std::size_t i = 0; i < result_.faces.size(); ++i) {
        const ObjFace& face = result_.faces[i];
        for (std::uint32_t k = 0; k < face.corner_count; ++k) {
            ObjCorner& corner = result_.corners[face.first_corner + k];
            if (is_beyond(corner.position, result_.positions.size())) {
                throw FileError(file_, fmt::format("face {} names vertex {}, but there are only {}",
                                                   i + 1, corner.position + std::int64_t{1},
                                                   result_.positions.size()));
            }
            if (is_beyond(corner.texcoord, result_.texcoords.size())) {
                report_.add("texture coordinate that does not exist", "corner",
                            face.first_corner + k, "taken as none");
                corner.texcoord = -1;
            }
            if (is_beyond(corner.normal, result_.normals.size())) {
                report_.add("normal that does not exist", "corner", face.first_corner + k,
                            "taken as none");
                corner.normal = -1;
            }
        }
    }
}

ObjStatements ObjParser::parse() {
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
    }
    check_indices();
    return std::move(result_);
}

}  // namespace

ObjStatements parse_obj(std::string_view text, const std::filesystem::path& file,
                        const glm::dvec3& origin, Report& report) {
    if (looks_like_utf16(text)) {
        throw FileError(file, "is UTF-16 text; save it as UTF-8");
    }
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return ObjParser(text, file, origin, report).parse();
}

}  // namespace relief
