// SPDX-License-Identifier: Apache-2.0
// FLIP by its definition [Andersson et al. 2020], with none of the library's shortcuts: YCxCz with
// its scales and offset, two-dimensional filters, doubles. See flip_brute_force.h.
#include "flip_brute_force.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>

namespace relief::test {
namespace {

constexpr double pi = std::numbers::pi;

/// From the standard's primaries and white point, in whole numbers.
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

/// A square of weights, (2 radius + 1)^2.
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

}  // namespace

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

}  // namespace relief::test
