// SPDX-License-Identifier: Apache-2.0
// Changes of a mesh (mesh_changes.h) that must not change its decimation, in combination with the
// options of decimation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
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

/// Any frames that `decimate` can compute: it has only --normals, but the library takes all.
FrameOptions random_frames(Dice& dice) {
    FrameOptions options;
    constexpr auto modes = enum_names<NormalMode>;
    if (!dice.one_in(2)) options.normals = modes[dice.below(modes.size())].value;
    constexpr TangentMethod methods[] = {TangentMethod::keep, TangentMethod::none,
                                         TangentMethod::mikktspace, TangentMethod::area_weighted,
                                         TangentMethod::lengyel};
    options.tangents = methods[dice.below(5)];
    if (dice.one_in(3)) options.crease_angle = dice.below(4) * (std::numbers::pi / 6.0);
    if (dice.one_in(4)) options.weld_tolerance = 0.25;
    options.smoothing_groups = !dice.one_in(3);
    return options;
}

/// Options of `decimate` for meshes of size 1.
///
/// \param with_distance  also those that measure the distance between surfaces, which takes most of
///                       the time
DecimateOptions random_decimation(const Mesh& mesh, bool with_distance, Dice& dice) {
    DecimateOptions options;
    options.triangles = mesh.triangles.size() / (1 + dice.below(4)) + 1;
    constexpr std::size_t few = 500;
    if (with_distance && dice.one_in(5) && mesh.triangles.size() <= few) {
        options.max_error = dice.one_in(2) ? 0.1 : 0.02;
        if (dice.one_in(2)) options.triangles = std::nullopt;
    }
    options.frames = random_frames(dice);
    constexpr double factors[] = {1.0, 1.0, 0.0, 20.0};
    for (double* weight : {&options.weights.texcoord, &options.weights.normal,
                           &options.weights.color, &options.weights.joint, &options.weights.target})
        *weight *= factors[dice.below(4)];
    options.goal = enum_names<DecimateGoal>[dice.below(3)].value;
    if (dice.one_in(3)) options.max_normal_error = dice.one_in(2) ? 0.1 : 0.6;
    options.keep_borders = dice.one_in(3);
    options.keep_seams = dice.one_in(3);
    options.fit_positions = dice.one_in(2);
    if (dice.one_in(4)) options.drop_parts = 0.75;
    return options;
}

std::string text_of(const DecimateOptions& options) {
    return fmt::format(
        "triangles {}, error {}, normals {}, tangents {}, crease {}, weld {}, groups {}, weights "
        "{} "
        "{} {} {} {}, goal {}, normal error {}, keep borders {}, seams {}, fit {}, drop {}",
        options.triangles.value_or(0), options.max_error.value_or(-1.0),
        enum_name(options.frames.normals), enum_name(options.frames.tangents),
        options.frames.crease_angle.value_or(-1.0), options.frames.weld_tolerance,
        options.frames.smoothing_groups, options.weights.texcoord, options.weights.normal,
        options.weights.color, options.weights.joint, options.weights.target,
        enum_name(options.goal), options.max_normal_error.value_or(-1.0), options.keep_borders,
        options.keep_seams, options.fit_positions, options.drop_parts);
}

/// Gives the vertices colors that differ also between vertices at one position.
void add_colors(Mesh& mesh) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.colors.emplace_back(0.25F * static_cast<float>(v % 5), 0.5F, v % 3 == 0 ? 1 : 0, 1.0F);
}

/// Returns a deformation of a scaled mesh that depends on unscaled positions: two joints, and a
/// morph target that moves vertices along x.
Deformation deformation_of(const Mesh& mesh, float scale) {
    Deformation deformation;
    for (const glm::vec3& scaled : mesh.positions) {
        const glm::vec3 position = scaled / scale;
        const float weight = position.x > 0.25F ? 1.0F : position.y > 0.5F ? 0.5F : 0.0F;
        deformation.joints.emplace_back(weight, 1.0F - weight, 0.0F, 0.0F);
        deformation.displacements[0].emplace_back(position.z > 0.5F ? 0.25F * scale : 0.0F, 0.0F,
                                                  0.0F);
    }
    return deformation;
}

/// The position, normal, texture coordinate, tangent and color at each corner of a triangle.
using TriangleValues = std::array<std::array<std::uint32_t, 16>, 3>;

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
            if (!mesh.colors.empty()) append(mesh.colors[v]);
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

/// A mesh to decimate, and how.
struct DecimationCase {
    Mesh mesh;
    bool is_deformed = false;
    DecimateOptions options;

    [[nodiscard]] Mesh result() const { return result_of(MeshVariant(mesh)); }

    /// Returns the decimation of a variant of the mesh, with lengths in its unit.
    [[nodiscard]] Mesh result_of(const MeshVariant& variant) const {
        DecimateOptions scaled = options;
        const auto scale = double(variant.scale);
        if (scaled.max_error) *scaled.max_error *= scale;
        scaled.frames.weld_tolerance *= scale;
        scaled.drop_parts *= scale;
        const Deformation deformation =
            is_deformed ? deformation_of(variant.mesh, variant.scale) : Deformation{};
        return decimated(variant.mesh, scaled, IgnoredReport(), deformation).mesh;
    }
};

/// Returns a difference between the decimated mesh and the decimated variant, or an empty string.
/// Rotated corners change the last bits of tangents, and nothing else.
/// \param expected  the decimated mesh
std::string decimation_difference(Mesh expected, const DecimationCase& decimation,
                                  const MeshVariant& variant) {
    Mesh found = decimation.result_of(variant);
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

/// Returns whether the largest coordinates are in a range in which results neither underflow nor
/// overflow.
bool has_usual_range(const Mesh& mesh) {
    const auto is_usual = [](const auto& vectors) {
        float largest = 0.0F;
        for (const auto& vector : vectors) {
            for (int i = 0; i < vector.length(); ++i) {
                if (std::isfinite(vector[i])) largest = std::max(largest, std::abs(vector[i]));
            }
        }
        return largest == 0.0F || (largest > 1e-25F && largest < 1e25F);
    };
    return is_usual(mesh.positions) && is_usual(mesh.texcoords);
}

/// Decimates every `step`-th mesh and its variant with some random sets of options. The changes
/// have the same options, so that cases of one process decimate each mesh only once.
void expect_same_decimation(const MeshChange& change, bool with_distance, std::size_t step,
                            std::uint32_t sets) {
    static std::map<std::tuple<bool, std::size_t, std::uint32_t>, Mesh> decimated_meshes;
    const std::vector<NamedMesh>& meshes = metamorphic_meshes();
    for (std::size_t m = 0; m < meshes.size(); m += step) {
        Dice change_dice(static_cast<std::uint32_t>(m));
        for (std::uint32_t set = 0; set < sets; ++set) {
            Dice dice(static_cast<std::uint32_t>(m) * 1000 + set);
            DecimationCase decimation{meshes[m].mesh, dice.one_in(4), {}};
            if (!dice.one_in(4)) decimation.mesh.tangents.clear();
            if (dice.one_in(4)) add_colors(decimation.mesh);
            decimation.options = random_decimation(decimation.mesh, with_distance, dice);
            MeshVariant variant(decimation.mesh);
            change.apply(variant, change_dice);
            const bool is_scaled = variant.scale != 1.0F || variant.texture_scale != 1.0F;
            if (is_scaled && !(has_usual_range(decimation.mesh) && has_usual_range(variant.mesh)))
                continue;
            const auto [place, is_new] = decimated_meshes.try_emplace({with_distance, m, set});
            if (is_new) place->second = decimation.result();
            ASSERT_EQ(decimation_difference(place->second, decimation, variant), "")
                << meshes[m].name << ": set " << set << (decimation.is_deformed ? ", deformed" : "")
                << (decimation.mesh.colors.empty() ? "" : ", colored") << ", "
                << text_of(decimation.options);
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
    expect_same_decimation(GetParam(), false, is_sanitized ? 21 : 7, 1);
}

class DecimationMeshSweep : public testing::TestWithParam<MeshChange> {};

TEST_LABELS(slow, sweep);
TEST_P(DecimationMeshSweep, LeavesTheResultAlone) {
    expect_same_decimation(GetParam(), true, 1, 2);
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, DecimationChanges,
                         testing::ValuesIn(tested_changes_of_decimation), name_of_change);
INSTANTIATE_TEST_SUITE_P(Metamorphic, DecimationMeshSweep, testing::ValuesIn(changes_of_decimation),
                         name_of_change);

}  // namespace
}  // namespace relief::test
