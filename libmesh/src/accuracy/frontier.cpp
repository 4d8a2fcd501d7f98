// SPDX-License-Identifier: Apache-2.0
// Sorted by time, a method is efficient where its error is below that of all faster ones.
// Tests: tests/mesh/accuracy/error_statistics_test.cpp.
#include "relief/mesh/frontier.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace relief {

std::vector<bool> pareto_optimal(std::span<const MethodCost> prices) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < prices.size(); ++i) {
        if (!std::isnan(prices[i].error) && !std::isnan(prices[i].time)) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return prices[a].time != prices[b].time ? prices[a].time < prices[b].time
                                                : prices[a].error < prices[b].error;
    });
    std::vector<bool> result(prices.size(), false);
    MethodCost last{std::numeric_limits<double>::infinity(),
                    0.0};  // The slowest efficient one so far.
    bool is_first = true;
    for (const std::size_t i : order) {
        const MethodCost& price = prices[i];
        const bool is_equal = !is_first && price.error == last.error && price.time == last.time;
        if (!is_first && !is_equal && price.error >= last.error) continue;
        result[i] = true;
        last = price;
        is_first = false;
    }
    return result;
}

}  // namespace relief
