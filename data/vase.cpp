// SPDX-License-Identifier: Apache-2.0
// The vase is a surface of revolution about the y axis. Its profile consists of cubic Bezier curves
// from the center of the foot up the outside, over the lip and down the inside to the center of the
// floor. u goes three times around. dv is the length along the profile divided by the radius, so
// that the mapping is conformal: texels are smaller where the vase is narrow, but never stretched.
// That would diverge at the two poles, so two discs are mapped flat, with the density of their
// rims. Tests: tests/mesh/image/sample_data_test.cpp.
#include <cmath>
#include <numbers>
#include <vector>

#include "samples.h"

namespace relief::sample {
namespace {

constexpr int segments = 48;
constexpr double repeats = 3.0;

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
        {{{0.535, 0.640}, {0.535, 0.400}, {0.360, 0.200}, {0.200, 0.170}}, 9},  // floor
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
                v -= glm::length(b - a) / (0.5 * (a.x + b.x)) * repeats / (2.0 * std::numbers::pi);
            }
            const glm::dvec2 end = bezier(curve, static_cast<double>(step + 1) / curve.steps);
            rings.push_back({end.x, end.y, v});
        }
    }
    return rings;
}

glm::vec3 revolved(double radius, double height, int segment) {
    const double angle = 2.0 * std::numbers::pi * (segment % segments) / segments;
    return {rounded(radius * std::sin(angle)), rounded(height), rounded(radius * std::cos(angle))};
}

void add_wall(Mesh& mesh, const std::vector<Ring>& rings) {
    for (const Ring& ring : rings) {
        for (int segment = 0; segment <= segments; ++segment) {
            mesh.positions.push_back(revolved(ring.radius, ring.height, segment));
            mesh.texcoords.emplace_back(rounded(repeats * segment / segments),
                                        rounded(ring.v - rings.back().v));
        }
    }
    const auto row = static_cast<std::uint32_t>(segments + 1);
    for (std::uint32_t ring = 0; ring + 1 < rings.size(); ++ring) {
        for (std::uint32_t segment = 0; segment < segments; ++segment) {
            const std::uint32_t lower = ring * row + segment;
            const std::uint32_t upper = lower + row;
            mesh.triangles.emplace_back(lower, lower + 1, upper + 1);
            mesh.triangles.emplace_back(lower, upper + 1, upper);
        }
    }
}

/// A flat disc inside a ring, facing down or up. Its texture is upright, seen from outside.
void add_disc(Mesh& mesh, const Ring& rim, bool faces_up) {
    const double density = repeats / (2.0 * std::numbers::pi * rim.radius);
    const double turn = faces_up ? 1.0 : -1.0;
    const auto add = [&](glm::vec3 position) {
        mesh.positions.push_back(position);
        mesh.texcoords.emplace_back(rounded(0.5 + density * position.x),
                                    rounded(0.5 + density * turn * position.z));
    };
    const auto center = static_cast<std::uint32_t>(mesh.positions.size());
    add(revolved(0.0, rim.height, 0));
    for (int segment = 0; segment < segments; ++segment)
        add(revolved(rim.radius, rim.height, segment));
    for (std::uint32_t segment = 0; segment < segments; ++segment) {
        const std::uint32_t here = center + 1 + segment;
        const std::uint32_t next = center + 1 + (segment + 1) % segments;
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
