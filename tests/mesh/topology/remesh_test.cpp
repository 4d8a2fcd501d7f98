// SPDX-License-Identifier: Apache-2.0
// Remeshing: closed manifold surfaces of any input, sharp edges, distances, and the same bytes for
// any order.
#include "relief/mesh/remesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "support/hard_meshes.h"
#include "support/labels.h"
#include "support/manifold.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::manifold_faults;
using test::ManifoldFaults;

/// Random triangles within the unit cube.
Mesh random_soup(std::uint32_t seed, std::uint32_t count, float size) {
    std::mt19937 random(seed);
    const auto number = [&random](float scale) {
        return scale * (static_cast<float>(random()) * 0x1p-31F - 1.0F);
    };
    Mesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 center{number(1.0F), number(1.0F), number(1.0F)};
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(center + glm::vec3{number(size), number(size), number(size)});
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return mesh;
}

double volume_of(const Mesh& mesh) {
    double volume = 0.0;
    for (const glm::uvec3& t : mesh.triangles)
        volume +=
            glm::dot(glm::dvec3(mesh.positions[t.x]),
                     glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
            6.0;
    return volume;
}

std::string fault_text(const ManifoldFaults& faults) {
    return faults.is_watertight()
               ? ""
               : fmt::format("{} boundary, {} crowded, {} twisted, {} fans, {} collapsed",
                             faults.boundary_edges, faults.crowded_edges, faults.twisted_edges,
                             faults.fans, faults.collapsed);
}

TEST(Remesh, ACubeKeepsItsEdgesAndCorners) {
    const Mesh cube = make_cube();
    const Mesh result = remeshed(cube, {.resolution = 32});
    EXPECT_EQ(fault_text(manifold_faults(result)), "");
    EXPECT_NEAR(volume_of(result), 8.0, 1e-5);
    const SurfaceDistance distance = surface_distance(cube, result);
    EXPECT_LT(distance.from_a.max, 1e-6);
    EXPECT_LT(distance.from_b.max, 1e-6);
}

TEST(Remesh, ASphereIsNearWithinAFractionOfACell) {
    const Mesh sphere = make_sphere(128, 64);
    const Mesh result = remeshed(sphere, {.resolution = 48});
    EXPECT_EQ(fault_text(manifold_faults(result)), "");
    const SurfaceDistance distance = surface_distance(sphere, result);
    const double cell = 2.0 / 48.0;
    EXPECT_LT(distance.from_a.max, 0.1 * cell);
    EXPECT_LT(distance.from_b.max, 0.1 * cell);
    // Euler's formula for a sphere.
    EXPECT_EQ(result.triangles.size(), 2 * (result.positions.size() - 2));
}

TEST(Remesh, ClosesGapsBelowACell) {
    // The sides of the cube do not meet.
    Mesh cracked = make_cube();
    for (std::size_t v = 0; v < cracked.positions.size(); ++v)
        cracked.positions[v] *= 1.0F - 0.002F * static_cast<float>(v % 5);
    const Mesh result = remeshed(cracked, {.resolution = 40});
    EXPECT_EQ(fault_text(manifold_faults(result)), "");
    EXPECT_NEAR(volume_of(result), 8.0, 0.2);
    Mesh open = make_cube();
    open.triangles.pop_back();
    EXPECT_THROW(remeshed(open, {.resolution = 40}), InvalidInput);
}

TEST(Remesh, SheetsBecomeShellsOnRequest) {
    const Mesh sheet = test::flat_grid(4);
    EXPECT_THROW(remeshed(sheet, {.resolution = 32}), InvalidInput);
    const Mesh result = remeshed(sheet, {.resolution = 32, .shell = true});
    EXPECT_EQ(fault_text(manifold_faults(result)), "");
    const double cell = 4.0 / 32.0;
    EXPECT_NEAR(volume_of(result), 16.0 * 1.5 * cell, 16.0 * 0.3 * cell);
    const SurfaceDistance distance = surface_distance(sheet, result);
    EXPECT_NEAR(distance.from_b.mean, 0.75 * cell, 0.05 * cell);
    // Vertices at the rim are at the corners of the planes around it.
    EXPECT_LT(distance.from_b.max, 1.2 * cell);
    Mesh triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.3F}};
    triangle.triangles = {{0, 1, 2}};
    EXPECT_EQ(fault_text(manifold_faults(remeshed(triangle, {.resolution = 20, .shell = true}))),
              "");
}

TEST(Remesh, FillsTheInsideOfNestedAndOverlappingParts) {
    Mesh two = make_cube();
    const Mesh inner = make_sphere(24, 12);
    const auto first = static_cast<std::uint32_t>(two.positions.size());
    for (const glm::vec3& p : inner.positions)
        two.positions.push_back(0.5F * p);
    for (const glm::uvec3& t : inner.triangles)
        two.triangles.push_back(t + first);
    two.normals.clear();
    two.texcoords.clear();
    two.tangents.clear();
    EXPECT_NEAR(volume_of(remeshed(two, {.resolution = 24})), 8.0, 1e-4);
}

TEST(Remesh, SoupsBecomeWatertightManifolds) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        const Mesh soup = random_soup(seed, 5 + 7 * (seed % 9), 0.3F + 0.1F * float(seed % 7));
        const int resolution = 8 + static_cast<int>(seed % 17);
        const Mesh shell = remeshed(soup, {.resolution = resolution, .shell = true});
        EXPECT_EQ(fault_text(manifold_faults(shell)), "") << "shell of soup " << seed;
        EXPECT_GT(volume_of(shell), 0.0) << seed;
        try {
            const Mesh solid = remeshed(soup, {.resolution = resolution});
            EXPECT_EQ(fault_text(manifold_faults(solid)), "") << "soup " << seed;
        } catch (const InvalidInput&) {
            // Nothing is enclosed.
        }
    }
}

TEST_LABELS(slow);
TEST(Remesh, ManyDenseSoupsBecomeWatertightManifolds) {
    for (std::uint32_t seed = 100; seed < 900; ++seed) {
        const Mesh soup = random_soup(seed, 100 + 50 * (seed % 9), 0.2F + 0.1F * float(seed % 7));
        for (const bool shell : {false, true}) {
            try {
                const Mesh result = remeshed(
                    soup, {.resolution = 12 + static_cast<int>(seed % 13), .shell = shell});
                EXPECT_EQ(fault_text(manifold_faults(result)), "") << seed;
            } catch (const InvalidInput&) {
                EXPECT_FALSE(shell) << seed;
            }
        }
    }
}

TEST(Remesh, HardMeshesHaveAStatedOutcome) {
    for (const test::NamedMesh& named : test::hard_meshes()) {
        for (const bool shell : {false, true}) {
            try {
                const Mesh result = remeshed(named.mesh, {.resolution = 16, .shell = shell});
                EXPECT_EQ(fault_text(manifold_faults(result)), "") << named.name;
            } catch (const InvalidInput& error) {
                const std::string text = error.what();
                EXPECT_TRUE(text.find("enclose nothing") != std::string::npos ||
                            text.find("no finite triangle") != std::string::npos ||
                            text.find("too small") != std::string::npos)
                    << named.name << ": " << text;
            }
        }
    }
}

TEST(Remesh, DoesNotDependOnTheOrderThreadsAndPowersOfTwo) {
    const Mesh soup = random_soup(7, 60, 0.6F);
    const RemeshOptions options{.resolution = 24, .shell = true};
    const Mesh expected = remeshed(soup, options);
    Mesh changed = soup;
    std::mt19937 random(5);
    for (std::size_t i = changed.triangles.size(); i > 1; --i)
        std::swap(changed.triangles[i - 1], changed.triangles[random() % i]);
    for (glm::uvec3& t : changed.triangles)
        t = random() % 2 == 0 ? glm::uvec3(t.y, t.z, t.x) : glm::uvec3(t.y, t.x, t.z);
    const Mesh result = remeshed(changed, options);
    EXPECT_EQ(result.positions, expected.positions);
    EXPECT_EQ(result.triangles, expected.triangles);
    RemeshOptions one_thread = options;
    one_thread.execution.threads = 1;
    EXPECT_EQ(remeshed(soup, one_thread).positions, expected.positions);
    for (glm::vec3& p : changed.positions)
        p *= 1024.0F;
    const Mesh large = remeshed(changed, options);
    ASSERT_EQ(large.positions.size(), expected.positions.size());
    for (std::size_t v = 0; v < large.positions.size(); ++v)
        ASSERT_EQ(large.positions[v], 1024.0F * expected.positions[v]);
}

TEST(Remesh, KeepsMaterialRanges) {
    Mesh cube = make_cube();
    cube.material_ranges = {{0, 2, 5}, {2, 10, std::nullopt}};
    Report report;
    const Mesh result = remeshed(cube, {.resolution = 16}, report);
    ASSERT_NO_THROW(validate(result));
    ASSERT_EQ(result.material_ranges.size(), 2U);
    EXPECT_EQ(result.material_ranges[0].material, 5U);
    EXPECT_NEAR(result.material_ranges[0].triangle_count / double(result.triangles.size()),
                1.0 / 6.0, 0.03);
    EXPECT_EQ(report.count("attributes of other triangles"), 1U);
}

TEST(Remesh, RefusesWhatHasNoResult) {
    EXPECT_THROW(remeshed(make_cube(), {.resolution = 7}), InvalidInput);
    EXPECT_THROW(remeshed(make_cube(), {.resolution = 1025}), InvalidInput);
    EXPECT_THROW(remeshed({}, {}), InvalidInput);
    Mesh far = make_cube();
    for (glm::vec3& p : far.positions)
        p.x += 100'000.0F;
    EXPECT_THROW(remeshed(far, {.resolution = 512}), InvalidInput);
    Mesh line;
    line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    line.triangles = {{0, 1, 2}};
    EXPECT_THROW(remeshed(line, {.shell = true}), InvalidInput);
}

}  // namespace
}  // namespace relief
