// SPDX-License-Identifier: Apache-2.0
// Power spectra of small squares under the square of a Hann window, averaged over squares and over
// bins of length and direction [Welch 1967], and the subtraction of white noise from them [Boll
// 1979]. Nothing throws. Tests: tests/mesh/accuracy/power_spectrum_test.cpp.
#include "accuracy/power_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/border.h"
#include "image/integration/complex_fft.h"

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
        const double hann = 0.5 - 0.5 * std::cos(2.0 * pi * (i + 0.5) / side_);
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
    const double length = std::hypot(x, y) * side_ / (2.0 * pi);
    const int ring = std::min(side_ - 1, static_cast<int>(length + 0.5));
    // A frequency and its opposite are the same wave.
    double angle = std::atan2(y, x);
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

double PowerSpectrum::without_noise(double x, double y, double deviation) const {
    constexpr double chance = 5.0;
    const Bin& bin = bins_[bin_at(x, y)];
    const double noise = deviation * deviation;
    // Half of the coefficients are independent, and the window makes neighbours alike: about one
    // in four is a draw of its own from an exponential distribution.
    const double by_chance = noise * (1.0 + chance / std::sqrt(std::max(1.0, bin.count / 4.0)));
    if (!(bin.power > by_chance)) return 0.0;
    return std::sqrt((bin.power - noise) / bin.power);
}

HeightTile without_noise(const HeightTile& tile, const PowerSpectrum& spectrum, double deviation) {
    const int side = 2 * tile.width;
    const int room = tile.width / 2;
    const std::vector<double> rest = without_plane(tile);
    // Beyond the border it goes on smoothly, and fades.
    std::vector<double> fade(static_cast<std::size_t>(side), 1.0);
    for (int i = 0; i < room; ++i) {
        const double w = 0.5 - 0.5 * std::cos(pi * (i + 0.5) / room);
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
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            square[static_cast<std::size_t>(row * side + column)] *=
                spectrum.without_noise(frequency(column, side), frequency(row, side), deviation);
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
