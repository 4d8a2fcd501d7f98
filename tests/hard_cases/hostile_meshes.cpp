// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/hostile_meshes.h"

#include <cmath>
#include <limits>
#include <random>

namespace relief::test {
namespace {

/// Draws, in the order of calls (hence braces around several); not by the standard's distributions,
/// which differ between libraries.
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : generator_(seed) {}

    std::uint32_t below(std::uint32_t limit) {
        return static_cast<std::uint32_t>(generator_()) % limit;
    }
    bool one_in(std::uint32_t n) { return below(n) == 0; }

    /// A multiple of 1/4 from -1 to 1, so that values coincide and cancel often.
    float common() { return 0.25F * static_cast<float>(below(9)) - 1.0F; }

    /// Any digits, from -1 to 1.
    float any_digits() { return static_cast<float>(generator_()) * 0x1p-31F - 1.0F; }

    float special() {
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

    /// \param rarity  one in so many is special
    float value(std::uint32_t rarity, bool is_common) {
        if (one_in(rarity)) return special();
        return is_common ? common() : any_digits();
    }

  private:
    std::mt19937 generator_;
};

/// How the values of a mesh are drawn.
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
        // On an edge of the last one, either way round; now and then the same triangle again.
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

}  // namespace relief::test
