// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/mesh_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "hard_cases/hard_cases.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/tangents.h"
#include "support/invariants.h"

namespace relief::test {

MeshVariant::MeshVariant(const Mesh& given) : mesh(given), original(3 * given.triangles.size()) {
    std::iota(original.begin(), original.end(), 0U);
}

void MeshVariant::add_triangle(const glm::uvec3& triangle, std::uint32_t group,
                               const std::array<std::uint32_t, 3>& corners) {
    mesh.triangles.push_back(triangle);
    if (!mesh.smoothing_groups.empty()) mesh.smoothing_groups.push_back(group);
    original.insert(original.end(), corners.begin(), corners.end());
}

void reorder_triangles(MeshVariant& variant, Dice& dice) {
    const auto order = shuffled(variant.mesh.triangles.size(), dice.below(1U << 30));
    const MeshVariant before = variant;
    variant.mesh = with_triangle_order(before.mesh, order);
    for (std::size_t t = 0; t < order.size(); ++t) {
        if (!before.mesh.smoothing_groups.empty())
            variant.mesh.smoothing_groups[t] = before.mesh.smoothing_groups[order[t]];
        for (std::size_t i = 0; i < 3; ++i)
            variant.original[3 * t + i] = before.original[3 * order[t] + i];
    }
}

void reorder_vertices(MeshVariant& variant, Dice& dice) {
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

void rotate_corners(MeshVariant& variant, Dice& dice) {
    variant.has_rotated_corners = true;
    for (std::size_t t = 0; t < variant.mesh.triangles.size(); ++t) {
        glm::uvec3& triangle = variant.mesh.triangles[t];
        const auto first = variant.original.begin() + static_cast<std::ptrdiff_t>(3 * t);
        for (std::uint32_t steps = dice.below(3); steps > 0; --steps) {
            triangle = {triangle.y, triangle.z, triangle.x};
            std::rotate(first, first + 1, first + 3);
        }
    }
}

void add_collapsed(MeshVariant& variant, Dice& dice) {
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
        // Positions that are not finite are equal to none.
        const glm::vec3 at_a = mesh.positions[a];
        const bool is_finite =
            std::isfinite(at_a.x) && std::isfinite(at_a.y) && std::isfinite(at_a.z);
        if (dice.one_in(2) && is_finite) {
            same = static_cast<std::uint32_t>(mesh.positions.size());
            const auto repeat = [a](auto& values) {
                if (!values.empty())
                    values.push_back(
                        typename std::decay_t<decltype(values)>::value_type(values[a]));
            };
            repeat(mesh.positions);
            repeat(mesh.normals);
            repeat(mesh.texcoords);
            repeat(mesh.tangents);
            repeat(mesh.colors);
        }
        variant.add_triangle(dice.one_in(4) ? glm::uvec3(a, same, a) : glm::uvec3(a, b, same),
                             dice.below(3));
    }
    reorder_triangles(variant, dice);
}

void duplicate_all(MeshVariant& variant, Dice&) {
    const MeshVariant before = variant;
    for (std::size_t t = 0; t < before.mesh.triangles.size(); ++t) {
        const auto at = [&](std::size_t i) { return before.original[3 * t + i]; };
        variant.add_triangle(
            before.mesh.triangles[t],
            before.mesh.smoothing_groups.empty() ? 0 : before.mesh.smoothing_groups[t],
            {at(0), at(1), at(2)});
    }
}

namespace {

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

}  // namespace

void scale_by_power_of_two(MeshVariant& variant, Dice& dice) {
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
    variant.texture_scale *= texture_scale;
}

void change_all(MeshVariant& variant, Dice& dice) {
    rotate_corners(variant, dice);
    add_collapsed(variant, dice);
    reorder_vertices(variant, dice);
    scale_by_power_of_two(variant, dice);
    rotate_corners(variant, dice);
    reorder_triangles(variant, dice);
}

namespace {

/// Tests whether triangles name only vertices that exist.
bool is_valid(const Mesh& mesh) {
    return message_of<InvalidInput>([&] { validate(mesh); }) == "no error";
}

}  // namespace

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
            mesh.texcoords_2.clear();
            mesh.colors.clear();
            all.push_back({row.name, std::move(mesh)});
        }
        for (std::uint32_t seed = 0; seed < 200; ++seed)
            all.push_back({fmt::format("random mesh {}", seed), random_mesh(seed)});
        for (std::uint32_t seed = 0; seed < 100; ++seed)
            all.push_back({fmt::format("hostile mesh {}", seed), hostile_mesh(seed)});
        for (NamedMesh& named : all) {
            Mesh& mesh = named.mesh;
            mesh.tangents.resize(mesh.positions.size());
            vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                            mesh.tangents);
        }
        return all;
    }();
    return meshes;
}

}  // namespace relief::test
