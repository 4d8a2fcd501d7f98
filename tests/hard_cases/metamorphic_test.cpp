// SPDX-License-Identifier: Apache-2.0
// Changes of a mesh (mesh_changes.h) that must not change its normals and tangents, in combination
// with all options of both.
//
// One change may change tangents: the gradient of a triangle's texture is computed in float from
// its first corner, as by MikkTSpace, so rotated corners change its last bits. Then tangents are
// compared by angle, and only where rounding of positions and texture coordinates does not
// determine the gradient.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hard_cases/mesh_changes.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/sanitized.h"

namespace relief::test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// The maximum angle by which rotated corners turn a tangent, in degrees.
constexpr double max_rotation_degrees = 0.001;

/// Every normal mode with every other option of normals of `process`, each with every source of
/// tangents.
std::vector<FrameOptions> all_frame_options() {
    std::vector<FrameOptions> all;
    const auto add = [&](FrameOptions options) {
        for (const EnumName<TangentMethod>& method : enum_names<TangentMethod>) {
            if (method.value == TangentMethod::triangle) continue;
            options.tangents = method.value;
            all.push_back(options);
        }
    };
    for (const EnumName<NormalMode>& mode : enum_names<NormalMode>) {
        FrameOptions options;
        options.normals = mode.value;
        add(options);
        if (mode.value == NormalMode::keep) {
            options.repair = true;
            for (const NormalMode repaired :
                 {NormalMode(NormalWeight::angle), NormalMode::flat, NormalMode::automatic}) {
                options.if_missing = repaired;
                add(options);
            }
        }
        if (mode.value == NormalMode::keep || mode.value == NormalMode::flat) continue;
        for (const double crease : {0.0, 20.0, 45.0, 60.0, 180.0}) {
            options.crease_angle = crease * degree;
            options.weld_tolerance = crease == 45.0 ? 0.25 : 0.0;
            options.smoothing_groups = crease != 20.0;
            add(options);
        }
    }
    return all;
}

std::string text_of(const FrameOptions& options) {
    return fmt::format("normals {}, tangents {}, crease {}, weld {}, groups {}, repair {}, by {}",
                       enum_name(options.normals), enum_name(options.tangents),
                       options.crease_angle ? *options.crease_angle / degree : -1.0,
                       options.weld_tolerance, options.smoothing_groups, options.repair,
                       enum_name(options.if_missing));
}

template <glm::length_t size>
bool has_same_bits(const glm::vec<size, float>& a, const glm::vec<size, float>& b) {
    for (glm::length_t i = 0; i < size; ++i) {
        if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
    }
    return true;
}

/// The triangles at each position whose gradient is certain, by the rule of identify_tangents():
/// the height, in space and in the image, is at least 1000 times the spacing of floats at the
/// corners and 1e-6 of the longest side.
class CertainGradients {
  public:
    explicit CertainGradients(const Mesh& mesh) : mesh_(mesh) {
        for (const glm::uvec3& triangle : mesh.triangles) {
            const glm::dvec3 normal = certain_normal(triangle);
            for (int i = 0; i < 3; ++i)
                normals_.emplace_back(place_of(triangle[i]), normal);
        }
        std::sort(normals_.begin(), normals_.end(), is_before);
    }

    /// Tests whether the gradients of all triangles at a position are certain, and seen from the
    /// front along this normal. Otherwise averages may cancel.
    [[nodiscard]] bool are_certain_at(std::uint32_t vertex, const glm::dvec3& normal) const {
        constexpr double edge_on = 0.05;
        const Entry key(place_of(vertex), glm::dvec3(0.0));
        const auto [first, last] =
            std::equal_range(normals_.begin(), normals_.end(), key, is_before);
        return std::all_of(first, last, [&](const Entry& entry) {
            return glm::dot(entry.second, normal) > edge_on;
        });
    }

  private:
    using Place = std::array<std::uint32_t, 3>;
    /// The unit normal of a triangle at a position, or 0.
    using Entry = std::pair<Place, glm::dvec3>;

    static bool is_before(const Entry& a, const Entry& b) { return a.first < b.first; }

    [[nodiscard]] Place place_of(std::uint32_t vertex) const {
        const glm::vec3 position = mesh_.positions[vertex] + 0.0F;
        return {std::bit_cast<std::uint32_t>(position.x), std::bit_cast<std::uint32_t>(position.y),
                std::bit_cast<std::uint32_t>(position.z)};
    }

    template <glm::length_t size>
    [[nodiscard]] static bool is_certain(const std::array<glm::vec<size, double>, 3>& corners,
                                         double twice_area) {
        double longest = 0.0, largest = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            longest = std::max(longest, glm::length(corners[(k + 1) % 3] - corners[k]));
            for (glm::length_t i = 0; i < size; ++i)
                largest = std::max(largest, std::abs(corners[k][i]));
        }
        const double height = longest > 0.0 ? twice_area / longest : 0.0;
        return height > 1000.0 * 1.2e-7 * largest && height > 1e-6 * longest &&
               std::isfinite(longest);
    }

    [[nodiscard]] glm::dvec3 certain_normal(const glm::uvec3& triangle) const {
        std::array<glm::dvec3, 3> p{};
        std::array<glm::dvec2, 3> t{};
        for (int k = 0; k < 3; ++k) {
            p[static_cast<std::size_t>(k)] = mesh_.positions[triangle[k]];
            t[static_cast<std::size_t>(k)] = mesh_.texcoords[triangle[k]];
        }
        const glm::dvec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
        const glm::dvec2 a = t[1] - t[0], b = t[2] - t[0];
        const bool certain =
            is_certain(p, glm::length(cross)) && is_certain(t, std::abs(a.x * b.y - a.y * b.x));
        return certain ? glm::normalize(cross) : glm::dvec3(0.0);
    }

    const Mesh& mesh_;
    std::vector<Entry> normals_;
};

/// The tangents of one corner in the mesh and in the variant.
struct TangentPair {
    std::uint32_t corner;
    glm::vec3 normal;
    glm::vec4 expected, found;
};

/// Compares tangents of rotated triangles.
std::string tangent_difference(const CertainGradients& gradients, const Mesh& mesh,
                               const TangentPair& pair) {
    const std::uint32_t vertex = mesh.triangles[pair.corner / 3][static_cast<int>(pair.corner % 3)];
    if (!gradients.are_certain_at(vertex, glm::dvec3(pair.normal))) return "";
    const double degrees = degrees_between(glm::dvec3(pair.expected), glm::dvec3(pair.found));
    if (pair.expected.w == pair.found.w && degrees <= max_rotation_degrees) return "";
    return fmt::format("corner {}: a tangent turned by {} degrees, w {} became {}", pair.corner,
                       degrees, pair.expected.w, pair.found.w);
}

/// Returns the first corner whose normal or tangent differs, or an empty string.
/// \param expected  the mesh with these frames
std::string frame_difference(const Mesh& mesh, const Mesh& expected, const MeshVariant& variant,
                             FrameOptions options) {
    options.weld_tolerance *= double(variant.scale);
    const Mesh found = with_frames(variant.mesh, options).mesh;
    if (expected.tangents.empty() != found.tangents.empty()) return "tangents are missing";
    std::optional<CertainGradients> gradients;
    for (std::size_t c = 0; c < variant.original.size(); ++c) {
        if (variant.original[c] == MeshVariant::added) continue;
        const std::uint32_t e = variant.original[c];
        const std::uint32_t before = expected.triangles[e / 3][static_cast<int>(e % 3)];
        const std::uint32_t after = found.triangles[c / 3][static_cast<int>(c % 3)];
        if (!has_same_bits(expected.normals[before], found.normals[after])) {
            const glm::vec3 a = expected.normals[before], b = found.normals[after];
            return fmt::format("corner {}: normal ({}, {}, {}) became ({}, {}, {})", e, a.x, a.y,
                               a.z, b.x, b.y, b.z);
        }
        if (expected.tangents.empty()) continue;
        const TangentPair pair{e, expected.normals[before], expected.tangents[before],
                               found.tangents[after]};
        if (has_same_bits(pair.expected, pair.found)) continue;
        if (!variant.has_rotated_corners) return fmt::format("corner {}: another tangent", e);
        if (!gradients) gradients.emplace(mesh);
        const std::string difference = tangent_difference(*gradients, mesh, pair);
        if (!difference.empty()) return difference;
    }
    return "";
}

/// Applies changes to meshes, with every `step`-th set of options. The frames of a mesh are
/// computed once for all changes.
void expect_same_frames(std::span<const NamedMesh> meshes, std::span<const MeshChange> changes,
                        std::size_t step) {
    const std::vector<FrameOptions> options = all_frame_options();
    std::uint32_t seed = 0;
    for (const NamedMesh& named : meshes) {
        Dice dice(++seed);
        if (is_sanitized && seed % 3 != 0) continue;
        std::vector<MeshVariant> variants;
        for (const MeshChange& change : changes) {
            variants.emplace_back(named.mesh);
            change.apply(variants.back(), dice);
        }
        for (std::size_t i = dice.below(static_cast<std::uint32_t>(step)); i < options.size();
             i += step) {
            const Mesh expected = with_frames(named.mesh, options[i]).mesh;
            for (std::size_t c = 0; c < changes.size(); ++c) {
                ASSERT_EQ(frame_difference(named.mesh, expected, variants[c], options[i]), "")
                    << changes[c].name << ", " << named.name << ": " << text_of(options[i]);
            }
        }
    }
}

class MeshChanges : public testing::TestWithParam<MeshChange> {};

TEST_P(MeshChanges, LeaveFramesAlone) {
    expect_same_frames(metamorphic_meshes(), {&GetParam(), 1}, 97);
}

constexpr std::size_t sweep_parts = 4;

/// All changes of one part of the meshes.
class MeshSweep : public testing::TestWithParam<std::size_t> {};

TEST_LABELS(slow, sweep);
TEST_P(MeshSweep, LeavesFramesAlone) {
    const std::span all(metamorphic_meshes());
    const std::size_t first = all.size() * GetParam() / sweep_parts;
    const std::size_t end = all.size() * (GetParam() + 1) / sweep_parts;
    expect_same_frames(all.subspan(first, end - first), mesh_changes, 5);
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, MeshChanges, testing::ValuesIn(tested_changes),
                         name_of_change);
INSTANTIATE_TEST_SUITE_P(Parts, MeshSweep, testing::Range(std::size_t{0}, sweep_parts));

}  // namespace
}  // namespace relief::test
