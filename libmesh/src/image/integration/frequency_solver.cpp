// SPDX-License-Identifier: Apache-2.0
// With slopes p = Dx Sy h and q = Sx Dy h, the least-squares heights satisfy
//     (|Dx|^2 |Sy|^2 + |Sx|^2 |Dy|^2) h = Dx' Sy' p + Sx' Dy' q
// which the transforms of real_transform.h turn into one division for each frequency. Most kernels
// are blind to waves of two texels and nearly so to those a little longer: there the division would
// make hills of noise. So the divisor grows by `damping` times shortness^4, where shortness is 1
// for two texels; at eight texels that is 5e-7 of the divisor. Tests:
// tests/mesh/image/integration/heights_from_normals_test.cpp.
#include "image/integration/frequency_solver.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "geometry/portable_math.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr double damping = 1e-3;
constexpr std::size_t real_lanes = RealTransform::lanes;

double squared_difference(const GradientKernel& kernel, double frequency, double texel) {
    std::complex<double> sum = 0.0;
    for (const HeightDifference& one : kernel.differences)
        sum += one.weight *
               (std::polar(1.0, frequency * one.after) - std::polar(1.0, frequency * one.before));
    return std::norm(sum / (kernel.divisor * texel));
}

double squared_smoothing(const GradientKernel& kernel, double frequency) {
    double sum = kernel.smoothing.front();
    for (std::size_t i = 1; i < kernel.smoothing.size(); ++i)
        sum += 2.0 * kernel.smoothing[i] * portable::cos(frequency * static_cast<double>(i));
    return sum * sum;
}

/// Whether the kernel, turned round, is itself but for the sign.
bool is_symmetric(const GradientKernel& kernel) {
    return std::all_of(
        kernel.differences.begin(), kernel.differences.end(),
        [](const HeightDifference& difference) { return difference.before == -difference.after; });
}

}  // namespace

FrequencySolver::Axis::Axis(int count, const GradientKernel& kernel, Wrap wrap, double texel)
    : transform(wrap == Wrap::repeat ? TransformKind::hartley : TransformKind::cosine,
                static_cast<std::size_t>(count)) {
    for (std::size_t k = 0; k < transform.length(); ++k) {
        const double frequency = transform.frequency(k);
        const double sine = portable::sin(0.5 * frequency);
        difference.push_back(squared_difference(kernel, frequency, texel));
        smoothing.push_back(squared_smoothing(kernel, frequency));
        shortness.push_back(sine * sine);
    }
}

FrequencySolver::FrequencySolver(int width, int height, const GradientKernel& kernel, Wraps wrap,
                                 glm::dvec2 texel)
    : x_(width, kernel, wrap.x, texel.x),
      y_(height, kernel, wrap.y, texel.y),
      is_exact_((wrap.x == Wrap::repeat && wrap.y == Wrap::repeat) ||
                (wrap.x != Wrap::clamp && wrap.y != Wrap::clamp && is_symmetric(kernel))) {}

void FrequencySolver::solve(double* values) const {
    transform_rows(values, true);
    solve_columns(values);
    transform_rows(values, false);
}

void FrequencySolver::transform_rows(double* values, bool forward) const {
    const std::size_t width = x_.transform.length(), height = y_.transform.length();
    parallel_for(
        (height + real_lanes - 1) / real_lanes, 1, [&](std::size_t begin, std::size_t end) {
            std::vector<double> rows(width * real_lanes), scratch;
            for (std::size_t group = begin; group < end; ++group) {
                const std::size_t first = group * real_lanes;
                const std::size_t count = std::min(real_lanes, height - first);
                for (std::size_t lane = 0; lane < count; ++lane) {
                    for (std::size_t column = 0; column < width; ++column)
                        rows[column * real_lanes + lane] = values[(first + lane) * width + column];
                }
                if (forward)
                    x_.transform.forward(rows.data(), scratch);
                else
                    x_.transform.inverse(rows.data(), scratch);
                for (std::size_t lane = 0; lane < count; ++lane) {
                    for (std::size_t column = 0; column < width; ++column)
                        values[(first + lane) * width + column] = rows[column * real_lanes + lane];
                }
            }
        });
}

void FrequencySolver::solve_columns(double* values) const {
    const std::size_t width = x_.transform.length(), height = y_.transform.length();
    parallel_for((width + real_lanes - 1) / real_lanes, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<double> columns(height * real_lanes), scratch;
        for (std::size_t group = begin; group < end; ++group) {
            const std::size_t first = group * real_lanes;
            const std::size_t count = std::min(real_lanes, width - first);
            for (std::size_t row = 0; row < height; ++row)
                std::copy_n(values + row * width + first, count, &columns[row * real_lanes]);
            y_.transform.forward(columns.data(), scratch);
            for (std::size_t row = 0; row < height; ++row) {
                for (std::size_t lane = 0; lane < count; ++lane) {
                    const std::size_t column = first + lane;
                    const double shortness = 0.5 * (x_.shortness[column] + y_.shortness[row]);
                    const double fourth = shortness * shortness * shortness * shortness;
                    const double seen = x_.difference[column] * y_.smoothing[row] +
                                        x_.smoothing[column] * y_.difference[row];
                    double& value = columns[row * real_lanes + lane];
                    value = row == 0 && column == 0 ? 0.0 : value / (seen + damping * fourth);
                }
            }
            y_.transform.inverse(columns.data(), scratch);
            for (std::size_t row = 0; row < height; ++row)
                std::copy_n(&columns[row * real_lanes], count, values + row * width + first);
        }
    });
}

}  // namespace relief
