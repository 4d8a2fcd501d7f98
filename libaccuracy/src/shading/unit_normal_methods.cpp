// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/unit_normal_experiment_test.cpp.
#include "shading/unit_normal_methods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace relief {
namespace {

constexpr double diffuse = 0.55;
constexpr double specular = 0.45;

/// Blinn-Phong of shininess 40 [Blinn 1977], by products: 40 = 32 + 8.
template <typename Number>
Number radiance(Number n_dot_l, Number n_dot_h) {
    const Number h = std::max(n_dot_h, Number(0));
    const Number h2 = h * h;
    const Number h4 = h2 * h2;
    const Number h8 = h4 * h4;
    const Number h16 = h8 * h8;
    return static_cast<Number>(diffuse) * std::max(n_dot_l, Number(0)) +
           static_cast<Number>(specular) * h16 * h16 * h8;
}

/// \param shaded  from an interpolated normal
template <typename Shaded>
FormulaMethod method_of(const char* name, const char* unit, const NormalSamples& samples,
                        Shaded shaded) {
    return {name, {{"made unit", unit}}, [&samples, shaded](std::span<float> results) {
                for (std::size_t i = 0; i < results.size(); ++i)
                    results[i] = shaded(samples.interpolated()[i]);
            }};
}

/// The light of a normal that is `scale` times the interpolated one.
float scaled_radiance(const glm::vec3& n, float scale) {
    return radiance(scale * glm::dot(n, NormalSamples::light()),
                    scale * glm::dot(n, NormalSamples::half()));
}

double exact_radiance(const glm::vec3& interpolated) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(interpolated));
    return radiance(glm::dot(n, glm::dvec3(NormalSamples::light())),
                    glm::dot(n, glm::dvec3(NormalSamples::half())));
}

}  // namespace

NormalSamples::NormalSamples(double degrees, int side) {
    // Corners stand on a circle around +z, 120 degrees apart: their distance is sqrt(3) sine.
    const double sine = 2.0 * std::sin(glm::radians(degrees) * 0.5) / std::numbers::sqrt3;
    std::array<glm::dvec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / 3.0;
        corners.at(i) = {sine * std::cos(turn), sine * std::sin(turn),
                         std::sqrt(1.0 - sine * sine)};
    }
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x + y < side; ++x) {
            const double a = (x + 1.0 / 3.0) / side;
            const double b = (y + 1.0 / 3.0) / side;
            interpolated_.emplace_back(a * corners[0] + b * corners[1] +
                                       (1.0 - a - b) * corners[2]);
        }
    }
}

std::vector<double> NormalSamples::true_radiances() const {
    std::vector<double> truth;
    for (const glm::vec3& normal : interpolated_)
        truth.push_back(exact_radiance(normal));
    return truth;
}

double NormalSamples::brightest() const {
    const std::vector<double> truth = true_radiances();
    return *std::max_element(truth.begin(), truth.end());
}

const glm::vec3& NormalSamples::light() {
    static const glm::vec3 unit = glm::normalize(glm::vec3(0.3F, 0.1F, 1.0F));
    return unit;
}

const glm::vec3& NormalSamples::half() {
    static const glm::vec3 unit = glm::normalize(light() + glm::vec3(0.0F, 0.0F, 1.0F));
    return unit;
}

std::vector<FormulaMethod> unit_normal_methods(const NormalSamples& samples) {
    return {method_of("as interpolated", "no", samples,
                      [](const glm::vec3& n) { return scaled_radiance(n, 1.0F); }),
            method_of("one step of Newton's", "nearly", samples,
                      [](const glm::vec3& n) {
                          return scaled_radiance(n, 1.5F - 0.5F * glm::dot(n, n));
                      }),
            method_of("square root, float32", "in float", samples,
                      [](const glm::vec3& n) {
                          return scaled_radiance(n, 1.0F / std::sqrt(glm::dot(n, n)));
                      }),
            method_of("square root, float64", "in double", samples,
                      [](const glm::vec3& n) { return static_cast<float>(exact_radiance(n)); })};
}

}  // namespace relief
