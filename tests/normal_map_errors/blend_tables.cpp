// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "normal_map_errors/error_tables.h"
#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/normal_blend.h"
#include "support/resized_waves.h"

namespace relief::test {
namespace {

constexpr int blend_side = 128;

/// The words of `relief-bake convert --blend`, in the order of all_normal_blends.
const std::vector<std::string> blend_names = {
    "reoriented", "partial-derivative", "whiteout", "udn", "unity", "linear", "overlay"};

using Waves = std::vector<HeightWave>;

/// Of waves, at any place: the height and its slope along x and along y, y upwards.
struct Surface {
    double height = 0.0;
    glm::dvec2 slope{};
};

/// \param place  in texels, y upwards
Surface surface_at(const Waves& waves, const glm::dvec2& place) {
    Surface result;
    for (const HeightWave& wave : waves) {
        const double angle = wave.frequency.x * place.x - wave.frequency.y * place.y + wave.phase;
        result.height += wave.amplitude * std::sin(angle);
        result.slope +=
            wave.amplitude * std::cos(angle) * glm::dvec2(wave.frequency.x, -wave.frequency.y);
    }
    return result;
}

/// The base with the detail standing on it along its normals.
glm::dvec3 carved_point(const Waves& base, const Waves& detail, const glm::dvec2& place) {
    const Surface under = surface_at(base, place);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-under.slope, 1.0));
    return glm::dvec3(place, under.height) + surface_at(detail, place).height * normal;
}

/// Its normals, by central differences so close that their own error is below 1e-6 degrees.
std::vector<glm::dvec3> carved_normals(const Waves& base, const Waves& detail) {
    constexpr double step = 1e-4;
    std::vector<glm::dvec3> normals;
    for (int row = 0; row < blend_side; ++row) {
        for (int column = 0; column < blend_side; ++column) {
            const auto point = [&](double x, double y) {
                return carved_point(base, detail, {column + x, -row + y});
            };
            normals.push_back(glm::normalize(
                glm::cross(point(step, 0) - point(-step, 0), point(0, step) - point(0, -step))));
        }
    }
    return normals;
}

Waves base_waves(double slope) {
    return waves_with_slope(blend_side, 6, 60, slope, 31);
}

Waves detail_waves(double slope) {
    return waves_with_slope(blend_side, 12, 7, slope, 32);
}

std::string row_of(double base_slope, double detail_slope, bool is_carved) {
    const Waves base = base_waves(base_slope);
    const Waves detail = detail_waves(detail_slope);
    Waves both = base;
    both.insert(both.end(), detail.begin(), detail.end());
    AnalyticHeights ground_truth = wave_heights(blend_side, blend_side, both);
    if (is_carved) ground_truth.normals = carved_normals(base, detail);
    std::vector<double> ranks;
    std::vector<std::string> cells;
    for (const NormalBlend method : all_normal_blends) {
        Image blended = normals_image(blend_side, blend_side, base);
        Report report;
        blend_normals(blended, normals_image(blend_side, blend_side, detail), method, report);
        const DirectionError error = normal_error(blended, ground_truth);
        ranks.push_back(error.rms);
        cells.push_back(in_digits(error.rms) + " / " + in_digits(error.max));
    }
    return table_row(fmt::format("{:g} and {:g}", base_slope, detail_slope), ranks, cells);
}

std::string table(bool is_carved) {
    std::string text = table_header(blend_names);
    for (const auto& [base, detail] :
         {std::pair{0.25, 0.25}, std::pair{0.5, 0.5}, std::pair{1.0, 0.25}, std::pair{1.0, 0.5}})
        text += row_of(base, detail, is_carved);
    return text;
}

}  // namespace

std::string blend_tables() {
    return "\nAgainst the sum of the two height fields: RMS / largest error in degrees, by the RMS "
           "slope of base and detail\n\n" +
           table(false) +
           "\nAgainst the base with the detail standing on it along its normals\n\n" + table(true);
}

}  // namespace relief::test
