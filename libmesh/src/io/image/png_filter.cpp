// SPDX-License-Identifier: Apache-2.0
// PNG's filters, see png_filter.h. Each filter is compiled for each step that occurs: the samples
// of a texel then stand in registers and go forward side by side, which matters, since every texel
// waits for the one on its left. Arithmetic is modulo 256. Any bytes are good input.
// Source: [ISO/IEC 15948], clause 9. Tests: tests/mesh/io/image/png_test.cpp.
#include "io/image/png_filter.h"

#include <array>

namespace relief {
namespace {

int magnitude(int value) {
    return value < 0 ? -value : value;
}

/// Whichever of left, above and upper left is nearest to left + above - upper left.
int paeth_prediction(int left, int above, int upper_left) {
    const int from_left = magnitude(above - upper_left);
    const int from_above = magnitude(left - upper_left);
    const int from_corner = magnitude(left + above - 2 * upper_left);
    const int other = from_above <= from_corner ? above : upper_left;
    const int other_distance = from_above <= from_corner ? from_above : from_corner;
    return from_left <= other_distance ? left : other;
}

/// Walks a row texel by texel; `predict(left, above, upper left)` for every byte.
template <std::size_t Step, typename Predict>
void add_prediction(std::uint8_t* row, const std::uint8_t* above, std::size_t size,
                    Predict predict) {
    std::array<int, Step> left{};
    std::array<int, Step> corner{};
    for (std::size_t at = 0; at < size; at += Step) {
        for (std::size_t k = 0; k < Step; ++k) {
            const int up = above[at + k];
            left[k] = (row[at + k] + predict(left[k], up, corner[k])) & 0xFF;
            corner[k] = up;
            row[at + k] = static_cast<std::uint8_t>(left[k]);
        }
    }
}

template <std::size_t Step>
bool undo(std::uint8_t filter, std::uint8_t* row, const std::uint8_t* above, std::size_t size) {
    switch (filter) {
        case 0:
            return true;
        case 1:
            add_prediction<Step>(row, above, size, [](int left, int, int) { return left; });
            return true;
        case 2:
            for (std::size_t i = 0; i < size; ++i)
                row[i] = static_cast<std::uint8_t>(row[i] + above[i]);
            return true;
        case 3:
            add_prediction<Step>(row, above, size,
                                 [](int left, int up, int) { return (left + up) >> 1; });
            return true;
        case paeth_filter:
            add_prediction<Step>(row, above, size, paeth_prediction);
            return true;
        default:
            return false;
    }
}

}  // namespace

bool undo_filter(std::uint8_t filter, std::size_t step, std::span<std::uint8_t> row,
                 std::span<const std::uint8_t> above) {
    switch (step) {
        case 1:
            return undo<1>(filter, row.data(), above.data(), row.size());
        case 2:
            return undo<2>(filter, row.data(), above.data(), row.size());
        case 3:
            return undo<3>(filter, row.data(), above.data(), row.size());
        case 4:
            return undo<4>(filter, row.data(), above.data(), row.size());
        case 6:
            return undo<6>(filter, row.data(), above.data(), row.size());
        default:
            return undo<8>(filter, row.data(), above.data(), row.size());
    }
}

void apply_paeth(std::size_t step, std::span<const std::uint8_t> row,
                 std::span<const std::uint8_t> above, std::span<std::uint8_t> filtered) {
    for (std::size_t i = 0; i < step; ++i)
        filtered[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    const std::uint8_t* const left = row.data();
    const std::uint8_t* const here = row.data() + step;
    const std::uint8_t* const corner = above.data();
    const std::uint8_t* const up = above.data() + step;
    std::uint8_t* const to = filtered.data() + step;
    const std::size_t size = row.size() - step;
    for (std::size_t i = 0; i < size; ++i)
        to[i] = static_cast<std::uint8_t>(here[i] - paeth_prediction(left[i], up[i], corner[i]));
}

}  // namespace relief
