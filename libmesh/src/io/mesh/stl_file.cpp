// SPDX-License-Identifier: Apache-2.0
// Reads STL files: corners with equal positions become one vertex, facet normals are ignored.
//
// Object space as written. A file is binary if its length matches its triangle count. Otherwise it
// is ASCII if it begins with "solid" and a keyword; otherwise it is truncated, which is a
// FileError. Source: [3D Systems 1989].
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "files.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/polygon_mesh.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

constexpr std::size_t header_size = 84;
constexpr std::size_t facet_size = 50;

/// Merges corners into vertices in order of first use; +0 equals -0 and NaN equals itself.
class CornerWelder {
  public:
    explicit CornerWelder(std::size_t expected) : numbers_(expected) {}

    std::uint32_t vertex_at(const glm::vec3& position) {
        const glm::vec3 key = position + 0.0F;  // -0 becomes +0, other values do not change.
        const auto vertex = numbers_.number_of(std::bit_cast<KeyNumbers<3>::Key>(key));
        if (vertex == positions.size()) positions.push_back(position);
        return vertex;
    }

    std::vector<glm::vec3> positions;

  private:
    KeyNumbers<3> numbers_;
};

Mesh read_binary(std::string_view bytes, std::size_t count, const glm::dvec3& origin) {
    CornerWelder welder(count / 2);
    Mesh mesh;
    mesh.triangles.reserve(count);
    ProgressStage stage("triangles", count);
    for (std::size_t i = 0; i < count; ++i) {
        stage.at(i);
        std::array<glm::vec3, 4> facet;  // The normal, then three corners.
        std::memcpy(facet.data(), bytes.data() + header_size + i * facet_size, sizeof(facet));
        for (glm::vec3& corner : facet)
            corner = glm::vec3(glm::dvec3(corner) - origin);
        const std::uint32_t a = welder.vertex_at(facet[1]);
        const std::uint32_t b = welder.vertex_at(facet[2]);
        mesh.triangles.emplace_back(a, b, welder.vertex_at(facet[3]));
    }
    mesh.positions = std::move(welder.positions);
    return mesh;
}

Mesh read_ascii(std::string_view bytes, const std::filesystem::path& file, const glm::dvec3& origin,
                Report& report) {
    TextScanner text(bytes, file);
    CornerWelder welder(bytes.size() / 256);
    Mesh mesh;
    std::vector<std::uint32_t> corners;
    ProgressStage stage("parsing", bytes.size());
    std::size_t rest = bytes.size();
    bool is_in_facet = false;
    bool is_in_solid = true;
    for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
        if (rest - text.rest().size() > 0x100000)
            stage.advance(rest - std::exchange(rest, text.rest().size()));
        if (equal_ignoring_case(word, "vertex")) {
            corners.push_back(welder.vertex_at(position_in(text, origin)));
        } else if (equal_ignoring_case(word, "endloop")) {
            if (corners.size() != 3) {
                text.fail(fmt::format("a facet has {} corners instead of 3", corners.size()));
            }
            mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
            corners.clear();
        } else if (equal_ignoring_case(word, "normal")) {
            for (int i = 0; i < 3; ++i)
                text.word();  // Some tools write words here: the normal is ignored.
        } else if (equal_ignoring_case(word, "solid") || equal_ignoring_case(word, "endsolid")) {
            is_in_solid = equal_ignoring_case(word, "solid");
            text.skip_line();
        } else if (equal_ignoring_case(word, "facet") || equal_ignoring_case(word, "endfacet")) {
            is_in_facet = equal_ignoring_case(word, "facet");
        } else if (!equal_ignoring_case(word, "outer") && !equal_ignoring_case(word, "loop")) {
            text.fail(fmt::format("{} is not a keyword of STL", quoted(word)));
        }
    }
    if (!corners.empty() || is_in_facet) text.fail("the file ends inside a facet");
    if (is_in_solid) {
        report.add("solid without an end", "triangle", mesh.triangles.size(),
                   "has the triangles before the end of the file");
    }
    mesh.positions = std::move(welder.positions);
    return mesh;
}

bool looks_like_ascii(std::string_view bytes, const std::filesystem::path& file) {
    TextScanner text(bytes.substr(0, 1024), file);
    if (!equal_ignoring_case(text.word(), "solid")) return false;
    text.skip_line();
    const std::string_view next = text.word();
    return equal_ignoring_case(next, "facet") || equal_ignoring_case(next, "endsolid");
}

}  // namespace

MeshFile read_stl(const std::filesystem::path& file, const glm::dvec3& origin, Report& report) {
    const FileContents contents(file);
    const std::string_view bytes = contents.text();
    std::uint32_t count = 0;
    if (bytes.size() >= header_size) {
        std::memcpy(&count, bytes.data() + header_size - sizeof(count), sizeof(count));
    }
    const std::uint64_t binary_size = header_size + std::uint64_t{count} * facet_size;
    MeshFile result;
    if (bytes.size() >= header_size && binary_size == bytes.size()) {
        result.mesh = read_binary(bytes, count, origin);
    } else if (looks_like_ascii(bytes, file)) {
        result.mesh = read_ascii(bytes, file, origin, report);
    } else if (bytes.size() >= header_size && binary_size < bytes.size()) {
        report.add("bytes behind the last triangle", "byte", binary_size, "left out");
        result.mesh = read_binary(bytes, count, origin);
    } else {
        throw FileError(file, fmt::format("is neither ASCII STL nor binary: {} triangles need {} "
                                          "bytes, but there are only {}",
                                          count, binary_size, bytes.size()));
    }
    if (result.mesh.triangles.empty()) throw FileError(file, "has no triangle");
    result.mesh.name = file.stem().string();
    return result;
}

}  // namespace relief::detail
