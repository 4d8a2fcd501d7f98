// SPDX-License-Identifier: Apache-2.0
// LDR-FLIP [Andersson et al. 2020]: colour differences as seen from a distance, raised where edges
// or points differ. Linear sRGB in, an error from 0 to 1 for each pixel out; what is not finite and
// what lets the background through as image_compare.h says. The steps: opponent colours, filters
// (flip_filters.h), Hunt-adjusted Lab, HyAB distance. Tests: tests/shade/compare/flip_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/flip_filters.h"
#include "parallel.h"
#include "relief/mesh/error.h"
#include "relief/shade/image_compare.h"

namespace relief {

namespace {

// The paper's exponents and the bend of the colour error's curve.
constexpr float color_exponent = 0.7F;
constexpr float bend_at = 0.4F;   // Of the largest colour error,
constexpr float bend_to = 0.95F;  // which becomes this much of the whole range.
constexpr float feature_exponent = 0.5F;

/// Rows that one thread works on at a time: large against the filters' reach, small in the cache.
constexpr int rows_per_band = 48;

/// A picture in linear light, ready to be read pixel by pixel over a background.
class Seen {
  public:
    explicit Seen(const Image& image)
        : linear_(to_linear(image)),
          samples_(linear_.as<float>().data()),
          channels_(static_cast<std::size_t>(image.channels)),
          is_grey_(image.channels < 3),
          has_alpha_(image.channels == 2 || image.channels == 4) {}

    [[nodiscard]] bool lets_background_through() const {
        if (!has_alpha_) return false;
        const std::size_t pixels = linear_.sample_count() / channels_;
        for (std::size_t i = 0; i < pixels; ++i) {
            if (shown(samples_[i * channels_ + channels_ - 1]) < 1.0F) return true;
        }
        return false;
    }

    /// As a screen shows it.
    [[nodiscard]] glm::vec3 color(std::size_t pixel, float background) const {
        const float* sample = samples_ + pixel * channels_;
        const glm::vec3 color(shown(sample[0]), shown(sample[is_grey_ ? 0 : 1]),
                              shown(sample[is_grey_ ? 0 : 2]));
        if (!has_alpha_) return color;
        const float alpha = shown(sample[channels_ - 1]);
        return alpha * color + (1.0F - alpha) * background;
    }

    /// Which of red, green, blue and alpha are NaN.
    [[nodiscard]] glm::bvec4 missing(std::size_t pixel) const {
        const float* sample = samples_ + pixel * channels_;
        return {std::isnan(sample[0]), std::isnan(sample[is_grey_ ? 0 : 1]),
                std::isnan(sample[is_grey_ ? 0 : 2]),
                has_alpha_ && std::isnan(sample[channels_ - 1])};
    }

  private:
    /// Within [0,1]; NaN, which compares as false, becomes 0.
    static float shown(float value) { return value > 0.0F ? std::min(value, 1.0F) : 0.0F; }

    Image linear_;
    const float* samples_;
    std::size_t channels_;
    bool is_grey_;
    bool has_alpha_;
};

/// L, a and b, a and b weakened where it is dark, as the eye does (Hunt's effect).
glm::vec3 hunt_adjusted_lab(const glm::vec3& relative_xyz) {
    constexpr float bound = 6.0F / 29.0F;
    const auto f = [](float t) {
        return t > bound * bound * bound ? std::cbrt(t) : t / (3.0F * bound * bound) + 4.0F / 29.0F;
    };
    const float x = f(relative_xyz.x);
    const float y = f(relative_xyz.y);
    const float z = f(relative_xyz.z);
    const float lightness = 116.0F * y - 16.0F;
    const float share = 0.01F * lightness;
    return {lightness, share * 500.0F * (x - y), share * 200.0F * (y - z)};
}

float hyab(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 apart = a - b;
    return std::abs(apart.x) + std::sqrt(apart.y * apart.y + apart.z * apart.z);
}

/// The last steps, from what is seen of two pixels to their error.
class PixelError {
  public:
    PixelError()
        : xyz_from_rgb_(relative_xyz_from_rgb()),
          rgb_from_xyz_(glm::inverse(relative_xyz_from_rgb())) {
        const glm::vec3 green = hunt_adjusted_lab(xyz_from_rgb_ * glm::vec3(0, 1, 0));
        const glm::vec3 blue = hunt_adjusted_lab(xyz_from_rgb_ * glm::vec3(0, 0, 1));
        most_ = std::pow(hyab(green, blue), color_exponent);
    }

    /// Lab of a filtered opponent colour, cut to what a screen shows.
    [[nodiscard]] glm::vec3 lab(float y, float cx, float cz) const {
        const glm::vec3 rgb = rgb_from_xyz_ * glm::vec3(y + cx, y, y - cz);
        return hunt_adjusted_lab(xyz_from_rgb_ * glm::clamp(rgb, 0.0F, 1.0F));
    }

    /// \param feature  the larger difference of the strengths of edges and points
    [[nodiscard]] float operator()(const glm::vec3& lab_a, const glm::vec3& lab_b,
                                   float feature) const {
        const float color = redistributed(std::pow(hyab(lab_a, lab_b), color_exponent));
        const float raise =
            std::pow(std::min(feature / std::numbers::sqrt2_v<float>, 1.0F), feature_exponent);
        return std::min(std::pow(color, 1.0F - raise), 1.0F);
    }

  private:
    /// Most of the range for small errors, the rest for large ones.
    [[nodiscard]] float redistributed(float error) const {
        const float bend = bend_at * most_;
        if (error < bend) return error * bend_to / bend;
        return bend_to + (error - bend) / (most_ - bend) * (1.0F - bend_to);
    }

    glm::mat3 xyz_from_rgb_;
    glm::mat3 rgb_from_xyz_;
    float most_ = 0;
};

/// Opponent colours of a band with its halo; beyond the picture, its outermost row goes on.
std::array<Rows, 3> opponent_colors(const Seen& picture, const Band& band, int height,
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
void raise_band(const std::array<const Seen*, 2>& pictures, const FlipFilters& filters,
                const Band& band, int height, float background, std::span<float> map) {
    const PixelError error_of;
    const auto seen = [&](const Seen* picture) {
        return see(filters, band, opponent_colors(*picture, band, height, background));
    };
    const SeenBand a = seen(pictures[0]);
    const SeenBand b = seen(pictures[1]);
    for (int y = band.begin; y < band.end; ++y) {
        const auto lab = [&](const SeenBand& picture, int x) {
            return error_of.lab(picture.opponent[0].row(y)[x], picture.opponent[1].row(y)[x],
                                picture.opponent[2].row(y)[x]);
        };
        const auto line = static_cast<std::size_t>(y) * static_cast<std::size_t>(band.width);
        for (int x = 0; x < band.width; ++x) {
            const float feature = std::max(std::abs(a.edge.row(y)[x] - b.edge.row(y)[x]),
                                           std::abs(a.point.row(y)[x] - b.point.row(y)[x]));
            float& error = map[line + static_cast<std::size_t>(x)];
            error = std::max(error, error_of(lab(a, x), lab(b, x), feature));
        }
    }
}

void check(const Image& reference, const Image& test, double pixels_per_degree) {
    for (const Image* image : {&reference, &test}) {
        if (image->empty()) throw InvalidInput("FLIP compares pictures, and one has no pixels");
        if (image->color_space == ColorSpace::data)
            throw InvalidInput("FLIP compares colours, and one image holds data");
    }
    if (reference.width != test.width || reference.height != test.height) {
        throw InvalidInput(fmt::format("pictures of {} x {} and {} x {} pixels cannot be compared",
                                       reference.width, reference.height, test.width, test.height));
    }
    if (!(pixels_per_degree >= 10.0 && pixels_per_degree <= 1000.0)) {
        throw InvalidInput(
            fmt::format("{} pixels per degree: FLIP takes 10 to 1000", pixels_per_degree));
    }
}

}  // namespace

FlipDifference flip_difference(const Image& reference, const Image& test,
                               double pixels_per_degree) {
    check(reference, test, pixels_per_degree);
    const FlipFilters filters(pixels_per_degree);
    const Seen a(reference);
    const Seen b(test);
    const bool is_opaque = !a.lets_background_through() && !b.lets_background_through();

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

}  // namespace relief
