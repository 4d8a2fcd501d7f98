// SPDX-License-Identifier: Apache-2.0
// Power spectra of small squares under the square of a Hann window, averaged over squares and over
// bins of length and direction [Welch 1967], and the subtraction of white noise from them [Boll
// 1979]. Nothing throws. Tests: tests/mesh/accuracy/power_spectrum_test.cpp.
#include "accuracy/power_spectrum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "accuracy/random.h"
#include "geometry/portable_math.h"
#include "image/fft.h"
#include "image/texel_loops.h"

namespace relief {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;
constexpr int sectors = 8;  ///< Of half a turn.

/// Lines of a square: `side` of them, `across` numbers apart, each of numbers `along` apart.
void transform_lines(Complex* square, int side, std::ptrdiff_t across, std::ptrdiff_t along,
                     const ComplexFft& transform, bool back) {
    constexpr int lanes = ComplexFft::lanes;
    std::vector<double> real(static_cast<std::size_t>(side * lanes));
    std::vector<double> imag(real.size());
    std::vector<double> scratch(transform.scratch_size());
    for (int first = 0; first < side; first += lanes) {
        const auto at = [&](int lane, int place) -> Complex& {
            return square[(first + lane) * across + place * along];
        };
        for (int place = 0; place < side; ++place) {
            for (int lane = 0; lane < lanes; ++lane) {
                real[static_cast<std::size_t>(place * lanes + lane)] = at(lane, place).real();
                imag[static_cast<std::size_t>(place * lanes + lane)] = at(lane, place).imag();
            }
        }
        // The inverse is the transform with both parts exchanged.
        transform.transform(
            back ? ComplexRows{imag.data(), real.data()} : ComplexRows{real.data(), imag.data()},
            scratch.data());
        for (int place = 0; place < side; ++place) {
            for (int lane = 0; lane < lanes; ++lane)
                at(lane, place) = {real[static_cast<std::size_t>(place * lanes + lane)],
                                   imag[static_cast<std::size_t>(place * lanes + lane)]};
        }
    }
}

/// The plane that fits best, subtracted: what a window would smear.
std::vector<double> without_plane(const HeightTile& tile) {
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
    std::vector<double> rest = tile.values;
    const double mean = sum / static_cast<double>(rest.size());
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            rest[static_cast<std::size_t>(y * tile.width + x)] -=
                mean + (along_x * (x - middle) + along_y * (y - middle)) / squares;
        }
    }
    return rest;
}

/// Signed frequency of a coefficient, radians a texel.
double frequency(int index, int side) {
    return 2.0 * pi * (index <= side / 2 ? index : index - side) / side;
}

}  // namespace

double NoiseSpectrum::at(double x, double y) const {
    const auto ring = static_cast<std::size_t>(std::sqrt(x * x + y * y) * side / (2.0 * pi) + 0.5);
    return rings[std::min(ring, rings.size() - 1)];
}

double NoiseSpectrum::deviation() const {
    if (rings.size() == 1) return std::sqrt(rings.front());
    double power = 0.0;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column)
            power += at(frequency(column, side), frequency(row, side));
    }
    return std::sqrt(power) / side;
}

double NoiseSpectrum::high_deviation() const {
    if (rings.size() == 1) return deviation();
    double power = 0.0;
    double gain = 0.0;
    // The mask (1 -2 1), three times over both axes.
    const auto response = [](double f) { return portable::pow(2.0 - 2.0 * portable::cos(f), 6.0); };
    for (int row = 0; row < side; ++row) {
        const double y = frequency(row, side);
        for (int column = 0; column < side; ++column) {
            const double x = frequency(column, side);
            const double weight = response(x) * response(y);
            power += weight * at(x, y);
            gain += weight;
        }
    }
    return std::sqrt(power / gain);
}

std::vector<double> noise_field(const NoiseSpectrum& spectrum, int side, std::uint32_t seed) {
    Random random(seed);
    std::vector<Complex> square(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (Complex& value : square)
        value = random.normal();
    transform_square(square, side, false);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            square[static_cast<std::size_t>(row * side + column)] *=
                std::sqrt(spectrum.at(frequency(column, side), frequency(row, side)));
        }
    }
    transform_square(square, side, true);
    std::vector<double> field(square.size());
    std::transform(square.begin(), square.end(), field.begin(), [&](const Complex& value) {
        return value.real() / (static_cast<double>(side) * side);
    });
    return field;
}

void transform_square(std::vector<Complex>& square, int side, bool back) {
    const ComplexFft transform(static_cast<std::size_t>(side));
    transform_lines(square.data(), side, side, 1, transform, back);
    transform_lines(square.data(), side, 1, side, transform, back);
}

PowerSpectrum::PowerSpectrum(std::span<const HeightTile> tiles) : side_(tiles[0].width) {
    bins_.resize(static_cast<std::size_t>(side_ * sectors));
    std::vector<double> window(static_cast<std::size_t>(side_));
    double squares = 0.0;
    for (int i = 0; i < side_; ++i) {
        const double hann = 0.5 - 0.5 * portable::cos(2.0 * pi * (i + 0.5) / side_);
        const double w = hann * hann;
        window[static_cast<std::size_t>(i)] = w;
        squares += w * w;
    }
    for (const HeightTile& tile : tiles) {
        const std::vector<double> rest = without_plane(tile);
        std::vector<Complex> square(rest.size());
        for (std::size_t i = 0; i < rest.size(); ++i) {
            square[i] = rest[i] * window[i % static_cast<std::size_t>(side_)] *
                        window[i / static_cast<std::size_t>(side_)];
        }
        transform_square(square, side_, false);
        for (int row = 0; row < side_; ++row) {
            for (int column = 0; column < side_; ++column) {
                Bin& bin = bins_[bin_at(frequency(column, side_), frequency(row, side_))];
                bin.power += std::norm(square[static_cast<std::size_t>(row * side_ + column)]) /
                             (squares * squares);
                bin.count += 1.0;
            }
        }
    }
    for (Bin& bin : bins_)
        bin.power /= std::max(1.0, bin.count);
}

std::size_t PowerSpectrum::bin_at(double x, double y) const {
    const double length = std::sqrt(x * x + y * y) * side_ / (2.0 * pi);
    const int ring = std::min(side_ - 1, static_cast<int>(length + 0.5));
    // A frequency and its opposite are the same wave.
    double angle = portable::atan2(y, x);
    if (angle < 0.0) angle += pi;
    // Sectors lie around the axes, on which much of what is made by hand has its waves.
    const int sector = static_cast<int>(std::floor(angle / pi * sectors + 0.5)) % sectors;
    return static_cast<std::size_t>(ring * sectors + sector);
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
    // Deviations that chance may reach in a bin, and in all of a ring that stand out in no bin.
    constexpr double chance = 5.0;
    constexpr double chance_of_ring = 4.0;
    // Less may be what the window spreads of strong waves, or a noise spectrum that is too low.
    constexpr double min_of_ring = 0.25;
    std::vector<double> result(bins_.size(), 0.0);
    for (int ring = 0; ring < side_; ++ring) {
        const double frequency = 2.0 * pi * ring / side_;
        if (frequency >= noise.lowest_of_noise_alone) break;
        const double power = noise.at(frequency, 0.0);
        double rest = 0.0;
        double count = 0.0;
        const auto first = static_cast<std::size_t>(ring * sectors);
        for (std::size_t i = first; i < first + sectors; ++i) {
            const Bin& bin = bins_[i];
            // Half of the coefficients are independent, and the window makes neighbors alike: about
            // one in four is a draw of its own from an exponential distribution.
            const double draws = std::max(1.0, bin.count / 4.0);
            // The last term is for the long tail of few draws.
            if (bin.power > power * (1.0 + chance / std::sqrt(draws) + 2.0 * chance / draws)) {
                result[i] = std::sqrt((bin.power - power) / bin.power);
            } else {
                rest += bin.power * bin.count;
                count += bin.count;
            }
        }
        if (count == 0.0) continue;
        rest /= count;
        // The window makes neighbors in all directions alike.
        const double least =
            std::max(min_of_ring, chance_of_ring / std::sqrt(std::max(1.0, count / 8.0)));
        if (!(rest > power * (1.0 + least))) continue;
        for (std::size_t i = first; i < first + sectors; ++i) {
            if (result[i] == 0.0) result[i] = std::sqrt((rest - power) / rest);
        }
    }
    return result;
}

double PowerSpectrum::excess_over(const NoiseSpectrum& noise) const {
    const std::vector<double> gains = this->gains(noise);
    double excess = 0.0;
    double power = 0.0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        const auto ring = static_cast<double>(i / sectors);
        excess += gains[i] * gains[i] * bins_[i].power * bins_[i].count;
        power += noise.at(2.0 * pi * ring / side_, 0.0) * bins_[i].count;
    }
    return power > 0.0 ? excess / power : std::numeric_limits<double>::infinity();
}

std::vector<PowerSpectrum::Band> PowerSpectrum::bands() const {
    constexpr double lowest = 4.0;
    std::vector<Band> result;
    for (int i = 0;; ++i) {
        const double begin = lowest * portable::pow(2.0, 0.5 * i);
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
    // The rise of power times squared frequency over at least an octave by which grain is known.
    constexpr double min_rise = 1.5;
    constexpr double ripple = 0.8;
    const std::vector<Band> bands = this->bands();
    const auto roughness = [&](std::size_t i) {
        return bands[i].power * bands[i].frequency * bands[i].frequency;
    };
    double greatest = min_rise;
    std::size_t first = bands.size();
    for (std::size_t valley = 0; valley + 2 < bands.size(); ++valley) {
        double top = roughness(valley);
        if (!(top > 0.0)) continue;
        for (std::size_t i = valley + 1; i < bands.size() && roughness(i) > ripple * top; ++i) {
            top = std::max(top, roughness(i));
            if (i < valley + 2 || roughness(i) / roughness(valley) < greatest) continue;
            greatest = roughness(i) / roughness(valley);
            first = valley + 1;
        }
    }
    if (first >= bands.size()) return std::nullopt;
    // Below, by the slope of the lowest octave of grain, which is between blue and pink.
    const Band& low = bands[std::min(first + 1, bands.size() - 1)];
    const Band& next = bands[std::min(first + 3, bands.size() - 1)];
    const double fall = next.frequency > low.frequency
                            ? std::clamp(portable::log(low.power / next.power) /
                                             portable::log(next.frequency / low.frequency),
                                         -4.0, 1.0)
                            : 0.0;
    NoiseSpectrum noise;
    noise.side = side_;
    noise.rings.clear();
    noise.lowest_of_noise_alone = 2.0 * pi * bands[first].frequency / side_;
    for (int ring = 0; ring < side_; ++ring) {
        const double f = std::max(1.0, static_cast<double>(ring));
        if (f <= low.frequency) {
            noise.rings.push_back(low.power * portable::pow(low.frequency / f, fall));
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
    // Detail is seen in a ring if its power exceeds `min_seen` of that of the noise; up to
    // `max_hidden` goes unnoticed.
    constexpr double min_seen = 0.25;
    constexpr double max_hidden = 0.7;
    // Exponents of the fall of the power over the frequency: edges, and what is smooth.
    constexpr double min_fall = 3.0;
    constexpr double greatest_fall = 5.0;
    const std::vector<double> gains = this->gains(noise);
    const auto rings = static_cast<std::size_t>(side_);
    std::vector<double> seen(rings, 0.0);
    std::vector<double> hidden(rings, 0.0);
    std::size_t last = 1;  // The highest ring where detail is seen.
    for (std::size_t ring = 1; ring < rings; ++ring) {
        const double noise_power = noise.at(2.0 * pi * static_cast<double>(ring) / side_, 0.0);
        double count = 0.0;
        double empty = 0.0;
        for (std::size_t i = ring * sectors; i < (ring + 1) * sectors; ++i) {
            seen[ring] += gains[i] * gains[i] * bins_[i].power * bins_[i].count;
            empty += gains[i] == 0.0 ? bins_[i].count : 0.0;
            count += bins_[i].count;
        }
        seen[ring] /= std::max(1.0, count);
        hidden[ring] = max_hidden * noise_power * empty / std::max(1.0, count);
        if (seen[ring] > min_seen * noise_power) last = ring;
    }
    const auto mean_seen = [&](double begin, double end) {
        double sum = 0.0;
        double count = 0.0;
        const auto to = static_cast<std::size_t>(end);
        for (std::size_t r = std::max<std::size_t>(1, static_cast<std::size_t>(begin)); r <= to;
             ++r) {
            sum += static_cast<double>(r) * seen[r];
            count += static_cast<double>(r);
        }
        return sum / count;
    };
    // From there on it falls as it does over the octave below, or as it must to go unnoticed.
    const auto edge = static_cast<double>(last);
    double fall = min_fall;
    double next = last + 1 < rings ? hidden[last + 1] : 0.0;
    if (const double top = mean_seen(0.7 * edge, edge); top > 0.0) {
        if (last >= 3) {
            const double below = mean_seen(0.35 * edge, 0.5 * edge);
            fall =
                std::clamp(portable::log(below / top) / std::numbers::ln2, min_fall, greatest_fall);
        }
        next = std::min(next, top * portable::pow(edge / (edge + 1.0), fall));
        const double drop = portable::log(top / next) / portable::log((edge + 1.0) / (0.85 * edge));
        if (next < top) fall = std::clamp(drop, fall, greatest_fall);
    }
    for (std::size_t ring = last + 1; ring < rings; ++ring) {
        const double limit = next * portable::pow((edge + 1.0) / static_cast<double>(ring), fall);
        hidden[ring] = std::min(hidden[ring], limit);
    }
    NoiseSpectrum result;
    result.side = side_;
    result.rings = std::move(hidden);
    return result;
}

double PowerSpectrum::missed_slope(const NoiseSpectrum& noise) const {
    const std::vector<double> gains = this->gains(noise);
    std::vector<double> missed(static_cast<std::size_t>(side_));
    for (int i = 0; i < side_; ++i) {
        const double f = frequency(i, side_);
        const double rest = f - true_slope_response(f);
        missed[static_cast<std::size_t>(i)] = rest * rest;
    }
    double square = 0.0;
    for (int row = 0; row < side_; ++row) {
        for (int column = 0; column < side_; ++column) {
            const std::size_t bin = bin_at(frequency(column, side_), frequency(row, side_));
            square +=
                gains[bin] * gains[bin] * bins_[bin].power *
                (missed[static_cast<std::size_t>(row)] + missed[static_cast<std::size_t>(column)]);
        }
    }
    // Twice, for as much beyond the Nyquist frequency; half of it is along x.
    return std::sqrt(square) / side_;
}

HeightTile without_noise(const HeightTile& tile, const PowerSpectrum& spectrum,
                         const NoiseSpectrum& noise) {
    const int side = 2 * tile.width;
    const int room = tile.width / 2;
    const std::vector<double> rest = without_plane(tile);
    // Beyond the border it goes on smoothly, and fades.
    std::vector<double> fade(static_cast<std::size_t>(side), 1.0);
    for (int i = 0; i < room; ++i) {
        const double w = 0.5 - 0.5 * portable::cos(pi * (i + 0.5) / room);
        fade[static_cast<std::size_t>(i)] = fade[static_cast<std::size_t>(side - 1 - i)] = w;
    }
    std::vector<Complex> square(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const double value = reflected(row - room, tile.height, [&](int y) {
                return reflected(column - room, tile.width, [&](int x) {
                    return rest[static_cast<std::size_t>(y * tile.width + x)];
                });
            });
            square[static_cast<std::size_t>(row * side + column)] =
                value * fade[static_cast<std::size_t>(row)] *
                fade[static_cast<std::size_t>(column)];
        }
    }
    transform_square(square, side, false);
    const std::vector<double> gains = spectrum.gains(noise);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            square[static_cast<std::size_t>(row * side + column)] *=
                gains[spectrum.bin_at(frequency(column, side), frequency(row, side))];
        }
    }
    transform_square(square, side, true);
    HeightTile result = tile;
    const double scale = 1.0 / (static_cast<double>(side) * side);
    for (int row = 0; row < tile.height; ++row) {
        for (int column = 0; column < tile.width; ++column) {
            const auto texel = static_cast<std::size_t>(row * tile.width + column);
            const auto place = static_cast<std::size_t>((row + room) * side + column + room);
            // The plane was taken away, and is still there.
            result.values[texel] += square[place].real() * scale - rest[texel];
        }
    }
    return result;
}

}  // namespace relief
