// SPDX-License-Identifier: Apache-2.0
// Conformance: the tangents of relief against those of the MikkTSpace reference implementation,
// corner by corner, on twelve meshes of the shared folder "golden". Its README gives the layout.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/tangents.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief::test {
namespace {

struct Golden {
    std::string name;
    Mesh mesh;  ///< Triangles; quads are split by MikkTSpace's rule.
    /// The reference's corner in the file for every corner of the triangles.
    std::vector<std::size_t> file_corner;
    std::vector<glm::vec4> tangents;  ///< By file corner.
    std::vector<glm::vec4> reversed;  ///< The same, with faces in reverse order.

    /// Returns whether the reference has one result at a file corner: the same w, and directions
    /// within 0.01 degrees.
    [[nodiscard]] bool is_stable(std::size_t file_corner) const;

    /// Returns whether the reference left a file corner at its initial value: (1,0,0), w = -1, for
    /// any normal. This happens if no group reaches the corner.
    [[nodiscard]] bool is_untouched(std::size_t file_corner) const;
};

constexpr double same_degrees = 0.01;  // The limit of stability in the README.

/// Indices into v, vt and vn, from 0.
using FileCorner = std::array<std::size_t, 3>;

struct ObjFile {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec3> normals;
    std::vector<std::vector<FileCorner>> faces;
};

FileCorner parse_corner(const std::string& word) {
    FileCorner corner{};
    std::size_t begin = 0;
    for (std::size_t& index : corner) {
        const std::size_t end = std::min(word.find('/', begin), word.size());
        index = std::stoul(word.substr(begin, end - begin)) - 1;
        begin = end + 1;
    }
    return corner;
}

ObjFile read_obj(const std::filesystem::path& path) {
    std::ifstream file(path);
    ObjFile obj;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kind;
        glm::vec3 value(0.0F);
        words >> kind;
        if (kind == "f") {
            auto& face = obj.faces.emplace_back();
            for (std::string word; words >> word;)
                face.push_back(parse_corner(word));
            continue;
        }
        words >> value.x >> value.y >> value.z;
        if (kind == "v") obj.positions.push_back(value);
        if (kind == "vt") obj.texcoords.emplace_back(value.x, value.y);
        if (kind == "vn") obj.normals.push_back(value);
    }
    if (obj.faces.empty()) throw std::runtime_error(path.string() + ": no faces");
    return obj;
}

std::vector<glm::vec4> read_tangents(const std::filesystem::path& path, std::size_t corners) {
    std::ifstream file(path, std::ios::binary);
    std::vector<glm::vec4> tangents(corners);
    const auto bytes = static_cast<std::streamsize>(corners * sizeof(glm::vec4));
    file.read(reinterpret_cast<char*>(tangents.data()), bytes);
    if (file.gcount() != bytes || file.peek() != std::ifstream::traits_type::eof()) {
        throw std::runtime_error(path.string() + ": not as many tangents as corners");
    }
    return tangents;
}

/// MikkTSpace splits a quad from corner 0 to 2 if that diagonal is shorter in texture space or, if
/// both are equal there, not longer in object space; otherwise from 1 to 3.
bool cuts_from_first(const ObjFile& obj, const std::vector<FileCorner>& quad) {
    const auto uv = [&](std::size_t i) { return obj.texcoords[quad[i][1]]; };
    const auto position = [&](std::size_t i) { return obj.positions[quad[i][0]]; };
    const auto squared = [](auto d) { return glm::dot(d, d); };
    const float uv_02 = squared(uv(2) - uv(0));
    const float uv_13 = squared(uv(3) - uv(1));
    if (uv_02 != uv_13) return uv_02 < uv_13;
    return squared(position(2) - position(0)) <= squared(position(3) - position(1));
}

/// Returns the corners of the triangles of a face.
std::vector<std::array<std::size_t, 3>> cut(const ObjFile& obj,
                                            const std::vector<FileCorner>& face) {
    if (face.size() == 3) return {{0, 1, 2}};
    if (face.size() != 4) throw std::runtime_error("a face is neither a triangle nor a quad");
    if (cuts_from_first(obj, face)) return {{0, 1, 2}, {0, 2, 3}};
    return {{0, 1, 3}, {1, 2, 3}};
}

bool Golden::is_stable(std::size_t corner) const {
    const glm::vec4& a = tangents[corner];
    const glm::vec4& b = reversed[corner];
    return a.w == b.w && degrees_between(glm::dvec3(a), glm::dvec3(b)) <= same_degrees;
}

bool Golden::is_untouched(std::size_t corner) const {
    return tangents[corner] == glm::vec4(1.0F, 0.0F, 0.0F, -1.0F);
}

Golden read_golden(const std::filesystem::path& path) {
    const ObjFile obj = read_obj(path);
    Golden golden;
    golden.name = path.stem().string();
    std::map<FileCorner, std::uint32_t> vertices;
    std::size_t corners = 0;
    for (const std::vector<FileCorner>& face : obj.faces) {
        std::vector<std::uint32_t> indices;
        for (const FileCorner& corner : face) {
            const auto next = static_cast<std::uint32_t>(golden.mesh.positions.size());
            const auto [known, is_new] = vertices.emplace(corner, next);
            indices.push_back(known->second);
            if (!is_new) continue;
            golden.mesh.positions.push_back(obj.positions[corner[0]]);
            const glm::vec2 texcoord = obj.texcoords[corner[1]];
            golden.mesh.texcoords.emplace_back(texcoord.x, 1.0F - texcoord.y);
            golden.mesh.normals.push_back(obj.normals[corner[2]]);
        }
        for (const std::array<std::size_t, 3>& triangle : cut(obj, face)) {
            golden.mesh.triangles.emplace_back(indices[triangle[0]], indices[triangle[1]],
                                               indices[triangle[2]]);
            for (const std::size_t i : triangle)
                golden.file_corner.push_back(corners + i);
        }
        corners += face.size();
    }
    const auto beside = [&](const char* suffix) {
        return path.parent_path() / (golden.name + suffix);
    };
    golden.tangents = read_tangents(beside(".tangents.f32"), corners);
    golden.reversed = read_tangents(beside(".reversed.f32"), corners);
    return golden;
}

std::vector<std::filesystem::path> golden_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".obj") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

// The same limit applies to the reference's own results for other face orders.
constexpr double conforming_degrees = 0.01;

std::vector<glm::vec4> golden_tangents_of(const Mesh& mesh) {
    Report report;
    return mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                               report);
}

/// The comparison of a mesh with the reference.
struct Comparison {
    std::size_t compared = 0;
    std::size_t unstable = 0;   ///< The reference has two results.
    std::size_t untouched = 0;  ///< The reference has no result, but relief has one.
    std::size_t other_sign = 0;
    std::size_t too_far = 0;
    double worst_degrees = 0.0;
};

Comparison compare(const Golden& golden, const std::vector<glm::vec4>& tangents) {
    Comparison result;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::size_t file_corner = golden.file_corner[corner];
        if (!golden.is_stable(file_corner)) {
            ++result.unstable;
            continue;
        }
        const glm::vec4& expected = golden.tangents[file_corner];
        const bool other_sign = tangents[corner].w != expected.w;
        const double degrees = degrees_between(tangents[corner], expected);
        if (golden.is_untouched(file_corner) && (other_sign || degrees > conforming_degrees)) {
            ++result.untouched;
            continue;
        }
        ++result.compared;
        result.other_sign += other_sign ? 1 : 0;
        result.too_far += degrees > conforming_degrees ? 1 : 0;
        result.worst_degrees = std::max(result.worst_degrees, degrees);
    }
    return result;
}

TEST(GoldenTangents, EveryStableCornerAgreesInSignAndWithinAHundredthOfADegree) {
    RELIEF_NEEDS_SHARED(folder, "golden");
    const auto files = golden_files(folder);
    ASSERT_GE(files.size(), 12U);
    for (const std::filesystem::path& file : files) {
        SCOPED_TRACE(file.filename());
        const Golden golden = read_golden(file);
        const Comparison result = compare(golden, golden_tangents_of(golden.mesh));
        EXPECT_EQ(result.other_sign, 0U);
        EXPECT_EQ(result.too_far, 0U) << "worst: " << result.worst_degrees << " degrees";
        // Only in the mesh of bad triangles does the reference have corners without a result.
        const bool is_bad = golden.name == "degenerate_mix";
        EXPECT_EQ(result.unstable, is_bad ? 77U : 0U);
        EXPECT_EQ(result.untouched, is_bad ? 58U : 0U);
        EXPECT_GE(result.compared, 1000U);
    }
}

TEST(GoldenTangents, KeepInvariantsThatTheReferenceViolates) {
    RELIEF_NEEDS_SHARED(folder, "golden");
    for (const std::filesystem::path& file : golden_files(folder)) {
        SCOPED_TRACE(file.filename());
        const Mesh mesh = read_golden(file).mesh;
        EXPECT_EQ(broken_tangents(mesh, golden_tangents_of(mesh)), "");
    }
}

TEST(GoldenTangents, PermutingTrianglesChangesNoBit) {
    RELIEF_NEEDS_SHARED(folder, "golden");
    for (const std::filesystem::path& file : golden_files(folder)) {
        SCOPED_TRACE(file.filename());
        const Mesh mesh = read_golden(file).mesh;
        const auto order = shuffled(mesh.triangles.size());
        const auto expected = golden_tangents_of(mesh);
        const auto permuted = golden_tangents_of(with_triangle_order(mesh, order));
        EXPECT_TRUE(same_bits(permuted, corners_in_order(expected, order)));
    }
}

}  // namespace
}  // namespace relief::test
