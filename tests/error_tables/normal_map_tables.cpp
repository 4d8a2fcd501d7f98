// SPDX-License-Identifier: Apache-2.0
// Errors of storing, resizing, blending and filtering normal maps, on surfaces of waves.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "error_tables/error_tables.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/normal_map.h"
#include "storage_experiments.h"
#include "support/images.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

constexpr int storage_side = 256;

/// The row of one method of normal_codes().
std::string storage_row(const char* name, const std::string& code_name) {
    const Image reference = image_of_normals(smooth_surface(storage_side), storage_side);
    for (const NormalCode& code : normal_codes()) {
        if (code.name != code_name) continue;
        const Image read = stored(code, reference);
        std::vector<std::string> cells;
        for (const int block : {1, 4, 16})
            cells.push_back(fmt::format("{:.5f}", patch_errors(read, reference, block).rms));
        return table_row(name, cells);
    }
    throw std::invalid_argument("no code " + code_name);
}

std::string storage_tables() {
    std::string text =
        "\nRMS error in degrees of single texels, and of the means of 4 x 4 and 16 x 16 of them, "
        "on a smooth surface\n\n" +
        table_header({"1 texel", "4 x 4", "16 x 16"});
    text += storage_row("8 bits", "xyz 8 bit");
    text += storage_row("8 bits, zero at 128", "xyz 8 bit, zero at 128");
    text += storage_row("8 bits, zero at 128, read as glTF and engines do",
                        "xyz 8 bit, zero at 128, read as glTF does");
    text += storage_row("8 bits, ordered", "xyz 8 bit, ordered");
    text += storage_row("8 bits, blue-noise", "xyz 8 bit, blue-noise");
    text += storage_row("16 bits", "xyz 16 bit");
    text += storage_row("16 bits, blue-noise", "xyz 16 bit, blue-noise");
    text += storage_row("half floats", "xyz half");
    text += storage_row("32 bits", "xyz float");
    return text;
}

constexpr int resize_side = 96;

const std::vector<std::string> filter_names = {"box", "triangle", "cubic", "lanczos", "best"};
constexpr ResizeFilter filters[] = {ResizeFilter::box, ResizeFilter::triangle, ResizeFilter::cubic,
                                    ResizeFilter::lanczos, ResizeFilter::best};

struct Situation {
    int to;
    double rms_slope;      ///< The slope of the whole map, including the waves that are lost.
    double shortest_held;  ///< The shortest wave that the other size can hold, in texels of the
                           ///< original.
    double shortest_lost;  ///< The shortest wave that it cannot hold; 0 if there is none.
};

std::string resize_row(const Situation& at, ResizeDomain domain) {
    std::vector<HeightWave> held =
        tiling_waves(resize_side, resize_side, 12, at.shortest_held, at.rms_slope, 5);
    std::vector<HeightWave> all = held;
    if (at.shortest_lost > 0.0) {
        const double limit = 2.0 * resize_side / at.to / 1.2;
        for (const HeightWave& wave :
             tiling_waves(resize_side, resize_side, 300, at.shortest_lost, at.rms_slope, 6)) {
            const bool is_lost = 2.0 * std::numbers::pi / glm::length(wave.frequency) < limit;
            if (is_lost && all.size() < 48) all.push_back(wave);
        }
    }
    const double factor = at.rms_slope / rms_slope_of(resize_side, resize_side, all);
    held = scaled_waves(held, factor);
    all = scaled_waves(all, factor);
    const Image normals = normals_image(resize_side, resize_side, all);
    const BumpField reference =
        wave_heights(at.to, at.to, resized_waves(held, static_cast<double>(resize_side) / at.to));
    std::vector<double> ranks;
    std::vector<std::string> cells;
    for (const ResizeFilter filter : filters) {
        ResizeOptions options;
        options.filter = filter;
        options.domain = domain;
        Report report;
        const double error =
            normal_error(resize_normals(normals, at.to, at.to, options, report), reference).rms;
        ranks.push_back(error);
        cells.push_back(in_digits(error));
    }
    return table_row(fmt::format("to {:.0f} %, slope {:g}{}, {}", 100.0 * at.to / resize_side,
                                 at.rms_slope, at.shortest_lost > 0.0 ? ", finer waves lost" : "",
                                 domain == ResizeDomain::slopes ? "slopes" : "vectors"),
                     ranks, cells);
}

std::string resize_tables() {
    std::string text = "\nRMS error in degrees against the same surface at the other size\n\n" +
                       table_header(filter_names);
    constexpr Situation situations[] = {{48, 0.5, 8.0, 0.0},  {24, 0.5, 12.0, 3.0},
                                        {24, 1.5, 12.0, 3.0}, {64, 0.5, 6.0, 0.0},
                                        {144, 0.5, 6.0, 0.0}, {192, 1.5, 6.0, 0.0}};
    for (const Situation& situation : situations) {
        for (const ResizeDomain domain : {ResizeDomain::slopes, ResizeDomain::vectors})
            text += resize_row(situation, domain);
    }
    return text;
}

constexpr int blend_side = 128;

/// The names of `relief-bake convert --blend`, in the order of all_normal_blends.
const std::vector<std::string> blend_names = {
    "reoriented", "partial-derivative", "whiteout", "udn", "unity", "linear", "overlay"};

using Waves = std::vector<HeightWave>;

/// The height of a sum of waves at a point and its slopes along x and y. The y axis points up.
struct Surface {
    double height = 0.0;
    glm::dvec2 slope{};
};

/// \param place  in texels, with y up
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

/// Returns the point of the base, moved by the detail along the normal of the base.
glm::dvec3 carved_point(const Waves& base, const Waves& detail, const glm::dvec2& place) {
    const Surface under = surface_at(base, place);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-under.slope, 1.0));
    return glm::dvec3(place, under.height) + surface_at(detail, place).height * normal;
}

/// Computes normals by central differences with a step so small that their error is below 1e-6
/// degrees.
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

std::string blend_row(double base_slope, double detail_slope, bool is_carved) {
    const Waves base = base_waves(base_slope);
    const Waves detail = detail_waves(detail_slope);
    Waves both = base;
    both.insert(both.end(), detail.begin(), detail.end());
    BumpField reference = wave_heights(blend_side, blend_side, both);
    if (is_carved) reference.normals = carved_normals(base, detail);
    std::vector<double> ranks;
    std::vector<std::string> cells;
    for (const NormalBlend method : all_normal_blends) {
        Image blended = normals_image(blend_side, blend_side, base);
        Report report;
        blend_normals(blended, normals_image(blend_side, blend_side, detail), method, report);
        const ErrorStats error = normal_error(blended, reference);
        ranks.push_back(error.rms);
        cells.push_back(rms_and_max(error));
    }
    return table_row(fmt::format("{:g} and {:g}", base_slope, detail_slope), ranks, cells);
}

std::string table(bool is_carved) {
    std::string text = table_header(blend_names);
    for (const auto& [base, detail] :
         {std::pair{0.25, 0.25}, std::pair{0.5, 0.5}, std::pair{1.0, 0.25}, std::pair{1.0, 0.5}})
        text += blend_row(base, detail, is_carved);
    return text;
}

std::string blend_tables() {
    return "\nAgainst the sum of the two height fields: RMS / maximum error in degrees, by the RMS "
           "slope of base and detail\n\n" +
           table(false) + "\nError from the base displaced by the detail along its normals\n\n" +
           table(true);
}

constexpr int mip_side = 64;

/// Returns the mean of the slope variances along both axes over the whole map.
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

std::string mip_row(double rms_slope) {
    const Image normals =
        normals_image(mip_side, mip_side, waves_with_slope(mip_side, 60, 4, rms_slope, 51));
    const std::vector<Image> levels = normal_mip_levels(normals);
    const auto mean = levels.back().as<float>();
    const double length = glm::length(glm::dvec3(mean[0], mean[1], mean[2]));
    const double reference = slope_variance(normals);
    const double found = slope_variance_of_length(length);
    const double toksvig = (1.0 - length) / length;
    constexpr double base = 0.3;
    const std::vector<std::string> cells = {
        fmt::format("{:.4f}", length),
        fmt::format("{:.4f}", reference),
        fmt::format("{:.4f}", found),
        fmt::format("{:.4f}", toksvig),
        fmt::format("{:.3f}", roughness_with_variance(base, reference)),
        fmt::format("{:.3f}", roughness_with_variance(base, found))};
    return table_row(fmt::format("rms slope {:g}", rms_slope), cells);
}

}  // namespace

std::string mip_tables() {
    std::string text =
        "\nA whole map in one texel: the variance of its slopes along each axis, and the roughness "
        "that\ncompensates for it on a surface of roughness 0.3\n\n" +
        table_header({"mean length", "exact variance", "from the length", "by Toksvig",
                      "exact roughness", "from the length"});
    for (const double slope : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6})
        text += mip_row(slope);
    return text;
}

std::vector<PageSection> normal_map_tables() {
    return {written_section("blending", blend_tables()),
            written_section("resizing", resize_tables()),
            written_section("storage", storage_tables()), written_section("mips", mip_tables())};
}

}  // namespace relief::test
