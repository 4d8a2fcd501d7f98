// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/sweep_test.cpp.
#include "stability/sweep.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace relief {
namespace {

/// The methods that fail from each value on, in words.
std::string breaks_of(const Chart& chart) {
    std::map<double, std::vector<std::string>> broken;
    for (const Curve& curve : chart.curves) {
        if (curve.breaks_at) broken[*curve.breaks_at].push_back(curve.method);
    }
    std::string text = fmt::format("{} ({}): ", chart.title, chart.x_label);
    if (broken.empty()) return text + "all are within the limit";
    std::size_t count = 0;
    for (const auto& [value, methods] : broken) {
        count += methods.size();
        const bool is_many = methods.size() > 4;
        text += is_many ? fmt::format("{} methods", methods.size())
                        : fmt::format("{}", fmt::join(methods, " and "));
        // Powers of ten: of counts as people write them.
        const std::string where =
            value < 1e4 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value);
        text += fmt::format(" fail{} from {} on, ", methods.size() == 1 ? "s" : "", where);
    }
    if (count == chart.curves.size()) return text + "none is within the limit everywhere";
    return text + "all others are within the limit";
}

}  // namespace

Sweeps::Sweeps(std::vector<std::string> methods, double bound)
    : methods_(std::move(methods)), bound_(bound), degrees_(methods_.size()) {}

void Sweeps::add(const std::string& id, const std::string& title, const std::string& x_label,
                 int decades, int step, const Errors& errors) {
    Chart chart{.id = id,
                .title = title,
                .x_label = x_label,
                .y_label = "RMS error, degrees",
                .bound = bound_};
    for (std::size_t method = 0; method < methods_.size(); ++method) {
        Curve curve{.method = methods_[method]};
        for (int decade = 0; decade <= decades; decade += step) {
            const double value = std::pow(10.0, decade);
            const std::vector<float> degrees = errors(method, value);
            degrees_[method].insert(degrees_[method].end(), degrees.begin(), degrees.end());
            const double error = curve_error(angle_distribution(degrees));
            curve.points.push_back({value, error});
            if (!curve.breaks_at && !(error <= bound_)) curve.breaks_at = value;
        }
        chart.curves.push_back(std::move(curve));
    }
    charts_.push_back(std::move(chart));
}

ErrorFigures Sweeps::figures(std::size_t method) const {
    return figures_of(angle_distribution(degrees_[method]));
}

std::string Sweeps::breaks() const {
    std::string text;
    for (const Chart& chart : charts_)
        text += (text.empty() ? "" : ". ") + breaks_of(chart);
    return text + ".";
}

void measure_swept(std::vector<MeasuredMethod> methods, const Sweeps& sweeps,
                   const RunOptions& options, Experiment& experiment) {
    for (std::size_t i = 0; i < methods.size(); ++i) {
        MeasuredMethod& method = methods[i];
        const bool is_plain = method.name.starts_with("plain");
        method.error = sweeps.figures(i);
        method.choices.emplace_back("guarded", is_plain ? "no" : "yes");
        if (is_plain) method.note = "Not of relief: what plain code does, for contrast.";
    }
    experiment.error_unit = "degrees";
    measure_methods(methods, options, {.all_threads = false, .memory = false}, experiment);
    experiment.charts = sweeps.charts();
    experiment.finding = fmt::format("A method fails where its RMS error exceeds {} degree. {}",
                                     broken_degrees, sweeps.breaks());
}

}  // namespace relief
