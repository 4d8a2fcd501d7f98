// SPDX-License-Identifier: Apache-2.0
// Options of accuracy, and what is settled by a map's own parts. Contradictions are usage errors; a
// bound that nothing keeps to is an error of the map. Tests: tests/tools/bump_accuracy_test.cpp.
#include "bump/bump_accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bump/bump_accuracy_summary.h"
#include "common/choices.h"
#include "relief/mesh/destaircase.h"
#include "relief/mesh/error.h"

namespace relief::tools {
namespace {

bool has_limit(const AccuracyRequest& request) {
    return request.max_error || request.max_added_error;
}

bool needs_experiment(const AccuracyRequest& request) {
    return request.compare || has_limit(request);
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

/// Why nothing keeps within the limits, and what would help.
std::string refusal_words(const AccuracyRequest& request, const BumpExperiment& experiment,
                          ErrorKind kind) {
    const BumpMeasurement* least = truest(experiment, kind);
    const ExpectedError error = expected_error(experiment.reference, *least, kind);
    const char* const kind_words = kind == ErrorKind::rms ? "RMS" : "greatest";
    const bool steps_may_go = !request.destaircase && experiment.reference.method->destaircased;
    const char* const closer = steps_may_go ? " (--destaircase comes closer)" : "";
    if (request.max_added_error && error.added > *request.max_added_error) {
        return fmt::format(
            "no way to convert it adds at most {:g} degrees ({}): the least is {:.3g}, with {}{}",
            *request.max_added_error, kind_words, error.added, method_words(least->method), closer);
    }
    if (std::isnan(error.map)) {
        return fmt::format(
            "its error cannot be estimated, as it has too few texels: no way to convert it is "
            "known "
            "to keep within {:g} degrees (limit what is added by --max-added-error)",
            *request.max_error);
    }
    if (error.map > *request.max_error) {
        return fmt::format(
            "no way to convert it keeps within {:g} degrees ({}): the map itself has an expected "
            "error of {:.3g} ({}), and {} adds {:.3g} (take a better map, or limit what is added "
            "by "
            "--max-added-error){}",
            *request.max_error, kind_words, error.map, experiment.choice.reason,
            method_words(least->method), error.added, closer);
    }
    return fmt::format(
        "no way to convert it keeps within {:g} degrees ({}): the least is {:.3g}, with {}{}",
        *request.max_error, kind_words, error.total(), method_words(least->method), closer);
}

/// Reports what the choice of --kernel auto depends on, as a finding.
void report_grain(const KernelChoice& choice, Report& report) {
    if (!choice.is_ambiguous()) return;
    const KernelPrediction& other = choice.otherwise->best;
    const BumpMethod method{other.kernel, other.gaussian_radius};
    const bool is_noise = choice.noise > 0.0;
    report.add({"fine grain that may be noise or detail",
                "map",
                fmt::format("taken for {}: {:.2g} degrees RMS expected; if it is {}: {:.2g}, and "
                            "{:.2g} by {} (--grain {})",
                            is_noise ? "noise" : "detail", choice.rms_degrees,
                            is_noise ? "detail" : "noise", choice.otherwise->rms_degrees,
                            other.rms_degrees, kernel_words(method), is_noise ? "detail" : "noise"),
                1,
                {0}});
}

void keep_within(const AccuracyRequest& request, AccuracyFound& found, BumpOptions& bump,
                 NormalMapFormat& format) {
    const ErrorKind kind = request.max_error_kind.value_or(ErrorKind::rms);
    const BumpMeasurement* kept =
        cheapest_within(*found.experiment, {request.max_error, request.max_added_error, kind});
    if (kept == nullptr) throw InvalidInput(refusal_words(request, *found.experiment, kind));
    found.kept = *kept;
    bump.kernel = kept->method.kernel;
    bump.gaussian_radius = kept->method.gaussian_radius;
    bump.arithmetic = kept->method.arithmetic;
    format.bits = kept->method.bits;
}

}  // namespace

void add_accuracy_options(CLI::App& app, AccuracyRequest& request) {
    const std::string group = "Accuracy";
    add_choice(app, "--kernel", request.kernel, kernel_or_auto_choices(),
               "How the slope is taken from neighbouring heights; all give the same depth. auto "
               "looks at bits, noise and detail of the map and takes the truest for it. central5 "
               "and central7 are for smooth maps of 16 bits or float; sobel5, scharr5 and gaussian "
               "smooth steps and noise; forward is half a texel off. Default: auto.")
        .group(group);
    const Choices<Grain> grains = {
        {"auto", Grain::automatic}, {"noise", Grain::noise}, {"detail", Grain::detail}};
    add_choice(app, "--grain", request.grain, grains,
               "What --kernel auto takes fine, even grain for: noise, which it smooths away, or "
               "detail, which it keeps. auto: noise, unless the map holds nothing else. Default: "
               "auto.")
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
               "Take the cheapest kernel, precision and depth whose expected error is at most DEG "
               "degrees: the error expected from the map itself (noise, rounding) and the error "
               "that the conversion adds, as root sum of squares. Refuse if there is none.")
        .group(group);
    add_number(app, "--max-added-error", "DEG", request.max_added_error, {0.0, 180.0, "degrees"},
               "The same for the error alone that kernel, precision and depth add to that of the "
               "map: their distance from the truest result known.")
        .group(group);
    const Choices<ErrorKind> kinds = {{"rms", ErrorKind::rms}, {"max", ErrorKind::max}};
    add_choice(app, "--max-error-kind", request.max_error_kind, kinds,
               "Whether --max-error and --max-added-error limit the root mean square or the "
               "greatest error. Default: rms.")
        .group(group);
    add_switch(app, "--compare", request.compare,
               "Also convert in every way, and print error beside time.")
        .group(group);
}

void check(const AccuracyRequest& request, bool slope_moments, bool half) {
    if (request.max_error_kind && !has_limit(request))
        throw UsageError("--max-error-kind: is for --max-error", "give --max-error DEG");
    if (!needs_experiment(request)) return;
    const std::string option = request.max_error         ? "--max-error"
                               : request.max_added_error ? "--max-added-error"
                                                         : "--compare";
    if (request.compare && has_limit(request))
        throw UsageError("--compare, " + option + ": one converts in every way, the other in one");
    if (slope_moments) throw UsageError(option + ", --slope-moments: errors are those of normals");
    if (half) throw UsageError(option + ", --half: errors of half floats are not measured");
}

std::vector<ImagePart> parts_wanted(const AccuracyRequest& request, const ImageInfo& map) {
    return wanted_of(request, map).in_order();
}

AccuracyFound settle_accuracy(const AccuracyRequest& request, const ImageInfo& map,
                              const std::vector<Image>& parts, const std::vector<int>& depths,
                              BumpOptions& bump, NormalMapFormat& format, Report& report) {
    AccuracyFound found;
    if (request.precision) bump.arithmetic = request.precision;
    if (request.kernel) bump.kernel = *request.kernel;
    const BumpSampleParts wanted = wanted_of(request, map);
    if (wanted.looked_at.empty()) return found;
    const BumpSample sample = wanted.sample(parts);
    if (!request.kernel) {
        found.choice = choose_kernel(sample.looked_at, bump, request.destaircase, request.grain);
        report_grain(*found.choice, report);
        bump.kernel = found.choice->kernel;
        bump.gaussian_radius = found.choice->gaussian_radius;
    }
    if (!needs_experiment(request)) return found;
    const int radius = found.choice ? best_gaussian_radius(*found.choice) : bump.gaussian_radius;
    BumpExperimentOptions options;
    options.bump = bump;
    options.format = format;
    options.grain = request.grain;
    if (!request.compare) options.repeats = {1, 0};
    const std::vector<int> measured_depths =
        has_limit(request) ? depths : std::vector<int>{format.bits};
    const bool has_steps = found.choice && found.choice->depth.bits > 0 &&
                           found.choice->depth.bits <= 12 && request.compare;
    found.experiment =
        measure_bump(sample, methods_for(request, radius, measured_depths, has_steps), options);
    if (has_limit(request)) keep_within(request, found, bump, format);
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
