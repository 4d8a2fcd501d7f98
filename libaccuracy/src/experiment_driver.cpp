// SPDX-License-Identifier: Apache-2.0
// Measures methods, fits orders, splits the rounds into passes, and runs the experiments of a
// subject.
#include "experiment_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "bake_experiments.h"
#include "bump_experiments.h"
#include "normals_experiments.h"
#include "relief/accuracy/experiment.h"
#include "relief/accuracy/measure.h"
#include "relief/mesh/report.h"
#include "shading_experiments.h"
#include "stability_experiments.h"
#include "storage_experiments.h"
#include "tangents_experiments.h"

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
        measurement.error = nan_if_empty(method.error);
        if (method.work) measurement.cost = costs[timed++];
        measurement.cost.stored_bytes = method.stored_bytes;
        measurement.note = method.note;
        experiment.measurements.push_back(std::move(measurement));
    }
    mark_pareto_optimal(experiment);
}

const Measurement* most_accurate(const Experiment& experiment) {
    const Measurement* least = nullptr;
    for (const Measurement& one : experiment.measurements) {
        if (std::isnan(curve_error(one.error))) continue;
        if (least == nullptr || one.error.rms < least->error.rms) least = &one;
    }
    return least;
}

std::string arithmetic_finding(const Experiment& experiment, const char* plural) {
    const auto& all = experiment.measurements;
    double difference = 0.0;
    std::vector<double> ratios;
    for (std::size_t i = 0; i + 1 < all.size(); i += 2) {
        const Measurement& in_double = all[i];
        const Measurement& in_float = all[i + 1];
        difference = std::max(difference, std::abs(in_float.error.rms - in_double.error.rms));
        if (in_float.cost.one_thread)
            ratios.push_back(median_seconds(in_float) / median_seconds(in_double));
    }
    std::string text =
        fmt::format("float32 changes no RMS error by more than {:.2g} degrees", difference);
    if (!ratios.empty())
        text += fmt::format(" and takes {:.2f} times as long (median of the {})",
                            time_statistics(ratios).median, plural);
    return text + ".";
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

void PassHistory::begin_pass() {
    ++begun_;
    id_.clear();
}

void PassHistory::begin_experiment(const std::string& id) {
    id_ = id;
}

std::size_t PassHistory::share_of(std::size_t rounds) const {
    const std::size_t passes_before = begun_ > 0 ? begun_ - 1 : 0;
    return rounds / passes_ + (passes_before < rounds % passes_ ? 1 : 0);
}

std::vector<Timing>& PassHistory::group(const std::string& name, std::size_t methods) {
    std::vector<Timing>& timings = records_[id_].groups.try_emplace(name, methods).first->second;
    // The methods of an experiment can change if OpenGL becomes unavailable.
    if (timings.size() != methods)
        throw std::runtime_error("an experiment times other methods than in the pass before");
    return timings;
}

const std::any& PassHistory::result(const std::string& name,
                                    const std::function<std::any()>& make) {
    const auto known = records_[id_].results.find(name);
    if (known != records_[id_].results.end()) return known->second;
    // `make` may ask for other results, so the entry is added afterwards.
    std::any made = make();
    return records_[id_].results.insert_or_assign(name, std::move(made)).first->second;
}

std::vector<Experiment> run_in_passes(
    std::size_t passes, const RunOptions& options,
    const std::function<std::vector<Experiment>(const RunOptions& options, std::size_t pass)>&
        run) {
    RunOptions with_rounds = options;
    // A pass without rounds would measure nothing.
    const std::size_t needed =
        options.is_timed ? std::clamp<std::size_t>(options.repeats.counted, 1, passes) : 1;
    with_rounds.earlier = std::make_shared<PassHistory>(needed);
    std::vector<Experiment> experiments;
    for (std::size_t pass = 0; pass < needed; ++pass) {
        with_rounds.earlier->begin_pass();
        experiments = run(with_rounds, pass);
    }
    return experiments;
}

std::vector<Experiment> run_planned(std::span<const PlannedExperiment> plan,
                                    const RunOptions& options) {
    std::vector<Experiment> experiments;
    for (const PlannedExperiment& planned : plan) {
        if (options.tell) options.tell(planned.title, experiments.size(), plan.size());
        if (options.earlier) options.earlier->begin_experiment(planned.title);
        experiments.push_back(planned.run());
        experiments.back().title = planned.title;
    }
    if (options.earlier) options.earlier->begin_experiment({});
    return experiments;
}

namespace {

struct SubjectEntry {
    Subject subject;
    std::string_view name;
    std::vector<Experiment> (*run)(const RunOptions&);
    bool is_rendered = false;
};

/// All subjects, in the order of reports.
constexpr std::array subject_entries = {
    SubjectEntry{Subject::normals, "normals", normals_experiments},
    SubjectEntry{Subject::tangents, "tangents", tangents_experiments, true},
    SubjectEntry{Subject::bump, "bump", bump_experiments},
    SubjectEntry{Subject::storage, "storage", storage_experiments},
    SubjectEntry{Subject::bake, "bake", bake_experiments},
    SubjectEntry{Subject::shading, "shading", shading_experiments, true},
    SubjectEntry{Subject::stability, "stability", stability_experiments},
};

const SubjectEntry& entry_of(Subject subject) {
    return *std::find_if(subject_entries.begin(), subject_entries.end(),
                         [&](const SubjectEntry& one) { return one.subject == subject; });
}

}  // namespace

std::vector<Subject> subjects_with_experiments() {
    std::vector<Subject> subjects;
    for (const SubjectEntry& entry : subject_entries)
        subjects.push_back(entry.subject);
    return subjects;
}

bool uses_opengl(Subject subject) {
    return entry_of(subject).is_rendered;
}

std::string_view name_of(Subject subject) {
    return entry_of(subject).name;
}

Subject subject_from(std::string_view word) {
    std::vector<std::string_view> names;
    for (const SubjectEntry& entry : subject_entries) {
        if (entry.name == word) return entry.subject;
        names.push_back(entry.name);
    }
    throw InvalidInput(fmt::format("subject '{}' is not one of {}", word, fmt::join(names, ", ")));
}

std::vector<Experiment> run_experiments(Subject subject, const RunOptions& options) {
    return entry_of(subject).run(options);
}

}  // namespace relief
