// SPDX-License-Identifier: Apache-2.0
// FLIP's filters, each as one pass along the rows and one along the columns: a Gaussian is a
// product of two, and so are its derivatives. See flip_filters.h. The constants are those of
// [Andersson et al. 2020].
// Tests: tests/shade/compare/flip_test.cpp (against the same filters as squares of weights).
#include "compare/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relief {

namespace {

using std::numbers::pi;

/// One Gaussian of the contrast sensitivity functions, a sqrt(pi / b) exp(-pi^2 d^2 / b) at d
/// degrees from the middle.
struct Sensitivity {
    double a;
    double b;
};
constexpr Sensitivity sensitivity_y{1.0, 0.0047};
constexpr Sensitivity sensitivity_cx{1.0, 0.0053};
constexpr Sensitivity sensitivity_cz_narrow{34.1, 0.04};
constexpr Sensitivity sensitivity_cz_wide{13.5, 0.025};

/// Width in degrees of what detects edges and points, from the Gaussian's inflection on one side to
/// that on the other.
constexpr double feature_width = 0.082;

using Weights = std::vector<double>;

template <typename Function>
Weights sampled(int radius, Function function) {
    Weights weights;
    for (int x = -radius; x <= radius; ++x)
        weights.push_back(function(static_cast<double>(x)));
    return weights;
}

double sum_of(const Weights& weights) {
    double sum = 0.0;
    for (const double weight : weights)
        sum += weight;
    return sum;
}

Kernel1d scaled(const Weights& weights, double factor) {
    Kernel1d kernel;
    for (const double weight : weights)
        kernel.push_back(static_cast<float>(weight * factor));
    return kernel;
}

/// The same, longer by zeros on both sides.
Kernel1d padded(const Kernel1d& kernel, int radius) {
    const std::size_t missing = static_cast<std::size_t>(radius) - kernel.size() / 2;
    Kernel1d longer(kernel.size() + 2 * missing);
    std::ranges::copy(kernel, longer.begin() + static_cast<std::ptrdiff_t>(missing));
    return longer;
}

/// Such that positive weights add up to 1 and negative ones to -1.
Kernel1d balanced(const Weights& weights) {
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : weights)
        (weight > 0.0 ? positive : negative) += std::abs(weight);
    Kernel1d kernel;
    for (const double weight : weights)
        kernel.push_back(static_cast<float>(weight / (weight > 0.0 ? positive : negative)));
    return kernel;
}

Weights gaussian(const Sensitivity& sensitivity, int radius, double pixels_per_degree) {
    return sampled(radius, [&](double x) {
        const double degrees = x / pixels_per_degree;
        return std::exp(-pi * pi * degrees * degrees / sensitivity.b);
    });
}

/// out[x] = sum of kernel[k] in[x + k].
void filter_row(const Kernel1d& kernel, const float* in, float* out, std::size_t width) {
    std::fill(out, out + width, 0.0F);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
        const float weight = kernel[k];
        if (weight == 0.0F) continue;
        for (std::size_t x = 0; x < width; ++x)
            out[x] += weight * in[x + k];
    }
}

/// The row with its end pixels repeated `radius` times.
void extend(const float* row, std::size_t width, std::size_t radius, std::vector<float>& extended) {
    extended.resize(width + 2 * radius);
    std::fill_n(extended.begin(), radius, row[0]);
    std::copy(row, row + width, extended.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill_n(extended.end() - static_cast<std::ptrdiff_t>(radius), radius, row[width - 1]);
}

Rows along_rows(const Band& band, const Kernel1d& kernel, const Rows& in) {
    Rows out = band.rows_with_halo();
    const auto width = static_cast<std::size_t>(band.width);
    std::vector<float> extended;
    for (int y = band.begin - band.halo; y < band.end + band.halo; ++y) {
        extend(in.row(y), width, static_cast<std::size_t>(band.halo), extended);
        filter_row(kernel, extended.data(), out.row(y), width);
    }
    return out;
}

/// Adds to `out`, which has no halo.
void add_along_columns(const Band& band, const Kernel1d& kernel, const Rows& in, Rows& out) {
    for (int y = band.begin; y < band.end; ++y) {
        float* to = out.row(y);
        for (int k = -band.halo; k <= band.halo; ++k) {
            const float weight = kernel[static_cast<std::size_t>(k + band.halo)];
            if (weight == 0.0F) continue;
            const float* from = in.row(y + k);
            for (int x = 0; x < band.width; ++x)
                to[x] += weight * from[x];
        }
    }
}

Rows filtered(const Band& band, const Rows& in, const Kernel1d& rows, const Kernel1d& columns) {
    Rows out = band.rows();
    add_along_columns(band, columns, along_rows(band, rows, in), out);
    return out;
}

/// Length of the filter's response in x and y, from what was smoothed and what was filtered along
/// the rows.
Rows strength(const Band& band, const FlipFilters& filters, const Kernel1d& kernel,
              const Rows& luminance, const Rows& smoothed) {
    Rows out = filtered(band, luminance, kernel, filters.smooth);
    Rows down = band.rows();
    add_along_columns(band, kernel, smoothed, down);
    for (int y = band.begin; y < band.end; ++y) {
        float* x_response = out.row(y);
        const float* y_response = down.row(y);
        for (int x = 0; x < band.width; ++x) {
            x_response[x] =
                std::sqrt(x_response[x] * x_response[x] + y_response[x] * y_response[x]);
        }
    }
    return out;
}

}  // namespace

const glm::dmat3& relative_xyz_from_rgb() {
    static const glm::dmat3 matrix = [] {
        const auto xyz = [](double x, double y) { return glm::dvec3(x, y, 1.0 - x - y); };
        const glm::dmat3 primaries(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
        const glm::dvec3 white = xyz(0.3127, 0.3290);
        const glm::dvec3 shares = glm::inverse(primaries) * white;
        return glm::dmat3(primaries[0] * shares[0] / white, primaries[1] * shares[1] / white,
                          primaries[2] * shares[2] / white);
    }();
    return matrix;
}

FlipFilters::FlipFilters(double pixels_per_degree) {
    // Three standard deviations of the widest Gaussian.
    const double widest = std::sqrt(sensitivity_cz_narrow.b / (2.0 * pi * pi));
    const int color_radius = static_cast<int>(std::ceil(3.0 * widest * pixels_per_degree));
    const double deviation = 0.5 * feature_width * pixels_per_degree;
    const int feature_radius = static_cast<int>(std::ceil(3.0 * deviation));
    radius = std::max(color_radius, feature_radius);

    const auto sensitive = [&](const Sensitivity& sensitivity) {
        return gaussian(sensitivity, color_radius, pixels_per_degree);
    };
    const auto normalised = [&](const Weights& weights) {
        return padded(scaled(weights, 1.0 / sum_of(weights)), radius);
    };
    y = normalised(sensitive(sensitivity_y));
    cx = normalised(sensitive(sensitivity_cx));
    // Both parts of Cz get the square root of their factor in both passes; together, as a square of
    // weights, they add up to 1.
    const Weights narrow = sensitive(sensitivity_cz_narrow);
    const Weights wide = sensitive(sensitivity_cz_wide);
    const auto factor = [](const Sensitivity& s) { return s.a * std::sqrt(pi / s.b); };
    const double total = factor(sensitivity_cz_narrow) * sum_of(narrow) * sum_of(narrow) +
                         factor(sensitivity_cz_wide) * sum_of(wide) * sum_of(wide);
    cz_narrow = padded(scaled(narrow, std::sqrt(factor(sensitivity_cz_narrow) / total)), radius);
    cz_wide = padded(scaled(wide, std::sqrt(factor(sensitivity_cz_wide) / total)), radius);

    const auto bell = [&](double x) { return std::exp(-0.5 * x * x / (deviation * deviation)); };
    smooth = normalised(sampled(feature_radius, bell));
    edge =
        padded(balanced(sampled(feature_radius, [&](double x) { return -x * bell(x); })), radius);
    point = padded(balanced(sampled(feature_radius,
                                    [&](double x) {
                                        return (x * x / (deviation * deviation) - 1.0) * bell(x);
                                    })),
                   radius);
}

SeenBand see(const FlipFilters& filters, const Band& band, const std::array<Rows, 3>& opponent) {
    const Rows& luminance = opponent[0];
    Rows cz = filtered(band, opponent[2], filters.cz_narrow, filters.cz_narrow);
    add_along_columns(band, filters.cz_wide, along_rows(band, filters.cz_wide, opponent[2]), cz);
    const Rows smoothed = along_rows(band, filters.smooth, luminance);
    return {{filtered(band, luminance, filters.y, filters.y),
             filtered(band, opponent[1], filters.cx, filters.cx), std::move(cz)},
            strength(band, filters, filters.edge, luminance, smoothed),
            strength(band, filters, filters.point, luminance, smoothed)};
}

}  // namespace relief
