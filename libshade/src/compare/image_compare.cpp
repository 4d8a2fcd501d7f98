// SPDX-License-Identifier: Apache-2.0
// Differences between two images: of their samples, in units of the images' own range; of their
// directions, as angles in degrees by atan2; and as people see them, by LDR-FLIP. Sums are in
// double, in the order of the samples. image_compare.h says how NaN, directions without a length
// and transparency count.
//
// LDR-FLIP [Andersson et al. 2020] gives color differences as seen from a distance, raised where
// edges or points differ: linear sRGB in, an error from 0 to 1 for each pixel out. The steps are
// opponent colors, filters, Hunt-adjusted Lab, HyAB distance. Filters work row by row, so that a
// picture is processed in bands on all threads; each is one pass along the rows and one along the
// columns, since a Gaussian and its derivatives are separable. Opponent colors are (Y/Yn, X/Xn -
// Y/Yn, Y/Yn - Z/Zn) of linear sRGB: YCxCz without its scales and offset, which the filters
// preserve. Beyond the border the outermost pixel repeats.
#include "relief/shade/image_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief::shade {
using namespace relief::detail;

// Samples

namespace {

/// Returns the distance of two samples; 0 for two NaN or two equal infinities, infinite for one
/// NaN.
double distance(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
    if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
    return std::abs(a - b);
}

template <typename T>
ImageDifference difference(const std::vector<T>& a, const std::vector<T>& b, std::size_t channels) {
    constexpr double peak = std::is_integral_v<T> ? std::numeric_limits<T>::max() : 1.0;
    ImageDifference result;
    double sum = 0.0;
    double sum_of_squares = 0.0;
    for (std::size_t pixel = 0; pixel < a.size(); pixel += channels) {
        bool differs = false;
        for (std::size_t i = pixel; i < pixel + channels; ++i) {
            const double error = distance(a[i], b[i]);
            differs = differs || error > 0.0;
            result.max = std::max(result.max, error);
            sum += error;
            sum_of_squares += error * error;
        }
        if (differs) ++result.differing_pixels;
    }
    if (!a.empty()) {
        result.mean = sum / static_cast<double>(a.size());
        result.rms = std::sqrt(sum_of_squares / static_cast<double>(a.size()));
        result.psnr = 20.0 / std::numbers::ln10 * portable::log(peak / result.rms);
    }
    return result;
}

}  // namespace

ImageDifference compare(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels ||
        a.bits() != b.bits()) {
        throw InvalidInput(fmt::format(
            "images cannot be compared: {} x {} pixels, {} channels of {} bits against {} x {} "
            "pixels, {} channels of {} bits",
            a.width, a.height, a.channels, a.bits(), b.width, b.height, b.channels, b.bits()));
    }
    return std::visit(
        [&]<typename T>(const std::vector<T>& samples) {
            return difference(samples, std::get<std::vector<T>>(b.samples),
                              static_cast<std::size_t>(a.channels));
        },
        a.samples);
}

// Directions

namespace {

constexpr std::size_t texels_per_piece = 1 << 14;

glm::dvec3 direction(std::span<const float> samples, std::size_t texel) {
    return {samples[3 * texel], samples[3 * texel + 1], samples[3 * texel + 2]};
}

/// Tells whether the length is finite and not 0. Squares of floats neither overflow nor vanish in
/// double.
bool has_direction(const glm::dvec3& vector) {
    const double squared = glm::dot(vector, vector);
    return std::isfinite(squared) && squared > 0.0;
}

void check(const Image& a, const Image& b) {
    for (const Image* image : {&a, &b}) {
        if (image->empty())
            throw InvalidInput("angles cannot be computed for an image without texels");
        if (image->channels != 3 || image->bits() != 32) {
            throw InvalidInput(
                fmt::format("angles are between directions in three float channels, not {} "
                            "channels of {} bits; decode_normal_map reads normal maps",
                            image->channels, image->bits()));
        }
    }
    if (a.width != b.width || a.height != b.height) {
        throw InvalidInput(
            fmt::format("directions of {} x {} and {} x {} texels cannot be compared", a.width,
                        a.height, b.width, b.height));
    }
}

}  // namespace

AngleDifference angle_difference(const Image& a, const Image& b) {
    check(a, b);
    AngleDifference result;
    result.map = make_image(a.width, a.height, 1, 32, ColorSpace::data);
    const std::span<float> map = result.map.as<float>();
    const std::span<const float> from = a.as<float>();
    const std::span<const float> to = b.as<float>();
    parallel_for(map.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 d = direction(from, i);
            const glm::dvec3 e = direction(to, i);
            const bool one = has_direction(d);
            const bool other = has_direction(e);
            const double angle =
                one && other ? degrees_between(d, e) : (one == other ? 0.0 : 180.0);
            map[i] = static_cast<float>(angle);
        }
    });

    result.angles = error_stats({map.begin(), map.end()});
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (!has_direction(direction(from, i)) || !has_direction(direction(to, i)))
            ++result.angles.undefined;
    }
    return result;
}

// Filters

namespace {

/// Weights of a symmetric or antisymmetric filter along a row or a column: 2 radius + 1 of them.
using Kernel1d = std::vector<float>;

/// The filters for one number of pixels per degree. All have the same length; shorter ones are
/// padded with zeros.
struct FlipFilters {
    explicit FlipFilters(double pixels_per_degree);

    int radius = 0;
    /// Contrast sensitivity: a Gaussian each for Y and Cx, the sum of two for Cz.
    Kernel1d y, cx, cz_narrow, cz_wide;
    /// The Gaussian with the width of the eye's edge detectors, and its derivatives; positive
    /// weights add up to 1, negative ones to -1.
    Kernel1d smooth, edge, point;
};

/// Consecutive rows of a picture, from `first` on, with one float a pixel. The values are undefined
/// until they are written.
class Rows {
  public:
    Rows(int first, int count, int width)
        : first_(first),
          width_(static_cast<std::size_t>(width)),
          values_(
              std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(count) * width_)) {}

    [[nodiscard]] float* row(int y) {
        return values_.get() + static_cast<std::size_t>(y - first_) * width_;
    }
    [[nodiscard]] const float* row(int y) const {
        return values_.get() + static_cast<std::size_t>(y - first_) * width_;
    }

  private:
    int first_;
    std::size_t width_;
    std::unique_ptr<float[]> values_;
};

/// The rows [begin, end) of a picture; the halo of more rows on both sides may lie outside of it.
struct Band {
    int begin = 0;
    int end = 0;
    int width = 0;
    int halo = 0;

    [[nodiscard]] Rows rows() const { return {begin, end - begin, width}; }
    [[nodiscard]] Rows rows_with_halo() const {
        return {begin - halo, end - begin + 2 * halo, width};
    }
};

/// A band after the filters.
struct FilteredBand {
    std::array<Rows, 3> opponent;  ///< Filtered opponent colors.
    Rows edge;                     ///< Strength of edges, 0 to sqrt(2).
    Rows point;                    ///< Strength of points and lines.
};

using std::numbers::pi;

/// One Gaussian of the contrast sensitivity functions, a sqrt(pi / b) exp(-pi^2 d^2 / b) at d
/// degrees from the center.
struct Sensitivity {
    double a;
    double b;
};
constexpr Sensitivity sensitivity_y{1.0, 0.0047};
constexpr Sensitivity sensitivity_cx{1.0, 0.0053};
constexpr Sensitivity sensitivity_cz_narrow{34.1, 0.04};
constexpr Sensitivity sensitivity_cz_wide{13.5, 0.025};

/// The width in degrees of the detectors of edges and points, between the inflection points of the
/// Gaussian.
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

/// Returns the kernel, padded with zeros on both sides.
Kernel1d padded(const Kernel1d& kernel, int radius) {
    const std::size_t missing = static_cast<std::size_t>(radius) - kernel.size() / 2;
    Kernel1d longer(kernel.size() + 2 * missing);
    std::ranges::copy(kernel, longer.begin() + static_cast<std::ptrdiff_t>(missing));
    return longer;
}

/// Scales positive weights to the sum 1 and negative ones to -1.
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
        return portable::exp(-pi * pi * degrees * degrees / sensitivity.b);
    });
}

/// Computes out[x], the sum of kernel[k] in[x + k].
void filter_row(const Kernel1d& kernel, const float* in, float* out, std::size_t width) {
    std::fill(out, out + width, 0.0F);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
        const float weight = kernel[k];
        if (weight == 0.0F) continue;
        for (std::size_t x = 0; x < width; ++x)
            out[x] += weight * in[x + k];
    }
}

/// Writes the row with its end pixels repeated `radius` times.
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

/// Adds the filtered columns to `out`, which has no halo, or with `is_first` writes them.
void add_along_columns(const Band& band, const Kernel1d& kernel, const Rows& in, Rows& out,
                       bool is_first = false) {
    for (int y = band.begin; y < band.end; ++y) {
        float* to = out.row(y);
        if (is_first) std::fill_n(to, band.width, 0.0F);
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
    add_along_columns(band, columns, along_rows(band, rows, in), out, true);
    return out;
}

/// Returns the length of the response of a filter in x and y.
/// \param smoothed  the luminance, smoothed along the rows
Rows strength(const Band& band, const FlipFilters& filters, const Kernel1d& kernel,
              const Rows& luminance, const Rows& smoothed) {
    Rows out = filtered(band, luminance, kernel, filters.smooth);
    Rows down = band.rows();
    add_along_columns(band, kernel, smoothed, down, true);
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

/// Returns the matrix from linear sRGB to XYZ relative to the white point; its rows add up to 1.
/// Computed from the primaries and the white point of the standard [IEC 61966-2-1].
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

    const auto sensitivity_weights = [&](const Sensitivity& sensitivity) {
        return gaussian(sensitivity, color_radius, pixels_per_degree);
    };
    const auto normalized = [&](const Weights& weights) {
        return padded(scaled(weights, 1.0 / sum_of(weights)), radius);
    };
    y = normalized(sensitivity_weights(sensitivity_y));
    cx = normalized(sensitivity_weights(sensitivity_cx));
    // Both parts of Cz get the square root of their factor in both passes; together, as a square of
    // weights, they add up to 1.
    const Weights narrow = sensitivity_weights(sensitivity_cz_narrow);
    const Weights wide = sensitivity_weights(sensitivity_cz_wide);
    const auto factor = [](const Sensitivity& s) { return s.a * std::sqrt(pi / s.b); };
    const double total = factor(sensitivity_cz_narrow) * sum_of(narrow) * sum_of(narrow) +
                         factor(sensitivity_cz_wide) * sum_of(wide) * sum_of(wide);
    cz_narrow = padded(scaled(narrow, std::sqrt(factor(sensitivity_cz_narrow) / total)), radius);
    cz_wide = padded(scaled(wide, std::sqrt(factor(sensitivity_cz_wide) / total)), radius);

    const auto bell = [&](double x) {
        return portable::exp(-0.5 * x * x / (deviation * deviation));
    };
    smooth = normalized(sampled(feature_radius, bell));
    edge =
        padded(balanced(sampled(feature_radius, [&](double x) { return -x * bell(x); })), radius);
    point = padded(balanced(sampled(feature_radius,
                                    [&](double x) {
                                        return (x * x / (deviation * deviation) - 1.0) * bell(x);
                                    })),
                   radius);
}

/// \param opponent  of the band with its halo; the halo is the radius of the filters
FilteredBand filter_band(const FlipFilters& filters, const Band& band,
                         const std::array<Rows, 3>& opponent) {
    const Rows& luminance = opponent[0];
    Rows cz = filtered(band, opponent[2], filters.cz_narrow, filters.cz_narrow);
    add_along_columns(band, filters.cz_wide, along_rows(band, filters.cz_wide, opponent[2]), cz);
    const Rows smoothed = along_rows(band, filters.smooth, luminance);
    return {{filtered(band, luminance, filters.y, filters.y),
             filtered(band, opponent[1], filters.cx, filters.cx), std::move(cz)},
            strength(band, filters, filters.edge, luminance, smoothed),
            strength(band, filters, filters.point, luminance, smoothed)};
}

}  // namespace

// Errors

namespace {

// The exponents of the paper, and the bend of the curve of the color error: errors up to bend_at of
// the maximum take bend_to of the range.
constexpr float color_exponent = 0.7F;
constexpr float bend_at = 0.4F;
constexpr float bend_to = 0.95F;

/// The rows that a thread processes at a time: large against the radius of the filters, small
/// enough for the cache.
constexpr int rows_per_band = 48;

/// A picture in linear light, read pixel by pixel over a background.
class LinearPicture {
  public:
    explicit LinearPicture(const Image& image)
        : linear_(to_linear(image)),
          samples_(linear_.as<float>().data()),
          channels_(static_cast<std::size_t>(image.channels)),
          is_gray_(image.channels < 3),
          has_alpha_(image.channels == 2 || image.channels == 4) {}

    [[nodiscard]] bool is_transparent() const {
        if (!has_alpha_) return false;
        const std::size_t pixels = linear_.sample_count() / channels_;
        for (std::size_t i = 0; i < pixels; ++i) {
            if (shown(samples_[i * channels_ + channels_ - 1]) < 1.0F) return true;
        }
        return false;
    }

    /// Returns the color on a screen.
    [[nodiscard]] glm::vec3 color(std::size_t pixel, float background) const {
        const float* sample = samples_ + pixel * channels_;
        const glm::vec3 color(shown(sample[0]), shown(sample[is_gray_ ? 0 : 1]),
                              shown(sample[is_gray_ ? 0 : 2]));
        if (!has_alpha_) return color;
        const float alpha = shown(sample[channels_ - 1]);
        return alpha * color + (1.0F - alpha) * background;
    }

    /// Tells which of red, green, blue and alpha are NaN.
    [[nodiscard]] glm::bvec4 missing(std::size_t pixel) const {
        const float* sample = samples_ + pixel * channels_;
        return {std::isnan(sample[0]), std::isnan(sample[is_gray_ ? 0 : 1]),
                std::isnan(sample[is_gray_ ? 0 : 2]),
                has_alpha_ && std::isnan(sample[channels_ - 1])};
    }

  private:
    /// Clamps to [0,1]; NaN, for which comparisons are false, becomes 0.
    static float shown(float value) { return value > 0.0F ? std::min(value, 1.0F) : 0.0F; }

    Image linear_;
    const float* samples_;
    std::size_t channels_;
    bool is_gray_;
    bool has_alpha_;
};

/// Returns the cube root of a positive number, with the same bits everywhere. The first estimate, a
/// third of the exponent, has an error of 3 %; each of Halley's steps cubes the error.
float cube_root(float t) {
    constexpr std::uint32_t bias = 0x2a5119f2;
    const double value = static_cast<double>(t);
    auto root =
        static_cast<double>(std::bit_cast<float>(std::bit_cast<std::uint32_t>(t) / 3 + bias));
    for (int i = 0; i < 2; ++i) {
        const double cube = root * root * root;
        root *= (cube + 2.0 * value) / (2.0 * cube + value);
    }
    return static_cast<float>(root);
}

/// Returns CIELAB with weaker a and b in the dark (the Hunt effect).
glm::vec3 hunt_adjusted_lab(const glm::vec3& relative_xyz) {
    constexpr float bound = 6.0F / 29.0F;
    const auto f = [](float t) {
        return t > bound * bound * bound ? cube_root(t) : t / (3.0F * bound * bound) + 4.0F / 29.0F;
    };
    const float x = f(relative_xyz.x);
    const float y = f(relative_xyz.y);
    const float z = f(relative_xyz.z);
    const float lightness = 116.0F * y - 16.0F;
    const float share = 0.01F * lightness;
    return {lightness, share * 500.0F * (x - y), share * 200.0F * (y - z)};
}

float hyab(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 difference = a - b;
    return std::abs(difference.x) +
           std::sqrt(difference.y * difference.y + difference.z * difference.z);
}

/// Returns x^y for x and y of at least 0.
float power(float x, float y) {
    if (y == 0.0F) return 1.0F;
    return static_cast<float>(portable::pow(static_cast<double>(x), static_cast<double>(y)));
}

/// The last steps, from two filtered pixels to their error.
class PixelError {
  public:
    PixelError()
        : xyz_from_rgb_(relative_xyz_from_rgb()),
          rgb_from_xyz_(glm::inverse(relative_xyz_from_rgb())) {
        const glm::vec3 green = hunt_adjusted_lab(xyz_from_rgb_ * glm::vec3(0, 1, 0));
        const glm::vec3 blue = hunt_adjusted_lab(xyz_from_rgb_ * glm::vec3(0, 0, 1));
        max_ = power(hyab(green, blue), color_exponent);
    }

    /// Returns Lab of a filtered opponent color, clamped to the gamut of a screen.
    [[nodiscard]] glm::vec3 lab(float y, float cx, float cz) const {
        const glm::vec3 rgb = rgb_from_xyz_ * glm::vec3(y + cx, y, y - cz);
        return hunt_adjusted_lab(xyz_from_rgb_ * glm::clamp(rgb, 0.0F, 1.0F));
    }

    /// \param feature  the larger difference of the strengths of edges and points
    [[nodiscard]] float operator()(const glm::vec3& lab_a, const glm::vec3& lab_b,
                                   float feature) const {
        const float color = redistributed(power(hyab(lab_a, lab_b), color_exponent));
        // The exponent of features is 1 / 2.
        const float raise = std::sqrt(std::min(feature / std::numbers::sqrt2_v<float>, 1.0F));
        return std::min(power(color, 1.0F - raise), 1.0F);
    }

  private:
    /// Redistributes color errors: most of the range for small ones, the rest for large ones.
    [[nodiscard]] float redistributed(float error) const {
        const float bend = bend_at * max_;
        if (error < bend) return error * bend_to / bend;
        return bend_to + (error - bend) / (max_ - bend) * (1.0F - bend_to);
    }

    glm::mat3 xyz_from_rgb_;
    glm::mat3 rgb_from_xyz_;
    float max_ = 0;
};

/// Returns the opponent colors of a band with its halo; beyond the picture its outermost row
/// repeats.
std::array<Rows, 3> opponent_colors(const LinearPicture& picture, const Band& band, int height,
                                    float background) {
    const glm::mat3 xyz_from_rgb(relative_xyz_from_rgb());
    std::array<Rows, 3> rows{band.rows_with_halo(), band.rows_with_halo(), band.rows_with_halo()};
    for (int y = band.begin - band.halo; y < band.end + band.halo; ++y) {
        const auto line = static_cast<std::size_t>(std::clamp(y, 0, height - 1)) *
                          static_cast<std::size_t>(band.width);
        for (int x = 0; x < band.width; ++x) {
            const glm::vec3 xyz =
                xyz_from_rgb * picture.color(line + static_cast<std::size_t>(x), background);
            rows[0].row(y)[x] = xyz.y;
            rows[1].row(y)[x] = xyz.x - xyz.y;
            rows[2].row(y)[x] = xyz.y - xyz.z;
        }
    }
    return rows;
}

/// Raises the errors in `map` to those of a band over one background.
void raise_band(const std::array<const LinearPicture*, 2>& pictures, const FlipFilters& filters,
                const Band& band, int height, float background, std::span<float> map) {
    const PixelError error_of;
    const auto filtered_band = [&](const LinearPicture* picture) {
        return filter_band(filters, band, opponent_colors(*picture, band, height, background));
    };
    const FilteredBand a = filtered_band(pictures[0]);
    const FilteredBand b = filtered_band(pictures[1]);
    for (int y = band.begin; y < band.end; ++y) {
        const auto lab = [&](const FilteredBand& picture, int x) {
            return error_of.lab(picture.opponent[0].row(y)[x], picture.opponent[1].row(y)[x],
                                picture.opponent[2].row(y)[x]);
        };
        const auto line = static_cast<std::size_t>(y) * static_cast<std::size_t>(band.width);
        // The error is 0 where the filtered pictures are equal, as around an object.
        const auto is_equal = [&](int x) {
            const auto are_equal = [&](const Rows& one, const Rows& other) {
                return one.row(y)[x] == other.row(y)[x];
            };
            return are_equal(a.opponent[0], b.opponent[0]) &&
                   are_equal(a.opponent[1], b.opponent[1]) &&
                   are_equal(a.opponent[2], b.opponent[2]) && are_equal(a.edge, b.edge) &&
                   are_equal(a.point, b.point);
        };
        for (int x = 0; x < band.width; ++x) {
            if (is_equal(x)) continue;
            const float feature = std::max(std::abs(a.edge.row(y)[x] - b.edge.row(y)[x]),
                                           std::abs(a.point.row(y)[x] - b.point.row(y)[x]));
            float& error = map[line + static_cast<std::size_t>(x)];
            error = std::max(error, error_of(lab(a, x), lab(b, x), feature));
        }
    }
}

void check(const Image& reference, const Image& test, double pixels_per_degree) {
    for (const Image* image : {&reference, &test}) {
        if (image->empty()) throw InvalidInput("FLIP compares pictures, but one is empty");
        if (image->color_space == ColorSpace::data)
            throw InvalidInput("FLIP compares colors, and one image holds data");
    }
    if (reference.width != test.width || reference.height != test.height) {
        throw InvalidInput(fmt::format("pictures of {} x {} and {} x {} pixels cannot be compared",
                                       reference.width, reference.height, test.width, test.height));
    }
    if (!(pixels_per_degree >= 10.0 && pixels_per_degree <= 1000.0)) {
        throw InvalidInput(
            fmt::format("the resolution is {} pixels per degree, but must be within [10, 1000]",
                        pixels_per_degree));
    }
}

}  // namespace

FlipDifference flip_difference(const Image& reference, const Image& test,
                               double pixels_per_degree) {
    check(reference, test, pixels_per_degree);
    const FlipFilters filters(pixels_per_degree);
    const LinearPicture a(reference);
    const LinearPicture b(test);
    const bool is_opaque = !a.is_transparent() && !b.is_transparent();

    FlipDifference result;
    result.map = make_image(reference.width, reference.height, 1, 32, ColorSpace::data);
    const std::span<float> map = result.map.as<float>();
    const int height = reference.height;
    const int bands = (height + rows_per_band - 1) / rows_per_band;
    parallel_for(static_cast<std::size_t>(bands), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const int top = static_cast<int>(i) * rows_per_band;
            const Band band{top, std::min(top + rows_per_band, height), reference.width,
                            filters.radius};
            raise_band({&a, &b}, filters, band, height, 0.0F, map);
            if (!is_opaque) raise_band({&a, &b}, filters, band, height, 1.0F, map);
        }
    });

    double sum = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (a.missing(i) != b.missing(i)) map[i] = 1.0F;
        sum += static_cast<double>(map[i]);
        result.max = std::max(result.max, static_cast<double>(map[i]));
    }
    result.mean = sum / static_cast<double>(map.size());
    return result;
}

}  // namespace relief::shade
