// SPDX-License-Identifier: Apache-2.0
// Plans and words; what is measured is in bump_methods.cpp and in relief::mesh's measure_bump().
// Tests: tests/accuracy/bump_experiments_test.cpp.
#include "bump/bump_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analytic_words.h"
#include "bump/bump_charts.h"
#include "bump/bump_methods.h"
#include "map_errors.h"
#include "measured_methods.h"
#include "relief/accuracy/passes.h"
#include "relief/mesh/bump_experiment.h"
#include "relief/mesh/destaircase.h"

namespace relief {
namespace {

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

/// What float32 changes, and what it saves: of the same kernels in both arithmetics.
std::string words_on_arithmetic(const Experiment& experiment) {
    double apart = 0.0;
    std::vector<double> ratios;
    for (const Measurement& in_double : experiment.measurements) {
        if (value_of(in_double, "arithmetic") != "float64") continue;
        for (const Measurement& in_float : experiment.measurements) {
            if (value_of(in_float, "arithmetic") != "float32" ||
                value_of(in_float, "kernel") != value_of(in_double, "kernel") ||
                value_of(in_float, "steps") != value_of(in_double, "steps"))
                continue;
            apart = std::max(apart, std::abs(in_float.error.rms - in_double.error.rms));
            if (in_float.cost.one_thread)
                ratios.push_back(median_seconds(in_float) / median_seconds(in_double));
        }
    }
    std::string text = fmt::format("float32 changes no RMS by more than {:.2g} degrees", apart);
    if (!ratios.empty())
        text += fmt::format(" and takes {:.2f} times as long (median of the kernels)",
                            spread_of(ratios).median);
    return text + ".";
}

/// "gaussian 4, float64 is closest, 0.32 degrees RMS, where sobel3 is 0.99 off. ..."
std::string bump_finding(const Experiment& experiment) {
    const Measurement& best = *truest(experiment);
    std::string text =
        fmt::format("{} is closest, {:.2g} degrees RMS", best.method, best.error.rms);
    const auto& all = experiment.measurements;
    const auto usual = std::find_if(all.begin(), all.end(), [](const Measurement& one) {
        return value_of(one, "kernel") == "sobel3";
    });
    if (value_of(best, "kernel") != "sobel3")
        text += fmt::format(", where sobel3 is {:.2g} off", usual->error.rms);
    return text + ". " + words_on_arithmetic(experiment);
}

Experiment on_wave(int bits, const RunOptions& options) {
    constexpr int side = 256 + 2 * wave_margin;
    constexpr double wavelength = 32.0;
    const WaveMap wave = oblique_wave(side, wavelength, bits);
    Experiment experiment =
        of_texels(fmt::format("bump/wave-{}", bits == 32 ? "float" : std::to_string(bits)),
                  static_cast<double>(side) * side);
    experiment.question =
        fmt::format("Which kernel finds the normals of a wave, by its length, from heights in {}?",
                    depth_words(bits));
    experiment.truth =
        "The wave's slopes in closed form; a kernel's response in closed form gives the same "
        "errors, which a test checks.";
    experiment.input =
        fmt::format("{} x {} texels of a wave {} texels long, slope 1, heights in {}", side, side,
                    wavelength, depth_words(bits));
    std::vector<MeasuredMethod> measured;
    for (const NamedKernel& kernel : named_kernels()) {
        for (const Arithmetic arithmetic : both_arithmetics) {
            MeasuredMethod method;
            method.name = fmt::format("{}, {}", kernel.name, word_of(arithmetic));
            method.choices = {{"kernel", kernel.name}, {"arithmetic", word_of(arithmetic)}};
            method.error = figures_of(wave_errors(wave, kernel, arithmetic));
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
    experiment.charts.push_back(
        made_once(options, [&] { return wavelength_chart(bits, side, options.is_quick); }));
    return experiment;
}

/// Every kernel in both arithmetics; where steps can be smoothed away, after that too.
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

/// The whole of a method, as it is timed.
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
    experiment.truth =
        "The field's normals in closed form, before noise and rounding came to its heights; tests "
        "differentiate it numerically as well.";
    const int bits = recipe.coding == FieldCoding::float32 ? 32 : 16;
    experiment.input = fmt::format("{} x {} texels, {}; the normal map in {}", side, side,
                                   recipe.name, depth_words(bits));
    const std::vector<BumpMethod> methods = methods_for(field, bits);
    BumpExperimentOptions errors_alone;
    errors_alone.repeats = {0, 0};
    const BumpExperiment found = measure_bump(field, methods, errors_alone);
    std::vector<MeasuredMethod> measured;
    for (const BumpMeasurement& one : found.measurements) {
        const std::string kernel = name_of(one.method.kernel, one.method.gaussian_radius);
        const char* const steps = one.method.destaircased ? "smoothed away" : "as they are";
        MeasuredMethod method;
        method.name = fmt::format("{}, {}{}", kernel, word_of(one.method.arithmetic),
                                  one.method.destaircased ? ", steps smoothed away" : "");
        method.choices = {
            {"kernel", kernel}, {"arithmetic", word_of(one.method.arithmetic)}, {"steps", steps}};
        method.error = figures_of(one.error);
        method.work = [&field, chosen = one.method] { convert(field, chosen); };
        measured.push_back(std::move(method));
    }
    measure_methods(measured, options, costs, experiment);
    experiment.finding =
        fmt::format("{} On this map --kernel auto takes {}.", bump_finding(experiment),
                    name_of(found.choice.kernel, found.choice.gaussian_radius));
    return experiment;
}

/// Where on the map kernels err: short waves against long ones.
void add_heat_maps(const FieldRecipe& recipe, int side, Experiment& experiment) {
    const BumpField field = make_bump_field(recipe, side, side);
    for (const char* name : {"central3", "gaussian 4"}) {
        for (const NamedKernel& kernel : named_kernels()) {
            if (kernel.name != name) continue;
            Report report;
            const Image normals = normals_from_height(
                field.heights, with_kernel(field.options, kernel, Arithmetic::float64), report);
            experiment.heat_maps.push_back(
                {fmt::format("Where {} errs on waves that are long at the sides and short in the "
                             "middle",
                             name),
                 fmt::format("{}, float64", name), angles_of(normals, field.normals), 10.0});
        }
    }
}

struct FieldCase {
    std::string id;
    std::string recipe;
    bool is_quick;
};

std::vector<FieldCase> field_cases() {
    return {{"detailed-8", "detailed, 8 bit", true},
            {"mixed-8", "mixed, 8 bit", true},
            {"noisy-float", "noise 0.03, float", true},
            {"smooth-float", "smooth, float", false},
            {"smooth-16", "smooth, 16 bit", false},
            {"smooth-8", "smooth, 8 bit", false},
            {"very-smooth-25-codes", "very smooth, 25 codes of 8 bit", false},
            {"steep-8", "steep, 8 bit", false},
            {"domes-8", "domes, 8 bit", false},
            {"creases-float", "creases, float", false}};
}

Experiment on_field(const FieldCase& one, const RunOptions& options) {
    constexpr int side = 256;  // As in docs/bump.md.
    const FieldRecipe& recipe = recipe_named(one.recipe);
    Experiment experiment =
        on_recipe("bump/" + one.id, recipe, side,
                  {.one_thread = true, .all_threads = true, .memory = false}, options);
    experiment.question = fmt::format(
        "Which kernel makes the truest normals of such a map ({}), and what does it cost?",
        one.recipe);
    if (one.id == "mixed-8") add_heat_maps(recipe, side, experiment);
    return experiment;
}

Experiment on_large_map(const RunOptions& options) {
    const int side = options.is_quick ? 512 : 2048;
    Experiment experiment =
        on_recipe("bump/large", recipe_named("smooth, 16 bit"), side, {}, options);
    experiment.question =
        "What does a large normal map cost, in time and in memory, and what do finer texels bring?";
    experiment.charts.push_back(
        made_once(options, [&] { return resolution_chart(options.is_quick); }));
    return experiment;
}

}  // namespace

std::vector<PlannedExperiment> bump_plan(const RunOptions& options) {
    std::vector<PlannedExperiment> plan;
    for (const int bits : {32, 16, 8}) {
        plan.push_back({fmt::format("Bump: a wave in {}", depth_words(bits)),
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
