// SPDX-License-Identifier: Apache-2.0
// A chart in the middle of a map, slanting at 37 degrees, on a flat background. Where it is to be
// seen in a smaller level of the map, it should slant as it does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bake_errors/error_tables.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/mip_levels.h"
#include "relief/mesh/shapes.h"

namespace relief::test {
namespace {

constexpr int padded_map_side = 256;
constexpr int levels = 6;
/// Corners of the chart, over the map: on no texel's border at any level.
constexpr float chart_begin = 0.3134F;
constexpr float chart_end = 0.6921F;
constexpr glm::vec3 slant{0.6F, 0.0F, 0.8F};

Image baked(int padding) {
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord = chart_begin + (chart_end - chart_begin) * texcoord;
    Mesh high = low;
    std::fill(high.normals.begin(), high.normals.end(), slant);
    Image map = make_image(padded_map_side, padded_map_side, 3, 32, ColorSpace::data);
    BakeOptions options;
    options.width = options.height = padded_map_side;
    options.padding = padding;
    options.space = BakeSpace::object;
    Report report;
    bake_normals(
        std::span(&high, 1), low, options,
        [&](const BakedRows& rows) {
            std::copy(
                rows.normals.begin(), rows.normals.end(),
                map.as<float>().begin() + std::ptrdiff_t{3} * padded_map_side * rows.first_row);
        },
        report);
    return map;
}

/// The greatest error of what a bilinear look-up within the chart can see: a texel around it too.
double greatest_error(const Image& level) {
    const auto seen = [&](double edge, double by) {
        return static_cast<int>(std::floor(edge * level.width - 0.5 + by));
    };
    double greatest = 0.0;
    for (int y = seen(chart_begin, 0.0); y <= seen(chart_end, 1.0); ++y) {
        for (int x = seen(chart_begin, 0.0); x <= seen(chart_end, 1.0); ++x) {
            const float* const n =
                &level.as<float>()[3 * static_cast<std::size_t>(y * level.width + x)];
            greatest = std::max(greatest,
                                degrees_between(glm::dvec3(n[0], n[1], n[2]), glm::dvec3(slant)));
        }
    }
    return greatest;
}

}  // namespace

std::string padding_tables() {
    std::vector<std::string> columns = {"the map itself"};
    for (int level = 1; level < levels; ++level)
        columns.push_back(fmt::format("level {}", level));
    std::string text =
        "\nThe greatest error in degrees of what filtering can see of the chart\n\n" +
        table_header(columns);
    for (const int padding : {0, 1, 2, 4, 8, 16, 32, 64}) {
        const Image map = baked(padding);
        std::vector<std::string> cells = {in_digits(greatest_error(map))};
        const std::vector<Image> smaller = mip_levels(map);
        for (int level = 1; level < levels; ++level)
            cells.push_back(
                in_digits(greatest_error(smaller[static_cast<std::size_t>(level - 1)])));
        text += table_row(fmt::format("`--padding {}`", padding),
                          std::vector<double>(cells.size(), NAN), cells);
    }
    return text;
}

}  // namespace relief::test
