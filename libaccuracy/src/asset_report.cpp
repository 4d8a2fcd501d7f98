// SPDX-License-Identifier: Apache-2.0
// Begins and finishes experiments on a user's files, and recommends one of their methods: the one
// of least cost, of least error, or the knee of the Pareto frontier.
#include "asset_report.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "experiment_driver.h"
#include "progress_stage.h"
#include "relief/accuracy/asset.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/mesh.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;
using namespace relief::detail;

namespace {

/// A method that may be recommended.
struct Candidate {
    std::size_t index = 0;
    double error = 0.0;    ///< RMS error of the method alone.
    double bounded = 0.0;  ///< The error that a limit applies to; includes that of the reference.
    double cost = 0.0;     ///< Seconds or bytes; 0 for all methods if none was measured.
    double bytes = 0.0;    ///< Stored bytes.
    double natural = 0.0;  ///< RecommendationRule::nominal_costs.
};

double nominal_cost(const Measurement& measurement, CostKind kind) {
    return kind == CostKind::bytes ? measurement.cost.stored_bytes : median_seconds(measurement);
}

std::vector<Candidate> candidates_of(const Experiment& experiment, const RecommendationRule& rule) {
    std::vector<Candidate> all;
    const double reference =
        rule.limited_reference.value_or(experiment.reference_error.value_or(0.0));
    bool is_measured = false;
    for (std::size_t i = 0; i < experiment.measurements.size(); ++i) {
        const Measurement& one = experiment.measurements[i];
        if (!rule.choosable.empty() && rule.choosable[i] == 0) continue;
        if (one.error.undefined > 0 || one.error.count == 0 || !std::isfinite(one.error.rms))
            continue;
        const double bounded = std::hypot(reference, one.error.*figure_of(rule.request.kind));
        all.push_back(
            {i, one.error.rms,
             rule.is_reference_unknown ? std::numeric_limits<double>::infinity() : bounded,
             nominal_cost(one, rule.cost), one.cost.stored_bytes,
             rule.nominal_costs.empty() ? 0.0 : rule.nominal_costs[i]});
        is_measured = is_measured || std::isfinite(all.back().cost);
    }
    if (is_measured) {
        std::erase_if(all, [](const Candidate& one) { return !std::isfinite(one.cost); });
    } else {
        for (Candidate& one : all)
            one.cost = 0.0;
    }
    return all;
}

/// The first candidate in the order `less`, or nullptr.
template <typename Less>
const Candidate* first_of(const std::vector<Candidate>& all, const Less& less) {
    const Candidate* best = nullptr;
    for (const Candidate& one : all) {
        if (best == nullptr || less(one, *best)) best = &one;
    }
    return best;
}

template <typename Less>
const Candidate* first_of(const std::vector<Candidate>&& all, const Less& less) = delete;

bool is_more_accurate(const Candidate& a, const Candidate& b) {
    return a.error != b.error ? a.error < b.error : a.cost < b.cost;
}
bool is_cheaper(const Candidate& a, const Candidate& b) {
    return std::tie(a.cost, a.bytes, a.natural, a.error) <
           std::tie(b.cost, b.bytes, b.natural, b.error);
}

const Candidate* knee_of(const std::vector<Candidate>& all, double floor) {
    const auto product = [&](const Candidate& one) {
        const double error = std::hypot(one.error, floor);
        return error * error * error * one.cost;
    };
    // If nothing was timed, all products are 0 and the error decides.
    const auto is_better = [&](const Candidate& a, const Candidate& b) {
        return product(a) != product(b) ? product(a) < product(b) : is_more_accurate(a, b);
    };
    const Candidate* best = first_of(all, is_better);
    if (best == nullptr || best->cost == 0.0) return best;
    const Candidate* taken = best;
    for (const Candidate& one : all) {
        if (one.bytes < taken->bytes && product(one) <= equal_time_ratio * product(*best))
            taken = &one;
    }
    return taken;
}

std::vector<Candidate> kept_of(std::vector<Candidate> all, const MethodRequest& request,
                               CostKind kind) {
    std::erase_if(all, [&](const Candidate& one) {
        return (request.max_error && !(one.bounded <= *request.max_error)) ||
               (kind == CostKind::time && request.max_seconds &&
                !(one.cost <= *request.max_seconds));
    });
    return all;
}

const Candidate* taken_of(const Experiment& experiment, const std::vector<Candidate>& kept,
                          const RecommendationRule& rule) {
    if (rule.request.max_error) return first_of(kept, is_cheaper);
    if (rule.request.max_seconds && rule.cost == CostKind::time)
        return first_of(kept, is_more_accurate);
    return knee_of(kept,
                   std::hypot(experiment.reference_error.value_or(0.0), rule.negligible_error));
}

/// The least accurate of the efficient candidates that are more accurate than `taken`.
const Candidate* next_more_accurate(const std::vector<Candidate>& all, const Candidate& taken) {
    std::vector<MethodCost> prices;
    for (const Candidate& one : all)
        prices.push_back({one.error, one.cost});
    const std::vector<bool> marks = pareto_optimal(prices);
    const Candidate* next = nullptr;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!marks[i] || !(all[i].error < taken.error)) continue;
        if (next == nullptr || all[i].error > next->error) next = &all[i];
    }
    return next;
}

/// The name of a statistic after its unit.
std::string after_unit(ErrorKind kind) {
    return fmt::format("({})", statistic_name(kind));
}

/// An expected error and its upper end, if it is a range.
struct ErrorRange {
    double low = 0.0;
    std::optional<double> high{};
};

ErrorRange with_added(const ErrorRange& reference, double added) {
    ErrorRange sum{std::hypot(reference.low, added)};
    if (reference.high) sum.high = std::hypot(*reference.high, added);
    return sum;
}

/// "1.35", "1.35 to 8.5"
std::string range_text(const ErrorRange& range) {
    return range.high ? fmt::format("{:.3g} to {:.3g}", range.low, *range.high)
                      : fmt::format("{:.3g}", range.low);
}

std::string cost_text(double cost, CostKind kind) {
    return kind == CostKind::bytes ? fmt::format("{:g} bytes", cost) : format_seconds(cost);
}

std::string recommendation_text(const Experiment& experiment, const RecommendationRule& rule,
                                const Candidate& taken, const Candidate* next) {
    const auto& all = experiment.measurements;
    const std::string& unit = experiment.error_unit;
    std::string text = all[taken.index].method + ": ";
    if (experiment.reference_error) {
        const ErrorRange reference{*experiment.reference_error, experiment.reference_error_upper};
        text += fmt::format("{} {} RMS expected ({} {}, this method adds {:.3g})",
                            range_text(with_added(reference, taken.error)), unit, rule.reference,
                            range_text(reference), taken.error);
    } else {
        text += fmt::format("{:.3g} {} RMS", taken.error, unit);
        if (rule.is_reference_unknown) text += fmt::format(", and {}", rule.reference);
    }
    if (rule.request.max_error && rule.request.kind != ErrorKind::rms)
        text += fmt::format(", {:.3g} {} {}", taken.bounded, unit, after_unit(rule.request.kind));
    if (taken.cost > 0.0) text += " at " + cost_text(taken.cost, rule.cost);
    if (next == nullptr) return text + "; no other method is more accurate";
    const double less = taken.error - next->error;
    const std::string gain = fmt::format("{:.2g} {} less", less, unit);
    const std::string& name = all[next->index].method;
    if (!(taken.cost > 0.0))
        return text + fmt::format("; the next more accurate ({}): {}", name, gain);
    const double times = next->cost / taken.cost;
    const std::string price = rule.cost == CostKind::bytes
                                  ? fmt::format("takes {}", cost_text(next->cost, rule.cost))
                              : times < 1.05 ? std::string("takes about as long")
                                             : fmt::format("takes {:.2g} times as long", times);
    return text + fmt::format("; the next more accurate ({}) {} for {}", name, price, gain);
}

std::string refusal_text(const Experiment& experiment, const RecommendationRule& rule,
                         const std::vector<Candidate>& all) {
    if (all.empty()) return "nothing could be measured";
    const MethodRequest& request = rule.request;
    const auto name = [&](const Candidate& one) {
        return experiment.measurements[one.index].method;
    };
    if (request.max_error) {
        const Candidate* least = first_of(
            all, [](const Candidate& a, const Candidate& b) { return a.bounded < b.bounded; });
        if (rule.is_reference_unknown) {
            return fmt::format("no method is known to be within {:g} {} {}, because of {}",
                               *request.max_error, experiment.error_unit, after_unit(request.kind),
                               rule.reference);
        }
        if (!(least->bounded <= *request.max_error)) {
            std::string text =
                fmt::format("no method is within {:g} {} {}: the smallest error is {:.3g}, with {}",
                            *request.max_error, experiment.error_unit, after_unit(request.kind),
                            least->bounded, name(*least));
            if (experiment.reference_error && *experiment.reference_error > 0.0)
                text += fmt::format(" ({} {:.3g})", rule.reference,
                                    rule.limited_reference.value_or(*experiment.reference_error));
            return text;
        }
        MethodRequest error_alone = request;
        error_alone.max_seconds.reset();
        const std::vector<Candidate> accurate_enough = kept_of(all, error_alone, rule.cost);
        const Candidate* cheapest = first_of(accurate_enough, is_cheaper);
        return fmt::format(
            "no method is within {:g} {} {} and {}: the fastest with that error takes {}, with {}",
            *request.max_error, experiment.error_unit, after_unit(request.kind),
            format_seconds(*request.max_seconds), format_seconds(cheapest->cost), name(*cheapest));
    }
    const Candidate* cheapest = first_of(all, is_cheaper);
    return fmt::format("no method is within {}: the fastest takes {}, with {}",
                       format_seconds(*request.max_seconds), format_seconds(cheapest->cost),
                       name(*cheapest));
}

}  // namespace

Recommendation recommended(const Experiment& experiment, const RecommendationRule& rule) {
    const std::vector<Candidate> all = candidates_of(experiment, rule);
    const std::vector<Candidate> kept = kept_of(all, rule.request, rule.cost);
    Recommendation result;
    const Candidate* taken = taken_of(experiment, kept, rule);
    if (taken == nullptr) {
        result.description = refusal_text(experiment, rule, all);
        return result;
    }
    const Candidate* next = next_more_accurate(all, *taken);
    result.method = taken->index;
    if (next != nullptr) result.next = next->index;
    result.description = recommendation_text(experiment, rule, *taken, next);
    return result;
}

AssetExperiment detail::asset_experiment(Subject subject, const std::string& topic,
                                         const std::string& title, const AssetOptions& options) {
    check_cancelled();
    AssetExperiment asset;
    Experiment& experiment = asset.experiment;
    experiment.id = "own/" + (options.file.empty() ? topic : options.file + "/" + topic);
    experiment.subject = subject;
    experiment.title = options.file.empty() ? title : fmt::format("{} of {}", title, options.file);
    experiment.error_unit = "degrees";
    experiment.command = options.command;
    if (options.run.tell) options.run.tell({.title = experiment.title});
    return asset;
}

std::function<MethodError()> detail::known_error(const ErrorStats& error) {
    return [error] { return error; };
}

void detail::set_finding(AssetExperiment& asset) {
    asset.experiment.finding = asset.recommendation.description + ".";
    if (!asset.command().empty()) asset.experiment.finding += " To do it: " + asset.command();
}

void detail::finish(AssetExperiment& asset, const std::vector<Method>& methods,
                    RecommendationRule rule, const AssetOptions& options) {
    const ProgressStage stage("measuring");
    std::vector<unsigned char> choosable;
    std::vector<double> nominal_costs;
    for (const Method& method : methods) {
        choosable.push_back(method.command.empty() ? 0 : 1);
        nominal_costs.push_back(method.nominal_cost);
        asset.commands.push_back(method.command);
    }
    asset.experiment = measured(
        {.report = std::move(asset.experiment), .methods = methods, .costs = options.costs},
        options.run);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        Measurement& one = asset.experiment.measurements[i];
        if (asset.experiment.reference_error && one.error.count > 0)
            one.expected = ExpectedError{*asset.experiment.reference_error, one.error.rms};
    }
    rule.request = options.request;
    rule.choosable = choosable;
    rule.nominal_costs = nominal_costs;
    asset.recommendation = recommended(asset.experiment, rule);
    set_finding(asset);
}

Mesh detail::part_to_measure(const Mesh& mesh, std::size_t max_triangles) {
    const std::size_t count = mesh.triangles.size();
    if (count <= max_triangles) return mesh;
    constexpr std::size_t runs = 8;
    const std::size_t length = std::max<std::size_t>(max_triangles / runs, 1);
    std::vector<std::uint32_t> triangles;
    for (std::size_t run = 0; run < runs; ++run) {
        const std::size_t first = run * (count - length) / (runs - 1);
        for (std::size_t t = first; t < first + length; ++t)
            triangles.push_back(static_cast<std::uint32_t>(t));
    }
    return part_of(mesh, triangles);
}

}  // namespace relief::accuracy
