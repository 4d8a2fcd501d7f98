// SPDX-License-Identifier: Apache-2.0
// Least cost, least error, or the knee of the frontier. Tests: tests/accuracy/recommend_test.cpp.
#include "relief/accuracy/recommend.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "measured_methods.h"
#include "relief/accuracy/words.h"
#include "relief/mesh/frontier.h"

namespace relief {
namespace {

/// Those that may be taken, with what the rule looks at.
struct Candidate {
    std::size_t index = 0;
    double error = 0.0;    ///< RMS that the method adds.
    double bounded = 0.0;  ///< What a bound is for: the reference's own error included.
    double cost = 0.0;     ///< Seconds or bytes; all 0 where none is known.
    double bytes = 0.0;    ///< Stored.
    double natural = 0.0;  ///< RecommendationRule::natural_costs.
};

double cost_of(const Measurement& measurement, CostKind kind) {
    return kind == CostKind::bytes ? measurement.cost.stored_bytes : median_seconds(measurement);
}

std::vector<Candidate> candidates_of(const Experiment& experiment, const RecommendationRule& rule) {
    std::vector<Candidate> all;
    const double reference = experiment.reference_error.value_or(0.0);
    bool is_measured = false;
    for (std::size_t i = 0; i < experiment.measurements.size(); ++i) {
        const Measurement& one = experiment.measurements[i];
        if (!rule.choosable.empty() && rule.choosable[i] == 0) continue;
        if (one.error.undefined > 0 || one.error.count == 0 || !std::isfinite(one.error.rms))
            continue;
        all.push_back({i, one.error.rms, std::hypot(reference, one.error.*(rule.wish.figure)),
                       cost_of(one, rule.cost), one.cost.stored_bytes,
                       rule.natural_costs.empty() ? 0.0 : rule.natural_costs[i]});
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

/// The first of those that `less` puts before all others; nullptr of none.
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

bool is_truer(const Candidate& a, const Candidate& b) {
    return a.error != b.error ? a.error < b.error : a.cost < b.cost;
}
bool is_cheaper(const Candidate& a, const Candidate& b) {
    return std::tie(a.cost, a.bytes, a.natural, a.error) <
           std::tie(b.cost, b.bytes, b.natural, b.error);
}

/// Times are hardly known better than this.
constexpr double alike = 1.1;

const Candidate* knee_of(const std::vector<Candidate>& all, double floor) {
    const auto worth = [&](const Candidate& one) {
        return std::pow(std::hypot(one.error, floor), 3.0) * one.cost;
    };
    // Untimed, costs are all 0 and so is each product: then what decides is the error.
    const auto is_better = [&](const Candidate& a, const Candidate& b) {
        return worth(a) != worth(b) ? worth(a) < worth(b) : is_truer(a, b);
    };
    const Candidate* best = first_of(all, is_better);
    if (best == nullptr || best->cost == 0.0) return best;
    const Candidate* taken = best;
    for (const Candidate& one : all) {
        if (one.bytes < taken->bytes && worth(one) <= alike * worth(*best)) taken = &one;
    }
    return taken;
}

std::vector<Candidate> kept_of(std::vector<Candidate> all, const Wish& wish, CostKind kind) {
    std::erase_if(all, [&](const Candidate& one) {
        return (wish.max_error && !(one.bounded <= *wish.max_error)) ||
               (kind == CostKind::time && wish.max_seconds && !(one.cost <= *wish.max_seconds));
    });
    return all;
}

const Candidate* taken_of(const Experiment& experiment, const std::vector<Candidate>& kept,
                          const RecommendationRule& rule) {
    if (rule.wish.max_error) return first_of(kept, is_cheaper);
    if (rule.wish.max_seconds && rule.cost == CostKind::time) return first_of(kept, is_truer);
    return knee_of(kept, std::hypot(experiment.reference_error.value_or(0.0), rule.unseen_error));
}

/// The one of the largest error among the efficient ones that are more accurate.
const Candidate* next_more_accurate(const std::vector<Candidate>& all, const Candidate& taken) {
    std::vector<Price> prices;
    for (const Candidate& one : all)
        prices.push_back({one.error, one.cost});
    const std::vector<bool> marks = efficient(prices);
    const Candidate* next = nullptr;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!marks[i] || !(all[i].error < taken.error)) continue;
        if (next == nullptr || all[i].error > next->error) next = &all[i];
    }
    return next;
}

std::string cost_words(double cost, CostKind kind) {
    return kind == CostKind::bytes ? fmt::format("{:g} bytes", cost) : seconds_in_words(cost);
}

std::string words_of(const Experiment& experiment, const RecommendationRule& rule,
                     const Candidate& taken, const Candidate* next) {
    const auto& all = experiment.measurements;
    const std::string& unit = experiment.error_unit;
    std::string words = all[taken.index].method + ": ";
    if (experiment.reference_error) {
        words += fmt::format("{:.3g} {} RMS expected ({} {:.3g}, this method adds {:.3g})",
                             std::hypot(*experiment.reference_error, taken.error), unit,
                             rule.reference, *experiment.reference_error, taken.error);
    } else {
        words += fmt::format("{:.3g} {} RMS", taken.error, unit);
    }
    if (taken.cost > 0.0) words += " at " + cost_words(taken.cost, rule.cost);
    if (next == nullptr) return words + "; no other method is more accurate";
    const double less = taken.error - next->error;
    const std::string gain = fmt::format("{:.2g} {} less", less, unit);
    const std::string& name = all[next->index].method;
    if (!(taken.cost > 0.0))
        return words + fmt::format("; the next more accurate ({}): {}", name, gain);
    const double times = next->cost / taken.cost;
    const std::string price = rule.cost == CostKind::bytes
                                  ? fmt::format("takes {}", cost_words(next->cost, rule.cost))
                              : times < 1.05 ? std::string("takes about as long")
                                             : fmt::format("takes {:.2g} times as long", times);
    return words + fmt::format("; the next more accurate ({}) {} for {}", name, price, gain);
}

std::string refusal_words(const Experiment& experiment, const RecommendationRule& rule,
                          const std::vector<Candidate>& all) {
    if (all.empty()) return "nothing could be measured";
    const Wish& wish = rule.wish;
    const auto name = [&](const Candidate& one) {
        return experiment.measurements[one.index].method;
    };
    if (wish.max_error) {
        const Candidate* least = first_of(
            all, [](const Candidate& a, const Candidate& b) { return a.bounded < b.bounded; });
        if (!(least->bounded <= *wish.max_error)) {
            std::string words =
                fmt::format("no method is within {:g} {}: the least is {:.3g}, with {}",
                            *wish.max_error, experiment.error_unit, least->bounded, name(*least));
            if (experiment.reference_error && *experiment.reference_error > 0.0)
                words += fmt::format(" ({} {:.3g})", rule.reference, *experiment.reference_error);
            return words;
        }
        Wish error_alone = wish;
        error_alone.max_seconds.reset();
        const std::vector<Candidate> true_enough = kept_of(all, error_alone, rule.cost);
        const Candidate* cheapest = first_of(true_enough, is_cheaper);
        return fmt::format("no method is within {:g} {} and {}: that error takes {}, with {}",
                           *wish.max_error, experiment.error_unit,
                           seconds_in_words(*wish.max_seconds), seconds_in_words(cheapest->cost),
                           name(*cheapest));
    }
    const Candidate* cheapest = first_of(all, is_cheaper);
    return fmt::format("no method is within {}: the fastest takes {}, with {}",
                       seconds_in_words(*wish.max_seconds), seconds_in_words(cheapest->cost),
                       name(*cheapest));
}

}  // namespace

Recommendation recommended(const Experiment& experiment, const RecommendationRule& rule) {
    const std::vector<Candidate> all = candidates_of(experiment, rule);
    const std::vector<Candidate> kept = kept_of(all, rule.wish, rule.cost);
    Recommendation result;
    const Candidate* taken = taken_of(experiment, kept, rule);
    if (taken == nullptr) {
        result.words = refusal_words(experiment, rule, all);
        return result;
    }
    const Candidate* next = next_more_accurate(all, *taken);
    result.method = taken->index;
    if (next != nullptr) result.next = next->index;
    result.words = words_of(experiment, rule, *taken, next);
    return result;
}

}  // namespace relief
