// SPDX-License-Identifier: Apache-2.0
// Rays of the baker at edges, vertices, grazing angles and every scale, and the choice of a hit in
// a stack of sheets.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "bake/ray_scene.h"
#include "relief/mesh/mesh.h"
#include "support/sanitized.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Returns a number from -1 to 1.
double number(std::mt19937& random) {
    return static_cast<double>(random()) / 2147483648.0 - 1.0;
}

RayScene scene_of(const Mesh& mesh) {
    return RayScene({{mesh.positions, mesh.triangles}});
}

glm::dvec3 place_of(const RayScene& scene, const RayHit& hit) {
    const auto corners = scene.corners(hit.mesh, hit.triangle);
    return hit.weights.x * corners[0] + hit.weights.y * corners[1] + hit.weights.z * corners[2];
}

/// Returns the mesh after scale and translation, with one rounding per position.
Mesh placed_at(Mesh mesh, double scale, const glm::dvec3& by) {
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(glm::dvec3(position) * scale + by);
    return mesh;
}

/// A closed surface around the origin with one vertex at each pole, and outward triangles. Those at
/// the poles are `slices` / 2 pi times as long as wide; with bumps, they are folded like a star.
Mesh closed_sphere(int slices, int stacks, double bumps) {
    Mesh mesh;
    const auto put = [&](double polar, double longitude) {
        const double radius = 1.0 + bumps * std::sin(12.0 * longitude) * std::sin(12.0 * polar);
        mesh.positions.emplace_back(radius * glm::dvec3(std::sin(polar) * std::sin(longitude),
                                                        std::cos(polar),
                                                        std::sin(polar) * std::cos(longitude)));
    };
    put(0.0, 0.0);
    for (int row = 1; row < stacks; ++row) {
        for (int i = 0; i < slices; ++i)
            put(std::numbers::pi * row / stacks, 2.0 * std::numbers::pi * i / slices);
    }
    put(std::numbers::pi, 0.0);
    const auto at = [&](int row, int i) {
        const int vertex = row == 0        ? 0
                           : row == stacks ? slices * (stacks - 1) + 1
                                           : 1 + (row - 1) * slices + i % slices;
        return static_cast<std::uint32_t>(vertex);
    };
    for (int row = 0; row < stacks; ++row) {
        for (int i = 0; i < slices; ++i) {
            if (row < stacks - 1)
                mesh.triangles.emplace_back(at(row, i), at(row + 1, i), at(row + 1, i + 1));
            if (row > 0)
                mesh.triangles.emplace_back(at(row, i), at(row + 1, i + 1), at(row, i + 1));
        }
    }
    return mesh;
}

TEST(RayScene, NoRayPassesBetweenNeedles) {
    // Needles of 1000:1 at the poles, and of 20:1 elsewhere. Rays in random bundles run from
    // outside to the center, through places inside of triangles, on edges and at vertices.
    const Mesh sphere = closed_sphere(6284, 8, 0.0);
    const RayScene scene = scene_of(sphere);
    std::mt19937 random(4);
    for (int bundle = 0; bundle < (test::is_sanitized ? 90 : 1500); ++bundle) {
        RayPacket packet;
        std::array<Ray, RayPacket::size> rays;
        const std::size_t first = random() % sphere.triangles.size();
        for (std::size_t lane = 0; lane < rays.size(); ++lane) {
            const glm::uvec3& t = sphere.triangles[(first + lane) % sphere.triangles.size()];
            const glm::dvec3 a(sphere.positions[t.x]);
            const double second = bundle % 3 == 2 ? 0.0 : 0.5 + 0.5 * number(random);
            const double third =
                bundle % 3 == 0 ? (1.0 - second) * (0.5 + 0.5 * number(random)) : 0.0;
            const glm::dvec3 place = a + second * (glm::dvec3(sphere.positions[t.y]) - a) +
                                     third * (glm::dvec3(sphere.positions[t.z]) - a);
            const glm::dvec3 center =
                0.2 * glm::dvec3(number(random), number(random), number(random));
            const glm::dvec3 direction = glm::normalize(center - place);
            const double before = 0.1 + 5.0 * std::abs(number(random));
            rays[lane] = {place - before * direction, direction, 0.0,
                          before + glm::distance(place, center)};
            scene.set(packet, lane, rays[lane]);
        }
        RayPacket blocked = packet;
        scene.find(packet, rays.size());
        scene.find_any(blocked, rays.size());
        for (std::size_t lane = 0; lane < rays.size(); ++lane) {
            ASSERT_TRUE(packet.hits(lane)) << bundle << " " << lane;
            ASSERT_TRUE(blocked.is_blocked(lane)) << bundle << " " << lane;
            ASSERT_TRUE(scene.nearest(rays[lane]).is_hit()) << bundle << " " << lane;
            EXPECT_TRUE(scene.hit(packet, lane).faces_origin) << bundle << " " << lane;
        }
    }
}

/// Returns whether the inner half of a line hits a front face.
bool has_front_inwards(const RayScene& scene, const ProjectionLine& line) {
    Ray ray{line.point, -line.outward, 0.0, line.inside};
    for (int crossing = 0; crossing < 100; ++crossing) {
        const RayHit hit = scene.nearest(ray);
        if (!hit.is_hit() || hit.faces_origin) return hit.is_hit();
        ray.near = hit.distance + 1e-13;
    }
    return false;
}

TEST(Projection, FindsTheFoldsOfNeedlesHoweverNearTheyAre) {
    // At the poles, folds of needles of 160:1 are closer to each other than 1e-8.
    std::mt19937 random(5);
    const Mesh star = closed_sphere(1000, 40, 0.2);
    const RayScene scene = scene_of(star);
    std::vector<ProjectionLine> lines;
    constexpr int line_count = test::is_sanitized ? 2000 : 20000;
    for (int i = 0; i < line_count; ++i) {
        const double polar = std::pow(10.0, 3.5 * number(random) - 4.5);
        const double longitude = std::numbers::pi * number(random);
        const glm::dvec3 outward(std::sin(polar) * std::sin(longitude), std::cos(polar),
                                 std::sin(polar) * std::cos(longitude));
        const double height =
            std::pow(10.0, 3.0 * number(random) - 8.0) * (i % 2 == 0 ? 1.0 : -1.0);
        const glm::dvec3 tilt(number(random), number(random), number(random));
        lines.push_back({(1.0 + height) * outward, glm::normalize(outward + tilt), 0.05, 0.05});
    }
    std::vector<ProjectedPoint> points(lines.size());
    Projection(scene, BackFaces::skip).find(lines, points);
    std::size_t fronts = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!has_front_inwards(scene, lines[i])) continue;
        ++fronts;
        EXPECT_TRUE(points[i].hit.is_hit()) << i;
        EXPECT_TRUE(points[i].hit.faces_origin) << i;
    }
    EXPECT_GT(fronts, test::is_sanitized ? 200U : 4000U);
}

TEST(RayScene, HitsPlanesExactlyAtEveryScale) {
    for (const double scale : {1e-20, 1e-3, 1.0, 1e5, 1e20}) {
        for (const double away : {0.0, 100.0}) {
            const glm::dvec3 by(away * scale, 0.0, 0.0);
            const Mesh quad = placed_at(make_quad(8), scale, by);
            const RayScene scene = scene_of(quad);
            std::mt19937 random(1);
            for (int i = 0; i < 100; ++i) {
                const double x = 0.9999 * number(random);
                const double y = 0.9999 * number(random);
                const Ray ray{glm::dvec3(x, y, 0.25) * scale + by, {0, 0, -1}, 0.0, scale};
                const RayHit hit = scene.nearest(ray);
                ASSERT_TRUE(hit.is_hit()) << scale << " " << x << " " << y;
                EXPECT_NEAR(hit.distance / scale, 0.25, 1e-12);
                EXPECT_TRUE(hit.faces_origin);
                // The comparison is in double, from the exact origin of the ray, without floats.
                EXPECT_LT(glm::distance(place_of(scene, hit),
                                        ray.origin - 0.25 * scale * glm::dvec3(0, 0, 1)) /
                              scale,
                          1e-6 * 0.2);
            }
        }
    }
}

TEST(RayScene, EdgesAndVerticesHaveOneHitInAnyOrder) {
    // 8 x 8 cells: rays along their edges, diagonals and vertices, and one in the opposite
    // direction.
    const Mesh quad = make_quad(8);
    Mesh turned = quad;
    std::reverse(turned.triangles.begin(), turned.triangles.end());
    const RayScene scene = scene_of(quad);
    const RayScene other = scene_of(turned);
    const auto count = static_cast<std::uint32_t>(quad.triangles.size());
    for (int i = 1; i < 32; ++i) {
        for (int j = 1; j < 32; ++j) {
            const Ray ray{{i / 16.0 - 1.0, j / 16.0 - 1.0, 1.0}, {0, 0, -1}, 0.0, 2.0};
            const RayHit hit = scene.nearest(ray);
            ASSERT_TRUE(hit.is_hit()) << i << " " << j;
            EXPECT_EQ(hit.distance, 1.0);
            EXPECT_EQ(other.nearest(ray).triangle, count - 1 - hit.triangle);
            EXPECT_GE(std::min({hit.weights.x, hit.weights.y, hit.weights.z}), 0.0);
        }
    }
}

TEST(RayScene, NoRayPassesBetweenTheTrianglesOfAClosedSurface) {
    const Mesh sphere = make_sphere(64, 32);
    const RayScene scene = scene_of(sphere);
    for (const glm::vec3& vertex : sphere.positions) {
        for (const double share : {0.0, 0.5}) {
            // Rays go through vertices, and through the middle of edges along rows.
            const std::size_t next =
                static_cast<std::size_t>(&vertex - sphere.positions.data()) + 1;
            if (next >= sphere.positions.size()) continue;
            const glm::dvec3 target =
                glm::mix(glm::dvec3(vertex), glm::dvec3(sphere.positions[next]), share);
            if (glm::length(target) < 0.5) continue;
            const glm::dvec3 outward = glm::normalize(target);
            const RayHit hit = scene.nearest({2.0 * outward, -outward, 0.0, 2.0});
            ASSERT_TRUE(hit.is_hit());
            EXPECT_LT(glm::distance(place_of(scene, hit), target), 0.03);
            EXPECT_TRUE(hit.faces_origin);
        }
    }
}

TEST(RayScene, SkinnyTrianglesSeenEdgeOnAreNotHit) {
    // A needle of width 1e-6 in the xz plane. Rays pass along it at a distance of 1e-4.
    Mesh needle;
    needle.positions = {{-1, 0, 0}, {1, 0, 0}, {1, 0, 1e-6F}};
    needle.triangles = {{0, 1, 2}};
    const RayScene scene = scene_of(needle);
    for (const double y : {1e-4, -1e-4, 1e-2}) {
        EXPECT_FALSE(scene.nearest({{-2, y, 0}, {1, 0, 0}, 0.0, 4.0}).is_hit());
        EXPECT_FALSE(scene.nearest({{0, y, 1e-3}, {0, 0, -1}, 0.0, 4.0}).is_hit());
    }
    // A ray through it is a hit, and the hit point is on it.
    const RayHit hit = scene.nearest({{0.9, 1.0, 4e-7}, {0, -1, 0}, 0.0, 4.0});
    ASSERT_TRUE(hit.is_hit());
    EXPECT_NEAR(hit.distance, 1.0, 1e-12);
}

TEST(RayScene, NumbersThatAreNoneAndTrianglesWithoutAreaAreNotHit) {
    Mesh quad = make_quad();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    quad.positions.push_back({nan, 0, 0});
    quad.positions.push_back({0, infinity, 0});
    const auto first = static_cast<std::uint32_t>(quad.positions.size() - 2);
    quad.triangles.push_back({0, 1, first});
    quad.triangles.push_back({0, 1, first + 1});
    quad.triangles.push_back({0, 0, 1});
    quad.triangles.push_back({0, 0, 0});
    const RayScene scene = scene_of(quad);
    EXPECT_EQ(scene.half_size(), 1.0);
    for (const double x : {-0.9, -0.1, 0.3, 0.99}) {
        const RayHit hit = scene.nearest({{x, 0.2, 1}, {0, 0, -1}, 0.0, 2.0});
        ASSERT_TRUE(hit.is_hit());
        EXPECT_LT(hit.triangle, 2U);
    }
    EXPECT_FALSE(scene.nearest({{2, 0, 1}, {0, 0, -1}, 0.0, 2.0}).is_hit());
}

TEST(RayScene, DistantRaysHitTheSamePoint) {
    const Mesh quad = placed_at(make_quad(8), 1.0, {3.0, 0.0, 0.0});  // The scene uses it, so it
                                                                      // must stay alive.
    const RayScene scene = scene_of(quad);
    const glm::dvec3 place(3.3, -0.4, 0.0);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.5, 0.25, -1.0));
    for (const double away : {3.9, 4.1, 100.0, 1e6, 1e9}) {
        const Ray ray{place - away * direction, direction, 0.0, 2.0 * away};
        const RayHit hit = scene.nearest(ray);
        ASSERT_TRUE(hit.is_hit()) << away;
        EXPECT_NEAR(hit.distance, away, 1e-15 * away + 1e-15);
        EXPECT_LT(glm::distance(place_of(scene, hit), place), 1e-15 * away + 1e-15);
        EXPECT_FALSE(scene.nearest({ray.origin, -direction, 0.0, 2.0 * away}).is_hit()) << away;
        EXPECT_FALSE(scene.nearest({ray.origin, direction, 0.0, 0.99 * away}).is_hit()) << away;
        EXPECT_FALSE(scene.nearest({ray.origin, direction, 1.01 * away, 2.0 * away}).is_hit());
        EXPECT_FALSE(scene.nearest({ray.origin + 3.0, direction, 0.0, 2.0 * away}).is_hit());
    }
    // Where doubles lose precision or overflow, rays hit nothing, and no error occurs.
    for (const double away : {1e11, 1e19, 1e30, 1e300, std::numeric_limits<double>::infinity()}) {
        const Ray ray{place - away * direction, direction, 0.0, 2.0 * away};
        EXPECT_FALSE(scene.nearest(ray).is_hit()) << away;
    }
}

TEST(RayScene, AnEmptySceneHasNoHits) {
    const RayScene nothing({});
    EXPECT_TRUE(nothing.is_empty());
    EXPECT_FALSE(nothing.nearest({{0, 0, 1}, {0, 0, -1}, 0.0, 2.0}).is_hit());
    EXPECT_EQ(nothing.distance_from({0, 0, 0}), std::numeric_limits<double>::infinity());
    const Mesh mesh;
    EXPECT_TRUE(scene_of(mesh).is_empty());
}

TEST(RayScene, KnowsMeshesApartAndHowFarTheyAre) {
    const Mesh near = placed_at(make_quad(), 1.0, {0, 0, 0.5});
    const Mesh far = make_quad();
    const RayScene scene({{far.positions, far.triangles}, {near.positions, near.triangles}});
    const Ray down{{0.1, 0.3, 1}, {0, 0, -1}, 0.0, 2.0};
    EXPECT_EQ(scene.nearest(down).mesh, 1U);
    EXPECT_DOUBLE_EQ(scene.nearest(down).distance, 0.5);
    const Ray up{{0.1, 0.3, -1}, {0, 0, 1}, 0.0, 2.0};
    EXPECT_EQ(scene.nearest(up).mesh, 0U);
    EXPECT_FALSE(scene.nearest(up).faces_origin);
    EXPECT_NEAR(scene.distance_from({0, 0, 0.75}), 0.25, 1e-6);
    EXPECT_NEAR(scene.distance_from({4, 5, 0.5}), 5.0, 1e-5);
    EXPECT_NEAR(scene.distance_from({0.2, -0.4, 0.1}), 0.1, 1e-6);
    // No surface is within this limit, so the distance is exact. Otherwise it is only a bound.
    EXPECT_EQ(scene.distance_from({0.2, 3.0, 0.1}, 1.5), scene.distance_from({0.2, 3.0, 0.1}));
    EXPECT_LE(scene.distance_from({0.2, 3.0, 0.1}, 4.0), 4.0);
}

TEST(RayScene, ASceneForFewRaysHasTheSameHits) {
    const Mesh sphere = make_sphere(96, 48);
    const RayScene many = scene_of(sphere);
    const RayScene few({{sphere.positions, sphere.triangles}}, 10.0);
    std::mt19937 random(9);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < 4000; ++i) {
        const glm::dvec3 origin(number(random), number(random), 2.0);
        // Every other ray goes to a vertex, except at grazing angles.
        const glm::dvec3 vertex(sphere.positions[i % sphere.positions.size()]);
        const bool is_to_vertex = i % 2 == 0 && vertex.z > 0.7;
        const glm::dvec3 target = is_to_vertex ? vertex : glm::dvec3(origin.x, origin.y, 0.0);
        const Ray ray{origin, glm::normalize(target - origin), 0.0, 4.0};
        const RayHit expected = many.nearest(ray);
        const RayHit found = few.nearest(ray);
        ASSERT_EQ(found.is_hit(), expected.is_hit());
        if (!found.is_hit()) continue;
        ++hits;
        ASSERT_EQ(found.triangle, expected.triangle);
        ASSERT_EQ(found.distance, expected.distance);
        ASSERT_EQ(found.weights, expected.weights);
    }
    EXPECT_GT(hits, 3000U);
}

TEST(RayScene, ARayHitsTheSameInAnyPacket) {
    const Mesh sphere = make_sphere(48, 24);
    const RayScene scene = scene_of(sphere);
    std::mt19937 random(7);
    const auto vector = [&] {
        const double x = number(random);
        const double y = number(random);
        return glm::dvec3(x, y, number(random));
    };
    for (int round = 0; round < 50; ++round) {
        RayPacket packet;
        std::array<Ray, RayPacket::size> rays;
        for (std::size_t lane = 0; lane < rays.size(); ++lane) {
            const glm::dvec3 from = 2.0 * glm::normalize(vector());
            rays[lane] = {from, glm::normalize(0.5 * vector() - from), 0.0, 5.0};
            scene.set(packet, lane, rays[lane]);
        }
        scene.find(packet, rays.size());
        for (std::size_t lane = 0; lane < rays.size(); ++lane) {
            const RayHit together = scene.hit(packet, lane);
            const RayHit alone = scene.nearest(rays[lane]);
            EXPECT_EQ(together.triangle, alone.triangle);
            EXPECT_EQ(together.weights, alone.weights);
        }
    }
}

struct Sheet {
    float height;
    bool faces_up;
};

/// Squares from -1 to 1 across the z axis.
Mesh stack(const std::vector<Sheet>& sheets) {
    Mesh mesh;
    for (const Sheet& sheet : sheets) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
            mesh.positions.emplace_back(corner, sheet.height);
        const glm::uvec3 up(first, first + 1, first + 2), other(first, first + 2, first + 3);
        for (const glm::uvec3& triangle : {up, other}) {
            mesh.triangles.push_back(
                sheet.faces_up ? triangle : glm::uvec3(triangle.x, triangle.z, triangle.y));
        }
    }
    return mesh;
}

/// Returns the height of the surface that belongs to the origin, seen from +z, within 1; -100 if
/// there is none.
double found(const std::vector<Sheet>& sheets, BackFaces back_faces = BackFaces::skip) {
    const Mesh mesh = stack(sheets);
    const RayScene scene({{mesh.positions, mesh.triangles}});
    const ProjectionLine line{{0.1, 0.2, 0.0}, {0, 0, 1}, 1.0, 1.0};
    ProjectedPoint point;
    Projection(scene, back_faces).find({&line, 1}, {&point, 1});
    return point.hit.is_hit() ? point.height : -100.0;
}

TEST(Projection, HitsASheetOnEitherSide) {
    for (const float height : {0.5F, 0.01F, 0.0F, -0.01F, -0.5F})
        EXPECT_NEAR(found({{height, true}}), height, 1e-12);
    EXPECT_EQ(found({}), -100.0);
    EXPECT_EQ(found({{1.5F, true}}), -100.0);
    EXPECT_EQ(found({{-1.5F, true}}), -100.0);
}

TEST(Projection, HitsTheOuterOfTwoSheets) {
    EXPECT_NEAR(found({{0.1F, true}, {-0.1F, true}}), 0.1F, 1e-12);
    EXPECT_NEAR(found({{0.1F, true}, {0.3F, true}}), 0.3F, 1e-12);
    EXPECT_NEAR(found({{-0.3F, true}, {-0.1F, true}}), -0.1F, 1e-12);
}

TEST(Projection, TheOtherSideOfAThinWallIsNot) {
    // The surface of the point, slightly inside or outside, and a wall that faces it.
    for (const float own : {-0.02F, 0.0F, 0.02F})
        EXPECT_NEAR(found({{own, true}, {0.2F, false}, {0.22F, true}}), own, 1e-12) << own;
    // The line begins within the wall.
    EXPECT_NEAR(found({{-0.02F, true}, {0.2F, false}}), -0.02F, 1e-12);
    EXPECT_NEAR(found({{0.02F, true}, {0.2F, false}, {1.2F, true}}), 0.02F, 1e-12);
    // The wall whose side is the surface itself: it is thinner than the distance of the surfaces.
    EXPECT_NEAR(found({{0.3F, true}, {0.28F, false}}), 0.3F, 1e-12);
    EXPECT_NEAR(found({{-0.3F, true}, {-0.32F, false}}), -0.3F, 1e-12);
}

TEST(Projection, HitsTheOutermostOfIntersectingSolids) {
    // A plate with a bolt whose foot is above the point.
    EXPECT_NEAR(found({{-0.5F, false}, {0.1F, true}, {0.05F, false}, {0.4F, true}}), 0.4F, 1e-12);
    // The same with a wall behind.
    EXPECT_NEAR(found({{-0.5F, false},
                       {0.1F, true},
                       {0.05F, false},
                       {0.4F, true},
                       {0.6F, false},
                       {0.7F, true}}),
                0.4F, 1e-12);
}

TEST(Projection, BackFacesAreIgnoredIfRequested) {
    EXPECT_EQ(found({{0.2F, false}}), -100.0);
    EXPECT_NEAR(found({{0.2F, false}}, BackFaces::take), 0.2F, 1e-12);
    EXPECT_NEAR(found({{-0.2F, false}, {-0.4F, true}}), -0.4F, 1e-12);
    EXPECT_NEAR(found({{-0.2F, false}, {-0.4F, true}}, BackFaces::take), -0.2F, 1e-12);
}

TEST(Projection, CountsItsRays) {
    const Mesh mesh = stack({{-0.1F, true}});
    const RayScene scene({{mesh.positions, mesh.triangles}});
    std::vector<ProjectionLine> lines(40, {{0.1, 0.2, 0.0}, {0, 0, 1}, 1.0, 1.0});
    std::vector<ProjectedPoint> points(lines.size());
    const Projection projection(scene, BackFaces::skip);
    EXPECT_EQ(projection.find(lines, points), 40U);
    // The surfaces are also found in the outward direction of the point, with nothing in between.
    for (ProjectionLine& line : lines)
        line.point.z = -0.2;
    EXPECT_EQ(projection.find(lines, points), 40U);
    EXPECT_NEAR(points.back().height, 0.1, 1e-7);
}

}  // namespace
}  // namespace relief
