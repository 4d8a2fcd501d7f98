// SPDX-License-Identifier: Apache-2.0
// diagnose() on meshes with known problems, and triangles that overlap in texture space.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "relief/mesh/diagnose.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/shapes.h"
#include "topology/diagnose_parts.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::mesh_from;
using test::not_a_number;
using test::shuffled;
using test::with_triangle_order;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

/// Maps each condition to its count, in the order of the enumeration.
std::map<MeshCondition, std::size_t> counts_of(const Mesh& mesh,
                                               const DiagnoseOptions& options = {}) {
    std::map<MeshCondition, std::size_t> counts;
    for (const MeshConditionCount& found : diagnose(mesh, options).conditions)
        counts[found.condition] = found.count;
    return counts;
}

std::vector<std::size_t> first_of(const Mesh& mesh, MeshCondition condition) {
    for (const MeshConditionCount& found : diagnose(mesh).conditions) {
        if (found.condition == condition) return found.first;
    }
    return {};
}

const glm::vec3 o(0, 0, 0);
const glm::vec3 x_axis(1, 0, 0);
const glm::vec3 y_axis(0, 1, 0);
const glm::vec3 z_axis(0, 0, 1);

TEST(Diagnose, ClosedShapesHaveNoFindings) {
    EXPECT_THAT(counts_of(make_cube()), ElementsAre(Pair(MeshCondition::texture_overlapping, 12)))
        << "24 vertices at 8 places; the image on every face";
    EXPECT_THAT(counts_of(make_torus(0.4F, 24, 12)), IsEmpty());
    EXPECT_THAT(counts_of(Mesh{}), IsEmpty());
}

TEST(Diagnose, DegenerateTrianglesByKind) {
    const Mesh mesh = mesh_from({o,
                                 x_axis,
                                 y_axis,
                                 2.0F * x_axis,
                                 {0.5F, 5e-5F, 0},
                                 {0.5F, 2e-4F, 0},
                                 {not_a_number, 0, 0},
                                 o},
                                {{0, 1, 2},    // Valid.
                                 {0, 1, 1},    // A repeated index.
                                 {0, 1, 7},    // Two vertices at one position.
                                 {0, 1, 3},    // Collinear.
                                 {0, 1, 4},    // Narrower than 1e-4 of its length.
                                 {0, 1, 5},    // Wider than that.
                                 {0, 1, 6}});  // Non-finite.
    EXPECT_THAT(counts_of(mesh, {.edges = false, .near_duplicates = false}),
                ElementsAre(Pair(MeshCondition::triangle_not_finite, 1),
                            Pair(MeshCondition::triangle_collapsed, 2),
                            Pair(MeshCondition::triangle_collinear, 1),
                            Pair(MeshCondition::triangle_needle, 1),
                            Pair(MeshCondition::vertex_not_finite, 1),
                            Pair(MeshCondition::vertex_degenerate_fan, 1)));
    EXPECT_THAT(first_of(mesh, MeshCondition::triangle_collapsed), ElementsAre(1, 2));
    EXPECT_THAT(first_of(mesh, MeshCondition::vertex_degenerate_fan), ElementsAre(3));
}

TEST(Diagnose, RepeatedTrianglesCountBeyondTheFirstWhicheverCornerTheyBeginWith) {
    const Mesh mesh = mesh_from({o, x_axis, y_axis, o}, {{0, 1, 2}, {1, 2, 0}, {3, 1, 2}});
    EXPECT_THAT(counts_of(mesh), ElementsAre(Pair(MeshCondition::triangle_repeated, 2),
                                             Pair(MeshCondition::edge_boundary, 3)));
    EXPECT_THAT(first_of(mesh, MeshCondition::triangle_repeated), ElementsAre(1, 2));
}

TEST(Diagnose, ASheetWithABackIsNeitherRepeatedNorNonManifold) {
    const Mesh mesh = mesh_from({o, x_axis, x_axis + y_axis, y_axis},
                                {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}});
    EXPECT_THAT(counts_of(mesh), ElementsAre(Pair(MeshCondition::triangle_two_sided, 4)));
}

TEST(Diagnose, EdgesByTheTrianglesOnThem) {
    // Three triangles at the edge from 0 to 1. The next two share one edge each.
    const Mesh fin =
        mesh_from({o, x_axis, y_axis, -y_axis, z_axis}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    EXPECT_THAT(counts_of(fin), ElementsAre(Pair(MeshCondition::edge_non_manifold, 1),
                                            Pair(MeshCondition::edge_boundary, 6)));
    // Two triangles that both run from 0 to 1.
    const Mesh flipped = mesh_from({o, x_axis, y_axis, -y_axis}, {{0, 1, 2}, {0, 1, 3}});
    EXPECT_THAT(counts_of(flipped), ElementsAre(Pair(MeshCondition::edge_flipped, 1),
                                                Pair(MeshCondition::edge_boundary, 4)));
    // The second triangle is folded back over the first.
    const Mesh folded = mesh_from({o, x_axis, y_axis, {0.2F, 0.7F, 0}}, {{0, 1, 2}, {1, 0, 3}});
    EXPECT_THAT(counts_of(folded), ElementsAre(Pair(MeshCondition::edge_folded, 1),
                                               Pair(MeshCondition::edge_boundary, 4)));
    EXPECT_THAT(first_of(folded, MeshCondition::edge_boundary), ElementsAre(0, 1))
        << "a triangle with two such edges is named once";
}

TEST(Diagnose, EdgesAreMatchedByPosition) {
    const Mesh seam = mesh_from({o, x_axis, y_axis, x_axis, o, -y_axis}, {{0, 1, 2}, {3, 4, 5}});
    EXPECT_THAT(counts_of(seam), ElementsAre(Pair(MeshCondition::edge_boundary, 4)));
}

TEST(Diagnose, VerticesThatTrianglesMissOrMeetTwice) {
    const Mesh bow_tie =
        mesh_from({o, x_axis, y_axis, -x_axis, -y_axis, z_axis, o}, {{0, 1, 2}, {0, 3, 4}});
    EXPECT_THAT(counts_of(bow_tie), ElementsAre(Pair(MeshCondition::edge_boundary, 6),
                                                Pair(MeshCondition::vertex_isolated, 1),
                                                Pair(MeshCondition::vertex_bow_tie, 1)));
    EXPECT_THAT(first_of(bow_tie, MeshCondition::vertex_isolated), ElementsAre(5))
        << "vertex 6 is where 0 is";
}

TEST(Diagnose, NearDuplicatesAreAFewUlpsApart) {
    constexpr float ulp = 0x1p-23F;  // For numbers from 1 to 2.
    const auto near = [](const glm::vec3& a, const glm::vec3& b) {
        const auto counts =
            counts_of(mesh_from({a, b, {9, 0, 0}, {9, 1, 0}}, {{0, 2, 3}, {1, 3, 2}}));
        const auto found = counts.find(MeshCondition::vertex_near_duplicate);
        return found == counts.end() ? 0 : found->second;
    };
    EXPECT_EQ(near({1, 0, 0}, {1 + ulp, 0, 0}), 2U);
    EXPECT_EQ(near({1, 0, 0}, {1 + 4 * ulp, 0, 0}), 2U);
    EXPECT_EQ(near({1, 0, 0}, {1 + 5 * ulp, 0, 0}), 0U);
    EXPECT_EQ(near({1, 0, 0}, {1, 0, 0}), 0U) << "equal is not near";
    EXPECT_EQ(near({1, 1e-9F, 0}, {1, -1e-9F, 0}), 2U) << "across the plane of a mirror";
    EXPECT_EQ(near({1, 0, 0}, {std::nextafter(1.0F, 0.0F), 0, 0}), 2U) << "beside a power of two";
    EXPECT_EQ(near({-2, 0, 0}, {-2 + ulp, 0, 0}), 2U);
    EXPECT_EQ(near({1, 1, 1}, {1, 1, 1.001F}), 0U);
    EXPECT_EQ(near({0, 0, 0}, {0, 4 * 0x1p-149F, 0}), 2U) << "subnormal";
    EXPECT_EQ(near({0, 0, 0}, {0, 1e-20F, 0}), 0U);
}

TEST(Diagnose, NearDuplicatesMatchEveryPairLookedAt) {
    Mesh mesh;
    const auto noise = [](std::size_t i) {
        return static_cast<float>((i * 2654435761U) % 1000U) / 1000.0F;
    };
    for (std::size_t i = 0; i < 600; ++i) {
        // Every coordinate lies on one of a few units in the last place around 0.5, 1 and 2.
        const glm::vec3 spread(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2));
        mesh.positions.push_back(glm::vec3(1) + glm::round(spread * 40.0F) * 0x1p-23F);
        mesh.positions.push_back(glm::vec3(2, 0.5F, 0) + glm::round(spread * 40.0F) * 0x1p-23F);
    }
    const auto reach = [](const glm::vec3& p) {
        return std::ldexp(4.0, std::ilogb(std::max({p.x, p.y, p.z})) - 23);
    };
    std::set<std::size_t> expected;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
            const glm::vec3& a = mesh.positions[i];
            const glm::vec3& b = mesh.positions[k];
            const glm::dvec3 apart = glm::abs(glm::dvec3(a) - glm::dvec3(b));
            const double most = std::max({apart.x, apart.y, apart.z});
            if (most > 0.0 && most <= std::max(reach(a), reach(b))) expected.insert(i);
        }
    }
    // Equal positions count once, by the first vertex.
    std::set<std::size_t> firsts;
    for (const std::size_t i : expected) {
        std::size_t first = 0;
        while (mesh.positions[first] != mesh.positions[i])
            ++first;
        firsts.insert(first);
    }
    ASSERT_GT(firsts.size(), 100U);
    ASSERT_LT(firsts.size(), mesh.positions.size());
    EXPECT_EQ(diagnose(mesh).count(MeshCondition::vertex_near_duplicate), firsts.size());
}

TEST(Diagnose, NormalsThatAreNone) {
    const Mesh mesh = test::square_with_normals(
        {{0, 0, not_a_number}, {0, 0, 0}, {0, 0, 1.0071F}, {0, 0, 1.0069F}});
    EXPECT_THAT(counts_of(mesh), ElementsAre(Pair(MeshCondition::edge_boundary, 4),
                                             Pair(MeshCondition::normal_not_finite, 1),
                                             Pair(MeshCondition::normal_zero, 1),
                                             Pair(MeshCondition::normal_not_unit, 1)));
}

TEST(Diagnose, NormalsAgainstTheirTriangles) {
    Mesh mesh = test::square_with_normals({z_axis, z_axis, -z_axis, x_axis});
    EXPECT_THAT(counts_of(mesh), ElementsAre(Pair(MeshCondition::edge_boundary, 4),
                                             Pair(MeshCondition::normal_opposed, 1),
                                             Pair(MeshCondition::normal_inconsistent, 1)));
    EXPECT_THAT(first_of(mesh, MeshCondition::normal_opposed), ElementsAre(2));
    EXPECT_THAT(first_of(mesh, MeshCondition::normal_inconsistent), ElementsAre(3)) << "sidewise";
    mesh.triangles[1] = {0, 3, 2};  // Reversed: 0 and 2 belong to a front and a back.
    EXPECT_THAT(first_of(mesh, MeshCondition::normal_inconsistent), ElementsAre(0, 2, 3));
}

TEST(Diagnose, TangentsThatSpanNoFrame) {
    Mesh mesh = test::square_with_normals({z_axis, z_axis, z_axis, z_axis});
    mesh.positions.push_back(2.0F * x_axis);
    mesh.triangles.push_back({1, 4, 2});
    mesh.normals.push_back(z_axis);
    mesh.tangents = {
        {1, 0, 0, 1}, {not_a_number, 0, 0, 1}, {2, 0, 0, 0.5F}, {0, 0, 1, -1}, {1, 0, 0.021F, 1}};
    EXPECT_THAT(counts_of(mesh, {.edges = false}),
                ElementsAre(Pair(MeshCondition::tangent_not_finite, 1),
                            Pair(MeshCondition::tangent_not_unit, 1),
                            Pair(MeshCondition::tangent_invalid_sign, 1),
                            Pair(MeshCondition::tangent_along_normal, 1),
                            Pair(MeshCondition::tangent_not_perpendicular, 1)));
}

TEST(Diagnose, TextureCoordinates) {
    Mesh mesh =
        mesh_from({o, x_axis, y_axis, {2, 0, 0}, {3, 0, 0}, {2, 1, 0}}, {{0, 1, 2}, {3, 4, 5}});
    // v points down: (0,1) is below (0,0), so the first triangle is upright and the second
    // mirrored.
    mesh.texcoords = {{0, 1}, {1, 1}, {0, 0}, {2, 0}, {3, 0}, {2, 1}};
    EXPECT_THAT(counts_of(mesh), ElementsAre(Pair(MeshCondition::edge_boundary, 6),
                                             Pair(MeshCondition::texture_mirrored, 1)));
    EXPECT_THAT(first_of(mesh, MeshCondition::texture_mirrored), ElementsAre(1));
    mesh.texcoords[5] = {4, 0};
    mesh.texcoords[0] = {not_a_number, 1};
    EXPECT_THAT(counts_of(mesh), ElementsAre(Pair(MeshCondition::edge_boundary, 6),
                                             Pair(MeshCondition::texture_not_finite, 1),
                                             Pair(MeshCondition::texture_degenerate, 1)));
}

TEST(Diagnose, OverlapIsOfTrianglesWithAnAreaInSpace) {
    Mesh mesh = mesh_from({o, x_axis, y_axis, o, x_axis, y_axis + z_axis, o, x_axis, x_axis},
                          {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
    mesh.texcoords = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 0}, {1, 1}};
    const Diagnosis diagnosis = diagnose(mesh);
    EXPECT_EQ(diagnosis.count(MeshCondition::texture_overlapping), 0U);
    EXPECT_EQ(diagnosis.overlap_raster, 1024);
    EXPECT_EQ(diagnose(mesh, {.texture_overlap = false}).overlap_raster, 0);
    mesh.positions[8] = z_axis;  // Now the third triangle covers half of both others.
    EXPECT_EQ(diagnose(mesh).count(MeshCondition::texture_overlapping), 3U);
}

TEST(Diagnose, FarAwayMeansCoarseFloatsForTheSizeOfTheMesh) {
    Mesh mesh = make_cube();
    EXPECT_EQ(diagnose(mesh).size, 2.0F);
    EXPECT_EQ(diagnose(mesh).spacing, 0x1p-24F) << "below 1";
    for (glm::vec3& position : mesh.positions)
        position.x += 200.0F;
    EXPECT_EQ(diagnose(mesh).count(MeshCondition::mesh_far_away), 0U);
    for (glm::vec3& position : mesh.positions)
        position.x += 800.0F;
    EXPECT_EQ(diagnose(mesh).spacing, 0x1p-14F) << "from 512 to 1024";
    EXPECT_EQ(diagnose(mesh).count(MeshCondition::mesh_far_away), 1U);
}

TEST(Diagnose, FarTextureMeansCoarseFloatsForItsExtent) {
    const auto found_at = [](float offset, float scale) {
        Mesh mesh = make_cube();  // Every side shows the whole image, from 0 to 1.
        for (glm::vec2& texcoord : mesh.texcoords)
            texcoord = scale * (texcoord + glm::vec2(0, -offset));
        return diagnose(mesh).count(MeshCondition::texture_far_away);
    };
    // From 128 to 256, floats are 1/65536 apart, and above that, twice as much.
    for (const float scale : {1.0F, 0x1p-80F, 0x1p80F}) {
        EXPECT_EQ(found_at(0, scale), 0U);
        EXPECT_EQ(found_at(255, scale), 0U);
        EXPECT_EQ(found_at(257, scale), 1U);
        EXPECT_EQ(found_at(1e6F, scale), 1U);
    }
    EXPECT_EQ(found_at(1e6F, 0.0F), 0U) << "no extent";
}

TEST(Diagnose, ScaleChangesNothing) {
    for (const float scale : {1e-30F, 1e-20F, 1e20F, 1e30F}) {
        Mesh mesh = make_torus(0.4F, 24, 12);
        for (glm::vec3& position : mesh.positions)
            position *= scale;
        EXPECT_THAT(counts_of(mesh), IsEmpty()) << scale;
    }
}

TEST(Diagnose, CountsDoNotDependOnTheOrderOfTrianglesOrOnThreads) {
    for (const test::NamedMesh& named : test::hard_meshes()) {
        const auto expected = counts_of(named.mesh);
        const Mesh reordered =
            with_triangle_order(named.mesh, shuffled(named.mesh.triangles.size()));
        EXPECT_EQ(counts_of(reordered), expected) << named.name;
    }
    const Mesh sphere = make_sphere(300, 150);
    const Mesh reordered = with_triangle_order(sphere, shuffled(sphere.triangles.size()));
    set_thread_limit(1);
    const Diagnosis alone = diagnose(sphere);
    set_thread_limit(0);
    EXPECT_EQ(diagnose(sphere), alone);
    EXPECT_EQ(counts_of(reordered), counts_of(sphere));
}

TEST(Diagnose, AskingForLessFindsTheRestTheSame) {
    const Mesh mesh = mesh_from({o, x_axis, y_axis, -y_axis, z_axis},
                                {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 1}});
    EXPECT_THAT(counts_of(mesh, {.edges = false}),
                ElementsAre(Pair(MeshCondition::triangle_collapsed, 1)));
}

// A hundred thousand triangles in shapes for which a search over all pairs would take hours.
TEST(Diagnose, CrowdedShapesAreCountedToo) {
    constexpr std::uint32_t count = 100'000;
    Mesh fan = mesh_from({o}, {});
    Mesh book = mesh_from({o, z_axis}, {});
    for (std::uint32_t i = 0; i <= count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / (count + 1);
        fan.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        book.positions.emplace_back(std::cos(angle), std::sin(angle), 0.5);
        if (i == count) break;
        fan.triangles.emplace_back(0, i + 1, i + 2);
        book.triangles.emplace_back(0, 1, i + 2);
    }
    const auto fan_counts = counts_of(fan);
    EXPECT_EQ(fan_counts.at(MeshCondition::edge_boundary), count + 2);
    EXPECT_EQ(fan_counts.at(MeshCondition::triangle_needle), count);
    EXPECT_EQ(fan_counts.size(), 2U);
    const auto book_counts = counts_of(book);
    EXPECT_EQ(book_counts.at(MeshCondition::edge_non_manifold), 1U);
    EXPECT_EQ(book_counts.at(MeshCondition::edge_boundary), 2 * count);
    EXPECT_EQ(book_counts.at(MeshCondition::vertex_isolated), 1U);

    const Mesh point = mesh_from(std::vector<glm::vec3>(count, x_axis),
                                 std::vector<glm::uvec3>(count, glm::uvec3(0, 1, 2)));
    EXPECT_THAT(counts_of(point), ElementsAre(Pair(MeshCondition::triangle_collapsed, count),
                                              Pair(MeshCondition::vertex_degenerate_fan, count)));
    const Mesh same =
        mesh_from({o, x_axis, y_axis}, std::vector<glm::uvec3>(count, glm::uvec3(0, 1, 2)));
    EXPECT_EQ(counts_of(same).at(MeshCondition::triangle_repeated), count - 1);
}

TEST(Diagnose, RefusesInvalidIndices) {
    EXPECT_THROW(diagnose(mesh_from({o, x_axis, y_axis}, {{0, 1, 3}})), InvalidInput);
}

TEST(DiagnoseWords, AreOneEach) {
    std::set<std::string_view> words;
    for (const MeshConditionInfo& info : mesh_conditions()) {
        EXPECT_TRUE(words.insert(info.word).second) << info.word;
        EXPECT_EQ(&condition_info(info.condition), &info);
        EXPECT_FALSE(info.meaning.empty());
    }
}

TEST(DiagnoseWords, FindingsCarryThemAndTheirSeverity) {
    const Diagnosis diagnosis = diagnose(mesh_from({o, x_axis, y_axis, -y_axis, z_axis},
                                                   {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 1}}));
    EXPECT_TRUE(diagnosis.has_problem());
    EXPECT_EQ(to_report(diagnosis).findings().size(), 3U);
    const Report remarks = to_report(diagnosis, Severity::note);
    ASSERT_EQ(remarks.findings().size(), 1U);
    EXPECT_EQ(to_string(remarks.findings()[0]),
              "6 x boundary edge (edge of triangle 0, 1, 2, ...): has one triangle: "
              "the surface is open");
    EXPECT_EQ(to_report(diagnosis, Severity::problem).count("non-manifold edge"), 1U);
    EXPECT_FALSE(diagnose(mesh_from({o, x_axis, y_axis}, {{0, 1, 2}})).has_problem());
}

std::vector<std::uint8_t> overlapping(const std::vector<glm::vec2>& texcoords,
                                      const std::vector<glm::uvec3>& triangles) {
    return texture_overlap(texcoords, triangles).overlapping;
}

TEST(TextureOverlap, NeighborsDoNotAndFoldedOnesDo) {
    const std::vector<glm::vec2> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    EXPECT_THAT(overlapping(square, {{0, 1, 2}, {0, 2, 3}}), ElementsAre(0, 0));
    EXPECT_THAT(overlapping(square, {{0, 1, 2}, {0, 1, 3}}), ElementsAre(1, 1));
    EXPECT_THAT(overlapping(square, {{0, 1, 2}, {0, 2, 1}}), ElementsAre(1, 1));
}

TEST(TextureOverlap, FindsExactlyTheTrianglesThatShareTexels) {
    // 0 overlaps 1; 2 is separate; 3 covers all of them; 4 has no area; 5 is not finite.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<glm::vec2> texcoords = {{0, 0},  {1, 0},    {0, 1},    {0.2F, 0.2F},
                                              {1, 1},  {3, 0},    {4, 0},    {3, 1},
                                              {-9, 0}, {0, 30.F}, {90.F, 0}, {nan, 0}};
    const std::vector<glm::uvec3> apart = {{0, 1, 2}, {3, 1, 4}, {5, 6, 7}, {0, 1, 1}, {0, 1, 11}};
    EXPECT_THAT(overlapping(texcoords, apart), ElementsAre(1, 1, 0, 0, 0));
    std::vector<glm::uvec3> covered = apart;
    covered.push_back({8, 10, 9});
    EXPECT_THAT(overlapping(texcoords, covered), ElementsAre(1, 1, 1, 0, 0, 1));
}

TEST(TextureOverlap, IgnoresRoundingOfTexcoords) {
    // Two adjacent squares that meet at texel centers of a 1/1024 grid. The second one begins half
    // a thousandth of a texel early, then twenty thousandths.
    constexpr float seam = 512.5F / 1024.0F;
    std::vector<glm::vec2> texcoords = {
        {0, 0}, {seam, 0}, {seam, 1}, {0, 1}, {seam - 5e-7F, 0}, {1, 0}, {1, 1}, {seam - 5e-7F, 1}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    ASSERT_EQ(texture_overlap(texcoords, triangles).raster, 1024);
    EXPECT_THAT(overlapping(texcoords, triangles), Each(0));
    texcoords[1].x += 1e-5F;
    texcoords[2].x += 1e-5F;
    texcoords[4].x = texcoords[7].x = seam - 1e-5F;
    EXPECT_THAT(overlapping(texcoords, triangles), ElementsAre(1, 0, 0, 1)) << "along the seam";
}

/// Returns whether the center of any texel is inside both, by definition.
bool share_a_texel(const std::vector<glm::vec2>& t, const glm::uvec3& a, const glm::uvec3& b,
                   int side) {
    const auto is_inside = [&](const glm::uvec3& triangle, const glm::dvec2& p) {
        glm::dvec2 c[3];
        for (int i = 0; i < 3; ++i)
            c[i] = glm::dvec2(t[triangle[i]]) * static_cast<double>(side);
        const glm::dvec2 u = c[1] - c[0];
        const glm::dvec2 v = c[2] - c[0];
        if (u.x * v.y - u.y * v.x < 0.0) std::swap(c[1], c[2]);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec2 edge = c[(i + 1) % 3] - c[i];
            const glm::dvec2 to = p - c[i];
            if (edge.x * to.y - edge.y * to.x < 1e-3 * glm::length(edge)) return false;
        }
        return true;
    };
    // Only texels in the boxes of both triangles can be inside both.
    const auto low_corner = [&](const glm::uvec3& triangle) {
        return glm::min(t[triangle.x], glm::min(t[triangle.y], t[triangle.z]));
    };
    const auto high_corner = [&](const glm::uvec3& triangle) {
        return glm::max(t[triangle.x], glm::max(t[triangle.y], t[triangle.z]));
    };
    const glm::vec2 low = glm::max(low_corner(a), low_corner(b)) * static_cast<float>(side);
    const glm::vec2 high = glm::min(high_corner(a), high_corner(b)) * static_cast<float>(side);
    const glm::ivec2 begin(low);
    const glm::ivec2 end = glm::min(glm::ivec2(high) + 1, side);
    for (int row = begin.y; row < end.y; ++row) {
        for (int column = begin.x; column < end.x; ++column) {
            const glm::dvec2 center(column + 0.5, row + 0.5);
            if (is_inside(a, center) && is_inside(b, center)) return true;
        }
    }
    return false;
}

TEST(TextureOverlap, MatchesASearchThroughAllPairs) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<float> anywhere(0.1F, 0.9F);
    std::uniform_real_distribution<float> near(-0.1F, 0.1F);
    std::vector<glm::vec2> texcoords = {{0, 0}, {1, 1}, {0, 0.001F}, {1, 0.999F}};
    std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 1, 3}};  // These triangles span the unit
                                                                 // square.
    for (std::uint32_t i = 0; i < 30; ++i) {
        const glm::vec2 center(anywhere(generator), anywhere(generator));
        for (int k = 0; k < 3; ++k)
            texcoords.push_back(center + glm::vec2(near(generator), near(generator)));
        triangles.push_back(glm::uvec3(0, 1, 2) + 3 * i + 4U);
    }
    const TextureOverlap found = texture_overlap(texcoords, triangles);
    ASSERT_EQ(found.raster, 1024);
    std::vector<std::uint8_t> expected(triangles.size(), 0);
    for (std::size_t a = 0; a < triangles.size(); ++a) {
        for (std::size_t b = a + 1; b < triangles.size(); ++b) {
            if (share_a_texel(texcoords, triangles[a], triangles[b], 1024))
                expected[a] = expected[b] = 1;
        }
    }
    EXPECT_EQ(found.overlapping, expected);
    const auto some = std::count(expected.begin(), expected.end(), 1);
    EXPECT_GT(some, 5);
    EXPECT_LT(some, 30) << "the test must see both";
}

TEST(TextureOverlap, ShapesWithOneImageAllOverHaveNone) {
    for (const Mesh& mesh : {test::grid(100), test::sphere(64, 32)})
        EXPECT_THAT(overlapping(mesh.texcoords, mesh.triangles), Each(0));
    const Mesh cube = test::cube();
    EXPECT_THAT(overlapping(cube.texcoords, cube.triangles), Each(1)) << "the image on every face";
}

TEST(TextureOverlap, CrowdsAreLookedAtMoreCoarsely) {
    constexpr std::uint32_t count = 300'000;
    std::vector<glm::vec2> texcoords = {{0, 0}};
    std::vector<glm::uvec3> fan;
    for (std::uint32_t i = 0; i <= count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / (count + 1);
        texcoords.emplace_back(std::cos(angle), std::sin(angle));
        if (i < count) fan.emplace_back(0, i + 1, i + 2);
    }
    const TextureOverlap none = texture_overlap(texcoords, fan);
    EXPECT_THAT(none.overlapping, Each(0));
    EXPECT_LT(none.raster, 200);
    EXPECT_GT(none.raster, 30);
    const TextureOverlap all = texture_overlap(
        texcoords, std::vector<glm::uvec3>(count, glm::uvec3(1, 1 + count / 3, 1 + count / 2)));
    EXPECT_THAT(all.overlapping, Each(1));
}

TEST(TextureOverlap, TheOrderOfTrianglesDoesNotMatter) {
    Mesh mesh = test::grid(40);
    for (std::size_t i = 0; i < mesh.texcoords.size(); i += 7)
        mesh.texcoords[i] += glm::vec2(0.06F, 0.03F);
    const std::vector<std::size_t> order = test::shuffled(mesh.triangles.size());
    const Mesh reordered = test::with_triangle_order(mesh, order);
    const auto before = overlapping(mesh.texcoords, mesh.triangles);
    const auto after = overlapping(reordered.texcoords, reordered.triangles);
    ASSERT_GT(std::count(before.begin(), before.end(), 1), 100);
    for (std::size_t i = 0; i < order.size(); ++i)
        ASSERT_EQ(after[i], before[order[i]]) << i;
}

}  // namespace
}  // namespace relief
