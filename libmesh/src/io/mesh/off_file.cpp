// SPDX-License-Identifier: Apache-2.0
// Reads OFF text files with normals, colors and texture coordinates. Object space as written; v is
// flipped.
//
// Source: the Geomview manual, object file format OFF: [ST][C][N]OFF, counts, vertex lines
// (position, normal, color, texture coordinates), face lines. Binary, four-dimensional and
// n-dimensional files, wrong counts and indices are FileErrors.
#include <fmt/format.h>

#include <algorithm>

#include "files.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/polygon_mesh.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

struct OffHeader {
    bool has_texcoords = false;
    bool has_colors = false;
    bool has_normals = false;
    std::uint64_t vertex_count = 0;
    std::uint64_t face_count = 0;
};

OffHeader parse_header(TextScanner& text, std::size_t file_size) {
    OffHeader header;
    std::string_view word = text.word();
    if (!word.ends_with("OFF")) text.fail("does not begin with 'OFF'");
    word.remove_suffix(3);
    const auto take = [&](std::string_view prefix) {
        const bool has = word.starts_with(prefix);
        if (has) word.remove_prefix(prefix.size());
        return has;
    };
    header.has_texcoords = take("ST");
    header.has_colors = take("C");
    header.has_normals = take("N");
    if (!word.empty())
        text.fail(fmt::format("'{}OFF' is a kind of OFF that relief does not read", word));
    const std::string_view first = text.word();
    const auto vertex_count = number_in<std::uint64_t>(first);
    if (!vertex_count)
        text.fail(fmt::format("expected the vertex count, but found {}", quoted(first)));
    header.vertex_count = *vertex_count;
    header.face_count = text.number<std::uint64_t>();
    text.skip_line();  // The number of edges, which some files lack.
    // A vertex has at least three numbers, a face one, each with a separator.
    if (header.vertex_count > file_size / 6 + 1 || header.face_count > file_size / 2 + 1) {
        text.fail(fmt::format("the file is too short for {} vertices and {} faces",
                              header.vertex_count, header.face_count));
    }
    return header;
}

/// A number of a color: a fraction, or out of 255.
struct LineNumber {
    float value = 0.0F;
    bool has_point = false;
};

std::vector<LineNumber> numbers_on_line(TextScanner& text) {
    std::vector<LineNumber> result;
    for (auto word = text.word_on_line(); !word.empty(); word = text.word_on_line()) {
        const auto value = number_in<float>(word);
        if (!value) text.fail(fmt::format("{} is not a number", quoted(word)));
        result.push_back({*value, word.find('.') != word.npos});
    }
    return result;
}

/// Returns a color of three or four numbers: fractions if any has a decimal point, otherwise out of
/// 255.
glm::vec4 color_of(const std::vector<LineNumber>& numbers) {
    const bool are_fractions = std::any_of(numbers.begin(), numbers.end(),
                                           [](const LineNumber& n) { return n.has_point; });
    glm::vec4 color(are_fractions ? 1.0F : 255.0F);
    for (std::size_t i = 0; i < std::min<std::size_t>(numbers.size(), 4); ++i) {
        color[static_cast<int>(i)] = numbers[i].value;
    }
    return are_fractions ? color : color / 255.0F;
}

void read_vertex(TextScanner& text, const OffHeader& header, const glm::dvec3& origin, Mesh& mesh) {
    mesh.positions.push_back(position_in(text, origin));
    if (header.has_normals) {
        const auto nx = text.number<float>();
        const auto ny = text.number<float>();
        mesh.normals.emplace_back(nx, ny, text.number<float>());
    }
    std::vector<LineNumber> rest = numbers_on_line(text);
    if (header.has_texcoords) {
        if (rest.size() < 2) text.fail("a vertex has no texture coordinates");
        mesh.texcoords.emplace_back(rest[rest.size() - 2].value, 1.0F - rest.back().value);
        rest.resize(rest.size() - 2);
    }
    if (header.has_colors) {
        if (rest.size() < 3) text.fail("a vertex has no color");
        mesh.colors.push_back(color_of(rest));
    }
}

void read_face(TextScanner& text, Polygons& polygons) {
    const auto count = text.number<std::int64_t>();
    if (count < 0 || static_cast<std::uint64_t>(count) > text.rest().size() / 2 + 1) {
        text.fail(fmt::format("a face has {} corners, which the file cannot hold", count));
    }
    for (std::int64_t i = 0; i < count; ++i) {
        const auto index = text.number<std::int64_t>();
        if (index < 0 || index > 0xFFFFFFFF)
            text.fail(fmt::format("a face names vertex {}", index));
        polygons.corners.push_back(static_cast<std::uint32_t>(index));
    }
    polygons.corner_counts.push_back(static_cast<std::uint32_t>(count));
    text.skip_line();  // A color of the face may follow.
}

}  // namespace

MeshFile read_off(const std::filesystem::path& file, const glm::dvec3& origin, Report& report) {
    const FileContents contents(file);
    const std::string_view bytes = contents.text();
    TextScanner text(bytes, file, '#');
    const OffHeader header = parse_header(text, bytes.size());
    MeshFile result;
    ProgressStage stage("parsing", header.vertex_count + header.face_count);
    for (std::uint64_t i = 0; i < header.vertex_count; ++i) {
        stage.at(i);
        read_vertex(text, header, origin, result.mesh);
    }
    Polygons polygons;
    for (std::uint64_t i = 0; i < header.face_count; ++i) {
        stage.at(i);
        read_face(text, polygons);
    }
    if (const std::string_view word = text.word(); !word.empty()) {
        report.add("text behind the last face", "byte",
                   static_cast<std::size_t>(word.data() - bytes.data()), "left out");
    }
    result.mesh.name = file.stem().string();
    add_triangles(result.mesh, polygons, file, report);
    return result;
}

}  // namespace relief::detail
