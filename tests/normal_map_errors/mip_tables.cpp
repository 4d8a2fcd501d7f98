// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "normal_map_errors/error_tables.h"
#include "relief/mesh/normal_map_operations.h"
#include "relief/mesh/normal_mips.h"
#include "support/resized_waves.h"

namespace relief::test {
namespace {

constexpr int mip_side = 64;

/// The mean of both axes' variances of the slopes, over the whole map.
double slope_variance(const Image& normals) {
    Report report;
    const Image slopes = slopes_from_normals(normals, report);
    double sum[2] = {};
    double squares = 0.0;
    for (std::size_t i = 0; i < slopes.sample_count(); ++i) {
        const auto slope = static_cast<double>(slopes.as<float>()[i]);
        sum[i % 2] += slope;
        squares += slope * slope;
    }
    const auto count = static_cast<double>(slopes.sample_count() / 2);
    return (squares / count - std::pow(sum[0] / count, 2) - std::pow(sum[1] / count, 2)) / 2.0;
}

std::string row_of(double rms_slope) {
    const Image normals =
        normals_image(mip_side, mip_side, waves_with_slope(mip_side, 60, 4, rms_slope, 51));
    const std::vector<Image> levels = normal_mip_levels(normals);
    const auto mean = levels.back().as<float>();
    const double length = glm::length(glm::dvec3(mean[0], mean[1], mean[2]));
    const double ground_truth = slope_variance(normals);
    const double found = slope_variance_of_length(length);
    const double toksvig = (1.0 - length) / length;
    constexpr double base = 0.3;
    const std::vector<std::string> cells = {
        fmt::format("{:.4f}", length),
        fmt::format("{:.4f}", ground_truth),
        fmt::format("{:.4f}", found),
        fmt::format("{:.4f}", toksvig),
        fmt::format("{:.3f}", roughness_with_variance(base, ground_truth)),
        fmt::format("{:.3f}", roughness_with_variance(base, found))};
    return table_row(fmt::format("rms slope {:g}", rms_slope), std::vector<double>(6, NAN), cells);
}

}  // namespace

std::string mip_tables() {
    std::string text =
        "\nAll of a map in one texel: the variance of its slopes along each axis, and the "
        "roughness "
        "that makes up for it on a surface of 0.3\n\n" +
        table_header({"mean length", "true variance", "from the length", "by Toksvig",
                      "true roughness", "from the length"});
    for (const double slope : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6})
        text += row_of(slope);
    return text;
}

std::vector<PageSection> normal_map_tables() {
    const auto section = [](const std::string& name, const std::string& text) {
        return PageSection{
            fmt::format("<!-- {}: written by relief-normal-map-errors-page -->\n", name),
            text + "\n"};
    };
    return {section("blending", blend_tables()), section("resizing", resize_tables()),
            section("storage", storage_tables()), section("mips", mip_tables())};
}

}  // namespace relief::test
