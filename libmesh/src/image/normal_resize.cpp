// SPDX-License-Identifier: Apache-2.0
// Resampling of normals and slopes, and mip levels with the roughness that compensates for
// averaging.
//
// Resampling is separable: for each row of the result, the rows around it are summed first, then
// the columns. Only these rows of the source are needed, so files are resized by bands. Weights are
// double, sums are float, in the order of the texels, so the bits are the same for any number of
// threads. Mip levels average vectors, never codes, and normalize only the result; its length
// before that gives the variance.
#include "relief/mesh/normal_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "image/normal_bands.h"
#include "image/texel_loops.h"
#include "image/unit_vectors.h"
#include "portable_math.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

double sinc(double x) {
    if (x == 0.0) return 1.0;
    return portable::sin(std::numbers::pi * x) / (std::numbers::pi * x);
}

double radius_of(ResizeFilter filter) {
    switch (filter) {
        case ResizeFilter::box:
            return 0.5;
        case ResizeFilter::triangle:
            return 1.0;
        case ResizeFilter::cubic:
            return 2.0;
        case ResizeFilter::lanczos:
        case ResizeFilter::best:
            break;
    }
    return 3.0;
}

/// Returns the filter at x texels from its center. The box is not included, because its weights are
/// overlaps of texels.
double filter_at(ResizeFilter filter, double x) {
    const double d = std::abs(x);
    if (d >= radius_of(filter)) return 0.0;
    if (filter == ResizeFilter::triangle) return 1.0 - d;
    if (filter == ResizeFilter::lanczos) return sinc(d) * sinc(d / 3.0);
    return d < 1.0 ? (1.5 * d - 2.5) * d * d + 1.0 : ((-0.5 * d + 2.5) * d - 4.0) * d + 2.0;
}

/// \param scale  source texels per result texel
double weight_of(ResizeFilter filter, double middle, int place, double scale) {
    const double width = std::max(scale, 1.0);
    if (filter != ResizeFilter::box) return filter_at(filter, (place + 0.5 - middle) / width);
    if (scale <= 1.0) return place == static_cast<int>(std::floor(middle)) ? 1.0 : 0.0;
    const double begin = std::max<double>(place, middle - width / 2.0);
    const double end = std::min<double>(place + 1.0, middle + width / 2.0);
    return std::max(end - begin, 0.0);
}

/// \param from, to  texels of the source and of the result; the result shows the source `repeat`
///                  times
ResampledAxis resampled_axis(int from, int to, double repeat, ResizeFilter filter, Wrap wrap) {
    ResampledAxis result;
    const double scale = from * repeat / to;
    if (filter == ResizeFilter::best)
        filter = scale > 1.0 ? ResizeFilter::lanczos : ResizeFilter::cubic;
    const double reach = radius_of(filter) * std::max(scale, 1.0);
    for (int i = 0; i < to; ++i) {
        const double middle = (i + 0.5) * scale;
        const int begin = static_cast<int>(std::floor(middle - reach));
        const int end = static_cast<int>(std::ceil(middle + reach));
        double sum = 0.0;
        for (int place = begin; place <= end; ++place)
            sum += weight_of(filter, middle, place, scale);
        for (int place = begin; place <= end; ++place) {
            const double weight = weight_of(filter, middle, place, scale) / sum;
            if (weight == 0.0) continue;
            result.taps.push_back({static_cast<std::size_t>(place_within(place, from, wrap)),
                                   static_cast<float>(weight)});
        }
        result.first.push_back(result.taps.size());
        result.reach.push_back({begin, end + 1});
    }
    return result;
}

bool is_own_size(const Image& image, int width, int height, const ResizeOptions& options) {
    return width == image.width && height == image.height && options.repeat == glm::dvec2(1.0);
}

/// Stores a row of means as unit normals. \param mean_vector  returns the mean vector of a texel
/// whose slopes are NaN
template <typename MeanVector>
void store_row(const std::vector<float>& means, ResizeDomain domain, std::size_t first_texel,
               float* normals, Report& found, const MeanVector& mean_vector) {
    const std::size_t channels = domain == ResizeDomain::slopes ? 2 : 3;
    for (std::size_t x = 0; x < means.size() / channels; ++x) {
        const float* const mean = &means[x * channels];
        Direction normal{mean[0], mean[1], channels == 3 ? mean[2] : 0.0};
        if (domain == ResizeDomain::slopes) normal = {-normal.x, -normal.y, 1.0};
        if (std::isnan(normal.x)) normal = mean_vector(x);
        if (!make_unit(normal))
            found.add("normals that cancel", "texel", first_texel + x, "made flat");
        store(normal, normals + x * 3);
    }
}

/// Returns the rows of an image in memory.
FloatRows rows_of(const Image& image) {
    const std::size_t row_size =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    return [samples = image.as<float>().data(), row_size](std::size_t row) {
        return samples + row * row_size;
    };
}

}  // namespace

void detail::check_resize(int width, int height, const ResizeOptions& options) {
    if (width < 1 || height < 1)
        throw InvalidInput(
            fmt::format("the size is {} x {} texels, but must be at least 1 x 1", width, height));
    for (const double repeat : {options.repeat.x, options.repeat.y}) {
        if (!(repeat > 0.0 && repeat <= 1e4))
            throw InvalidInput(fmt::format(
                "the number of repeats is {}, but must be above 0 and at most 1e4", repeat));
    }
}

Resampling::Resampling(int width, int height, int to_width, int to_height,
                       const ResizeOptions& options)
    : width_(static_cast<std::size_t>(width)),
      across_(resampled_axis(width, to_width, options.repeat.x, options.filter, options.wrap.x)),
      down_(resampled_axis(height, to_height, options.repeat.y, options.filter, options.wrap.y)) {}

void Resampling::make_row(std::size_t row, std::size_t channels, const FloatRows& source,
                          float* result) const {
    const std::vector<float> sums = sum_of_rows(row, channels, source);
    for (std::size_t x = 0; x + 1 < across_.first.size(); ++x) {
        for (std::size_t c = 0; c < channels; ++c) {
            float sum = 0.0F;
            for (std::size_t t = across_.first[x]; t < across_.first[x + 1]; ++t)
                sum += across_.taps[t].weight * sums[across_.taps[t].place * channels + c];
            result[x * channels + c] = sum;
        }
    }
}

Direction Resampling::mean_vector(const FloatRows& vectors, std::size_t row,
                                  std::size_t column) const {
    Direction sum{0.0, 0.0, 0.0};
    for (std::size_t j = down_.first[row]; j < down_.first[row + 1]; ++j) {
        const float* const vectors_of_row = vectors(down_.taps[j].place);
        for (std::size_t i = across_.first[column]; i < across_.first[column + 1]; ++i) {
            const float* const vector = vectors_of_row + across_.taps[i].place * 3;
            const double weight = static_cast<double>(down_.taps[j].weight) *
                                  static_cast<double>(across_.taps[i].weight);
            sum = {sum.x + weight * vector[0], sum.y + weight * vector[1],
                   sum.z + weight * vector[2]};
        }
    }
    return sum;
}

std::vector<float> Resampling::sum_of_rows(std::size_t row, std::size_t channels,
                                           const FloatRows& source) const {
    std::vector<float> sums(width_ * channels);
    for (std::size_t t = down_.first[row]; t < down_.first[row + 1]; ++t) {
        const float* const from = source(down_.taps[t].place);
        const float weight = down_.taps[t].weight;
        for (std::size_t i = 0; i < sums.size(); ++i)
            sums[i] += weight * from[i];
    }
    return sums;
}

Image detail::slopes_to_average(const Image& normals, Report& report) {
    Image result = make_image(normals.width, normals.height, 2, 32, ColorSpace::data);
    const std::span<const float> from = normals.as<float>();
    const std::span<float> to = result.as<float>();
    for_each_texel(from.size() / 3, report, [&](std::size_t texel, Report& found) {
        const float* const n = &from[texel * 3];
        const double across = std::sqrt(double{n[0]} * n[0] + double{n[1]} * n[1]);
        const bool is_steep = !(across <= max_averaged_slope * n[2]);
        if (is_steep)
            found.add("normal too steep to average slopes", "texel", texel,
                      "the vectors around it are averaged");
        to[texel * 2] = is_steep ? std::numeric_limits<float>::quiet_NaN() : -n[0] / n[2];
        to[texel * 2 + 1] = is_steep ? std::numeric_limits<float>::quiet_NaN() : -n[1] / n[2];
    });
    return result;
}

void detail::resize_normal_rows(const Resampling& resampling, ResizeDomain domain,
                                const FloatRows& normals, const FloatRows& slopes, int first_row,
                                Image& result, Report& report) {
    const bool has_slopes = domain == ResizeDomain::slopes;
    const std::size_t channels = has_slopes ? 2 : 3;
    float* const to = result.as<float>().data();
    const auto columns = static_cast<std::size_t>(result.width);
    for_each_row(result.width, result.height, report, [&](std::size_t index, Report& found) {
        const std::size_t row = static_cast<std::size_t>(first_row) + index;
        std::vector<float> means(columns * channels);
        resampling.make_row(row, channels, has_slopes ? slopes : normals, means.data());
        store_row(means, domain, index * columns, to + index * columns * 3, found,
                  [&](std::size_t x) { return resampling.mean_vector(normals, row, x); });
    });
}

void detail::resize_sample_rows(const Resampling& resampling, const FloatRows& samples,
                                int first_row, Image& result) {
    float* const to = result.as<float>().data();
    const auto channels = static_cast<std::size_t>(result.channels);
    const std::size_t row_size = static_cast<std::size_t>(result.width) * channels;
    Report unused;
    for_each_row(result.width, result.height, unused, [&](std::size_t index, Report&) {
        resampling.make_row(static_cast<std::size_t>(first_row) + index, channels, samples,
                            to + index * row_size);
    });
}

Image resize_normals(const Image& normals, int width, int height, const ResizeOptions& options,
                     Report& report) {
    check_floats(normals, 3, "normals");
    check_resize(width, height, options);
    if (is_own_size(normals, width, height, options)) return normals;
    const bool has_slopes = options.domain == ResizeDomain::slopes;
    const Image slopes = has_slopes ? slopes_to_average(normals, report) : Image{};
    const Resampling resampling(normals.width, normals.height, width, height, options);
    Image result = make_image(width, height, 3, 32, ColorSpace::data);
    resize_normal_rows(resampling, options.domain, rows_of(normals),
                       has_slopes ? rows_of(slopes) : FloatRows(), 0, result, report);
    return result;
}

Image resize_samples(const Image& image, int width, int height, const ResizeOptions& options) {
    check_floats(image, image.channels, "samples");
    check_resize(width, height, options);
    if (is_own_size(image, width, height, options)) return image;
    const Resampling resampling(image.width, image.height, width, height, options);
    Image result = make_image(width, height, image.channels, 32, image.color_space);
    resize_sample_rows(resampling, rows_of(image), 0, result);
    return result;
}

Image fitted_detail(const Image& detail, int base_width, int base_height,
                    const ResizeOptions& options, Report& report) {
    const auto period = [](int size, double repeat) {
        const double texels = size / repeat;
        return texels >= 1.0 && texels == std::floor(texels) ? static_cast<int>(texels) : size;
    };
    check_floats(detail, 3, "normals of a detail");
    check_resize(base_width, base_height, options);
    ResizeOptions fitted = options;
    fitted.wrap = Wrap::repeat;
    const int width = period(base_width, options.repeat.x);
    const int height = period(base_height, options.repeat.y);
    fitted.repeat = {width < base_width ? 1.0 : options.repeat.x,
                     height < base_height ? 1.0 : options.repeat.y};
    return resize_normals(detail, width, height, fitted, report);
}

namespace {

constexpr double shortest_mean = 1e-6;

/// Normalizes some vectors. \param lengths  gets the length of each one
void split_group(const UnitVectorFunctions& functions, std::size_t first_texel, float* vectors,
                 std::span<float> lengths, Report& found) {
    VectorGroup group;
    group.z.fill(1.0);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        group.x[i] = vectors[3 * i];
        group.y[i] = vectors[3 * i + 1];
        group.z[i] = vectors[3 * i + 2];
    }
    VectorNumbers exact;
    functions.lengths(group, exact);
    bool are_long = true;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        are_long &= exact[i] >= shortest_mean;
        lengths[i] = static_cast<float>(std::min(exact[i], 1.0));
    }
    if (are_long && functions.make_units(group, lengths.size(), vectors)) return;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        Direction direction{group.x[i], group.y[i], group.z[i]};
        if (exact[i] < shortest_mean) direction = {0.0, 0.0, 0.0};
        if (!make_unit(direction)) {
            found.add("normals that cancel", "texel", first_texel + i, "made flat, with length 0");
        }
        store(direction, vectors + 3 * i);
    }
}

}  // namespace

std::vector<Image> normal_mip_levels(const Image& normals) {
    check_floats(normals, 3, "normals");
    return mip_levels(normals);
}

Image split_lengths(Image& means, Report& report) {
    check_floats(means, 3, "normals");
    Image lengths = make_image(means.width, means.height, 1, 32, ColorSpace::data);
    const std::span<float> vectors = means.as<float>();
    const std::span<float> to = lengths.as<float>();
    constexpr std::size_t grain = texels_per_piece / vectors_per_group;
    const std::size_t groups = (to.size() + vectors_per_group - 1) / vectors_per_group;
    parallel_for_reporting(
        groups, grain, report, [&](std::size_t begin, std::size_t end, Report& found) {
            const UnitVectorFunctions functions = unit_vector_functions();
            for (std::size_t group = begin; group < end; ++group) {
                const std::size_t first = group * vectors_per_group;
                const std::size_t count = std::min(vectors_per_group, to.size() - first);
                split_group(functions, first, &vectors[3 * first], to.subspan(first, count), found);
            }
        });
    return lengths;
}

double slope_variance_of_length(double length) {
    const double r = std::clamp(length, 1e-3, 1.0);
    return (1.0 / (r * r) - 1.0) / 2.0;
}

double toksvig_factor(double length, double exponent) {
    const double r = std::clamp(length, 0.0, 1.0);
    return r / (r + exponent * (1.0 - r));
}

double roughness_with_variance(double roughness, double variance) {
    const double alpha = roughness * roughness;
    return std::sqrt(std::sqrt(std::min(alpha * alpha + 2.0 * variance, 1.0)));
}

Image roughness_from_lengths(const Image& lengths, double roughness) {
    check_floats(lengths, 1, "lengths");
    if (!(roughness >= 0.0 && roughness <= 1.0))
        throw InvalidInput(
            fmt::format("the roughness is {}, but must be within [0, 1]", roughness));
    Image result = make_image(lengths.width, lengths.height, 1, 32, ColorSpace::data);
    const std::span<const float> from = lengths.as<float>();
    const std::span<float> to = result.as<float>();
    Report unused;
    for_each_texel(to.size(), unused, [&](std::size_t texel, Report&) {
        const double variance = slope_variance_of_length(static_cast<double>(from[texel]));
        to[texel] = static_cast<float>(roughness_with_variance(roughness, variance));
    });
    return result;
}

}  // namespace relief
