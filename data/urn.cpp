// SPDX-License-Identifier: Apache-2.0
// The urn is a surface of revolution about the y axis, closed by two discs. Its profile consists of
// cubic Bezier curves from the edge of the foot to the edge of the lid. Carvings displace the
// surface along its normal: lobes, beads, studs and tool marks; the discs have none. u goes once
// around the body, v down along the profile. Tests: tests/mesh/image/sample_data_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "samples.h"

namespace relief::sample {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

using Bezier = std::array<glm::dvec2, 4>;  // Radius and height.
constexpr std::array<Bezier, 3> profile_curves = {{
    {{{0.260, 0.000}, {0.260, 0.050}, {0.215, 0.080}, {0.235, 0.140}}},  // Foot.
    {{{0.235, 0.140}, {0.262, 0.221}, {0.520, 0.360}, {0.520, 0.600}}},  // Belly.
    {{{0.520, 0.600}, {0.520, 0.800}, {0.420, 0.940}, {0.300, 1.000}}},  // Shoulder.
}};

/// A point of the profile. Its parameter `along` is the index of the curve plus the curve's own
/// parameter.
struct ProfilePoint {
    glm::dvec2 position{0.0};
    glm::dvec2 outward{0.0};  ///< Unit.
};

ProfilePoint profile_point(double along) {
    const std::size_t index = std::min(static_cast<std::size_t>(along), profile_curves.size() - 1);
    const Bezier& c = profile_curves[index];
    const double t = along - static_cast<double>(index);
    const double s = 1.0 - t;
    const glm::dvec2 forward =
        s * s * (c[1] - c[0]) + 2.0 * s * t * (c[2] - c[1]) + t * t * (c[3] - c[2]);
    return {s * s * s * c[0] + 3.0 * s * s * t * c[1] + 3.0 * s * t * t * c[2] + t * t * t * c[3],
            glm::normalize(glm::dvec2(forward.y, -forward.x))};
}

/// 1 inside a range, 0 outside, with smooth ends.
double window(double from, double to, double soft, double x) {
    return smooth_step(from, from + soft, x) * smooth_step(to, to - soft, x);
}

/// The displacement of the surface by the carving, outwards.
double carved(double angle, double along) {
    const double lobes = std::pow(std::abs(std::sin(10.0 * angle)), 0.7);
    const double bead_x = std::remainder(25.0 * angle / two_pi, 1.0);
    const double bead_y = (along - 2.08) / 0.16;
    const double bead = std::sqrt(std::max(0.0, 1.0 - 4.4 * (bead_x * bead_x + bead_y * bead_y)));
    const double stud =
        std::sin(10.0 * angle + 19.0 * along) * std::sin(10.0 * angle - 19.0 * along);
    const glm::dvec2 at = profile_point(along).position;
    const double marks =
        octaves(14.0 * at.x * std::sin(angle), 14.0 * at.y, 14.0 * at.x * std::cos(angle), 2, 71);
    return 0.020 * lobes * window(1.04, 1.94, 0.16, along) + 0.019 * bead +
           0.014 * std::max(0.0, stud) * window(2.22, 2.92, 0.1, along) +
           0.003 * marks * window(0.0, 3.0, 0.2, along);
}

glm::vec3 revolved(const glm::dvec2& point, double angle) {
    return {rounded(point.x * std::sin(angle)), rounded(point.y),
            rounded(point.x * std::cos(angle))};
}

struct Resolution {
    int segments;
    std::array<int, 3> steps;  ///< Of each curve.
};

/// The profile's parameter at each ring.
std::vector<double> ring_parameters(const Resolution& resolution) {
    std::vector<double> parameters = {0.0};
    for (std::size_t curve = 0; curve < profile_curves.size(); ++curve) {
        for (int step = 1; step <= resolution.steps[curve]; ++step)
            parameters.push_back(static_cast<double>(curve) +
                                 static_cast<double>(step) / resolution.steps[curve]);
    }
    return parameters;
}

/// The length of the profile up to each ring, relative to its whole length.
std::vector<double> shares_of_length(const std::vector<double>& parameters) {
    std::vector<double> shares = {0.0};
    for (std::size_t i = 1; i < parameters.size(); ++i) {
        const glm::dvec2 step =
            profile_point(parameters[i]).position - profile_point(parameters[i - 1]).position;
        shares.push_back(shares.back() + glm::length(step));
    }
    const double all = shares.back();
    for (double& share : shares)
        share /= all;
    return shares;
}

void add_body(Mesh& mesh, const Resolution& resolution, bool is_carved) {
    const std::vector<double> parameters = ring_parameters(resolution);
    const std::vector<double> shares = shares_of_length(parameters);
    for (std::size_t ring = 0; ring < parameters.size(); ++ring) {
        const ProfilePoint point = profile_point(parameters[ring]);
        for (int segment = 0; segment <= resolution.segments; ++segment) {
            const double angle = two_pi * (segment % resolution.segments) / resolution.segments;
            const double out = is_carved ? carved(angle, parameters[ring]) : 0.0;
            mesh.positions.push_back(revolved(point.position + out * point.outward, angle));
            mesh.texcoords.emplace_back(rounded(0.02 + 0.96 * segment / resolution.segments),
                                        rounded(0.02 + 0.70 * (1.0 - shares[ring])));
        }
    }
    const auto row = static_cast<std::uint32_t>(resolution.segments + 1);
    for (std::uint32_t ring = 0; ring + 1 < parameters.size(); ++ring) {
        for (std::uint32_t lower = ring * row; lower + 1 < (ring + 1) * row; ++lower) {
            mesh.triangles.emplace_back(lower, lower + 1, lower + row + 1);
            mesh.triangles.emplace_back(lower, lower + row + 1, lower + row);
        }
    }
}

/// A flat disc at an end of the profile. Its texture is upright, seen from outside.
void add_disc(Mesh& mesh, const Resolution& resolution, bool is_lid) {
    const glm::dvec2 rim = profile_point(is_lid ? 3.0 : 0.0).position;
    const double turn = is_lid ? 1.0 : -1.0;
    const glm::dvec2 middle = is_lid ? glm::dvec2(0.14, 0.87) : glm::dvec2(0.40, 0.87);
    const auto add = [&](const glm::vec3& position) {
        mesh.positions.push_back(position);
        mesh.texcoords.emplace_back(rounded(middle.x + 0.11 / rim.x * position.x),
                                    rounded(middle.y + 0.11 / rim.x * turn * position.z));
    };
    const auto center = static_cast<std::uint32_t>(mesh.positions.size());
    add(revolved({0.0, rim.y}, 0.0));
    for (int segment = 0; segment < resolution.segments; ++segment)
        add(revolved(rim, two_pi * segment / resolution.segments));
    const auto count = static_cast<std::uint32_t>(resolution.segments);
    for (std::uint32_t segment = 0; segment < count; ++segment) {
        const std::uint32_t here = center + 1 + segment;
        const std::uint32_t next = center + 1 + (segment + 1) % count;
        if (is_lid) mesh.triangles.emplace_back(center, here, next);
        if (!is_lid) mesh.triangles.emplace_back(center, next, here);
    }
}

Mesh urn(const Resolution& resolution, bool is_carved) {
    Mesh mesh;
    add_body(mesh, resolution, is_carved);
    add_disc(mesh, resolution, false);
    add_disc(mesh, resolution, true);
    return mesh;
}

}  // namespace

Mesh carved_urn() {
    Mesh mesh = urn({200, {8, 28, 30}}, true);
    mesh.texcoords.clear();  // A bake uses those of the plain urn.
    mesh.name = "carved urn";
    return mesh;
}

Mesh plain_urn() {
    Mesh mesh = urn({24, {3, 6, 5}}, false);
    mesh.name = "plain urn";
    return mesh;
}

}  // namespace relief::sample
