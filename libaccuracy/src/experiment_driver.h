// SPDX-License-Identifier: Apache-2.0
/// \file
/// The form of an experiment (an input, methods and rounds), the driver that runs experiments in
/// passes, the list of all experiments, and the clocks and limits with which the driver measures.
/// Tests: tests/accuracy/experiment_driver_test.cpp.
#pragma once

#include <sched.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief::accuracy::detail {

class GlDevice;  // rendered_methods.h

struct MethodError {
    MethodError(const ErrorStats& statistics, std::string text = {})
        : stats(statistics), note(std::move(text)) {}

    ErrorStats stats;
    std::string note;  ///< A remark on the results; mostly empty.
};

/// A method of an experiment. Its functions own or share their input.
struct Method {
    std::string name{};
    Choices choices{};
    /// Computes the error against the ground truth. The driver calls it once.
    std::function<MethodError()> error{};
    /// Does the whole job once and frees its result, for times and memory. A round repeats it if it
    /// is shorter than 4 milliseconds. Empty: the method has no time of its own.
    std::function<void()> work{};
    /// Runs one round and returns its time, instead of `work`.
    std::function<double()> round{};
    double stored_bytes = 0.0;
    std::string note{};  ///< Before that of the error.

    // For recommendations on a user's files only:
    std::string command{};      ///< Applies the method; empty: no tool does.
    double nominal_cost = 0.0;  ///< RecommendationRule::nominal_costs.
};

/// A method as a function of its input, for experiments that apply it to several inputs.
template <typename Input, typename Result>
struct MethodOn {
    std::string name{};
    Choices choices{};
    std::function<Result(const Input&)> compute{};
    bool is_textbook = false;   ///< Code without guards, measured for contrast.
    bool has_work = true;       ///< Otherwise it has no time of its own.
    double stored_bytes = 0.0;  ///< Method::stored_bytes
    std::string note{};
    std::string command{};  ///< Of its own arguments; empty: no tool applies it.
};

template <typename Methods>
std::vector<std::string> names_of(const Methods& methods) {
    std::vector<std::string> names;
    for (const auto& one : methods)
        names.emplace_back(one.name);
    return names;
}

/// Applies functions to one input, as methods of an experiment.
///
/// \param input  of the work that is timed
/// \param error  returns the error of one of the functions
template <typename Input, typename Result, typename Error>
std::vector<Method> methods_on(const std::shared_ptr<const Input>& input,
                               const std::vector<MethodOn<Input, Result>>& functions,
                               const Error& error) {
    std::vector<Method> methods;
    for (const MethodOn<Input, Result>& one : functions) {
        methods.push_back({.name = one.name,
                           .choices = one.choices,
                           .error = [error, one] { return MethodError(error(one)); },
                           .stored_bytes = one.stored_bytes,
                           .note = one.note});
        if (one.has_work) methods.back().work = [input, compute = one.compute] { compute(*input); };
    }
    return methods;
}

/// An experiment whose input exists.
struct PreparedExperiment {
    /// Describes the experiment. The driver adds the subject, the title and the measurements.
    Experiment report{};
    std::vector<Method> methods{};
    CostChoice costs{};
    /// If true, one thread means all threads on one processor, because threads of an OpenGL driver
    /// ignore the limit of parallel loops.
    bool limits_processors = false;
    /// The methods that the finding compares. Empty: the most and the least accurate one.
    std::vector<std::string> compared{};
    /// Adds charts and pictures to the report, and may replace its finding. Called once, after the
    /// last pass.
    std::function<void(Experiment& report)> finish{};
};

/// A value that several experiments share. The first of them makes it.
template <typename Value>
class SharedInput {
  public:
    explicit SharedInput(std::function<std::shared_ptr<const Value>()> make = {})
        : state_(std::make_shared<State>(State{std::move(make), nullptr})) {}

    [[nodiscard]] std::shared_ptr<const Value> get() const {
        if (!state_->value) state_->value = state_->make();
        return state_->value;
    }

  private:
    struct State {
        std::function<std::shared_ptr<const Value>()> make;
        std::shared_ptr<const Value> value;
    };
    std::shared_ptr<State> state_;
};

/// Options of the experiments of a plan.
struct PlanOptions {
    bool is_quick = false;
    SharedInput<GlDevice> device{};
};

/// An experiment that can be run.
struct PlannedExperiment {
    std::string id{};  ///< Experiment::id
    std::string title{};
    /// Makes the input and lists the methods. Called once, and not at all if the experiment is
    /// left out.
    std::function<PreparedExperiment(const PlanOptions&)> prepare{};
    Subject subject = Subject::normals;  ///< Set by run_experiments().
};

/// Runs experiments in passes. run_experiments() has the details.
std::vector<Experiment> run_planned(std::vector<PlannedExperiment> plan, const RunOptions& options,
                                    const PlanOptions& plan_options = {});

/// Measures one experiment in one pass, and marks the Pareto-optimal methods.
Experiment measured(PreparedExperiment prepared, const RunOptions& options);

/// Lists the experiments of a subject. The file of the subject describes them. Without OpenGL,
/// those that render measure nothing, and their findings give the reason.
using Plan = std::vector<PlannedExperiment>(const PlanOptions& options);
Plan normals_plan, tangents_plan, bump_plan, storage_plan, compression_plan, bake_plan,
    decimation_plan, unwrapping_plan, relief_plan, shading_plan, stability_plan;

/// Returns the finding of an experiment: the most accurate of the compared methods, and the errors
/// and times of the others; and the effect of float32, if methods are in pairs of both arithmetics.
///
/// "'max, float64' has the smallest error, 0.453 degrees RMS, 2.03 at most; 'area, float64' has the
/// largest, 1.28."
/// \param compared  as PreparedExperiment::compared
std::string finding_of(const Experiment& experiment, const std::vector<std::string>& compared);

/// Completes a chart with a curve per method.
///
/// \param input_at  makes the input at x, once for all methods
/// \param error  returns the error of method number i on an input
template <typename InputAt, typename Error>
Chart chart_over(Chart chart, const std::vector<std::string>& methods,
                 const std::vector<double>& all_x, const InputAt& input_at, const Error& error) {
    for (const std::string& method : methods)
        chart.curves.push_back({.method = method});
    for (const double x : all_x) {
        const auto input = input_at(x);
        for (std::size_t i = 0; i < methods.size(); ++i)
            chart.curves[i].points.push_back({x, error(i, input)});
    }
    return chart;
}

/// Adds the order fitted to the points of a curve, and that of theory.
void fit(Curve& curve, std::optional<double> expected_order);

// Clocks, thread limits and the peak memory of works

/// Returns how often a work must be repeated so that a round is at least 4 milliseconds long.
/// Shorter rounds are mostly noise: this is a time slice of the scheduler.
std::size_t repeats_per_round(const std::function<void()>& work);

/// Measures the processor time of the process, which excludes the time of other programs; a wall
/// clock includes it. At least a nanosecond.
double processor_seconds_of(const std::function<void()>& work);

/// Returns the peak memory of `work` in bytes in addition to the memory before; nothing if the
/// system does not report it.
std::optional<std::uint64_t> peak_bytes_of(const std::function<void()>& work);

/// Keeps all threads of this process on one processor during its lifetime. A software OpenGL driver
/// starts its threads only once, so this is the only way to time it on one thread. The destructor
/// restores the affinity that the calling thread had.
class SingleProcessor {
  public:
    SingleProcessor();
    ~SingleProcessor();
    SingleProcessor(const SingleProcessor&) = delete;
    SingleProcessor& operator=(const SingleProcessor&) = delete;

    /// Returns whether the system allowed it; if not, nothing has changed.
    [[nodiscard]] bool is_active() const { return is_active_; }

  private:
    ::cpu_set_t before_;
    bool is_active_ = false;
};

}  // namespace relief::accuracy::detail
