// SPDX-License-Identifier: Apache-2.0
// Changes of a mesh (mesh_changes.h) that must not change its decimation, in combination with the
// options of decimation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "hard_cases/mesh_changes.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/topology.h"
#include "support/labels.h"
#include "support/sanitized.h"

namespace relief::test {
namespace {

/// The options of `decimate`, with distances in the unit of the mesh.
///
/// \param with_distance  also those that measure the distance between surfaces, which takes most of
///                       the time
std::vector<DecimateOptions> all_decimate_options(const Mesh& mesh, bool with_distance) {
    std::vector<DecimateOptions> all;
    const auto with = [&](const auto& set) {
        DecimateOptions options;
        options.triangles = mesh.triangles.size() / 2 + 1;
        set(options);
        all.push_back(options);
    };
    with([](DecimateOptions&) {});
    with([](DecimateOptions& o) { o.fit_positions = true; });
    with([](DecimateOptions& o) { o.keep_borders = true; });
    with([](DecimateOptions& o) { o.keep_seams = true; });
    with([](DecimateOptions& o) { o.weights.normal = 0.1; });
    with([](DecimateOptions& o) { o.weights.texcoord = 0.0; });
    with([](DecimateOptions& o) { o.max_normal_error = 0.6; });
    with([](DecimateOptions& o) {
        o.frames.normals = NormalMode::automatic;
        o.frames.crease_angle = 40.0 * (std::numbers::pi / 180.0);
        o.frames.tangents = TangentMethod::mikktspace;
    });
    if (!with_distance) return all;
    with([](DecimateOptions& o) { o.max_error = 0.1; });
    with([](DecimateOptions& o) {
        o.triangles = std::nullopt;
        o.max_error = 0.05;
        o.fit_positions = true;
    });
    return all;
}

/// The position, normal, texture coordinate and tangent at each corner of a triangle.
using TriangleValues = std::array<std::array<std::uint32_t, 12>, 3>;

/// Returns the values of all triangles without their order. Each begins at the corner that makes it
/// the smallest.
std::vector<TriangleValues> values_of(const Mesh& mesh, float scale = 1.0F,
                                      float texture_scale = 1.0F) {
    std::vector<TriangleValues> all;
    for (const glm::uvec3& triangle : mesh.triangles) {
        TriangleValues values{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = triangle[static_cast<int>(k)];
            auto to = values[k].begin();
            const auto append = [&to](const auto& vector) {
                for (int i = 0; i < vector.length(); ++i)
                    *to++ = std::bit_cast<std::uint32_t>(vector[i] + 0.0F);
            };
            append(mesh.positions[v] / scale);
            append(mesh.texcoords[v] / texture_scale);
            append(mesh.normals[v]);
            if (!mesh.tangents.empty()) append(mesh.tangents[v]);
        }
        TriangleValues least = values;
        for (int turn = 0; turn < 2; ++turn) {
            std::rotate(values.begin(), values.begin() + 1, values.end());
            least = std::min(least, values);
        }
        all.push_back(least);
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// Returns a difference between the decimated mesh and the decimated variant, or an empty string.
/// Rotated corners change the last bits of tangents, and nothing else.
/// \param expected  the mesh, decimated with these options
std::string decimation_difference(Mesh expected, const MeshVariant& variant,
                                  DecimateOptions options) {
    if (options.max_error) *options.max_error *= double(variant.scale);
    Mesh found = decimated(variant.mesh, options).mesh;
    if (expected.tangents.empty() != found.tangents.empty()) return "tangents are missing";
    if (variant.has_rotated_corners) {
        expected.tangents.clear();
        found.tangents.clear();
    }
    const std::vector<TriangleValues> before = values_of(expected);
    const std::vector<TriangleValues> after =
        values_of(found, variant.scale, variant.texture_scale);
    if (before.size() != after.size())
        return fmt::format("{} triangles became {}", before.size(), after.size());
    const auto [was, is] = std::mismatch(before.begin(), before.end(), after.begin());
    if (was == before.end()) return "";
    const auto text = [](const TriangleValues& triangle) {
        std::string all;
        for (const auto& corner : triangle) {
            for (const std::uint32_t bits : corner)
                all += fmt::format("{} ", std::bit_cast<float>(bits));
        }
        return all;
    };
    return fmt::format("a triangle ({}) became ({})", text(*was), text(*is));
}

/// Decimates all meshes and their variants, each with every `step`-th set of options. The changes
/// have the same options, so that cases of one process decimate each mesh only once.
void expect_same_decimation(const MeshChange& change, bool with_distance, std::size_t step) {
    static std::map<std::tuple<bool, std::uint32_t, std::size_t>, Mesh> decimated_meshes;
    std::uint32_t seed = 0;
    for (const NamedMesh& named : metamorphic_meshes()) {
        Dice dice(++seed);
        if (is_sanitized && seed % 3 != 0) continue;
        Mesh mesh = named.mesh;
        if (!dice.one_in(4)) mesh.tangents.clear();
        std::size_t i = dice.below(static_cast<std::uint32_t>(step));
        MeshVariant variant(mesh);
        change.apply(variant, dice);
        const std::vector<DecimateOptions> options = all_decimate_options(mesh, with_distance);
        for (; i < options.size(); i += step) {
            const auto [place, is_new] = decimated_meshes.try_emplace({with_distance, seed, i});
            if (is_new) place->second = decimated(mesh, options[i]).mesh;
            ASSERT_EQ(decimation_difference(place->second, variant, options[i]), "")
                << named.name << ": options " << i;
        }
    }
}

// Duplicate triangles make all their edges non-manifold, and these are not simplified.
constexpr MeshChange changes_of_decimation[] = {
    {"OrderOfTriangles", reorder_triangles}, {"OrderOfVertices", reorder_vertices},
    {"RotatedCorners", rotate_corners},      {"CollapsedTriangles", add_collapsed},
    {"PowersOfTwo", scale_by_power_of_two},  {"AllAtOnce", change_all}};

constexpr std::span<const MeshChange> tested_changes_of_decimation =
    is_sanitized ? std::span(changes_of_decimation).last(1) : std::span(changes_of_decimation);

class DecimationChanges : public testing::TestWithParam<MeshChange> {};

TEST_P(DecimationChanges, LeaveTheResultAlone) {
    expect_same_decimation(GetParam(), false, 23);
}

class DecimationMeshSweep : public testing::TestWithParam<MeshChange> {};

TEST_LABELS(slow);
TEST_P(DecimationMeshSweep, LeavesTheResultAlone) {
    expect_same_decimation(GetParam(), true, 13);
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, DecimationChanges,
                         testing::ValuesIn(tested_changes_of_decimation), name_of_change);
INSTANTIATE_TEST_SUITE_P(Metamorphic, DecimationMeshSweep, testing::ValuesIn(changes_of_decimation),
                         name_of_change);

}  // namespace
}  // namespace relief::test
