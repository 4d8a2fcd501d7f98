// SPDX-License-Identifier: Apache-2.0
// Irradiance from spherical harmonics; see irradiance_sh.h. The convolution with the cosine turns
// the radiance's coefficients L of order l into A_l L, A = pi, 2 pi / 3, pi / 4
// [Ramamoorthi and Hanrahan 2001]; both normalisation constants of each harmonic, one from L and
// one from the sum that gives the irradiance, and the division by pi are multiplied in.
// Tests: tests/shade/environment/irradiance_sh_test.cpp.
#include "environment/irradiance_sh.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "environment/cube_faces.h"
#include "relief/mesh/error.h"

namespace relief {

namespace {

using std::numbers::pi;

/// Texels of faces with fewer are cut into parts, so that the harmonics hardly change within one.
constexpr int fewest_cells = 64;

/// The harmonics' polynomials, in the order of IrradianceSh.
std::array<double, 9> polynomials(const glm::dvec3& n) {
    return {1.0,
            n.y,
            n.z,
            n.x,
            n.x * n.y,
            n.y * n.z,
            3.0 * n.z * n.z - 1.0,
            n.x * n.z,
            n.x * n.x - n.y * n.y};
}

/// A_l / pi times the square of the harmonic's normalisation constant.
constexpr std::array<double, 9> factors{1.0 / (4 * pi),
                                        2.0 / 3.0 * 3.0 / (4 * pi),
                                        2.0 / 3.0 * 3.0 / (4 * pi),
                                        2.0 / 3.0 * 3.0 / (4 * pi),
                                        1.0 / 4.0 * 15.0 / (4 * pi),
                                        1.0 / 4.0 * 15.0 / (4 * pi),
                                        1.0 / 4.0 * 5.0 / (16 * pi),
                                        1.0 / 4.0 * 15.0 / (4 * pi),
                                        1.0 / 4.0 * 15.0 / (16 * pi)};

void check(std::span<const Image> faces) {
    check_faces(faces, "irradiance");
    if (faces[0].bits() != 32 || faces[0].channels < 3)
        throw InvalidInput("irradiance is computed from three float channels of linear light");
    for (std::size_t face = 0; face < 6; ++face) {
        const auto samples = faces[face].as<float>();
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (std::isfinite(samples[i])) continue;
            throw InvalidInput(
                fmt::format("irradiance: face {} holds {} in texel {}, which is not finite",
                            cube_face_names.at(face), samples[i],
                            i / static_cast<std::size_t>(faces[0].channels)));
        }
    }
}

glm::dvec3 radiance(const Image& face, int x, int y) {
    const auto texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(face.width) +
                       static_cast<std::size_t>(x);
    const float* sample = face.as<float>().data() + texel * static_cast<std::size_t>(face.channels);
    return {sample[0], sample[1], sample[2]};
}

}  // namespace

IrradianceSh irradiance_sh(std::span<const Image> faces) {
    check(faces);
    const int size = faces[0].width;
    const int parts = (fewest_cells + size - 1) / size;
    const int cells = size * parts;
    const double side = 2.0 / cells;
    std::array<glm::dvec3, 9> sums{};
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            const glm::dvec2 from(x * side - 1.0, y * side - 1.0);
            const double weight = solid_angle(from, from + side);
            const glm::dvec2 middle = from + 0.5 * side;
            for (std::size_t face = 0; face < 6; ++face) {
                const glm::dvec3 normal = glm::normalize(face_direction(face, middle.x, middle.y));
                const glm::dvec3 light = weight * radiance(faces[face], x / parts, y / parts);
                const std::array<double, 9> values = polynomials(normal);
                for (std::size_t i = 0; i < values.size(); ++i)
                    sums.at(i) += light * values.at(i);
            }
        }
    }
    IrradianceSh coefficients{};
    for (std::size_t i = 0; i < sums.size(); ++i)
        coefficients.at(i) = glm::vec3(sums.at(i) * factors.at(i));
    return coefficients;
}

glm::dvec3 irradiance_over_pi(const IrradianceSh& coefficients, const glm::dvec3& normal) {
    const std::array<double, 9> values = polynomials(normal);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < values.size(); ++i)
        sum += glm::dvec3(coefficients.at(i)) * values.at(i);
    return sum;
}

}  // namespace relief
