// SPDX-License-Identifier: Apache-2.0
// Power spectral densities of small squares with a squared Hann window, averaged over the squares
// and over bins of frequency and direction [Welch 1967], and spectral subtraction of noise
// [Boll 1979]. Nothing throws. Tests: tests/mesh/bump/kernel_choice_test.cpp.
#include "bump/height_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bump/tile_loops.h"
#include "image/fft.h"
#include "image/texel_loops.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;
constexpr int sectors = 8;  ///< Number of directions in the half circle.

/// Transforms `side` lines of a square. The lines are `across` numbers apart, and the numbers of a
/// line are `along` numbers apart.
void transform_lines(Complex* square, int side, std::ptrdiff_t across, std::ptrdiff_t along,
                     const ComplexFft& transform, bool inverse) {
    constexpr int lanes = ComplexFft::lanes;
    std::vector<double> real(static_cast<std::size_t>(side * lanes));
    std::vector<double> imag(real.size());
    std::vector<double> scratch(transform.scratch_size());
    for (int first = 0; first < side; first += lanes) {
        const auto at = [&](int lane, int index) -> Complex& {
            return square[(first + lane) * across + index * along];
        };
        for (int index = 0; index < side; ++index) {
            for (int lane = 0; lane < lanes; ++lane) {
                real[static_cast<std::size_t>(index * lanes + lane)] = at(lane, index).real();
                imag[static_cast<std::size_t>(index * lanes + lane)] = at(lane, index).imag();
            }
        }
        // Exchanging the real and imaginary parts turns the transform into its inverse.
        transform.transform(
            inverse ? ComplexRows{imag.data(), real.data()} : ComplexRows{real.data(), imag.data()},
            scratch.data());
        for (int index = 0; index < side; ++index) {
            for (int lane = 0; lane < lanes; ++lane)
                at(lane, index) = {real[static_cast<std::size_t>(index * lanes + lane)],
                                   imag[static_cast<std::size_t>(index * lanes + lane)]};
        }
    }
}

/// Returns the heights without their least-squares plane, whose power the window would spread.
std::vector<double> without_trend(const HeightTile& tile) {
    const double middle = 0.5 * (tile.width - 1);
    double sum = 0.0;
    double along_x = 0.0;
    double along_y = 0.0;
    double squares = 0.0;
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const double value = tile.values[static_cast<std::size_t>(y * tile.width + x)];
            sum += value;
            along_x += value * (x - middle);
            along_y += value * (y - middle);
            squares += (x - middle) * (x - middle);
        }
    }
    std::vector<double> residual = tile.values;
    const double mean = sum / static_cast<double>(residual.size());
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            residual[static_cast<std::size_t>(y * tile.width + x)] -=
                mean + (along_x * (x - middle) + along_y * (y - middle)) / squares;
        }
    }
    return residual;
}

/// Returns the signed frequency of a Fourier coefficient in radians per texel.
double frequency(int index, int side) {
    return 2.0 * pi * (index <= side / 2 ? index : index - side) / side;
}

/// Returns the number of texels by which remove_noise() extends tiles on each side. Large tiles
/// serve wide kernels, whose noise is so strong that the filter is wide, too.
int extension_of(int side) {
    return side > 64 ? side / 2 : side / 4;
}

/// Calls with_pair(row, column, times) for one of all coefficients of equal distances from both
/// axes, with their number.
template <typename WithPair>
void for_mirrored_coefficients(int side, const WithPair& with_pair) {
    const auto times = [side](int index) { return index == 0 || 2 * index == side ? 1.0 : 2.0; };
    for (int row = 0; 2 * row <= side; ++row) {
        for (int column = 0; column <= row; ++column)
            with_pair(row, column, times(row) * times(column) * (row == column ? 1.0 : 2.0));
    }
}

}  // namespace

double NoiseSpectrum::at(double x, double y) const {
    const auto ring = static_cast<std::size_t>(std::sqrt(x * x + y * y) * side / (2.0 * pi) + 0.5);
    return rings[std::min(ring, rings.size() - 1)];
}

double NoiseSpectrum::deviation() const {
    if (rings.size() == 1) return std::sqrt(rings.front());
    double power = 0.0;
    for_mirrored_coefficients(side, [&](int row, int column, double times) {
        power += times * at(frequency(column, side), frequency(row, side));
    });
    return std::sqrt(power) / side;
}

OctaveDeviations NoiseSpectrum::octave_deviations() const {
    OctaveDeviations result{};
    if (rings.size() == 1) {
        result.fill(deviation());
        return result;
    }
    // The responses of the low-pass mask along one axis, up to each octave.
    const auto count = static_cast<std::size_t>(side);
    std::vector<double> before(count, 1.0);
    for (std::size_t octave = 0; octave < result.size(); ++octave) {
        std::vector<double> after(count);
        for (int i = 0; i < side; ++i) {
            const double f = frequency(i, side) * static_cast<double>(1 << octave);
            after[static_cast<std::size_t>(i)] =
                before[static_cast<std::size_t>(i)] *
                (0.375 + 0.5 * portable::cos(f) + 0.125 * portable::cos(2.0 * f));
        }
        double power = 0.0;
        double gain = 0.0;
        for_mirrored_coefficients(side, [&](int row, int column, double times) {
            const auto y = static_cast<std::size_t>(row);
            const auto x = static_cast<std::size_t>(column);
            const double response = before[y] * before[x] - after[y] * after[x];
            const double weight = times * response * response;
            power += weight * at(frequency(column, side), frequency(row, side));
            gain += weight;
        });
        result[octave] = std::sqrt(power / gain);
        before = std::move(after);
    }
    return result;
}

std::vector<double> noise_field(const NoiseSpectrum& spectrum, int side, std::uint32_t seed) {
    // The transform of white noise is white noise. The real part of its inverse transform has half
    // of the power.
    const auto count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    std::vector<double> numbers(2 * count);
    random_normals(best_vector_target(), seed, numbers.size(), numbers.data());
    std::vector<Complex> square(count);
    const auto mirrored = [side](int index) { return index == 0 ? 0 : side - index; };
    for_mirrored_coefficients(side, [&](int y, int x, double) {
        const double gain = std::sqrt(spectrum.at(frequency(x, side), frequency(y, side))) / side;
        for (const auto& [row, column] : {std::pair(y, x), std::pair(x, y)}) {
            for (const int r : {row, mirrored(row)}) {
                for (const int c : {column, mirrored(column)}) {
                    const auto i = static_cast<std::size_t>(r * side + c);
                    square[i] = {gain * numbers[2 * i], gain * numbers[2 * i + 1]};
                }
            }
        }
    });
    transform_square(square, side, true);
    std::vector<double> field(count);
    std::transform(square.begin(), square.end(), field.begin(),
                   [&](const Complex& value) { return value.real(); });
    return field;
}

void transform_square(std::vector<Complex>& square, int side, bool inverse) {
    const ComplexFft transform(static_cast<std::size_t>(side));
    transform_lines(square.data(), side, side, 1, transform, inverse);
    transform_lines(square.data(), side, 1, side, transform, inverse);
}

PowerSpectrum::PowerSpectrum(std::span<const HeightTile> tiles) : side_(tiles[0].width) {
    bins_of_coefficients_ = bins_of(side_);
    bins_.resize(static_cast<std::size_t>(side_ * sectors));
    std::vector<double> window(static_cast<std::size_t>(side_));
    double squares = 0.0;
    for (int i = 0; i < side_; ++i) {
        const double hann = 0.5 - 0.5 * portable::cos(2.0 * pi * (i + 0.5) / side_);
        const double w = hann * hann;
        window[static_cast<std::size_t>(i)] = w;
        squares += w * w;
    }
    // Two tiles share a transform, as its real and its imaginary part. The power of both is half of
    // the sum of that of opposite frequencies, which have the same bin.
    std::vector<Complex> square;
    for (std::size_t first = 0; first < tiles.size(); first += 2) {
        const std::size_t count = std::min<std::size_t>(2, tiles.size() - first);
        square.assign(bins_of_coefficients_.size(), {});
        for (std::size_t i = 0; i < count; ++i) {
            const std::vector<double> residual = without_trend(tiles[first + i]);
            const Complex part = i == 0 ? Complex(1.0, 0.0) : Complex(0.0, 1.0);
            for (std::size_t row = 0; row < window.size(); ++row) {
                for (std::size_t column = 0; column < window.size(); ++column) {
                    const std::size_t texel = row * window.size() + column;
                    square[texel] += part * (residual[texel] * window[row] * window[column]);
                }
            }
        }
        transform_square(square, side_, false);
        for (std::size_t i = 0; i < square.size(); ++i) {
            Bin& bin = bins_[bins_of_coefficients_[i]];
            bin.power += std::norm(square[i]);
            bin.count += static_cast<double>(count);
        }
    }
    for (Bin& bin : bins_)
        bin.power /= squares * squares;
    for (Bin& bin : bins_)
        bin.power /= std::max(1.0, bin.count);
}

std::vector<std::uint32_t> PowerSpectrum::bins_of(int side) const {
    std::vector<std::uint32_t> bins(static_cast<std::size_t>(side) *
                                    static_cast<std::size_t>(side));
    // Opposite frequencies have the same bin.
    const auto mirrored = [side](int index) { return index == 0 ? 0 : side - index; };
    for (int row = 0; 2 * row <= side; ++row) {
        for (int column = 0; column < side; ++column) {
            const auto bin =
                static_cast<std::uint32_t>(bin_at(frequency(column, side), frequency(row, side)));
            const bool has_opposite = 2 * row != side && 2 * column != side;
            bins[static_cast<std::size_t>(row * side + column)] = bin;
            if (has_opposite)
                bins[static_cast<std::size_t>(mirrored(row) * side + mirrored(column))] = bin;
        }
    }
    for (int row = side / 2 + 1; row < side; ++row) {
        bins[static_cast<std::size_t>(row * side + side / 2)] =
            static_cast<std::uint32_t>(bin_at(frequency(side / 2, side), frequency(row, side)));
    }
    return bins;
}

std::size_t PowerSpectrum::bin_at(double x, double y) const {
    const double length = std::sqrt(x * x + y * y) * side_ / (2.0 * pi);
    const int ring = std::min(side_ - 1, static_cast<int>(length + 0.5));
    // Opposite frequencies belong to the same wave.
    if (y < 0.0 || (y == 0.0 && x < 0.0)) {
        x = -x;
        y = -y;
    }
    // Sectors are centered on the axes, since many synthetic textures have waves along them. They
    // end at odd multiples of pi / 16, whose cosines and sines these are.
    constexpr double c1 = 0.9807852804032304;
    constexpr double s1 = 0.19509032201612825;
    constexpr double c3 = 0.8314696123025452;
    constexpr double s3 = 0.5555702330196022;
    static constexpr double ends[sectors][2] = {{c1, s1},  {c3, s3},  {s3, c3},  {s1, c1},
                                                {-s1, c1}, {-s3, c3}, {-c3, s3}, {-c1, s1}};
    int sector = 0;
    for (const auto& [cosine, sine] : ends)
        sector += y * cosine > x * sine ? 1 : 0;
    sector %= sectors;
    return static_cast<std::size_t>(ring * sectors + sector);
}

bool PowerSpectrum::ends_flat() const {
    constexpr double max_ratio = 3.0;
    const std::vector<Band> bands = this->bands();
    return bands.size() < 2 || bands[bands.size() - 2].power < max_ratio * bands.back().power;
}

double PowerSpectrum::white_floor() const {
    std::vector<double> powers;
    for (int ring = 3 * side_ / 8; ring < side_; ++ring) {
        for (int sector = 0; sector < sectors; ++sector) {
            const Bin& bin = bins_[static_cast<std::size_t>(ring * sectors + sector)];
            if (bin.count >= 4.0) powers.push_back(bin.power);
        }
    }
    if (powers.empty()) return 0.0;
    const auto middle = powers.begin() + static_cast<std::ptrdiff_t>(powers.size() / 2);
    std::nth_element(powers.begin(), middle, powers.end());
    return std::sqrt(*middle);
}

std::vector<double> PowerSpectrum::gains(const NoiseSpectrum& noise) const {
    // Significance thresholds in standard deviations, for a bin and for the insignificant bins of a
    // ring together.
    constexpr double bin_threshold = 5.0;
    constexpr double ring_threshold = 4.0;
    // A smaller excess can result from spectral leakage, or from a noise spectrum that is too low.
    constexpr double min_ring_excess = 0.25;
    std::vector<double> result(bins_.size(), 0.0);
    // Periodic detail stands out of noise at any frequency.
    constexpr double min_periodic_ratio = 50.0;
    for (int ring = 0; ring < side_; ++ring) {
        const double frequency = 2.0 * pi * ring / side_;
        const bool is_noise_only = frequency >= noise.min_noise_only_frequency;
        const double power = noise.at(frequency, 0.0);
        double residual = 0.0;
        double count = 0.0;
        const auto first = static_cast<std::size_t>(ring * sectors);
        for (std::size_t i = first; i < first + sectors; ++i) {
            const Bin& bin = bins_[i];
            // Half of the coefficients are independent, and the window correlates neighbors: about
            // one in four is an independent sample of an exponential distribution.
            const double samples = std::max(1.0, bin.count / 4.0);
            // The last term accounts for the long tail if there are few samples.
            const double min_ratio =
                std::max(is_noise_only ? min_periodic_ratio : 0.0,
                         1.0 + bin_threshold / std::sqrt(samples) + 2.0 * bin_threshold / samples);
            if (bin.power > power * min_ratio) {
                result[i] = std::sqrt((bin.power - power) / bin.power);
            } else {
                residual += bin.power * bin.count;
                count += bin.count;
            }
        }
        if (count == 0.0 || is_noise_only) continue;
        residual /= count;
        // The window correlates neighbors in all directions.
        const double min_excess =
            std::max(min_ring_excess, ring_threshold / std::sqrt(std::max(1.0, count / 8.0)));
        if (!(residual > power * (1.0 + min_excess))) continue;
        for (std::size_t i = first; i < first + sectors; ++i) {
            if (result[i] == 0.0) result[i] = std::sqrt((residual - power) / residual);
        }
    }
    return result;
}

double PowerSpectrum::excess_over(const NoiseSpectrum& noise) const {
    const std::vector<double> gains = this->gains(noise);
    double excess = 0.0;
    double power = 0.0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        const std::size_t ring = i / sectors;
        excess += gains[i] * gains[i] * bins_[i].power * bins_[i].count;
        power += noise.at(2.0 * pi * static_cast<double>(ring) / side_, 0.0) * bins_[i].count;
    }
    return power > 0.0 ? excess / power : std::numeric_limits<double>::infinity();
}

std::vector<PowerSpectrum::Band> PowerSpectrum::bands() const {
    constexpr double min_frequency = 4.0;
    std::vector<Band> result;
    for (int i = 0;; ++i) {
        const double begin = min_frequency * portable::pow(2.0, 0.5 * i);
        const double end = begin * std::numbers::sqrt2;
        if (begin > 0.6 * side_) break;
        std::vector<double> powers;
        for (int ring = static_cast<int>(std::ceil(begin)); ring < std::min<double>(side_, end);
             ++ring) {
            for (int sector = 0; sector < sectors; ++sector) {
                const Bin& bin = bins_[static_cast<std::size_t>(ring * sectors + sector)];
                if (bin.count >= 2.0) powers.push_back(bin.power);
            }
        }
        if (powers.empty()) continue;
        const auto middle = powers.begin() + static_cast<std::ptrdiff_t>(powers.size() / 2);
        std::nth_element(powers.begin(), middle, powers.end());
        result.push_back(
            {std::sqrt(begin * std::min(end, side_ * std::numbers::sqrt2 / 2.0)), *middle});
    }
    return result;
}

std::optional<NoiseSpectrum> PowerSpectrum::grain() const {
    // The minimum ratio of grain: the increase of power times squared frequency over an octave or
    // more.
    constexpr double min_rise = 1.5;
    constexpr double ripple = 0.8;
    const std::vector<Band> bands = this->bands();
    const auto roughness = [&](std::size_t i) {
        return bands[i].power * bands[i].frequency * bands[i].frequency;
    };
    // Grain has power up to the highest frequencies. Only blurred noise has not, which
    // blurred_noise() detects.
    const auto ends_before_nyquist = [&](std::size_t first) {
        constexpr double max_decrease = 30.0;
        double max_power = 0.0;
        double min_power = std::numeric_limits<double>::infinity();
        for (std::size_t i = first; i < bands.size(); ++i) {
            max_power = std::max(max_power, bands[i].power);
            min_power = std::min(min_power, bands[i].power);
        }
        return max_power > max_decrease * min_power;
    };
    double max_rise = min_rise;
    std::size_t first = bands.size();
    for (std::size_t valley = 0; valley + 2 < bands.size(); ++valley) {
        double top = roughness(valley);
        if (!(top > 0.0)) continue;
        for (std::size_t i = valley + 1; i < bands.size() && roughness(i) > ripple * top; ++i) {
            top = std::max(top, roughness(i));
            if (i < valley + 2 || roughness(i) / roughness(valley) < max_rise ||
                ends_before_nyquist(valley + 1))
                continue;
            max_rise = roughness(i) / roughness(valley);
            first = valley + 1;
        }
    }
    if (first >= bands.size()) return std::nullopt;
    // Lower frequencies continue the slope of the lowest octave of grain.
    const Band& low = bands[std::min(first + 1, bands.size() - 1)];
    const Band& next = bands[std::min(first + 3, bands.size() - 1)];
    const double exponent = next.frequency > low.frequency
                                ? std::clamp(portable::log(low.power / next.power) /
                                                 portable::log(next.frequency / low.frequency),
                                             -4.0, 1.0)
                                : 0.0;
    NoiseSpectrum noise;
    noise.side = side_;
    noise.rings.clear();
    noise.min_noise_only_frequency = 2.0 * pi * bands[first].frequency / side_;
    for (int ring = 0; ring < side_; ++ring) {
        const double f = std::max(1.0, static_cast<double>(ring));
        if (f <= low.frequency) {
            noise.rings.push_back(low.power * portable::pow(low.frequency / f, exponent));
            continue;
        }
        std::size_t above = first + 2;
        while (above + 1 < bands.size() && bands[above].frequency < f)
            ++above;
        if (above >= bands.size() || f >= bands.back().frequency) {
            noise.rings.push_back(bands.back().power);
            continue;
        }
        const Band& a = bands[above - 1];
        const Band& b = bands[above];
        const double w = portable::log(f / a.frequency) / portable::log(b.frequency / a.frequency);
        noise.rings.push_back(a.power * portable::pow(b.power / a.power, w));
    }
    return noise;
}

NoiseSpectrum PowerSpectrum::hidden_detail(const NoiseSpectrum& noise) const {
    // Detail is visible in a ring if its power exceeds `min_visible` times that of the noise.
    // Detail of up to `max_hidden` times the noise can be hidden.
    constexpr double min_visible = 0.25;
    constexpr double max_hidden = 0.7;
    // Exponents of the decrease of power with frequency: of step edges, and of smooth surfaces.
    constexpr double min_exponent = 3.0;
    constexpr double max_exponent = 5.0;
    const std::vector<double> gains = this->gains(noise);
    const auto rings = static_cast<std::size_t>(side_);
    std::vector<double> visible(rings, 0.0);
    std::vector<double> hidden(rings, 0.0);
    std::size_t last = 1;  // The highest ring with visible detail.
    for (std::size_t ring = 1; ring < rings; ++ring) {
        const double noise_power = noise.at(2.0 * pi * static_cast<double>(ring) / side_, 0.0);
        double count = 0.0;
        double empty = 0.0;
        for (std::size_t i = ring * sectors; i < (ring + 1) * sectors; ++i) {
            visible[ring] += gains[i] * gains[i] * bins_[i].power * bins_[i].count;
            empty += gains[i] == 0.0 ? bins_[i].count : 0.0;
            count += bins_[i].count;
        }
        visible[ring] /= std::max(1.0, count);
        hidden[ring] = max_hidden * noise_power * empty / std::max(1.0, count);
        if (visible[ring] > min_visible * noise_power) last = ring;
    }
    const auto mean_visible = [&](double begin, double end) {
        double sum = 0.0;
        double count = 0.0;
        const auto to = static_cast<std::size_t>(end);
        for (std::size_t r = std::max<std::size_t>(1, static_cast<std::size_t>(begin)); r <= to;
             ++r) {
            sum += static_cast<double>(r) * visible[r];
            count += static_cast<double>(r);
        }
        return sum / count;
    };
    // Above that ring, the power decreases as over the octave below, or fast enough to stay hidden.
    const auto edge = static_cast<double>(last);
    double exponent = min_exponent;
    double next = last + 1 < rings ? hidden[last + 1] : 0.0;
    if (const double top = mean_visible(0.7 * edge, edge); top > 0.0) {
        if (last >= 3) {
            const double below = mean_visible(0.35 * edge, 0.5 * edge);
            exponent = std::clamp(portable::log(below / top) / std::numbers::ln2, min_exponent,
                                  max_exponent);
        }
        next = std::min(next, top * portable::pow(edge / (edge + 1.0), exponent));
        const double drop = portable::log(top / next) / portable::log((edge + 1.0) / (0.85 * edge));
        if (next < top) exponent = std::clamp(drop, exponent, max_exponent);
    }
    for (std::size_t ring = last + 1; ring < rings; ++ring) {
        const double limit =
            next * portable::pow((edge + 1.0) / static_cast<double>(ring), exponent);
        hidden[ring] = std::min(hidden[ring], limit);
    }
    NoiseSpectrum result;
    result.side = side_;
    result.rings = std::move(hidden);
    return result;
}

double PowerSpectrum::unresolved_slope(const NoiseSpectrum& noise) const {
    const std::vector<double> gains = this->gains(noise);
    std::vector<double> losses(static_cast<std::size_t>(side_));
    for (int i = 0; i < side_; ++i) {
        const double f = frequency(i, side_);
        const double residual = f - reference_slope_response(f);
        losses[static_cast<std::size_t>(i)] = residual * residual;
    }
    double square = 0.0;
    for (int row = 0; row < side_; ++row) {
        for (int column = 0; column < side_; ++column) {
            const std::size_t bin =
                bins_of_coefficients_[static_cast<std::size_t>(row * side_ + column)];
            square +=
                gains[bin] * gains[bin] * bins_[bin].power *
                (losses[static_cast<std::size_t>(row)] + losses[static_cast<std::size_t>(column)]);
        }
    }
    // Half of the sum is along x.
    constexpr double amount_above_nyquist = 2.5;
    return std::sqrt(0.5 * (1.0 + amount_above_nyquist) * square) / side_;
}

std::vector<double> PowerSpectrum::gains_of_extension(std::span<const double> gains) const {
    std::vector<double> result;
    for (const std::uint32_t bin : bins_of(side_ + 2 * extension_of(side_)))
        result.push_back(gains[bin]);
    return result;
}

void remove_noise(std::span<HeightTile> tiles, std::span<const double> gains) {
    // Both tiles have one transform, as its real and its imaginary part: the gains are real and
    // equal for opposite frequencies.
    const int tile_side = tiles.front().width;
    const int margin = extension_of(tile_side);
    const int side = tile_side + 2 * margin;
    // The tiles are extended by reflection, and a Hann window fades out the extension.
    std::vector<double> fade(static_cast<std::size_t>(side), 1.0);
    for (int i = 0; i < margin; ++i) {
        const double w = 0.5 - 0.5 * portable::cos(pi * (i + 0.5) / margin);
        fade[static_cast<std::size_t>(i)] = fade[static_cast<std::size_t>(side - 1 - i)] = w;
    }
    std::vector<std::vector<double>> residuals;
    std::vector<Complex> square(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    std::vector<double> extended(static_cast<std::size_t>(side) *
                                 static_cast<std::size_t>(tile_side));
    for (const HeightTile& tile : tiles) {
        const std::vector<double>& residual = residuals.emplace_back(without_trend(tile));
        const Complex part = residuals.size() == 1 ? Complex(1.0, 0.0) : Complex(0.0, 1.0);
        for (int row = 0; row < tile_side; ++row) {
            const double* const line = residual.data() + row * tile_side;
            for (int column = 0; column < side; ++column) {
                extended[static_cast<std::size_t>(row * side + column)] =
                    reflected(column - margin, tile_side, [&](int x) { return line[x]; });
            }
        }
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                const double value = reflected(row - margin, tile_side, [&](int y) {
                    return extended[static_cast<std::size_t>(y * side + column)];
                });
                square[static_cast<std::size_t>(row * side + column)] +=
                    part * (value * fade[static_cast<std::size_t>(row)] *
                            fade[static_cast<std::size_t>(column)]);
            }
        }
    }
    transform_square(square, side, false);
    for (std::size_t i = 0; i < square.size(); ++i)
        square[i] *= gains[i];
    transform_square(square, side, true);
    const double scale = 1.0 / (static_cast<double>(side) * side);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        for (int row = 0; row < tile_side; ++row) {
            for (int column = 0; column < tile_side; ++column) {
                const auto texel = static_cast<std::size_t>(row * tile_side + column);
                const Complex& value =
                    square[static_cast<std::size_t>((row + margin) * side + column + margin)];
                // Subtracting the residual keeps the least-squares plane of the tile.
                tiles[i].values[texel] +=
                    (i == 0 ? value.real() : value.imag()) * scale - residuals[i][texel];
            }
        }
    }
}

}  // namespace relief::detail
