// SPDX-License-Identifier: Apache-2.0
// Converts a height map, or parts of it, by all methods in interleaved rounds. The stored normals
// are decoded and compared with the reference in degrees. A time is that of all parts together.
// Tests: tests/accuracy/measure_bump_test.cpp.
#include "relief/accuracy/asset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
constexpr Kernel all_kernels[] = {
    Kernel::forward, Kernel::central3, Kernel::prewitt3, Kernel::sobel3,   Kernel::scharr3,
    Kernel::sobel5,  Kernel::scharr5,  Kernel::central5, Kernel::central7, Kernel::gaussian};

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

BumpOptions options_of(const BumpMethod& method, BumpOptions bump) {
    bump.kernel = method.kernel;
    bump.gaussian_radius = method.gaussian_radius;
    bump.arithmetic = method.arithmetic;
    return bump;
}

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
        destaircased = smooth.rms_degrees < plain.rms_degrees;
        if (destaircased) best = smooth;
    }
    BumpReference reference;
    reference.method =
        BumpMethod{best.kernel, best.gaussian_radius, Arithmetic::float64, 32, destaircased};
    reference.reference_degrees = best.rms_degrees;
    reference.reference_mean_degrees = best.mean_degrees;
    reference.reference_p99_degrees = best.p99_degrees;
    reference.reference_max_degrees = best.max_degrees;
    reference.upper_degrees = best.upper_rms_degrees;
    reference.upper_mean_degrees = best.upper_mean_degrees;
    reference.upper_p99_degrees = best.upper_p99_degrees;
    reference.upper_max_degrees = best.upper_max_degrees;
    reference.description = fmt::format(
        "the kernel selected for this map in float64{}, with an expected error of about {:.2g} "
        "degrees RMS itself; the exact normals are unknown",
        destaircased ? " after smoothing its steps" : "", best.rms_degrees);
    return reference;
}

void take_reference(const BumpReference& reference, Trial& trial) {
    const BumpMethod& method = *reference.method;
    const std::vector<Image>& heights = method.destaircased ? trial.smooth : trial.heights;
    for (const Image& part : heights) {
        Report ignored;
        trial.ground_truth.push_back(
            directions_of(normals_from_height(part, options_of(method, trial.bump), ignored)));
    }
}

/// \param times  the rounds of each method
void mark_pareto_optimal(const std::vector<std::vector<double>>& times,
                         std::vector<BumpMeasurement>& all) {
    std::vector<MethodCost> costs;
    for (std::size_t i = 0; i < all.size(); ++i)
        costs.push_back({all[i].error.rms, all[i].seconds.median, times[i]});
    const std::vector<bool> marks = pareto_optimal(costs);
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i].is_pareto_optimal = marks[i];
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

/// Measures the times. Each round smooths the steps first, once for all methods that need it, so
/// that their times share the drift of the machine with the others.
void take_times(std::span<const BumpMethod> methods, const Trial& trial,
                const BumpExperimentOptions& options, BumpExperiment& experiment) {
    const std::size_t smoothings = is_any_destaircased(methods) ? 1 : 0;
    std::vector<double> smoothing;
    std::vector<std::vector<double>> times(methods.size());
    std::vector<Image> maps;
    interleave(smoothings + methods.size(), options.repeats, [&](std::size_t turn, bool counted) {
        if (turn < smoothings) {
            const double seconds = seconds_of([&] { smoothed_heights(trial); });
            if (counted) smoothing.push_back(seconds);
            return;
        }
        const std::size_t i = turn - smoothings;
        // The first run allocates the maps, which are reused by the timed run.
        convert_parts(trial, methods[i], options.format, maps);
        const double seconds =
            seconds_of([&] { convert_parts(trial, methods[i], options.format, maps); });
        if (counted)
            times[i].push_back(seconds + (methods[i].destaircased ? smoothing.back() : 0.0));
    });
    experiment.smoothing = time_statistics(smoothing);
    const auto texels = static_cast<double>(trial.texels());
    for (std::size_t i = 0; i < methods.size(); ++i) {
        BumpMeasurement& one = experiment.measurements[i];
        one.seconds = time_statistics(times[i]);
        if (one.seconds.median > 0.0) one.megapixels_per_second = texels / one.seconds.median / 1e6;
    }
    mark_pareto_optimal(times, experiment.measurements);
}

/// Runs all methods on a trial with a ground truth.
void measure_methods(std::span<const BumpMethod> methods, const Trial& trial,
                     const BumpExperimentOptions& options, BumpExperiment& experiment) {
    experiment.measurements.resize(methods.size());
    std::vector<Image> maps;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        convert_parts(trial, methods[i], options.format, maps);
        std::vector<float> angles;
        for (std::size_t part = 0; part < maps.size(); ++part) {
            const NormalMapFormat format = format_of(methods[i], options.format);
            Report ignored;
            const std::vector<float> more =
                inner_angles(decode_normal_map(maps[part], format.green, format.flat, ignored),
                             trial.ground_truth[part], trial.margin);
            angles.insert(angles.end(), more.begin(), more.end());
        }
        experiment.measurements[i].method = methods[i];
        experiment.measurements[i].error = error_stats(std::move(angles));
    }
    if (options.repeats.counted > 0) take_times(methods, trial, options, experiment);
}

double error_of(const BumpMeasurement& measurement, ErrorKind kind) {
    return measurement.error.*figure_of(kind);
}

double error_of(const BumpReference& reference, ErrorKind kind) {
    switch (kind) {
        case ErrorKind::mean:
            return reference.reference_mean_degrees;
        case ErrorKind::p99:
            return reference.reference_p99_degrees;
        case ErrorKind::max:
            return reference.reference_max_degrees;
        case ErrorKind::rms:
            break;
    }
    return reference.reference_degrees;
}

double upper_error_of(const BumpReference& reference, ErrorKind kind) {
    switch (kind) {
        case ErrorKind::mean:
            return reference.upper_mean_degrees;
        case ErrorKind::p99:
            return reference.upper_p99_degrees;
        case ErrorKind::max:
            return reference.upper_max_degrees;
        case ErrorKind::rms:
            break;
    }
    return reference.upper_degrees;
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
                for (const Kernel kernel : all_kernels)
                    methods.push_back({kernel, gaussian_radius, arithmetic, bits, smooth});
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
    return {error_of(reference, kind), error_of(measurement, kind)};
}

ExpectedError expected_error_upper(const BumpReference& reference,
                                   const BumpMeasurement& measurement, ErrorKind kind) {
    return {upper_error_of(reference, kind), error_of(measurement, kind)};
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
    const BumpMeasurement* least = nullptr;
    for (const BumpMeasurement& one : experiment.measurements) {
        if (least == nullptr || error_of(one, kind) < error_of(*least, kind)) least = &one;
    }
    return least;
}

}  // namespace relief::accuracy
