// SPDX-License-Identifier: Apache-2.0
// First how far the next baked texel of each column is, then the nearest of those along a row.
// Only baked texels are read and only others are written, so rows are filled where they are.
// Tests: tests/mesh/bake/dilation_test.cpp.
#include "bake/dilation.h"

#include <algorithm>

#include "bake/baked_layers.h"
#include "bake/nearest_columns.h"
#include "bake/texel_mean.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr int row_step = 64;
constexpr std::size_t columns_at_once = 256;

template <typename T>
void append(std::vector<T>& all, std::span<const T> more) {
    all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Dilation::Dilation(int width, int height, int texels, std::function<void(const BakedRows&)> take)
    : width_(width), height_(height), texels_(texels), take_(std::move(take)) {
    window_.layers.resize(baked_layers.size());
}

void Dilation::push(const BakedRows& rows) {
    if (texels_ == 0) return take_(rows);
    for (std::size_t i = 0; i < baked_layers.size(); ++i)
        append<float>(window_.layers[i], rows.*baked_layers[i].values);
    append<TexelState>(window_.states, rows.states);
    end_row_ += rows.row_count;
    const int complete = (end_row_ - texels_) / row_step * row_step;
    const int last = end_row_ == height_ ? height_ : complete;
    if (last > next_row_) hand_on(last);
}

void Dilation::hand_on(int last_row) {
    measure_columns(last_row);
    const BakedRows rows = rows_of(first_row_, end_row_);
    parallel_for(static_cast<std::size_t>(last_row - next_row_), 4,
                 [&](std::size_t begin, std::size_t end) {
                     NearestColumns nearest;
                     for (std::size_t i = begin; i < end; ++i)
                         fill_row(next_row_ + static_cast<int>(i), rows, nearest);
                 });
    // What is needed further on is copied first, as rows handed on may be changed.
    const int kept = std::max(last_row - texels_, first_row_);
    Window rest = last_row < height_ ? copy_from(kept) : Window{};
    take_(rows_of(next_row_, last_row));
    window_ = std::move(rest);
    next_row_ = last_row;
    first_row_ = kept;
}

/// By columns side by side: what goes on from row to row fits a cache.
void Dilation::measure_columns(int last_row) {
    const auto beyond = static_cast<std::uint16_t>(texels_ + 1);
    const auto width = static_cast<std::size_t>(width_);
    const int begin_row = std::max(next_row_ - texels_, first_row_);
    const int end_row = std::min(last_row + texels_, end_row_);
    upwards_.resize(texels_in(last_row - next_row_));
    downwards_.resize(upwards_.size());
    parallel_for(width, columns_at_once, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint16_t> distance;
        const auto pass = [&](int row, std::vector<std::uint16_t>& found) {
            const TexelState* states = &window_.states[texels_in(row - first_row_)];
            for (std::size_t x = begin; x < end; ++x) {
                const auto further = static_cast<std::uint16_t>(distance[x - begin] + 1);
                distance[x - begin] =
                    states[x] == TexelState::baked ? std::uint16_t{0} : std::min(further, beyond);
            }
            if (row < next_row_ || row >= last_row) return;
            const auto to = found.begin() + static_cast<std::ptrdiff_t>(texels_in(row - next_row_));
            std::copy(distance.begin(), distance.end(), to + static_cast<std::ptrdiff_t>(begin));
        };
        distance.assign(end - begin, beyond);
        for (int row = begin_row; row < last_row; ++row)
            pass(row, upwards_);
        distance.assign(end - begin, beyond);
        for (int row = end_row; row-- > next_row_;)
            pass(row, downwards_);
    });
}

void Dilation::fill_row(int row, const BakedRows& rows, NearestColumns& nearest) {
    const std::size_t out = texels_in(row - next_row_);
    const std::size_t here = texels_in(row - first_row_);
    const auto up = [&](int column) { return upwards_[out + static_cast<std::size_t>(column)]; };
    const auto down = [&](int column) {
        return downwards_[out + static_cast<std::size_t>(column)];
    };
    const auto is_baked = [&](int column) {
        return column < 0 || column == width_ || up(column) == 0;
    };
    nearest.clear();
    for (int column = 0; column < width_; ++column) {
        const int distance = std::min(up(column), down(column));
        // Between two that are baked, a texel is nearest to none that is not.
        if (distance == 0 && is_baked(column - 1) && is_baked(column + 1)) continue;
        if (distance <= texels_) nearest.add(column, distance);
    }
    if (nearest.is_empty()) return;
    std::vector<std::size_t> from;
    for (int column = 0; column < width_; ++column) {
        if (up(column) == 0) continue;
        if (nearest.squared_distance(column) > std::int64_t{texels_} * texels_) continue;
        from.clear();
        nearest.for_nearest(column, [&](int other) {
            const std::size_t texel = here + static_cast<std::size_t>(other);
            const int above = up(other), below = down(other);
            if (above <= below) from.push_back(texel - texels_in(above));
            if (below <= above && below != 0) from.push_back(texel + texels_in(below));
        });
        const std::size_t to = here + static_cast<std::size_t>(column);
        for (const BakedLayer& layer : baked_layers) {
            const std::span<float> values = rows.*layer.values;
            if (!values.empty()) average(layer, values, from, &values[layer.channels * to]);
        }
        rows.states[to] = TexelState::padded;
    }
}

BakedRows Dilation::rows_of(int first_row, int last_row) {
    BakedRows rows;
    rows.first_row = first_row;
    rows.row_count = last_row - first_row;
    const std::size_t first = texels_in(first_row - first_row_);
    const std::size_t texels = texels_in(rows.row_count);
    for (std::size_t i = 0; i < baked_layers.size(); ++i) {
        const std::size_t channels = baked_layers[i].channels;
        if (window_.layers[i].empty()) continue;
        rows.*baked_layers[i].values =
            std::span(window_.layers[i]).subspan(channels * first, channels * texels);
    }
    rows.states = std::span(window_.states).subspan(first, texels);
    return rows;
}

Dilation::Window Dilation::copy_from(int first_row) const {
    const auto first = static_cast<std::ptrdiff_t>(texels_in(first_row - first_row_));
    Window rest;
    for (std::size_t i = 0; i < baked_layers.size(); ++i) {
        const std::vector<float>& values = window_.layers[i];
        const auto skipped = static_cast<std::ptrdiff_t>(baked_layers[i].channels) * first;
        rest.layers.emplace_back(values.empty() ? values.end() : values.begin() + skipped,
                                 values.end());
    }
    rest.states.assign(window_.states.begin() + first, window_.states.end());
    return rest;
}

}  // namespace relief
