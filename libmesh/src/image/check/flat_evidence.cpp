// SPDX-License-Identifier: Apache-2.0
// Counts pairs of codes. Tests: tests/mesh/image/check/flat_evidence_test.cpp.
#include "image/check/flat_evidence.h"

#include <cstdint>
#include <limits>
#include <span>

namespace relief {
namespace {

template <typename Code>
FlatEvidence counted(const Image& map) {
    constexpr int lower = std::numeric_limits<Code>::max() / 2;
    const std::span<const Code> samples = map.as<Code>();
    const auto channels = static_cast<std::size_t>(map.channels);
    const auto is_near = [](int code) { return code >= lower - 1 && code <= lower + 2; };
    FlatEvidence evidence;
    for (std::size_t first = 0; first + 2 < samples.size(); first += channels) {
        const int x = samples[first];
        const int y = samples[first + 1];
        if (!is_near(x) || !is_near(y)) continue;
        ++evidence.near;
        if (x == lower && y == lower) ++evidence.lower;
    }
    return evidence;
}

}  // namespace

FlatEvidence flat_evidence(const Image& map) {
    switch (map.bits()) {
        case 8:
            return counted<std::uint8_t>(map);
        case 16:
            return counted<std::uint16_t>(map);
        default:
            return {};
    }
}

}  // namespace relief
