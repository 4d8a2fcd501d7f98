// SPDX-License-Identifier: Apache-2.0
// Rank sums, resampling, and the control of false discoveries. Tests:
// tests/accuracy/two_samples_test.cpp.
#include "relief/accuracy/two_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "relief/mesh/timing.h"

namespace relief {
namespace {

/// Up to here all ways to choose are counted.
constexpr std::size_t most_counted_exactly = 60;

/// Twice the rank of each value, a's first; equal ones share the mean of their ranks, which twice
/// is whole.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> all = a;
    all.insert(all.end(), b.begin(), b.end());
    std::vector<double> sorted = all;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::size_t> ranks;
    for (const double value : all) {
        const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
        // Ranks first + 1 to last: twice their mean is first + 1 + last.
        ranks.push_back(static_cast<std::size_t>(first - sorted.begin()) + 1 +
                        static_cast<std::size_t>(last - sorted.begin()));
    }
    return ranks;
}

/// ways[k][s]: how many ways there are to choose k of the ranks so that their sum is s.
std::vector<std::vector<double>> counted_ways(const std::vector<std::size_t>& ranks,
                                              std::size_t chosen) {
    const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
    std::vector<std::vector<double>> ways(chosen + 1, std::vector<double>(total + 1, 0.0));
    ways[0][0] = 1.0;
    for (const std::size_t rank : ranks) {
        for (std::size_t k = chosen; k > 0; --k) {
            for (std::size_t sum = total; sum >= rank; --sum)
                ways[k][sum] += ways[k - 1][sum - rank];
        }
    }
    return ways;
}

/// The share of all ways to choose whose sum is at least as far from the middle as `sum`.
double exact_p(const std::vector<std::size_t>& ranks, std::size_t chosen, std::size_t sum) {
    const std::vector<double> ways = counted_ways(ranks, chosen)[chosen];
    const std::size_t total = ways.size() - 1;
    // The middle is chosen * total / count: compared in whole numbers, multiplied out.
    const auto distance = [&](std::size_t one) {
        const auto here = static_cast<long long>(one * ranks.size());
        return std::llabs(here - static_cast<long long>(chosen * total));
    };
    double all = 0.0;
    double as_far = 0.0;
    for (std::size_t one = 0; one < ways.size(); ++one) {
        all += ways[one];
        if (distance(one) >= distance(sum)) as_far += ways[one];
    }
    return as_far / all;
}

/// By the normal distribution that rank sums of large samples have.
double approximate_p(const std::vector<std::size_t>& ranks, std::size_t chosen, std::size_t sum) {
    const auto count = static_cast<double>(ranks.size());
    const auto a = static_cast<double>(chosen);
    const double mean = a * (count + 1.0) / 2.0;
    double squares = 0.0;
    for (const std::size_t rank : ranks)
        squares += std::pow(static_cast<double>(rank) / 2.0 - (count + 1.0) / 2.0, 2);
    // The variance of a sum drawn without replacement; ties make the ranks' own smaller.
    const double variance = a * (count - a) / (count * (count - 1.0)) * squares;
    const double off = std::max(std::abs(static_cast<double>(sum) / 2.0 - mean) - 0.5, 0.0);
    return variance > 0.0 ? std::erfc(off / std::sqrt(2.0 * variance)) : 1.0;
}

std::vector<double> resampled(const std::vector<double>& values, std::mt19937_64& random) {
    std::vector<double> drawn;
    drawn.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        drawn.push_back(values[random() % values.size()]);
    return drawn;
}

}  // namespace

double mann_whitney_p(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.empty() || b.empty()) return 1.0;
    const std::vector<std::size_t> ranks = doubled_ranks(a, b);
    const std::size_t sum = std::accumulate(
        ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(a.size()), std::size_t{0});
    return ranks.size() <= most_counted_exactly ? exact_p(ranks, a.size(), sum)
                                                : approximate_p(ranks, a.size(), sum);
}

double least_mann_whitney_p(std::size_t a, std::size_t b) {
    if (a == 0 || b == 0) return 1.0;
    // Two of all ways to choose a of a + b; for samples that large, no matter.
    double ways = 1.0;
    for (std::size_t i = 1; i <= a; ++i)
        ways *= static_cast<double>(b + i) / static_cast<double>(i);
    return std::min(1.0, 2.0 / ways);
}

Interval median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
    constexpr std::size_t resamples = 1000;
    std::mt19937_64 random(20261122);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < resamples; ++i) {
        const double below = spread_of(resampled(a, random)).median;
        ratios.push_back(spread_of(resampled(b, random)).median / below);
    }
    std::sort(ratios.begin(), ratios.end());
    return {.value = spread_of(b).median / spread_of(a).median,
            .low = ratios[resamples / 40],
            .high = ratios[resamples - 1 - resamples / 40]};
}

std::vector<bool> discoveries(const std::vector<double>& p, double rate) {
    std::vector<double> sorted = p;
    std::sort(sorted.begin(), sorted.end());
    double limit = -1.0;  // The largest p that still counts.
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const double share = static_cast<double>(i + 1) / static_cast<double>(sorted.size());
        if (sorted[i] <= rate * share) limit = sorted[i];
    }
    std::vector<bool> found;
    for (const double one : p)
        found.push_back(one <= limit);
    return found;
}

}  // namespace relief
