// SPDX-License-Identifier: Apache-2.0
// Sums over pieces of a fixed size, added up in order: the same for any number of threads. Lengths
// have no unit; texels that are not finite count as such and in nothing else.
// Tests: tests/mesh/image/check/normal_map_check_test.cpp.
#include "image/check/map_statistics.h"

#include <algorithm>
#include <cmath>

#include "parallel.h"

namespace relief {
namespace {

constexpr std::size_t statistics_texels_per_piece = 1 << 15;
constexpr float longest_without_direction = 1.0F / 16.0F;
constexpr float facing_back = -0.02F;  // Beyond what rounding to 8 bits makes of 0.

constexpr std::size_t listed_at_most = 8;

void note(FoundMapCondition& found, std::size_t texel) {
    if (found.count++ < listed_at_most) found.first.push_back(texel);
}

/// Those of a later part of the map.
void append(FoundMapCondition& found, const FoundMapCondition& later) {
    found.count += later.count;
    for (const std::size_t texel : later.first) {
        if (found.first.size() < listed_at_most) found.first.push_back(texel);
    }
}

/// Sums, before they are divided.
struct Sums {
    MapStatistics counts;
    double length = 0.0;
    double squared_deviation = 0.0;
    std::array<std::size_t, VectorLengths::bounds.size()> within{};

    void add(const glm::vec3& v, float length_of_v) {
        ++counts.vectors;
        counts.upwards += v.z > 0.0F ? 1 : 0;
        counts.in_disk += v.x * v.x + v.y * v.y <= 1.1F ? 1 : 0;
        counts.mean += glm::dvec3(v);
        const double deviation = static_cast<double>(length_of_v) - 1.0;
        length += static_cast<double>(length_of_v);
        squared_deviation += deviation * deviation;
        const double distance = std::abs(deviation);
        for (std::size_t i = 0; i < within.size(); ++i)
            within[i] += distance <= VectorLengths::bounds[i] ? 1 : 0;
    }

    void add(const Sums& other) {
        counts.texels += other.counts.texels;
        counts.equal += other.counts.equal;
        counts.background += other.counts.background;
        counts.vectors += other.counts.vectors;
        counts.upwards += other.counts.upwards;
        counts.in_disk += other.counts.in_disk;
        counts.mean += other.counts.mean;
        append(counts.not_finite, other.counts.not_finite);
        append(counts.without_direction, other.counts.without_direction);
        append(counts.facing_back, other.counts.facing_back);
        for (std::size_t i = 0; i < counts.constant.size(); ++i)
            counts.constant[i] = counts.constant[i] && other.counts.constant[i];
        length += other.length;
        squared_deviation += other.squared_deviation;
        for (std::size_t i = 0; i < within.size(); ++i)
            within[i] += other.within[i];
    }

    [[nodiscard]] MapStatistics result() const {
        MapStatistics statistics = counts;
        if (counts.vectors == 0) return statistics;
        const auto count = static_cast<double>(counts.vectors);
        statistics.mean /= count;
        statistics.lengths.mean = length / count;
        statistics.lengths.rms_deviation = std::sqrt(squared_deviation / count);
        for (std::size_t i = 0; i < within.size(); ++i)
            statistics.lengths.within[i] = static_cast<double>(within[i]) / count;
        return statistics;
    }
};

template <typename Sample>
Sums sums_of(const MapVectors<Sample>& vectors, std::size_t begin, std::size_t end,
             std::size_t step) {
    Sums sums;
    sums.counts.constant.fill(true);
    const std::size_t channels = vectors.channels();
    for (std::size_t texel = begin; texel < end; texel += step) {
        ++sums.counts.texels;
        for (std::size_t channel = 0; channel < channels; ++channel) {
            if (!sums.counts.constant[channel]) continue;
            sums.counts.constant[channel] =
                vectors.component(texel, channel) == vectors.component(0, channel);
        }
        const glm::vec3 v = vectors[texel];
        const float length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        if (!std::isfinite(v.x + v.y + v.z)) {
            note(sums.counts.not_finite, texel);
            continue;
        }
        const bool has_direction = length > longest_without_direction;
        if (!has_direction) note(sums.counts.without_direction, texel);
        if (v.x == v.y && v.y == v.z) {
            ++sums.counts.equal;
            sums.counts.background += has_direction && std::abs(length - 1.0F) > 0.25F ? 1 : 0;
            continue;
        }
        if (v.z < facing_back) note(sums.counts.facing_back, texel);
        sums.add(v, length);
    }
    return sums;
}

}  // namespace

MapStatistics map_statistics(const Image& map, const SampleMeaning& meaning, std::size_t step) {
    return with_sample_type(map, [&](auto sample) {
        const MapVectors<decltype(sample)> vectors(map, meaning);
        const std::size_t count =
            static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
        const std::size_t per_piece = statistics_texels_per_piece * step;
        std::vector<Sums> pieces((count + per_piece - 1) / per_piece);
        parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t piece = begin; piece < end; ++piece)
                pieces[piece] = sums_of(vectors, piece * per_piece,
                                        std::min(count, (piece + 1) * per_piece), step);
        });
        Sums all = pieces.front();
        for (std::size_t piece = 1; piece < pieces.size(); ++piece)
            all.add(pieces[piece]);
        return all.result();
    });
}

}  // namespace relief
