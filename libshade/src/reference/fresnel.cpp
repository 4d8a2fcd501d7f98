// SPDX-License-Identifier: Apache-2.0
// Fresnel's formulas with a complex index of refraction, and Schlick's fit. Dimensionless, angles
// as cosines; what is no boundary, or no index, has the outcome stated in fresnel.h.
// Source: [Born and Wolf 1999], sections 1.5.2 and 14.2; [Schlick 1994].
// Tests: tests/shade/reference/fresnel_test.cpp.
#include "reference/fresnel.h"

#include <cmath>

namespace relief::reference {

double fresnel(std::complex<double> index, double cosine) {
    if (index == 1.0) return 0.0;
    if (index == 0.0 || cosine <= 0.0) return 1.0;
    // Snell's law: the sine inside is the sine outside over the index.
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
                                        std::pow(1.0 - cosine, 5.0);
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

}  // namespace relief::reference
