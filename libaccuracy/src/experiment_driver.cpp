// SPDX-License-Identifier: Apache-2.0
// Runs experiments in passes, lists the experiments of all subjects, derives figures that several
// findings contain, measures processor time and resident memory, and limits processors.
#include "experiment_driver.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <system_error>

#include "progress_stage.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "rendered_methods.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;
using namespace relief::detail;

namespace {

/// Computes the errors of all methods.
void begin(PreparedExperiment& prepared) {
    for (const Method& method : prepared.methods) {
        check_cancelled();
        const MethodError error = method.error();
        prepared.report.measurements.push_back({.method = method.name,
                                                .choices = method.choices,
                                                .error = nan_if_empty(error.stats),
                                                .cost = {.stored_bytes = method.stored_bytes},
                                                .note = method.note + error.note});
    }
}

/// Adds interleaved rounds of all methods that have a time.
/// \param cost  receives the times
/// \param clock  returns the wall time or the processor time of a work
void add_rounds(PreparedExperiment& prepared, const Repeats& repeats,
                std::optional<Timing> Cost::*cost, double (*clock)(const std::function<void()>&)) {
    std::vector<std::size_t> timed;
    std::vector<std::size_t> repeats_of_work;
    for (std::size_t i = 0; i < prepared.methods.size(); ++i) {
        const Method& method = prepared.methods[i];
        if (!method.round && !method.work) continue;
        timed.push_back(i);
        repeats_of_work.push_back(1);
        if (method.round) continue;
        check_cancelled();
        method.work();  // The first run fills caches and is slower.
        repeats_of_work.back() = repeats_per_round(method.work);
    }
    const auto seconds_of_round = [&](std::size_t thing) {
        const Method& method = prepared.methods[timed[thing]];
        if (method.round) return method.round();
        const std::size_t count = repeats_of_work[thing];
        const double seconds = clock([&] {
            for (std::size_t repeat = 0; repeat < count; ++repeat)
                method.work();
        });
        return seconds / static_cast<double>(count);
    };
    interleave(timed.size(), repeats, [&](std::size_t thing, bool counted) {
        check_cancelled();
        const double seconds = seconds_of_round(thing);
        if (!counted) return;
        std::optional<Timing>& timing = prepared.report.measurements[timed[thing]].cost.*cost;
        if (!timing) timing.emplace();
        timing->rounds.push_back(seconds);
    });
}

/// Adds the rounds of one pass.
void add_times(PreparedExperiment& prepared, const Repeats& repeats, unsigned threads) {
    if (prepared.costs.one_thread && prepared.limits_processors) {
        const SingleProcessor processor;
        if (processor.is_active())
            add_rounds(prepared, repeats, &Cost::one_thread, processor_seconds_of);
    } else if (prepared.costs.one_thread) {
        const ExecutionScope one_thread({.threads = 1});
        add_rounds(prepared, repeats, &Cost::one_thread, processor_seconds_of);
    }
    const ExecutionScope all_threads({.threads = threads});
    if (prepared.costs.all_threads) add_rounds(prepared, repeats, &Cost::all_threads, seconds_of);
}

/// Measures the memory, marks the Pareto-optimal methods, and finishes the report.
Experiment end(PreparedExperiment& prepared, const RunOptions& options) {
    Experiment& report = prepared.report;
    const ExecutionScope all_threads({.threads = options.threads});
    for (std::size_t i = 0; i < prepared.methods.size(); ++i) {
        const std::function<void()>& work = prepared.methods[i].work;
        if (options.is_timed && prepared.costs.memory && work)
            report.measurements[i].cost.peak_bytes = peak_bytes_of(work);
    }
    mark_pareto_optimal(report);
    if (!prepared.methods.empty()) report.finding = finding_of(report, prepared.compared);
    if (prepared.finish) prepared.finish(report);
    return std::move(report);
}

/// The part of `rounds` that belongs to a pass; the first passes have one more if they cannot be
/// divided evenly.
std::size_t share_of(std::size_t rounds, std::size_t pass, std::size_t passes) {
    return rounds / passes + (pass < rounds % passes ? 1 : 0);
}

}  // namespace

std::vector<Experiment> detail::run_planned(std::vector<PlannedExperiment> plan,
                                            const RunOptions& options,
                                            const PlanOptions& plan_options) {
    if (options.selects_experiment) {
        std::erase_if(plan, [&](const PlannedExperiment& planned) {
            return !options.selects_experiment(planned.id);
        });
    }
    // A pass without rounds would measure nothing.
    const std::size_t most = options.is_timed ? std::max<std::size_t>(options.passes, 1) : 1;
    const std::size_t passes = std::clamp<std::size_t>(options.repeats.counted, 1, most);
    std::vector<PreparedExperiment> prepared(plan.size());
    std::vector<Experiment> experiments;
    for (std::size_t pass = 0; pass < passes; ++pass) {
        for (std::size_t i = 0; i < plan.size(); ++i) {
            if (options.tell) options.tell({plan[i].title, pass, i, plan.size()});
            if (pass == 0) {
                prepared[i] = plan[i].prepare(plan_options);
                prepared[i].report.id = plan[i].id;
                prepared[i].report.subject = plan[i].subject;
                prepared[i].report.title = plan[i].title;
                begin(prepared[i]);
            }
            Repeats repeats = options.repeats;
            repeats.counted = share_of(repeats.counted, pass, passes);
            if (options.is_timed) add_times(prepared[i], repeats, options.threads);
            if (pass + 1 < passes) continue;
            experiments.push_back(end(prepared[i], options));
            prepared[i] = {};  // Frees the input.
            if (options.finished) options.finished(experiments.back());
        }
    }
    return experiments;
}

Experiment detail::measured(PreparedExperiment prepared, const RunOptions& options) {
    begin(prepared);
    if (options.is_timed) add_times(prepared, options.repeats, options.threads);
    return end(prepared, options);
}

namespace {

/// Returns whether two methods differ only in their arithmetic, float64 and then float32.
bool is_arithmetic_pair(const Measurement& one, const Measurement& other) {
    if (one.choices.size() != other.choices.size()) return false;
    bool is_pair = false;
    for (std::size_t i = 0; i < one.choices.size(); ++i) {
        if (one.choices[i] == other.choices[i]) continue;
        if (is_pair || one.choices[i].first != "arithmetic") return false;
        is_pair = one.choices[i].second == "float64" && other.choices[i].second == "float32";
        if (!is_pair) return false;
    }
    return is_pair;
}

/// " float32 changes no RMS error by more than 0.01 degrees and takes 0.70 times as long
/// (median).", or an empty text without pairs.
std::string arithmetic_finding(const Experiment& experiment) {
    const auto& all = experiment.measurements;
    double difference = 0.0;
    std::size_t pairs = 0;
    std::vector<double> ratios;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        if (!is_arithmetic_pair(all[i], all[i + 1])) continue;
        ++pairs;
        difference = std::max(difference, std::abs(all[i + 1].error.rms - all[i].error.rms));
        if (all[i + 1].cost.one_thread)
            ratios.push_back(median_seconds(all[i + 1]) / median_seconds(all[i]));
    }
    if (pairs == 0) return "";
    std::string text = fmt::format(" float32 changes no RMS error by more than {:.2g} {}",
                                   difference, experiment.error_unit);
    if (!ratios.empty())
        text +=
            fmt::format(" and takes {:.2f} times as long (median)", time_statistics(ratios).median);
    return text + ".";
}

}  // namespace

std::string detail::finding_of(const Experiment& experiment,
                               const std::vector<std::string>& compared) {
    std::vector<const Measurement*> methods;
    for (const Measurement& one : experiment.measurements) {
        const bool is_compared = compared.empty() || std::find(compared.begin(), compared.end(),
                                                               one.method) != compared.end();
        if (is_compared && !std::isnan(curve_error(one.error))) methods.push_back(&one);
    }
    if (methods.empty()) return "No method has a defined error everywhere.";
    std::stable_sort(
        methods.begin(), methods.end(),
        [](const Measurement* a, const Measurement* b) { return a->error.rms < b->error.rms; });
    const Measurement& best = *methods.front();
    std::string text =
        fmt::format("'{}' has the smallest error, {:.3g} {} RMS, {:.3g} at most", best.method,
                    best.error.rms, experiment.error_unit, best.error.max);
    if (compared.empty() && methods.size() > 1) {
        const ErrorStats& worst = methods.back()->error;
        text += fmt::format("; '{}' has the largest, {:.3g} RMS, {:.3g} at most",
                            methods.back()->method, worst.rms, worst.max);
    }
    std::vector<std::string> errors, times;
    for (const Measurement* one : methods) {
        if (one != &best) errors.push_back(fmt::format("'{}' {:.3g}", one->method, one->error.rms));
        const double seconds = median_seconds(*one);
        if (!std::isnan(seconds))
            times.push_back(fmt::format("'{}' {}", one->method, format_seconds(seconds)));
    }
    if (compared.empty()) return text + "." + arithmetic_finding(experiment);
    if (!errors.empty()) text += fmt::format("; {}", fmt::join(errors, ", "));
    if (!times.empty()) text += fmt::format(". Median times: {}", fmt::join(times, ", "));
    return text + ".";
}

void detail::fit(Curve& curve, std::optional<double> expected_order) {
    curve.order = fitted_order(curve.points);
    curve.expected_order = expected_order;
}

namespace {

struct SubjectEntry {
    Subject subject;
    Plan* plan;
    bool is_rendered = false;
};

constexpr std::array subject_entries = {
    SubjectEntry{Subject::normals, normals_plan},
    SubjectEntry{Subject::tangents, tangents_plan, true},
    SubjectEntry{Subject::bump, bump_plan},
    SubjectEntry{Subject::storage, storage_plan},
    SubjectEntry{Subject::compression, compression_plan},
    SubjectEntry{Subject::bake, bake_plan},
    SubjectEntry{Subject::decimation, decimation_plan},
    SubjectEntry{Subject::unwrapping, unwrapping_plan},
    SubjectEntry{Subject::relief, relief_plan, true},
    SubjectEntry{Subject::shading, shading_plan, true},
    SubjectEntry{Subject::stability, stability_plan},
};

const SubjectEntry& entry_of(Subject subject) {
    return *std::find_if(subject_entries.begin(), subject_entries.end(),
                         [&](const SubjectEntry& one) { return one.subject == subject; });
}

}  // namespace

bool uses_opengl(Subject subject) {
    return entry_of(subject).is_rendered;
}

Subject subject_from(std::string_view word) {
    std::vector<std::string_view> names;
    for (const EnumName<Subject>& entry : enum_names<Subject>) {
        if (entry.name == word) return entry.value;
        names.emplace_back(entry.name);
    }
    throw InvalidInput(fmt::format("subject '{}' is not one of {}", word, fmt::join(names, ", ")));
}

std::vector<Experiment> run_experiments(std::span<const Subject> subjects,
                                        const RunOptions& options) {
    const PlanOptions plan_options{
        options.is_quick, SharedInput<GlDevice>([] { return std::make_shared<const GlDevice>(); })};
    std::vector<PlannedExperiment> plan;
    for (const Subject subject : subjects) {
        for (PlannedExperiment& planned : entry_of(subject).plan(plan_options)) {
            planned.subject = subject;
            plan.push_back(std::move(planned));
        }
    }
    return run_planned(std::move(plan), options, plan_options);
}

std::size_t detail::repeats_per_round(const std::function<void()>& work) {
    constexpr double min_round_seconds = 4e-3;
    const double seconds = seconds_of(work);
    return seconds >= min_round_seconds
               ? 1
               : static_cast<std::size_t>(std::ceil(min_round_seconds / std::max(seconds, 1e-7)));
}

namespace {

/// Processor time of this process with all its threads, in seconds.
double processor_seconds() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The value of a line such as "VmHWM:   12345 kB" in /proc/self/status, in bytes.
std::optional<std::uint64_t> status_bytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::uint64_t kilobytes = 0;
        if (word == name + ":" && status >> kilobytes) return kilobytes * 1024;
    }
    return std::nullopt;
}

}  // namespace

double detail::processor_seconds_of(const std::function<void()>& work) {
    constexpr double min_seconds = 1e-9;  // Work that only waits must have a positive time.
    const double begin = processor_seconds();
    work();
    return std::max(processor_seconds() - begin, min_seconds);
}

std::optional<std::uint64_t> detail::peak_bytes_of(const std::function<void()>& work) {
    ::malloc_trim(0);  // Otherwise the work could reuse memory that is already resident.
    std::ofstream reset("/proc/self/clear_refs");
    reset << 5 << std::flush;  // Sets VmHWM to the current VmRSS.
    const std::optional<std::uint64_t> before = status_bytes("VmRSS");
    if (!reset || !before) return std::nullopt;
    work();
    const std::optional<std::uint64_t> peak = status_bytes("VmHWM");
    if (!peak) return std::nullopt;
    return *peak - std::min(*peak, *before);
}

namespace {

/// Sets the affinity of all threads of this process. New threads inherit it.
bool set_affinity(const ::cpu_set_t& processors) {
    std::error_code failed;
    bool is_active = true;
    // A thread may end meanwhile; ESRCH is therefore not an error.
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", failed)) {
        const auto thread = static_cast<::pid_t>(std::stoi(entry.path().filename().string()));
        const bool is_set = ::sched_setaffinity(thread, sizeof processors, &processors) == 0;
        is_active = is_active && (is_set || errno == ESRCH);
    }
    return is_active && !failed;
}

/// The set that holds only the first of `processors`.
::cpu_set_t first_of(const ::cpu_set_t& processors) {
    ::cpu_set_t first;
    CPU_ZERO(&first);
    for (int one = 0; one < CPU_SETSIZE; ++one) {
        if (!CPU_ISSET(one, &processors)) continue;
        CPU_SET(one, &first);
        break;
    }
    return first;
}

}  // namespace

SingleProcessor::SingleProcessor() {
    CPU_ZERO(&before_);
    if (::sched_getaffinity(0, sizeof before_, &before_) != 0) return;
    is_active_ = set_affinity(first_of(before_));
    if (!is_active_) set_affinity(before_);
}

SingleProcessor::~SingleProcessor() {
    if (is_active_) set_affinity(before_);
}

}  // namespace relief::accuracy
