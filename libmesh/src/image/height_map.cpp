// SPDX-License-Identifier: Apache-2.0
// Heights from image channels, in parallel, and the filling of holes. An empty image, or one
// without the channel, throws. Source of luminance: [IEC 61966-2-1].
//
// Holes are heights that are not finite, or transparent. The value of a hole is the mean over the
// smallest square around it that contains a finite height. All squares inside that one contain
// none, so the mean runs over its rim. A chessboard distance map gives the rim
// [Rosenfeld and Pfaltz 1968]. Sums run in double precision in a fixed order around the rim.
#include "relief/mesh/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "image/height_holes.h"
#include "image/texel_loops.h"
#include "large_memory.h"
#include "parallel.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

bool is_gray(const Image& image) {
    return image.channels < 3;
}

/// Computes every height by height(first sample of the texel).
template <typename Sample, typename Height>
std::vector<float> make_heights(const Image& image, const Height& height) {
    const std::span<const Sample> samples = image.as<Sample>();
    const auto channels = static_cast<std::size_t>(image.channels);
    std::vector<float> heights;
    reserve_to_fill(heights, samples.size() / channels);
    heights.resize(samples.size() / channels);
    parallel_for(heights.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        const Sample* texel = samples.data() + begin * channels;
        for (std::size_t i = begin; i < end; ++i, texel += channels)
            heights[i] = height(texel);
    });
    return heights;
}

/// The number of channels is a template argument, so that the loop is vectorized.
template <std::size_t channels, typename Sample>
std::vector<float> mean_of_colors(std::span<const Sample> samples) {
    std::vector<float> heights;
    reserve_to_fill(heights, samples.size() / channels);
    heights.resize(samples.size() / channels);
    parallel_for(heights.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        const Sample* const from = samples.data();
        float* const to = heights.data();
        for (std::size_t texel = begin; texel < end; ++texel) {
            double sum = 0.0;
            for (std::size_t color = 0; color < 3; ++color)
                sum += static_cast<double>(from[texel * channels + color]);
            to[texel] = static_cast<float>(sum / (3.0 * largest_sample<Sample>));
        }
    });
    return heights;
}

/// Computes the luminance of Rec. 709; `linear(sample)` decodes a sample.
template <typename Sample, typename Linear>
std::vector<float> luminance_by(const Image& image, const Linear& linear) {
    return make_heights<Sample>(image, [&linear](const Sample* texel) {
        return static_cast<float>(0.2126 * linear(texel[0]) + 0.7152 * linear(texel[1]) +
                                  0.0722 * linear(texel[2]));
    });
}

template <typename Sample>
std::vector<float> luminance(const Image& image) {
    if constexpr (std::is_same_v<Sample, float>) {
        return luminance_by<Sample>(image,
                                    [](float sample) { return static_cast<double>(sample); });
    } else {
        std::vector<double> table(std::numeric_limits<Sample>::max() + std::size_t{1});
        for (std::size_t code = 0; code < table.size(); ++code) {
            const double coded = static_cast<double>(code) / largest_sample<Sample>;
            table[code] = linear_from_srgb(static_cast<float>(coded));
        }
        return luminance_by<Sample>(image, [&table](Sample sample) { return table[sample]; });
    }
}

std::vector<float> floats_of(Image&& image) {
    return std::get<std::vector<float>>(std::move(image.samples));
}

template <typename Sample>
std::vector<float> heights_of(const Image& image, HeightChannel channel) {
    if (channel == HeightChannel::alpha) return floats_of(channel_of(image, image.channels - 1));
    if (is_gray(image)) return floats_of(channel_of(image, 0));
    switch (channel) {
        case HeightChannel::luminance:
            return luminance<Sample>(image);
        case HeightChannel::red:
            return floats_of(channel_of(image, 0));
        case HeightChannel::green:
            return floats_of(channel_of(image, 1));
        case HeightChannel::blue:
            return floats_of(channel_of(image, 2));
        default:
            return image.channels == 3 ? mean_of_colors<3>(image.as<Sample>())
                                       : mean_of_colors<4>(image.as<Sample>());
    }
}

void check(const Image& image, HeightChannel channel) {
    if (image.empty()) throw InvalidInput("the image is empty");
    if (channel == HeightChannel::alpha && !has_alpha(image))
        throw InvalidInput("the image has no alpha channel to take heights from");
    const bool is_color = channel == HeightChannel::green || channel == HeightChannel::blue;
    if (is_color && is_gray(image))
        throw InvalidInput(fmt::format("a gray image has no {} channel to take heights from",
                                       channel == HeightChannel::green ? "green" : "blue"));
}

/// Takes alpha in the depth of the image, and the texels where it is 0.
template <typename Sample>
void take_alpha(const Image& image, HeightMap& map) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::span<const Sample> samples = image.as<Sample>();
    std::vector<Sample> alpha(samples.size() / channels);
    bool any_transparent = false;
    for (std::size_t texel = 0; texel < alpha.size(); ++texel) {
        alpha[texel] = samples[texel * channels + channels - 1];
        any_transparent |= alpha[texel] == Sample{0};
    }
    if (any_transparent) {
        map.transparent.resize(alpha.size());
        std::transform(alpha.begin(), alpha.end(), map.transparent.begin(),
                       [](Sample value) { return static_cast<std::uint8_t>(value == Sample{0}); });
    }
    map.alpha = {image.width, image.height, 1, ColorSpace::data, std::move(alpha)};
}

/// Estimates the shares of colored texels and of partial alpha from evenly spaced texels.
template <typename Sample>
void take_shares(const Image& image, HeightMap& map) {
    // JPEG changes gray images by up to this difference.
    constexpr double min_difference = 1.0 / 16.0;
    constexpr std::size_t analyzed = 10000;
    const std::span<const Sample> samples = image.as<Sample>();
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t texels = samples.size() / channels;
    // An odd distance is not a multiple of most image widths.
    const std::size_t distance = texels / analyzed | 1U;
    double count = 0.0;
    double colored = 0.0;
    double partial = 0.0;
    for (std::size_t texel = 0; texel < texels; texel += distance) {
        const Sample* const at = samples.data() + texel * channels;
        ++count;
        if (channels >= 3) {
            const auto [least, greatest] = std::minmax({at[0], at[1], at[2]});
            const double difference = static_cast<double>(greatest) - static_cast<double>(least);
            if (difference > min_difference * largest_sample<Sample>) ++colored;
        }
        if (has_alpha(image)) {
            const double alpha = static_cast<double>(at[channels - 1]) / largest_sample<Sample>;
            if (alpha > 0.0 && alpha < 1.0) ++partial;
        }
    }
    map.colored_fraction = colored / count;
    map.partial_alpha_fraction = partial / count;
}

}  // namespace

std::size_t HeightMap::transparent_count() const {
    return static_cast<std::size_t>(std::count(transparent.begin(), transparent.end(), 1));
}

Image height_field(const Image& image, HeightChannel channel) {
    check(image, channel);
    Image result{image.width, image.height, 1, ColorSpace::data, {}};
    std::visit(
        [&]<typename Sample>(const std::vector<Sample>&) {
            result.samples = heights_of<Sample>(image, channel);
        },
        image.samples);
    return result;
}

HeightMap height_map(Image&& image, HeightChannel channel) {
    check(image, channel);
    HeightMap map;
    if (image.channels > 1) {
        std::visit(
            [&]<typename Sample>(const std::vector<Sample>&) { take_shares<Sample>(image, map); },
            image.samples);
    }
    if (has_alpha(image) && channel != HeightChannel::alpha) {
        std::visit(
            [&]<typename Sample>(const std::vector<Sample>&) { take_alpha<Sample>(image, map); },
            image.samples);
    }
    map.heights = image.channels == 1 ? std::move(image) : height_field(image, channel);
    map.heights.color_space = ColorSpace::data;
    return map;
}

namespace {

/// A grid of texels and its continuation beyond the border.
struct Lattice {
    int width = 0;
    int height = 0;
    Wraps wrap;

    [[nodiscard]] std::size_t size() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }

    /// Returns the texel at a position, or -1 if there is none.
    [[nodiscard]] std::ptrdiff_t at(int column, int row) const {
        const auto is_beyond = [](int place, int count, Wrap rule) {
            return rule == Wrap::clamp && (place < 0 || place >= count);
        };
        if (is_beyond(column, width, wrap.x) || is_beyond(row, height, wrap.y)) return -1;
        column = place_within(column, width, wrap.x);
        row = place_within(row, height, wrap.y);
        return static_cast<std::ptrdiff_t>(row) * width + column;
    }
};

/// Performs one sweep of the distance map: every texel is updated from the neighbors that the sweep
/// has visited. \return whether a distance changed
bool sweep(std::vector<std::uint32_t>& distance, const Lattice& lattice, int direction) {
    bool changed = false;
    const int rows = lattice.height;
    const int columns = lattice.width;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            const int row = direction > 0 ? r : rows - 1 - r;
            const int column = direction > 0 ? c : columns - 1 - c;
            std::uint32_t& own = distance[static_cast<std::size_t>(lattice.at(column, row))];
            const int visited[4][2] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
            for (const auto& step : visited) {
                const std::ptrdiff_t neighbor =
                    lattice.at(column + direction * step[0], row + direction * step[1]);
                if (neighbor < 0) continue;
                const std::uint32_t through = distance[static_cast<std::size_t>(neighbor)] + 1;
                if (through >= own) continue;
                own = through;
                changed = true;
            }
        }
    }
    return changed;
}

/// Computes the chessboard distance of every texel to the nearest finite height. Two sweeps suffice
/// for a bounded image; a tiled one needs one or two more rounds until nothing changes.
std::vector<std::uint32_t> distance_to_finite(std::span<const float> heights,
                                              const Lattice& lattice) {
    constexpr std::uint32_t far = std::uint32_t{1} << 31;
    std::vector<std::uint32_t> distance(heights.size());
    std::transform(heights.begin(), heights.end(), distance.begin(),
                   [](float height) { return std::isfinite(height) ? 0 : far; });
    bool changed = true;
    while (changed) {
        const bool forwards = sweep(distance, lattice, 1);
        const bool backwards = sweep(distance, lattice, -1);
        changed = forwards || backwards;
    }
    return distance;
}

/// Returns the mean of the finite heights on the rim of a square.
float rim_mean(std::span<const float> heights, const Lattice& lattice, int column, int row,
               int radius) {
    double sum = 0.0;
    std::size_t count = 0;
    const auto take = [&](int c, int r) {
        const std::ptrdiff_t texel = lattice.at(c, r);
        if (texel < 0) return;
        const double height = heights[static_cast<std::size_t>(texel)];
        if (!std::isfinite(height)) return;
        sum += height;
        ++count;
    };
    for (int offset = -radius; offset <= radius; ++offset) {
        take(column + offset, row - radius);
        take(column + offset, row + radius);
    }
    for (int offset = 1 - radius; offset < radius; ++offset) {
        take(column - radius, row + offset);
        take(column + radius, row + offset);
    }
    return static_cast<float>(sum / static_cast<double>(count));
}

bool all_finite(std::span<const float> heights) {
    std::atomic<bool> finite = true;
    parallel_for(heights.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        // The loop tests bits, because it is then vectorized: infinities and NaN have all exponent
        // bits set.
        constexpr std::uint32_t exponent = 0x7F800000U;
        std::uint32_t found = 0;
        for (std::size_t texel = begin; texel < end; ++texel) {
            const auto bits = std::bit_cast<std::uint32_t>(heights[texel]);
            found |= static_cast<std::uint32_t>((bits & exponent) == exponent);
        }
        if (found != 0) finite = false;
    });
    return finite;
}

/// Returns the heights, with NaN for transparent texels.
std::vector<float> without_transparent(std::span<const float> heights,
                                       std::span<const unsigned char> transparent) {
    std::vector<float> result(heights.begin(), heights.end());
    for (std::size_t texel = 0; texel < transparent.size(); ++texel) {
        if (transparent[texel] != 0) result[texel] = std::numeric_limits<float>::quiet_NaN();
    }
    return result;
}

}  // namespace

std::vector<float> detail::filled_holes(const Image& height, const Wraps& wrap, Report& report,
                                        const Transparency& transparency) {
    const std::span<const unsigned char> transparent = transparency.texels;
    if (transparent.empty() && all_finite(height.as<float>())) return {};
    const std::vector<float> heights = without_transparent(height.as<float>(), transparent);
    const auto is_transparent = [&](std::size_t texel) {
        return !transparent.empty() && transparent[texel] != 0;
    };
    const Lattice lattice{height.width, height.height, wrap};
    const std::vector<std::uint32_t> distance = distance_to_finite(heights, lattice);
    const auto farthest = static_cast<std::uint32_t>(std::max(height.width, height.height));
    const auto reach = static_cast<std::uint32_t>(transparency.reach);
    std::vector<float> whole = heights;
    parallel_for(lattice.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t texel = begin; texel < end; ++texel) {
            if (distance[texel] == 0) continue;
            const int column = static_cast<int>(texel % static_cast<std::size_t>(lattice.width));
            const int row = static_cast<int>(texel / static_cast<std::size_t>(lattice.width));
            const bool is_filled = distance[texel] <= (is_transparent(texel) ? reach : farthest);
            whole[texel] = is_filled ? rim_mean(heights, lattice, column, row,
                                                static_cast<int>(distance[texel]))
                                     : 0.0F;
        }
    });
    const bool has_heights =
        std::any_of(distance.begin(), distance.end(), [](std::uint32_t away) { return away == 0; });
    const char* const outcome = has_heights
                                    ? "read as the mean of the nearest finite heights"
                                    : "read as 0, as no height of the map is finite: it is flat";
    for (std::size_t texel = 0; texel < distance.size(); ++texel) {
        if (distance[texel] != 0 && !is_transparent(texel))
            report.add("non-finite height", "texel", texel, outcome);
    }
    return whole;
}

}  // namespace relief
