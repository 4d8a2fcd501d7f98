// SPDX-License-Identifier: Apache-2.0
// A wall of weathered bricks, evaluated texel by texel over the unit square, which it tiles.
// A brick is a rounded block with noise and chips along its outline. Its face has waves, pores and
// fine grain. The mortar is sandy and concave. Heights are from 0 to 1.
// Tests: tests/mesh/image/sample_data_test.cpp.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "samples.h"

namespace relief::sample {
namespace {

constexpr int courses = 8;
constexpr int bricks_per_course = 4;
// All lengths below are in thousandths of the tile's side.
constexpr double unit = 0.001;
constexpr double brick_length = 1000.0 / bricks_per_course;
constexpr double brick_height = 1000.0 / courses;
constexpr double half_joint = 6.0;
constexpr double bevel = 13.0;

/// The random properties of a brick.
struct Brick {
    std::int32_t column;
    std::int32_t course;

    [[nodiscard]] double chance(std::uint32_t which) const {
        return random(column, course, 100 + which);
    }
    [[nodiscard]] double spread(std::uint32_t which) const { return 2.0 * chance(which) - 1.0; }
};

/// The properties of a point of the wall that height and color share.
struct WallPoint {
    Brick brick;
    double inside;     ///< Distance from the brick's worn outline; negative in the joint.
    double from_left;  ///< Position within the brick, -1 to 1.
    double from_top;
    double wear;   ///< Weathering, 0 to 1: noise of low frequency.
    double pores;  ///< Depth of pores, 0 to 1.
    double grain;  ///< Noise of the highest frequency.
    double crack;  ///< 1 in the center of a crack, 0 outside.
};

/// The distance from the border of a rectangle with round corners, positive inside.
/// \param half  half of its sides
double inside_rounded(glm::dvec2 from_center, glm::dvec2 half, double radius) {
    const glm::dvec2 beyond = glm::abs(from_center) - (half - radius);
    const double outside = std::sqrt(std::max(beyond.x, 0.0) * std::max(beyond.x, 0.0) +
                                     std::max(beyond.y, 0.0) * std::max(beyond.y, 0.0));
    return radius - outside - std::min(std::max(beyond.x, beyond.y), 0.0);
}

/// Round holes of random size, at most one per lattice cell: 1 in the center, 0 outside.
double holes(double x, double y, std::int32_t cells, double share, std::uint32_t seed) {
    const double cx = x * cells;
    const double cy = y * cells;
    double deepest = 0.0;
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
        for (std::int32_t dx = -1; dx <= 1; ++dx) {
            const auto column = static_cast<std::int32_t>(std::floor(cx)) + dx;
            const auto row = static_cast<std::int32_t>(std::floor(cy)) + dy;
            const std::int32_t c = (column % cells + cells) % cells;
            const std::int32_t r = (row % cells + cells) % cells;
            if (random(c, r, seed) > share) continue;
            const double radius = 0.18 + 0.30 * random(c, r, seed + 1);
            const double px = cx - column - (0.3 + 0.4 * random(c, r, seed + 2));
            const double py = cy - row - (0.3 + 0.4 * random(c, r, seed + 3));
            const double square = (px * px + py * py) / (radius * radius);
            deepest = std::max(deepest, (1.0 - square) * (0.5 + 0.5 * random(c, r, seed + 4)));
        }
    }
    return std::max(deepest, 0.0);
}

/// The depth of chips in the outline. Large chips are rare, small ones frequent; corners have more.
double chips(double x, double y, const Brick& brick, double corner) {
    const double broad = tiling_octaves(x, y, 20, 3, 300);
    const double fine = tiling_octaves(x, y, 56, 2, 310);
    const double luck = 0.16 * brick.chance(1) + 0.16 * corner;
    return 34.0 * std::max(broad - 0.44 + luck, 0.0) + 6.0 * std::max(fine - 0.30 + luck, 0.0);
}

WallPoint wall_point(double x, double y) {
    // The outline is displaced at two scales: that of hand-made bricks, and that of broken edges.
    const double bent_x =
        x + unit * (3.2 * tiling_octaves(x, y, 12, 2, 1) + 1.3 * tiling_octaves(x, y, 64, 2, 2));
    const double bent_y =
        y + unit * (2.6 * tiling_octaves(x, y, 12, 2, 3) + 1.3 * tiling_octaves(x, y, 64, 2, 4));
    const double row = bent_y * courses;
    const auto course = static_cast<std::int32_t>(std::floor(row));
    const double shift = (course % 2 + 2) % 2 * 0.5;
    const double column = bent_x * bricks_per_course + shift;
    const auto index = static_cast<std::int32_t>(std::floor(column));

    WallPoint point{};
    point.brick = {(index % bricks_per_course + bricks_per_course) % bricks_per_course,
                   (course % courses + courses) % courses};
    const Brick& brick = point.brick;
    glm::dvec2 from_center((column - index - 0.5) * brick_length,
                           (row - course - 0.5) * brick_height);
    from_center -= glm::dvec2(2.2 * brick.spread(2), 1.6 * brick.spread(3));
    from_center.y += from_center.x * 0.012 * brick.spread(4);
    const glm::dvec2 half(brick_length / 2.0 - half_joint - 1.6 * brick.chance(5),
                          brick_height / 2.0 - half_joint - 1.2 * brick.chance(6));
    point.from_left = from_center.x / half.x;
    point.from_top = from_center.y / half.y;
    const double corner =
        smooth_step(1.5, 2.0, std::abs(point.from_left) + std::abs(point.from_top));
    point.inside =
        inside_rounded(from_center, half, 6.0 + 7.0 * brick.chance(7)) - chips(x, y, brick, corner);
    point.wear = 0.5 + 0.5 * tiling_octaves(x, y, 4, 4, 20);
    // Pores are irregular: noise of about their size displaces them.
    const double torn_x = x + unit * 4.0 * tiling_octaves(x, y, 90, 2, 31);
    const double torn_y = y + unit * 4.0 * tiling_octaves(x, y, 90, 2, 33);
    const double fired_hard = brick.chance(8) * brick.chance(8);
    point.pores = std::max(holes(torn_x, torn_y, 40, 0.05 + 0.20 * fired_hard, 400),
                           0.7 * holes(torn_x, torn_y, 110, 0.08 + 0.16 * fired_hard, 410));
    point.grain = tiling_octaves(x, y, 128, 2, 30);
    // A crack is where noise of low frequency changes its sign, in one brick of five.
    const double ridge = std::abs(tiling_octaves(x, y, 14, 3, 40));
    const double open = brick.chance(9) < 0.22 ? 1.0 : 0.0;
    point.crack = open * smooth_step(0.075, 0.0, ridge) *
                  smooth_step(0.35, 0.65, point.wear + 0.2 * brick.spread(10));
    return point;
}

double mortar_height(double x, double y, const WallPoint& point) {
    const double hollow = smooth_step(-half_joint, 1.0, point.inside);
    return 0.20 + 0.05 * hollow + 0.050 * tiling_octaves(x, y, 40, 3, 50) + 0.030 * point.grain +
           0.035 * holes(x, y, 150, 0.5, 420);
}

double brick_face(double x, double y, const WallPoint& point) {
    const Brick& brick = point.brick;
    const double tilt =
        0.035 * (brick.spread(11) * point.from_left + brick.spread(12) * point.from_top);
    const double waves =
        0.075 * tiling_octaves(x, y, 16, 2, 60) + 0.045 * tiling_octaves(x, y, 48, 3, 61);
    // Flakes of the burnt surface are missing, which gives a ragged step.
    const double skin = tiling_octaves(x, y, 9, 5, 70) + 0.35 * brick.spread(13);
    const double flaked = 0.060 * smooth_step(0.22, 0.30, skin);
    return 0.80 + 0.07 * brick.spread(14) + tilt + waves - flaked - 0.14 * point.pores -
           0.13 * point.crack + (0.010 + 0.012 * brick.chance(15)) * point.grain;
}

double height_at(double x, double y) {
    const WallPoint point = wall_point(x, y);
    const double mortar = mortar_height(x, y, point);
    if (point.inside <= 0.0) return mortar;
    // The edge is rounded from the joint to the face, and never vertical.
    const double left = 1.0 - std::min(point.inside / bevel, 1.0);
    return mix(mortar, brick_face(x, y, point), 1.0 - left * left * left);
}

/// Linear diffuse color.
glm::dvec3 color_at(double x, double y) {
    const WallPoint point = wall_point(x, y);
    const Brick& brick = point.brick;
    // Fired clay: from orange over red to nearly black; some bricks are pale.
    const glm::dvec3 orange(0.46, 0.165, 0.072);
    const glm::dvec3 red(0.30, 0.078, 0.042);
    const glm::dvec3 burnt(0.105, 0.052, 0.044);
    const glm::dvec3 pale(0.50, 0.30, 0.18);
    const double fired = brick.chance(20);
    glm::dvec3 clay = fired < 0.55 ? mixed(orange, red, fired / 0.55)
                                   : mixed(red, burnt, smooth_step(0.55, 1.0, fired));
    if (brick.chance(21) > 0.90) clay = mixed(clay, pale, 0.7);
    const double cloud = tiling_octaves(x, y, 10, 4, 80);
    clay = mixed(clay, burnt, 0.45 * smooth_step(0.05, 0.75, cloud + 0.5 * brick.spread(22)));
    const double skin = tiling_octaves(x, y, 9, 5, 70) + 0.35 * brick.spread(13);
    clay = mixed(clay, clay * 1.25 + glm::dvec3(0.02, 0.008, 0.002), smooth_step(0.22, 0.30, skin));
    clay *= 1.0 + 0.16 * point.grain + 0.10 * tiling_octaves(x, y, 48, 3, 61);
    clay *= 1.0 - 0.55 * point.pores - 0.6 * point.crack;
    // Water has washed lime out of the joints onto the bricks.
    const double bloom =
        smooth_step(0.45, 1.0, point.wear + 0.22 * cloud) * smooth_step(26.0, 2.0, point.inside);
    clay = mixed(clay, glm::dvec3(0.50, 0.46, 0.41), 0.30 * bloom);

    glm::dvec3 mortar = mixed(glm::dvec3(0.40, 0.36, 0.30), glm::dvec3(0.24, 0.21, 0.175),
                              smooth_step(0.3, 0.8, point.wear));
    mortar *= 1.0 + 0.20 * point.grain + 0.18 * tiling_octaves(x, y, 40, 3, 50) -
              0.35 * holes(x, y, 150, 0.5, 420);
    return glm::max(mixed(mortar, clay, smooth_step(0.0, 3.0, point.inside)), glm::dvec3(0.004));
}

}  // namespace

Image brick_heights(int size) {
    Image image = make_image(size, size, 1, 16, ColorSpace::data);
    // Heights are multiples of 128, half a step of 8 bits. Finer grain would increase the file size
    // without a visible effect.
    constexpr double step = 128.0;
    auto sample = image.as<std::uint16_t>().begin();
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const double height = height_at((column + 0.5) / size, (row + 0.5) / size);
            *sample++ = static_cast<std::uint16_t>(
                std::floor(std::clamp(height, 0.0, 1.0) * (65535.0 - step) / step + 0.5) * step);
        }
    }
    return image;
}

Image brick_colors(int size) {
    Image linear = make_image(size, size, 3, 32, ColorSpace::linear);
    auto sample = linear.as<float>().begin();
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            glm::dvec3 sum(0.0);
            for (const glm::dvec2 corner :
                 {glm::dvec2(0.25, 0.25), {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}})
                sum += color_at((column + corner.x) / size, (row + corner.y) / size);
            for (int channel = 0; channel < 3; ++channel)
                *sample++ = static_cast<float>(sum[channel] / 4.0);
        }
    }
    return to_srgb(linear, 8);
}

}  // namespace relief::sample
