// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/random_meshes.h"

#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "support/hard_meshes.h"

namespace relief::test {

float Dice::special() {
    constexpr float values[] = {-0.0F,
                                0x1p-149F,
                                -0x1.8p-130F,
                                1e-38F,
                                -1e-25F,
                                1e-18F,
                                1e6F,
                                -1e20F,
                                1e25F,
                                std::numeric_limits<float>::max(),
                                -std::numeric_limits<float>::max(),
                                std::numeric_limits<float>::infinity(),
                                std::numeric_limits<float>::quiet_NaN()};
    return values[below(std::size(values))];
}

namespace {

/// The choice of random values for one mesh.
struct Temper {
    std::uint32_t rarity;
    bool is_common;
    float position_scale;
    float position_offset;
    float texture_scale;
    float texture_offset;
    float normal_scale;
};

Temper temper(Dice& dice) {
    constexpr float scales[] = {1, 1, 1, 1, 1e-30F, 1e-18F, 1e18F, 1e30F};
    constexpr float offsets[] = {0, 0, 0, 1e6F};
    const auto scale = [&] { return scales[dice.below(std::size(scales))]; };
    const auto offset = [&] { return offsets[dice.below(std::size(offsets))]; };
    const std::uint32_t rarity = dice.one_in(2) ? 1U << 30 : dice.one_in(2) ? 40 : 6;
    return {rarity, dice.one_in(2), scale(), offset(), scale(), offset(), scale()};
}

void add_vertex(Mesh& mesh, const Temper& temper, Dice& dice) {
    const auto draw = [&] { return dice.value(temper.rarity, temper.is_common); };
    mesh.positions.push_back(temper.position_scale * glm::vec3{draw(), draw(), draw()} +
                             temper.position_offset);
    mesh.normals.push_back(temper.normal_scale * glm::vec3{draw(), draw(), draw()});
    mesh.texcoords.push_back(temper.texture_scale * glm::vec2{draw(), draw()} +
                             temper.texture_offset);
    if (mesh.positions.size() == 1 || !dice.one_in(2)) return;
    const std::uint32_t other = dice.below(static_cast<std::uint32_t>(mesh.positions.size() - 1));
    if (!dice.one_in(3)) mesh.positions.back() = mesh.positions[other];
    if (!dice.one_in(3)) mesh.normals.back() = mesh.normals[other];
    if (!dice.one_in(3)) mesh.texcoords.back() = mesh.texcoords[other];
}

void add_triangle(Mesh& mesh, Dice& dice) {
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    glm::uvec3 triangle{dice.below(count), dice.below(count), dice.below(count)};
    if (!mesh.triangles.empty() && !dice.one_in(3)) {
        // The triangle shares an edge with the last one, in either direction. Sometimes it is the
        // same triangle.
        const glm::uvec3& last = mesh.triangles.back();
        triangle = dice.one_in(3) ? glm::uvec3(last.x, last.y, triangle.z)
                                  : glm::uvec3(last.z, last.y, triangle.z);
        if (dice.one_in(8)) triangle = {last.y, last.z, last.x};
    }
    mesh.triangles.push_back(triangle);
}

}  // namespace

Mesh hostile_mesh(std::uint32_t seed) {
    Dice dice(seed);
    const Temper how = temper(dice);
    Mesh mesh;
    const std::uint32_t vertices = 1 + dice.below(12);
    for (std::uint32_t v = 0; v < vertices; ++v)
        add_vertex(mesh, how, dice);
    const std::uint32_t triangles = dice.below(25);
    for (std::uint32_t t = 0; t < triangles; ++t)
        add_triangle(mesh, dice);
    return mesh;
}

namespace {

/// Rows of quads between the poles of a sphere. The quads at the poles have one collapsed triangle
/// each.
Mesh sphere_with_collapsed_triangles(Dice& dice) {
    const std::uint32_t segments = 5 + dice.below(16);
    const std::uint32_t rings = 3 + dice.below(8);
    Mesh mesh;
    for (std::uint32_t y = 0; y <= rings; ++y) {
        for (std::uint32_t x = 0; x <= segments; ++x) {
            // Both sides of the seam, and all vertices of a pole, are at one position.
            const double longitude = 2.0 * std::numbers::pi * (x % segments) / segments;
            const double latitude = std::numbers::pi * y / rings;
            const double radius = y == 0 || y == rings ? 0.0 : std::sin(latitude);
            mesh.positions.emplace_back(radius * std::cos(longitude), std::cos(latitude),
                                        radius * std::sin(longitude));
            mesh.normals.push_back(mesh.positions.back());
            mesh.texcoords.emplace_back(double(x) / segments, double(y) / rings);
        }
    }
    const std::uint32_t row = segments + 1;
    for (std::uint32_t y = 0; y < rings; ++y) {
        for (std::uint32_t x = 0; x < segments; ++x) {
            const std::uint32_t corner = y * row + x;
            mesh.triangles.emplace_back(corner, corner + 1, corner + row);
            mesh.triangles.emplace_back(corner + 1, corner + row + 1, corner + row);
        }
    }
    return mesh;
}

/// A grid with steep random heights whose texture is mirrored at a line.
Mesh grid_mirrored_at_line(Dice& dice) {
    Mesh mesh = flat_grid(static_cast<int>(3 + dice.below(5)));
    const bool is_common = dice.one_in(2);
    for (glm::vec3& position : mesh.positions)
        position.z = is_common ? dice.common() : dice.any_digits();
    mesh = textured_from_above(mesh);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord.x = std::abs(texcoord.x - 2.0F);
    return mesh;
}

/// A fan of triangles between two directions that are close to each other.
Mesh needles(Dice& dice) {
    Mesh mesh;
    mesh.positions.emplace_back(0.0F);
    const std::uint32_t count = 3 + dice.below(20);
    for (std::uint32_t i = 0; i <= count; ++i) {
        const float width = std::ldexp(dice.any_digits(), -static_cast<int>(dice.below(30)));
        mesh.positions.emplace_back(1.0F, width, dice.one_in(3) ? width : 0.0F);
        if (i > 0) mesh.triangles.emplace_back(0, i, i + 1);
    }
    return textured_from_above(mesh);
}

/// Triangles between points of a small lattice.
Mesh lattice(Dice& dice) {
    Mesh mesh;
    const std::uint32_t vertices = 4 + dice.below(12);
    const auto coordinate = [&] { return 0.5F * static_cast<float>(dice.below(4)); };
    for (std::uint32_t v = 0; v < vertices; ++v) {
        mesh.positions.push_back(glm::vec3{coordinate(), coordinate(), coordinate()});
        mesh.texcoords.push_back(glm::vec2{dice.common(), dice.common()});
        mesh.normals.push_back(glm::normalize(glm::vec3{dice.common(), dice.common(), 1.5F}));
    }
    const std::uint32_t triangles = 5 + dice.below(40);
    for (std::uint32_t t = 0; t < triangles; ++t)
        mesh.triangles.push_back(
            glm::uvec3{dice.below(vertices), dice.below(vertices), dice.below(vertices)});
    return mesh;
}

}  // namespace

Mesh random_mesh(std::uint32_t seed) {
    Dice dice(seed);
    constexpr Mesh (*shapes[])(Dice&) = {sphere_with_collapsed_triangles, grid_mirrored_at_line,
                                         needles, lattice};
    Mesh mesh = shapes[seed % std::size(shapes)](dice);
    if (dice.one_in(2)) {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            mesh.smoothing_groups.push_back(dice.below(3));
    }
    return mesh;
}

}  // namespace relief::test
