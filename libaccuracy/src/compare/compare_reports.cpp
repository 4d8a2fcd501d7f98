// SPDX-License-Identifier: Apache-2.0
// Two runs, matched by experiment and method. Tests: tests/accuracy/compare_reports_test.cpp.
#include "relief/accuracy/compare_reports.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "compare/compare_errors.h"
#include "compare/compare_times.h"

namespace relief {
namespace {

const Experiment* find(const std::vector<Experiment>& all, const std::string& id) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Experiment& one) { return one.id == id; });
    return found == all.end() ? nullptr : &*found;
}

const Measurement* find(const Experiment* experiment, const std::string& method) {
    if (experiment == nullptr) return nullptr;
    const auto& all = experiment->measurements;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Measurement& one) { return one.method == method; });
    return found == all.end() ? nullptr : &*found;
}

/// "EXPERIMENT: METHOD" for what is in one run and not in the other.
std::vector<std::string> missing_from(const std::vector<Experiment>& other,
                                      const std::vector<Experiment>& all) {
    std::vector<std::string> names;
    for (const Experiment& experiment : all) {
        const Experiment* same = find(other, experiment.id);
        for (const Measurement& one : experiment.measurements) {
            if (find(same, one.method) == nullptr)
                names.push_back(experiment.id + ": " + one.method);
        }
    }
    return names;
}

void append(std::vector<std::string>& all, std::vector<std::string> more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
}

bool has_same_input(const Experiment& a, const Experiment& b) {
    return a.input == b.input && a.items == b.items && a.error_unit == b.error_unit;
}

void add_pair(std::vector<TimedPair>& pairs, const std::string& experiment,
              const std::string& method, bool on_all_threads, const std::optional<Timing>& before,
              const std::optional<Timing>& after) {
    if (!before || !after) return;
    if (!(before->spread().median > 0.0) || !(after->spread().median > 0.0)) return;
    pairs.push_back({experiment, method, on_all_threads, before->rounds, after->rounds});
}

/// Less is pages, and how threads happen to meet.
constexpr double least_memory_ratio = 1.1;
constexpr double least_memory_bytes = 1e6;

void add_memory(ReportComparison& result, const std::string& experiment, const Measurement& was,
                const Measurement& is) {
    if (!was.cost.peak_bytes || !is.cost.peak_bytes) return;
    ++result.with_memory;
    const auto before = static_cast<double>(*was.cost.peak_bytes);
    const auto after = static_cast<double>(*is.cost.peak_bytes);
    const double more = std::max(before, after);
    const double less = std::min(before, after);
    if (more - less < least_memory_bytes || more < least_memory_ratio * less) return;
    result.memory.push_back({experiment, was.method, *was.cost.peak_bytes, *is.cost.peak_bytes});
}

/// Those of `pairs` on one thread, or on all.
std::vector<TimedPair> of_kind(const std::vector<TimedPair>& pairs, bool on_all_threads) {
    std::vector<TimedPair> chosen;
    std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(chosen),
                 [&](const TimedPair& one) { return one.on_all_threads == on_all_threads; });
    return chosen;
}

}  // namespace

double MemoryChange::growth() const {
    if (before == 0) return after > 0 ? std::numeric_limits<double>::infinity() : 0.0;
    return static_cast<double>(after) / static_cast<double>(before) - 1.0;
}

ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after, bool same_machine,
                                 const std::optional<double>& max_ratio) {
    ReportComparison result;
    result.gone = missing_from(after, before);
    result.added = missing_from(before, after);
    std::vector<TimedPair> pairs;
    for (const Experiment& old_one : before) {
        const Experiment* new_one = find(after, old_one.id);
        if (new_one == nullptr) continue;
        if (!has_same_input(old_one, *new_one)) {
            result.other_input.push_back(old_one.id);
            continue;
        }
        for (const Measurement& was : old_one.measurements) {
            const Measurement* is = find(new_one, was.method);
            if (is == nullptr) continue;
            ++result.methods;
            ErrorChange change = change_of(old_one, was, *is);
            if (!change.figures.empty()) result.errors.push_back(std::move(change));
            add_memory(result, old_one.id, was, *is);
            add_pair(pairs, old_one.id, was.method, false, was.cost.one_thread,
                     is->cost.one_thread);
            add_pair(pairs, old_one.id, was.method, true, was.cost.all_threads,
                     is->cost.all_threads);
        }
        for (ErrorChange& change : curve_changes(old_one, *new_one))
            result.errors.push_back(std::move(change));
        append(result.gone, curves_missing_from(*new_one, old_one));
        append(result.added, curves_missing_from(old_one, *new_one));
    }
    for (const bool on_all_threads : {false, true}) {
        const std::vector<TimedPair> kind = of_kind(pairs, on_all_threads);
        CommonChange& common = on_all_threads ? result.all_threads : result.one_thread;
        common = common_change(kind, same_machine, max_ratio);
        for (TimeChange& change : judged_times(kind, common, same_machine, max_ratio))
            result.times.push_back(std::move(change));
    }
    return result;
}

}  // namespace relief
