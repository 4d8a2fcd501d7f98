// SPDX-License-Identifier: Apache-2.0
// Computes normals from waves and fields with known normals, and compares every kernel in both
// arithmetics with the closed form.
#include "experiment_parts.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "experiment_driver.h"
#include "relief/accuracy/asset.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"

namespace relief::accuracy::detail {

std::span<const BumpMethod> kernel_methods() {
    static const std::vector<BumpMethod> kernels = [] {
        std::vector<BumpMethod> all;
        for (const EnumName<Kernel>& one : enum_names<Kernel>) {
            for (const int radius : {2, 4, 8, 16}) {
                if (one.value == Kernel::gaussian || radius == 2)
                    all.push_back({one.value, radius, Arithmetic::float64});
            }
        }
        return all;
    }();
    return kernels;
}

std::string name_of(Kernel kernel, int gaussian_radius) {
    return kernel == Kernel::gaussian ? fmt::format("gaussian {}", gaussian_radius)
                                      : enum_name(kernel);
}

BumpOptions options_of(const BumpMethod& method, BumpOptions options) {
    options.kernel = method.kernel;
    options.gaussian_radius = method.gaussian_radius;
    options.arithmetic = method.arithmetic;
    return options;
}

Image normals_by(const BumpMethod& method, const Image& heights, const BumpOptions& options) {
    Report report;
    return normals_from_height(heights, options_of(method, options), report);
}

void convert_by(const BumpMethod& method, const Image& heights, const BumpOptions& options,
                Image& result) {
    Report report;
    const auto convert = [&](const Image& input) {
        normal_map_from_height(input, options_of(method, options), {.bits = method.bits}, result,
                               report);
    };
    if (method.destaircased)
        convert(destaircase(heights, {.wrap = *options.wrap}).heights);
    else
        convert(heights);
}

double rms_error(const BumpField& field, Kernel kernel, int gaussian_radius) {
    const BumpMethod method{kernel, gaussian_radius, Arithmetic::float64};
    return normal_error(normals_by(method, field.heights, field.options), field).rms;
}

const FieldRecipe& field_recipe(const std::string& name) {
    for (const auto& set : {tuning_fields(), evaluation_fields()}) {
        for (const FieldRecipe& recipe : set) {
            if (name == recipe.name) return recipe;
        }
    }
    throw InvalidInput("there is no field " + name);
}

BumpField oblique_wave(int side, double wavelength, int bits) {
    const double steepness = 2.0 * std::numbers::pi / wavelength;
    const HeightWave wave{1.0 / steepness, steepness * glm::dvec2(2.0, 1.0) / std::sqrt(5.0), 0.7};
    BumpField field = wave_heights(side, side, std::span(&wave, 1));
    field.options.wrap = Wrap::clamp;
    if (bits == 32) return field;
    CodedHeights coded = coded_heights(field.heights, bits);
    field.options.strength = coded.strength;
    field.heights = std::move(coded.codes);
    return field;
}

ErrorStats wave_errors(const BumpField& wave, const BumpMethod& method) {
    const int margin = wave.options.wrap == Wraps(Wrap::repeat) ? 0 : wave_margin;
    return normal_error(normals_by(method, wave.heights, wave.options), wave, margin);
}

BumpField surface_at(int side) {
    constexpr int coarsest = 64;
    constexpr std::uint32_t seed = 5;
    const double scale = static_cast<double>(side) / coarsest;
    std::vector<HeightWave> waves = tiling_waves(coarsest, coarsest, 8, 8.0, 0.3, seed);
    for (HeightWave& wave : waves) {
        wave.frequency /= scale;
        wave.amplitude *= scale;
    }
    return wave_heights(side, side, waves);
}

namespace {

/// A method named "scharr3, float32", with these choices.
Method by_kernel(const BumpMethod& method) {
    const std::string kernel = name_of(method.kernel, method.gaussian_radius);
    const char* const arithmetic = enum_name(method.arithmetic);
    return {.name = fmt::format("{}, {}", kernel, arithmetic),
            .choices = {{"kernel", kernel}, {"arithmetic", arithmetic}}};
}

}  // namespace

Method described(const BumpMethod& method) {
    Method result = by_kernel(method);
    const std::string bits = fmt::format("{} bit", method.bits);
    result.name += ", " + bits + (method.destaircased ? ", steps smoothed" : "");
    result.choices.emplace_back("depth", bits);
    result.choices.emplace_back("steps", method.destaircased ? "smoothed" : "as they are");
    result.stored_bytes = 3.0 * method.bits / 8.0;
    return result;
}

namespace {

/// A chart with a curve per kernel.
Chart kernel_chart(Chart chart, const std::vector<double>& all_x,
                   const std::function<BumpField(double x)>& wave_at) {
    chart.y_label = "RMS error, degrees";
    std::vector<std::string> names;
    for (const BumpMethod& method : kernel_methods())
        names.push_back(name_of(method.kernel, method.gaussian_radius));
    return chart_over(std::move(chart), names, all_x, wave_at,
                      [](std::size_t i, const BumpField& wave) {
                          return curve_error(wave_errors(wave, kernel_methods()[i]));
                      });
}

/// Adds the orders of the kernels. Only points at which the order dominates are fitted: the wave is
/// longer than the reach of the kernel, and the error exceeds that of heights in float.
/// \param x_per_texel  x, divided by the length of the shortest wave in texels
void add_orders(Chart& chart, double x_per_texel) {
    for (std::size_t k = 0; k < chart.curves.size(); ++k) {
        const BumpMethod& method = kernel_methods()[k];
        const GradientKernel kernel = gradient_kernel(method.kernel, method.gaussian_radius);
        std::vector<CurvePoint> ruled;
        for (const CurvePoint& point : chart.curves[k].points) {
            if (point.x >= 4.0 * x_per_texel * kernel.radius && point.error > 1e-4)
                ruled.push_back(point);
        }
        chart.curves[k].order = fitted_order(ruled);
        chart.curves[k].expected_order = -kernel.order;
    }
}

/// The error over the wavelength, for maps of `side` texels with heights of `bits` bits (32:
/// floats).
Chart wavelength_chart(int bits, int side, bool is_quick) {
    std::vector<double> wavelengths = {4, 6, 8, 12, 16, 24, 32, 64, 128, 256};
    if (!is_quick) wavelengths = {4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256};
    Chart chart = kernel_chart(
        {.id = "wavelength", .title = "Longer waves", .x_label = "wavelength, texels"}, wavelengths,
        [=](double wavelength) { return oblique_wave(side, wavelength, bits); });
    // With integer codes errors grow again: longer waves have smaller steps, which rounding loses.
    if (bits == 32) add_orders(chart, 1.0);
    return chart;
}

/// The error over the resolution of one surface.
Chart resolution_chart(bool is_quick) {
    std::vector<double> sides = {64, 128, 256};
    if (!is_quick) sides.insert(sides.end(), {512, 1024});
    Chart chart =
        kernel_chart({.id = "resolution",
                      .title = "The same surface in finer texels",
                      .x_label = "texels along a side"},
                     sides, [](double side) { return surface_at(static_cast<int>(side)); });
    add_orders(chart, 8.0);  // The shortest waves have an eighth of the texels of the coarsest map.
    return chart;
}

Experiment square_map(int side) {
    return {.error_unit = "degrees", .item = "texel", .items = static_cast<double>(side) * side};
}

/// Every kernel in both arithmetics; then again after the steps are smoothed, or not.
std::vector<BumpMethod> in_both_arithmetics(int bits, bool has_smoothed) {
    std::vector<BumpMethod> methods;
    for (const bool smoothed : {false, true}) {
        if (smoothed && !has_smoothed) continue;
        for (const BumpMethod& kernel : kernel_methods()) {
            for (const Arithmetic arithmetic : both_arithmetics)
                methods.push_back(
                    {kernel.kernel, kernel.gaussian_radius, arithmetic, bits, smoothed});
        }
    }
    return methods;
}

PreparedExperiment on_wave(int bits, const PlanOptions& options) {
    constexpr int side = 256 + 2 * wave_margin;
    constexpr double wavelength = 32.0;
    const auto wave = std::make_shared<const BumpField>(oblique_wave(side, wavelength, bits));
    PreparedExperiment prepared;
    prepared.report = square_map(side);
    prepared.report.question =
        fmt::format("Which kernel is most accurate on a wave, by its length, with heights in {}?",
                    depth_name(bits));
    prepared.report.ground_truth =
        "The slopes of the wave in closed form. A test verifies the errors by the closed-form "
        "frequency response of each kernel.";
    prepared.report.input =
        fmt::format("{} x {} texels of a wave {} texels long, slope 1, heights in {}", side, side,
                    wavelength, depth_name(bits));
    prepared.costs.memory = false;
    for (const BumpMethod& method : in_both_arithmetics(32, false)) {
        Method& one = prepared.methods.emplace_back(by_kernel(method));
        one.error = [wave, method] { return wave_errors(*wave, method); };
        one.work = [wave, method] { normals_by(method, wave->heights, wave->options); };
    }
    prepared.finish = [bits, is_quick = options.is_quick](Experiment& report) {
        report.charts = {wavelength_chart(bits, side, is_quick)};
    };
    return prepared;
}

/// The errors of the stored normals.
ErrorStats conversion_error(const BumpField& field, const BumpMethod& method) {
    const NormalMapFormat format{.bits = method.bits};
    Report report;
    Image map;
    convert_by(method, field.heights, field.options, map);
    return normal_error(decode_normal_map(map, format.green, format.flat, report), field);
}

PreparedExperiment on_recipe(const FieldRecipe& recipe, int side) {
    const auto field = std::make_shared<const BumpField>(make_bump_field(recipe, side, side));
    const int bits = recipe.coding == FieldCoding::float32 ? 32 : 16;
    PreparedExperiment prepared;
    prepared.report = square_map(side);
    prepared.report.ground_truth =
        "The normals of the field in closed form, without the noise and rounding of its heights. "
        "Tests verify them by numerical differentiation.";
    prepared.report.input = fmt::format("{} x {} texels, {}; the normal map in {}", side, side,
                                        recipe.name, depth_name(bits));
    for (const BumpMethod& method : in_both_arithmetics(bits, field->heights.bits() == 8)) {
        Method& one = prepared.methods.emplace_back(by_kernel(method));
        if (method.destaircased) one.name += ", steps smoothed away";
        one.choices.emplace_back("steps", method.destaircased ? "smoothed away" : "as they are");
        one.error = [field, method] { return conversion_error(*field, method); };
        one.work = [field, method] {
            Image map;
            convert_by(method, field->heights, field->options, map);
        };
    }
    prepared.finish = [field](Experiment& report) {
        const KernelChoice choice = choose_kernel(field->heights, field->options);
        report.finding += fmt::format(" On this map --kernel auto selects {}.",
                                      name_of(choice.kernel, choice.gaussian_radius));
    };
    return prepared;
}

/// Heat maps of a short and a wide kernel, whose errors are at short and at long waves.
void add_heat_maps(const FieldRecipe& recipe, int side, Experiment& experiment) {
    const BumpField field = make_bump_field(recipe, side, side);
    for (const BumpMethod& method : {BumpMethod{Kernel::central3, 2, Arithmetic::float64},
                                     BumpMethod{Kernel::gaussian, 4, Arithmetic::float64}}) {
        const Image normals = normals_by(method, field.heights, field.options);
        experiment.heat_maps.push_back(
            {fmt::format("Error of {} on waves that are long at the sides and short in the "
                         "middle",
                         name_of(method.kernel, method.gaussian_radius)),
             by_kernel(method).name, angles_of(normals, field.normals), 10.0});
    }
}

struct FieldCase {
    const char* id;
    const char* recipe;  ///< FieldRecipe::name
    bool is_quick = false;
    bool has_heat_maps = false;
};

constexpr std::array field_cases = {
    FieldCase{"detailed-8", "detailed, 8 bit", true},
    FieldCase{"mixed-8", "mixed, 8 bit", true, true},
    FieldCase{"noisy-float", "noise 0.03, float", true},
    FieldCase{"smooth-float", "smooth, float"},
    FieldCase{"smooth-16", "smooth, 16 bit"},
    FieldCase{"smooth-8", "smooth, 8 bit"},
    FieldCase{"very-smooth-25-codes", "very smooth, 25 codes of 8 bit"},
    FieldCase{"steep-8", "steep, 8 bit"},
    FieldCase{"domes-8", "domes, 8 bit"},
    FieldCase{"creases-float", "creases, float"}};

PreparedExperiment on_field(const FieldCase& one) {
    constexpr int side = 256;  // The same size as in docs/bump.md.
    const FieldRecipe recipe = field_recipe(one.recipe);
    PreparedExperiment prepared = on_recipe(recipe, side);
    prepared.report.question = fmt::format(
        "Which kernel is most accurate on such a map ({}), and what does it cost?", one.recipe);
    prepared.costs.memory = false;
    if (one.has_heat_maps) {
        prepared.finish = [finding = prepared.finish, recipe](Experiment& report) {
            finding(report);
            add_heat_maps(recipe, side, report);
        };
    }
    return prepared;
}

PreparedExperiment on_large_map(const PlanOptions& options) {
    PreparedExperiment prepared =
        on_recipe(field_recipe("smooth, 16 bit"), options.is_quick ? 512 : 2048);
    prepared.report.question =
        "How much time and memory does a large normal map cost, and how much do finer texels help?";
    prepared.finish = [finding = prepared.finish, is_quick = options.is_quick](Experiment& report) {
        finding(report);
        report.charts = {resolution_chart(is_quick)};
    };
    return prepared;
}

}  // namespace

std::vector<PlannedExperiment> bump_plan(const PlanOptions& options) {
    std::vector<PlannedExperiment> plan;
    for (const int bits : {32, 16, 8}) {
        plan.push_back({fmt::format("bump/wave-{}", bits == 32 ? "float" : std::to_string(bits)),
                        fmt::format("Bump: a wave in {}", depth_name(bits)),
                        [bits](const PlanOptions& all) { return on_wave(bits, all); }});
    }
    for (const FieldCase& one : field_cases) {
        if (options.is_quick && !one.is_quick) continue;
        plan.push_back({fmt::format("bump/{}", one.id), fmt::format("Bump: {}", one.recipe),
                        [one](const PlanOptions&) { return on_field(one); }});
    }
    plan.push_back({"bump/large", "Bump: a large map", on_large_map});
    return plan;
}

}  // namespace relief::accuracy::detail
