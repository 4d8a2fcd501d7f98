// SPDX-License-Identifier: Apache-2.0
// FLIP against a direct implementation of its definition [Andersson et al. 2020], against the
// authors' program, and against properties of any metric.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/image_compare.h"

namespace relief::test {
using namespace relief::shade;

namespace {

constexpr double pi = std::numbers::pi;

/// Computed from the primaries and the white point of the standard, as integers.
const glm::dmat3 xyz_from_rgb = glm::transpose(
    glm::dmat3(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0,  //
               2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0,    //
               1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0));
const glm::dvec3 white = xyz_from_rgb * glm::dvec3(1.0);

struct Plane {
    int width = 0;
    int height = 0;
    std::vector<glm::dvec3> pixels;

    [[nodiscard]] const glm::dvec3& at(int x, int y) const {
        const int column = std::clamp(x, 0, width - 1);
        const int row = std::clamp(y, 0, height - 1);
        return pixels[static_cast<std::size_t>(row * width + column)];
    }
};

Plane ycxcz(const Image& image) {
    const Image linear = to_linear(image);
    const auto samples = linear.as<float>();
    Plane plane{image.width, image.height, {}};
    for (std::size_t i = 0; i < samples.size(); i += 3) {
        const glm::dvec3 xyz =
            xyz_from_rgb * glm::dvec3(samples[i], samples[i + 1], samples[i + 2]) / white;
        plane.pixels.emplace_back(116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y),
                                  200.0 * (xyz.y - xyz.z));
    }
    return plane;
}

/// A square filter of (2 radius + 1)^2 weights.
struct Square {
    int radius = 0;
    std::vector<double> weights;

    Square(int r, const std::function<double(int, int)>& weight) : radius(r) {
        for (int y = -r; y <= r; ++y) {
            for (int x = -r; x <= r; ++x)
                weights.push_back(weight(x, y));
        }
        double positive = 0.0;
        double negative = 0.0;
        for (const double w : weights)
            (w > 0.0 ? positive : negative) += std::abs(w);
        for (double& w : weights)
            w /= w > 0.0 ? positive : negative;
    }

    [[nodiscard]] double apply(const Plane& plane, int channel, int x, int y) const {
        double sum = 0.0;
        std::size_t i = 0;
        for (int dy = -radius; dy <= radius; ++dy) {
            for (int dx = -radius; dx <= radius; ++dx)
                sum += weights[i++] * plane.at(x + dx, y + dy)[channel];
        }
        return sum;
    }
};

double sensitivity(double a, double b, double squared_degrees) {
    return a * std::sqrt(pi / b) * std::exp(-pi * pi * squared_degrees / b);
}

glm::dvec3 hunt_lab(const glm::dvec3& rgb) {
    const glm::dvec3 t = xyz_from_rgb * rgb / white;
    const auto f = [](double v) {
        return v > std::pow(6.0 / 29.0, 3.0) ? std::cbrt(v) : v * 841.0 / 108.0 + 4.0 / 29.0;
    };
    const double lightness = 116.0 * f(t.y) - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (f(t.x) - f(t.y)),
            0.01 * lightness * 200.0 * (f(t.y) - f(t.z))};
}

glm::dvec3 lab_of_opponent(const glm::dvec3& c) {
    const double y = (c.x + 16.0) / 116.0;
    const glm::dvec3 xyz = glm::dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * white;
    return hunt_lab(glm::clamp(glm::inverse(xyz_from_rgb) * xyz, 0.0, 1.0));
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

double color_error(const glm::dvec3& a, const glm::dvec3& b) {
    const double most = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
    const double error = std::pow(hyab(lab_of_opponent(a), lab_of_opponent(b)), 0.7);
    if (error < 0.4 * most) return 0.95 * error / (0.4 * most);
    return 0.95 + 0.05 * (error - 0.4 * most) / (0.6 * most);
}

std::vector<double> flip_brute_force(const Image& reference, const Image& test, double ppd) {
    const std::array<Plane, 2> planes{ycxcz(reference), ycxcz(test)};
    const int r = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * ppd));
    const auto degrees = [&](int x, int y) { return (x * x + y * y) / (ppd * ppd); };
    const Square y_filter(r, [&](int x, int y) { return sensitivity(1, 0.0047, degrees(x, y)); });
    const Square cx_filter(r, [&](int x, int y) { return sensitivity(1, 0.0053, degrees(x, y)); });
    const Square cz_filter(r, [&](int x, int y) {
        return sensitivity(34.1, 0.04, degrees(x, y)) + sensitivity(13.5, 0.025, degrees(x, y));
    });
    const double s = 0.5 * 0.082 * ppd;
    const int fr = static_cast<int>(std::ceil(3.0 * s));
    const auto bell = [&](int x, int y) { return std::exp(-(x * x + y * y) / (2.0 * s * s)); };
    const auto second = [&](int x) { return x * x / (s * s) - 1.0; };
    const Square edge_x(fr, [&](int x, int y) { return -x * bell(x, y); });
    const Square edge_y(fr, [&](int x, int y) { return -y * bell(x, y); });
    const Square point_x(fr, [&](int x, int y) { return second(x) * bell(x, y); });
    const Square point_y(fr, [&](int x, int y) { return second(y) * bell(x, y); });

    std::vector<double> map;
    for (int y = 0; y < reference.height; ++y) {
        for (int x = 0; x < reference.width; ++x) {
            std::array<glm::dvec3, 2> seen{};
            std::array<double, 2> edge{};
            std::array<double, 2> point{};
            for (std::size_t i = 0; i < 2; ++i) {
                const Plane& p = planes.at(i);
                seen.at(i) = {y_filter.apply(p, 0, x, y), cx_filter.apply(p, 1, x, y),
                              cz_filter.apply(p, 2, x, y)};
                edge.at(i) = std::hypot(edge_x.apply(p, 0, x, y), edge_y.apply(p, 0, x, y)) / 116.0;
                point.at(i) =
                    std::hypot(point_x.apply(p, 0, x, y), point_y.apply(p, 0, x, y)) / 116.0;
            }
            const double feature =
                std::sqrt(std::max(std::abs(edge[0] - edge[1]), std::abs(point[0] - point[1])) /
                          std::numbers::sqrt2);
            map.push_back(std::pow(color_error(seen[0], seen[1]), 1.0 - feature));
        }
    }
    return map;
}

using Codes = std::function<unsigned(unsigned x, unsigned y, unsigned channel)>;

/// Returns a fixed hash of the position, from 0 to 255.
unsigned noise(unsigned x, unsigned y, unsigned channel, unsigned seed) {
    std::uint32_t hash =
        x * 374761393U + y * 668265263U + channel * 2246822519U + seed * 3266489917U;
    hash = (hash ^ (hash >> 13U)) * 1274126177U;
    return (hash ^ (hash >> 16U)) & 255U;
}

unsigned ramps(unsigned x, unsigned y, unsigned channel) {
    return (2U * x + 3U * y + 60U * channel) % 256U;
}

unsigned grainy_ramps(unsigned x, unsigned y, unsigned channel) {
    return std::min(255U, ramps(x, y, channel) + noise(x, y, channel, 7) / 8U);
}

unsigned moved_ramps(unsigned x, unsigned y, unsigned channel) {
    return ramps(x + 1, y, channel);
}

Codes noise_of(unsigned seed) {
    return [seed](unsigned x, unsigned y, unsigned channel) { return noise(x, y, channel, seed); };
}

Image picture(int width, int height, const Codes& codes) {
    Image image = make_image(width, height, 3, 8, ColorSpace::srgb);
    std::size_t i = 0;
    for (unsigned y = 0; y < static_cast<unsigned>(height); ++y) {
        for (unsigned x = 0; x < static_cast<unsigned>(width); ++x) {
            for (unsigned c = 0; c < 3; ++c)
                image.as<std::uint8_t>()[i++] = static_cast<std::uint8_t>(codes(x, y, c));
        }
    }
    return image;
}

/// A linear float image of one color with one channel for each value.
Image plain(std::vector<float> color, int width = 12, int height = 9) {
    Image image = make_image(width, height, static_cast<int>(color.size()), 32, ColorSpace::linear);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<float>()[i] = color[i % color.size()];
    return image;
}

float map_at(const FlipDifference& difference, std::size_t x, std::size_t y) {
    return difference.map.as<float>()[y * static_cast<std::size_t>(difference.map.width) + x];
}

TEST(Flip, GivesTheNumbersOfItsAuthorsProgram) {
    // Output of version 1.7 of the authors' C++ program for these images of 96 x 80 pixels. The
    // program works in float with a rounding error of 4e-7 in each lightness, which the exponents
    // increase.
    constexpr double rounding = 2e-5;
    const auto expect = [](const Codes& reference, const Codes& test, double pixels_per_degree,
                           double mean, double max, double middle, double corner) {
        const FlipDifference difference =
            flip_difference(picture(96, 80, reference), picture(96, 80, test), pixels_per_degree);
        EXPECT_NEAR(difference.mean, mean, rounding);
        EXPECT_NEAR(difference.max, max, rounding);
        EXPECT_NEAR(map_at(difference, 50, 40), middle, rounding);
        EXPECT_NEAR(map_at(difference, 95, 79), corner, rounding);
    };
    const double usual = default_pixels_per_degree;
    expect(noise_of(1), noise_of(2), usual, 0.4398127, 0.969753, 0.619667, 0.628800);
    expect(ramps, grainy_ramps, usual, 0.2934516, 0.436778, 0.302091, 0.333837);
    expect(ramps, moved_ramps, usual, 0.1460653, 0.804802, 0.092005, 0.083920);
    expect(ramps, grainy_ramps, 30, 0.3068858, 0.552595, 0.262061, 0.328351);
    expect(ramps, moved_ramps, 120, 0.1397213, 0.547950, 0.180056, 0.128828);
}

TEST(Flip, SeparableFiltersEqualSquareFilters) {
    // The image is taller than a band of rows, so that a wrong halo shows.
    const Image a = picture(23, 57, noise_of(3));
    const Image b = picture(23, 57, noise_of(4));
    for (const double pixels_per_degree : {12.0, 40.0, default_pixels_per_degree}) {
        const FlipDifference difference = flip_difference(a, b, pixels_per_degree);
        const std::vector<double> expected = test::flip_brute_force(a, b, pixels_per_degree);
        double worst = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            worst = std::max(
                worst, std::abs(expected[i] - static_cast<double>(difference.map.as<float>()[i])));
        }
        // Float against double: if features hardly differ, the square root of their difference
        // turns a rounding error of 1e-8 into 1e-4.
        EXPECT_LT(worst, 1e-4) << pixels_per_degree;
    }
}

TEST(Flip, IsExactlyZeroForEqualPicturesOnly) {
    const Image a = picture(40, 30, noise_of(1));
    const FlipDifference none = flip_difference(a, a);
    EXPECT_EQ(none.mean, 0.0);
    EXPECT_EQ(none.max, 0.0);
    Image b = a;
    b.as<std::uint8_t>()[3 * (15 * 40 + 20)] ^= 8U;
    const FlipDifference some = flip_difference(a, b);
    EXPECT_GT(some.mean, 0.0);
    EXPECT_GT(map_at(some, 20, 15), 0.0F);
    EXPECT_EQ(map_at(some, 20 + 11, 15), 0.0F) << "beyond the filters' reach of 10";
}

TEST(Flip, IsTheSameBothWaysRoundBitForBit) {
    const Image a = picture(50, 60, ramps);
    const Image b = picture(50, 60, noise_of(5));
    const FlipDifference there = flip_difference(a, b);
    const FlipDifference back = flip_difference(b, a);
    EXPECT_EQ(there.map.samples, back.map.samples);
    EXPECT_EQ(there.mean, back.mean);
}

TEST(Flip, MatchesTheFormulaForPlainColors) {
    // Both images have one color, so filters change nothing, there are no features, and the
    // lightness differs by 100. The largest distance is 203.3 (between green and blue), and the
    // exponent is 0.7:
    const double bent = std::pow(100.0 / 203.3, 0.7);
    const double expected = 0.95 + 0.05 * (bent - 0.4) / 0.6;
    const FlipDifference extreme = flip_difference(plain({0, 0, 0}), plain({1, 1, 1}));
    EXPECT_NEAR(extreme.mean, expected, 1e-4);
    EXPECT_NEAR(extreme.mean, extreme.max, 1e-6) << "the same in every pixel but for rounding";
    EXPECT_NEAR(flip_difference(plain({0, 1, 0}), plain({0, 0, 1})).mean, 1.0, 1e-5);
}

TEST(Flip, StaysWithinItsRangeAndGrowsWithContrast) {
    double before = 0.0;
    for (const float light : {0.21F, 0.22F, 0.25F, 0.3F, 0.5F, 0.8F, 1.0F}) {
        const double error =
            flip_difference(plain({0.2F, 0.2F, 0.2F}), plain({light, light, light})).mean;
        EXPECT_GT(error, before);
        before = error;
    }
    // Hard edges in all directions against their negative give the strongest features.
    const Codes checks = [](unsigned x, unsigned y, unsigned) {
        return (x / 9 + y / 9) % 2 == 0 ? 255U : 0U;
    };
    const Codes negative = [&](unsigned x, unsigned y, unsigned c) {
        return 255U - checks(x, y, c);
    };
    const FlipDifference hardest =
        flip_difference(picture(60, 60, checks), picture(60, 60, negative));
    EXPECT_GT(hardest.max, 0.9);
    for (const float error : hardest.map.as<float>()) {
        ASSERT_GE(error, 0.0F);
        ASSERT_LE(error, 1.0F);
    }
}

TEST(Flip, FineGrainFadesWithDistanceAndABlurredEdgeShows) {
    const Codes checks = [](unsigned x, unsigned y, unsigned) {
        return (x + y) % 2 == 0 ? 140U : 110U;
    };
    const Codes inverse = [&](unsigned x, unsigned y, unsigned c) {
        return 250U - checks(x, y, c);
    };
    const auto error_at = [&](double pixels_per_degree) {
        return flip_difference(picture(48, 48, checks), picture(48, 48, inverse), pixels_per_degree)
            .mean;
    };
    EXPECT_LT(error_at(30), 0.7 * error_at(15));
    EXPECT_LT(error_at(100), 0.2 * error_at(15));

    const Codes sharp = [](unsigned x, unsigned, unsigned) { return x < 24 ? 60U : 200U; };
    const Codes soft = [](unsigned x, unsigned, unsigned) {
        return x < 20 ? 60U : (x < 28 ? 60U + (x - 20U) * 18U : 200U);
    };
    const FlipDifference blurred = flip_difference(picture(48, 20, sharp), picture(48, 20, soft));
    EXPECT_GT(map_at(blurred, 23, 10), 0.2F);
    EXPECT_EQ(map_at(blurred, 4, 10), 0.0F);
}

TEST(Flip, TheNumberOfThreadsChangesNoBit) {
    const Image a = picture(70, 200, noise_of(1));
    const Image b = picture(70, 200, noise_of(2));
    const FlipDifference all = flip_difference(a, b);
    set_thread_limit(1);
    const FlipDifference one = flip_difference(a, b);
    set_thread_limit(0);
    EXPECT_EQ(all.map.samples, one.map.samples);
    EXPECT_EQ(all.mean, one.mean);
}

TEST(Flip, BitsChannelsAndCodingOfOnePictureDoNotMatter) {
    const Codes gray = [](unsigned x, unsigned y, unsigned) { return ramps(x, y, 0); };
    const Image bytes = picture(30, 20, gray);
    Image words = make_image(30, 20, 1, 16, ColorSpace::srgb);
    for (std::size_t i = 0; i < words.sample_count(); ++i) {
        words.as<std::uint16_t>()[i] =
            static_cast<std::uint16_t>(257U * bytes.as<std::uint8_t>()[3 * i]);
    }
    EXPECT_EQ(flip_difference(bytes, words).max, 0.0);
    EXPECT_EQ(flip_difference(bytes, to_linear(bytes)).max, 0.0);
}

TEST(Flip, ClampsToDisplayableColors) {
    const float inf = std::numeric_limits<float>::infinity();
    EXPECT_EQ(flip_difference(plain({1, 1, 1}), plain({2, inf, 1e30F})).max, 0.0);
    EXPECT_EQ(flip_difference(plain({0, 0, 0}), plain({-1, -inf, -0.0F})).max, 0.0);
}

TEST(Flip, NoNumberAgainstANumberIsTheLargestErrorInItsPixel) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Image a = plain({0, 0, 0});
    Image b = a;
    a.as<float>()[3 * 5 + 1] = nan;
    for (const FlipDifference& difference : {flip_difference(a, b), flip_difference(b, a)}) {
        EXPECT_EQ(map_at(difference, 5, 0), 1.0F);
        EXPECT_EQ(map_at(difference, 4, 0), 0.0F) << "shown as black, which is what is there";
        EXPECT_DOUBLE_EQ(difference.mean, 1.0 / 108.0);
    }
    b.as<float>()[3 * 5 + 1] = nan;
    EXPECT_EQ(flip_difference(a, b).max, 0.0);
    b.as<float>()[3 * 5 + 2] = nan;
    EXPECT_EQ(map_at(flip_difference(a, b), 5, 0), 1.0F);
}

TEST(Flip, CoverageCountsOverBlackAndOverWhite) {
    // Opaque black and a transparent pixel are equal over black, and opposite over white.
    const double extreme = flip_difference(plain({0, 0, 0}), plain({1, 1, 1})).mean;
    EXPECT_NEAR(flip_difference(plain({0, 0, 0, 1}), plain({0, 0, 0, 0})).mean, extreme, 1e-6);
    EXPECT_NEAR(flip_difference(plain({1, 1}), plain({1, 0})).mean, extreme, 1e-6);
    EXPECT_EQ(flip_difference(plain({1, 0, 0, 0}), plain({0, 1, 0, 0})).max, 0.0)
        << "nothing shows of either";
    EXPECT_EQ(flip_difference(plain({0.5F, 0, 0, 1}), plain({0.5F, 0, 0})).max, 0.0);
}

TEST(Flip, APictureOfOnePixelHasAnError) {
    EXPECT_NEAR(flip_difference(plain({0, 1, 0}, 1, 1), plain({0, 0, 1}, 1, 1)).mean, 1.0, 1e-5);
}

TEST(Flip, RefusesIncomparableImages) {
    const auto message = [](const Image& a, const Image& b, double ppd) -> std::string {
        try {
            (void)flip_difference(a, b, ppd);
            return "accepted";
        } catch (const InvalidInput& error) {
            return error.what();
        }
    };
    const Image image = plain({0, 0, 0});
    EXPECT_EQ(message(image, plain({0, 0, 0}, 9, 12), 60),
              "pictures of 12 x 9 and 9 x 12 pixels cannot be compared");
    EXPECT_EQ(message(image, make_image(12, 9, 3, 8, ColorSpace::data), 60),
              "FLIP compares colors, and one image holds data");
    EXPECT_EQ(message(Image{}, image, 60), "FLIP compares pictures, but one is empty");
    EXPECT_EQ(message(image, image, 9),
              "the resolution is 9 pixels per degree, but must be within [10, 1000]");
    EXPECT_EQ(message(image, image, std::nan("")),
              "the resolution is nan pixels per degree, but must be within [10, 1000]");
    EXPECT_EQ(message(image, image, 1000), "accepted");
}

}  // namespace
}  // namespace relief::test
