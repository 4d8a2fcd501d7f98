// SPDX-License-Identifier: Apache-2.0
// Statistics of the vectors of a map, the direction of green, and the code of flat texels.
//
// Sums run over pieces of a fixed size and are added in order, so they are the same for any number
// of threads. Texels that are not finite count only as such.
//
// The direction of green: slopes p along x and q along y (upwards if green is up) are computed for
// one square of the map at a time, with a border, and halved in size three times. At each size, the
// sums over all texels with usable neighbors are
//     agree = nz^4 * dp/dy * dq/dx        size = nz^4 * ((dp/dy)^2 + (dq/dx)^2) / 2
// The weight turns slopes, which are unbounded, into angles. agree / size is 1 for integrable
// slopes, and -1 if y is inverted. Squares count as independent observations, and their variance
// gives the deviation of the result.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>

#include "image/map_statistics.h"
#include "parallel.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

constexpr std::size_t texels_per_sum = 1 << 15;
constexpr float longest_without_direction = 1.0F / 16.0F;
constexpr float facing_back = -0.02F;  // Rounding to 8 bits decodes 0 to values above this one.

constexpr std::size_t listed_at_most = 8;

void note(MapConditionCount& found, std::size_t texel) {
    if (found.count++ < listed_at_most) found.first.push_back(texel);
}

/// Adds the texels of a later part of the map.
void append(MapConditionCount& found, const MapConditionCount& later) {
    found.count += later.count;
    for (const std::size_t texel : later.first) {
        if (found.first.size() < listed_at_most) found.first.push_back(texel);
    }
}

/// The sums before division.
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

MapStatistics map_statistics(const ImageView& map, const SampleMeaning& meaning, std::size_t step) {
    return with_sample_type(map, [&](auto sample) {
        const MapVectors<decltype(sample)> vectors(map, meaning);
        const std::size_t count =
            static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
        const std::size_t per_piece = texels_per_sum * step;
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

namespace {

constexpr int scales = 4;  ///< Averages over 1, 2, 4 and 8 texels.
constexpr int largest_square = 64;
constexpr int least_square = 8;
constexpr float max_slope = 10.0F;

// The limits of a significant correlation. Of 24 real maps, those of surfaces have 0.39 to 0.998 at
// 7.5 deviations or more; ripples, flakes, noise and isolated wires have up to 0.08, or 0.2 at 2.7.
constexpr double min_correlation = 0.15;
constexpr double min_sureness = 5.0;  // In standard deviations.
constexpr double min_squares =
    4.0;  // The effective number of squares. Fewer have no meaningful deviation.

/// The slopes of a square at one scale; NaN for texels that do not contribute.
struct Slopes {
    int side = 0;
    std::vector<float> p, q;

    [[nodiscard]] std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
               static_cast<std::size_t>(column);
    }
};

/// Averages 2 x 2 texels.
void halve(const std::vector<float>& from, int side, std::vector<float>& to) {
    const int half = side / 2;
    to.resize(static_cast<std::size_t>(half) * static_cast<std::size_t>(half));
    for (int row = 0; row < half; ++row) {
        const float* upper =
            &from[static_cast<std::size_t>(2 * row) * static_cast<std::size_t>(side)];
        const float* lower = upper + side;
        float* out = &to[static_cast<std::size_t>(row) * static_cast<std::size_t>(half)];
        for (int column = 0; column < half; ++column) {
            const int left = 2 * column;
            out[column] = 0.25F * (upper[left] + upper[left + 1] + lower[left] + lower[left + 1]);
        }
    }
}

/// The sums of one square at one scale.
struct Observation {
    double agree = 0.0;
    double size = 0.0;
};

struct SquareEvidence {
    std::array<Observation, scales> green;
    double alpha_slopes = 0.0, alpha_alpha = 0.0, slopes_slopes = 0.0;
};

/// Adds the terms of each column of one row, from three rows of p and q. The derivatives use
/// Sobel's weights, which halve the noise.
void observe_row(const std::array<const float*, 3>& p, const std::array<const float*, 3>& q,
                 std::size_t count, float* agree, float* size) {
    for (std::size_t i = 1; i + 1 < count; ++i) {
        // Rows count downwards, y upwards.
        const float p_in_y = (p[0][i - 1] + 2.0F * p[0][i] + p[0][i + 1]) -
                             (p[2][i - 1] + 2.0F * p[2][i] + p[2][i + 1]);
        const float q_in_x = (q[0][i + 1] + 2.0F * q[1][i + 1] + q[2][i + 1]) -
                             (q[0][i - 1] + 2.0F * q[1][i - 1] + q[2][i - 1]);
        const float weight = 1.0F / (1.0F + p[1][i] * p[1][i] + q[1][i] * q[1][i]);
        const float squared = weight * weight;
        const float of_size = 0.5F * squared * (p_in_y * p_in_y + q_in_x * q_in_x);
        // If a slope is NaN, so are all of these, and the comparison is false.
        const bool counts = of_size < std::numeric_limits<float>::max();
        agree[i] += counts ? squared * p_in_y * q_in_x : 0.0F;
        size[i] += counts ? of_size : 0.0F;
    }
}

/// Returns the sums over all texels of a square that have two neighbors on each side inside it.
Observation observe(const Slopes& slopes) {
    const auto side = static_cast<std::size_t>(slopes.side);
    std::array<float, largest_square> agree{}, size{};
    for (std::size_t row = 1; row + 1 < side; ++row) {
        const auto rows_of = [&](const std::vector<float>& of) {
            const float* middle = of.data() + row * side;
            return std::array<const float*, 3>{middle - side, middle, middle + side};
        };
        observe_row(rows_of(slopes.p), rows_of(slopes.q), side, agree.data(), size.data());
    }
    Observation sum;
    for (std::size_t i = 0; i < side; ++i) {
        sum.agree += static_cast<double>(agree[i]);
        sum.size += static_cast<double>(size[i]);
    }
    return sum;
}

template <typename Sample>
class Squares {
  public:
    Squares(const ImageView& map, const SampleMeaning& meaning)
        : vectors_(map, meaning), width_(map.width), height_(map.height) {
        const int shorter = std::min(width_, height_);
        side_ = std::clamp(shorter / 4 / 8 * 8, least_square, largest_square);
        columns_ = std::max(1, width_ / side_);
        rows_ = std::max(1, height_ / side_);
    }

    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    }

    [[nodiscard]] SquareEvidence look_at(std::size_t square) const {
        Slopes slopes = slopes_of(square);
        SquareEvidence evidence;
        if (vectors_.channels() == 4) compare_alpha(square, slopes, evidence);
        for (int scale = 0; scale < scales; ++scale) {
            evidence.green[static_cast<std::size_t>(scale)] = observe(slopes);
            if (slopes.side < 6) break;
            Slopes coarser;
            coarser.side = slopes.side / 2;
            halve(slopes.p, slopes.side, coarser.p);
            halve(slopes.q, slopes.side, coarser.q);
            slopes = std::move(coarser);
        }
        return evidence;
    }

  private:
    /// Returns the slopes of a square. If the map is smaller than a square, slopes beyond its
    /// border are NaN.
    [[nodiscard]] Slopes slopes_of(std::size_t square) const {
        const int first_column =
            static_cast<int>(square % static_cast<std::size_t>(columns_)) * side_;
        const int first_row = static_cast<int>(square / static_cast<std::size_t>(columns_)) * side_;
        Slopes slopes;
        slopes.side = side_;
        slopes.p.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
        slopes.q.resize(slopes.p.size());
        for (int row = 0; row < side_; ++row) {
            for (int column = 0; column < side_; ++column) {
                const std::size_t at = slopes.at(column, row);
                slopes.p[at] = slopes.q[at] = std::numeric_limits<float>::quiet_NaN();
                if (first_column + column >= width_ || first_row + row >= height_) continue;
                const glm::vec3 n = vectors_[static_cast<std::size_t>(first_row + row) *
                                                 static_cast<std::size_t>(width_) +
                                             static_cast<std::size_t>(first_column + column)];
                if (!(n.z > 0.0F) || !(std::max(std::abs(n.x), std::abs(n.y)) <= max_slope * n.z))
                    continue;
                slopes.p[at] = -n.x / n.z;
                slopes.q[at] = -n.y / n.z;
            }
        }
        return slopes;
    }

    /// Adds the products of the slopes of the normals and of alpha, both along x.
    void compare_alpha(std::size_t square, const Slopes& slopes, SquareEvidence& evidence) const {
        const std::size_t first = texel_of(square);
        for (int row = 0; row < side_; ++row) {
            for (int column = 1; column + 1 < side_; ++column) {
                const float p = slopes.p[slopes.at(column, row)];
                if (!std::isfinite(p)) continue;
                const std::size_t texel =
                    first + static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(column);
                const float rise =
                    vectors_.component(texel + 1, 3) - vectors_.component(texel - 1, 3);
                if (!std::isfinite(rise)) continue;
                evidence.alpha_slopes += static_cast<double>(rise) * static_cast<double>(p);
                evidence.alpha_alpha += static_cast<double>(rise) * static_cast<double>(rise);
                evidence.slopes_slopes += static_cast<double>(p) * static_cast<double>(p);
            }
        }
    }

    /// Returns the first texel of a square.
    [[nodiscard]] std::size_t texel_of(std::size_t square) const {
        const auto columns = static_cast<std::size_t>(columns_);
        const auto side = static_cast<std::size_t>(side_);
        return square / columns * side * static_cast<std::size_t>(width_) + square % columns * side;
    }

    MapVectors<Sample> vectors_;
    int width_, height_, side_ = 0, columns_ = 0, rows_ = 0;
};

/// Returns the evidence of one scale. `green` is absent unless it is significant.
GreenEvidence judged(const std::vector<SquareEvidence>& squares, std::size_t scale) {
    GreenEvidence evidence;
    evidence.scale = 1 << scale;
    double agree = 0.0, size = 0.0, size_squares = 0.0;
    for (const SquareEvidence& square : squares) {
        agree += square.green[scale].agree;
        size += square.green[scale].size;
        size_squares += square.green[scale].size * square.green[scale].size;
    }
    if (!(size > 0.0)) return evidence;
    evidence.correlation = agree / size;
    double squared = 0.0;
    for (const SquareEvidence& square : squares) {
        const double rest =
            square.green[scale].agree - evidence.correlation * square.green[scale].size;
        squared += rest * rest;
    }
    // The deviation of a ratio of sums; then the effective number of squares.
    evidence.deviation = std::sqrt(squared) / size;
    if (size * size < min_squares * size_squares) return evidence;
    const double sureness = std::abs(evidence.correlation) / evidence.deviation;
    evidence.confidence = portable::erf(sureness / std::numbers::sqrt2);
    if (std::abs(evidence.correlation) >= min_correlation && sureness >= min_sureness)
        evidence.green = evidence.correlation > 0.0 ? Green::up : Green::down;
    return evidence;
}

/// Returns the scale with the highest significance. If two scales significantly contradict each
/// other, green is undecided.
GreenEvidence surest(const std::vector<SquareEvidence>& squares) {
    const auto sureness = [](const GreenEvidence& evidence) {
        if (evidence.correlation == 0.0 || evidence.confidence == 0.0) return 0.0;
        return std::abs(evidence.correlation) / std::max(evidence.deviation, 1e-9);
    };
    GreenEvidence best = judged(squares, 0);
    bool up = best.green == Green::up, down = best.green == Green::down;
    for (std::size_t scale = 1; scale < scales; ++scale) {
        const GreenEvidence evidence = judged(squares, scale);
        up = up || evidence.green == Green::up;
        down = down || evidence.green == Green::down;
        const bool is_better = evidence.green.has_value() != best.green.has_value()
                                   ? evidence.green.has_value()
                                   : sureness(evidence) > sureness(best);
        if (is_better) best = evidence;
    }
    if (up && down) best.green.reset();
    return best;
}

/// Returns the correlation of the slopes of alpha and of the normals along x; along y the sign of
/// green may be unknown.
std::optional<double> alpha_correlation(const std::vector<SquareEvidence>& squares) {
    double both = 0.0, alpha = 0.0, slopes = 0.0;
    for (const SquareEvidence& square : squares) {
        both += square.alpha_slopes;
        alpha += square.alpha_alpha;
        slopes += square.slopes_slopes;
    }
    if (!(alpha > 0.0) || !(slopes > 0.0)) return 0.0;
    return both / std::sqrt(alpha * slopes);
}

}  // namespace

SurfaceEvidence surface_evidence(const ImageView& map, const SampleMeaning& meaning) {
    return with_sample_type(map, [&](auto sample) {
        const Squares<decltype(sample)> all(map, meaning);
        std::vector<SquareEvidence> squares(all.count());
        parallel_for(squares.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t square = begin; square < end; ++square)
                squares[square] = all.look_at(square);
        });
        SurfaceEvidence result{surest(squares), std::nullopt};
        if (map.channels == 4) result.alpha_correlation = alpha_correlation(squares);
        return result;
    });
}

namespace {

template <typename Code>
FlatEvidence counted(const ImageView& map) {
    constexpr int lower = std::numeric_limits<Code>::max() / 2;
    const auto is_near = [](int code) { return code >= lower - 1 && code <= lower + 2; };
    FlatEvidence evidence;
    for (int row = 0; row < map.height; ++row) {
        const Code* texel = map.row<Code>(row);
        for (int column = 0; column < map.width; ++column, texel += map.channels) {
            const int x = texel[0];
            const int y = texel[1];
            if (!is_near(x) || !is_near(y)) continue;
            ++evidence.near;
            if (x == lower && y == lower) ++evidence.lower;
        }
    }
    return evidence;
}

}  // namespace

FlatEvidence flat_evidence(const ImageView& map) {
    switch (map.bits()) {
        case 8:
            return counted<std::uint8_t>(map);
        case 16:
            return counted<std::uint16_t>(map);
        default:
            return {};
    }
}

}  // namespace relief::detail
