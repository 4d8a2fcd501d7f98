// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/bake_experiments_test.cpp.
#include "bake/bumpy_sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace relief {
namespace {

constexpr double height = 0.02;
constexpr double waves = 12.0;

struct SphereAngles {
    double longitude = 0.0;  ///< From +z towards +x.
    double polar = 0.0;      ///< From +y.
};

SphereAngles angles_of(const glm::dvec3& p) {
    return {std::atan2(p.x, p.z), std::atan2(std::hypot(p.x, p.z), p.y)};
}

double radius_at(const SphereAngles& a) {
    return 1.0 + height * std::sin(waves * a.longitude) * std::sin(waves * a.polar);
}

glm::dvec3 direction_at(const SphereAngles& a) {
    return {std::sin(a.polar) * std::sin(a.longitude), std::cos(a.polar),
            std::sin(a.polar) * std::cos(a.longitude)};
}

/// The gradient of |p| - radius: outwards - d radius / d polar * p_polar
/// - d radius / d longitude / sin polar * p_longitude, over the radius.
glm::dvec3 normal_at(const SphereAngles& a) {
    const double sine = std::max(std::sin(a.polar), 1e-9);
    const glm::dvec3 polar_wards(std::cos(a.polar) * std::sin(a.longitude), -std::sin(a.polar),
                                 std::cos(a.polar) * std::cos(a.longitude));
    const glm::dvec3 east(std::cos(a.longitude), 0.0, -std::sin(a.longitude));
    const double by_polar =
        height * waves * std::sin(waves * a.longitude) * std::cos(waves * a.polar);
    const double by_longitude =
        height * waves * std::cos(waves * a.longitude) * std::sin(waves * a.polar);
    const double radius = radius_at(a);
    return glm::normalize(direction_at(a) - by_polar / radius * polar_wards -
                          by_longitude / (radius * sine) * east);
}

/// Where a line meets a triangle, if it does; a little beyond its edges too.
std::optional<glm::dvec3> weights_of(const glm::dvec3& from, const glm::dvec3& along,
                                     const glm::dvec3& a, const glm::dvec3& b,
                                     const glm::dvec3& c) {
    const glm::dvec3 x = a - from;
    const glm::dvec3 y = b - from;
    const glm::dvec3 z = c - from;
    const glm::dvec3 volumes(glm::dot(glm::cross(along, z), y), glm::dot(glm::cross(along, x), z),
                             glm::dot(glm::cross(along, y), x));
    const glm::dvec3 weights = volumes / (volumes.x + volumes.y + volumes.z);
    if (!(std::min({weights.x, weights.y, weights.z}) > -1e-9)) return std::nullopt;
    return weights;
}

}  // namespace

BumpySphere::BumpySphere(int stacks) : stacks_(stacks) {
    const int slices = 2 * stacks;
    for (int stack = 0; stack <= stacks; ++stack) {
        for (int slice = 0; slice <= slices; ++slice) {
            const SphereAngles a{2.0 * std::numbers::pi * (slice % slices) / slices,
                                 std::numbers::pi * stack / stacks};
            mesh_.positions.emplace_back(radius_at(a) * direction_at(a));
            mesh_.normals.emplace_back(normal_at(a));
        }
    }
    for (int stack = 0; stack < stacks; ++stack) {
        for (int slice = 0; slice < slices; ++slice) {
            const auto upper = static_cast<std::uint32_t>(stack * (slices + 1) + slice);
            const auto lower = upper + static_cast<std::uint32_t>(slices + 1);
            mesh_.triangles.emplace_back(upper, lower, lower + 1);
            mesh_.triangles.emplace_back(upper, lower + 1, upper + 1);
        }
    }
}

SurfacePoint BumpySphere::on_surface(const glm::dvec3& from, const glm::dvec3& inward) {
    // How far outside the formula says the point is, is how far to go on: the line is steep.
    double way = 0.0;
    glm::dvec3 at = from;
    for (int step = 0; step < 40; ++step) {
        const double outside = glm::length(at) - radius_at(angles_of(at));
        if (std::abs(outside) < 1e-15) break;
        way += outside;
        at = from + way * inward;
    }
    return {at, normal_at(angles_of(at))};
}

SurfacePoint BumpySphere::on_mesh(const glm::dvec3& from, const glm::dvec3& inward) const {
    const SphereAngles a = angles_of(on_surface(from, inward).position);
    const int slices = 2 * stacks_;
    const auto near_stack = static_cast<int>(std::floor(a.polar / std::numbers::pi * stacks_));
    const auto near_slice =
        static_cast<int>(std::floor(a.longitude / (2.0 * std::numbers::pi) * slices));
    for (int stack = std::max(near_stack - 1, 0); stack <= std::min(near_stack + 1, stacks_ - 1);
         ++stack) {
        for (int by = -1; by <= 1; ++by) {
            const int slice = (near_slice + by + slices) % slices;
            for (int half = 0; half < 2; ++half) {
                const auto index = static_cast<std::size_t>(2 * (stack * slices + slice) + half);
                const glm::uvec3& t = mesh_.triangles[index];
                const auto weights =
                    weights_of(from, inward, glm::dvec3(mesh_.positions[t.x]),
                               glm::dvec3(mesh_.positions[t.y]), glm::dvec3(mesh_.positions[t.z]));
                if (!weights) continue;
                const auto mixed = [&](const std::vector<glm::vec3>& values) {
                    return weights->x * glm::dvec3(values[t.x]) +
                           weights->y * glm::dvec3(values[t.y]) +
                           weights->z * glm::dvec3(values[t.z]);
                };
                return {mixed(mesh_.positions), glm::normalize(mixed(mesh_.normals))};
            }
        }
    }
    throw std::logic_error("a line passes the sphere by");
}

}  // namespace relief
