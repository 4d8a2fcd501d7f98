// SPDX-License-Identifier: Apache-2.0
// Tries filters on a few rows: all of them by how often each byte comes out, and the promising ones
// by the repetitions that deflate would find as well. Any rows are good input. Tests:
// tests/mesh/io/png/png_filter_choice_test.cpp.
#include "io/png/png_filter_choice.h"

#include <array>
#include <vector>

#include "io/png/png_filter.h"

namespace relief {
namespace {

std::vector<std::uint8_t> filtered_by(std::uint8_t filter, std::span<const std::uint8_t> rows,
                                      std::size_t size, std::size_t step) {
    std::vector<std::uint8_t> filtered(rows.size() - size);
    for (std::size_t at = 0; at < filtered.size(); at += size) {
        apply_filter(filter, step, rows.subspan(at + size, size), rows.subspan(at, size),
                     std::span(filtered).subspan(at, size));
    }
    return filtered;
}

/// What repetitions must save to be worth the time. Bytes that take many bits repeat in short
/// pieces only, which are many, and take long to find.
std::uint64_t surcharge_in_percent(std::uint64_t bits, std::size_t bytes, WriteEffort effort) {
    const std::uint64_t bits_per_byte_in_percent = 100 * bits / bytes;
    switch (effort) {
        case WriteEffort::fast:
            return bits_per_byte_in_percent / 8;
        case WriteEffort::normal:
            return bits_per_byte_in_percent / 20;
        case WriteEffort::small:
            break;
    }
    return 1;
}

}  // namespace

FilterChoice choose_filter(std::span<const std::uint8_t> rows, std::size_t size, std::size_t step,
                           WriteEffort effort) {
    std::array<std::vector<std::uint8_t>, filter_count> tried;
    FilterChoice best;
    std::uint64_t least = 0;
    const auto consider = [&](std::uint8_t filter, Repetitions repetitions) {
        std::uint64_t bits = estimated_bits(tried[filter], repetitions);
        if (repetitions == Repetitions::sought)
            bits += bits * surcharge_in_percent(bits, tried[filter].size(), effort) / 100;
        if (least > 0 && bits >= least) return;
        least = bits;
        best = {filter, repetitions};
    };
    for (std::uint8_t filter = 0; filter < filter_count; ++filter) {
        tried[filter] = filtered_by(filter, rows, size, step);
        consider(filter, Repetitions::ignored);
    }
    const std::uint8_t plain_best = best.filter;
    consider(plain_best, Repetitions::sought);
    if (plain_best != 0) consider(0, Repetitions::sought);
    if (plain_best != 2) consider(2, Repetitions::sought);
    return best;
}

}  // namespace relief
