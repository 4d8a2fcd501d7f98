// SPDX-License-Identifier: Apache-2.0
// Fresnel's formulas with a complex index of refraction, and the reflectance of thin films.
// Sources: [Born and Wolf 1999], sections 1.5.2 and 14.2; [Schlick 1994]; [Belcour and Barla 2017].
#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/glm.hpp>
#include <numbers>

#include "portable_math.h"
#include "reference/reference_parts.h"

namespace relief::shade::reference {
using namespace relief::detail;
using namespace relief::shade::detail;

// Fresnel

double fresnel(std::complex<double> index, double cosine) {
    if (index == 1.0) return 0.0;
    if (index == 0.0 || cosine <= 0.0) return 1.0;
    // Snell's law: the sine inside is the sine outside divided by the index.
    const std::complex<double> cosine_inside =
        std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const std::complex<double> across =
        (cosine - index * cosine_inside) / (cosine + index * cosine_inside);
    const std::complex<double> along =
        (index * cosine - cosine_inside) / (index * cosine + cosine_inside);
    return 0.5 * (std::norm(across) + std::norm(along));
}

glm::dvec3 fresnel_factor(const Material& material, double n_dot_v) {
    const glm::dvec3 reflectivity(material.reflectivity);
    if (reflectivity == glm::dvec3(0.0)) return glm::dvec3(0.0);
    const double cosine = glm::clamp(n_dot_v, 0.0, 1.0);
    glm::dvec3 factor(0.0);
    switch (material.fresnel) {
        case FresnelModel::schlick:
            factor = reflectivity + (glm::dvec3(material.grazing_reflectivity) - reflectivity) *
                                        portable::pow(1.0 - cosine, 5.0);
            break;
        case FresnelModel::dielectric:
            factor = reflectivity * fresnel(static_cast<double>(material.refractive_index), cosine);
            break;
        case FresnelModel::conductor:
            for (int i = 0; i < 3; ++i) {
                const std::complex<double> index(
                    static_cast<double>(material.conductor_index[i]),
                    static_cast<double>(material.conductor_absorption[i]));
                factor[i] = reflectivity[i] * fresnel(index, cosine);
            }
            break;
    }
    return glm::clamp(factor, 0.0, 1.0);
}

// Thin films

namespace {

/// Returns the color of light whose parts differ by a path in nanometers, relative to white. The
/// sensitivities are Gaussians over wave numbers [Belcour and Barla 2017].
///
/// \param sign  -1 where one part is reflected with the opposite phase, for X, Y and Z
glm::dvec3 interference(double path, const glm::dvec3& sign) {
    struct Gaussian {
        int component;
        double height, position, variance;
    };
    constexpr Gaussian gaussians[] = {{0, 5.4856e-13, 1.6810e6, 4.3278e9},
                                      {1, 4.4201e-13, 1.7953e6, 9.3046e9},
                                      {2, 5.2481e-13, 2.2084e6, 6.6121e9},
                                      {0, 9.7470e-14, 2.2399e6, 4.5282e9}};
    constexpr double white = 1.0685e-7;
    const double phase = 2.0 * std::numbers::pi * path * 1e-9;
    glm::dvec3 xyz(0.0);
    for (const auto& [component, height, position, variance] : gaussians) {
        xyz[component] +=
            sign[component] * height / white * std::sqrt(2.0 * std::numbers::pi * variance) *
            portable::cos(position * phase) * portable::exp(-variance * phase * phase);
    }
    const glm::dmat3 rgb_from_xyz(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108,
                                  -0.2040259, -0.4985314, 0.0415560, 1.0572252);
    return rgb_from_xyz * xyz;
}

double schlick(double f0, double cosine) {
    return f0 + (1.0 - f0) * portable::pow(1.0 - cosine, 5.0);
}

}  // namespace

glm::dvec3 film_reflectance(const glm::dvec3& f0, double cosine, double index, double thickness) {
    const double cosine_inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const double outer = schlick(fresnel(index, 1.0), cosine);
    const double through = 1.0 - outer;
    glm::dvec3 sign(0.0);
    glm::dvec3 from_base(0.0);
    glm::dvec3 amplitude(0.0);
    for (int i = 0; i < 3; ++i) {
        const double root = std::sqrt(std::clamp(f0[i], 0.0, 0.9999));
        const double base_index = (1.0 + root) / (1.0 - root);
        const double inner = schlick(fresnel(base_index / index, 1.0), cosine_inside);
        const double bounce = std::clamp(outer * inner, 1e-5, 0.9999);
        sign[i] = base_index < index ? 1.0 : -1.0;
        from_base[i] = through * through * inner / (1.0 - bounce);
        amplitude[i] = std::sqrt(bounce);
    }
    // The path difference of the first order; orders above 2 are left out.
    const double path = 2.0 * index * thickness * cosine_inside;
    const glm::dvec3 first = (from_base - through) * amplitude;
    return glm::max(outer + from_base + 2.0 * first * interference(path, sign) +
                        2.0 * first * amplitude * interference(2.0 * path, glm::dvec3(1.0)),
                    0.0);
}

}  // namespace relief::shade::reference
