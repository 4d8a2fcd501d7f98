// SPDX-License-Identifier: Apache-2.0
// Fourier transforms with Stockham's self-sorting passes of radix 2, 3, 4, 5, 7, 11 and 13. A
// length with another prime factor is computed as a convolution with a chirp, of a power-of-two
// length [Bluestein 1970]. Four rows are interleaved, so that every loop runs over adjacent memory.
// In double precision, with the same bits for any instruction set.
//
// Two real rows form one complex row: both real transforms are linear with real coefficients, so
// real and imaginary parts do not mix. The Hartley transform is the even part of the Fourier
// transform minus sqrt(-1) times the odd part. The cosine transform is computed from the Fourier
// transform of the even samples followed by the odd ones in reverse [Makhoul 1980].
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "image/fft.h"
#include "portable_math.h"

namespace relief::detail {
/// One pass: `count` groups of `radix` samples at a distance. Each sample is `stride` lanes wide.
struct ComplexFft::Pass {
    std::size_t radix, groups, stride;
    std::vector<double> cosines, sines;  ///< Of group g to the power k, at index g * radix + k.
};

/// The data of Bluestein's algorithm, which computes a transform of any length by two transforms of
/// a power-of-two length.
struct ComplexFft::Chirp {
    explicit Chirp(std::size_t padded) : fft(padded), padded_length(padded) {}
    ComplexFft fft;
    std::size_t padded_length;
    std::vector<double> cosines, sines;  ///< exp(-pi i j^2 / n)
    std::vector<double> filter_real,
        filter_imag;  ///< The transform of the chirp, over the padded length.
};

namespace {

constexpr std::size_t lanes = ComplexFft::lanes;
constexpr std::array<std::size_t, 7> radices = {4, 2, 3, 5, 7, 11, 13};

/// Returns the prime factors in the order of `radices`; empty if another factor remains.
std::vector<std::size_t> factors_of(std::size_t length) {
    std::vector<std::size_t> factors;
    for (const std::size_t radix : radices) {
        while (length % radix == 0) {
            factors.push_back(radix);
            length /= radix;
        }
    }
    return length == 1 ? factors : std::vector<std::size_t>{};
}

struct PassArguments {
    std::size_t groups, width;  ///< Width: samples side by side, lanes included.
    const double* cosines;
    const double* sines;
    ComplexRows from, to;
};

RELIEF_INLINE void pass_of_2(const PassArguments& a) {
    const std::size_t half = a.groups * a.width;
    for (std::size_t g = 0; g < a.groups; ++g) {
        const double c = a.cosines[g * 2 + 1], s = a.sines[g * 2 + 1];
        const double* xr = a.from.real + g * a.width;
        const double* xi = a.from.imag + g * a.width;
        double* yr = a.to.real + 2 * g * a.width;
        double* yi = a.to.imag + 2 * g * a.width;
        for (std::size_t q = 0; q < a.width; ++q) {
            const double dr = xr[q] - xr[q + half], di = xi[q] - xi[q + half];
            yr[q] = xr[q] + xr[q + half];
            yi[q] = xi[q] + xi[q + half];
            yr[q + a.width] = dr * c - di * s;
            yi[q + a.width] = dr * s + di * c;
        }
    }
}

RELIEF_INLINE void pass_of_4(const PassArguments& a) {
    const std::size_t apart = a.groups * a.width;
    for (std::size_t g = 0; g < a.groups; ++g) {
        const double c1 = a.cosines[g * 4 + 1], s1 = a.sines[g * 4 + 1];
        const double c2 = a.cosines[g * 4 + 2], s2 = a.sines[g * 4 + 2];
        const double c3 = a.cosines[g * 4 + 3], s3 = a.sines[g * 4 + 3];
        const double* xr = a.from.real + g * a.width;
        const double* xi = a.from.imag + g * a.width;
        double* yr = a.to.real + 4 * g * a.width;
        double* yi = a.to.imag + 4 * g * a.width;
        for (std::size_t q = 0; q < a.width; ++q) {
            const double r0 = xr[q], r1 = xr[q + apart];
            const double r2 = xr[q + 2 * apart], r3 = xr[q + 3 * apart];
            const double i0 = xi[q], i1 = xi[q + apart];
            const double i2 = xi[q + 2 * apart], i3 = xi[q + 3 * apart];
            const double er = r0 + r2, ei = i0 + i2, fr = r0 - r2, fi = i0 - i2;
            const double gr = r1 + r3, gi = i1 + i3, hr = r1 - r3, hi = i1 - i3;
            const double b1r = fr + hi, b1i = fi - hr, b3r = fr - hi, b3i = fi + hr;
            const double b2r = er - gr, b2i = ei - gi;
            yr[q] = er + gr;
            yi[q] = ei + gi;
            yr[q + a.width] = b1r * c1 - b1i * s1;
            yi[q + a.width] = b1r * s1 + b1i * c1;
            yr[q + 2 * a.width] = b2r * c2 - b2i * s2;
            yi[q + 2 * a.width] = b2r * s2 + b2i * c2;
            yr[q + 3 * a.width] = b3r * c3 - b3i * s3;
            yi[q + 3 * a.width] = b3r * s3 + b3i * c3;
        }
    }
}

/// Computes a pass of any radix by the definition of the transform.
template <std::size_t Radix>
RELIEF_INLINE void pass_of(const PassArguments& a) {
    std::array<double, Radix> unit_cos{}, unit_sin{};
    for (std::size_t k = 0; k < Radix; ++k) {
        const double angle = -2.0 * std::numbers::pi * static_cast<double>(k) / Radix;
        unit_cos[k] = portable::cos(angle);
        unit_sin[k] = portable::sin(angle);
    }
    const std::size_t apart = a.groups * a.width;
    for (std::size_t g = 0; g < a.groups; ++g) {
        const double* xr = a.from.real + g * a.width;
        const double* xi = a.from.imag + g * a.width;
        for (std::size_t k = 0; k < Radix; ++k) {
            const double c = a.cosines[g * Radix + k], s = a.sines[g * Radix + k];
            double* yr = a.to.real + (Radix * g + k) * a.width;
            double* yi = a.to.imag + (Radix * g + k) * a.width;
            for (std::size_t q = 0; q < a.width; ++q) {
                double real = xr[q], imag = xi[q];
                for (std::size_t j = 1; j < Radix; ++j) {
                    const double uc = unit_cos[j * k % Radix], us = unit_sin[j * k % Radix];
                    real += xr[q + j * apart] * uc - xi[q + j * apart] * us;
                    imag += xr[q + j * apart] * us + xi[q + j * apart] * uc;
                }
                yr[q] = real * c - imag * s;
                yi[q] = real * s + imag * c;
            }
        }
    }
}

RELIEF_INLINE void any_pass(std::size_t radix, const PassArguments& arguments) {
    switch (radix) {
        case 2:
            return pass_of_2(arguments);
        case 3:
            return pass_of<3>(arguments);
        case 4:
            return pass_of_4(arguments);
        case 5:
            return pass_of<5>(arguments);
        case 7:
            return pass_of<7>(arguments);
        case 11:
            return pass_of<11>(arguments);
        default:
            return pass_of<13>(arguments);
    }
}

void pass_128(std::size_t radix, const PassArguments& arguments) {
    any_pass(radix, arguments);
}
RELIEF_TARGET_256 void pass_256(std::size_t radix, const PassArguments& arguments) {
    any_pass(radix, arguments);
}
RELIEF_TARGET_512 void pass_512(std::size_t radix, const PassArguments& arguments) {
    any_pass(radix, arguments);
}

/// Multiplies sample j of every lane by the j-th complex number.
void multiply(ComplexRows rows, std::size_t count, const double* real, const double* imag) {
    for (std::size_t j = 0; j < count; ++j) {
        for (std::size_t i = j * lanes; i < (j + 1) * lanes; ++i) {
            const double r = rows.real[i], m = rows.imag[i];
            rows.real[i] = r * real[j] - m * imag[j];
            rows.imag[i] = r * imag[j] + m * real[j];
        }
    }
}

}  // namespace

ComplexFft::ComplexFft(std::size_t length) : length_(length) {
    std::size_t stride = 1, rest = length;
    for (const std::size_t radix : factors_of(length)) {
        Pass pass{radix, rest / radix, stride, {}, {}};
        for (std::size_t g = 0; g < pass.groups; ++g) {
            for (std::size_t k = 0; k < radix; ++k) {
                const double angle = -2.0 * std::numbers::pi * static_cast<double>(g * k) /
                                     static_cast<double>(rest);
                pass.cosines.push_back(portable::cos(angle));
                pass.sines.push_back(portable::sin(angle));
            }
        }
        rest /= radix;
        stride *= radix;
        passes_.push_back(std::move(pass));
    }
    if (length <= 1 || !passes_.empty()) return;
    chirp_ = std::make_unique<Chirp>(std::bit_ceil(2 * length - 1));
    const std::size_t padded = chirp_->padded_length;
    std::vector<double> real(padded * lanes), imag(padded * lanes);
    for (std::size_t j = 0; j < length; ++j) {
        // j^2 modulo 2n keeps the precision of the angle.
        const auto angle = std::numbers::pi * static_cast<double>(j * j % (2 * length)) /
                           static_cast<double>(length);
        chirp_->cosines.push_back(portable::cos(angle));
        chirp_->sines.push_back(-portable::sin(angle));
        for (const std::size_t at : {j, (padded - j) % padded}) {
            real[at * lanes] = portable::cos(angle);
            imag[at * lanes] = portable::sin(angle);
        }
    }
    std::vector<double> scratch(chirp_->fft.scratch_size());
    chirp_->fft.transform({real.data(), imag.data()}, scratch.data());
    for (std::size_t k = 0; k < padded; ++k) {
        chirp_->filter_real.push_back(real[k * lanes] / static_cast<double>(padded));
        chirp_->filter_imag.push_back(imag[k * lanes] / static_cast<double>(padded));
    }
}

ComplexFft::~ComplexFft() = default;

std::size_t ComplexFft::scratch_size() const {
    if (!chirp_) return 2 * length_ * lanes;
    return 2 * chirp_->padded_length * lanes + chirp_->fft.scratch_size();
}

void ComplexFft::transform(ComplexRows rows, double* scratch) const {
    const std::size_t count = length_ * lanes;
    if (!chirp_) {
        const VectorTarget target = best_vector_target();
        const auto run = target == VectorTarget::widest ? pass_512
                         : target == VectorTarget::wide ? pass_256
                                                        : pass_128;
        ComplexRows from = rows, to{scratch, scratch + count};
        for (const Pass& pass : passes_) {
            run(pass.radix, {pass.groups, pass.stride * lanes, pass.cosines.data(),
                             pass.sines.data(), from, to});
            std::swap(from, to);
        }
        if (from.real == rows.real) return;
        std::copy_n(from.real, count, rows.real);
        std::copy_n(from.imag, count, rows.imag);
        return;
    }
    const std::size_t padded = chirp_->padded_length * lanes;
    const ComplexRows wide{scratch, scratch + padded};
    double* rest = scratch + 2 * padded;
    multiply(rows, length_, chirp_->cosines.data(), chirp_->sines.data());
    std::copy_n(rows.real, count, wide.real);
    std::copy_n(rows.imag, count, wide.imag);
    std::fill(wide.real + count, wide.real + padded, 0.0);
    std::fill(wide.imag + count, wide.imag + padded, 0.0);
    chirp_->fft.transform(wide, rest);
    multiply(wide, chirp_->padded_length, chirp_->filter_real.data(), chirp_->filter_imag.data());
    chirp_->fft.transform({wide.imag, wide.real}, rest);
    std::copy_n(wide.real, count, rows.real);
    std::copy_n(wide.imag, count, rows.imag);
    multiply(rows, length_, chirp_->cosines.data(), chirp_->sines.data());
}

namespace {

constexpr std::size_t half_lanes = ComplexFft::lanes;
static_assert(RealTransform::lanes == 2 * half_lanes);

/// Returns the position of sample j of a row in the order of even samples followed by odd samples
/// in reverse.
std::size_t place_of(std::size_t j, std::size_t length) {
    return j % 2 == 0 ? j / 2 : length - 1 - j / 2;
}

}  // namespace

RealTransform::RealTransform(TransformKind kind, std::size_t length)
    : kind_(kind), length_(length), fft_(length) {
    for (std::size_t k = 0; kind == TransformKind::cosine && k < length; ++k) {
        cosines_.push_back(portable::cos(0.5 * frequency(k)));
        sines_.push_back(portable::sin(0.5 * frequency(k)));
    }
}

double RealTransform::frequency(std::size_t k) const {
    const double turns = static_cast<double>(k) / static_cast<double>(length_);
    return (kind_ == TransformKind::hartley ? 2.0 : 1.0) * std::numbers::pi * turns;
}

/// Copies the rows to real and imaginary parts in the scratch memory.
ComplexRows RealTransform::unpacked(const double* samples, std::vector<double>& scratch) const {
    const std::size_t count = length_ * half_lanes;
    scratch.resize(2 * count + fft_.scratch_size());
    const ComplexRows rows{scratch.data(), scratch.data() + count};
    for (std::size_t j = 0; j < length_; ++j) {
        const std::size_t place = kind_ == TransformKind::cosine ? place_of(j, length_) : j;
        std::copy_n(samples + j * lanes, half_lanes, rows.real + place * half_lanes);
        std::copy_n(samples + j * lanes + half_lanes, half_lanes, rows.imag + place * half_lanes);
    }
    return rows;
}

void RealTransform::forward(double* samples, std::vector<double>& scratch) const {
    const ComplexRows rows = unpacked(samples, scratch);
    fft_.transform(rows, scratch.data() + 2 * length_ * half_lanes);
    for (std::size_t k = 0; k < length_; ++k) {
        const std::size_t opposite = k == 0 ? 0 : length_ - k;
        const double* r = rows.real + k * half_lanes;
        const double* m = rows.imag + k * half_lanes;
        const double* opposite_r = rows.real + opposite * half_lanes;
        const double* opposite_m = rows.imag + opposite * half_lanes;
        double* to = samples + k * lanes;
        if (kind_ == TransformKind::hartley) {
            // (Z[k] + Z[-k]) / 2 + i (Z[k] - Z[-k]) / 2
            for (std::size_t i = 0; i < half_lanes; ++i) {
                to[i] = 0.5 * (r[i] + opposite_r[i] - m[i] + opposite_m[i]);
                to[i + half_lanes] = 0.5 * (m[i] + opposite_m[i] + r[i] - opposite_r[i]);
            }
        } else {
            // (exp(-i a) Z[k] + exp(i a) Z[-k]) / 2
            const double c = 0.5 * cosines_[k], s = 0.5 * sines_[k];
            for (std::size_t i = 0; i < half_lanes; ++i) {
                to[i] = c * (r[i] + opposite_r[i]) + s * (m[i] - opposite_m[i]);
                to[i + half_lanes] = c * (m[i] + opposite_m[i]) - s * (r[i] - opposite_r[i]);
            }
        }
    }
}

void RealTransform::inverse(double* samples, std::vector<double>& scratch) const {
    const double scale = 1.0 / static_cast<double>(length_);
    if (kind_ == TransformKind::hartley) {
        // The transform is its own inverse except for a factor.
        forward(samples, scratch);
        for (std::size_t i = 0; i < length_ * lanes; ++i)
            samples[i] *= scale;
        return;
    }
    const std::size_t count = length_ * half_lanes;
    scratch.resize(2 * count + fft_.scratch_size());
    const ComplexRows rows{scratch.data(), scratch.data() + count};
    for (std::size_t k = 0; k < length_; ++k) {
        // exp(i a) (C[k] - i C[n - k]), with C[n] = 0
        const double* c = samples + k * lanes;
        const double* d = samples + (length_ - k) % length_ * lanes;
        const double present = k == 0 ? 0.0 : 1.0;
        const double cosine = scale * cosines_[k], sine = scale * sines_[k];
        for (std::size_t i = 0; i < half_lanes; ++i) {
            const double real = c[i] + present * d[i + half_lanes];
            const double imag = c[i + half_lanes] - present * d[i];
            rows.real[k * half_lanes + i] = cosine * real - sine * imag;
            rows.imag[k * half_lanes + i] = cosine * imag + sine * real;
        }
    }
    fft_.transform({rows.imag, rows.real}, scratch.data() + 2 * count);
    for (std::size_t j = 0; j < length_; ++j) {
        const std::size_t place = place_of(j, length_);
        std::copy_n(rows.real + place * half_lanes, half_lanes, samples + j * lanes);
        std::copy_n(rows.imag + place * half_lanes, half_lanes, samples + j * lanes + half_lanes);
    }
}

}  // namespace relief::detail
