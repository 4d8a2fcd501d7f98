// SPDX-License-Identifier: Apache-2.0
// A cube baked onto one a tenth smaller, whose edges are hard. The high cube's normals say where on
// it they are: each points away from the cube's centre. So a baked normal tells which place the ray
// met.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bake_errors/error_tables.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/shapes.h"

namespace relief::test {
namespace {

constexpr int direction_map_side = 64;
constexpr double outside = 1.1;

/// One face, +z, of a cube of half size 1 made of cells x cells cells, and the five others whole:
/// the map shows the one alone.
Mesh low_cube(int cells) {
    Mesh cube = make_cube();
    cube.triangles.erase(cube.triangles.begin(), cube.triangles.begin() + 2);
    for (glm::vec2& texcoord : cube.texcoords)
        texcoord += glm::vec2(4.0F);
    Mesh face = make_quad(cells);
    for (glm::vec3& position : face.positions)
        position.z = 1.0F;
    const auto first = static_cast<std::uint32_t>(cube.positions.size());
    for (std::size_t i = 0; i < face.positions.size(); ++i) {
        cube.positions.push_back(face.positions[i]);
        cube.normals.push_back({0, 0, 1});
        cube.texcoords.push_back(face.texcoords[i]);
    }
    for (const glm::uvec3& triangle : face.triangles)
        cube.triangles.push_back(triangle + first);
    return cube;
}

Mesh high_cube() {
    Mesh cube = make_cube();
    for (std::size_t i = 0; i < cube.positions.size(); ++i) {
        cube.normals[i] = cube.positions[i];
        cube.positions[i] *= static_cast<float>(outside);
    }
    return cube;
}

struct Kept {
    double seen = 0.0;    ///< Share of the high face's side that the map holds.
    double skewed = 0.0;  ///< The furthest that a place is moved along the face, over its height.
};

Kept kept(const Mesh& low, BakeOptions options) {
    options.width = options.height = direction_map_side;
    options.space = BakeSpace::object;
    options.offset = 0.2;
    options.max_distance = 0.1;
    Kept result;
    const Mesh high = high_cube();
    Report report;
    bake_normals(
        std::span(&high, 1), low, options,
        [&](const BakedRows& rows) {
            for (std::size_t i = 0; i < rows.states.size(); ++i) {
                if (rows.states[i] != TexelState::baked) continue;
                const float* const n = &rows.normals[3 * i];
                const glm::dvec2 met = outside / double{n[2]} * glm::dvec2(n[0], n[1]);
                const auto x = static_cast<double>(i % direction_map_side);
                const auto y = static_cast<double>(i / direction_map_side) + rows.first_row;
                const glm::dvec2 from((x + 0.5) / direction_map_side * 2.0 - 1.0,
                                      1.0 - (y + 0.5) / direction_map_side * 2.0);
                // Half a texel beyond the outermost centre ends what the map holds.
                const double end = std::max(std::abs(met.x), std::abs(met.y)) * direction_map_side /
                                   (direction_map_side - 1.0);
                result.seen = std::max(result.seen, std::min(end / outside, 1.0));
                result.skewed = std::max(result.skewed, glm::length(met - from) / (outside - 1.0));
            }
        },
        report);
    return result;
}

std::string row(const std::string& name, const BakeOptions& options) {
    std::vector<std::string> cells;
    for (const int cells_of_face : {1, 8}) {
        const Kept result = kept(low_cube(cells_of_face), options);
        cells.push_back(fmt::format("{:.0f}%", 100.0 * (1.0 - result.seen * result.seen)));
        cells.push_back(fmt::format("{:.2f}", result.skewed));
    }
    return table_row(name, std::vector<double>(cells.size(), NAN), cells);
}

}  // namespace

std::string direction_tables() {
    std::string text =
        "\nHow much of the high face no texel holds, and how far along the face a place is moved "
        "at "
        "most, in units of its height above the low face\n\n" +
        table_header(
            {"not held, face of 2 triangles", "moved", "not held, face of 128 triangles", "moved"});
    text += row("`--rays averaged` (default)", {});
    for (const double hardness : {0.5, 1.0}) {
        BakeOptions options;
        options.hardness = hardness;
        text += row(fmt::format("`--hardness {:g}`", hardness), options);
    }
    BakeOptions shading;
    shading.directions = RayDirections::shading;
    text += row("`--rays shading`", shading);
    BakeOptions face;
    face.directions = RayDirections::face;
    text += row("`--rays face`", face);
    return text;
}

}  // namespace relief::test
