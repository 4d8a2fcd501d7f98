// SPDX-License-Identifier: Apache-2.0
/// \file
/// Inputs that programs for unwrapping find hard, for tests and for relief-unwrap-bench: many
/// parts, slivers, edges of many triangles, and surfaces without an orientation.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

/// Numbers within [0, 1), the same on every machine.
class InputDice {
  public:
    float operator()() { return static_cast<float>(random_()) / 4294967296.0F; }
    glm::vec3 point() {
        const float x = (*this)();
        const float y = (*this)();
        return {x, y, (*this)()};
    }
    std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>(random_()) % count;
    }

  private:
    std::mt19937 random_{1};
};

inline void append_triangle(Mesh& mesh, const glm::vec3& a, const glm::vec3& b,
                            const glm::vec3& c) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.emplace_back(first, first + 1, first + 2);
}

/// Separate triangles in a box, of up to `size`.
inline Mesh soup(int count, float size) {
    Mesh mesh;
    InputDice dice;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 origin = dice.point();
        const glm::vec3 a = origin + size * dice.point();
        const glm::vec3 b = origin + size * dice.point();
        append_triangle(mesh, a, b, origin + size * dice.point());
    }
    return mesh;
}

/// Separate triangles as long as 1, and `width` wide.
inline Mesh separate_slivers(int count, float width) {
    Mesh mesh;
    InputDice dice;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 origin = 40.0F * dice.point();
        const glm::vec3 along = glm::normalize(dice.point() - 0.5F);
        append_triangle(mesh, origin, origin + along,
                        origin + width * glm::vec3(along.y, -along.x, 0.0F));
    }
    return mesh;
}

inline Mesh tetrahedra(int count) {
    Mesh mesh;
    InputDice dice;
    for (int i = 0; i < count; ++i) {
        const auto f = static_cast<std::uint32_t>(mesh.positions.size());
        const glm::vec3 origin(i % 24, i / 24 % 24, i / 576);
        for (int k = 0; k < 4; ++k)
            mesh.positions.push_back(origin + 0.5F * glm::vec3(k == 1, k == 2, k == 3) +
                                     0.05F * dice.point());
        mesh.triangles.insert(
            mesh.triangles.end(),
            {{f, f + 2, f + 1}, {f, f + 1, f + 3}, {f + 1, f + 2, f + 3}, {f, f + 3, f + 2}});
    }
    return mesh;
}

/// A strip of quadrilaterals of 1 x `step`, straight or around a cylinder.
inline Mesh sliver_strip(std::uint32_t count, double step, bool is_closed) {
    Mesh mesh;
    const double radius = count * step / (2.0 * std::numbers::pi);
    for (std::uint32_t i = 0; i < count + (is_closed ? 0 : 1); ++i) {
        const double turn = i * step / radius;
        for (const double y : {0.0, 1.0})
            mesh.positions.emplace_back(is_closed ? radius * std::cos(turn) : i * step, y,
                                        is_closed ? radius * std::sin(turn) : 0.0);
    }
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = 2 * i;
        const std::uint32_t b = (2 * i + 2) % vertices;
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    }
    return mesh;
}

/// Triangles around a vertex, in 20 folds.
inline Mesh folded_fan(std::uint32_t count) {
    Mesh mesh;
    mesh.positions.emplace_back(0.0F);
    for (std::uint32_t i = 0; i <= count; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / count;
        mesh.positions.emplace_back(std::cos(turn), 0.3 * std::sin(20.0 * turn), std::sin(turn));
    }
    for (std::uint32_t i = 0; i < count; ++i)
        mesh.triangles.emplace_back(0, i + 2, i + 1);
    return mesh;
}

/// Triangles that share one edge, around which they are evenly distributed.
inline Mesh book(std::uint32_t pages) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}};
    for (std::uint32_t i = 0; i < pages; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / pages;
        mesh.positions.emplace_back(std::cos(turn), std::sin(turn), 0.5);
        mesh.triangles.emplace_back(i % 2, 1 - i % 2, i + 2);
    }
    return mesh;
}

/// Random triangles of a few vertices.
inline Mesh tangle(std::size_t count, std::uint32_t vertices) {
    Mesh mesh;
    InputDice dice;
    for (std::uint32_t i = 0; i < vertices; ++i)
        mesh.positions.push_back(dice.point());
    while (mesh.triangles.size() < count) {
        const std::uint32_t a = dice.below(vertices);
        const std::uint32_t b = dice.below(vertices);
        const std::uint32_t c = dice.below(vertices);
        if (a != b && b != c && a != c) mesh.triangles.emplace_back(a, b, c);
    }
    return mesh;
}

/// Pairs of triangles that touch in one vertex.
inline Mesh bow_ties(int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const auto f = static_cast<std::uint32_t>(mesh.positions.size());
        const glm::vec3 o(i % 50, i / 50, 0);
        for (const glm::vec2& p :
             {glm::vec2(0, 0), {0.4F, 0.2F}, {0.4F, -0.2F}, {-0.4F, 0.2F}, {-0.4F, -0.2F}})
            mesh.positions.push_back(o + glm::vec3(p, 0.0F));
        mesh.triangles.insert(mesh.triangles.end(), {{f, f + 2, f + 1}, {f, f + 3, f + 4}});
    }
    return mesh;
}

/// A strip of `count` quadrilaterals that is joined to itself after half a twist.
inline Mesh moebius_strip(std::uint32_t count) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / count;
        for (const double side : {-0.3, 0.3}) {
            const double radius = 1.0 + side * std::cos(0.5 * turn);
            mesh.positions.emplace_back(radius * std::cos(turn), radius * std::sin(turn),
                                        side * std::sin(0.5 * turn));
        }
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = 2 * i;
        const bool is_last = i + 1 == count;
        const std::uint32_t c = is_last ? 0 : a + 3;
        mesh.triangles.emplace_back(a, is_last ? 1 : a + 2, c);
        mesh.triangles.emplace_back(a, c, a + 1);
    }
    return mesh;
}

inline Mesh klein_bottle(std::uint32_t around, std::uint32_t across) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < across; ++j) {
            const double u = 2.0 * std::numbers::pi * i / around;
            const double v = 2.0 * std::numbers::pi * j / across;
            const double half = 0.5 * u;
            const double radius =
                2.0 + std::cos(half) * std::sin(v) - std::sin(half) * std::sin(2.0 * v);
            mesh.positions.emplace_back(
                radius * std::cos(u), radius * std::sin(u),
                std::sin(half) * std::sin(v) + std::cos(half) * std::sin(2.0 * v));
        }
    }
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        return i == around ? (across - j % across) % across : i * across + j % across;
    };
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < across; ++j) {
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return mesh;
}

/// The hard inputs by their names.
inline std::vector<std::pair<std::string, Mesh>> hard_unwrap_meshes() {
    return {{"5,000 separate triangles", soup(5000, 0.1F)},
            {"12,000 separate triangles", soup(12'000, 0.1F)},
            {"12,000 tetrahedra", tetrahedra(12'000)},
            {"12,000 separate slivers, 1000 : 1", separate_slivers(12'000, 1e-3F)},
            {"strip of 12,000 slivers, 1000 : 1", sliver_strip(6000, 1e-3, false)},
            {"strip of 12,000 slivers, 10,000 : 1", sliver_strip(6000, 1e-4, false)},
            {"closed strip of 12,000 slivers, 1000 : 1", sliver_strip(6000, 1e-3, true)},
            {"folded fan of 5,000", folded_fan(5000)},
            {"book of 5,000", book(5000)},
            {"5,000 random triangles of 200 vertices", tangle(5000, 200)},
            {"2,500 bow-ties", bow_ties(2500)},
            {"Möbius strip", moebius_strip(2400)},
            {"Klein bottle", klein_bottle(100, 50)}};
}

}  // namespace relief::test
