// SPDX-License-Identifier: Apache-2.0
// Two real rows make one complex row: both transforms are linear with real coefficients, so that
// real and imaginary parts never mix. The Hartley transform is the even part of the Fourier
// transform less sqrt(-1) times the odd one; the cosine transform comes from the Fourier transform
// of the even samples followed by the odd ones backwards [Makhoul 1980].
// Tests: tests/mesh/image/integration/real_transform_test.cpp.
#include "image/integration/real_transform.h"
#include "geometry/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relief {
namespace {

constexpr std::size_t half_lanes = ComplexFft::lanes;
static_assert(RealTransform::lanes == 2 * half_lanes);

/// Where sample j of a row stands among the even ones followed by the odd ones backwards.
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

/// The rows taken apart into real and imaginary parts, in the scratch.
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
        // Its own inverse, but for a factor.
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

}  // namespace relief
