// SPDX-License-Identifier: Apache-2.0
// The thresholds of image.h: Bayer's recursive matrix, and blue noise by the void-and-cluster
// method. All ranks are computed from integers, and ties go to the first in reading order, so the
// tiles are the same on every machine.
#include "image/dither_tile.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace relief {
using namespace relief::detail;

namespace {

DitherTile tile_of_ranks(std::size_t side, const std::vector<std::uint32_t>& ranks) {
    DitherTile tile{side, std::vector<float>(ranks.size())};
    const auto all =
        static_cast<float>(ranks.size());  // The count is a power of two, so the result is exact.
    for (std::size_t i = 0; i < ranks.size(); ++i)
        tile.thresholds[i] = (static_cast<float>(ranks[i]) + 0.5F) / all;
    return tile;
}

/// Returns the tile of [Bayer 1973]: the bits of a rank alternate between x ^ y and y, and the
/// lowest bit of the position is the highest of the rank.
DitherTile bayer_tile() {
    constexpr std::uint32_t bits = 4;
    constexpr std::uint32_t side = 1U << bits;
    std::vector<std::uint32_t> ranks;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            std::uint32_t rank = 0;
            for (std::uint32_t bit = 0; bit < bits; ++bit)
                rank = rank * 4 + 2 * ((x ^ y) >> bit & 1U) + (y >> bit & 1U);
            ranks.push_back(rank);
        }
    }
    return tile_of_ranks(side, ranks);
}

/// The pattern of [Ulichney 1993] on a torus, with the crowding of every position: the sum of
/// weights of the points around it. Points can be added and removed.
class Crowd {
  public:
    static constexpr int side = 64;
    static constexpr std::size_t places = std::size_t{side} * side;

    Crowd() : crowding_(places, 0), taken_(places, 0) {
        // exp(-d^2 / (2 * 1.5^2)) for d^2 = 0, 1, ..., in units of 2^-26; then 0.
        constexpr std::uint64_t ratio = 3439140958;  // exp(-1 / 4.5) in units of 2^-32.
        std::uint64_t weight = 1U << 26U;
        for (std::uint32_t& entry : weights_) {
            entry = static_cast<std::uint32_t>(weight);
            weight = weight * ratio >> 32U;
        }
    }

    void put(std::size_t place) { change(place, true); }
    void take(std::size_t place) { change(place, false); }

    /// Returns the free position with the least crowding.
    [[nodiscard]] std::size_t void_place() const {
        constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
        return best([&](std::size_t i) { return taken_[i] ? most : crowding_[i]; });
    }
    /// Returns the occupied position with the most crowding.
    [[nodiscard]] std::size_t cluster_place() const {
        constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
        return best([&](std::size_t i) { return taken_[i] ? most - crowding_[i] : most; });
    }

  private:
    static constexpr int reach =
        9;  // Weights at larger distances are less than 1e-7 of the largest.

    template <typename Key>
    static std::size_t best(const Key& key) {
        std::uint32_t least = key(0);
        for (std::size_t i = 1; i < places; ++i)
            least = std::min(least, key(i));
        std::size_t first = 0;
        while (key(first) != least)
            ++first;
        return first;
    }

    void change(std::size_t place, bool is_put) {
        taken_[place] = is_put ? 1 : 0;
        const int x = static_cast<int>(place) % side;
        const int y = static_cast<int>(place) / side;
        for (int j = -reach; j <= reach; ++j) {
            for (int i = -reach; i <= reach; ++i) {
                const std::uint32_t weight = weights_[static_cast<std::size_t>(i * i + j * j)];
                const int row = (y + j + side) % side;
                const int column = (x + i + side) % side;
                std::uint32_t& crowding = crowding_[static_cast<std::size_t>(row * side + column)];
                crowding = is_put ? crowding + weight : crowding - weight;
            }
        }
    }

    std::array<std::uint32_t, 2 * reach * reach + 1> weights_{};
    std::vector<std::uint32_t> crowding_;
    std::vector<std::uint8_t> taken_;
};

/// Returns evenly distributed points on a tenth of all positions: the most crowded one moves to the
/// largest void until it returns to its own position.
Crowd even_points(std::uint32_t count) {
    Crowd crowd;
    std::vector<std::uint8_t> used(Crowd::places, 0);
    std::uint32_t state = 1;
    for (std::uint32_t put = 0; put < count;) {
        state = state * 1664525U + 1013904223U;
        const std::size_t place = state >> 20U;  // The upper 12 bits: one of 4096.
        if (used[place]) continue;
        used[place] = 1;
        crowd.put(place);
        ++put;
    }
    for (;;) {
        const std::size_t from = crowd.cluster_place();
        crowd.take(from);
        const std::size_t to = crowd.void_place();
        crowd.put(to);
        if (to == from) return crowd;
    }
}

/// The third phase of [Ulichney 1993] removes clusters of free positions. It selects the same
/// positions as the second phase, because the crowding by points and by free positions has a
/// constant sum.
DitherTile blue_noise_tile() {
    constexpr std::uint32_t first_points = Crowd::places / 10;
    const Crowd start = even_points(first_points);
    std::vector<std::uint32_t> ranks(Crowd::places);
    Crowd crowd = start;
    for (std::uint32_t rank = first_points; rank-- > 0;) {
        const std::size_t place = crowd.cluster_place();
        crowd.take(place);
        ranks[place] = rank;
    }
    crowd = start;
    for (std::uint32_t rank = first_points; rank < Crowd::places; ++rank) {
        const std::size_t place = crowd.void_place();
        crowd.put(place);
        ranks[place] = rank;
    }
    return tile_of_ranks(Crowd::side, ranks);
}

/// Offsets of the tiles of the three channels. For blue noise, the thresholds of the channels then
/// have almost no correlation; for a Bayer matrix they always have some.
constexpr std::array<std::size_t, 3> shifts_x = {0, 21, 43};
constexpr std::array<std::size_t, 3> shifts_y = {0, 38, 11};

}  // namespace

const DitherTile& detail::dither_tile(Dither dither) {
    if (dither == Dither::ordered) {
        static const DitherTile bayer = bayer_tile();
        return bayer;
    }
    static const DitherTile blue_noise = blue_noise_tile();
    return blue_noise;
}

DitherRow::DitherRow(Dither dither, int y) : mask_(0), rows_{}, shifts_(shifts_x) {
    const DitherTile& tile = dither_tile(dither);
    mask_ = tile.side - 1;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const std::size_t row = (static_cast<std::size_t>(y) + shifts_y[channel]) & mask_;
        rows_[channel] = tile.thresholds.data() + row * tile.side;
    }
}

float dither_threshold(Dither dither, int x, int y, int channel) {
    return DitherRow(dither, y).at(static_cast<std::size_t>(x), static_cast<std::size_t>(channel));
}

}  // namespace relief
