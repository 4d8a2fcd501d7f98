// SPDX-License-Identifier: Apache-2.0
// Changes of a mesh that must not change its normals, in combination with all options of normals:
// another order of triangles and vertices, rotated corners, added collapsed and
// duplicate triangles, and scaling by powers of two.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "hard_cases/hard_cases.h"
#include "hard_cases/random_meshes.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/labels.h"

namespace relief::test {
namespace {

constexpr std::uint32_t added = std::numeric_limits<std::uint32_t>::max();

/// A changed mesh.
struct Variant {
    Mesh mesh;
    std::vector<std::uint32_t> original;  ///< By corner: the corner of the original, or `added`.
    float scale = 1.0F;                   ///< Of positions.

    explicit Variant(const Mesh& given) : mesh(given), original(3 * given.triangles.size()) {
        std::iota(original.begin(), original.end(), 0U);
    }
    void add_triangle(const glm::uvec3& triangle, std::uint32_t group,
                      const std::array<std::uint32_t, 3>& corners = {added, added, added}) {
        mesh.triangles.push_back(triangle);
        if (!mesh.smoothing_groups.empty()) mesh.smoothing_groups.push_back(group);
        original.insert(original.end(), corners.begin(), corners.end());
    }
};

void reorder_triangles(Variant& variant, Dice& dice) {
    const auto order = shuffled(variant.mesh.triangles.size(), dice.below(1U << 30));
    const Variant before = variant;
    variant.mesh = with_triangle_order(before.mesh, order);
    for (std::size_t t = 0; t < order.size(); ++t) {
        if (!before.mesh.smoothing_groups.empty())
            variant.mesh.smoothing_groups[t] = before.mesh.smoothing_groups[order[t]];
        for (std::size_t i = 0; i < 3; ++i)
            variant.original[3 * t + i] = before.original[3 * order[t] + i];
    }
}

void reorder_vertices(Variant& variant, Dice& dice) {
    const auto order = shuffled(variant.mesh.positions.size(), dice.below(1U << 30));
    std::vector<std::uint32_t> place(order.size());
    VertexSplit split;
    for (std::size_t v = 0; v < order.size(); ++v) {
        split.source_vertex.push_back(static_cast<std::uint32_t>(order[v]));
        place[order[v]] = static_cast<std::uint32_t>(v);
    }
    for (const glm::uvec3& triangle : variant.mesh.triangles)
        split.triangles.emplace_back(place[triangle.x], place[triangle.y], place[triangle.z]);
    variant.mesh = carried(variant.mesh, split);
}

void rotate_corners(Variant& variant, Dice& dice) {
    for (std::size_t t = 0; t < variant.mesh.triangles.size(); ++t) {
        glm::uvec3& triangle = variant.mesh.triangles[t];
        const auto first = variant.original.begin() + static_cast<std::ptrdiff_t>(3 * t);
        for (std::uint32_t steps = dice.below(3); steps > 0; --steps) {
            triangle = {triangle.y, triangle.z, triangle.x};
            std::rotate(first, first + 1, first + 3);
        }
    }
}

/// Adds triangles with two or three corners at one vertex, or at two vertices with equal values.
void add_collapsed(Variant& variant, Dice& dice) {
    Mesh& mesh = variant.mesh;
    if (mesh.triangles.empty()) return;
    const std::size_t count = 2 + mesh.triangles.size() / 4;
    for (std::size_t i = 0; i < count; ++i) {
        // An edge of the mesh or any two of its vertices.
        const glm::uvec3& here =
            mesh.triangles[dice.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        const std::uint32_t a = here.x;
        const std::uint32_t b =
            dice.one_in(3) ? dice.below(static_cast<std::uint32_t>(mesh.positions.size())) : here.y;
        std::uint32_t same = a;
        if (dice.one_in(2)) {
            same = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(glm::vec3(mesh.positions[a]));
            mesh.normals.push_back(glm::vec3(mesh.normals[a]));
            mesh.texcoords.push_back(glm::vec2(mesh.texcoords[a]));
        }
        variant.add_triangle(dice.one_in(4) ? glm::uvec3(a, same, a) : glm::uvec3(a, b, same),
                             dice.below(3));
    }
    reorder_triangles(variant, dice);
}

void duplicate_all(Variant& variant, Dice&) {
    const Variant before = variant;
    for (std::size_t t = 0; t < before.mesh.triangles.size(); ++t) {
        const auto at = [&](std::size_t i) { return before.original[3 * t + i]; };
        variant.add_triangle(
            before.mesh.triangles[t],
            before.mesh.smoothing_groups.empty() ? 0 : before.mesh.smoothing_groups[t],
            {at(0), at(1), at(2)});
    }
}

/// Tests whether all values keep their bits when they are scaled and scaled back.
template <typename Vector>
bool is_exact(const std::vector<Vector>& values, float scale) {
    return std::all_of(values.begin(), values.end(), [&](const Vector& value) {
        for (int i = 0; i < Vector::length(); ++i) {
            const float scaled = value[i] * scale;
            if (std::isfinite(value[i]) && (!std::isfinite(scaled) || scaled / scale != value[i]))
                return false;
        }
        return true;
    });
}

void scale_by_power_of_two(Variant& variant, Dice& dice) {
    const float scale = std::ldexp(1.0F, static_cast<int>(dice.below(41)) - 20);
    if (is_exact(variant.mesh.positions, scale)) {
        for (glm::vec3& position : variant.mesh.positions)
            position *= scale;
        variant.scale *= scale;
    }
    const float texture_scale = std::ldexp(1.0F, static_cast<int>(dice.below(41)) - 20);
    if (!is_exact(variant.mesh.texcoords, texture_scale)) return;
    for (glm::vec2& texcoord : variant.mesh.texcoords)
        texcoord *= texture_scale;
}

void change_all(Variant& variant, Dice& dice) {
    rotate_corners(variant, dice);
    add_collapsed(variant, dice);
    reorder_vertices(variant, dice);
    scale_by_power_of_two(variant, dice);
    rotate_corners(variant, dice);
    reorder_triangles(variant, dice);
}

struct Change {
    const char* name;
    void (*apply)(Variant& variant, Dice& dice);
};

/// A gtest name for a change.
std::string change_name(const testing::TestParamInfo<Change>& change) {
    return change.param.name;
}

/// Tests whether triangles name only vertices that exist.
bool is_valid(const Mesh& mesh) {
    return message_of<InvalidInput>([&] { validate(mesh); }) == "no error";
}

/// The hard meshes, those of the catalogue, and random ones. All have normals and texture
/// coordinates.
const std::vector<NamedMesh>& metamorphic_meshes() {
    static const std::vector<NamedMesh> meshes = [] {
        constexpr std::size_t max_triangles = 3000;
        std::vector<NamedMesh> all = hard_meshes();
        for (const HardCase& row : hard_cases()) {
            if (!row.mesh) continue;
            Mesh mesh = row.mesh();
            if (mesh.triangles.size() > max_triangles || !is_valid(mesh)) continue;
            // Adds normals where there are none.
            if (mesh.texcoords.empty() || mesh.normals.empty())
                mesh = textured_from_above(std::move(mesh));
            mesh.tangents.clear();
            mesh.texcoords_2.clear();
            mesh.colors.clear();
            all.push_back({row.name, std::move(mesh)});
        }
        for (std::uint32_t seed = 0; seed < 200; ++seed)
            all.push_back({fmt::format("random mesh {}", seed), random_mesh(seed)});
        for (std::uint32_t seed = 0; seed < 100; ++seed)
            all.push_back({fmt::format("hostile mesh {}", seed), hostile_mesh(seed)});
        return all;
    }();
    return meshes;
}

constexpr double degree = std::numbers::pi / 180.0;

/// Every normal mode with every other option of normals of `process`.
std::vector<FrameOptions> all_frame_options() {
    std::vector<FrameOptions> all;
    for (const EnumName<NormalMode>& mode : enum_names<NormalMode>) {
        FrameOptions options;
        options.normals = mode.value;
        options.tangents = TangentMethod::none;
        all.push_back(options);
        if (mode.value == NormalMode::keep) {
            options.repair = true;
            all.push_back(options);
        }
        if (mode.value == NormalMode::keep || mode.value == NormalMode::flat) continue;
        for (const double crease : {0.0, 20.0, 45.0, 60.0, 180.0}) {
            options.crease_angle = crease * degree;
            options.weld_tolerance = crease == 45.0 ? 0.25 : 0.0;
            options.smoothing_groups = crease != 20.0;
            all.push_back(options);
        }
    }
    return all;
}

std::string text_of(const FrameOptions& options) {
    return fmt::format("normals {}, tangents {}, crease {}, weld {}, groups {}, repair {}",
                       enum_name(options.normals), enum_name(options.tangents),
                       options.crease_angle ? *options.crease_angle / degree : -1.0,
                       options.weld_tolerance, options.smoothing_groups, options.repair);
}

template <glm::length_t size>
bool has_same_bits(const glm::vec<size, float>& a, const glm::vec<size, float>& b) {
    for (glm::length_t i = 0; i < size; ++i) {
        if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
    }
    return true;
}

/// Returns the first corner whose normal or tangent differs, or an empty string.
std::string frame_difference(const Mesh& mesh, const Variant& variant, FrameOptions options) {
    const Mesh expected = with_frames(mesh, options).mesh;
    options.weld_tolerance *= double(variant.scale);
    const Mesh found = with_frames(variant.mesh, options).mesh;
    for (std::size_t c = 0; c < variant.original.size(); ++c) {
        if (variant.original[c] == added) continue;
        const std::size_t e = variant.original[c];
        const std::uint32_t before = expected.triangles[e / 3][static_cast<int>(e % 3)];
        const std::uint32_t after = found.triangles[c / 3][static_cast<int>(c % 3)];
        const auto differs = [&](const auto& a, const auto& b) {
            return a.empty() != b.empty() || (!a.empty() && !has_same_bits(a[before], b[after]));
        };
        if (differs(expected.normals, found.normals)) {
            const glm::vec3 a = expected.normals[before], b = found.normals[after];
            return fmt::format("corner {}: normal ({}, {}, {}) became ({}, {}, {})", e, a.x, a.y,
                               a.z, b.x, b.y, b.z);
        }
        if (differs(expected.tangents, found.tangents))
            return fmt::format("corner {}: another tangent", e);
    }
    return "";
}

constexpr Change changes_of_frames[] = {{"OrderOfTriangles", reorder_triangles},
                                        {"OrderOfVertices", reorder_vertices},
                                        {"RotatedCorners", rotate_corners},
                                        {"CollapsedTriangles", add_collapsed},
                                        {"EachTriangleTwice", duplicate_all},
                                        {"PowersOfTwo", scale_by_power_of_two},
                                        {"AllAtOnce", change_all}};

/// Applies a change to all meshes, each with every `step`-th set of options.
void expect_same_frames(const Change& change, std::size_t step) {
    const std::vector<FrameOptions> options = all_frame_options();
    std::uint32_t seed = 0;
    for (const NamedMesh& named : metamorphic_meshes()) {
        Dice dice(++seed);
        Variant variant(named.mesh);
        change.apply(variant, dice);
        for (std::size_t i = dice.below(static_cast<std::uint32_t>(step)); i < options.size();
             i += step) {
            ASSERT_EQ(frame_difference(named.mesh, variant, options[i]), "")
                << named.name << ": " << text_of(options[i]);
        }
    }
}

class MeshChanges : public testing::TestWithParam<Change> {};

TEST_P(MeshChanges, LeaveFramesAlone) {
    expect_same_frames(GetParam(), 13);
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, MeshChanges, testing::ValuesIn(changes_of_frames),
                         change_name);

class MeshSweep : public testing::TestWithParam<Change> {};

TEST_LABELS(slow);
TEST_P(MeshSweep, LeavesFramesAlone) {
    expect_same_frames(GetParam(), 1);
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, MeshSweep, testing::ValuesIn(changes_of_frames), change_name);

}  // namespace
}  // namespace relief::test
