// SPDX-License-Identifier: Apache-2.0
// First how far the next baked texel of each column is, then the nearest of those along a row.
// Tests: tests/mesh/bake/dilation_test.cpp.
#include "bake/dilation.h"

#include <algorithm>

#include "geometry/direction.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr int row_step = 64;

template <typename T>
void append(std::vector<T>& all, std::span<const T> more) {
    all.insert(all.end(), more.begin(), more.end());
}

template <typename T>
void drop(std::vector<T>& all, std::size_t count) {
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

Dilation::Dilation(int width, int height, int texels, std::function<void(const BakedRows&)> take)
    : width_(width), height_(height), texels_(texels), take_(std::move(take)) {}

void Dilation::push(const BakedRows& rows) {
    if (texels_ == 0) return take_(rows);
    append<float>(normals_, rows.normals);
    append<float>(heights_, rows.heights);
    append<TexelState>(states_, rows.states);
    end_row_ += rows.row_count;
    const int complete = (end_row_ - texels_) / row_step * row_step;
    const int last = end_row_ == height_ ? height_ : complete;
    if (last > next_row_) hand_on(last);
}

void Dilation::hand_on(int last_row) {
    measure_columns();
    const auto count = static_cast<std::size_t>(last_row - next_row_);
    const std::size_t first = at(next_row_, 0);
    const std::size_t texels = count * static_cast<std::size_t>(width_);
    const auto part = [&](auto& all, std::size_t channels) {
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first * channels);
        return std::vector(begin, begin + static_cast<std::ptrdiff_t>(texels * channels));
    };
    std::vector<float> normals = part(normals_, 3), heights = part(heights_, 1);
    std::vector<TexelState> states = part(states_, 1);
    const BakedRows filled{next_row_, static_cast<int>(count), normals, heights, states};
    parallel_for(count, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            fill_row(next_row_ + static_cast<int>(i), filled);
    });
    take_(filled);
    next_row_ = last_row;
    forget(std::max(next_row_ - texels_, first_row_));
}

void Dilation::measure_columns() {
    const auto beyond = static_cast<std::uint16_t>(texels_ + 1);
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t count = states_.size();
    upwards_.resize(count);
    downwards_.resize(count);
    const auto next = [&](std::size_t i, std::uint16_t before) {
        if (states_[i] == TexelState::baked) return std::uint16_t{0};
        return std::min<std::uint16_t>(static_cast<std::uint16_t>(before + 1), beyond);
    };
    for (std::size_t i = 0; i < count; ++i)
        upwards_[i] = next(i, i < width ? beyond : upwards_[i - width]);
    for (std::size_t i = count; i-- > 0;)
        downwards_[i] = next(i, i + width >= count ? beyond : downwards_[i + width]);
}

void Dilation::fill_row(int row, const BakedRows& filled) const {
    const std::size_t out_row =
        static_cast<std::size_t>(row - filled.first_row) * static_cast<std::size_t>(width_);
    for (int column = 0; column < width_; ++column) {
        if (states_[at(row, column)] == TexelState::baked) continue;
        const int begin = std::max(column - texels_, 0);
        const int end = std::min(column + texels_ + 1, width_);
        const auto squared = [&](int other, const std::vector<std::uint16_t>& vertical) {
            const int across = other - column;
            const int along = vertical[at(row, other)];
            return across * across + along * along;
        };
        const int limit = texels_ * texels_;
        int nearest = limit + 1;
        for (int other = begin; other < end; ++other)
            nearest = std::min({nearest, squared(other, upwards_), squared(other, downwards_)});
        if (nearest > limit) continue;
        glm::dvec3 sum(0.0), first(0.0);
        double height = 0.0;
        int count = 0;
        const auto add = [&](int other_row, int other) {
            const std::size_t texel = at(other_row, other);
            const glm::dvec3 normal(normals_[3 * texel], normals_[3 * texel + 1],
                                    normals_[3 * texel + 2]);
            if (count++ == 0) first = normal;
            sum += normal;
            height += heights_[texel];
        };
        for (int other = begin; other < end; ++other) {
            const int up = upwards_[at(row, other)];
            const int down = downwards_[at(row, other)];
            if (squared(other, upwards_) == nearest) add(row - up, other);
            if (down != 0 && squared(other, downwards_) == nearest) add(row + down, other);
        }
        glm::dvec3 mean = direction_or_zero(sum);
        if (glm::length(sum) < 1e-6 * count) mean = first;
        const std::size_t out = out_row + static_cast<std::size_t>(column);
        for (std::size_t axis = 0; axis < 3; ++axis)
            filled.normals[3 * out + axis] = rounded(mean)[static_cast<int>(axis)];
        filled.heights[out] = static_cast<float>(height / count);
        filled.states[out] = TexelState::padded;
    }
}

void Dilation::forget(int first_row) {
    const std::size_t count = at(first_row, 0);
    drop(normals_, 3 * count);
    drop(heights_, count);
    drop(states_, count);
    first_row_ = first_row;
}

}  // namespace relief
