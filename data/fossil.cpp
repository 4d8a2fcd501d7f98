// SPDX-License-Identifier: Apache-2.0
// The fossil is a stone with ammonites, as a scanner would see it: two square sheets of vertices,
// bent into a pillow and joined at their rims. The upper sheet carries the shells. A shell is a
// logarithmic spiral r = A W^(theta / 2 pi) [Raup 1966], so that each whorl is W times as large as
// the one before, with a rounded section and a constant number of ribs a whorl. Layers of sediment,
// weathering and grain displace the stone. Tests: tests/mesh/image/sample_data_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "samples.h"

namespace relief::sample {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr int cells = 274;  ///< Of a sheet, along each axis.

/// A shell on the upper side of the stone.
struct Shell {
    glm::dvec2 center;  ///< x and z.
    double radius;      ///< Of the last whorl.
    double turn;        ///< Of the aperture, in radians.
    double ribs;        ///< For each whorl.
    double sunk;        ///< How deep it lies in the stone.
};

constexpr std::array<Shell, 4> shells = {{
    {{-0.09, 0.03}, 0.305, 0.6, 34.0, 0.007},
    {{0.315, -0.205}, 0.125, 2.9, 26.0, 0.003},
    {{0.335, 0.175}, 0.085, 4.4, 22.0, 0.002},
    {{-0.345, -0.315}, 0.070, 1.7, 20.0, 0.002},
}};

/// The surface of a shell above the stone, and how light it is.
struct ShellPoint {
    double height = -1.0;
    double light = 0.0;
};

ShellPoint shell_point(const Shell& shell, const glm::dvec2& at) {
    constexpr double growth = 1.85;  // W, of one whorl.
    const glm::dvec2 offset = (at - shell.center) / shell.radius;
    const double radius = std::max(glm::length(offset), 0.012);
    const double turned = std::atan2(offset.y, offset.x) - shell.turn;
    const double angle = turned - two_pi * std::floor(turned / two_pi);
    // The number of whorls whose outline has the point inside.
    const double inside = angle / two_pi - 1.0 - std::log(radius) / std::log(growth);
    if (inside < 0.0) return {};
    const double whorl = std::floor(inside);
    const double across = 1.0 - (inside - whorl);  // 0 at the inner seam of a whorl, 1 outside.
    const double size = std::pow(growth, angle / two_pi - 1.0 - whorl);  // 1 at the aperture.
    const double section = std::pow(std::max(0.0, 1.0 - std::pow(2.0 * across - 1.0, 2.0)), 0.6);
    const double bent = 2.2 * (across - 0.4) * (across - 0.4);
    const double phase = shell.ribs * (angle - two_pi * whorl - bent);
    // Each second rib begins only in the outer half.
    const double rib = std::pow(0.5 + 0.5 * std::cos(phase), 1.6);
    const double between =
        std::pow(0.5 - 0.5 * std::cos(phase), 1.6) * smooth_step(0.45, 0.8, across);
    const double ribbed = std::max(rib, 0.8 * between);
    const double body = size * (0.05 + 0.17 * section) * (1.0 + 0.16 * section * ribbed);
    return {shell.radius * body - shell.sunk, 0.25 + 0.55 * ribbed * section + 0.2 * section};
}

/// A point of a sheet.
struct StonePoint {
    glm::dvec3 position{0.0};
    glm::dvec3 color{0.0};  ///< Linear.
};

glm::dvec3 stone_color(const glm::dvec3& p, double grain) {
    const double layer = octaves(2.0 * p.x, 26.0 * p.y, 2.0 * p.z, 3, 411);
    const double stain = octaves(5.0 * p.x, 5.0 * p.y, 5.0 * p.z, 4, 431);
    const glm::dvec3 color = mixed({0.30, 0.235, 0.16}, {0.44, 0.37, 0.27}, 0.5 + 0.5 * layer);
    return mixed(color, {0.23, 0.10, 0.045}, 0.7 * smooth_step(0.05, 0.6, stain)) *
           (1.0 + 0.22 * grain);
}

StonePoint stone_point(double u, double v, double side) {
    // A square onto a rounded square. Rows are closer together at the rim, where the stone is
    // steep.
    const double square = std::sqrt(1.0 - (1.0 - u * u) * (1.0 - v * v));
    const double shrunk = 1.3 - 0.3 * square * square;
    const glm::dvec2 bent =
        glm::dvec2(u * std::sqrt(1.0 - 0.42 * v * v), v * std::sqrt(1.0 - 0.42 * u * u));
    const double out = square * shrunk;
    const double rise = std::sqrt(std::max(0.0, 1.0 - out * out * out * out));
    glm::dvec3 p(0.56 * shrunk * bent.x, side * 0.115 * rise, 0.48 * shrunk * bent.y);
    // Layers of different hardness form the edge, chips the outline.
    const double layer = octaves(1.5 * p.x, 34.0 * p.y, 1.5 * p.z, 2, 401);
    const double chips = octaves(3.1 * p.x, 4.0 * p.y, 3.1 * p.z, 4, 405);
    const double steep = smooth_step(0.75, 1.0, out);
    const double widened = 1.0 + steep * (0.022 * layer + 0.07 * chips);
    p.x *= widened;
    p.z *= widened;
    const double waves = octaves(4.0 * p.x, 4.0 * side, 4.0 * p.z, 5, 409);
    const double grain = octaves(60.0 * p.x, 60.0 * p.y, 60.0 * p.z, 3, 419);
    p.y += side * rise * (0.018 * waves + 0.0022 * grain);
    StonePoint point{p, stone_color(p, grain)};
    if (side < 0.0) return point;
    for (const Shell& shell : shells) {
        const ShellPoint at = shell_point(shell, {p.x, p.z});
        // Remains of stone cover a part of the shells.
        const double crust = octaves(9.0 * p.x, 9.0 * p.z, 3.0, 4, 443);
        const double above = at.height - 0.05 * smooth_step(0.35, 0.75, crust);
        if (above <= 0.0) continue;
        point.position.y += rise * (above + 0.0008 * grain);
        const double worn = octaves(16.0 * p.x, 16.0 * p.z, 7.0, 4, 457);
        const glm::dvec3 shine = mixed({0.055, 0.026, 0.012}, {0.50, 0.34, 0.16}, at.light);
        point.color = mixed(shine, {0.20, 0.22, 0.15}, 0.6 * smooth_step(0.1, 0.7, worn)) *
                      (1.0 + 0.08 * grain);
    }
    return point;
}

/// Each grid point of a sheet; the lower one has no rim of its own.
class Sheets {
  public:
    explicit Sheets(Mesh& mesh) : mesh_(mesh) {
        for (const double side : {1.0, -1.0}) {
            for (int row = 0; row <= cells; ++row) {
                for (int column = 0; column <= cells; ++column) {
                    if (side > 0.0 || !is_rim(row, column)) add(row, column, side);
                }
            }
        }
    }

    std::uint32_t upper(int row, int column) const {
        return static_cast<std::uint32_t>(row * (cells + 1) + column);
    }
    std::uint32_t lower(int row, int column) const {
        if (is_rim(row, column)) return upper(row, column);
        return static_cast<std::uint32_t>((cells + 1) * (cells + 1) + (row - 1) * (cells - 1) +
                                          column - 1);
    }

  private:
    static bool is_rim(int row, int column) {
        return row == 0 || column == 0 || row == cells || column == cells;
    }
    void add(int row, int column, double side) {
        const StonePoint point =
            stone_point(2.0 * column / cells - 1.0, 2.0 * row / cells - 1.0, side);
        mesh_.positions.emplace_back(rounded(point.position.x), rounded(point.position.y),
                                     rounded(point.position.z));
        // Multiples of 1/255, which the file stores as bytes.
        const glm::dvec3 color = glm::round(glm::clamp(point.color, 0.0, 1.0) * 255.0) / 255.0;
        mesh_.colors.emplace_back(glm::vec3(color), 1.0F);
    }

    Mesh& mesh_;
};

}  // namespace

Mesh fossil() {
    Mesh mesh;
    mesh.name = "fossil";
    const Sheets sheets(mesh);
    for (int row = 0; row < cells; ++row) {
        for (int column = 0; column < cells; ++column) {
            // The diagonals point to the middle: no triangle lies in both sheets.
            const bool falls = (2 * row < cells) == (2 * column < cells);
            for (const bool is_upper : {true, false}) {
                const auto corner = [&](int down, int right) {
                    return is_upper ? sheets.upper(row + down, column + right)
                                    : sheets.lower(row + down, column + right);
                };
                std::array<std::uint32_t, 4> ring = {corner(0, 0), corner(1, 0), corner(1, 1),
                                                     corner(0, 1)};
                if (!falls) std::rotate(ring.begin(), ring.begin() + 1, ring.end());
                if (!is_upper) std::swap(ring[1], ring[3]);
                mesh.triangles.emplace_back(ring[0], ring[1], ring[2]);
                mesh.triangles.emplace_back(ring[0], ring[2], ring[3]);
            }
        }
    }
    return mesh;
}

}  // namespace relief::sample
