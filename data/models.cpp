// SPDX-License-Identifier: Apache-2.0
// The vase is a surface of revolution about the y axis. Its profile consists of cubic Bezier curves
// from the center of the foot up the outside, over the lip and down the inside to the center of the
// floor. u goes three times around. dv is the length along the profile divided by the radius, so
// that the mapping is conformal: texels are smaller where the vase is narrow, but never stretched.
// That would diverge at the two poles, so two discs are mapped flat, with the density of their
// rims.
//
// The pot consists of surfaces of revolution and tubes along cubic Bezier curves; the knot is a
// torus knot. Tests: tests/mesh/image/sample_data_test.cpp.
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "samples.h"

namespace relief::sample {
namespace {

constexpr int vase_segments = 48;
constexpr double vase_repeats = 3.0;

/// A ring of vertices: radius, height and the texture coordinate v.
struct Ring {
    double radius;
    double height;
    double v = 0.0;
};

struct Curve {
    glm::dvec2 points[4];
    int steps;
};

glm::dvec2 bezier(const Curve& curve, double t) {
    const double s = 1.0 - t;
    return s * s * s * curve.points[0] + 3.0 * s * s * t * curve.points[1] +
           3.0 * s * t * t * curve.points[2] + t * t * t * curve.points[3];
}

/// The rings between the two discs.
std::vector<Ring> profile() {
    const Curve curves[] = {
        {{{0.300, 0.000}, {0.335, 0.000}, {0.350, 0.012}, {0.352, 0.036}}, 4},   // edge of the foot
        {{{0.352, 0.036}, {0.357, 0.100}, {0.292, 0.085}, {0.300, 0.135}}, 5},   // throat above it
        {{{0.300, 0.135}, {0.325, 0.290}, {0.585, 0.390}, {0.585, 0.640}}, 10},  // belly
        {{{0.585, 0.640}, {0.585, 0.900}, {0.285, 0.930}, {0.285, 1.140}}, 10},  // shoulder
        {{{0.285, 1.140}, {0.285, 1.265}, {0.330, 1.330}, {0.415, 1.372}}, 6},   // neck
        {{{0.415, 1.372}, {0.447, 1.388}, {0.432, 1.417}, {0.398, 1.402}}, 4},   // lip
        {{{0.398, 1.402}, {0.300, 1.355}, {0.245, 1.265}, {0.245, 1.140}},
         6},  // inside of the neck
        {{{0.245, 1.140}, {0.245, 0.930}, {0.535, 0.880}, {0.535, 0.640}}, 5},
        {{{0.535, 0.640}, {0.535, 0.400}, {0.310, 0.200}, {0.200, 0.170}}, 9},  // floor
    };
    std::vector<Ring> rings{{curves[0].points[0].x, curves[0].points[0].y}};
    for (const Curve& curve : curves) {
        // v is an integral along the curve, by the midpoint rule with finer steps.
        constexpr int parts = 64;
        double v = rings.back().v;
        for (int step = 0; step < curve.steps; ++step) {
            for (int part = 0; part < parts; ++part) {
                const double from = (step + static_cast<double>(part) / parts) / curve.steps;
                const double to = (step + static_cast<double>(part + 1) / parts) / curve.steps;
                const glm::dvec2 a = bezier(curve, from);
                const glm::dvec2 b = bezier(curve, to);
                v -= glm::length(b - a) / (0.5 * (a.x + b.x)) * vase_repeats /
                     (2.0 * std::numbers::pi);
            }
            const glm::dvec2 end = bezier(curve, static_cast<double>(step + 1) / curve.steps);
            rings.push_back({end.x, end.y, v});
        }
    }
    return rings;
}

glm::vec3 revolved(double radius, double height, int segment) {
    const double angle = 2.0 * std::numbers::pi * (segment % vase_segments) / vase_segments;
    return {rounded(radius * std::sin(angle)), rounded(height), rounded(radius * std::cos(angle))};
}

void add_wall(Mesh& mesh, const std::vector<Ring>& rings) {
    for (const Ring& ring : rings) {
        for (int segment = 0; segment <= vase_segments; ++segment) {
            mesh.positions.push_back(revolved(ring.radius, ring.height, segment));
            mesh.texcoords.emplace_back(rounded(vase_repeats * segment / vase_segments),
                                        rounded(ring.v - rings.back().v));
        }
    }
    const auto row = static_cast<std::uint32_t>(vase_segments + 1);
    for (std::uint32_t ring = 0; ring + 1 < rings.size(); ++ring) {
        for (std::uint32_t segment = 0; segment < vase_segments; ++segment) {
            const std::uint32_t lower = ring * row + segment;
            const std::uint32_t upper = lower + row;
            mesh.triangles.emplace_back(lower, lower + 1, upper + 1);
            mesh.triangles.emplace_back(lower, upper + 1, upper);
        }
    }
}

/// A flat disc inside a ring, facing down or up. Its texture is upright, seen from outside.
void add_disc(Mesh& mesh, const Ring& rim, bool faces_up) {
    const double density = vase_repeats / (2.0 * std::numbers::pi * rim.radius);
    const double turn = faces_up ? 1.0 : -1.0;
    const auto add = [&](glm::vec3 position) {
        mesh.positions.push_back(position);
        mesh.texcoords.emplace_back(rounded(0.5 + density * position.x),
                                    rounded(0.5 + density * turn * position.z));
    };
    const auto center = static_cast<std::uint32_t>(mesh.positions.size());
    add(revolved(0.0, rim.height, 0));
    for (int segment = 0; segment < vase_segments; ++segment)
        add(revolved(rim.radius, rim.height, segment));
    for (std::uint32_t segment = 0; segment < vase_segments; ++segment) {
        const std::uint32_t here = center + 1 + segment;
        const std::uint32_t next = center + 1 + (segment + 1) % vase_segments;
        if (faces_up) mesh.triangles.emplace_back(center, here, next);
        if (!faces_up) mesh.triangles.emplace_back(center, next, here);
    }
}

}  // namespace

Mesh vase() {
    const std::vector<Ring> rings = profile();
    Mesh mesh;
    mesh.name = "vase";
    add_wall(mesh, rings);
    add_disc(mesh, rings.front(), false);
    add_disc(mesh, rings.back(), true);
    return mesh;
}

}  // namespace relief::sample

namespace relief::sample {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

glm::vec3 rounded(const glm::dvec3& position) {
    return {sample::rounded(position.x), sample::rounded(position.y), sample::rounded(position.z)};
}

/// A point of a cubic Bezier curve.
template <typename Vector>
Vector bezier(const Vector (&points)[4], double t) {
    const double s = 1.0 - t;
    return s * s * s * points[0] + 3.0 * s * s * t * points[1] + 3.0 * s * t * t * points[2] +
           t * t * t * points[3];
}

/// A curve of a profile: radius and height.
struct Profile {
    glm::dvec2 points[4];
    int steps;
};

/// Adds a surface of revolution about the y axis. The profile must go upwards on the outside. At
/// radius 0, triangles without area are left out.
void add_revolved(Mesh& mesh, const std::vector<Profile>& pieces, int segments) {
    std::vector<glm::dvec2> rings{pieces.front().points[0]};
    for (const Profile& piece : pieces) {
        for (int step = 1; step <= piece.steps; ++step)
            rings.push_back(bezier(piece.points, static_cast<double>(step) / piece.steps));
    }
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t ring = 0; ring < rings.size(); ++ring) {
        for (int segment = 0; segment <= segments; ++segment) {
            const double angle = two_pi * (segment % segments) / segments;
            const double radius = rings[ring].x;
            mesh.positions.push_back(
                rounded({radius * std::sin(angle), rings[ring].y, radius * std::cos(angle)}));
            mesh.texcoords.emplace_back(
                2.0 * segment / segments,
                1.0 - static_cast<double>(ring) / static_cast<double>(rings.size() - 1));
        }
    }
    const auto row = static_cast<std::uint32_t>(segments + 1);
    for (std::uint32_t ring = 0; ring + 1 < rings.size(); ++ring) {
        for (std::uint32_t segment = 0; segment + 1 < row; ++segment) {
            const std::uint32_t lower = first + ring * row + segment;
            const std::uint32_t upper = lower + row;
            if (rings[ring].x > 0.0) mesh.triangles.emplace_back(lower, lower + 1, upper + 1);
            if (rings[ring + 1].x > 0.0) mesh.triangles.emplace_back(lower, upper + 1, upper);
        }
    }
}

/// A curve in space with a radius, over t in [0, 1].
struct TubePath {
    std::function<glm::dvec3(double t)> center;
    std::function<double(double t)> radius;
    /// A direction that is never parallel to the curve. It orients the cross-section.
    std::function<glm::dvec3(double t)> reference;
    bool closed = false;  ///< t = 1 is the same point as t = 0.
};

/// Adds a tube: rings of vertices, each in the plane perpendicular to the curve. For the texture,
/// the first vertex of each ring is repeated, and so is the first ring of a closed tube.
/// \param along    the number of cells along the curve
/// \param around   the number of cells around it
/// \param repeats  the repetitions of the texture: u around, v along
void add_tube(Mesh& mesh, const TubePath& path, int along, int around, glm::dvec2 repeats) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    constexpr double step = 1e-4;
    for (int ring = 0; ring <= along; ++ring) {
        const double share = static_cast<double>(ring) / along;
        const double t = path.closed && ring == along ? 0.0 : share;
        const double before = path.closed ? t - step : std::max(t - step, 0.0);
        const double after = path.closed ? t + step : std::min(t + step, 1.0);
        const glm::dvec3 forward = glm::normalize(path.center(after) - path.center(before));
        const glm::dvec3 side = glm::normalize(glm::cross(forward, path.reference(t)));
        const glm::dvec3 up = glm::cross(side, forward);
        for (int corner = 0; corner <= around; ++corner) {
            const double angle = 2.0 * std::numbers::pi * (corner % around) / around;
            const glm::dvec3 outwards = std::cos(angle) * up + std::sin(angle) * side;
            mesh.positions.push_back(rounded(path.center(t) + path.radius(t) * outwards));
            mesh.texcoords.emplace_back(repeats.x * corner / around, repeats.y * (1.0 - share));
        }
    }
    const auto row = static_cast<std::uint32_t>(around + 1);
    for (std::uint32_t ring = 0; ring < static_cast<std::uint32_t>(along); ++ring) {
        for (std::uint32_t corner = 0; corner + 1 < row; ++corner) {
            const std::uint32_t lower = first + ring * row + corner;
            mesh.triangles.emplace_back(lower, lower + row, lower + 1);
            mesh.triangles.emplace_back(lower + 1, lower + row, lower + row + 1);
        }
    }
}

/// Adds a tube in the xy plane along a Bezier curve, from one radius to another.
void add_plane_tube(Mesh& mesh, const glm::dvec3 (&points)[4], double from, double to, int along,
                    int around) {
    const TubePath path{[&](double t) { return bezier(points, t); },
                        [&](double t) { return from + (to - from) * t * t * (3.0 - 2.0 * t); },
                        [](double) { return glm::dvec3(0.0, 0.0, 1.0); }, false};
    add_tube(mesh, path, along, around, {1.0, 2.0});
}

}  // namespace

Mesh pot() {
    Mesh mesh;
    mesh.name = "pot";
    add_revolved(
        mesh,
        {{{{0.00, 0.00}, {0.20, 0.00}, {0.34, 0.00}, {0.36, 0.02}}, 4},   // foot
         {{{0.36, 0.02}, {0.38, 0.05}, {0.58, 0.12}, {0.60, 0.34}}, 12},  // belly
         {{{0.60, 0.34}, {0.62, 0.56}, {0.46, 0.66}, {0.38, 0.70}}, 12},  // shoulder
         {{{0.38, 0.70}, {0.39, 0.73}, {0.36, 0.74}, {0.35, 0.72}}, 4},   // rim
         {{{0.35, 0.72}, {0.30, 0.80}, {0.08, 0.80}, {0.06, 0.84}}, 10},  // lid
         {{{0.06, 0.84}, {0.04, 0.88}, {0.12, 0.90}, {0.11, 0.95}}, 6},   // neck of the knob
         {{{0.11, 0.95}, {0.10, 1.00}, {0.05, 1.01}, {0.00, 1.01}}, 6}},  // knob
        48);
    add_plane_tube(mesh,
                   {{0.45, 0.22, 0.0}, {0.85, 0.22, 0.0}, {0.68, 0.58, 0.0}, {0.98, 0.70, 0.0}},
                   0.15, 0.055, 24, 20);
    add_plane_tube(mesh,
                   {{-0.40, 0.62, 0.0}, {-1.10, 0.86, 0.0}, {-1.00, 0.02, 0.0}, {-0.45, 0.16, 0.0}},
                   0.05, 0.05, 32, 14);
    return mesh;
}

Mesh knot() {
    constexpr double tube = 0.2;
    // The curve goes twice around a torus and three times around its tube.
    const auto torus_angles = [](double t) { return glm::dvec2(2.0, 3.0) * two_pi * t; };
    const auto outwards = [=](double t) {
        const glm::dvec2 a = torus_angles(t);
        return glm::dvec3(std::cos(a.y) * std::sin(a.x), std::sin(a.y),
                          std::cos(a.y) * std::cos(a.x));
    };
    const auto center = [=](double t) {
        const glm::dvec2 a = torus_angles(t);
        return glm::dvec3(0.5 * std::sin(a.x), 0.45, 0.5 * std::cos(a.x)) + 0.24 * outwards(t);
    };
    Mesh mesh;
    mesh.name = "knot";
    add_tube(mesh,
             {center, [](double t) { return tube * (0.5 + 0.03 * std::sin(30.0 * two_pi * t)); },
              outwards, true},
             400, 16, {2.0, 24.0});
    return mesh;
}

}  // namespace relief::sample
