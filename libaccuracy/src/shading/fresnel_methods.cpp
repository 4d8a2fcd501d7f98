// SPDX-License-Identifier: Apache-2.0
// Loops are plain, so that the compiler makes of each what it can. Tests:
// tests/accuracy/fresnel_experiment_test.cpp.
#include "shading/fresnel_methods.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "reference/shading.h"

namespace relief {
namespace {

/// A formula of one cosine as a method for all.
template <typename Formula>
FormulaMethod method_of(const char* name, const char* reflectance, std::span<const float> cosines,
                        Formula formula) {
    return {name, {{"reflectance", reflectance}}, [cosines, formula](std::span<float> results) {
                for (std::size_t i = 0; i < results.size(); ++i)
                    results[i] = formula(cosines[i]);
            }};
}

float fifth_power(float x) {
    const float squared = x * x;
    return squared * squared * x;
}

/// |F0| at normal incidence, and what brings Schlick's fit to the true value at a cosine of 1/7.
struct Fit {
    explicit Fit(std::complex<double> index)
        : f0(static_cast<float>(reference::fresnel(index, 1.0))) {
        constexpr double at = 1.0 / 7.0;
        const double there = f0 + (1.0 - f0) * std::pow(1.0 - at, 5.0);
        excess = static_cast<float>((there - reference::fresnel(index, at)) /
                                    (at * std::pow(1.0 - at, 6.0)));
    }
    float f0;
    float excess = 0.0F;
};

/// [Born and Wolf 1999], 1.5.2: of a real index, in float.
float dielectric(float index, float cosine) {
    const float inside = std::sqrt(std::max(index * index - 1.0F + cosine * cosine, 0.0F));
    const float across = (cosine - inside) / (cosine + inside);
    const float squared = index * index * cosine;
    const float along = (squared - inside) / (squared + inside);
    return 0.5F * (across * across + along * along);
}

/// The same, 14.2, of n + ik, without complex numbers: a and b are the real and imaginary part of
/// the root of index^2 - sine^2.
float conductor(float n, float k, float cosine) {
    const float sine2 = 1.0F - cosine * cosine;
    const float real = n * n - k * k - sine2;
    const float length = std::sqrt(real * real + 4.0F * n * n * k * k);
    const float a = std::sqrt(std::max(0.5F * (length + real), 0.0F));
    const float sum = length + cosine * cosine;
    const float across = (sum - 2.0F * a * cosine) / (sum + 2.0F * a * cosine);
    const float first = cosine * cosine * length + sine2 * sine2;
    const float second = 2.0F * a * cosine * sine2;
    const float along = across * (first - second) / (first + second);
    return 0.5F * (across + along);
}

FormulaMethod table_of(std::complex<double> index, std::span<const float> cosines) {
    constexpr std::size_t entries = 64;
    auto table = std::make_shared<std::vector<float>>();
    for (std::size_t i = 0; i <= entries; ++i) {
        table->push_back(static_cast<float>(
            reference::fresnel(index, static_cast<double>(i) / static_cast<double>(entries))));
    }
    return method_of("table of 65", "tabulated", cosines, [table](float cosine) {
        const float place = cosine * static_cast<float>(entries);
        const std::size_t before = std::min(static_cast<std::size_t>(place), entries - 1);
        const float share = place - static_cast<float>(before);
        return (*table)[before] + share * ((*table)[before + 1] - (*table)[before]);
    });
}

}  // namespace

std::vector<FormulaMethod> fresnel_methods(std::complex<double> index,
                                           std::span<const float> cosines) {
    const Fit fit(index);
    const auto n = static_cast<float>(index.real());
    const auto k = static_cast<float>(index.imag());
    const auto schlick = [fit](float cosine) {
        return fit.f0 + (1.0F - fit.f0) * fifth_power(1.0F - cosine);
    };
    std::vector<FormulaMethod> methods = {
        method_of("constant", "that of normal incidence", cosines, [fit](float) { return fit.f0; }),
        method_of("Schlick", "Schlick's", cosines, schlick),
        method_of("Schlick, power of two", "Schlick's", cosines,
                  [fit](float cosine) {
                      return fit.f0 +
                             (1.0F - fit.f0) * std::exp2((-5.55473F * cosine - 6.98316F) * cosine);
                  }),
        method_of("Schlick, right at 82 degrees", "Schlick's and a third number", cosines,
                  [schlick, fit](float cosine) {
                      const float away = 1.0F - cosine;
                      return schlick(cosine) - fit.excess * cosine * fifth_power(away) * away;
                  }),
        table_of(index, cosines)};
    if (k == 0.0F) {
        methods.push_back(method_of("Fresnel, float32", "Fresnel's", cosines,
                                    [n](float cosine) { return dielectric(n, cosine); }));
    } else {
        methods.push_back(method_of("Fresnel, float32", "Fresnel's", cosines,
                                    [n, k](float cosine) { return conductor(n, k, cosine); }));
    }
    return methods;
}

std::vector<double> true_reflectances(std::complex<double> index, std::span<const float> cosines) {
    std::vector<double> truth;
    for (const float cosine : cosines)
        truth.push_back(reference::fresnel(index, static_cast<double>(cosine)));
    return truth;
}

std::vector<float> cosines_of_angles(std::size_t count) {
    std::vector<float> cosines;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle =
            0.5 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count - 1);
        cosines.push_back(static_cast<float>(std::max(std::cos(angle), 0.0)));
    }
    cosines.back() = 0.0F;
    return cosines;
}

}  // namespace relief
