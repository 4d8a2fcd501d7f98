// SPDX-License-Identifier: Apache-2.0
// Converts a height map, or parts of it, by all methods in interleaved rounds. The stored normals
// are decoded and compared with the reference in degrees. A time is that of all parts together.
// Tests: tests/accuracy/measure_bump_test.cpp.
#include "relief/accuracy/asset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiment_driver.h"
#include "experiment_parts.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;

namespace {

/// Only maps with fewer bits than this are de-staircased, because the steps of others are
/// invisible.
constexpr int fine_bits = 13;

/// The input of all conversions.
struct Trial {
    std::vector<Image> heights;
    std::vector<Image> smooth;  ///< De-staircased; empty if no method needs it.
    std::vector<std::vector<glm::dvec3>> ground_truth;
    BumpOptions bump;
    int margin =
        0;  ///< Texels along the border that are not compared, because parts lack neighbors.

    [[nodiscard]] std::int64_t texels() const {
        std::int64_t sum = 0;
        for (const Image& part : heights)
            sum += std::int64_t{part.width} * part.height;
        return sum;
    }
};

bool is_any_destaircased(std::span<const BumpMethod> methods) {
    return std::any_of(methods.begin(), methods.end(),
                       [](const BumpMethod& method) { return method.destaircased; });
}

std::vector<Image> smoothed_heights(const Trial& trial) {
    std::vector<Image> smooth;
    for (const Image& part : trial.heights)
        smooth.push_back(destaircase(part, {.wrap = *trial.bump.wrap}).heights);
    return smooth;
}

BumpReference reference_for(const BumpSample& sample, const BumpExperimentOptions& options,
                            const KernelChoice& plain) {
    KernelChoice best = plain;
    bool destaircased = false;
    if (plain.depth.bits > 0 && plain.depth.bits < fine_bits) {
        const KernelChoice smooth =
            choose_kernel(sample.analyzed, options.bump, true, options.grain);
        // Expected errors are measured on samples: less is no difference.
        constexpr double clearly_less = 0.95;
        destaircased = smooth.rms_degrees < clearly_less * plain.rms_degrees;
        if (destaircased) best = smooth;
    }
    BumpReference reference;
    reference.method =
        BumpMethod{best.kernel, best.gaussian_radius, Arithmetic::float64, 32, destaircased};
    reference.error = {.rms = best.rms_degrees,
                       .mean = best.mean_degrees,
                       .p99 = best.p99_degrees,
                       .max = best.max_degrees};
    reference.upper_error = {.rms = best.upper_rms_degrees,
                             .mean = best.upper_mean_degrees,
                             .p99 = best.upper_p99_degrees,
                             .max = best.upper_max_degrees};
    reference.description = fmt::format(
        "the kernel selected for this map in float64{}, with an expected error of about {:.2g} "
        "degrees RMS itself; the exact normals are unknown",
        destaircased ? " after smoothing its steps" : "", best.rms_degrees);
    return reference;
}

void take_reference(const BumpReference& reference, Trial& trial) {
    const BumpMethod& method = *reference.method;
    const std::vector<Image>& heights = method.destaircased ? trial.smooth : trial.heights;
    for (const Image& part : heights)
        trial.ground_truth.push_back(directions_of(normals_by(method, part, trial.bump)));
}

NormalMapFormat format_of(const BumpMethod& method, NormalMapFormat format) {
    format.bits = method.bits;
    return format;
}

void convert_parts(const Trial& trial, const BumpMethod& method, const NormalMapFormat& format,
                   std::vector<Image>& maps) {
    const std::vector<Image>& heights = method.destaircased ? trial.smooth : trial.heights;
    maps.resize(heights.size());
    Report ignored;
    for (std::size_t part = 0; part < heights.size(); ++part)
        normal_map_from_height(heights[part], options_of(method, trial.bump),
                               format_of(method, format), maps[part], ignored);
}

/// The errors of the stored normals of all parts.
ErrorStats conversion_error(const Trial& trial, const BumpMethod& method,
                            const NormalMapFormat& format, std::vector<Image>& maps) {
    convert_parts(trial, method, format, maps);
    std::vector<float> angles;
    for (std::size_t part = 0; part < maps.size(); ++part) {
        Report ignored;
        const std::vector<float> more =
            inner_angles(decode_normal_map(maps[part], format.green, format.flat, ignored),
                         trial.ground_truth[part], trial.margin);
        angles.insert(angles.end(), more.begin(), more.end());
    }
    return error_stats(std::move(angles));
}

/// Runs all methods on a trial with a ground truth. Each round smooths the steps first, once for
/// all methods that need it, so that their times share the drift of the machine with the others.
void measure_methods(std::span<const BumpMethod> methods, const Trial& trial,
                     const BumpExperimentOptions& options, BumpExperiment& result) {
    const std::size_t smoothings = is_any_destaircased(methods) ? 1 : 0;
    double smoothing = 0.0;
    std::vector<Image> maps;
    PreparedExperiment prepared{.costs = {.one_thread = false, .memory = false}};
    if (smoothings > 0) {
        prepared.methods.push_back(
            {.error = [] { return ErrorStats(); },
             .round = [&] { return smoothing = seconds_of([&] { smoothed_heights(trial); }); }});
    }
    for (const BumpMethod& method : methods) {
        const auto convert = [&] { convert_parts(trial, method, options.format, maps); };
        prepared.methods.push_back(
            {.error = [&] { return conversion_error(trial, method, options.format, maps); },
             .round =
                 [&, convert] {
                     convert();  // Allocates the maps, which are reused by the timed run.
                     return seconds_of(convert) + (method.destaircased ? smoothing : 0.0);
                 }});
    }
    RunOptions run;
    run.repeats = options.repeats;
    run.is_timed = options.repeats.counted > 0;
    const Experiment experiment = measured(std::move(prepared), run);
    const auto times_of = [](const Measurement& one) {
        return one.cost.all_threads ? one.cost.all_threads->spread() : TimeStatistics();
    };
    if (smoothings > 0) result.smoothing = times_of(experiment.measurements.front());
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const Measurement& one = experiment.measurements[smoothings + i];
        const TimeStatistics times = times_of(one);
        const double rate = static_cast<double>(trial.texels()) / times.median / 1e6;
        result.measurements.push_back(
            {methods[i], one.error, times, times.median > 0.0 ? rate : 0.0, one.is_pareto_optimal});
    }
}

}  // namespace

double nominal_cost(const BumpMethod& method) {
    const GradientKernel kernel = gradient_kernel(method.kernel, method.gaussian_radius);
    // Both slopes need a multiplication and two additions for each difference and smoothed pair.
    const double operations =
        6.0 * static_cast<double>(kernel.differences.size() + kernel.smoothing.size());
    return 1e6 * method.bits + (method.destaircased ? 1e5 : 0.0) +
           operations * (method.arithmetic == Arithmetic::float64 ? 2.0 : 1.0);
}

std::vector<BumpMethod> bump_methods(int gaussian_radius, std::span<const int> depths,
                                     std::span<const Arithmetic> arithmetics,
                                     std::span<const bool> destaircased) {
    std::vector<BumpMethod> methods;
    for (const bool smooth : destaircased) {
        for (const int bits : depths) {
            for (const Arithmetic arithmetic : arithmetics) {
                for (const EnumName<Kernel>& kernel : enum_names<Kernel>)
                    methods.push_back({kernel.value, gaussian_radius, arithmetic, bits, smooth});
            }
        }
    }
    return methods;
}

std::vector<ImagePart> parts_to_measure(int width, int height, std::int64_t max_texels) {
    if (std::int64_t{width} * height <= max_texels) return {{0, 0, width, height}};
    constexpr int each_way = 3;
    const auto side = static_cast<int>(std::sqrt(max_texels / (each_way * each_way)));
    const int part_width = std::clamp(side, 1, width);
    const int part_height = std::clamp(side, 1, height);
    std::vector<ImagePart> parts;
    for (int row = 0; row < each_way; ++row) {
        for (int column = 0; column < each_way; ++column) {
            parts.push_back({static_cast<int>(std::int64_t{column} * (width - part_width) / 2),
                             static_cast<int>(std::int64_t{row} * (height - part_height) / 2),
                             part_width, part_height});
        }
    }
    return parts;
}

std::vector<ImagePart> BumpSampleParts::in_order() const {
    std::vector<ImagePart> all = analyzed;
    for (const ImagePart& part : measured) {
        if (std::find(all.begin(), all.end(), part) == all.end()) all.push_back(part);
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const ImagePart& a, const ImagePart& b) { return a.y < b.y; });
    return all;
}

BumpSample BumpSampleParts::sample(const std::vector<Image>& images) const {
    const std::vector<ImagePart> order = in_order();
    const auto taken = [&](const std::vector<ImagePart>& places) {
        std::vector<Image> found;
        for (const ImagePart& place : places) {
            const auto at = std::find(order.begin(), order.end(), place) - order.begin();
            found.push_back(images.at(static_cast<std::size_t>(at)));
        }
        return found;
    };
    return {taken(analyzed), taken(measured), measured.size() <= 1};
}

BumpSample sample_of(const Image& height, std::int64_t max_texels) {
    if (height.empty()) throw InvalidInput("an empty height field cannot be measured");
    BumpSample sample;
    for (const ImagePart& part : parts_to_analyze(height.width, height.height))
        sample.analyzed.push_back(part_of(height, part));
    const std::vector<ImagePart> parts = parts_to_measure(height.width, height.height, max_texels);
    sample.is_whole = parts.size() == 1;
    for (const ImagePart& part : parts)
        sample.measured.push_back(sample.is_whole ? height : part_of(height, part));
    return sample;
}

BumpExperiment measure_bump(const BumpSample& sample, std::span<const BumpMethod> methods,
                            const BumpExperimentOptions& options) {
    BumpExperiment experiment;
    experiment.choice = choose_kernel(sample.analyzed, options.bump, false, options.grain);
    experiment.reference = reference_for(sample, options, experiment.choice);
    Trial trial;
    trial.bump = options.bump;
    trial.heights = sample.measured;
    if (!trial.bump.wrap) trial.bump.wrap = detect_tiling(sample.measured.front()).wraps();
    if (!sample.is_whole) {
        trial.bump.wrap = Wrap::clamp;
        const Image& part = sample.measured.front();
        trial.margin = std::min({16, (part.width - 1) / 2, (part.height - 1) / 2});
    }
    if (experiment.reference.method->destaircased || is_any_destaircased(methods))
        trial.smooth = smoothed_heights(trial);
    take_reference(experiment.reference, trial);
    experiment.texels = trial.texels();
    experiment.is_whole = sample.is_whole;
    measure_methods(methods, trial, options, experiment);
    return experiment;
}

BumpExperiment measure_bump(const BumpField& field, std::span<const BumpMethod> methods,
                            BumpExperimentOptions options) {
    options.bump = field.options;
    BumpExperiment experiment;
    experiment.choice = choose_kernel(field.heights, options.bump);
    experiment.reference.description = "the exact normals of the field";
    Trial trial;
    trial.bump = options.bump;
    trial.heights.push_back(field.heights);
    if (is_any_destaircased(methods)) trial.smooth = smoothed_heights(trial);
    trial.ground_truth.push_back(field.normals);
    experiment.texels = trial.texels();
    measure_methods(methods, trial, options, experiment);
    return experiment;
}

ExpectedError expected_error(const BumpReference& reference, const BumpMeasurement& measurement,
                             ErrorKind kind) {
    return {reference.error.*figure_of(kind), measurement.error.*figure_of(kind)};
}

ExpectedError expected_error_upper(const BumpReference& reference,
                                   const BumpMeasurement& measurement, ErrorKind kind) {
    return {reference.upper_error.*figure_of(kind), measurement.error.*figure_of(kind)};
}

const BumpMeasurement* cheapest_within(const BumpExperiment& experiment,
                                       const ErrorLimits& limits) {
    const BumpMeasurement* cheapest = nullptr;
    for (const BumpMeasurement& one : experiment.measurements) {
        if (!limits.hold(expected_error(experiment.reference, one, limits.kind))) continue;
        if (cheapest == nullptr || nominal_cost(one.method) < nominal_cost(cheapest->method))
            cheapest = &one;
    }
    return cheapest;
}

const BumpMeasurement* most_accurate(const BumpExperiment& experiment, ErrorKind kind) {
    const auto& all = experiment.measurements;
    const auto error = [&](const BumpMeasurement& one) { return one.error.*figure_of(kind); };
    return all.empty() ? nullptr : &*std::ranges::min_element(all, {}, error);
}

}  // namespace relief::accuracy
