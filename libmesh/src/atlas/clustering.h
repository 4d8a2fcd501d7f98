// SPDX-License-Identifier: Apache-2.0
/// \file
/// Merges clusters of a graph in rounds: each cluster selects the neighbor with the least cost, and
/// clusters that select each other merge. A round is linear, and few rounds are needed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "progress_stage.h"

namespace relief::detail {

/// The common border of two clusters, a < b.
struct ClusterEdge {
    std::uint32_t a;
    std::uint32_t b;
    std::uint32_t count;  ///< Number of edges of the mesh.
    float cost;           ///< Of merging them; negative if it is unknown.
    double length;
};

/// Joins entries between the same clusters, and orders them. \param cluster_count above all ends
inline void combine_edges(std::vector<ClusterEdge>& edges, std::size_t cluster_count) {
    std::vector<std::uint32_t> begin(cluster_count + 1, 0);
    for (const ClusterEdge& edge : edges)
        ++begin[edge.a + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<ClusterEdge> sorted(edges.size());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (const ClusterEdge& edge : edges)
        sorted[next[edge.a]++] = edge;
    edges.clear();
    for (std::size_t cluster = 0; cluster < cluster_count; ++cluster) {
        const auto first = sorted.begin() + begin[cluster];
        const auto last = sorted.begin() + begin[cluster + 1];
        // Stable, so that lengths are added in a fixed order.
        if (last - first > 32)
            std::stable_sort(first, last, [](const auto& x, const auto& y) { return x.b < y.b; });
        else
            for (auto i = first; i != last; ++i)
                for (auto j = i; j != first && (j - 1)->b > j->b; --j)
                    std::swap(*j, *(j - 1));
        for (auto edge = first; edge != last; ++edge) {
            if (!edges.empty() && edges.back().a == edge->a && edges.back().b == edge->b) {
                edges.back().length += edge->length;
                edges.back().count += edge->count;
                edges.back().cost = -1.0F;
            } else {
                edges.push_back(*edge);
            }
        }
    }
}

/// The limit of costs: merges above it wait for a later round. It rises from `first` by `factor`
/// whenever no more clusters merge, until `last`.
struct CostLimit {
    float first = std::numeric_limits<float>::max();
    float factor = 2.0F;
    float last = std::numeric_limits<float>::max();
};

/// \param clusters  provides `float cost(const ClusterEdge&)`, at least 0 and infinite if the merge
///         is not allowed; `merge(const ClusterEdge&)`, which changes cluster a; and
///         `move(from, to)`, which renumbers a cluster
/// \param edges  as combine_edges() leaves them
/// \return for each cluster at the beginning, the one at the end; numbers are in the order of the
///         smallest member
template <typename Clusters>
std::vector<std::uint32_t> merge_in_rounds(Clusters& clusters, std::size_t count,
                                           std::vector<ClusterEdge>& edges,
                                           const CostLimit& limits) {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> label(count);
    std::iota(label.begin(), label.end(), 0U);
    std::vector<std::uint32_t> best(count), renamed(count);
    std::vector<float> best_cost(count);
    std::vector<std::uint8_t> is_changed(count, 0);
    float limit = limits.first;
    for (;;) {
        check_cancelled();
        std::fill_n(best.begin(), count, none);
        std::fill_n(best_cost.begin(), count, std::numeric_limits<float>::infinity());
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t i = 0; i < edges.size(); ++i) {
            ClusterEdge& edge = edges[i];
            if (edge.cost < 0.0F) edge.cost = clusters.cost(edge);
            least = std::min(least, edge.cost);
            if (edge.cost > limit) continue;
            // Edges are ascending by both ends, so that the smaller neighbor wins a tie.
            for (const std::uint32_t end : {edge.a, edge.b}) {
                if (edge.cost >= best_cost[end]) continue;
                best_cost[end] = edge.cost;
                best[end] = i;
            }
        }
        std::iota(renamed.begin(), renamed.begin() + static_cast<std::ptrdiff_t>(count), 0U);
        std::fill_n(is_changed.begin(), count, std::uint8_t{0});
        bool has_merged = false;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (best[i] == none) continue;
            const ClusterEdge& edge = edges[best[i]];
            if (edge.a != i || best[edge.b] != best[i]) continue;
            clusters.merge(edge);
            renamed[edge.b] = edge.a;
            is_changed[edge.a] = 1;
            has_merged = true;
        }
        if (!has_merged) {
            if (!(least <= limits.last) || limit >= limits.last) return label;
            // Skips the rounds in which nothing would happen.
            do
                limit = std::min(limit * limits.factor, limits.last);
            while (limit < least && limit < limits.last);
            continue;
        }
        std::uint32_t remaining = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (renamed[i] != i) {
                renamed[i] = renamed[renamed[i]];  // The smaller one has its new number.
                continue;
            }
            clusters.move(i, remaining);
            is_changed[remaining] = is_changed[i];
            renamed[i] = remaining++;
        }
        std::size_t kept = 0;
        for (ClusterEdge edge : edges) {
            edge.a = renamed[edge.a];
            edge.b = renamed[edge.b];
            if (edge.a == edge.b) continue;
            if (edge.a > edge.b) std::swap(edge.a, edge.b);
            if (is_changed[edge.a] != 0 || is_changed[edge.b] != 0) edge.cost = -1.0F;
            edges[kept++] = edge;
        }
        edges.resize(kept);
        combine_edges(edges, remaining);
        for (std::uint32_t& each : label)
            each = renamed[each];
        count = remaining;
    }
}

}  // namespace relief::detail
