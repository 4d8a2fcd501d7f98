// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/measured_methods_test.cpp.
#include "measured_methods.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace relief {

void measure_methods(std::span<const MeasuredMethod> methods, const RunOptions& options,
                     const CostChoice& choice, Experiment& experiment) {
    std::vector<std::function<void()>> works;
    for (const MeasuredMethod& method : methods) {
        if (method.work) works.push_back(method.work);
    }
    const std::vector<Cost> costs = measure_costs(works, options, choice);
    std::size_t timed = 0;
    for (const MeasuredMethod& method : methods) {
        Measurement measurement;
        measurement.method = method.name;
        measurement.choices = method.choices;
        measurement.error = method.error;
        if (method.work) measurement.cost = costs[timed++];
        measurement.cost.stored_bytes = method.stored_bytes;
        measurement.note = method.note;
        experiment.measurements.push_back(std::move(measurement));
    }
    mark_efficient(experiment);
}

const Measurement* truest(const Experiment& experiment) {
    const Measurement* least = nullptr;
    for (const Measurement& one : experiment.measurements) {
        if (std::isnan(curve_error(one.error))) continue;
        if (least == nullptr || one.error.rms < least->error.rms) least = &one;
    }
    return least;
}

const Measurement& method_in(const Experiment& experiment, const std::string& name) {
    for (const Measurement& one : experiment.measurements) {
        if (one.method == name) return one;
    }
    throw std::out_of_range(experiment.id + " has no method " + name);
}

double median_seconds(const Measurement& measurement) {
    if (measurement.cost.one_thread) return measurement.cost.one_thread->spread().median;
    if (measurement.cost.all_threads) return measurement.cost.all_threads->spread().median;
    return std::numeric_limits<double>::quiet_NaN();
}

std::string value_of(const Measurement& measurement, const std::string& choice) {
    for (const auto& [name, value] : measurement.choices) {
        if (name == choice) return value;
    }
    return {};
}

Curve fitted_curve(std::string method, std::vector<CurvePoint> points,
                   std::optional<double> expected_order) {
    Curve curve;
    curve.method = std::move(method);
    curve.order = fitted_order(points);
    curve.expected_order = expected_order;
    curve.points = std::move(points);
    return curve;
}

}  // namespace relief
