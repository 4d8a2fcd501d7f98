// SPDX-License-Identifier: Apache-2.0
// Options of accuracy, and what is settled by a map's own parts. Contradictions are usage errors; a
// bound that nothing keeps to is an error of the map. Tests: tests/tools/bump_accuracy_test.cpp.
#include "bump/bump_accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "bump/bump_accuracy_summary.h"
#include "common/map_choices.h"
#include "relief/mesh/destaircase.h"
#include "relief/mesh/error.h"

namespace relief::tools {
namespace {

using KernelWish = std::optional<Kernel>;

Choices<KernelWish> kernel_or_auto() {
    Choices<KernelWish> choices = {{"auto", std::nullopt}};
    for (const auto& [name, kernel] : kernel_choices())
        choices.emplace_back(name, kernel);
    return choices;
}

bool needs_experiment(const AccuracyRequest& request) {
    return request.compare || request.max_error.has_value();
}

/// The parts for the choice, then those to measure on.
BumpSampleParts wanted_of(const AccuracyRequest& request, const ImageInfo& map) {
    BumpSampleParts wanted;
    if (!request.kernel || needs_experiment(request))
        wanted.looked_at = parts_to_look_at(map.width, map.height);
    if (needs_experiment(request)) wanted.measured = parts_to_measure(map.width, map.height);
    return wanted;
}

/// What may be chosen from, or is to be compared: whatever the command line leaves open.
std::vector<BumpMethod> methods_for(const AccuracyRequest& request, int radius,
                                    const std::vector<int>& depths, bool compares_steps) {
    std::vector<Arithmetic> arithmetics = {Arithmetic::float32, Arithmetic::float64};
    if (request.precision) arithmetics = {*request.precision};
    const std::array ways = {false, true};
    const std::size_t first = request.destaircase && !compares_steps ? 1 : 0;
    const std::size_t last = request.destaircase || compares_steps ? 2 : 1;
    std::vector<BumpMethod> methods =
        bump_methods(radius, depths, arithmetics, std::span(ways).subspan(first, last - first));
    if (request.kernel && !request.compare)
        std::erase_if(methods, [&](const auto& m) { return m.kernel != *request.kernel; });
    return methods;
}

void keep_within(const AccuracyRequest& request, AccuracyFound& found, BumpOptions& bump,
                 NormalMapFormat& format) {
    const ErrorKind kind = request.max_error_kind.value_or(ErrorKind::rms);
    const BumpMeasurement* kept = cheapest_within(*found.experiment, *request.max_error, kind);
    if (kept == nullptr) {
        const BumpMeasurement* least = truest(*found.experiment, kind);
        const double error = kind == ErrorKind::rms ? least->error.rms : least->error.max;
        const bool steps_may_go =
            !request.destaircase && found.experiment->reference.method->destaircased;
        throw InvalidInput(fmt::format(
            "no way to convert it keeps within {:g} degrees ({}): the least is {:.3g}, with {}{}",
            *request.max_error, kind == ErrorKind::rms ? "RMS" : "greatest", error,
            method_words(least->method), steps_may_go ? " (--destaircase comes closer)" : ""));
    }
    found.kept = *kept;
    bump.kernel = kept->method.kernel;
    bump.gaussian_radius = kept->method.gaussian_radius;
    bump.arithmetic = kept->method.arithmetic;
    format.bits = kept->method.bits;
}

}  // namespace

void add_accuracy_options(CLI::App& app, AccuracyRequest& request) {
    const std::string group = "Accuracy";
    add_choice(app, "--kernel", request.kernel, kernel_or_auto(),
               "How the slope is taken from neighbouring heights; all give the same depth. auto "
               "looks at bits, noise and detail of the map and takes the truest for it. central5 "
               "and central7 are for smooth maps of 16 bits or float; sobel5, scharr5 and gaussian "
               "smooth steps and noise; forward is half a texel off. Default: auto.")
        .group(group);
    add_switch(app, "--destaircase", request.destaircase,
               "Smooth the steps of maps of few bits away first; no height moves by more than half "
               "a step.")
        .group(group);
    const Choices<std::optional<Arithmetic>> precisions = {
        {"float32", Arithmetic::float32}, {"float64", Arithmetic::float64}, {"auto", std::nullopt}};
    add_choice(
        app, "--precision", request.precision, precisions,
        "What slopes and normals are computed in. Default: auto, which is float64 for 32-bit "
        "output and float32 else.")
        .group(group);
    add_number(app, "--max-error", "DEG", request.max_error, {0.0, 180.0, "degrees"},
               "Take the cheapest kernel, precision and depth whose error, measured on this map, "
               "stays within DEG degrees of the truest result known; refuse if there is none.")
        .group(group);
    const Choices<ErrorKind> kinds = {{"rms", ErrorKind::rms}, {"max", ErrorKind::max}};
    add_choice(app, "--max-error-kind", request.max_error_kind, kinds,
               "Whether --max-error is for the root mean square or the greatest error. Default: "
               "rms.")
        .group(group);
    add_switch(app, "--compare", request.compare,
               "Also convert in every way, and print error beside time.")
        .group(group);
}

void check(const AccuracyRequest& request, bool slope_moments, bool half) {
    if (request.max_error_kind && !request.max_error)
        throw UsageError("--max-error-kind: is for --max-error", "give --max-error DEG");
    if (!needs_experiment(request)) return;
    if (request.compare && request.max_error)
        throw UsageError("--compare, --max-error: one converts in every way, the other in one");
    const std::string option = request.max_error ? "--max-error" : "--compare";
    if (slope_moments) throw UsageError(option + ", --slope-moments: errors are those of normals");
    if (half) throw UsageError(option + ", --half: errors of half floats are not measured");
}

std::vector<ImagePart> parts_wanted(const AccuracyRequest& request, const ImageInfo& map) {
    return wanted_of(request, map).in_order();
}

AccuracyFound settle_accuracy(const AccuracyRequest& request, const ImageInfo& map,
                              const std::vector<Image>& parts, const std::vector<int>& depths,
                              BumpOptions& bump, NormalMapFormat& format) {
    AccuracyFound found;
    if (request.precision) bump.arithmetic = request.precision;
    if (request.kernel) bump.kernel = *request.kernel;
    const BumpSampleParts wanted = wanted_of(request, map);
    if (wanted.looked_at.empty()) return found;
    const BumpSample sample = wanted.sample(parts);
    if (!request.kernel) {
        found.choice = choose_kernel(sample.looked_at, bump, request.destaircase);
        bump.kernel = found.choice->kernel;
        bump.gaussian_radius = found.choice->gaussian_radius;
    }
    if (!needs_experiment(request)) return found;
    const int radius = found.choice ? best_gaussian_radius(*found.choice) : bump.gaussian_radius;
    BumpExperimentOptions options;
    options.bump = bump;
    options.format = format;
    if (!request.compare) options.repeats = {1, 0};
    const std::vector<int> measured_depths =
        request.max_error ? depths : std::vector<int>{format.bits};
    const bool has_steps = found.choice && found.choice->depth.bits > 0 &&
                           found.choice->depth.bits <= 12 && request.compare;
    found.experiment = measure_bump(
        sample, methods_for(request, radius, measured_depths, has_steps && !request.max_error),
        options);
    if (request.max_error) keep_within(request, found, bump, format);
    return found;
}

void destaircase_map(const AccuracyRequest& request, const Wraps& wrap, HeightMapFile& map,
                     AccuracyFound& found) {
    if (!request.destaircase) return;
    if (map.is_streamed()) {
        throw InvalidInput(
            "--destaircase: the map is too large to be in memory (convert it without)");
    }
    Destaircased smooth = destaircase(map.map().heights, {.wrap = wrap});
    found.step = smooth.step;
    if (smooth.step > 0.0) map.map().heights = std::move(smooth.heights);
}

}  // namespace relief::tools
