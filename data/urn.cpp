// SPDX-License-Identifier: Apache-2.0
// A profile of cubic Bezier curves from the foot's edge to the lid's, turned about the y axis, and
// closed by two discs. Carvings move the surface along its normal: lobes, beads, studs, and the
// marks of a tool; they end before the discs begin. Object space, y up. Texture: u runs once round
// the body, v down along the profile. Tests: tests/mesh/image/sample_data_test.cpp.
#include "urn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "noise.h"
#include "rounded.h"

namespace relief::sample {
namespace {

constexpr double whole_turn = 2.0 * std::numbers::pi;

using Bezier = std::array<glm::dvec2, 4>;  // Radius and height.
constexpr std::array<Bezier, 3> profile_curves = {{
    {{{0.260, 0.000}, {0.260, 0.050}, {0.215, 0.080}, {0.235, 0.140}}},  // Foot.
    {{{0.235, 0.140}, {0.262, 0.221}, {0.520, 0.360}, {0.520, 0.600}}},  // Belly.
    {{{0.520, 0.600}, {0.520, 0.800}, {0.420, 0.940}, {0.300, 1.000}}},  // Shoulder.
}};

/// A place on the profile; `along` is the number of the curve and how far along it that is.
struct ProfilePlace {
    glm::dvec2 point{0.0};
    glm::dvec2 outward{0.0};  ///< Unit.
};

ProfilePlace place_at(double along) {
    const std::size_t index = std::min(static_cast<std::size_t>(along), profile_curves.size() - 1);
    const Bezier& c = profile_curves[index];
    const double t = along - static_cast<double>(index);
    const double s = 1.0 - t;
    const glm::dvec2 forward =
        s * s * (c[1] - c[0]) + 2.0 * s * t * (c[2] - c[1]) + t * t * (c[3] - c[2]);
    return {s * s * s * c[0] + 3.0 * s * s * t * c[1] + 3.0 * s * t * t * c[2] + t * t * t * c[3],
            glm::normalize(glm::dvec2(forward.y, -forward.x))};
}

/// 1 inside of a range, 0 outside, smooth at its ends.
double window(double from, double to, double soft, double x) {
    return smooth_step(from, from + soft, x) * smooth_step(to, to - soft, x);
}

/// How far outwards the carving moves the surface.
double carved(double angle, double along) {
    const double lobes = std::pow(std::abs(std::sin(10.0 * angle)), 0.7);
    const double bead_x = std::remainder(25.0 * angle / whole_turn, 1.0);
    const double bead_y = (along - 2.08) / 0.16;
    const double bead = std::sqrt(std::max(0.0, 1.0 - 4.4 * (bead_x * bead_x + bead_y * bead_y)));
    const double stud =
        std::sin(10.0 * angle + 19.0 * along) * std::sin(10.0 * angle - 19.0 * along);
    const glm::dvec2 at = place_at(along).point;
    const double marks =
        octaves(14.0 * at.x * std::sin(angle), 14.0 * at.y, 14.0 * at.x * std::cos(angle), 2, 71);
    return 0.020 * lobes * window(1.04, 1.94, 0.16, along) + 0.019 * bead +
           0.014 * std::max(0.0, stud) * window(2.22, 2.92, 0.1, along) +
           0.003 * marks * window(0.0, 3.0, 0.2, along);
}

glm::vec3 turned(const glm::dvec2& point, double angle) {
    return {rounded(point.x * std::sin(angle)), rounded(point.y),
            rounded(point.x * std::cos(angle))};
}

struct Fineness {
    int segments;
    std::array<int, 3> steps;  ///< Of each curve.
};

std::vector<double> ring_places(const Fineness& fineness) {
    std::vector<double> places = {0.0};
    for (std::size_t curve = 0; curve < profile_curves.size(); ++curve) {
        for (int step = 1; step <= fineness.steps[curve]; ++step)
            places.push_back(static_cast<double>(curve) +
                             static_cast<double>(step) / fineness.steps[curve]);
    }
    return places;
}

/// How long the profile is up to each ring, over all of it.
std::vector<double> shares_of_length(const std::vector<double>& places) {
    std::vector<double> shares = {0.0};
    for (std::size_t i = 1; i < places.size(); ++i) {
        const glm::dvec2 step = place_at(places[i]).point - place_at(places[i - 1]).point;
        shares.push_back(shares.back() + glm::length(step));
    }
    const double all = shares.back();
    for (double& share : shares)
        share /= all;
    return shares;
}

void add_body(Mesh& mesh, const Fineness& fineness, bool is_carved) {
    const std::vector<double> places = ring_places(fineness);
    const std::vector<double> shares = shares_of_length(places);
    for (std::size_t ring = 0; ring < places.size(); ++ring) {
        const ProfilePlace place = place_at(places[ring]);
        for (int segment = 0; segment <= fineness.segments; ++segment) {
            const double angle = whole_turn * (segment % fineness.segments) / fineness.segments;
            const double out = is_carved ? carved(angle, places[ring]) : 0.0;
            mesh.positions.push_back(turned(place.point + out * place.outward, angle));
            mesh.texcoords.emplace_back(rounded(0.02 + 0.96 * segment / fineness.segments),
                                        rounded(0.02 + 0.70 * (1.0 - shares[ring])));
        }
    }
    const auto row = static_cast<std::uint32_t>(fineness.segments + 1);
    for (std::uint32_t ring = 0; ring + 1 < places.size(); ++ring) {
        for (std::uint32_t lower = ring * row; lower + 1 < (ring + 1) * row; ++lower) {
            mesh.triangles.emplace_back(lower, lower + 1, lower + row + 1);
            mesh.triangles.emplace_back(lower, lower + row + 1, lower + row);
        }
    }
}

/// A flat disc within the profile's end; its texture lies upright as seen from outside.
void add_disc(Mesh& mesh, const Fineness& fineness, bool is_lid) {
    const glm::dvec2 rim = place_at(is_lid ? 3.0 : 0.0).point;
    const double turn = is_lid ? 1.0 : -1.0;
    const glm::dvec2 middle = is_lid ? glm::dvec2(0.14, 0.87) : glm::dvec2(0.40, 0.87);
    const auto add = [&](const glm::vec3& position) {
        mesh.positions.push_back(position);
        mesh.texcoords.emplace_back(rounded(middle.x + 0.11 / rim.x * position.x),
                                    rounded(middle.y + 0.11 / rim.x * turn * position.z));
    };
    const auto center = static_cast<std::uint32_t>(mesh.positions.size());
    add(turned({0.0, rim.y}, 0.0));
    for (int segment = 0; segment < fineness.segments; ++segment)
        add(turned(rim, whole_turn * segment / fineness.segments));
    const auto count = static_cast<std::uint32_t>(fineness.segments);
    for (std::uint32_t segment = 0; segment < count; ++segment) {
        const std::uint32_t here = center + 1 + segment;
        const std::uint32_t next = center + 1 + (segment + 1) % count;
        if (is_lid) mesh.triangles.emplace_back(center, here, next);
        if (!is_lid) mesh.triangles.emplace_back(center, next, here);
    }
}

Mesh urn(const Fineness& fineness, bool is_carved) {
    Mesh mesh;
    add_body(mesh, fineness, is_carved);
    add_disc(mesh, fineness, false);
    add_disc(mesh, fineness, true);
    return mesh;
}

}  // namespace

Mesh carved_urn() {
    Mesh mesh = urn({200, {8, 28, 30}}, true);
    mesh.texcoords.clear();  // Whoever bakes looks at the plain one's.
    mesh.name = "carved urn";
    return mesh;
}

Mesh plain_urn() {
    Mesh mesh = urn({24, {3, 6, 5}}, false);
    mesh.name = "plain urn";
    return mesh;
}

}  // namespace relief::sample
