// SPDX-License-Identifier: Apache-2.0
// Computes normals from waves and fields with known normals, and compares every kernel in both
// arithmetics with the closed form.
#include "bump_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "error_metrics.h"
#include "experiment_driver.h"
#include "relief/accuracy/measure.h"
#include "relief/accuracy/measure_bump.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"
#include "report_names.h"

namespace relief {

std::span<const NamedKernel> named_kernels() {
    static const std::array kernels = {NamedKernel{"forward", Kernel::forward, 2},
                                       NamedKernel{"central3", Kernel::central3, 2},
                                       NamedKernel{"prewitt3", Kernel::prewitt3, 2},
                                       NamedKernel{"sobel3", Kernel::sobel3, 2},
                                       NamedKernel{"scharr3", Kernel::scharr3, 2},
                                       NamedKernel{"sobel5", Kernel::sobel5, 2},
                                       NamedKernel{"scharr5", Kernel::scharr5, 2},
                                       NamedKernel{"central5", Kernel::central5, 2},
                                       NamedKernel{"central7", Kernel::central7, 2},
                                       NamedKernel{"gaussian 2", Kernel::gaussian, 2},
                                       NamedKernel{"gaussian 4", Kernel::gaussian, 4},
                                       NamedKernel{"gaussian 8", Kernel::gaussian, 8},
                                       NamedKernel{"gaussian 16", Kernel::gaussian, 16}};
    return kernels;
}

std::string name_of(Kernel kernel, int gaussian_radius) {
    for (const NamedKernel& named : named_kernels()) {
        if (named.kernel == kernel && kernel != Kernel::gaussian) return named.name;
    }
    return fmt::format("gaussian {}", gaussian_radius);
}

double rms_error(const BumpField& field, Kernel kernel, int gaussian_radius) {
    BumpOptions options = field.options;
    options.kernel = kernel;
    options.gaussian_radius = gaussian_radius;
    options.arithmetic = Arithmetic::float64;
    Report report;
    return field_error(normals_from_height(field.heights, options, report), field).rms;
}

const FieldRecipe& recipe_named(const std::string& name) {
    for (const auto& set : {tuning_fields(), evaluation_fields()}) {
        for (const FieldRecipe& recipe : set) {
            if (name == recipe.name) return recipe;
        }
    }
    throw InvalidInput("there is no field " + name);
}

WaveMap oblique_wave(int side, double wavelength, int bits) {
    const double steepness = 2.0 * std::numbers::pi / wavelength;
    const HeightWave wave{1.0 / steepness, steepness * glm::dvec2(2.0, 1.0) / std::sqrt(5.0), 0.7};
    AnalyticHeights field = wave_heights(side, side, std::span(&wave, 1));
    WaveMap map;
    map.options.wrap = Wrap::clamp;
    map.options.strength = 1.0;
    map.normals = std::move(field.normals);
    if (bits == 32) {
        map.heights = std::move(field.heights);
    } else {
        CodedHeights coded = coded_heights(field.heights, bits);
        map.options.strength = coded.strength;
        map.heights = std::move(coded.codes);
    }
    return map;
}

ErrorStats wave_errors(const WaveMap& wave, const NamedKernel& kernel, Arithmetic arithmetic) {
    BumpOptions options = wave.options;
    options.kernel = kernel.kernel;
    options.gaussian_radius = kernel.radius;
    options.arithmetic = arithmetic;
    Report report;
    const int margin = options.wrap == Wraps(Wrap::repeat) ? 0 : wave_margin;
    return map_errors(normals_from_height(wave.heights, options, report), wave.normals, margin);
}

WaveMap surface_at(int side) {
    constexpr int coarsest = 64;
    constexpr std::uint32_t seed = 5;
    const double scale = static_cast<double>(side) / coarsest;
    std::vector<HeightWave> waves = tiling_waves(coarsest, coarsest, 8, 8.0, 0.3, seed);
    for (HeightWave& wave : waves) {
        wave.frequency /= scale;
        wave.amplitude *= scale;
    }
    AnalyticHeights field = wave_heights(side, side, waves);
    WaveMap map;
    map.heights = std::move(field.heights);
    map.options.strength = 1.0;
    map.normals = std::move(field.normals);
    return map;
}

MeasuredMethod measured_method(const BumpMethod& method, const ErrorStats& error) {
    const std::string kernel = method.kernel == Kernel::gaussian
                                   ? fmt::format("gaussian {}", method.gaussian_radius)
                                   : enum_name(method.kernel);
    const std::string bits = fmt::format("{} bit", method.bits);
    MeasuredMethod measured;
    measured.name = fmt::format("{}, {}, {}{}", kernel, enum_name(method.arithmetic), bits,
                                method.destaircased ? ", steps smoothed" : "");
    measured.choices = {{"kernel", kernel},
                        {"arithmetic", enum_name(method.arithmetic)},
                        {"depth", bits},
                        {"steps", method.destaircased ? "smoothed" : "as they are"}};
    measured.error = error;
    measured.stored_bytes = 3.0 * method.bits / 8.0;
    return measured;
}

namespace {

/// Adds the order of a kernel to its curve. Only points at which the order dominates are fitted:
/// the wave is longer than the reach of the kernel, and the error exceeds that of heights in float.
Curve with_order(Curve curve, const GradientKernel& kernel) {
    std::vector<CurvePoint> ruled;
    for (const CurvePoint& point : curve.points) {
        if (point.x >= 4.0 * kernel.radius && point.error > 1e-4) ruled.push_back(point);
    }
    curve.order = fitted_order(ruled);
    curve.expected_order = -kernel.order;
    return curve;
}

/// A chart with an empty curve per kernel.
Chart kernel_chart(const char* id, const char* title, const char* x_label) {
    Chart chart{.id = id, .title = title, .x_label = x_label, .y_label = "RMS error, degrees"};
    for (const NamedKernel& kernel : named_kernels())
        chart.curves.emplace_back().method = kernel.name;
    return chart;
}

/// Adds a point to the curve of each kernel.
void add_points(Chart& chart, double x, const WaveMap& wave) {
    for (std::size_t k = 0; k < chart.curves.size(); ++k) {
        const ErrorStats errors = wave_errors(wave, named_kernels()[k], Arithmetic::float64);
        chart.curves[k].points.push_back({x, curve_error(errors)});
    }
}

/// The error over the wavelength, for maps of `side` texels with heights of `bits` bits (32:
/// floats).
Chart wavelength_chart(int bits, int side, bool is_quick) {
    Chart chart = kernel_chart("wavelength", "Longer waves", "wavelength, texels");
    std::vector<double> wavelengths = {4, 6, 8, 12, 16, 24, 32, 64, 128, 256};
    if (!is_quick) wavelengths = {4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256};
    for (const double wavelength : wavelengths)
        add_points(chart, wavelength, oblique_wave(side, wavelength, bits));
    // With integer codes errors grow again: longer waves have smaller steps, which rounding loses.
    if (bits < 32) return chart;
    for (std::size_t k = 0; k < chart.curves.size(); ++k) {
        const NamedKernel& kernel = named_kernels()[k];
        chart.curves[k] =
            with_order(chart.curves[k], gradient_kernel(kernel.kernel, kernel.radius));
    }
    return chart;
}

/// The error over the resolution of one surface.
Chart resolution_chart(bool is_quick) {
    Chart chart =
        kernel_chart("resolution", "The same surface in finer texels", "texels along a side");
    for (const int side :
         is_quick ? std::vector{64, 128, 256} : std::vector{64, 128, 256, 512, 1024})
        add_points(chart, side, surface_at(side));
    for (std::size_t k = 0; k < chart.curves.size(); ++k) {
        const NamedKernel& kernel = named_kernels()[k];
        // The shortest waves have an eighth of the texels of the coarsest map.
        GradientKernel reach = gradient_kernel(kernel.kernel, kernel.radius);
        reach.radius *= 8;
        chart.curves[k] = with_order(chart.curves[k], reach);
    }
    return chart;
}

BumpOptions with_kernel(BumpOptions options, const NamedKernel& kernel, Arithmetic arithmetic) {
    options.kernel = kernel.kernel;
    options.gaussian_radius = kernel.radius;
    options.arithmetic = arithmetic;
    return options;
}

Experiment of_texels(const std::string& id, double texels) {
    Experiment experiment;
    experiment.id = id;
    experiment.subject = Subject::bump;
    experiment.error_unit = "degrees";
    experiment.item = "texel";
    experiment.items = texels;
    return experiment;
}

/// "gaussian 4, float64 has the smallest error, 0.32 degrees RMS (sobel3: 0.99). ..."
/// \param experiment  measures each of named_kernels() in both arithmetics; then again after
/// smoothing,
///         or not
std::string bump_finding(const Experiment& experiment) {
    const Measurement& best = *most_accurate(experiment);
    std::string text =
        fmt::format("{} has the smallest error, {:.2g} degrees RMS", best.method, best.error.rms);
    const auto& all = experiment.measurements;
    const std::span<const NamedKernel> kernels = named_kernels();
    const auto kernel_of = [&](const Measurement& one) {
        const auto index = static_cast<std::size_t>(&one - all.data());
        return kernels[index / both_arithmetics.size() % kernels.size()].kernel;
    };
    const auto usual = std::find_if(all.begin(), all.end(), [&](const Measurement& one) {
        return kernel_of(one) == Kernel::sobel3;
    });
    if (kernel_of(best) != Kernel::sobel3)
        text += fmt::format(" (sobel3: {:.2g})", usual->error.rms);
    return text + ". " + arithmetic_finding(experiment, "kernels");
}

Experiment on_wave(int bits, const RunOptions& options) {
    constexpr int side = 256 + 2 * wave_margin;
    constexpr double wavelength = 32.0;
    const WaveMap wave = oblique_wave(side, wavelength, bits);
    Experiment experiment =
        of_texels(fmt::format("bump/wave-{}", bits == 32 ? "float" : std::to_string(bits)),
                  static_cast<double>(side) * side);
    experiment.question =
        fmt::format("Which kernel is most accurate on a wave, by its length, with heights in {}?",
                    depth_name(bits));
    experiment.ground_truth =
        "The slopes of the wave in closed form. A test verifies the errors by the closed-form "
        "frequency response of each kernel.";
    experiment.input =
        fmt::format("{} x {} texels of a wave {} texels long, slope 1, heights in {}", side, side,
                    wavelength, depth_name(bits));
    std::vector<MeasuredMethod> measured;
    for (const NamedKernel& kernel : named_kernels()) {
        for (const Arithmetic arithmetic : both_arithmetics) {
            MeasuredMethod method;
            method.name = fmt::format("{}, {}", kernel.name, enum_name(arithmetic));
            method.choices = {{"kernel", kernel.name}, {"arithmetic", enum_name(arithmetic)}};
            method.error = wave_errors(wave, kernel, arithmetic);
            method.work = [&wave, chosen = with_kernel(wave.options, kernel, arithmetic)] {
                Report report;
                normals_from_height(wave.heights, chosen, report);
            };
            measured.push_back(std::move(method));
        }
    }
    measure_methods(measured, options, {.one_thread = true, .all_threads = true, .memory = false},
                    experiment);
    experiment.finding = bump_finding(experiment);
    experiment.charts.push_back(computed_once(
        options, "chart", [&] { return wavelength_chart(bits, side, options.is_quick); }));
    return experiment;
}

/// Every kernel in both arithmetics; for 8-bit heights also after the steps are smoothed.
std::vector<BumpMethod> methods_for(const BumpField& field, int bits) {
    std::vector<BumpMethod> methods;
    for (const bool smoothed : {false, true}) {
        if (smoothed && field.heights.bits() != 8) continue;
        for (const NamedKernel& kernel : named_kernels()) {
            for (const Arithmetic arithmetic : both_arithmetics)
                methods.push_back({kernel.kernel, kernel.radius, arithmetic, bits, smoothed});
        }
    }
    return methods;
}

/// The complete work of a method, as it is timed.
void convert(const BumpField& field, const BumpMethod& method) {
    BumpOptions options = field.options;
    options.kernel = method.kernel;
    options.gaussian_radius = method.gaussian_radius;
    options.arithmetic = method.arithmetic;
    Report report;
    if (method.destaircased) {
        const Image smooth = destaircase(field.heights, {.wrap = *options.wrap}).heights;
        normal_map_from_height(smooth, options, {.bits = method.bits}, report);
    } else {
        normal_map_from_height(field.heights, options, {.bits = method.bits}, report);
    }
}

Experiment on_recipe(const std::string& id, const FieldRecipe& recipe, int side,
                     const CostChoice& costs, const RunOptions& options) {
    const BumpField field = make_bump_field(recipe, side, side);
    Experiment experiment = of_texels(id, static_cast<double>(side) * side);
    experiment.ground_truth =
        "The normals of the field in closed form, without the noise and rounding of its heights. "
        "Tests verify them by numerical differentiation.";
    const int bits = recipe.coding == FieldCoding::float32 ? 32 : 16;
    experiment.input = fmt::format("{} x {} texels, {}; the normal map in {}", side, side,
                                   recipe.name, depth_name(bits));
    const std::vector<BumpMethod> methods = methods_for(field, bits);
    BumpExperimentOptions errors_alone;
    errors_alone.repeats = {0, 0};
    const BumpExperiment result = measure_bump(field, methods, errors_alone);
    std::vector<MeasuredMethod> measured;
    for (const BumpMeasurement& one : result.measurements) {
        const std::string kernel = name_of(one.method.kernel, one.method.gaussian_radius);
        const char* const steps = one.method.destaircased ? "smoothed away" : "as they are";
        MeasuredMethod method;
        method.name = fmt::format("{}, {}{}", kernel, enum_name(one.method.arithmetic),
                                  one.method.destaircased ? ", steps smoothed away" : "");
        method.choices = {
            {"kernel", kernel}, {"arithmetic", enum_name(one.method.arithmetic)}, {"steps", steps}};
        method.error = one.error;
        method.work = [&field, chosen = one.method] { convert(field, chosen); };
        measured.push_back(std::move(method));
    }
    measure_methods(measured, options, costs, experiment);
    experiment.finding =
        fmt::format("{} On this map --kernel auto selects {}.", bump_finding(experiment),
                    name_of(result.choice.kernel, result.choice.gaussian_radius));
    return experiment;
}

/// Heat maps of a short and a wide kernel, whose errors are at short and at long waves.
void add_heat_maps(const FieldRecipe& recipe, int side, Experiment& experiment) {
    const BumpField field = make_bump_field(recipe, side, side);
    for (const NamedKernel& kernel : {NamedKernel{"central3", Kernel::central3},
                                      NamedKernel{"gaussian 4", Kernel::gaussian, 4}}) {
        Report report;
        const Image normals = normals_from_height(
            field.heights, with_kernel(field.options, kernel, Arithmetic::float64), report);
        experiment.heat_maps.push_back(
            {fmt::format("Error of {} on waves that are long at the sides and short in the "
                         "middle",
                         kernel.name),
             fmt::format("{}, float64", kernel.name), angles_of(normals, field.normals), 10.0});
    }
}

struct FieldCase {
    std::string id;
    std::string recipe;
    bool is_quick = false;
    bool has_heat_maps = false;
};

std::vector<FieldCase> field_cases() {
    return {{"detailed-8", "detailed, 8 bit", true},
            {"mixed-8", "mixed, 8 bit", true, true},
            {"noisy-float", "noise 0.03, float", true},
            {"smooth-float", "smooth, float"},
            {"smooth-16", "smooth, 16 bit"},
            {"smooth-8", "smooth, 8 bit"},
            {"very-smooth-25-codes", "very smooth, 25 codes of 8 bit"},
            {"steep-8", "steep, 8 bit"},
            {"domes-8", "domes, 8 bit"},
            {"creases-float", "creases, float"}};
}

Experiment on_field(const FieldCase& one, const RunOptions& options) {
    constexpr int side = 256;  // The same size as in docs/bump.md.
    const FieldRecipe& recipe = recipe_named(one.recipe);
    Experiment experiment =
        on_recipe("bump/" + one.id, recipe, side,
                  {.one_thread = true, .all_threads = true, .memory = false}, options);
    experiment.question = fmt::format(
        "Which kernel is most accurate on such a map ({}), and what does it cost?", one.recipe);
    if (one.has_heat_maps) add_heat_maps(recipe, side, experiment);
    return experiment;
}

Experiment on_large_map(const RunOptions& options) {
    const int side = options.is_quick ? 512 : 2048;
    Experiment experiment =
        on_recipe("bump/large", recipe_named("smooth, 16 bit"), side, {}, options);
    experiment.question =
        "How much time and memory does a large normal map cost, and how much do finer texels help?";
    experiment.charts.push_back(
        computed_once(options, "chart", [&] { return resolution_chart(options.is_quick); }));
    return experiment;
}

}  // namespace

std::vector<PlannedExperiment> bump_plan(const RunOptions& options) {
    std::vector<PlannedExperiment> plan;
    for (const int bits : {32, 16, 8}) {
        plan.push_back({fmt::format("Bump: a wave in {}", depth_name(bits)),
                        [&options, bits] { return on_wave(bits, options); }});
    }
    for (const FieldCase& one : field_cases()) {
        if (options.is_quick && !one.is_quick) continue;
        plan.push_back({"Bump: " + one.recipe, [&options, one] { return on_field(one, options); }});
    }
    plan.push_back({"Bump: a large map", [&options] { return on_large_map(options); }});
    return plan;
}

std::vector<Experiment> bump_experiments(const RunOptions& options) {
    return run_planned(bump_plan(options), options);
}

}  // namespace relief
