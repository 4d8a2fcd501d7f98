// SPDX-License-Identifier: Apache-2.0
// Chooses the reader or writer of a mesh file by its extension, and the local origin of distant
// meshes.
//
// Local origins are multiples of a power of two near the mesh's size. Subtracting them is
// therefore exact, and they have few digits. If a reader runs out of memory, this is a FileError.
#include "relief/mesh/mesh_file.h"

#include <fmt/format.h>
#include <locale.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

#include "files.h"
#include "io/mesh/mesh_formats.h"
#include "relief/mesh/local_origin.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

bool ends_line(char c) {
    return c == '\n' || c == '\r';
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

}  // namespace

double detail::strtod_in_c_locale(std::string_view number) {
    static const locale_t c = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return ::strtod_l(std::string(number).c_str(), nullptr, c);
}

void TextScanner::skip_blanks() {
    std::size_t i = 0;
    while (i < rest_.size() && is_blank(rest_[i]))
        ++i;
    if (comment_ != '\0' && i < rest_.size() && rest_[i] == comment_) {
        while (i < rest_.size() && !ends_line(rest_[i]))
            ++i;
    }
    rest_.remove_prefix(i);
}

void TextScanner::skip_line_end() {
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
    ++line_;
}

std::string_view TextScanner::word_on_line() {
    skip_blanks();
    std::size_t length = 0;
    while (length < rest_.size() && !is_blank(rest_[length]) && !ends_line(rest_[length]))
        ++length;
    const std::string_view word = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return word;
}

std::string_view TextScanner::word() {
    std::string_view word = word_on_line();
    while (word.empty() && !rest_.empty()) {
        skip_line_end();
        word = word_on_line();
    }
    return word;
}

void TextScanner::skip_line() {
    rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size()));
    if (!rest_.empty()) skip_line_end();
}

void TextScanner::fail(const std::string& reason) const {
    throw FileError(file_, fmt::format("line {}: {}", line_, reason));
}

void TextScanner::fail_at(std::string_view text, const char* wanted) const {
    fail(text.empty() ? fmt::format("expected {}, but the file ends", wanted)
                      : fmt::format("expected {1}, but found {0}", quoted(text), wanted));
}

glm::vec3 detail::position_in(TextScanner& text, const glm::dvec3& origin) {
    if (origin == glm::dvec3(0.0)) {
        const auto x = text.number<float>();
        const auto y = text.number<float>();
        return {x, y, text.number<float>()};
    }
    const auto x = text.number<double>();
    const auto y = text.number<double>();
    return glm::vec3(glm::dvec3(x, y, text.number<double>()) - origin);
}

std::string detail::quoted(std::string_view word) {
    std::string result = "'";
    for (const char c : word.substr(0, 40))
        result += c >= ' ' && c != '\x7F' ? c : '?';
    return result + (word.size() > 40 ? "...'" : "'");
}

bool detail::equal_ignoring_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

glm::dvec3 local_origin(const glm::dvec3& low, const glm::dvec3& high) {
    constexpr double max_ratio =
        16.0;  // At this ratio floats still resolve 20 bits of the mesh's size.
    const glm::dvec3 extent = high - low;
    const double size = std::max({extent.x, extent.y, extent.z});
    const glm::dvec3 farthest = glm::max(glm::abs(low), glm::abs(high));
    if (std::max({farthest.x, farthest.y, farthest.z}) <= max_ratio * size) return glm::dvec3(0.0);
    if (size == 0.0) return low;  // All positions are equal.
    // The power of two that is not less than the size.
    int exponent = 0;
    const double fraction = std::frexp(size, &exponent);
    const double step = std::ldexp(1.0, fraction == 0.5 ? exponent - 1 : exponent);
    return glm::round(0.5 * (low + high) / step) * step + 0.0;  // No negative zero.
}

namespace {

/// Returns the offset to the middle of the mesh; zero if the mesh is near 0 compared with its size.
glm::dvec3 offset_if_distant(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    if (bounds.empty()) return glm::dvec3(0.0);
    return local_origin(glm::dvec3(bounds.min), glm::dvec3(bounds.max));
}

/// Returns true if the positions that were read with an origin have digits that the old ones lack.
bool has_more_digits(const MeshFile& centered, const MeshFile& before) {
    const std::vector<glm::vec3>& now = centered.mesh.positions;
    const std::vector<glm::vec3>& then = before.mesh.positions;
    if (now.size() != then.size()) return true;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const glm::dvec3 value = glm::dvec3(now[i]) + centered.origin;
        const glm::dvec3 old = glm::dvec3(then[i]) + before.origin;
        for (int k = 0; k < 3; ++k) {
            if (value[k] != old[k] && std::isfinite(value[k])) return true;
        }
    }
    return false;
}

}  // namespace

MeshFile detail::read_with_local_origin(const std::filesystem::path& file, const MeshReader& read,
                                        Report& report) {
    Report findings;
    MeshFile best = read(file, glm::dvec3(0.0), findings);
    // Positions that are equal in float may be far apart compared with their size once the origin
    // is near.
    constexpr int max_passes = 3;
    for (int pass = 0; pass < max_passes; ++pass) {
        const glm::dvec3 shift = offset_if_distant(best.mesh);
        if (shift == glm::dvec3(0.0)) break;
        Report again;
        MeshFile centered = read(file, best.origin + shift, again);
        centered.origin = best.origin + shift;
        if (!has_more_digits(centered, best)) break;
        best = std::move(centered);
        findings = std::move(again);
    }
    report.merge(findings);
    if (best.origin != glm::dvec3(0.0)) {
        report.add(
            "far from the origin", "mesh", 0,
            fmt::format("are stored relative to ({}, {}, {}), so that floats keep their digits",
                        best.origin.x, best.origin.y, best.origin.z));
    }
    return best;
}

namespace {

/// Converts names to UTF-8, and replaces colors that are not finite.
MeshFile with_valid_values(MeshFile file, Report& report) {
    std::size_t number = 0;
    const auto convert = [&](std::string& name) {
        name = utf8_name(std::move(name), "name", number++, report);
    };
    convert(file.mesh.name);
    for (MtlMaterial& material : file.materials)
        convert(material.name);
    for (std::string& object : file.objects)
        convert(object);
    for (std::size_t i = 0; i < file.mesh.colors.size(); ++i) {
        glm::vec4& color = file.mesh.colors[i];
        const bool is_finite = std::isfinite(color.r) && std::isfinite(color.g) &&
                               std::isfinite(color.b) && std::isfinite(color.a);
        if (is_finite) continue;
        color = glm::vec4(1.0F);
        report.add("non-finite color", "vertex", i, "is white");
    }
    return file;
}

}  // namespace

bool MtlMaterial::may_read(const std::filesystem::path& map) const {
    return std::find(outside_maps.begin(), outside_maps.end(), map) == outside_maps.end();
}

MeshFile read_mesh(const std::filesystem::path& file, Report& report) {
    const std::string extension = lower_extension(file);
    const auto read = [&](const MeshReader& reader) {
        return with_valid_values(read_with_local_origin(file, reader, report), report);
    };
    try {
        if (extension == ".obj") return read(read_obj);
        if (extension == ".ply") return read(read_ply);
        if (extension == ".stl") return read(read_stl);
        if (extension == ".off") return read(read_off);
    } catch (const std::bad_alloc&) {
        throw FileError(file, "needs more memory than is available");
    }
    throw FileError(
        file, fmt::format("'{}' is not a mesh format that relief reads: .obj, .ply, .stl and .off",
                          extension));
}

void write_mesh(const std::filesystem::path& file, const MeshFile& contents, Report& report) {
    validate(contents.mesh);
    for (const MaterialRange& range : contents.mesh.material_ranges) {
        if (range.material && *range.material >= contents.materials.size()) {
            throw InvalidInput(
                fmt::format("a material range names material {}, but there are "
                            "only {}",
                            *range.material, contents.materials.size()));
        }
    }
    const std::string extension = lower_extension(file);
    if (extension == ".obj") {
        write_obj(file, contents, report);
    } else if (extension == ".ply") {
        write_ply(file, contents);
    } else {
        throw InvalidInput(
            fmt::format("{}: '{}' is not a mesh format that relief writes: .obj and .ply",
                        file.string(), extension));
    }
}

}  // namespace relief
