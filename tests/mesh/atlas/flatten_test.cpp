// SPDX-License-Identifier: Apache-2.0
// Conformal charts of parts of spheres are stereographic projections, whose scale is known.
#include "atlas/flatten.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "atlas/surface.h"
#include "relief/mesh/unwrap.h"
#include "support/hard_meshes.h"

namespace relief {
namespace {

constexpr std::uint32_t zone_sides = 96;

/// The unit sphere between two angles from its pole; from 0 on, a cap without a hole.
Mesh spherical_zone(double first, double last, std::uint32_t rings) {
    Mesh mesh;
    const bool has_pole = first == 0.0;
    if (has_pole) mesh.positions.emplace_back(0.0F, 0.0F, 1.0F);
    const auto before = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t ring = has_pole ? 1 : 0; ring <= rings; ++ring) {
        const double angle = first + (last - first) * ring / rings;
        for (std::uint32_t i = 0; i < zone_sides; ++i) {
            const double turn = 2.0 * std::numbers::pi * i / zone_sides;
            mesh.positions.emplace_back(std::sin(angle) * std::cos(turn),
                                        std::sin(angle) * std::sin(turn), std::cos(angle));
        }
    }
    for (std::uint32_t i = 0; i < zone_sides; ++i) {
        const std::uint32_t next = (i + 1) % zone_sides;
        if (has_pole) mesh.triangles.emplace_back(0, before + i, before + next);
        for (std::uint32_t a = before; a + zone_sides < mesh.positions.size(); a += zone_sides) {
            const std::uint32_t b = a + zone_sides;
            mesh.triangles.emplace_back(a + i, b + i, b + next);
            mesh.triangles.emplace_back(a + i, b + next, a + next);
        }
    }
    return mesh;
}

/// A mesh flattened as one chart.
struct Flat {
    std::vector<double> scale;   ///< Of each face: the root of the ratio of its areas.
    std::vector<double> ratio;   ///< Of its singular values.
    std::vector<double> height;  ///< Of its center along the axis.
    double area_ratio = 0.0;     ///< Of the area in the plane to that on the surface.
};

Flat flattened_mesh(const Mesh& mesh, const detail::FlatteningTask& task) {
    Report report;
    const detail::AtlasSurface surface = detail::atlas_surface(mesh, {}, report);
    std::vector<std::uint32_t> faces(surface.faces.size());
    std::iota(faces.begin(), faces.end(), 0U);
    detail::ChartMembers members(std::vector<std::uint32_t>(faces.size(), 0));
    members.assign(faces);
    const detail::ChartMesh chart = detail::chart_mesh(surface, members, faces);
    const std::vector<glm::dvec2> coordinates =
        detail::flattened(surface, chart, detail::projected(surface, chart), task);
    Flat flat;
    double flat_area = 0.0;
    double area = 0.0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const glm::uvec3& v = chart.vertices[i];
        const detail::Stretch stretch = detail::stretch_of(
            surface, chart.faces[i], {coordinates[v.x], coordinates[v.y], coordinates[v.z]});
        EXPECT_GT(stretch.smallest, 0.0);
        flat.scale.push_back(std::sqrt(stretch.largest * stretch.smallest));
        flat.ratio.push_back(stretch.largest / stretch.smallest);
        area += surface.areas[i];
        flat_area += surface.areas[i] * stretch.largest * stretch.smallest;
    }
    flat.area_ratio = flat_area / area;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        glm::dvec3 center(0.0);
        for (std::uint32_t k = 0; k < 3; ++k)
            center += surface.position(3 * chart.faces[i] + k) / 3.0;
        flat.height.push_back(center.z * surface.unit);
    }
    return flat;
}

/// The largest relative deviation of scales from those of a stereographic projection, up to a
/// common factor.
double deviation_from_stereographic(const Flat& flat, double lowest_z) {
    const double least_z = *std::min_element(flat.height.begin(), flat.height.end());
    double low = std::numeric_limits<double>::infinity();
    double high = 0.0;
    for (std::size_t i = 0; i < flat.scale.size(); ++i) {
        const double z = flat.height[i] - least_z + lowest_z;
        // Projected from the opposite pole: 2 / (1 + z).
        const double factor = flat.scale[i] * (1.0 + z);
        low = std::min(low, factor);
        high = std::max(high, factor);
    }
    return high / low - 1.0;
}

Flat flattened_zone(const Mesh& mesh, Flattening method) {
    return flattened_mesh(mesh, {.method = method});
}

TEST(Flattening, IsStereographicForACap) {
    const double angle = std::numbers::pi / 3.0;
    const Mesh cap = spherical_zone(0.0, angle, 24);
    const Flat conformal = flattened_zone(cap, Flattening::conformal);
    const Flat rigid = flattened_zone(cap, Flattening::arap);
    const double lowest = std::cos(angle - angle / 72.0);
    EXPECT_LT(deviation_from_stereographic(conformal, lowest), 0.02);
    EXPECT_GT(deviation_from_stereographic(rigid, lowest), 0.1);
    EXPECT_LT(*std::max_element(conformal.ratio.begin(), conformal.ratio.end()), 1.03);
    EXPECT_GT(*std::max_element(rigid.ratio.begin(), rigid.ratio.end()), 1.15);
    EXPECT_NEAR(conformal.area_ratio, 1.0, 1e-9);
}

// A hole adds an unknown, and the result is still part of the same projection.
TEST(Flattening, IsStereographicAroundAHole) {
    const double angle = std::numbers::pi / 3.0;
    const double hole = std::numbers::pi / 8.0;
    const Flat ring = flattened_zone(spherical_zone(hole, angle, 24), Flattening::conformal);
    EXPECT_LT(deviation_from_stereographic(ring, std::cos(angle - (angle - hole) / 72.0)), 0.02);
    EXPECT_LT(*std::max_element(ring.ratio.begin(), ring.ratio.end()), 1.03);
}

// Noise stretches single triangles more than all others.
TEST(Flattening, RepairsSingleTrianglesAboveTheStretchLimit) {
    Mesh mesh = test::flat_grid(40);
    std::mt19937 random(1);
    for (glm::vec3& position : mesh.positions)
        position.z = (static_cast<float>(random()) * 0x1p-32F - 0.5F) * 2.0F;
    for (const Flattening method : {Flattening::arap, Flattening::conformal}) {
        const auto largest = [&](double max_stretch) {
            const Flat flat = flattened_mesh(mesh, {.method = method, .max_stretch = max_stretch});
            double result = 1.0;
            for (std::size_t i = 0; i < flat.scale.size(); ++i) {
                const double area = flat.scale[i] * flat.scale[i];
                result = std::max({result, flat.ratio[i], area, 1.0 / area});
            }
            return result;
        };
        const double unrepaired = largest(1e6);
        ASSERT_GT(unrepaired, 1.5);
        const double limit = 1.0 + 0.95 * (unrepaired - 1.0);
        EXPECT_LE(largest(limit), limit);
    }
}

TEST(Flattening, KeepsAnglesOfWholeMeshes) {
    UnwrapOptions options;
    options.size = {512, 512};
    const Mesh torus = make_torus(0.4F, 48, 24);
    const AtlasStats rigid = unwrap(torus, options).stats;
    options.flattening = Flattening::conformal;
    const AtlasStats conformal = unwrap(torus, options).stats;
    EXPECT_LT(conformal.mean_anisotropy - 1.0, 0.8 * (rigid.mean_anisotropy - 1.0));
    EXPECT_LE(conformal.max_anisotropy, options.max_stretch);
    EXPECT_LE(conformal.charts, rigid.charts + 6);
}

}  // namespace
}  // namespace relief
