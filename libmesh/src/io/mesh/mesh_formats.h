// SPDX-License-Identifier: Apache-2.0
/// \file
/// Readers and writers of the mesh formats, see read_mesh() and write_mesh(), and the words and
/// numbers of text files, with line numbers for messages. Readers subtract `origin` from the
/// positions before these are rounded to float.
///
/// Numbers are rounded once, correctly, in any locale; infinities and NaN are accepted. Invalid
/// input throws FileError.
#pragma once

#include <charconv>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// Returns what strtod() does in the C locale; that of the process may have another decimal point.
double strtod_in_c_locale(std::string_view number);

/// Parses a whole word as a number; nullopt if it is none.
///
/// Numbers beyond the range of the type become infinity or 0, as with strtod. "1.#QNAN" and the
/// like, which old printf implementations wrote for NaN and infinity, are accepted.
template <typename Number>
std::optional<Number> number_in(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    Number value = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error == std::errc() && stop == end) return value;
    if constexpr (std::numeric_limits<Number>::has_infinity) {
        if (error == std::errc::result_out_of_range && stop == end) {
            return static_cast<Number>(strtod_in_c_locale(word));
        }
        const auto has = [&](std::string_view part) { return word.find(part) != word.npos; };
        if (has("#QNAN") || has("#IND") || has("#SNAN")) {
            return std::numeric_limits<Number>::quiet_NaN();
        }
        if (has("#INF")) {
            return (word.starts_with('-') ? -1 : 1) * std::numeric_limits<Number>::infinity();
        }
    }
    return std::nullopt;
}

/// Scans the words of a text and counts lines. LF, CR LF and CR end a line.
class TextScanner {
  public:
    /// \param comment  the character that begins a comment, which ends with the line; 0 for none
    TextScanner(std::string_view text, const std::filesystem::path& file, char comment = '\0')
        : rest_(text), file_(file), comment_(comment) {}

    /// Returns the next word on any line; empty at the end of the text.
    std::string_view word();

    /// Returns the next word on this line; empty at its end.
    std::string_view word_on_line();

    /// Skips the rest of this line.
    void skip_line();

    /// Returns the next word as a number. \throws FileError if there is none or it is no number
    template <typename Number>
    Number number() {
        const std::string_view text = word();
        const std::optional<Number> value = number_in<Number>(text);
        if (!value) fail_at(text, "a number");
        return *value;
    }

    /// The text that has not been read yet.
    [[nodiscard]] std::string_view rest() const { return rest_; }

    /// \throws FileError always, with the line
    [[noreturn]] void fail(const std::string& reason) const;

  private:
    [[noreturn]] void fail_at(std::string_view text, const char* wanted) const;
    void skip_blanks();
    void skip_line_end();

    std::string_view rest_;
    const std::filesystem::path& file_;
    char comment_;
    std::size_t line_ = 1;
};

/// Returns true for characters that separate the words of a line.
inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

/// Returns the next three numbers minus the origin, rounded once. \throws FileError as number()
/// does
glm::vec3 position_in(TextScanner& text, const glm::dvec3& origin);

/// Quotes a word of a file for a message: at most 40 characters, unprintable ones as '?'.
std::string quoted(std::string_view word);

/// Compares ASCII letters without case.
bool equal_ignoring_case(std::string_view a, std::string_view b);

MeshFile read_obj(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

/// Writes materials to a file of the same name with the extension .mtl.
void write_obj(const std::filesystem::path& file, const MeshFile& contents, Report& report);

/// Vertices keep their number and order, except if texture coordinates are stored per face: corners
/// are then merged into vertices as for OBJ.
///
/// Texture coordinates are s t, u v or texture_u texture_v, with v upwards as Blender, MeshLab and
/// others write them (the format does not specify it); v is flipped. Integer colors, normals and
/// texture coordinates are divided by the largest value of their type.
MeshFile read_ply(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

/// Texture coordinates are s t with v upwards. Colors are bytes if all of them are multiples of
/// 1/255, otherwise floats.
void write_ply(const std::filesystem::path& file, const MeshFile& contents);

/// Several solids in one ASCII file become one mesh.
///
/// relief does not use OpenMesh 9's reader: it drops triangles smaller than 1e-38 and those with
/// NaN, and reads files that are truncated or have bytes after the last triangle as empty.
MeshFile read_stl(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

/// Vertices keep their number and order; v is flipped, as for PLY.
///
/// relief does not use OpenMesh 9's reader: after a NaN it repeats old numbers, it trusts any
/// count, and it reads nothing if the counts are on the line of "OFF".
MeshFile read_off(const std::filesystem::path& file, const glm::dvec3& origin, Report& report);

/// One of the readers above.
using MeshReader =
    std::function<MeshFile(const std::filesystem::path&, const glm::dvec3& origin, Report&)>;

/// Reads a file, and reads it again with a local origin if the mesh is farther from 0 than 16 times
/// its size. The second result is used, and reported, if it has digits that floats around 0 cannot
/// hold. Files with float coordinates (binary ones) are not affected.
MeshFile read_with_local_origin(const std::filesystem::path& file, const MeshReader& read,
                                Report& report);

}  // namespace relief::detail
